"""How round a section about an axis is: trunks bend all the way, piers at their corners alone.

A circle can be laid through the corner of a house as through a trunk, most of all where two passes
that lie centimetres apart show each of its walls twice. What tells them apart is how the surface
bends between its points, of each drive by itself: a trunk by one over its radius all the way
round, a pier not at all along its sides and by several times as much at its corners.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

_STEP_DEG, _HALF_DEG = 15.0, 30.0
"""From window to window, and to either side of a window's middle: in 60 degrees a circle stands an
eighth of its radius off its chord, and a side of a square takes up 90."""

_FEWEST = 20
"""Points of one drive in a window."""

_WIDE = 0.7
"""Of the radius that they must span along the surface, of 1.0 in a full window."""

_SURE = 0.35
"""Standard deviation of the bend up to which a window says anything: between none and a circle's
lie three of them."""

_SCATTER = 1 / 20
"""Of the radius off the curve: two fifths of what a circle stands off its chord. Where points
scatter more, which of them count decides the bend."""

_STRAY = 2.5
"""Standard deviations off a window's curve: twigs and shoots before the bark."""

_LEAST_BEND, _MOST_BEND = 0.45, 2.0
"""Bend over that of the circle: bark, knots and roots stay between, a side of a square has 0 and
its corner 2.6 to 4."""

_FEWEST_WINDOWS = 3


def round_share(beside: Floats, radii: Floats, drives: Integers) -> float:
    """The share of a section's windows that bend as a circle does.

    Parameters
    ----------
    beside : (n, 2) float64
        Points about the axis, m.
    radii : (n,) float64
        Of the circle at their heights.
    drives : (n,) int64
        Which drive each is of: between drives there may be a shift.

    Returns
    -------
    float
        0 to 1; NaN where fewer than three windows are told: too few points, or too much noise for
        so thin a thing.
    """
    told = bends = 0
    turn = np.degrees(np.arctan2(beside[:, 1], beside[:, 0]))
    for drive in np.unique(drives):
        mine = np.flatnonzero(drives == drive)
        mine = mine[np.argsort(turn[mine], kind="stable")]
        some, round_ones = _windows_kernel(beside[mine], radii[mine], turn[mine])
        told, bends = told + some, bends + round_ones
    return bends / told if told >= _FEWEST_WINDOWS else math.nan


@kernel
def _windows_kernel(beside: Floats, radii: Floats, turn: Floats) -> tuple[int, int]:
    """How many windows are told, and how many of them bend as a circle; points rise in turn."""
    count = len(turn)
    told = bends = 0
    along, out = np.empty(count), np.empty(count)
    for number in range(int(360.0 / _STEP_DEG)):
        middle = -180.0 + number * _STEP_DEG
        first = np.searchsorted(turn, middle - _HALF_DEG)
        end = np.searchsorted(turn, middle + _HALF_DEG)
        # What goes on beyond half a turn begins again on the other side.
        over = np.searchsorted(turn, middle - _HALF_DEG + 360.0)
        used = 0
        for part in range(2):
            low, high = (first, end) if part == 0 else (over, count)
            for one in range(low, high):
                east, north = beside[one, 0] / radii[one], beside[one, 1] / radii[one]
                cosine, sine = math.cos(math.radians(middle)), math.sin(math.radians(middle))
                along[used] = north * cosine - east * sine
                out[used] = east * cosine + north * sine
                used += 1
        bend = _bend_kernel(along[:used], out[:used])
        if not math.isnan(bend):
            told += 1
            bends += _LEAST_BEND < bend < _MOST_BEND
    return told, bends


@kernel
def _bend_kernel(along: Floats, out: Floats) -> float:
    """Twice the second coefficient of a parabola through points without strays; NaN if unsure."""
    if len(along) < _FEWEST or along.max() - along.min() < _WIDE:
        return math.nan
    is_near = np.ones(len(along), np.bool_)
    curve, spread = np.zeros(3), np.zeros(2)
    for _ in range(2):
        if is_near.sum() < _FEWEST:
            return math.nan
        _parabola_kernel(along, out, is_near, curve, spread)
        for one in range(len(along)):
            off = abs(_off_kernel(curve, along[one], out[one]))
            is_near[one] = is_near[one] and off < _STRAY * max(spread[0], 1e-4)
    is_sure = spread[0] < _SCATTER and 2.0 * spread[1] < _SURE
    return -2.0 * curve[2] if is_sure else math.nan


@kernel
def _parabola_kernel(
    along: Floats, out: Floats, is_near: NDArray[np.bool_], curve: Floats, spread: Floats
) -> None:
    """Write the coefficients, the scatter about them, and the last one's standard deviation."""
    normal, right = np.zeros((3, 3)), np.zeros(3)
    for one in np.flatnonzero(is_near):
        powers = (1.0, along[one], along[one] ** 2)
        for row in range(3):
            right[row] += powers[row] * out[one]
            for column in range(3):
                normal[row, column] += powers[row] * powers[column]
    for row in range(3):
        normal[row, row] += 1e-9
    cofactors = np.linalg.inv(normal)
    curve[:] = cofactors @ right
    square = 0.0
    for one in np.flatnonzero(is_near):
        square += _off_kernel(curve, along[one], out[one]) ** 2
    spread[0] = math.sqrt(square / (is_near.sum() - 3))
    spread[1] = spread[0] * math.sqrt(cofactors[2, 2])


@kernel
def _off_kernel(curve: Floats, along: float, out: float) -> float:
    """How far outside the curve a point lies."""
    off: float = out - curve[0] - along * (curve[1] + along * curve[2])
    return off
