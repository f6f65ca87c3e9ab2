"""At which heights above the ground fine cells of the plan hold points, for what stands upright.

Ground is known for cells 0.8 m wide. A bank rises by half a metre within one, so it is laid between
their middles here; where neighbours differ by more than a bank does, a wall or an edge lies between
them, and each keeps its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.road.objects.drive_chunks import chunks_of
from processing.methods.road.objects.sparse_plan import CELL_M, TILE, SparsePlan, cell_of
from processing.recording.drive import Drive

FINE = 2 * TILE
"""Cells along the side of a tile."""

FINE_M = CELL_M / 2
"""0.1 m wide: a rail and its beam's depth; what stands behind it lies in other cells."""

LOWEST_M = 0.2
"""Below lie grass, curbs and the error of the ground."""

SLAB_M, SLABS = 0.15, 31
"""Height of a slab, and how many: up to 4.85 m, higher than noise walls."""

GROUND_BIT = np.uint32(1 << SLABS)
"""Set where the ground was seen."""

_MOST_STEP_M = 0.6
"""A bank of 1 : 1.5 rises so much between the middles of cells of the ground."""


@dataclass(frozen=True)
class RaisedCells:
    """What stands upright.

    Attributes
    ----------
    plan : SparsePlan
    ground : (tiles, 64, 64) float32
        m about the origin of the plan; NaN where none is known.
    slabs : (tiles, 128, 128) uint32
        Bit b: points from ``0.2 + 0.15 b`` m above the ground; the last: points of the ground.
    """

    plan: SparsePlan
    ground: NDArray[np.float32]
    slabs: NDArray[np.uint32]

    def corners(self) -> Floats:
        """(tiles, 2) float64: where each tile begins, m about the origin of the plan."""
        begin = np.full(2, -0.5)
        return np.array([self.plan.middles(tile, begin) for tile in range(len(self.plan))]).reshape(
            -1, 2
        )


def raised_cells(
    drives: Sequence[Drive], plan: SparsePlan, ground: NDArray[np.float32], monitor: Monitor
) -> RaisedCells:
    """Cells of all drives together.

    Parameters
    ----------
    ground : (tiles, 16, 16) float32
        As :func:`processing.methods.road.objects.ground_heights.ground_heights` found it.
    """
    between = np.empty((len(plan), TILE, TILE), np.float32)
    for tile in range(len(plan)):
        between_kernel(plan.window(ground, tile, 1, np.nan), between[tile])
    slabs = np.zeros((len(plan), FINE, FINE), np.uint32)
    for chunk in chunks_of(drives, plan.origin, monitor):
        raise_kernel(
            chunk.local, chunk.is_noise, plan.table, between.reshape(-1), slabs.reshape(-1)
        )
    return RaisedCells(plan, between, slabs)


@kernel
def between_kernel(coarse: NDArray[np.float32], between: NDArray[np.float32]) -> None:
    """Lay the ground of a tile between the middles of its cells.

    Parameters
    ----------
    coarse : (18, 18) float32
        With a cell around.
    """
    per = between.shape[0] // (coarse.shape[0] - 2)
    for i in range(between.shape[0]):
        for j in range(between.shape[1]):
            east, north = (i + 0.5) / per + 0.5, (j + 0.5) / per + 0.5
            own = coarse[i // per + 1, j // per + 1]
            a, b = int(east), int(north)
            total = weight = 0.0
            for u in range(2):
                for v in range(2):
                    height = coarse[a + u, b + v]
                    share = (1 - abs(east - (a + u))) * (1 - abs(north - (b + v)))
                    if abs(height - own) <= _MOST_STEP_M:
                        total += share * height
                        weight += share
            between[i, j] = total / weight if weight > 0 else own


@kernel
def raise_kernel(
    local: Floats,
    is_noise: NDArray[np.bool_],
    table: NDArray[np.int32],
    ground: NDArray[np.float32],
    slabs: NDArray[np.uint32],
) -> None:
    """Mark at which heights cells hold points."""
    for point in range(len(local)):
        if is_noise[point]:
            continue
        cell = cell_of(local[point, 0], local[point, 1], table, FINE)
        if cell < 0:
            continue
        tile, i, j = cell // (FINE * FINE), cell // FINE % FINE, cell % FINE
        height = local[point, 2] - ground[(tile * TILE + i // 2) * TILE + j // 2] - LOWEST_M
        # Comparisons with NaN are false.
        if 0.0 <= height < SLABS * SLAB_M:
            slabs[cell] |= np.uint32(1) << np.uint32(height / SLAB_M)
        elif -2 * LOWEST_M <= height < 0.0:
            slabs[cell] |= GROUND_BIT
