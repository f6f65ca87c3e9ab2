"""PTX, Leica's text format: scans as grids of points, each with the pose of its scanner."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import BadFile, report_as_user_error
from processing.core.text import Text
from processing.formats.points.delivered.delivered_floats import ColumnBlock, FloatFile
from processing.formats.points.delivered.field_names import block_of
from processing.formats.points.las.las_header import damaged
from processing.formats.points.text.text_numbers import NumberLines

_POSITION_LINES, _POSE_LINES = 4, 4
_NAMES = ("x", "y", "z", "intensity", "red", "green", "blue")
_WIDTHS = (7, 4, 3)
_LEAST_LINE_BYTES = 6


@dataclass(frozen=True)
class _Scan:
    """One scan's header: its number in the file, its grid and its pose (4, 4)."""

    number: int
    sweeps: int
    sweep_length: int
    pose: NDArray[np.float64]

    @property
    def cells(self) -> int:
        return self.sweeps * self.sweep_length


def is_ptx(start: bytes) -> bool:
    """Whether a file begins as PTX: two whole numbers alone on a line, then three coordinates."""
    lines = [line.split() for line in start.split(b"\n")[:3]]
    widths = [len(line) for line in lines]
    return widths == [1, 1, 3] and all(line[0].isdigit() for line in lines[:2])


def open_ptx(path: Path) -> FloatFile:
    """The points of all scans of a PTX file, moved by their poses, with their cells of the grid.

    Cells of the grid without a return (0 0 0) are left out. The grid's columns are the sweeps.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read; a line is not what it should be; it ends inside a scan.
    """
    with report_as_user_error(path):
        path.stat()
    return FloatFile(path, "PTX", lambda: _blocks(path))


def _blocks(path: Path) -> Iterator[ColumnBlock]:
    with report_as_user_error(path), path.open("rb") as file:
        size = path.stat().st_size
        lines = NumberLines(path, file)
        number = 0
        while (scan := _next_scan(path, lines, number + 1, size)) is not None:
            number, done = scan.number, 0
            # The widest lines have colours, others intensity, or neither.
            words = lines.width()
            columns = next((width for width in _WIDTHS if words >= width), _WIDTHS[-1])
            for numbers in lines.numbers(columns, scan.cells):
                yield _block(numbers, scan, done)
                done += numbers.shape[0]
            if done < scan.cells:
                raise _ends_early(path, done, scan.cells)


def _block(numbers: NDArray[np.float64], scan: _Scan, first_cell: int) -> ColumnBlock:
    is_measured = numbers[:, :3].any(axis=1)
    measured = numbers[is_measured]
    fields = {name: measured[:, i] for i, name in enumerate(_NAMES[: measured.shape[1]])}
    block = block_of(fields)
    # The pose multiplies from the right: rows are the scanner's axes, the last one its place.
    block["xyz"] = np.einsum("ni,ij->nj", measured[:, :3], scan.pose[:3, :3]) + scan.pose[3, :3]
    cells = first_cell + np.flatnonzero(is_measured)
    block["grid"] = np.column_stack(np.divmod(cells, scan.sweep_length))
    block["scan"] = np.full(cells.size, scan.number)
    block["scanner_position"] = np.broadcast_to(scan.pose[3, :3], (cells.size, 3))
    return block


def _next_scan(path: Path, lines: NumberLines, number: int, size: int) -> _Scan | None:
    """The scan whose header comes next; None at the end of the file."""
    sizes = _take_lines(lines, 2, 1)
    if sizes.size == 0:
        return None
    if sizes.shape[0] < 2 or not (np.isfinite(sizes).all() and (sizes >= 0).all()):
        raise _ends_early(path, 0, 0)
    sweeps, sweep_length = (int(min(value, 1e9)) for value in sizes[:, 0])
    # Held against the file, a count can't make anything be allocated.
    if sweeps * sweep_length * _LEAST_LINE_BYTES > size + 1:
        raise _ends_early(path, size // _LEAST_LINE_BYTES, sweeps * sweep_length)
    position = _take_lines(lines, _POSITION_LINES, 3)
    pose = _take_lines(lines, _POSE_LINES, 4)
    if (
        position.shape[0] + pose.shape[0] < _POSITION_LINES + _POSE_LINES
        or not np.isfinite(pose).all()
    ):
        raise _ends_early(path, 0, sweeps * sweep_length)
    return _Scan(number, sweeps, sweep_length, pose)


def _take_lines(lines: NumberLines, limit: int, columns: int) -> NDArray[np.float64]:
    found = list(lines.numbers(columns, limit))
    return np.concatenate(found) if found else np.empty((0, columns))


def _ends_early(path: Path, whole: int, count: int) -> BadFile:
    return damaged(
        path,
        Text(
            f"A scan ends in the middle of point {whole + 1:,} of {count:,}.",
            f"スキャンの{count:,}点のうち{whole + 1:,}点目の途中で終わっています。",
        ),
    )
