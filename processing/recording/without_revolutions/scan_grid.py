"""The grid of a standing scanner: its sweeps stand in for rows, the places in them for pulses.

A structured scan is an image already, so nothing is to be found but whether it is a sound one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Text
from processing.recording.columns.columns import ColumnWriter, column_path
from processing.recording.columns.ordering import chunk_ranges, read_chunk, sort_points

COLUMN = "grid"
"""Column of a folder that is being made: (n, 2) sweep and place in it, −1 where unknown."""

_POINTS_AT_ONCE = 2_000_000
"""Points read at a time."""

_MOST_REPEATED = 0.01
"""Share of points that may share a cell: second returns that a file has all the same. By trial; no
measurement is recorded."""

_MOST_CELLS_A_POINT, _FEW_CELLS = 1_000, 10_000_000
"""A grid with more cells for each point is a mistake, but for small ones: it would fill memory."""

_PIECES, _PIECE_POINTS = 64, 4_096
"""Pieces in which neighbours are looked at, spread over the scan."""

_FEWEST_PAIRS = 200
"""Pairs of neighbours that tell something. By trial; no measurement is recorded."""

_FARTHEST_STEP = 0.5
"""Neighbours in a grid are nearer than this share of what points of a piece are apart. By trial; no
measurement is recorded."""

SHOWN_AS_SCAN = Text(
    "The scanner stood still, so there are no revolutions along a path; the scan's own image "
    "of {sweeps} sweeps with {length} places is shown.",
    "据置型スキャナの点群のため、走行に沿った回転はありません。"
    "スキャン画像（{sweeps} 列 × {length} 点）で表示します。",
)
_CONTRADICTION = Text(
    "The scan's grid in the file contradicts itself ({why}); the top view is shown.",
    "ファイル内のスキャン格子に矛盾があります（{why}）。上面画像で表示します。",
)
_UNKNOWN = Text("points lack their row or column", "行または列の番号がない点があります")
_NO_GRID = Text("all points lie in one sweep", "全点が1列に並んでいます")
_TOO_WIDE = Text("nearly all of its cells are empty", "ほぼすべてのセルが空です")
_REPEATED = Text("many points share a cell", "多くの点が同じセルにあります")
_NO_NEIGHBOURS = Text("neighbours in it lie far apart", "隣り合うセルの点が離れています")


@dataclass(frozen=True)
class ScanGrid:
    """Cells of a scan: sweep after sweep, from the first that has a point.

    Attributes
    ----------
    first_sweep, first_position : int
        The file's numbers of the first sweep and place with a point.
    sweeps, sweep_length : int
    """

    first_sweep: int
    first_position: int
    sweeps: int
    sweep_length: int

    def cells_of(self, grid: NDArray[np.int32]) -> NDArray[np.int64]:
        """(n,) int64: the cell of every point, of its (n, 2) sweep and place."""
        sweeps = grid[:, 0].astype(np.int64) - self.first_sweep
        return np.asarray(sweeps * self.sweep_length + (grid[:, 1] - self.first_position))

    @property
    def reported(self) -> Text:
        """Why the drive has no revolutions, and what is shown instead."""
        return SHOWN_AS_SCAN.filled(sweeps=f"{self.sweeps:,}", length=f"{self.sweep_length:,}")


@dataclass(frozen=True)
class NoGrid:
    """Why the grid of a file can't be used."""

    reason: Text


def order_by_grid(
    folder: Path, count: int, names: Callable[[], tuple[str, ...]], monitor: Monitor
) -> ScanGrid | NoGrid:
    """Bring the points of a folder into the order of their cells, and number these as pulses.

    Parameters
    ----------
    folder : Path
        A drive folder that is being made; `COLUMN` is among its columns.
    names : callable
        Gives the names of its columns; called only if the points must be sorted.

    Returns
    -------
    ScanGrid or NoGrid
        With a grid the column ``pulse`` is written; without, the points may be in another order.

    Raises
    ------
    UserError, Cancelled

    Notes
    -----
    A grid is refused where points lack their cell, where it is one line, where less than one cell
    in a thousand is filled, where more than one point in a hundred shares its cell with another
    that is not a return of the same pulse, and where points of neighbouring cells lie about as
    far apart as any others.
    """
    grid = _bounds_of(folder, count, monitor)
    if isinstance(grid, NoGrid):
        return grid
    if not _is_in_order(folder, grid, count, monitor):

        def by_cell(columns: Mapping[str, NDArray[Any]]) -> tuple[NDArray[Any], NDArray[Any]]:
            return grid.cells_of(columns[COLUMN]), columns["return_number"]

        sort_points(folder, names(), count, by_cell, PartMonitor(monitor, 0.2, 0.8))
    if _count_repeated(folder, grid, count) > _MOST_REPEATED * count:
        return NoGrid(_CONTRADICTION.filled(why=_REPEATED))
    if not _has_neighbours(folder, grid, count):
        return NoGrid(_CONTRADICTION.filled(why=_NO_NEIGHBOURS))
    with ColumnWriter(folder) as pulses:
        for cells, _ in _cells(folder, grid, count):
            monitor.check()
            pulses.append({"pulse": cells})
    return grid


