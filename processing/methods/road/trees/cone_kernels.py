"""The leaning, tapering, oval, bent body through the points of a stem: the loops.

A body has ten numbers: east and north of its axis 1.2 m above the foot, how far that moves there in
a metre of height, radius, what that gains in a metre, how far from round it is (cosine and sine
of the doubled direction), and how far to the east and north the axis bends off its tangent a metre
above and below. A body that begins straight stays so.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

NUMBERS = 10

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

_LEAN, _TAPER, _BEND_M = 0.1, 0.02, 0.05
"""Standard deviations of lean, taper and bend (m off the tangent in a metre) of trees, by which
they are held: slender stems of one tree curve out by 0.1 m in a metre and a half."""

_STRAIGHT_M = 1e-9
"""The same of an axis that is not to bend."""

_FEWEST_POINTS = 8
"""As many as a straight body has numbers."""

_HALF_SEEN = 2.0 / math.pi
"""How far the mean of directions to the points of half a circle lies from its middle."""

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

_FEWEST_OF_SLAB = 5
"""Points of a slab that tell which sides of a stem it shows."""

_ONE_SIDE = 3
"""Sectors that hold a stake or another stem a hand's breadth away."""

_APART_M = 0.03
"""Standard deviation of how far drives lie apart, by which shifts are held where few points of a
drive tell them; passes in towns differ by 2 to 5 cm."""

_STEPS_M = (0.02, 0.005)
"""From place to place that is asked; the first finds what half the tolerance catches."""

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
    body : (10,) float64
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
    row, bend_m = np.empty(NUMBERS), _bend_m(body)
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
        _hold(body, bend_m, (spread, shape_m, count), normal, right)
        body += np.linalg.solve(normal, right)
        if bend_m == _STRAIGHT_M:
            body[8:10] = 0.0
        body[5] = min(max(body[5], -MOST_TAPER), MOST_TAPER)
        deviation = spread * math.sqrt(max(np.linalg.inv(normal)[4, 4], 0.0))
        noise = max(LEAST_NOISE_M, 1.4826 * np.median(np.abs(off[near])))
        tolerance = min(max(3.0 * noise, _LEAST_TOLERANCE_M), TOLERANCE_M)
    return deviation, noise


@kernel
def _bend_m(body: Floats) -> float:
    """How far an axis may bend: one that begins straight stays so."""
    return _BEND_M if body[8] != 0.0 or body[9] != 0.0 else _STRAIGHT_M


@kernel
def _hold(
    body: Floats,
    bend_m: float,
    found: tuple[float, float, int],
    normal: Floats,
    right: Floats,
) -> None:
    """Hold lean, taper, flattening and bend, and fill the other half of the normal equations.

    Parameters
    ----------
    found : (float, float, int)
        How far points lie off the body, how far bark makes its shape seem off, and how many points.
    """
    spread, shape_m, count = found
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
        elif i > 7:
            weight = (spread / bend_m) ** 2
        elif i > 5:
            weight = (spread / oval) ** 2 + count * (shape_m / oval) ** 2
        normal[i, i] += weight + 1e-9
        right[i] -= weight * body[i]


@kernel
def off_of(local: Floats, point: int, body: Floats, row: Floats) -> float:
    """How far a point lies outside a body, and how that changes with its numbers."""
    up = local[point, 2]
    east = local[point, 0] - body[0] - (body[2] + body[8] * up) * up
    north = local[point, 1] - body[1] - (body[3] + body[9] * up) * up
    away = max(math.hypot(east, north), 1e-6)
    east, north = east / away, north / away
    row[0], row[1] = -east, -north
    row[2], row[3] = -east * up, -north * up
    row[4], row[5] = -1.0, -up
    row[6], row[7] = north * north - east * east, -2 * east * north
    row[8], row[9] = -east * up * up, -north * up * up
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
def speaks_kernel(local: Floats, body: Floats) -> float:
    """How many points lie on a body, less for those beside it, and fewer by those inside it."""
    row, speaks = np.empty(NUMBERS), 0.0
    for point in range(len(local)):
        off = off_of(local, point, body, row) / TOLERANCE_M
        if off < -1.0:
            speaks -= 1.0
        elif off < 1.0:
            speaks += 1.0 - off * off
    return speaks


