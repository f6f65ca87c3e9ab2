"""The straight round shaft in a column's points: the loops.

A shaft is a cone, long and nearly upright. A line along its surface is drawn through two of its
points; circles that touch this line stand for the shaft, and of these the one with the most
heights on it is fitted by least squares and followed upwards and downwards.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel

(
    EAST,
    NORTH,
    LEAN_EAST,
    LEAN_NORTH,
    RADIUS,
    TAPER,
    DEVIATION,
    NOISE,
    LOW,
    TOP,
    POINTS,
    SLABS,
    ARC,
    INSIDE,
    BESIDE,
    FREE,
) = range(16)
"""What is told of a shaft.

``EAST``, ``NORTH``, ``RADIUS``: of its axis at `LEVEL_M`, m about the column; ``LEAN_…``: m in a
metre of height; ``TAPER``: m of radius lost in a metre; ``DEVIATION``: standard deviation of the
radius, m; ``NOISE``: how far its points lie off it, m; ``LOW``, ``TOP``: where it was seen, m above
the ground; ``POINTS`` on it; ``SLABS``: the share of those between low and top that show it;
``ARC``: the share of its circumference that was seen; ``INSIDE``, ``BESIDE``: points in it and
within `BESIDE_M` of it for each on it; ``FREE``: the share of the slabs above the ground that show
it with less beside it than on it.
"""

SHAFT_WIDTH = 16

LEVEL_M = 1.2
"""Height at which diameters are told, as of trees."""

SLAB_M = 0.1
"""Height of a slab: scan lines of a slow vehicle are no farther apart on an upright thing."""

BESIDE_M = 0.3
"""About a shaft: what stands so near hides or holds it."""

_SLABS = 160
"""16 m: the tallest poles beside a road."""

_LINES = 160
"""Of two points each: with a seventh of the points on the shaft nine pairs in ten miss it, and one
of these is good all the same in all but one case in a million."""

_TRIES = 4
"""Lines of a column: edges of plates and twigs beside a post make some of their own."""

_RISE = 0.25
"""Between the two points of a line, of the height of all: nearer ones leave its lean open."""

_MOST_DRAWN = 500
"""Points that tell one line from another: enough for ten in each of fifty slabs."""

_FACTOR, _INCREMENT, _MODULUS = 1_664_525, 1_013_904_223, 1 << 32
"""Of the generator of draws (Press et al., Numerical Recipes, 7.1): the same ones each time."""

_ON_LINE_M = 0.015
"""How far a point may lie off a line along the surface: three times the noise of usual scanners."""

_APART_M = 0.06
"""What is nearer to a shaft's surface is its own; a second one in its column stands farther off."""

_SIDES = 16
"""Directions from the line in which the axis is looked for."""

_FLANK_M, _LEFT_OUT = 0.1, 0.5
"""What lies so near to the line along a shaft's surface is its flank: a circle that leaves it out
may touch the shaft and the plate beside it and be neither. What such a point takes from a circle,
of what one on it gives."""

_MOST_OF_SLAB = 3.0
"""Points that a slab may say for a line."""

_SECTORS = 24
"""Of 15 degrees, in which an arc is covered or not."""

_ABOVE_M, _ONE_AXIS_M = 2.0, 0.06
"""m above a sleeve in which the pole in it is looked for: half of it is sure to be clear of bands
and boxes. How far both axes may differ: sleeves hang a little askew."""

_SMOOTHER = 0.75
"""Noise of the upper one over that of the lower, where a fit took a pole and its sleeve for one."""

_STEP_M, _STEPS = 0.006, 14
"""By which a pole may be thinner than its sleeve: plates against bills are 1 to 3 cm thick with
their studs, sockets of lamps up to 8 cm wider in radius."""

_FEWEST_CLEAR = 4
"""Slabs that tell a shaft by themselves."""

_USUAL_TAPER, _TAPER_OFF = 0.003, 0.004
"""Metres of radius lost in a metre, of poles of concrete (JIS A 5373: 1/150) and straight pipes;
and how far others are off. Wraps and plates about the lower part don't widen a pole upwards."""

_LEAST_NOISE_M = 5e-4
"""No scanner of streets is more exact."""

_GROUND_M = 0.2
"""Below, the ground lies beside every shaft."""

