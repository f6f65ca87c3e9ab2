"""The points about columns, gathered in one pass over the drives."""

from __future__ import annotations

from collections.abc import Sequence
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

    def followed_by(self, other: ColumnPoints) -> ColumnPoints:
        """Points about these columns, and about others after them."""
        return ColumnPoints(
            np.concatenate([self.starts, self.starts[-1] + other.starts[1:]]),
            np.concatenate([self.local, other.local]),
            np.concatenate([self.drives, other.drives]),
            np.concatenate([self.points, other.points]),
        )

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
    if not len(middles):
        return ColumnPoints(
            np.zeros(1, np.int64), np.empty((0, 3)), np.empty(0, np.int64), np.empty(0, np.int64)
        )
    nearest = nearest_columns(plan, middles, radius_m).reshape(-1)

    def gathered(chunk: DriveChunk) -> _GatheredPoints:
        owners = np.empty(len(chunk.local), np.int32)
        owners_kernel(chunk.local, plan.table, nearest, middles, radius_m, owners)
        owners[chunk.is_noise] = -1
        kept = np.flatnonzero(owners >= 0)
        return _GatheredPoints(
            owners.take(kept), chunk.local.take(kept, axis=0), chunk.drive, chunk.start + kept
        )

    parts = list(in_order(gathered, chunks_of(drives, plan.origin, monitor)))
    counts = np.zeros(len(middles), np.int64)
    for part in parts:
        monitor.check()
        counts += np.bincount(part.owners, minlength=len(middles))
    starts = np.concatenate([[0], np.cumsum(counts)])
    about = ColumnPoints(
        starts,
        np.empty((starts[-1], 3)),
        np.empty(starts[-1], np.int64),
        np.empty(starts[-1], np.int64),
    )
    free = starts[:-1].copy()
    for part in parts:
        monitor.check()
        place_kernel(part, free, about.local, about.drives, about.points)
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
        local[place] = part.local[point]
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