@kernel
def inside_kernel(local: Floats, body: Floats) -> float:
    """How many points lie inside a body, over those on it."""
    row, on, inside = np.empty(NUMBERS), 0, 0
    for point in range(len(local)):
        off = off_of(local, point, body, row)
        on += abs(off) <= TOLERANCE_M
        inside += off < -TOLERANCE_M
    return inside / max(on, 1)


@kernel
def thinner_kernel(local: Floats, share: float, body: Floats) -> None:
    """Make a body thinner whose surface stays where its points are.

    Parameters
    ----------
    share : float
        Of its radius that is left.
    """
    row = np.empty(NUMBERS)
    east, north, count = 0.0, 0.0, 0
    for point in range(len(local)):
        if abs(off_of(local, point, body, row)) <= TOLERANCE_M:
            east, north, count = east - row[0], north - row[1], count + 1
    # Seen all round, its middle stays.
    away = math.hypot(east, north)
    if away > 0.0:
        moved = (1.0 - share) * body[4] * min(1.0, away / (_HALF_SEEN * count)) / away
        body[0] += moved * east
        body[1] += moved * north
    body[4] *= share


@kernel
def near_kernel(local: Floats, body: Floats) -> NDArray[np.bool_]:
    """Which points lie on a body: (n,) bool."""
    row = np.empty(NUMBERS)
    near = np.empty(len(local), np.bool_)
    for point in range(len(local)):
        near[point] = abs(off_of(local, point, body, row)) <= TOLERANCE_M
    return near


@kernel
def arc_kernel(local: Floats, body: Floats, near: NDArray[np.bool_]) -> float:
    """Share of the circumference that has points."""
    seen = np.zeros(_SECTORS, np.bool_)
    for point in range(len(local)):
        if near[point]:
            up = local[point, 2]
            east = local[point, 0] - body[0] - (body[2] + body[8] * up) * up
            north = local[point, 1] - body[1] - (body[3] + body[9] * up) * up
            sector = int((math.atan2(north, east) / math.pi + 1) / 2 * _SECTORS)
            seen[min(sector, _SECTORS - 1)] = True
    return float(seen.sum() / _SECTORS)


@kernel
def evenness_kernel(local: Floats, body: Floats, near: NDArray[np.bool_]) -> float:
    """How evenly points fill the seen side of a body: in slabs or in all, whichever is more.

    In slabs over what as many by chance would, in all by how many sides would hold as many alike.
    Of bark a flat scan line shows all that it sees, and steep ones show all together; of bars, and
    of stems that a circle goes through, each shows the same few sides at every height.
    """
    lowest = np.inf
    for point in range(len(local)):
        if near[point]:
            lowest = min(lowest, local[point, 2])
    slabs = 1
    for point in range(len(local)):
        if near[point]:
            slabs = max(slabs, int((local[point, 2] - lowest) / FREE_SLAB_M) + 1)
    counts, row = np.zeros((slabs, _SECTORS), np.int64), np.empty(NUMBERS)
    for point in range(len(local)):
        if near[point]:
            off_of(local, point, body, row)
            sector = int((math.atan2(-row[1], -row[0]) / math.pi + 1) / 2 * _SECTORS)
            slab = int((local[point, 2] - lowest) / FREE_SLAB_M)
            counts[slab, min(sector, _SECTORS - 1)] += 1
    seen = np.count_nonzero(counts.sum(axis=0))
    filled, likely = 0.0, 0.0
    for slab in range(slabs):
        count = counts[slab].sum()
        if count >= _FEWEST_OF_SLAB:
            filled += np.count_nonzero(counts[slab])
            likely += seen * (1.0 - (1.0 - 1.0 / seen) ** count)
    whole = counts.sum(axis=0)
    alike = whole.sum() ** 2 / max((whole * whole).sum(), 1) / max(seen, 1)
    return max(filled / likely, alike) if likely > 0.0 else 1.0


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
def shift_kernel(local: Floats, body: Floats, most_m: float, shift: Floats) -> None:
    """How far points of one drive lie aside of a body that another shows, to half a centimetre.

    Parameters
    ----------
    shift : (2,) float64
        m to the east and north. Written.
    """
    moved, east, north, most = local.copy(), 0.0, 0.0, -np.inf
    for step in _STEPS_M:
        middle_east, middle_north = east, north
        around = round((most_m if step == _STEPS_M[0] else _STEPS_M[0]) / step)
        for column in range(-around, around + 1):
            for row in range(-around, around + 1):
                aside = middle_east + step * column, middle_north + step * row
                for point in range(len(local)):
                    moved[point, 0] = local[point, 0] - aside[0]
                    moved[point, 1] = local[point, 1] - aside[1]
                # Of places alike the nearest.
                speaks = speaks_kernel(moved, body) * (1.0 - math.hypot(*aside))
                if speaks > most:
                    most, east, north = speaks, aside[0], aside[1]
    shift[0], shift[1] = east, north


