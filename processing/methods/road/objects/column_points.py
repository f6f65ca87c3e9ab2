"""The points about columns, gathered in one pass over the drives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.drive_chunks import DriveChunk, chunks_of
from processing.methods.road.objects.sparse_plan import (
    CELL_M,
    TILE,
    SparsePlan,
    cell_of,
)
from processing.recording.drive import Drive


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
    sizes = np.array([0, *(len(middles) for middles in groups)], np.int64)
    offsets = np.cumsum(sizes)
    nearest = [nearest_columns(plan, middles, radius_m).reshape(-1) for middles in groups]

    def gathered(chunk: DriveChunk) -> list[_GatheredPoints]:
        found = []
        owners = np.empty(len(chunk.local), np.int32)
        for middles, near, offset in zip(groups, nearest, offsets[:-1].tolist(), strict=True):
            owners_kernel(chunk.local, plan.table, near, middles, radius_m, owners)
            owners[chunk.is_noise] = -1
            kept = np.flatnonzero(owners >= 0)
            local = chunk.local.take(kept, axis=0)
            numbers = owners.take(kept) + np.int32(offset)
            found.append(_GatheredPoints(numbers, local, chunk.drive, chunk.start + kept))
        return found

    chunks = chunks_of(drives, plan.origin, monitor) if groups else ()
    parts = [part for some in in_order(gathered, chunks) for part in some]
    return _in_columns(parts, int(offsets[-1]), monitor)


def _in_columns(parts: Sequence[_GatheredPoints], columns: int, monitor: Monitor) -> ColumnPoints:
    """Points of stretches that follow each other, column by column."""
    counts = np.zeros(columns, np.int64)
    for part in parts:
        monitor.check()
        counts += np.bincount(part.owners, minlength=columns)
    starts = np.concatenate([[0], np.cumsum(counts)])
    about = ColumnPoints(
        starts,
        np.empty((starts[-1], 3)),
        np.empty(starts[-1], np.int64),
        np.empty(starts[-1], np.int64),
    )

    def with_room() -> Iterator[tuple[_GatheredPoints, Integers]]:
        free = starts[:-1].copy()
        for part in parts:
            monitor.check()
            yield part, free.copy()
            free += np.bincount(part.owners, minlength=columns)

    def place(part: tuple[_GatheredPoints, Integers]) -> None:
        place_kernel(*part, about.local, about.drives, about.points)

    for _ in in_order(place, with_room()):
        monitor.check()
    return about


class _GatheredPoints(NamedTuple):
    """Points of a chunk about columns.

    ``owners``: the column of each; ``drive``, ``points``: which of the drives they are of, and
    their numbers there.
    """

    owners: NDArray[np.int32]
    local: Floats
    drive: int
    points: Integers


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
