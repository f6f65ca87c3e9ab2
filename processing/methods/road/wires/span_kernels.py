"""A wire through points: the loops. Thousands of pieces among leaves are tried and dropped."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel

EAST, NORTH, WAY_EAST, WAY_NORTH, ASIDE, TURN, RISE, SLOPE, BEND, START, END, NOISE = range(12)
"""What is told of a span: its middle and way in plan, m about the plan's origin; how far it lies to
the left of the way there and what it gains in a metre; height, slope and half the second derivative
of height; where it was seen along the way; how far its points lie off it."""

SPAN_WIDTH = 12


class SpanLimits(NamedTuple):
    """What a piece of a wire is.

    ``fewest``, ``long_m``: points and length that tell a direction; ``trim``, ``least_trim_m``:
    times the usual distance, and m, beyond which points are another thing's; ``turns``: steps of
    the fit; ``bend``, ``bend_off``: half the second derivative of usual wires, and how far others
    are off, 1/m; ``noise_m``: no wire is smoother.
    """

    fewest: int
    long_m: float
    trim: float
    least_trim_m: float
    turns: int
    bend: float
    bend_off: float
    noise_m: float


@kernel
def span_kernel(
    local: Floats, lines: Integers, limits: SpanLimits, told: Floats, kept: Flags
) -> bool:
    """Fit a wire to points; whether they are enough and far enough apart.

    Parameters
    ----------
    local : (n, 3) float64
        m about the plan's origin.
    lines : (k,) int64
        Of the points.
    told : (SPAN_WIDTH,) float64
        Written.
    kept : (k,) bool
        Which of them are the wire's. Written.
    """
    count = lines.size
    along, left, off = np.empty(count), np.empty(count), np.zeros(count)
    _measure_along(local, lines, told, along, left)
    kept[:] = True
    if along.max() - along.min() < limits.long_m:
        return False
    for _ in range(limits.turns):
        if not _tells_direction(along, kept, limits):
            return False
        squares, number = 0.0, 0
        for one in range(count):
            if kept[one]:
                squares += off[one] * off[one]
                number += 1
        noise = max(math.sqrt(squares / number), limits.noise_m)
        _fit_sides(along, left, kept, told)
        _fit_heights(local, lines, along, kept, (noise / limits.bend_off) ** 2, limits.bend, told)
        for one in range(count):
            aside = left[one] - told[ASIDE] - told[TURN] * along[one]
            above = local[lines[one], 2] - told[RISE] - told[SLOPE] * along[one]
            off[one] = math.hypot(aside, above - told[BEND] * along[one] * along[one])
        usual = 1.2 * float(np.median(off[kept]))
        most = max(limits.trim * usual, limits.least_trim_m)
        for one in range(count):
            kept[one] = off[one] < most
    told[START], told[END] = along[kept].min(), along[kept].max()
    told[NOISE] = math.sqrt((off[kept] ** 2).mean())
    return True


@kernel
def _measure_along(
    local: Floats, lines: Integers, told: Floats, along: Floats, left: Floats
) -> None:
    """Write the middle and the main way of points, and where they lie along and beside it."""
    east, north = 0.0, 0.0
    for line in lines:
        east += local[line, 0]
        north += local[line, 1]
    told[EAST], told[NORTH] = east / lines.size, north / lines.size
    wide, cross, tall = 0.0, 0.0, 0.0
    for line in lines:
        east, north = local[line, 0] - told[EAST], local[line, 1] - told[NORTH]
        wide += east * east
        cross += east * north
        tall += north * north
    angle = math.atan2(2 * cross, wide - tall) / 2
    told[WAY_EAST], told[WAY_NORTH] = math.cos(angle), math.sin(angle)
    for one in range(lines.size):
        east, north = local[lines[one], 0] - told[EAST], local[lines[one], 1] - told[NORTH]
        along[one] = east * told[WAY_EAST] + north * told[WAY_NORTH]
        left[one] = north * told[WAY_EAST] - east * told[WAY_NORTH]


@kernel
def _tells_direction(along: Floats, kept: Flags, limits: SpanLimits) -> bool:
    low, high, number = math.inf, -math.inf, 0
    for one in range(along.size):
        if kept[one]:
            low, high = min(low, along[one]), max(high, along[one])
            number += 1
    return number >= limits.fewest and high - low >= limits.long_m


@kernel
def _fit_sides(along: Floats, left: Floats, kept: Flags, told: Floats) -> None:
    """The straight line in plan, by least squares."""
    sums = np.zeros(5)
    for one in range(along.size):
        if kept[one]:
            sums[0] += 1.0
            sums[1] += along[one]
            sums[2] += along[one] * along[one]
            sums[3] += left[one]
            sums[4] += left[one] * along[one]
    spread = sums[0] * sums[2] - sums[1] * sums[1]
    told[ASIDE] = (sums[2] * sums[3] - sums[1] * sums[4]) / spread
    told[TURN] = (sums[0] * sums[4] - sums[1] * sums[3]) / spread


@kernel
def _fit_heights(
    local: Floats,
    lines: Integers,
    along: Floats,
    kept: Flags,
    held: float,
    bend: float,
    told: Floats,
) -> None:
    """The parabola upwards, its bend held to what wires have by as much as points leave it open."""
    normal, right = np.zeros((3, 3)), np.zeros(3)
    row = np.ones(3)
    for one in range(along.size):
        if kept[one]:
            row[1], row[2] = along[one], along[one] * along[one]
            for i in range(3):
                right[i] += row[i] * local[lines[one], 2]
                for j in range(3):
                    normal[i, j] += row[i] * row[j]
    normal[2, 2] += held
    right[2] += held * bend
    told[RISE : BEND + 1] = np.linalg.solve(normal, right)
