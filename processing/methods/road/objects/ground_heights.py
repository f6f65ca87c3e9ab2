"""How high the ground lies under the things beside a road: a coarse map of the lowest points.

It tells the height of a point above the ground to a decimetre or two, which is enough to look for
columns and wires. Where a thing meets the ground exactly is measured about its foot.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, minimum_filter

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.drive_chunks import DriveChunk, chunks_of
from processing.methods.road.objects.opaque_ground import (
    LAYER_M,
    LAYERS,
    cells_below_ground,
)
from processing.methods.road.objects.sparse_plan import (
    CELL_M,
    TILE,
    SparsePlan,
    cell_of,
)
from processing.recording.drive import Drive

GROUND_CELLS = 16
"""Along the side of a tile: 0.8 m wide, so that among the points of a cell are some of the ground
between grass and behind a post."""

GROUND_M = CELL_M * TILE / GROUND_CELLS

_LOWEST = 3
"""The third lowest point of a cell counts: one or two below the ground are mirrored or mixed."""

_STEEPEST = 0.7
"""Rise over run of the steepest bank beside a road: 1 : 1.5 and what its unevenness adds."""

_STEP_M = 0.35
"""m; a curb and the noise of the cell beside it. What rises more from one cell to the next is no
ground, or the top of a wall, whose cells farther in are kept."""

_REACH_CELLS = 4
"""How far lower ground tells that a cell is none: 3.2 m, wider than a vehicle."""

_FILL_CELLS = 8
"""How far the ground is taken from the nearest cell that shows it: 6.4 m, under a hedge or a parked
lorry."""

_EMPTY = 1e9

_MOST_COUNTED = np.iinfo(np.uint16).max


def ground_heights(
    drives: Sequence[Drive], plan: SparsePlan, monitor: Monitor
) -> NDArray[np.float32]:
    """The ground of all cells of drives, see `ground_of_chunks`."""
    return ground_of_chunks(chunks_of(drives, plan.origin, monitor), plan, monitor)


def ground_of_chunks(
    chunks: Iterable[DriveChunk], plan: SparsePlan, monitor: Monitor
) -> NDArray[np.float32]:
    """The ground of all cells.

    Parameters
    ----------
    chunks : iterable of DriveChunk
        Points about the plan's origin.
    plan : SparsePlan
        Gets the tiles of all points.

    Returns
    -------
    (tiles, 16, 16) float32
        m about the origin of the plan; NaN where no ground is near.

    Notes
    -----
    1. Each cell keeps the third lowest of its points.
    2. Cells that lie below a layer which no beam passes are none
       (:mod:`processing.methods.road.objects.opaque_ground`).
    3. A cell is no ground if one within 3.2 m lies lower by more than a bank of 1 : 1.5 and a step
       of 0.35 m: tops of vehicles, hedges, edges of roofs, crowns without ground under them.
    4. Other cells take the ground of the nearest within 6.4 m.
    """
    lowest: NDArray[np.float32] = np.empty((0, GROUND_CELLS, GROUND_CELLS, _LOWEST), np.float32)
    counts: NDArray[np.uint16] = np.zeros((1, GROUND_CELLS, GROUND_CELLS, LAYERS), np.uint16)
    for chunk in chunks:
        plan.add(chunk.local)
        lowest, counts = plan.grown(lowest, _EMPTY), _with_room(counts, len(plan))
        lowest_kernel(
            chunk.local,
            chunk.is_noise,
            plan.table,
            lowest.reshape(-1, _LOWEST),
            counts.reshape(-1, LAYERS),
        )
    third = np.where(lowest[..., -1] < _EMPTY, lowest[..., -1], np.float32(np.inf))
    rises = (_STEP_M, _STEEPEST * GROUND_M)
    third[cells_below_ground(third, counts, plan, rises, monitor)] = np.inf
    ground = np.empty_like(third)

    def fill(tile: int) -> None:
        monitor.check()
        halo = _REACH_CELLS + _FILL_CELLS
        heights = plan.window(third, tile, halo, np.inf)
        ground[tile] = _filled(heights, _are_ground(heights))[halo:-halo, halo:-halo]

    for _ in in_order(fill, range(len(plan))):
        monitor.check()
    return ground


@kernel
def lowest_kernel(
    local: Floats,
    is_noise: NDArray[np.bool_],
    table: NDArray[np.int32],
    lowest: NDArray[np.float32],
    counts: NDArray[np.uint16],
) -> None:
    """Keep the lowest heights of each cell, rising, and count the points of its layers."""
    for point in range(len(local)):
        if is_noise[point]:
            continue
        cell = cell_of(local[point, 0], local[point, 1], table, GROUND_CELLS)
        if cell < 0:
            continue
        height = np.float32(local[point, 2])
        for rank in range(_LOWEST):
            if height < lowest[cell, rank]:
                height, lowest[cell, rank] = lowest[cell, rank], height
        above = local[point, 2] - lowest[cell, _LOWEST - 1]
        layer = math.floor(local[point, 2] / LAYER_M) % LAYERS
        if above < LAYERS * LAYER_M and counts[cell, layer] < _MOST_COUNTED:
            counts[cell, layer] += 1


def _with_room(counts: NDArray[np.uint16], tiles: int) -> NDArray[np.uint16]:
    """Counts of so many tiles or more, doubled whenever they are too few.

    They are copied seldom, since they are large; room that nobody counts in takes no memory.
    """
    if tiles <= len(counts):
        return counts
    more = np.zeros((max(tiles, 2 * len(counts)), *counts.shape[1:]), np.uint16)
    more[: len(counts)] = counts
    return more


def height_of(ground: NDArray[np.float32], plan: SparsePlan, east: float, north: float) -> float:
    """The ground at a place about the origin, m; NaN where none is known."""
    cell = int(cell_of(east, north, plan.table, GROUND_CELLS))
    return float(ground.reshape(-1)[cell]) if cell >= 0 else float("nan")


def _are_ground(heights: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Cells that no nearby ground lies far below."""
    is_ground = np.isfinite(heights)
    side = np.arange(-_REACH_CELLS, _REACH_CELLS + 1)
    away = np.hypot(side[:, None], side[None, :])
    for radius in range(1, _REACH_CELLS + 1):
        ring = (away > radius - 0.5) & (away <= radius + 0.5)
        lower = minimum_filter(heights, footprint=ring, mode="nearest")
        is_ground &= heights <= lower + _STEP_M + _STEEPEST * GROUND_M * radius
    return is_ground


def _filled(heights: NDArray[np.float32], known: NDArray[np.bool_]) -> NDArray[np.float32]:
    if not known.any():
        return np.full_like(heights, np.nan)
    away, nearest = distance_transform_edt(~known, return_indices=True)
    filled = heights[tuple(nearest)]
    filled[away > _FILL_CELLS] = np.nan
    return np.asarray(filled)
