"""The points about columns, gathered in one pass over the drives."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor, PartMonitor
from processing.core.scratch_arrays import nameless_array
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.drive_chunks import DriveChunk, chunks_of
from processing.methods.road.objects.sparse_plan import (
    CELL_M,
    TILE,
    SparsePlan,
    cell_of,
)
from processing.recording.drive import Drive

_MOST_IN_MEMORY = 10_000_000
"""Points of a survey of which those about columns are held in memory: half a gigabyte at most. Of
larger ones they lie in a file for the time of the run."""


@dataclass(frozen=True)
class ColumnPoints:
    """Points about columns, those of a column in one piece, in the order of drives and points.

    Attributes
    ----------
    starts : (k + 1,) int64
        Column c has the lines ``starts[c] … starts[c + 1] − 1``.
    local : (n, 3) float64
        m about the origin of the plan.
    drives : (n,) int64
        Which of the drives each is of.
    points : (n,) int64
        Its number in that drive.
    """

    starts: Integers
    local: Floats
    drives: Integers
    points: Integers

    def of(self, column: int) -> slice:
        """The lines of a column."""
        return slice(int(self.starts[column]), int(self.starts[column + 1]))

    def chosen(self, is_in: Flags) -> ColumnPoints:
        """Some of the points, (n,) bool, of as many columns."""
        lines = np.flatnonzero(is_in)
        starts = np.searchsorted(lines, self.starts)
        return ColumnPoints(starts, self.local[lines], self.drives[lines], self.points[lines])


def points_about(
    drives: Sequence[Drive],
    plan: SparsePlan,
    middles: Floats,
    radius_m: float,
    monitor: Monitor,
) -> ColumnPoints:
    """All points within a distance of a column in plan; of several columns, the nearest.

    Parameters
    ----------
    middles : (k, 2) float64
        Of the columns, m about the origin of the plan.
    radius_m : float
    """
    return points_about_each(drives, plan, (middles,), radius_m, monitor)


def points_about_each(
    drives: Sequence[Drive],
    plan: SparsePlan,
    groups: Sequence[Floats],
    radius_m: float,
    monitor: Monitor,
) -> ColumnPoints:
    """The same about several groups of columns, one group after the other.

    A point lies about a column of each group that is near: none takes it from another's.
    """
    groups = [middles for middles in groups if len(middles)]
    if not groups:
        return _room_for(np.zeros(1, np.int64), None)
    gathered = _Gathering(plan, groups, radius_m)
    if sum(drive.count for drive in drives) > _MOST_IN_MEMORY:
        return _in_a_file(drives, plan.origin, gathered, monitor)
    chunks = chunks_of(drives, plan.origin, monitor)
    parts = [part for some in in_order(gathered.of, chunks) for part in some]
    monitor.check()
    about = _room_for(_starts(gathered.columns, (one.owners for one in parts)), None)
    _place((parts,), about, monitor)
    return about


def _in_a_file(
    drives: Sequence[Drive], origin: Floats, gathered: _Gathering, monitor: Monitor
) -> ColumnPoints:
    """Read twice, so that nothing but one chunk is ever held: memory doesn't grow with a drive."""
    first, second = PartMonitor(monitor, 0.0, 0.5), PartMonitor(monitor, 0.5, 1.0)
    counted = in_order(gathered.of, chunks_of(drives, origin, first))
    starts = _starts(gathered.columns, (part.owners for parts in counted for part in parts))
    about = _room_for(starts, drives[0].folder)
    _place(in_order(gathered.of, chunks_of(drives, origin, second)), about, monitor)
    return about


def _starts(columns: int, owners: Iterable[NDArray[np.int32]]) -> Integers:
    """(k + 1,) where the points of each column begin."""
    counts = np.zeros(columns, np.int64)
    for some in owners:
        counts += np.bincount(some, minlength=columns)
    return np.concatenate([[0], np.cumsum(counts)])


def _room_for(starts: Integers, folder: Path | None) -> ColumnPoints:
    """Columns whose points are not there yet, in memory or on the disk of a folder."""
    count = int(starts[-1])
    if folder is None:
        whole = np.empty((count, 3)), np.empty(count, np.int64), np.empty(count, np.int64)
    else:
        whole = (
            nameless_array(folder, np.float64, (count, 3)),
            nameless_array(folder, np.int64, (count,)),
            nameless_array(folder, np.int64, (count,)),
        )
    return ColumnPoints(starts, *whole)


