"""The steep line along a shaft's surface, on which the most heights have points: the loops.

It is drawn through two of the points, heights first, since plates and twigs have more points than
posts, and straightened by least squares.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel

SLAB_M = 0.1
"""Height of a slab: scan lines of a slow vehicle are no farther apart on an upright thing."""

MOST_SLABS = 160
"""16 m: the tallest poles beside a road."""

_LINES = 160
"""Of two points each: with a seventh of the points on the shaft nine pairs in ten miss it, and one
of these is good all the same in all but one case in a million."""

RISE = 0.25
"""Between the two points of a line, of the height of all: nearer ones leave its lean open."""

_MOST_DRAWN = 500
"""Points that tell one line from another: enough for ten in each of fifty slabs."""

_FACTOR, _INCREMENT, _MODULUS = 1_664_525, 1_013_904_223, 1 << 32
"""Of the generator of draws (Press et al., Numerical Recipes, 7.1): the same ones each time."""

ON_LINE_M = 0.015
"""How far a point may lie off a line along the surface: three times the noise of usual scanners."""

_MOST_OF_SLAB = 3.0
"""Points that a slab may say for a line."""


class ShaftLimits(NamedTuple):
    """What a shaft may be.

    ``least_m``, ``most_m``: radius; ``steepest``: run over rise of its lean; ``low_m``,
    ``high_m``: between which heights it is looked for first; ``gap_m``: how far it may be hidden;
    ``noise_m``: how far points may lie off it.
    """

    least_m: float
    most_m: float
    steepest: float
    low_m: float
    high_m: float
    gap_m: float
    noise_m: float


@kernel
def drawn_points(points: Floats, is_left: Flags, limits: ShaftLimits) -> Integers:
    """Points between the first heights, evenly thinned."""
    count = 0
    for point in range(len(points)):
        count += is_left[point] and limits.low_m <= points[point, 2] <= limits.high_m
    step = count // _MOST_DRAWN + 1
    drawn = np.empty(count // step + 1, np.int64)
    kept, number = 0, 0
    for point in range(len(points)):
        if is_left[point] and limits.low_m <= points[point, 2] <= limits.high_m:
            if number % step == 0:
                drawn[kept] = point
                kept += 1
            number += 1
    return drawn[:kept]


@kernel
def surface_line(points: Floats, drawn: Integers, limits: ShaftLimits, line: Floats) -> int:
    """The steep line that the most slabs have points on: place at height 0 and lean; how many."""
    best, state = 0.0, 1
    guess = np.zeros(4)
    starts = np.zeros(MOST_SLABS + 1, np.int64)
    ordered = _by_slab(points, drawn, starts)
    near = np.ascontiguousarray(points[ordered].T)
    filled = np.flatnonzero(starts[1:] > starts[:-1])
    if filled.size < 2:
        return 0
    least = max(2 * SLAB_M, RISE * SLAB_M * (filled[-1] - filled[0]))
    for _ in range(_LINES):
        # Slabs first, then points: plates have more of these than posts.
        state = (state * _FACTOR + _INCREMENT) % _MODULUS
        slab = filled[state * filled.size // _MODULUS]
        state = (state * _FACTOR + _INCREMENT) % _MODULUS
        a = ordered[starts[slab] + state * (starts[slab + 1] - starts[slab]) // _MODULUS]
        state = (state * _FACTOR + _INCREMENT) % _MODULUS
        slab = filled[state * filled.size // _MODULUS]
        state = (state * _FACTOR + _INCREMENT) % _MODULUS
        b = ordered[starts[slab] + state * (starts[slab + 1] - starts[slab]) // _MODULUS]
        rise = points[b, 2] - points[a, 2]
        if abs(rise) < least:
            continue
        guess[2] = (points[b, 0] - points[a, 0]) / rise
        guess[3] = (points[b, 1] - points[a, 1]) / rise
        lean = math.hypot(guess[2], guess[3]) / limits.steepest
        if lean > 1.0:
            continue
        guess[0] = points[a, 0] - guess[2] * points[a, 2]
        guess[1] = points[a, 1] - guess[3] * points[a, 2]
        # Most poles are upright; along a thick one many lines are as good.
        score = _on_line(near, starts, guess)[0] * (1.0 - lean)
        if score > best:
            best = score
            line[:] = guess
    if best == 0.0:
        return 0
    for _ in range(2):
        _straighten(points, drawn, line)
    return _on_line(near, starts, line)[1]


@kernel
def _by_slab(points: Floats, drawn: Integers, starts: Integers) -> Integers:
    """The drawn points slab after slab; where each begins is written."""
    starts[:] = 0
    for point in drawn:
        starts[int(points[point, 2] / SLAB_M) + 1] += 1
    for slab in range(MOST_SLABS):
        starts[slab + 1] += starts[slab]
    free, ordered = starts.copy(), np.empty_like(drawn)
    for point in drawn:
        slab = int(points[point, 2] / SLAB_M)
        ordered[free[slab]] = point
        free[slab] += 1
    return ordered


@kernel
def _on_line(near: Floats, starts: Integers, line: Floats) -> tuple[float, int]:
    """How much speaks for a line, and how many slabs have points on it.

    Each slab speaks as much as its points are near, `_MOST_OF_SLAB` at most.

    Parameters
    ----------
    near : (3, n) float64
        The drawn points, slab after slab.
    starts : (MOST_SLABS + 1,) int64
    """
    score, slabs = 0.0, 0
    for slab in range(MOST_SLABS):
        on = 0.0
        for point in range(starts[slab], starts[slab + 1]):
            east = near[0, point] - line[0] - line[2] * near[2, point]
            north = near[1, point] - line[1] - line[3] * near[2, point]
            off = (east * east + north * north) / (ON_LINE_M * ON_LINE_M)
            on += max(1.0 - off, 0.0)
        score += min(on, _MOST_OF_SLAB)
        slabs += on > 0.0
    return score, slabs


@kernel
def _straighten(points: Floats, drawn: Integers, line: Floats) -> None:
    """Least squares through the points on a line, each the less the more its slab has."""
    count = np.zeros(MOST_SLABS)
    for step in range(2):
        sums = np.zeros(7)
        for point in drawn:
            up = points[point, 2]
            east = points[point, 0] - line[0] - line[2] * up
            north = points[point, 1] - line[1] - line[3] * up
            if east * east + north * north > ON_LINE_M * ON_LINE_M:
                continue
            slab = int(up / SLAB_M)
            if step == 0:
                count[slab] += 1.0
                continue
            weight = 1.0 / count[slab]
            sums[0] += weight
            sums[1] += weight * up
            sums[2] += weight * up * up
            sums[3] += weight * east
            sums[4] += weight * east * up
            sums[5] += weight * north
            sums[6] += weight * north * up
    spread = sums[0] * sums[2] - sums[1] * sums[1]
    if spread <= 1e-6:
        return
    line[0] += (sums[2] * sums[3] - sums[1] * sums[4]) / spread
    line[2] += (sums[0] * sums[4] - sums[1] * sums[3]) / spread
    line[1] += (sums[2] * sums[5] - sums[1] * sums[6]) / spread
    line[3] += (sums[0] * sums[6] - sums[1] * sums[5]) / spread


@kernel
def strike(points: Floats, line: Floats, is_left: Flags) -> None:
    """Take the points on a line out of those that others are drawn from."""
    for point in range(len(points)):
        up = points[point, 2]
        east = points[point, 0] - line[0] - line[2] * up
        north = points[point, 1] - line[1] - line[3] * up
        if east * east + north * north < ON_LINE_M * ON_LINE_M:
            is_left[point] = False
