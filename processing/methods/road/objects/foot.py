"""Where the ground lies about the foot of a column, to a centimetre or two."""

from __future__ import annotations

import math

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

_RINGS_M = (0.03, 0.15, 0.3, 0.5, 0.9)
"""Edges of rings about the column's surface: soil is heaped up about trunks, so the nearest ring
tells most, but it may hold only grass and shoots."""

_HEAP = 0.15
"""Rise over run at which the ground may rise towards a column: soil in a tree pit."""

_ABOUT_M = 0.5
"""How far the ground there may be off the coarse map: a curb, a tree pit, the map's own error."""

_SECTORS = 8
"""Of 45 degrees: each tells its own height, so that grass or a curb on one side don't count."""

_LEAST_SECTORS, _FEWEST = 3, 3
"""Of a ring that tells a height, and points of a sector: a column hides what lies behind it."""

_LOW_SHARE = 0.1
"""Of a sector's points: what lies higher is grass, leaves and things."""


_LAYER_M, _HIGHEST_M = 0.1, 3.0
"""Layers in which points about a column are counted, and how far above the coarse ground."""

_MIRRORED = 0.05
"""Of the points of the fullest layer: windows and wet roads mirror few beams, and the ground beside
a hedge, which hides some of it, holds more."""

_EMPTY, _FEW = 3, 0.3
"""Layers that hold hardly anything between the ground and what it mirrors, where that is more: a
hedge and a trunk fill them; and share of the ground's points that lie below them."""

_LEAST_RISE_M, _LEAST_FALL_M, _LOWEST_M = 0.5, 0.3, 1.0
"""What lies less above or below the ground isn't looked for: gutters and tree pits have such steps;
and how far below it is looked for."""

_PLAN_CELL_M, _STANDING, _WIDER = 0.15, 8, 1.5
"""Cells of the plan that are counted; layers above the ground that hold what stands on it; and how
many times as many cells ground fills: a trunk fills as many in each layer, a ring of rails too."""


_BIN_M, _DOWN_M, _UP_M = 0.05, 0.5, 1.0
"""In layers of two bins the ground about a column is looked for, so far below and above the coarse
map: beside an open gutter or a step that holds what lies deepest within 0.8 m."""

_FROM_M, _TO_M = 0.1, 0.6
"""Ring about a column's middle that shows its ground: beyond itself, nearer than gutters are
wide."""

_DEEPER = 0.3
"""Of a layer's points, so many below it that the ground is deeper: the bottom of a gutter has few
points at most, what grass, hedges and steps stand on has more."""


