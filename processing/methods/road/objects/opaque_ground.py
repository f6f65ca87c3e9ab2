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

_FEWEST = 20
"""Points of layers that hold more than any others of a cell, from which they tell it too: under a
crown the ground is denser than leaves."""

_ASIDE = 2
"""Cells to either side that are asked: 1.6 m, wider than rings. Puddles are asked from their rims
inwards."""

_ROUNDS = 16
"""From the rim of a puddle to its middle 25 m away; a road is no wider."""

_FAINT = 0.1
"""Of the points that cells beside have on their ground: so few below it are of no ground that a
beam reached, where nothing of the cell's own shows at that height, as behind a trunk."""

_DEEP = 3
"""Layers that these lie below it, at least: what is nearer may be a ditch that the edge of the road
hides."""

_STRAYS = 0.01
"""Of the points at the height of the ground beside: fewer far below it are mixed or of phase."""

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
    1. A cell is sure of its height if half of its points lie in its lowest two layers, or more than
       in any other two.
    2. Of the others, one that lies below the ground of most sure cells within 1.6 m, and has as
       many points in a layer at their height as below it, is below the ground. It counts as sure of
       the height of the nearest of them when others are asked.
    3. So is one that has hardly any points below it by their measure: stray ones fill the shadow of
       a trunk or a vehicle, where nothing of the ground was seen.
    4. So is one with a hundred times as many points at the height of the nearest sure cell as far
       below it, be that within a bank's rise.
    """
    level = heights.copy()
    sure = np.full(heights.shape, _UNKNOWN, np.float32)
    points = np.zeros(heights.shape, np.float32)
    sure_kernel(level.reshape(-1), counts.reshape(-1, LAYERS), sure.reshape(-1), points.reshape(-1))
    found: NDArray[np.bool_] = np.zeros(heights.shape, np.bool_)
    for _ in range(_ROUNDS):
        added = 0
        for tile in range(len(plan)):
            monitor.check()
            around = plan.window(sure, tile, _ASIDE, _UNKNOWN), plan.window(points, tile, _ASIDE, 0)
            told = level[tile], found[tile], points[tile]
            added += votes_kernel(around, counts[tile], np.array(rises), told)
        sure = np.where(found, level, sure)
        if not added:
            break
    return found


@kernel
def sure_kernel(
    level: NDArray[np.float32],
    counts: NDArray[np.uint16],
    sure: NDArray[np.float32],
    points: NDArray[np.float32],
) -> None:
    """Copy the heights of cells of whose points the lowest two layers hold most, and how many."""
    for cell in range(level.size):
        if not math.isfinite(level[cell]):
            continue
        first = math.floor(level[cell] / LAYER_M)
        total, most = 0, 0
        for layer in range(LAYERS):
            total += int(counts[cell, layer])
            two = int(counts[cell, layer]) + int(counts[cell, (layer + 1) % LAYERS])
            most = max(most, two)
        low = int(counts[cell, first % LAYERS]) + int(counts[cell, (first + 1) % LAYERS])
        if low >= _SHARE * total or (low >= most and low >= _FEWEST):
            sure[cell] = level[cell]
            points[cell] = low


@kernel
def votes_kernel(
    around: tuple[NDArray[np.float32], NDArray[np.float32]],
    counts: NDArray[np.uint16],
    rises: NDArray[np.float64],
    told: tuple[NDArray[np.float32], Flags, NDArray[np.float32]],
) -> int:
    """Mark cells of a tile, give those below the ground its height, and count these.

    Parameters
    ----------
    around : two of (c + 4, c + 4) float32
        Heights of cells that are sure of them, those of the tile in the middle, and how many points
        tell each.
    told : (heights, which are below the ground, points that tell it) of the tile
        Written.
    """
    level, found, shown = told
    added = 0
    for i in range(level.shape[0]):
        for j in range(level.shape[1]):
            low = level[i, j]
            if not math.isfinite(low) or math.isfinite(around[0][i + _ASIDE, j + _ASIDE]):
                continue
            ground = _ground_beside(around, (i, j), low, rises, counts[i, j])
            if not math.isfinite(ground):
                continue
            level[i, j] = ground
            found[i, j] = True
            layer = math.floor(ground / LAYER_M)
            for one in range(layer - 1, layer + 2):
                shown[i, j] += counts[i, j, one % LAYERS]
            added += 1
    return added


@kernel
def _ground_beside(
    around: tuple[NDArray[np.float32], NDArray[np.float32]],
    place: tuple[int, int],
    low: float,
    rises: NDArray[np.float64],
    counts: NDArray[np.uint16],
) -> float:
    """The height of the nearest sure cell above one that is below the ground; NaN if it isn't."""
    above, beside, seen, seeing = 0, 0, 0.0, 0
    nearest, ground, least, level = np.inf, np.nan, np.inf, np.nan
    floor, top = np.inf, -np.inf
    for a in range(2 * _ASIDE + 1):
        for b in range(2 * _ASIDE + 1):
            away = math.hypot(a - _ASIDE, b - _ASIDE)
            height = around[0][place[0] + a, place[1] + b]
            if not away < _ASIDE + 0.5 or not math.isfinite(height):
                continue
            if away < least:
                least, level = away, height
            rise = rises[0] + rises[1] * away
            if height - low <= rise:
                beside += 1
                continue
            above += 1
            points = around[1][place[0] + a, place[1] + b]
            seen += points
            seeing += points > 0
            floor, top = min(floor, height - rise), max(top, height + rise)
            if away < nearest:
                nearest, ground = away, height
    is_below = above > beside and _is_opaque(counts, low, floor, top)
    if above > beside and not is_below:
        under = ground - rises[0] - rises[1] * nearest
        is_below = _is_faint(counts, low, under, seen / max(seeing, 1))
    if is_below:
        return ground
    return level if _are_strays(counts, low, level) else np.nan


@kernel
def _are_strays(counts: NDArray[np.uint16], low: float, level: float) -> bool:
    """Whether hardly any points lie below the height of a cell beside, and nearly all others at it.

    A bank would be seen on its way down.
    """
    if not math.isfinite(level):
        return False
    first, at = math.floor(low / LAYER_M), math.floor(level / LAYER_M)
    if not 2 < at - first < LAYERS:
        return False
    below = 0
    for layer in range(first, at - 1):
        below += int(counts[layer % LAYERS])
    here = 0
    for layer in range(at - 1, at + 2):
        here += int(counts[layer % LAYERS])
    return below < _STRAYS * here


@kernel
def _is_faint(counts: NDArray[np.uint16], low: float, floor: float, usual: float) -> bool:
    """Whether hardly any points lie far below a height, of those that cells beside usually have."""
    first, last = math.floor(low / LAYER_M), math.floor(floor / LAYER_M)
    if last - first < _DEEP or last - first >= LAYERS:
        return False
    below = 0
    for layer in range(first, last):
        below += int(counts[layer % LAYERS])
    return below < _FAINT * usual


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
