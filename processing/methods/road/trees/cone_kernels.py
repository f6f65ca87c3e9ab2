"""The leaning, tapering, oval body through the points of a stem: the loops.

A body has eight numbers: east and north of its axis 1.2 m above the foot, how far that moves in a
metre of height, radius, what that gains in a metre, and how far from round it is (cosine and sine
of the doubled direction).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel

NUMBERS = 8

TOLERANCE_M = 0.012
"""First tolerance, before the noise is known: three times the 4 mm of usual scanners."""

LEAST_NOISE_M = 0.002
"""Bark is no smoother."""

_LEAST_TOLERANCE_M = 0.006

MOST_TAPER = 0.06
"""Metres of radius lost in a metre of height: twice the swelling at the foot of old trees."""

OVAL = 0.06
"""Standard deviation of half the difference of a trunk's two diameters, as a share of their mean:
trunks of street trees are seldom wider one way than the other by more than a quarter."""

_LEAN, _TAPER = 0.1, 0.02
"""Standard deviations of lean and taper of trees, by which they are held."""

_FEWEST_POINTS = 8
"""As many as a body has numbers."""

_TURNS = 6
"""Steps of the fit; it ends within four. By trial; no measurement is recorded."""

_SECTORS = 24
"""Of 15 degrees, in which a circumference was seen or not."""


@kernel
def settle_kernel(
    local: Floats, shape_m: float, body: Floats, off: Floats, near: NDArray[np.bool_]
) -> tuple[float, float]:
    """Fit a body to the points near it, step by step (Gauss and Newton).

    Taper, lean and flattening are held to what trees have, by as much as their points leave them
    open: of half a trunk only its far side tells whether it is a circle.

    Parameters
    ----------
    local : (n, 3) float64
        m about the foot, but for the height: about 1.2 m above it.
    shape_m : float
        How far bark and mixed points make the shape seem off, however many there are.
    body : (8,) float64
        Where it begins; where it ends is written.
    off : (n,) float64
        How far each point lies outside the body of the last turn. Written.
    near : (n,) bool
        The points that the last step was made from. Written.

    Returns
    -------
    float, float
        Standard deviation of the radius, and how far its points lie off it, m; negative where too
        few points are near.
    """
    tolerance, deviation, noise = TOLERANCE_M, -1.0, -1.0
    row = np.empty(NUMBERS)
    for _ in range(_TURNS):
        normal, right = np.zeros((NUMBERS, NUMBERS)), np.zeros(NUMBERS)
        count, square = 0, 0.0
        for point in range(len(local)):
            off[point] = off_of(local, point, body, row)
            near[point] = abs(off[point]) <= tolerance
            if near[point]:
                count += 1
                square += off[point] ** 2
                for i in range(NUMBERS):
                    right[i] -= row[i] * off[point]
                    for j in range(i + 1):
                        normal[i, j] += row[i] * row[j]
        if count < _FEWEST_POINTS:
            return -1.0, -1.0
        spread = max(LEAST_NOISE_M, math.sqrt(square / count))
        _hold(body, spread, shape_m, count, normal, right)
        step = np.linalg.solve(normal, right)
        body += step
        body[5] = min(max(body[5], -MOST_TAPER), MOST_TAPER)
        deviation = spread * math.sqrt(max(np.linalg.inv(normal)[4, 4], 0.0))
        noise = max(LEAST_NOISE_M, 1.4826 * np.median(np.abs(off[near])))
        tolerance = min(max(3.0 * noise, _LEAST_TOLERANCE_M), TOLERANCE_M)
    return deviation, noise


@kernel
def _hold(
    body: Floats, spread: float, shape_m: float, count: int, normal: Floats, right: Floats
) -> None:
    """Hold lean, taper and flattening, and fill the other half of the normal equations."""
    oval = OVAL * abs(body[4])
    for i in range(NUMBERS):
        for j in range(i):
            normal[j, i] = normal[i, j]
        weight = 0.0
        if i in (2, 3):
            weight = (spread / _LEAN) ** 2
        elif i == 5:
            weight = (spread / _TAPER) ** 2
        elif i > 5:
            weight = (spread / oval) ** 2 + count * (shape_m / oval) ** 2
        normal[i, i] += weight + 1e-9
        right[i] -= weight * body[i]


@kernel
def off_of(local: Floats, point: int, body: Floats, row: Floats) -> float:
    """How far a point lies outside a body, and how that changes with its eight numbers."""
    up = local[point, 2]
    east = local[point, 0] - body[0] - body[2] * up
    north = local[point, 1] - body[1] - body[3] * up
    away = max(math.hypot(east, north), 1e-6)
    east, north = east / away, north / away
    row[0], row[1] = -east, -north
    row[2], row[3] = -east * up, -north * up
    row[4], row[5] = -1.0, -up
    row[6], row[7] = north * north - east * east, -2 * east * north
    return float(away - body[4] - body[5] * up + row[6] * body[6] + row[7] * body[7])


@kernel
def scatter_kernel(
    local: Floats, body: Floats, near: NDArray[np.bool_], other: NDArray[np.bool_]
) -> float:
    """How far the points of either of two bodies lie off one, m."""
    row = np.empty(NUMBERS)
    square, count = 0.0, 0
    for point in range(len(local)):
        if near[point] or other[point]:
            square += min(abs(off_of(local, point, body, row)), TOLERANCE_M) ** 2
            count += 1
    return math.sqrt(square / max(count, 1))


@kernel
def arc_kernel(local: Floats, body: Floats, near: NDArray[np.bool_]) -> float:
    """Share of the circumference that has points."""
    seen = np.zeros(_SECTORS, np.bool_)
    for point in range(len(local)):
        if near[point]:
            east = local[point, 0] - body[0] - body[2] * local[point, 2]
            north = local[point, 1] - body[1] - body[3] * local[point, 2]
            sector = int((math.atan2(north, east) / math.pi + 1) / 2 * _SECTORS)
            seen[min(sector, _SECTORS - 1)] = True
    return float(seen.sum() / _SECTORS)