_TURNS = 5
"""Steps of a fit; it ends within four."""

_PARTS = 6
"""Numbers of a cone: the first six of a shaft."""


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
def shafts_kernel(points: Floats, starts: Integers, limits: ShaftLimits, shafts: Floats) -> None:
    """The shafts of each column; radius 0 where there are no more.

    Parameters
    ----------
    points : (n, 3) float64
        m about their column's middle on the ground, column after column.
    starts : (k + 1,) int64
    shafts : (k, s, SHAFT_WIDTH) float64
        Up to s of each column, the likeliest first. Written.
    """
    shafts[:] = 0.0
    for column in range(starts.size - 1):
        part = points[starts[column] : starts[column + 1]]
        is_left = np.ones(len(part), np.bool_)
        line, number = np.zeros(4), 0
        for _ in range(_TRIES):
            drawn = _drawn(part, is_left, limits)
            if drawn.size < 8 or _surface_line(part, drawn, limits, line) < 4:
                break
            _strike(part, line, is_left)
            shaft = shafts[column, number]
            if _touching_circle(part, drawn, limits, line, shaft) and _settled(part, limits, shaft):
                _thinner_above(part, limits, shaft)
                for point in range(len(part)):
                    if abs(_off(part, point, shaft)) < _APART_M:
                        is_left[point] = False
                number += 1
            else:
                shaft[:] = 0.0
            if number == shafts.shape[1]:
                break


@kernel
def _settled(points: Floats, limits: ShaftLimits, shaft: Floats) -> bool:
    """Fit a shaft and follow it until it grows no longer."""
    reached = 0.0
    shaft[LOW], shaft[TOP] = limits.low_m, limits.high_m
    for _ in range(4):
        if not _fit(points, _clear_slabs(points, shaft), limits, shaft):
            return False
        again = _followed(points, limits, shaft)
        if abs(again - reached) < SLAB_M:
            break
        reached = again
    _tell(points, shaft)
    return True


@kernel
def _thinner_above(points: Floats, limits: ShaftLimits, shaft: Floats) -> None:
    """Put the shaft that goes on above in its place, where this one is a sleeve or half of one.

    Both have one axis; the upper one is thinner, and goes higher or is smoother: it tells the
    pole's own diameter.
    """
    low = min(shaft[TOP], limits.high_m)
    high = low + _ABOVE_M
    thinner = _swell(points, shaft, low, high)
    if thinner > 0.0:
        return
    upper = shaft.copy()
    upper[RADIUS] += thinner
    upper[LOW], upper[TOP] = low, high
    above = ShaftLimits(
        limits.least_m,
        limits.most_m,
        limits.steepest,
        low,
        high,
        limits.gap_m,
        limits.noise_m,
    )
    if not _settled(points, above, upper):
        return
    is_longer = upper[TOP] > shaft[TOP] + _ABOVE_M / 2
    is_smoother = upper[NOISE] < _SMOOTHER * shaft[NOISE] and upper[TOP] > shaft[TOP] - SLAB_M
    apart = math.hypot(upper[EAST] - shaft[EAST], upper[NORTH] - shaft[NORTH])
    if (is_longer or is_smoother) and apart < _ONE_AXIS_M and upper[RADIUS] < shaft[RADIUS]:
        upper[LOW] = min(shaft[LOW], upper[LOW])
        shaft[:] = upper
        _tell(points, shaft)


@kernel
def _swell(points: Floats, shaft: Floats, low_m: float, high_m: float) -> float:
    """How far off a shaft's surface most points between two heights lie inwards; 1 without any."""
    counts = np.zeros(_STEPS, np.int64)
    seen = np.zeros((_STEPS, _SLABS), np.bool_)
    for point in range(len(points)):
        up = points[point, 2]
        step = int(-_off(points, point, shaft) / _STEP_M)
        if low_m <= up < high_m and 0 < step < _STEPS:
            counts[step] += 1
            seen[step, min(int(up / SLAB_M), _SLABS - 1)] = True
    best = int(counts.argmax())
    if seen[best].sum() < _RISE * (high_m - low_m) / SLAB_M:
        return 1.0
    return -(best + 0.5) * _STEP_M


