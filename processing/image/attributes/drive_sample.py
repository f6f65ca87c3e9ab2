"""Percentiles of a drive's values, from a sample that is drawn once."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.recording.columns.ordering import read_chunk

_PIECES = 64
"""Pieces of a column, spread over the drive."""

_PIECE_POINTS = 4096
"""Of each piece: 260,000 in all, read in a moment."""


def value_at_percent(
    folder: Path, name: str, count: int, axis: int | None, percent: float
) -> float:
    """The value of a column below which a share of the drive's points lie.

    Parameters
    ----------
    folder : Path
        The drive's folder; its columns as delivered never change.
    axis : int or None
        Which of a vector's values.
    """
    sample = _sorted_sample(folder, name, count, axis)
    return float(np.percentile(sample, percent)) if sample.size else 0.0


@lru_cache(maxsize=64)
def _sorted_sample(folder: Path, name: str, count: int, axis: int | None) -> NDArray[np.float64]:
    """Pieces as long as a revolution from all over the drive: the disk is read at few positions."""
    last = max(0, count - _PIECE_POINTS)
    starts = np.unique(np.linspace(0, last, _PIECES).astype(np.int64))
    if count <= _PIECES * _PIECE_POINTS:
        starts, length = np.zeros(1, np.int64), count
    else:
        length = _PIECE_POINTS
    pieces = [read_chunk(folder, name, int(start), int(start) + length) for start in starts]
    values = np.concatenate([piece if axis is None else piece[:, axis] for piece in pieces])
    values = values.astype(np.float64)
    return np.sort(values[np.isfinite(values)])
