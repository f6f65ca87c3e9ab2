"""Cells whose lowest points lie below the ground: what a street mirrors, and rings of phase.

No beam passes through a road. Where most of what was measured over a cell lies in one thin layer
that the cells around go on, the points below it are of no surface: puddles and windows mirror the
street downwards, and scanners that measure by phase draw rings about themselves.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.road.objects.sparse_plan import SparsePlan

LAYERS = 64
"""Counted over the low points of a cell: 25.6 m, as far as streets are mirrored and rings reach."""

LAYER_M = 0.4
"""Thickness of a layer: the ground of a cell lies in two at most, on a bank of 1 : 1.5 as well."""

_SHARE = 0.5
"""Of the points of a cell in its lowest two layers, from which they tell what its ground is."""

_ASIDE = 2
"""Cells to either side that are asked: 1.6 m, wider than rings. Puddles are asked from their rims
inwards."""

_ROUNDS = 16
"""From the rim of a puddle to its middle 25 m away; a road is no wider."""

_UNKNOWN = math.inf


def cells_below_ground(
    heights: NDArray[np.float32],
    counts: NDArray[np.uint16],
    plan: SparsePlan,
    rises: tuple[float, float],
    monitor: Monitor,
) -> NDArray[np.bool_]:
    """Cells whose low points lie below an opaque ground.

    Parameters
    ----------
    heights : (tiles, c, c) float32
        The low points of cells, m; not finite where too few were measured.
    counts : (tiles, c, c, 64) uint16
        How many points lie in each layer of 0.4 m; which one is the height over 0.4 m, modulo 64.
    rises : (float, float)
        How much ground rises at most between the middles of cells: m, and m for each cell.

    Returns
    -------
    (tiles, c, c) bool

    Notes
    -----
    1. A cell is sure of its height if half of its points lie in its lowest two layers.
    2. Of the others, one that lies below the ground of most sure cells within 1.6 m, and has as
       many points in a layer at their height as below it, is below the ground. It counts as sure of
       the height of the nearest of them when others are asked.
    """
    level = heights.copy()
    sure = np.full(heights.shape, _UNKNOWN, np.float32)
    sure_kernel(level.reshape(-1), counts.reshape(-1, LAYERS), sure.reshape(-1))
    found: NDArray[np.bool_] = np.zeros(heights.shape, np.bool_)
    for _ in range(_ROUNDS):
        added = 0
        for tile in range(len(plan)):
            monitor.check()
            around = plan.window(sure, tile, _ASIDE, _UNKNOWN)
            added += votes_kernel(around, counts[tile], np.array(rises), level[tile], found[tile])
        sure = np.where(found, level, sure)
        if not added:
            break
    return found


@kernel
def sure_kernel(
    level: NDArray[np.float32], counts: NDArray[np.uint16], sure: NDArray[np.float32]
) -> None:
    """Copy the heights of cells of whose points the lowest two layers hold most."""
    for cell in range(level.size):
        if not math.isfinite(level[cell]):
            continue
        first = math.floor(level[cell] / LAYER_M)
        total = 0
        for layer in range(LAYERS):
            total += int(counts[cell, layer])
        low = int(counts[cell, first % LAYERS]) + int(counts[cell, (first + 1) % LAYERS])
        if low >= _SHARE * total:
            sure[cell] = level[cell]


@kernel
def votes_kernel(
    around: NDArray[np.float32],
    counts: NDArray[np.uint16],
    rises: NDArray[np.float64],
    level: NDArray[np.float32],
    found: Flags,
) -> int:
    """Mark cells of a tile, give those below the ground its height, and count these.

    Parameters
    ----------
    around : (c + 4, c + 4) float32
        Heights of cells that are sure of them, those of the tile in the middle.
    """
    added = 0
    for i in range(level.shape[0]):
        for j in range(level.shape[1]):
            low = level[i, j]
            if not math.isfinite(low) or math.isfinite(around[i + _ASIDE, j + _ASIDE]):
                continue
            above, beside, nearest = 0, 0, np.inf
            floor, top, ground = np.inf, -np.inf, low
            for a in range(-_ASIDE, _ASIDE + 1):
                for b in range(-_ASIDE, _ASIDE + 1):
                    away = math.hypot(a, b)
                    height = around[i + _ASIDE + a, j + _ASIDE + b]
                    if not away < _ASIDE + 0.5 or not math.isfinite(height):
                        continue
                    rise = rises[0] + rises[1] * away
                    if height - low <= rise:
                        beside += 1
                        continue
                    above += 1
                    floor, top = min(floor, height - rise), max(top, height + rise)
                    if away < nearest:
                        nearest, ground = away, height
            if above > beside and _is_opaque(counts[i, j], low, floor, top):
                level[i, j] = ground
                found[i, j] = True
                added += 1
    return added


@kernel
def _is_opaque(counts: NDArray[np.uint16], low: float, floor: float, top: float) -> bool:
    """Whether one layer between two heights holds as many points as all below it."""
    first = math.floor(low / LAYER_M)
    last = min(math.floor(top / LAYER_M), first + LAYERS - 2)
    below = 0
    for layer in range(first, last + 1):
        here = int(counts[layer % LAYERS])
        both = here + int(counts[(layer + 1) % LAYERS])
        if layer > first and layer * LAYER_M >= floor - LAYER_M and both >= below:
            return True
        below += here
    return False
