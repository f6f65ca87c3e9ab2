"""Points and their codes as few bytes: what is painted lies in runs, and has few codes."""

from __future__ import annotations

import zlib

import numpy as np
from numpy.typing import NDArray

_LEVEL = 1  # thrice as quick as the usual one, and runs are small anyway
_NARROW, _WIDE = 4, 8
_DTYPES = {_NARROW: "<u4", _WIDE: "<u8"}


def pack_points(points: NDArray[np.int64]) -> bytes:
    """Indices of points as compressed gaps and lengths of their runs.

    Parameters
    ----------
    points : (n,) int64
        Rising strictly, from 0.

    Raises
    ------
    ValueError
        They don't rise, or one is negative.
    """
    if points.size == 0:
        return b""
    steps = np.diff(points)
    if points[0] < 0 or (steps <= 0).any():
        message = "points to be packed must rise from 0"
        raise ValueError(message)
    firsts = np.concatenate([[0], np.flatnonzero(steps != 1) + 1])
    lengths = np.diff(np.append(firsts, points.size))
    starts = points[firsts]
    gaps = starts - np.concatenate([[0], starts[:-1] + lengths[:-1]])
    is_narrow = max(int(gaps.max()), int(lengths.max())) <= np.iinfo(np.uint32).max
    width = _NARROW if is_narrow else _WIDE
    table = np.stack([gaps, lengths]).astype(_DTYPES[width])
    return bytes([width]) + zlib.compress(table.tobytes(), _LEVEL)


def unpack_points(packed: bytes) -> NDArray[np.int64]:
    """The points of :func:`pack_points`.

    Returns
    -------
    (n,) int64

    Raises
    ------
    ValueError
        The bytes are damaged.
    """
    if not packed:
        return np.empty(0, np.int64)
    if packed[0] not in _DTYPES:
        message = f"runs of {packed[0]} bytes"
        raise ValueError(message)
    dtype = np.dtype(_DTYPES[packed[0]])
    table = np.frombuffer(_decompress_labels(packed[1:]), dtype).reshape(2, -1).astype(np.int64)
    gaps, lengths = table
    stops = np.cumsum(gaps + lengths)
    # Every point is one behind the one before it, but for the first of a run.
    steps = np.ones(int(lengths.sum()), np.int64)
    firsts = np.cumsum(lengths) - lengths
    steps[firsts] += gaps
    steps[0] -= 1
    points: NDArray[np.int64] = np.cumsum(steps)
    if points.size and points[-1] != stops[-1] - 1:
        message = "runs that overlap"
        raise ValueError(message)
    return points


def pack_codes(codes: NDArray[np.uint8]) -> bytes:
    """Codes of points, compressed."""
    return zlib.compress(np.ascontiguousarray(codes, np.uint8).tobytes(), _LEVEL)


def unpack_codes(packed: bytes) -> NDArray[np.uint8]:
    """The (n,) uint8 codes of :func:`pack_codes`.

    Raises
    ------
    ValueError
        The bytes are damaged.
    """
    return np.frombuffer(_decompress_labels(packed), np.uint8)


def _decompress_labels(packed: bytes) -> bytes:
    try:
        return zlib.decompress(packed)
    except zlib.error as error:
        raise ValueError(str(error)) from error