@kernel
def apart_kernel(
    local: Floats, numbers: tuple[Integers, Integers], shape_m: float, body: Floats, shifts: Floats
) -> float:
    """Fit a body and how far the points of each drive lie aside of it together.

    Parameters
    ----------
    numbers : (drive of each point, shift of each drive)
        (n,) and (drives,) int64; −1: a drive has none.
    body : (10,) float64
        Where it begins; where it ends is written.
    shifts : (drives, 2) float64
        m to the east and north, as they begin. Written.

    Returns
    -------
    float
        How much lies on the body: 1 for a point on it, less for one beside it.
    """
    drive, shift = numbers
    size = NUMBERS + 2 * (int(shift.max()) + 1)
    moved, tolerance, bend_m = local.copy(), CAPTURED_M, _bend_m(body)
    _move(local, drive, shifts, moved)
    for _ in range(_APART_TURNS):
        normal, right = np.zeros((size, size)), np.zeros(size)
        on, square = _add_rows(moved, numbers, tolerance, body, (normal, right))
        if on < size:
            return 0.0
        spread = max(LEAST_NOISE_M, math.sqrt(square / on))
        _hold(body, bend_m, (spread, shape_m, on), normal, right)
        for one in range(shift.size):
            for axis in range(2 if shift[one] >= 0 else 0):
                at = NUMBERS + 2 * shift[one] + axis
                normal[at, at] += (spread / _APART_M) ** 2
                right[at] -= (spread / _APART_M) ** 2 * shifts[one, axis]
        step = np.linalg.solve(normal, right)
        body += step[:NUMBERS]
        if bend_m == _STRAIGHT_M:
            body[8:10] = 0.0
        for one in range(shift.size):
            if shift[one] >= 0:
                at = NUMBERS + 2 * shift[one]
                shifts[one] += step[at : at + 2]
        _move(local, drive, shifts, moved)
        tolerance = max(_SHRINKS * tolerance, TOLERANCE_M)
    row, lies = np.empty(NUMBERS), 0.0
    for point in range(len(moved)):
        lies += max(0.0, 1.0 - (off_of(moved, point, body, row) / TOLERANCE_M) ** 2)
    return lies


@kernel
def _move(local: Floats, drive: Integers, shifts: Floats, moved: Floats) -> None:
    """Write points without the shifts of their drives."""
    for point in range(len(local)):
        moved[point, 0] = local[point, 0] - shifts[drive[point], 0]
        moved[point, 1] = local[point, 1] - shifts[drive[point], 1]


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