def remove_grid_column(folder: Path) -> None:
    """Remove `COLUMN`: the cells are pulses by now."""
    path = column_path(folder, COLUMN)
    with report_as_user_error(path):
        path.unlink(missing_ok=True)


def _bounds_of(folder: Path, count: int, monitor: Monitor) -> ScanGrid | NoGrid:
    lowest, highest = np.full(2, np.iinfo(np.int64).max), np.full(2, -1)
    for start, stop in chunk_ranges(count, _POINTS_AT_ONCE):
        monitor.check()
        grid = read_chunk(folder, COLUMN, start, stop)
        lowest = np.minimum(lowest, grid.min(axis=0))
        highest = np.maximum(highest, grid.max(axis=0))
    if lowest.min() < 0:
        return NoGrid(_CONTRADICTION.filled(why=_UNKNOWN))
    sweeps, length = (highest - lowest + 1).tolist()
    if min(sweeps, length) < 2:
        return NoGrid(_CONTRADICTION.filled(why=_NO_GRID))
    if sweeps * length > max(_MOST_CELLS_A_POINT * count, _FEW_CELLS):
        return NoGrid(_CONTRADICTION.filled(why=_TOO_WIDE))
    return ScanGrid(int(lowest[0]), int(lowest[1]), sweeps, length)


def _cells(
    folder: Path, grid: ScanGrid, count: int
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.uint8]]]:
    """Cells and return numbers of all points, chunk by chunk."""
    for start, stop in chunk_ranges(count, _POINTS_AT_ONCE):
        cells = grid.cells_of(read_chunk(folder, COLUMN, start, stop))
        yield cells, read_chunk(folder, "return_number", start, stop)


def _is_in_order(folder: Path, grid: ScanGrid, count: int, monitor: Monitor) -> bool:
    last = (-1, -1)
    for cells, returns in _cells(folder, grid, count):
        monitor.check()
        steps = np.diff(cells, prepend=last[0])
        goes_back = returns < np.concatenate([[last[1]], returns[:-1]])
        if ((steps < 0) | ((steps == 0) & goes_back)).any():
            return False
        last = int(cells[-1]), int(returns[-1])
    return True


def _count_repeated(folder: Path, grid: ScanGrid, count: int) -> int:
    """Points in the cell of the point before that are the same return."""
    repeated, last = 0, (-1, -1)
    for cells, returns in _cells(folder, grid, count):
        same = (np.diff(cells, prepend=last[0]) == 0) & (
            returns == np.concatenate([[last[1]], returns[:-1]])
        )
        repeated += int(same.sum())
        last = int(cells[-1]), int(returns[-1])
    return repeated


def _has_neighbours(folder: Path, grid: ScanGrid, count: int) -> bool:
    """Whether points of neighbouring cells lie nearer each other than points of any cells."""
    random = np.random.default_rng(0)
    steps, strides = [], []
    for start in np.unique(np.linspace(0, max(count - _PIECE_POINTS, 0), _PIECES).astype(int)):
        stop = min(int(start) + _PIECE_POINTS, count)
        xyz = read_chunk(folder, "xyz", int(start), stop).astype(np.float64)
        cells = grid.cells_of(read_chunk(folder, COLUMN, int(start), stop))
        follows = np.flatnonzero(np.diff(cells) == 1)
        steps.append(np.linalg.norm(xyz[follows + 1] - xyz[follows], axis=1))
        strides.append(np.linalg.norm(xyz[random.permutation(xyz.shape[0])] - xyz, axis=1))
    step, stride = np.concatenate(steps), np.concatenate(strides)
    if step.size < _FEWEST_PAIRS:
        return True
    return float(np.median(step)) <= _FARTHEST_STEP * float(np.median(stride))