@kernel
def _strike(points: Floats, line: Floats, is_left: Flags) -> None:
    """Take the points on a line out of those that others are drawn from."""
    for point in range(len(points)):
        up = points[point, 2]
        east = points[point, 0] - line[0] - line[2] * up
        north = points[point, 1] - line[1] - line[3] * up
        if east * east + north * north < _ON_LINE_M * _ON_LINE_M:
            is_left[point] = False


@kernel
def _drawn(points: Floats, is_left: Flags, limits: ShaftLimits) -> Integers:
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
def _surface_line(points: Floats, drawn: Integers, limits: ShaftLimits, line: Floats) -> int:
    """The steep line that the most slabs have points on: place at height 0 and lean; how many."""
    best, state = 0.0, 1
    guess = np.zeros(4)
    starts = np.zeros(_SLABS + 1, np.int64)
    ordered = _by_slab(points, drawn, starts)
    near = np.ascontiguousarray(points[ordered].T)
    filled = np.flatnonzero(starts[1:] > starts[:-1])
    if filled.size < 2:
        return 0
    least = max(2 * SLAB_M, _RISE * SLAB_M * (filled[-1] - filled[0]))
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
    for slab in range(_SLABS):
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
    starts : (_SLABS + 1,) int64
    """
    score, slabs = 0.0, 0
    for slab in range(_SLABS):
        on = 0.0
        for point in range(starts[slab], starts[slab + 1]):
            east = near[0, point] - line[0] - line[2] * near[2, point]
            north = near[1, point] - line[1] - line[3] * near[2, point]
            off = (east * east + north * north) / (_ON_LINE_M * _ON_LINE_M)
            on += max(1.0 - off, 0.0)
        score += min(on, _MOST_OF_SLAB)
        slabs += on > 0.0
    return score, slabs


@kernel
def _straighten(points: Floats, drawn: Integers, line: Floats) -> None:
    """Least squares through the points on a line, each the less the more its slab has."""
    count = np.zeros(_SLABS)
    for step in range(2):
        sums = np.zeros(7)
        for point in drawn:
            up = points[point, 2]
            east = points[point, 0] - line[0] - line[2] * up
            north = points[point, 1] - line[1] - line[3] * up
            if east * east + north * north > _ON_LINE_M * _ON_LINE_M:
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
def _touching_circle(
    points: Floats, drawn: Integers, limits: ShaftLimits, line: Floats, shaft: Floats
) -> bool:
    """The circle touching the line that has the most on it and the least in it.

    Slabs count alike: in each it is the share of what lies near, for a plate on a post has more
    points than all of the post, and a circle that touches both is neither.
    """
    about = _about_line(points, drawn, line)
    turns = np.arange(_SIDES) * (2 * math.pi / _SIDES)
    radius, best = limits.least_m, 0.0
    scores = np.empty(_SIDES)
    while radius <= limits.most_m:
        east, north = radius * np.cos(turns), radius * np.sin(turns)
        _rate_circles(about, (east, north), radius, limits.noise_m, scores)
        side = int(scores.argmax())
        if scores[side] > best:
            best = scores[side]
            shaft[EAST] = line[0] + east[side] + line[2] * LEVEL_M
            shaft[NORTH] = line[1] + north[side] + line[3] * LEVEL_M
            shaft[RADIUS] = radius
        radius *= 1.25
    shaft[LEAN_EAST], shaft[LEAN_NORTH] = line[2], line[3]
    return best > 0.0


@kernel
def _about_line(points: Floats, drawn: Integers, line: Floats) -> Floats:
    """(4, n) how far points lie to the east and north of a line and in plan; what each counts."""
    about = np.empty((4, drawn.size))
    slabs = np.empty(drawn.size, np.int64)
    near = np.ones(_SLABS)
    for number in range(drawn.size):
        up = points[drawn[number], 2]
        about[0, number] = points[drawn[number], 0] - line[0] - line[2] * up
        about[1, number] = points[drawn[number], 1] - line[1] - line[3] * up
        about[2, number] = math.sqrt(about[0, number] ** 2 + about[1, number] ** 2)
        slabs[number] = min(max(int(up / SLAB_M), 0), _SLABS - 1)
        near[slabs[number]] += about[2, number] < BESIDE_M
    for number in range(drawn.size):
        about[3, number] = 1.0 / near[slabs[number]]
    return about


@kernel
def _rate_circles(
    about: Floats, middles: tuple[Floats, Floats], radius: float, noise_m: float, scores: Floats
) -> None:
    """How much speaks for circles: points on each, less those in it and on the flank beside it."""
    scores[:] = 0.0
    # Farther points are neither on nor in a circle that touches the line, nor on its flank.
    reach = max(2 * radius + noise_m, _FLANK_M)
    for point in range(about.shape[1]):
        if about[2, point] >= reach:
            continue
        east, north, counts = about[0, point], about[1, point], about[3, point]
        beyond = -_LEFT_OUT if about[2, point] < _FLANK_M else 0.0
        # Without a branch, so that several circles are asked at a time.
        for side in range(_SIDES):
            off_east, off_north = east - middles[0][side], north - middles[1][side]
            off = math.sqrt(off_east * off_east + off_north * off_north) - radius
            worth = 1.0 - abs(off) / noise_m
            outside = -1.0 if off < 0.0 else beyond
            scores[side] += counts * (worth if worth > 0.0 else outside)


@kernel
def _off(points: Floats, point: int, shaft: Floats) -> float:
    """How far a point lies outside the cone."""
    up = points[point, 2] - LEVEL_M
    east = points[point, 0] - shaft[EAST] - shaft[LEAN_EAST] * up
    north = points[point, 1] - shaft[NORTH] - shaft[LEAN_NORTH] * up
    return float(math.sqrt(east * east + north * north) - shaft[RADIUS] + shaft[TAPER] * up)


@kernel
def _clear_slabs(points: Floats, shaft: Floats) -> Flags:
    """Slabs between its low and top that have more on it than beside it; all, if few have."""
    on, beside = np.zeros(_SLABS, np.int64), np.zeros(_SLABS, np.int64)
    low, top = int(shaft[LOW] / SLAB_M), min(int(shaft[TOP] / SLAB_M) + 1, _SLABS)
    for point in range(len(points)):
        slab = int(points[point, 2] / SLAB_M)
        if points[point, 2] < 0 or slab < low or slab >= top:
            continue
        off = abs(_off(points, point, shaft))
        if off < _ON_LINE_M:
            on[slab] += 1
        elif off < BESIDE_M:
            beside[slab] += 1
    is_clear = on > beside
    if is_clear.sum() < _FEWEST_CLEAR:
        is_clear[low:top] = True
    return is_clear


@kernel
def _fit(points: Floats, is_clear: Flags, limits: ShaftLimits, shaft: Floats) -> bool:
    """Least squares over the points near the cone in some slabs; whether one is left."""
    normal, right, row = np.zeros((_PARTS, _PARTS)), np.zeros(_PARTS), np.zeros(_PARTS)
    tolerance = 2 * limits.noise_m
    # Held to what shafts are by as much as their points leave it open: lean, radius lost a metre.
    held = np.array([math.inf, math.inf, 0.1, 0.1, math.inf, _TAPER_OFF])
    for _ in range(_TURNS):
        normal[:], right[:] = 0.0, 0.0
        squares, count = 0.0, 0
        for point in range(len(points)):
            up = points[point, 2]
            if up < 0 or not is_clear[min(int(up / SLAB_M), _SLABS - 1)]:
                continue
            off = _off(points, point, shaft)
            if abs(off) > tolerance:
                continue
            up -= LEVEL_M
            east = points[point, 0] - shaft[EAST] - shaft[LEAN_EAST] * up
            north = points[point, 1] - shaft[NORTH] - shaft[LEAN_NORTH] * up
            away = max(math.sqrt(east * east + north * north), 1e-6)
            row[0], row[1] = east / away, north / away
            row[2], row[3], row[4], row[5] = row[0] * up, row[1] * up, 1.0, -up
            # A half that is seen doubly well tells no more than the other.
            weight = 1.0 - (off / tolerance) ** 2
            for i in range(_PARTS):
                right[i] += weight * row[i] * off
                for j in range(_PARTS):
                    normal[i, j] += weight * row[i] * row[j]
            squares += weight * off * off
            count += 1
        if count < 8:
            return False
        noise = max(_LEAST_NOISE_M, math.sqrt(squares / count))
        for i in range(_PARTS):
            weight = (noise / held[i]) ** 2
            normal[i, i] += weight + 1e-9
            right[i] -= weight * (shaft[i] - (_USUAL_TAPER if i == TAPER else 0.0))
        shaft[:_PARTS] += np.linalg.solve(normal, right)
        shaft[TAPER] = min(max(shaft[TAPER], -_TAPER_OFF), 4 * _TAPER_OFF)
        tolerance = min(max(3 * noise, 0.006), limits.noise_m)
        if not limits.least_m / 2 <= shaft[RADIUS] <= limits.most_m:
            return False
    shaft[NOISE] = noise
    shaft[DEVIATION] = noise * math.sqrt(np.linalg.inv(normal)[RADIUS, RADIUS])
    return math.hypot(shaft[LEAN_EAST], shaft[LEAN_NORTH]) <= limits.steepest


@kernel
def _followed(points: Floats, limits: ShaftLimits, shaft: Floats) -> float:
    """Write how far down and up the shaft was seen; its top."""
    seen = np.zeros(_SLABS, np.int64)
    tolerance = max(0.008, 3 * shaft[NOISE])
    middle, weight = 0.0, 0
    for point in range(len(points)):
        up = points[point, 2]
        if 0.0 < up < _SLABS * SLAB_M and abs(_off(points, point, shaft)) < tolerance:
            seen[int(up / SLAB_M)] += 1
            if limits.low_m <= up <= limits.high_m:
                middle += up
                weight += 1
    start = int(middle / max(weight, 1) / SLAB_M)
    most = int(limits.gap_m / SLAB_M)
    low, top, gap = start, start, 0
    for slab in range(start, _SLABS):
        gap = 0 if seen[slab] > 0 else gap + 1
        if gap > most:
            break
        if seen[slab] > 0:
            top = slab
    gap = 0
    for slab in range(start, -1, -1):
        gap = 0 if seen[slab] > 0 else gap + 1
        if gap > most:
            break
        if seen[slab] > 0:
            low = slab
    shaft[LOW], shaft[TOP] = low * SLAB_M, (top + 1) * SLAB_M
    return float(shaft[TOP])


@kernel
def _tell(points: Floats, shaft: Floats) -> None:
    """Count what is on, in and beside the shaft."""
    on, beside = np.zeros(_SLABS, np.int64), np.zeros(_SLABS, np.int64)
    arc = np.zeros(_SECTORS, np.bool_)
    inside = 0
    tolerance = max(0.008, 3 * shaft[NOISE])
    top = 0.0
    for point in range(len(points)):
        up = points[point, 2]
        if up < shaft[LOW] or up >= shaft[TOP]:
            continue
        off = _off(points, point, shaft)
        slab = min(int(up / SLAB_M), _SLABS - 1)
        if abs(off) < tolerance:
            on[slab] += 1
            top = max(top, up)
            east = points[point, 0] - shaft[EAST] - shaft[LEAN_EAST] * (up - LEVEL_M)
            north = points[point, 1] - shaft[NORTH] - shaft[LEAN_NORTH] * (up - LEVEL_M)
            arc[min(int((math.atan2(north, east) / math.pi + 1) / 2 * _SECTORS), _SECTORS - 1)] = (
                True
            )
        elif off < 0:
            inside += 1
        elif off < BESIDE_M:
            beside[slab] += 1
    shaft[POINTS] = on.sum()
    low_slab, top_slab = round(shaft[LOW] / SLAB_M), round(shaft[TOP] / SLAB_M)
    seen, above, free = 0, 0, 0
    for slab in range(low_slab, top_slab):
        seen += on[slab] > 0
        if slab * SLAB_M >= _GROUND_M:
            above += on[slab] > 0
            free += on[slab] > beside[slab]
    shaft[SLABS] = seen / max(top_slab - low_slab, 1)
    shaft[FREE] = free / max(above, 1)
    shaft[ARC] = arc.sum() / _SECTORS
    shaft[INSIDE] = inside / max(shaft[POINTS], 1.0)
    shaft[BESIDE] = beside.sum() / max(shaft[POINTS], 1.0)
    shaft[TOP] = top