@kernel
def ground_beside_kernel(
    points: Floats, starts: Integers, middles: Floats, coarse: Floats, ground: Floats
) -> None:
    """The ground that was seen about each column; the coarse one where it tells nothing clear.

    Parameters
    ----------
    points : (n, 3) float64
        m about any origin, column after column.
    starts : (k + 1,) int64
    middles : (k, 2) float64
        Of the columns, about the same.
    coarse : (k,) float64
        The ground of the coarse map, about the same.
    ground : (k,) float64
        Written.

    Notes
    -----
    In each sector it is the layer of a decimetre with the most points that has few below it; of the
    sectors the middle one tells it, the upper of two: a post stands beside a gutter, not in it.
    Where all of them together show much below, as in hedges and at steps, the coarse map is asked.
    """
    bins = int((_DOWN_M + _UP_M) / _BIN_M)
    counts = np.zeros((_SECTORS, bins), np.int64)
    levels = np.empty(_SECTORS)
    for column in range(len(middles)):
        counts[:] = 0
        lowest = coarse[column] - _DOWN_M
        for point in range(starts[column], starts[column + 1]):
            level = math.floor((points[point, 2] - lowest) / _BIN_M)
            east = points[point, 0] - middles[column, 0]
            north = points[point, 1] - middles[column, 1]
            away = math.hypot(east, north)
            if 0 <= level < bins and _FROM_M <= away < _TO_M:
                sector = int((math.atan2(north, east) / math.pi + 1) / 2 * _SECTORS) % _SECTORS
                counts[sector, level] += 1
        known = 0
        for sector in range(_SECTORS):
            levels[known] = _ground_level(counts[sector])
            known += levels[known] >= 0.0
        ground[column] = coarse[column]
        if known >= _LEAST_SECTORS:
            told = np.sort(levels[:known])[known // 2]
            if _is_lowest(counts.sum(axis=0), int(told)):
                ground[column] = lowest + _BIN_M * told


@kernel
def _is_lowest(counts: Integers, level: int) -> bool:
    """Whether few points lie below a layer of two decimetres."""
    low = max(level - 2, 0)
    return bool(counts[:low].sum() <= _DEEPER * counts[low : level + 2].sum())


@kernel
def _ground_level(counts: Integers) -> float:
    """The middle of the layer that is ground, in bins; −1: of none."""
    layers = counts[:-1] + counts[1:]
    best = int(layers.argmax())
    if layers[best] < _FEWEST:
        return -1.0
    while best > 1 and counts[: best - 1].sum() > _DEEPER * layers[best]:
        best = int(layers[: best - 1].argmax())
    return best + 0.5 + float(counts[best + 1]) / float(layers[best])


def ground_seen(points: Floats, coarse_m: float) -> float:
    """The ground of the coarse map, or what lies above or below it where that is off.

    Parameters
    ----------
    points : (n, 3) float64
        About a column, m about any origin.
    coarse_m : float
        The ground of the coarse map, about the same.

    Notes
    -----
    The coarse map may hold a few mirrored points, or what hides the ground from most sides. What
    lies above or below is ground if it takes up more room in plan than what stands on it: where
    rails and walls hide the ground, the lowest that was seen is the trunk itself.
    """
    layers = round((_HIGHEST_M + _LOWEST_M) / _LAYER_M)
    lowest = coarse_m - _LOWEST_M
    layer = np.floor((points[:, 2] - lowest) / _LAYER_M).astype(np.int64)
    is_asked = (layer >= 0) & (layer < layers)
    counts = np.bincount(layer[is_asked], minlength=layers)
    filled = np.flatnonzero(counts > _MIRRORED * counts.max(initial=0))
    if not filled.size:
        return coarse_m
    first = _above_images(counts, filled)
    seen = lowest + (float(first) + 0.5) * _LAYER_M
    is_near = coarse_m - _LEAST_FALL_M <= seen <= coarse_m + _LEAST_RISE_M
    if first == filled[0] and is_near:
        return coarse_m
    cells = np.floor(points[is_asked, :2] / _PLAN_CELL_M).astype(np.int64)
    places = np.unique(np.column_stack([layer[is_asked], cells]), axis=0)
    room = np.bincount(places[:, 0], minlength=layers)
    above = room[first + 2 : first + 2 + _STANDING]
    is_ground = above.size > 0 and room[first] > _WIDER * above.max()
    return seen if is_ground else coarse_m


def _above_images(counts: Integers, filled: Integers) -> int:
    """The lowest of the filled layers that isn't far below one that holds many times as much."""
    gaps = np.flatnonzero(np.diff(filled) > _EMPTY)
    if gaps.size:
        upper = int(filled[gaps[0] + 1])
        if counts[:upper].sum() < _FEW * counts[upper : upper + 2].sum():
            return upper
    return int(filled[0])


def foot_height(points: Floats, axis: Floats, coarse_m: float, radius_m: float = 0.0) -> float:
    """Height of the ground about an axis.

    Parameters
    ----------
    points : (n, 3) float64
        m about any origin.
    axis : (2,) float64
        Of the column near its foot, about the same.
    coarse_m : float
        The ground of the coarse map.
    radius_m : float
        Of the column.

    Returns
    -------
    float
        The lowest of what rings about the column tell, each the median over sectors of their low
        points, raised by what soil may be heaped up; ``coarse_m`` where none was measured.
    """
    told = told_kernel(points, axis, coarse_m, radius_m)
    return coarse_m if np.isnan(told) else told


@kernel
def told_kernel(points: Floats, axis: Floats, coarse_m: float, radius_m: float) -> float:
    """The lowest of what the rings tell; NaN where none does."""
    rings = len(_RINGS_M) - 1
    groups = np.full(len(points), -1, np.int64)
    counts = np.zeros((rings, _SECTORS), np.int64)
    for point in range(len(points)):
        east, north = points[point, 0] - axis[0], points[point, 1] - axis[1]
        away = math.hypot(east, north) - radius_m
        if abs(points[point, 2] - coarse_m) >= _ABOUT_M or away >= _RINGS_M[rings]:
            continue
        ring = -1
        while ring + 1 < rings and away >= _RINGS_M[ring + 1]:
            ring += 1
        if ring >= 0:
            sector = int((math.atan2(north, east) / math.pi + 1) / 2 * _SECTORS) % _SECTORS
            groups[point] = ring * _SECTORS + sector
            counts[ring, sector] += 1
    best = np.nan
    lows = np.empty(_SECTORS)
    for ring in range(rings):
        known = 0
        for sector in range(_SECTORS):
            if counts[ring, sector] >= _FEWEST:
                heights = points[groups == ring * _SECTORS + sector, 2]
                lows[known] = np.quantile(heights, _LOW_SHARE)
                known += 1
        if known >= _LEAST_SECTORS:
            middle = (_RINGS_M[ring] + _RINGS_M[ring + 1]) / 2
            height = np.median(lows[:known]) + _HEAP * middle
            if not height >= best:
                best = height
    return float(best)
