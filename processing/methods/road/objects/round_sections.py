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

_STEP_DEG, _HALF_DEG, _WINDOWS = 15.0, 30.0, 24
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
"""That have to say something."""

_EVENLY = 0.25
"""Share of the windows that scatter no more than noise makes them."""


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
    turn = np.degrees(np.arctan2(beside[:, 1], beside[:, 0]))
    windows = [np.empty((0, 2))]
    for drive in np.unique(drives):
        mine = np.flatnonzero(drives == drive)
        mine = mine[np.argsort(turn[mine], kind="stable")]
        # The first window's points come again after the last one's: a section closes.
        again = mine[turn[mine] < 2 * _HALF_DEG - 180.0]
        turns = np.concatenate([turn[mine], turn[again] + 360.0])
        mine = np.concatenate([mine, again])
        windows.append(np.empty((_WINDOWS, 2)))
        windows_kernel(beside[mine], radii[mine], turns, windows[-1])
    scatters, bends = np.concatenate(windows).T
    if not (scatters < _SCATTER).any():
        return math.nan
    # Noise is alike all round; corners and twigs scatter more in their windows alone.
    if np.quantile(scatters[np.isfinite(scatters)], _EVENLY) > _SCATTER:
        return math.nan
    told = bends[(scatters < _SCATTER) & np.isfinite(bends)]
    if told.size < _FEWEST_WINDOWS:
        return math.nan
    return float(((told > _LEAST_BEND) & (told < _MOST_BEND)).mean())


@kernel
def windows_kernel(beside: Floats, radii: Floats, turns: Floats, windows: Floats) -> None:
    """How far the points of each window scatter about its curve, and how it bends.

    Parameters
    ----------
    beside, radii, turns : (n, 2), (n,), (n,) float64
        Points about the axis, m, the circle's radius at their heights, m, and their direction from
        it, degrees, rising.
    windows : (w, 2) float64
        Gets scatter, of the radius, and bend, over that of the circle; NaN where too few points
        are, and a NaN bend where it is too unsure.
    """
    for number in range(len(windows)):
        middle = number * _STEP_DEG - 180.0 + _HALF_DEG
        first = np.searchsorted(turns, middle - _HALF_DEG)
        end = np.searchsorted(turns, middle + _HALF_DEG)
        cosine, sine = math.cos(math.radians(middle)), math.sin(math.radians(middle))
        east = beside[first:end, 0] / radii[first:end]
        north = beside[first:end, 1] / radii[first:end]
        along, out = north * cosine - east * sine, east * cosine + north * sine
        windows[number] = math.nan
        if end - first >= _FEWEST and along.max() - along.min() >= _WIDE:
            _bend_kernel(along, out, windows[number])


@kernel
def _bend_kernel(along: Floats, out: Floats, window: Floats) -> None:
    """Write the scatter about a parabola through points without strays, and how it bends."""
    is_near = np.ones(len(along), np.bool_)
    curve, spread = np.zeros(3), np.zeros(2)
    for _ in range(2):
        if is_near.sum() < _FEWEST:
            return
        _parabola_kernel(along, out, is_near, curve, spread)
        for one in range(len(along)):
            off = abs(_off_kernel(curve, along[one], out[one]))
            is_near[one] = is_near[one] and off < _STRAY * max(spread[0], 1e-4)
    window[0] = spread[0]
    if 2.0 * spread[1] < _SURE:
        window[1] = -2.0 * curve[2]


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
