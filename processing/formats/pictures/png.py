"""PNG pictures, written a strip of rows at a time: they may be longer than memory."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from processing.core.safe_write import write_safely

MOST_ROWS = 1_000_000
"""Of a picture that programs built on libpng open."""
MOST_PIXELS = 1 << 30
"""Of a picture that OpenCV opens."""

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_EIGHT_BITS, _RED_GREEN_BLUE = 8, 2
_LEFT_NEIGHBOUR = 1
_LEVEL = 1


def write_png(path: Path, size: tuple[int, int], strips: Iterable[NDArray[np.uint8]]) -> None:
    """Write a picture.

    Parameters
    ----------
    size : tuple of int
        Rows and columns of the whole.
    strips : iterable of (k, columns, 3) uint8
        Its rows from the top; red, green, blue.

    Raises
    ------
    NoSpace
        The disk is full or refuses the write.
    ValueError
        The strips are not as long as the picture.

    References
    ----------
    ISO/IEC 15948:2004, Portable Network Graphics: clauses 9 (filter type 1) and 11.2.
    """
    rows, columns = size
    with write_safely(path) as temporary, temporary.open("wb") as file:
        file.write(_SIGNATURE)
        _write_chunk(
            file,
            b"IHDR",
            struct.pack(">IIBBBBB", columns, rows, _EIGHT_BITS, _RED_GREEN_BLUE, 0, 0, 0),
        )
        packer = zlib.compressobj(_LEVEL, strategy=zlib.Z_RLE)
        written = 0
        for strip in strips:
            written += strip.shape[0]
            _write_chunk(file, b"IDAT", packer.compress(_filter_rows(strip)))
        if written != rows:
            message = f"{written} rows of a picture of {rows}"
            raise ValueError(message)
        _write_chunk(file, b"IDAT", packer.flush())
        _write_chunk(file, b"IEND", b"")


def _filter_rows(strip: NDArray[np.uint8]) -> bytes:
    """Rows as differences of each pixel to the one on its left."""
    rows, columns, _ = strip.shape
    lines = np.empty((rows, 1 + 3 * columns), np.uint8)
    lines[:, 0] = _LEFT_NEIGHBOUR
    differences = lines[:, 1:].reshape(rows, columns, 3)
    differences[:, :1] = strip[:, :1]
    np.subtract(strip[:, 1:], strip[:, :-1], out=differences[:, 1:])
    return lines.tobytes()


def _write_chunk(file: BinaryIO, name: bytes, data: bytes) -> None:
    file.write(struct.pack(">I", len(data)) + name)
    file.write(data)
    file.write(struct.pack(">I", zlib.crc32(data, zlib.crc32(name))))
