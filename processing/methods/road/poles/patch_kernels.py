"""Patches of what hangs on a shaft: whether they are smooth surfaces, and bulge as mirrors do.

A patch is what one head measured about a point of it: heads see a plate's two sides, which lie
centimetres apart. It grows from the points next to its middle over those that go on smoothly, so
that the post before a plate, or the dish behind a mirror, is no part of it.
"""

from __future__ import annotations

import math

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel

STATE, EAST, NORTH, UP, ASIDE = range(5)
"""What is told of a patch: one of the states; the unit vector in which it bulges; and how far the
shaft's axis stands off its surface, m."""

ROUGH, SMOOTH, BULGING = 0.0, 1.0, 2.0
PATCH_WIDTH = 5

PATCH_M = 0.35
"""Radius of patches whose bulge is told: the smallest mirror has 0.3 m."""

FEWEST = 12
"""Points from which a surface is told."""

_START_M, _MOST_START_M, _STARTED = 0.12, 0.2, 8
"""Radius from which a patch grows, that of sparse ones, and the points that they begin with."""

_GROWN_M = (0.2, 0.28, PATCH_M)

_WIDE_M, _SMOOTH_M, _NEAR_M = 0.06, 0.01, 0.008
"""Standard deviation of a patch's points along its shorter side, and off its surface: lines and
edges tell nothing. How far off a surface that is smoother points still are of it."""

_MOST_OF_IT = 0.6
"""Share of the points about its middle that are of a smooth surface: leaves are so by chance."""

LEAST_RADIUS_M, MOST_RADIUS_M = 0.8, 6.0
"""Radii of curvature of road mirrors: 1.5 to 3.6 m (道路反射鏡設置指針), those of
yards less, and the error of it."""

_SURE = 4.0
"""Standard deviations of a bulge that is none."""


@kernel
def patches_kernel(
    points: Floats, heads: Integers, middles: Integers, lean: Floats, told: Floats
) -> None:
    """Tell what patches are.

    Parameters
    ----------
    points : (n, 3) float64
        m about a shaft's foot.
    heads : (n,) int64
        Which head measured each.
    middles : (k,) int64
        The point that each patch is about.
    lean : (2,) float64
        Of the shaft.
    told : (k, PATCH_WIDTH) float64
        Written.
    """
    near, away = np.empty(len(points), np.int64), np.empty(len(points))
    for patch in range(middles.size):
        middle = middles[patch]
        told[patch] = 0.0
        count = 0
        for point in range(len(points)):
            east = points[point, 0] - points[middle, 0]
            north = points[point, 1] - points[middle, 1]
            up = points[point, 2] - points[middle, 2]
            square = east * east + north * north + up * up
            if square < PATCH_M * PATCH_M and heads[point] == heads[middle]:
                near[count], away[count] = point, math.sqrt(square)
                count += 1
        if count >= FEWEST:
            _grow(points[near[:count]] - points[middle], away[:count], told[patch])
            up = points[middle, 2]
            off = (lean[0] * up - points[middle, 0]) * told[patch, EAST]
            off += (lean[1] * up - points[middle, 1]) * told[patch, NORTH]
            told[patch, ASIDE] = abs(off)


@kernel
def _grow(local: Floats, away: Floats, told: Floats) -> None:
    """Grow a patch from its middle; tell what it is."""
    start = min(max(_START_M, np.sort(away)[_STARTED - 1]), _MOST_START_M)
    axes = _axes_of(local[away <= start])
    flat = local @ axes
    is_on = away <= start
    surface, normal = np.zeros(4), np.zeros((4, 4))
    scatter = _fitted(flat, is_on, surface, normal)
    if scatter > _SMOOTH_M:
        return
    for radius in _GROWN_M:
        tolerance = max(3.0 * scatter, _NEAR_M)
        for point in range(len(flat)):
            off = flat[point, 0] - _height(surface, flat[point, 2], flat[point, 1])
            is_on[point] = away[point] <= radius and abs(off) <= tolerance
        scatter = _fitted(flat, is_on, surface, normal)
    if is_on.sum() < max(_MOST_OF_IT * len(flat), FEWEST) or scatter > _SMOOTH_M:
        return
    if _narrow(flat, is_on) < _WIDE_M:
        return
    bulge = abs(surface[3])
    is_sure = bulge > _SURE * scatter * math.sqrt(np.linalg.inv(normal)[3, 3])
    if is_sure and 2 * bulge >= 1 / LEAST_RADIUS_M:
        return
    told[STATE] = SMOOTH
    looks = axes @ np.array([1.0, -surface[2], -surface[1]])
    looks /= math.sqrt((looks * looks).sum())
    if is_sure and 2 * bulge > 1 / MOST_RADIUS_M:
        told[STATE] = BULGING
        looks *= -np.sign(surface[3])
    told[EAST : UP + 1] = looks


@kernel
def _axes_of(local: Floats) -> Floats:
    """(3, 3) axes of a few points: the normal of their plane first."""
    middle = np.zeros(3)
    for point in range(len(local)):
        middle += local[point] / len(local)
    spread = np.zeros((3, 3))
    for point in range(len(local)):
        for i in range(3):
            for j in range(3):
                spread[i, j] += (local[point, i] - middle[i]) * (local[point, j] - middle[j])
    return np.ascontiguousarray(np.linalg.eigh(spread)[1])


@kernel
def _height(surface: Floats, u: float, v: float) -> float:
    return float(surface[0] + surface[1] * u + surface[2] * v + surface[3] * (u * u + v * v))


@kernel
def _fitted(flat: Floats, is_on: Flags, surface: Floats, normal: Floats) -> float:
    """Least squares; how far the points lie off."""
    normal[:] = 0.0
    right, row = np.zeros(4), np.ones(4)
    count = 0
    for point in range(len(flat)):
        if not is_on[point]:
            continue
        row[1], row[2] = flat[point, 2], flat[point, 1]
        row[3] = row[1] * row[1] + row[2] * row[2]
        count += 1
        for i in range(4):
            right[i] += row[i] * flat[point, 0]
            for j in range(4):
                normal[i, j] += row[i] * row[j]
    for i in range(4):
        normal[i, i] += 1e-9
    surface[:] = np.linalg.solve(normal, right)
    squares = 0.0
    for point in range(len(flat)):
        if is_on[point]:
            off = flat[point, 0] - _height(surface, flat[point, 2], flat[point, 1])
            squares += off * off
    return math.sqrt(squares / max(count - 4, 1))


@kernel
def _narrow(flat: Floats, is_on: Flags) -> float:
    """Standard deviation of points along the shorter side of what they fill."""
    sums = np.zeros(6)
    for point in range(len(flat)):
        if is_on[point]:
            u, v = flat[point, 2], flat[point, 1]
            sums += np.array([1.0, u, v, u * u, u * v, v * v])
    u, v = sums[1] / sums[0], sums[2] / sums[0]
    uu, uv, vv = sums[3] / sums[0] - u * u, sums[4] / sums[0] - u * v, sums[5] / sums[0] - v * v
    return math.sqrt(max((uu + vv) / 2 - math.hypot((uu - vv) / 2, uv), 0.0))
