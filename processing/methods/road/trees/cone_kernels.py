"""The leaning, tapering, oval body through the points of a stem: the loops.

A body has eight numbers: east and north of its axis 1.2 m above the foot, how far that moves in a
metre of height, radius, what that gains in a metre, and how far from round it is (cosine and sine
of the doubled direction).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

NUMBERS = 8

TOLERANCE_M = 0.012
"""First tolerance, before the noise is known: three times the 4 mm of usual scanners."""

EVEN_NOISE_M = 1.4826 * TOLERANCE_M / 2
"""What is told of the noise where points fill the tolerance about a stem evenly."""

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

CAPTURED_M = 0.06
"""Off a stem's surface: passes lie so far apart where satellites are hidden for a minute."""

FREE_SLAB_M, _FREE_FROM_M, _FREE_TO_M, _FREE_SHARE = 0.2, 0.03, 0.15, 0.15
"""Slabs in which a stem is looked at; between which distances from its surface nothing lies where
it stands free, beyond bark and noise and nearer than most of what stands beside; and points there
over those on it: along a wall there are as many."""

_ONE_SIDE = 3
"""Sectors that hold a stake or another stem a hand's breadth away."""

_APART_M = 0.03
"""Standard deviation of how far drives lie apart, by which shifts are held where few points of a
drive tell them; passes in towns differ by 2 to 5 cm."""

_SHRINKS, _APART_TURNS = 0.7, 10
"""The tolerance of each step over that of the one before, until it is `TOLERANCE_M`; steps of the
fit, of which the last six have it."""


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
    for i in range(len(normal)):
        for j in range(i):
            normal[j, i] = normal[i, j]
    for i in range(NUMBERS):
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
def scatter_kernel(local: Floats, body: Floats, near: NDArray[np.bool_]) -> float:
    """How far some points lie off a body, m."""
    row = np.empty(NUMBERS)
    square, count = 0.0, 0
    for point in range(len(local)):
        if near[point]:
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


@kernel
def free_slabs_kernel(
    points: Floats, breast_m: float, body: Floats, heights: tuple[float, float]
) -> int:
    """In how many slabs of a body hardly any points lie beside those that lie on it.

    What lies on one side, in an eighth of the circle, doesn't count: it is a stake or a stem.

    Parameters
    ----------
    points : (n, 3) float64
        m about the foot.
    breast_m : float
        The height about which the body is told.
    heights : (float, float)
        From where to where it is asked, m above the foot.
    """
    slabs = max(1, int((heights[1] - heights[0]) / FREE_SLAB_M))
    on, beside = np.zeros(slabs, np.int64), np.zeros((slabs, _SECTORS), np.int64)
    row, local = np.empty(NUMBERS), np.empty((1, 3))
    for point in range(len(points)):
        slab = math.floor((points[point, 2] - heights[0]) / FREE_SLAB_M)
        if not 0 <= slab < slabs:
            continue
        local[0] = points[point]
        local[0, 2] -= breast_m
        off = off_of(local, 0, body, row)
        if abs(off) <= TOLERANCE_M:
            on[slab] += 1
        elif _FREE_FROM_M < off < _FREE_TO_M:
            side = int((math.atan2(-row[1], -row[0]) / math.pi + 1) / 2 * _SECTORS)
            beside[slab, min(side, _SECTORS - 1)] += 1
    free = 0
    for slab in range(slabs):
        most = 0
        for side in range(_SECTORS):
            one_side = 0
            for near in range(_ONE_SIDE):
                one_side += beside[slab, (side + near) % _SECTORS]
            most = max(most, one_side)
        if on[slab] > 0 and beside[slab].sum() - most <= _FREE_SHARE * on[slab]:
            free += 1
    return free


@kernel
def apart_kernel(
    local: Floats, numbers: tuple[Integers, Integers], shape_m: float, body: Floats, shifts: Floats
) -> float:
    """Fit a body and how far the points of each drive lie aside of it together.

    Parameters
    ----------
    numbers : (drive of each point, shift of each drive)
        (n,) and (drives,) int64; −1: a drive has none.
    body : (8,) float64
        Where it begins; where it ends is written.
    shifts : (drives, 2) float64
        m to the east and north. Written.

    Returns
    -------
    float
        How much lies on the body: 1 for a point on it, less for one beside it.
    """
    drive, shift = numbers
    size = NUMBERS + 2 * (int(shift.max()) + 1)
    moved, tolerance = local.copy(), CAPTURED_M
    for _ in range(_APART_TURNS):
        normal, right = np.zeros((size, size)), np.zeros(size)
        on, square = _add_rows(moved, numbers, tolerance, body, (normal, right))
        if on < size:
            return 0.0
        spread = max(LEAST_NOISE_M, math.sqrt(square / on))
        _hold(body, spread, shape_m, on, normal, right)
        for one in range(shift.size):
            for axis in range(2 if shift[one] >= 0 else 0):
                at = NUMBERS + 2 * shift[one] + axis
                normal[at, at] += (spread / _APART_M) ** 2
                right[at] -= (spread / _APART_M) ** 2 * shifts[one, axis]
        step = np.linalg.solve(normal, right)
        body += step[:NUMBERS]
        for one in range(shift.size):
            if shift[one] >= 0:
                at = NUMBERS + 2 * shift[one]
                shifts[one] += step[at : at + 2]
        for point in range(len(local)):
            moved[point, 0] = local[point, 0] - shifts[drive[point], 0]
            moved[point, 1] = local[point, 1] - shifts[drive[point], 1]
        tolerance = max(_SHRINKS * tolerance, TOLERANCE_M)
    row, lies = np.empty(NUMBERS), 0.0
    for point in range(len(moved)):
        lies += max(0.0, 1.0 - (off_of(moved, point, body, row) / TOLERANCE_M) ** 2)
    return lies


@kernel
def _add_rows(
    moved: Floats,
    numbers: tuple[Integers, Integers],
    tolerance: float,
    body: Floats,
    equations: tuple[Floats, Floats],
) -> tuple[int, float]:
    """Fill the lower half of normal equations with points near a body; how many, and squares."""
    drive, shift = numbers
    normal, right = equations
    row, columns = np.empty(NUMBERS), np.arange(NUMBERS + 2)
    values = np.empty(NUMBERS + 2)
    on, square = 0, 0.0
    for point in range(len(moved)):
        off = off_of(moved, point, body, row)
        if abs(off) > tolerance:
            continue
        on += 1
        square += off * off
        own = shift[drive[point]]
        values[:NUMBERS] = row
        # Points that lie aside look like an axis that does.
        values[NUMBERS], values[NUMBERS + 1] = row[0], row[1]
        columns[NUMBERS], columns[NUMBERS + 1] = NUMBERS + 2 * own, NUMBERS + 2 * own + 1
        for i in range(NUMBERS + 2 if own >= 0 else NUMBERS):
            right[columns[i]] -= values[i] * off
            for j in range(i + 1):
                normal[columns[i], columns[j]] += values[i] * values[j]
    return on, square
