"""Heights of the road's surface in cells of 0.2 m, along the lines that somebody drove or drew.

What is kept is bounded by the length of the road: cells far from it are none. A cell tells the mean
height of its low points, so that noise is averaged and what stands or hangs above doesn't count.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.objects.drive_chunks import chunks_of
from processing.methods.road.objects.sparse_plan import (
    CELL_M,
    TILE,
    SparsePlan,
    cell_of,
    plan_of,
)
from processing.recording.drive import Drive

REACH_M = 15.0
"""To either side of a line: four lanes and a walk (道路構造令 第5条, 第11条)."""

_ROUND = 8
"""Directions in which tiles are looked for about a line."""

_BELOW_M, _ABOVE_M = 0.02, 0.05
"""About the second lowest point of a cell what else lies on its surface: noise of scanners, and
the fall of a steep road within a cell."""

_EMPTY = np.float32(1e9)
_MOST_COUNTED = np.iinfo(np.uint16).max


class RoadRaster(NamedTuple):
    """The surface about some lines.

    Attributes
    ----------
    plan : SparsePlan
        Tiles within reach of the lines.
    heights : (tiles, 64, 64) float32
        m about the plan's origin; NaN where nothing was measured.
    """

    plan: SparsePlan
    heights: NDArray[np.float32]

    def at(self, places: Floats) -> Floats:
        """Heights of the cells at places: (...) float64 of (..., 2), NaN where none is known."""
        flat = np.ascontiguousarray(places.reshape(-1, 2))
        cells = cells_at(self.plan, flat)
        known = cells >= 0
        found = np.full(len(flat), np.nan)
        found[known] = self.heights.reshape(-1)[cells[known]]
        return found.reshape(places.shape[:-1])


def road_raster(drives: Sequence[Drive], lines: Sequence[Floats], monitor: Monitor) -> RoadRaster:
    """The surface about lines.

    Parameters
    ----------
    lines : sequence of (n, 2) float64
        Plan places a metre or two apart, m, project CRS.

    Raises
    ------
    OutOfRange
        The drives lie too far apart.

    Notes
    -----
    1. Each cell keeps its two lowest points: the lowest may be mirrored or mixed.
    2. What lies from 2 cm below the second lowest to 5 cm above it is the cell's surface.
    """
    plan = plan_of([(drive.info.lowest, drive.info.highest) for drive in drives])
    for line in lines:
        plan.add(_around(line - plan.origin[:2]))
    shape = (len(plan), TILE, TILE)
    lowest = np.full((*shape, 2), _EMPTY, np.float32)
    for chunk in chunks_of(drives, plan.origin, PartMonitor(monitor, 0.0, 0.5)):
        lowest_two_kernel(chunk.local, chunk.is_noise, plan.table, lowest.reshape(-1, 2))
    # A cell with a single point is as high as this.
    base = np.where(lowest[..., 1] < _EMPTY, lowest[..., 1], lowest[..., 0])
    sums, counts = np.zeros(shape, np.float32), np.zeros(shape, np.uint16)
    for chunk in chunks_of(drives, plan.origin, PartMonitor(monitor, 0.5, 1.0)):
        flat = (base.reshape(-1), sums.reshape(-1), counts.reshape(-1))
        low_layer_kernel(chunk.local, chunk.is_noise, plan.table, flat)
    with np.errstate(invalid="ignore", divide="ignore"):
        heights = np.where(counts > 0, base + sums / counts, np.float32(np.nan))
    return RoadRaster(plan, heights.astype(np.float32))


def cells_at(plan: SparsePlan, places: Floats) -> Integers:
    """(n,) int64 the numbers of cells of 0.2 m at places (n, 2); −1 where there is none."""
    cells = np.empty(len(places), np.int64)
    cells_kernel(np.ascontiguousarray(places), plan.table, cells)
    return cells


def middles_of(plan: SparsePlan, cells: Integers) -> Floats:
    """(n, 2) float64 the middles of cells by their numbers, m about the plan's origin."""
    corners = np.empty((len(plan), 2))
    there = np.argwhere(plan.table >= 0)
    corners[plan.table[tuple(there.T)]] = there * (CELL_M * TILE)
    tile, within = cells // (TILE * TILE), cells % (TILE * TILE)
    inner = np.column_stack([within // TILE, within % TILE])
    middles: Floats = corners[tile] + (inner + 0.5) * CELL_M
    return middles


def _around(places: Floats) -> Floats:
    angles = np.arange(_ROUND) * (2 * math.pi / _ROUND)
    steps = np.concatenate([[[0.0, 0.0]], np.column_stack([np.cos(angles), np.sin(angles)])])
    around = places[:, None] + np.concatenate([steps, steps / 2]) * REACH_M
    return np.ascontiguousarray(around.reshape(-1, 2))


@kernel
def cells_kernel(places: Floats, table: NDArray[np.int32], cells: Integers) -> None:
    """The cell of each place."""
    for number in range(len(places)):
        cells[number] = cell_of(places[number, 0], places[number, 1], table, TILE)


@kernel
def lowest_two_kernel(
    local: Floats,
    is_noise: NDArray[np.bool_],
    table: NDArray[np.int32],
    lowest: NDArray[np.float32],
) -> None:
    """Keep the two lowest heights of each cell, rising."""
    for point in range(len(local)):
        if is_noise[point]:
            continue
        cell = cell_of(local[point, 0], local[point, 1], table, TILE)
        if cell < 0:
            continue
        height = np.float32(local[point, 2])
        if height < lowest[cell, 0]:
            height, lowest[cell, 0] = lowest[cell, 0], height
        if height < lowest[cell, 1]:
            lowest[cell, 1] = height


@kernel
def low_layer_kernel(
    local: Floats,
    is_noise: NDArray[np.bool_],
    table: NDArray[np.int32],
    cells: tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.uint16]],
) -> None:
    """Add up how far the points of each cell's surface lie above its base, and count them.

    Parameters
    ----------
    cells : (base, sums, counts), each (cells,)
        The last two written.
    """
    base, sums, counts = cells
    for point in range(len(local)):
        if is_noise[point]:
            continue
        cell = cell_of(local[point, 0], local[point, 1], table, TILE)
        if cell < 0:
            continue
        above = local[point, 2] - base[cell]
        if -_BELOW_M <= above <= _ABOVE_M and counts[cell] < _MOST_COUNTED:
            sums[cell] += np.float32(above)
            counts[cell] += 1
