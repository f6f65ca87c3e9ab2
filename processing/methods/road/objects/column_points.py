"""The points about columns, gathered in one pass over the drives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.road.objects.drive_chunks import chunks_of
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
    nearest = nearest_columns(plan, middles, radius_m)
    parts: list[tuple[Integers, Floats, Integers, Integers]] = []
    for chunk in chunks_of(drives, plan.origin, monitor):
        owners = np.empty(len(chunk.local), np.int32)
        owners_kernel(chunk.local, plan.table, nearest.reshape(-1), middles, radius_m, owners)
        owners[chunk.is_noise] = -1
        kept = np.flatnonzero(owners >= 0)
        numbers = np.full(kept.size, chunk.drive, np.int64)
        parts.append(
            (owners[kept].astype(np.int64), chunk.local[kept], numbers, chunk.start + kept)
        )
    if not parts:
        none = np.empty(0, np.int64)
        return ColumnPoints(np.zeros(len(middles) + 1, np.int64), np.empty((0, 3)), none, none)
    owner = np.concatenate([one[0] for one in parts])
    starts = np.concatenate([[0], np.cumsum(np.bincount(owner, minlength=len(middles)))])
    order = np.empty(owner.size, np.int64)
    order_kernel(owner, starts[:-1].copy(), order)
    return ColumnPoints(
        starts,
        np.concatenate([one[1] for one in parts])[order],
        np.concatenate([one[2] for one in parts])[order],
        np.concatenate([one[3] for one in parts])[order],
    )


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


def nearest_columns(plan: SparsePlan, middles: Floats, radius_m: float) -> NDArray[np.int32]:
    """(tiles, 64, 64) the column nearest to each cell; −1 where none is near."""
    nearest = np.full((len(plan), TILE, TILE), -1, np.int32)
    away = np.full((len(plan), TILE, TILE), np.inf, np.float32)
    reach = int(np.ceil(radius_m / CELL_M)) + 1
    nearest_kernel(middles, reach, plan.table, nearest.reshape(-1), away.reshape(-1))
    return nearest


@kernel
def order_kernel(owner: Integers, free: Integers, order: Integers) -> None:
    """Points by their column, those of a column in the order that they come in.

    Parameters
    ----------
    free : (k,) int64
        Where the next point of each column goes; moved on.
    """
    for point in range(owner.size):
        order[free[owner[point]]] = point
        free[owner[point]] += 1


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
