"""PTX, Leica's text format: scans as grids of points, each with the pose of its scanner."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.errors import BadFile, told_as_user_error
from processing.formats.delivered_floats import Block, FloatFile
from processing.formats.field_names import block_of
from processing.formats.las_header import damaged
from processing.formats.text_numbers import TextPart, number_blocks
from processing.text import Text

_HEADER_LINES = 10
_POSE_LINES = 4
_NAMES = ("x", "y", "z", "intensity", "red", "green", "blue")
_LEAST_LINE_BYTES = 8


def is_ptx(start: bytes) -> bool:
    """Whether a file begins as PTX: two whole numbers alone on a line, then three coordinates."""
    lines = [line.split() for line in start.split(b"\n")[:3]]
    widths = [len(line) for line in lines]
    return widths == [1, 1, 3] and all(line[0].isdigit() for line in lines[:2])


def open_ptx(path: Path) -> FloatFile:
    """The points of all scans of a PTX file, moved by their poses.

    Cells of the grid without a return (0 0 0) are left out.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read; a line is not what it should be; it ends inside a scan.
    """
    with told_as_user_error(path):
        path.stat()
    return FloatFile(path, "PTX", lambda: _blocks(path))


def _blocks(path: Path) -> Iterator[Block]:
    done = 0
    while (scan := _scan_at(path, done)) is not None:
        count, pose, width = scan
        left = count
        part = TextPart(path, skip=done + _HEADER_LINES, limit=count)
        for numbers in number_blocks(part, width) if count else ():
            left -= numbers.shape[0]
            yield _block(numbers, pose)
        if left:
            raise _ends_early(path, count - left, count)
        done += _HEADER_LINES + count


def _block(numbers: NDArray[np.float64], pose: NDArray[np.float64]) -> Block:
    measured = numbers[numbers[:, :3].any(axis=1)]
    fields = {name: measured[:, i] for i, name in enumerate(_NAMES[: measured.shape[1]])}
    block = block_of(fields)
    # The pose multiplies from the right: rows are the scanner's axes, the last one its place.
    block["xyz"] = np.einsum("ni,ij->nj", measured[:, :3], pose[:3, :3]) + pose[3, :3]
    return block


def _scan_at(path: Path, line: int) -> tuple[int, NDArray[np.float64], int] | None:
    """Points, pose and numbers on a line of the scan whose header is there; None at the end."""
    sizes = _lines(path, line, 2, 1)
    if sizes.size == 0:
        return None
    if sizes.shape[0] < 2 or not (np.isfinite(sizes).all() and (sizes >= 0).all()):
        raise _ends_early(path, 0, 0)
    count = int(min(sizes.prod(), 1e15))
    if count * _LEAST_LINE_BYTES > path.stat().st_size:
        raise _ends_early(path, path.stat().st_size // _LEAST_LINE_BYTES, count)
    pose = _lines(path, line + _HEADER_LINES - _POSE_LINES, _POSE_LINES, 4)
    if pose.shape[0] < _POSE_LINES or not np.isfinite(pose).all():
        raise _ends_early(path, 0, count)
    return count, pose, _width(path, line + _HEADER_LINES)


def _lines(path: Path, skip: int, limit: int, columns: int) -> NDArray[np.float64]:
    found = list(number_blocks(TextPart(path, skip=skip, limit=limit), columns))
    return np.concatenate(found) if found else np.empty((0, columns))


def _width(path: Path, line: int) -> int:
    """How many numbers a point has: with colours, with intensity, or bare."""
    with told_as_user_error(path), path.open("rb") as file:
        own = next((text for i, text in enumerate(file) if i == line), b"")
    words = len(own.split())
    return next(width for width in (7, 4, 3) if words >= width or width == 3)


def _ends_early(path: Path, whole: int, count: int) -> BadFile:
    return damaged(
        path,
        Text(
            f"A scan ends in the middle of point {whole + 1:,} of {count:,}.",
            f"スキャンの{count:,}点のうち{whole + 1:,}点目の途中で終わっています。",
        ),
    )