def _place(
    parts: Iterable[Sequence[_GatheredPoints]], about: ColumnPoints, monitor: Monitor
) -> None:
    """Put points of stretches that follow each other into their columns."""
    columns = len(about.starts) - 1

    def with_room() -> Iterator[tuple[_GatheredPoints, Integers]]:
        free = about.starts[:-1].copy()
        for part in (one for some in parts for one in some):
            monitor.check()
            yield part, free.copy()
            free += np.bincount(part.owners, minlength=columns)

    def place(part: tuple[_GatheredPoints, Integers]) -> None:
        place_kernel(*part, about.local, about.drives, about.points)

    for _ in in_order(place, with_room()):
        monitor.check()


class _GatheredPoints(NamedTuple):
    """Points of a chunk about columns.

    ``owners``: the column of each; ``drive``, ``points``: which of the drives they are of, and
    their numbers there.
    """

    owners: NDArray[np.int32]
    local: Floats
    drive: int
    points: Integers


class _Gathering:
    """Tells which points of a chunk lie about columns.

    Attributes
    ----------
    columns : int
        Of all groups.
    """

    def __init__(self, plan: SparsePlan, groups: Sequence[Floats], radius_m: float) -> None:
        self._table, self._groups, self._radius_m = plan.table, groups, radius_m
        self._nearest = [nearest_columns(plan, one, radius_m).reshape(-1) for one in groups]
        self._offsets = np.cumsum([0, *(len(one) for one in groups)]).tolist()
        self.columns: int = self._offsets[-1]

    def of(self, chunk: DriveChunk) -> list[_GatheredPoints]:
        """Those of each group."""
        found = []
        owners = np.empty(len(chunk.local), np.int32)
        for middles, near, offset in zip(
            self._groups, self._nearest, self._offsets[:-1], strict=True
        ):
            owners_kernel(chunk.local, self._table, near, middles, self._radius_m, owners)
            owners[chunk.is_noise] = -1
            kept = np.flatnonzero(owners >= 0)
            local = chunk.local.take(kept, axis=0)
            numbers = owners.take(kept) + np.int32(offset)
            found.append(_GatheredPoints(numbers, local, chunk.drive, chunk.start + kept))
        return found


@kernel
def owners_kernel(
    local: Floats,
    table: NDArray[np.int32],
    nearest: NDArray[np.int32],
    middles: Floats,
    radius_m: float,
    owners: NDArray[np.int32],
) -> None:
    """The column that each point lies about; −1: none."""
    for point in range(len(local)):
        cell = cell_of(local[point, 0], local[point, 1], table, TILE)
        column = nearest[cell] if cell >= 0 else -1
        if column >= 0:
            east = local[point, 0] - middles[column, 0]
            north = local[point, 1] - middles[column, 1]
            if east * east + north * north > radius_m * radius_m:
                column = -1
        owners[point] = column


@kernel
def place_kernel(
    part: _GatheredPoints, free: Integers, local: Floats, drives: Integers, points: Integers
) -> None:
    """Put points behind those of their column, in the order that they come in.

    Parameters
    ----------
    free : (k,) int64
        Where the next point of each column goes; moved on.
    """
    for point in range(part.owners.size):
        place = free[part.owners[point]]
        free[part.owners[point]] += 1
        for axis in range(3):
            local[place, axis] = part.local[point, axis]
        drives[place] = part.drive
        points[place] = part.points[point]


def nearest_columns(plan: SparsePlan, middles: Floats, radius_m: float) -> NDArray[np.int32]:
    """(tiles, 64, 64) the column nearest to each cell; −1 where none is near."""
    nearest = np.full((len(plan), TILE, TILE), -1, np.int32)
    away = np.full((len(plan), TILE, TILE), np.inf, np.float32)
    reach = int(np.ceil(radius_m / CELL_M)) + 1
    nearest_kernel(middles, reach, plan.table, nearest.reshape(-1), away.reshape(-1))
    return nearest


@kernel
def nearest_kernel(
    middles: Floats,
    reach: int,
    table: NDArray[np.int32],
    nearest: NDArray[np.int32],
    away: NDArray[np.float32],
) -> None:
    """Write each column into the cells about it that no other is nearer to."""
    for column in range(len(middles)):
        for i in range(-reach, reach + 1):
            for j in range(-reach, reach + 1):
                east = (np.floor(middles[column, 0] / CELL_M) + i + 0.5) * CELL_M
                north = (np.floor(middles[column, 1] / CELL_M) + j + 0.5) * CELL_M
                cell = cell_of(east, north, table, TILE)
                if cell < 0:
                    continue
                distance = np.hypot(east - middles[column, 0], north - middles[column, 1])
                if distance < away[cell]:
                    away[cell] = distance
                    nearest[cell] = column
