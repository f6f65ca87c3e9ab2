"""The straight round shaft in a column's points: the loops.

A shaft is a cone, long and nearly upright. A line along its surface is drawn through two of its
points; circles that touch this line stand for the shaft, and of these the one with the most
heights on it is fitted by least squares and followed upwards and downwards.
"""

from __future__ import annotations

import math

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.poles.surface_lines import (
    MOST_SLABS,
    ON_LINE_M,
    RISE,
    SLAB_M,
    ShaftLimits,
    drawn_points,
    strike,
    surface_line,
)

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

BESIDE_M = 0.3
"""About a shaft: what stands so near hides or holds it."""

LEAST_SLABS, LEAST_ARC, MOST_INSIDE = 0.5, 0.24, 0.6
"""Of the heights that show it, of its circumference, and of points within it for each on it: a
scanner sees nearly half of any post on all its heights, and nothing inside."""

_CANE_M = 0.03
"""Radius of the thickest canes of banners, and of posts of 60.5 mm."""

_TRIES = 4
"""Lines of a column: edges of plates and twigs beside a post make some of their own."""

_APART_M = 0.06
"""What is nearer to a shaft's surface is its own; a second one in its column stands farther off."""

_SIDES = 16
"""Directions from the line in which the axis is looked for."""

_FLANK_M, _LEFT_OUT = 0.1, 0.5
"""What lies so near to the line along a shaft's surface is its flank: a circle that leaves it out
may touch the shaft and the plate beside it and be neither. What such a point takes from a circle,
of what one on it gives."""

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

_ROUND_SECTORS, _NO_PLATE = 8, 4
"""Of 45 degrees about a shaft, and the one by whose points leaves are told, the emptiest first: a
plate, rail or wall leaves half of them empty, twigs about a shaft fill more."""

_CHANCE, _POOLED = 3.0, 3
"""Times as many points as leaves alone would put on a shaft's surface, and slabs above and below
that are asked together: single leaves lie on it in any slab."""

_TURNS = 5
"""Steps of a fit; it ends within four."""

_PARTS = 6
"""Numbers of a cone: the first six of a shaft."""


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
            drawn = drawn_points(part, is_left, limits)
            if drawn.size < 8 or surface_line(part, drawn, limits, line) < 4:
                break
            strike(part, line, is_left)
            shaft = shafts[column, number]
            if _shaft_on(part, drawn, limits, line, shaft):
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
def _shaft_on(
    points: Floats, drawn: Integers, limits: ShaftLimits, line: Floats, shaft: Floats
) -> bool:
    """The shaft along a line on its surface; whether there is one.

    Where the likeliest circle makes none, the line may be a cane, which is told where no cloth
    hangs on it: elsewhere cloth has far more points, and circles that touch both are neither.
    """
    if (
        _touching_circle(points, drawn, limits, line, shaft)
        and _settled(points, limits, shaft)
        and is_shaft(shaft)
    ):
        return True
    clear = _clear_of_cloth(points, limits, line)
    if clear.size < 8:
        return False
    canes = ShaftLimits(
        limits.least_m,
        _CANE_M,
        limits.steepest,
        limits.low_m,
        limits.high_m,
        limits.gap_m,
        limits.noise_m,
    )
    shaft[:] = 0.0
    return bool(
        _touching_circle(points, clear, canes, line, shaft)
        and _settled(points, canes, shaft)
        and is_shaft(shaft)
    )


@kernel
def _clear_of_cloth(points: Floats, limits: ShaftLimits, line: Floats) -> Integers:
    """Points about a line, at heights that have more on a cane along it than beside."""
    on, near = np.zeros(MOST_SLABS, np.int64), np.zeros(MOST_SLABS, np.int64)
    is_near = np.zeros(len(points), np.bool_)
    for point in range(len(points)):
        up = points[point, 2]
        if up < limits.low_m or up > limits.high_m:
            continue
        east = points[point, 0] - line[0] - line[2] * up
        north = points[point, 1] - line[1] - line[3] * up
        away, slab = math.hypot(east, north), int(up / SLAB_M)
        is_near[point] = away < BESIDE_M
        near[slab] += away < BESIDE_M
        on[slab] += away < 2 * _CANE_M
    is_clear = 2 * on > near
    for point in range(len(points)):
        if is_near[point]:
            is_near[point] = is_clear[int(points[point, 2] / SLAB_M)]
    if is_clear.sum() < _FEWEST_CLEAR:
        is_near[:] = False
    return np.flatnonzero(is_near)


@kernel
def is_shaft(shaft: Floats) -> bool:
    """Whether enough of a shaft is seen, and little in it."""
    return bool(
        shaft[SLABS] >= LEAST_SLABS and shaft[ARC] >= LEAST_ARC and shaft[INSIDE] <= MOST_INSIDE
    )


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
    seen = np.zeros((_STEPS, MOST_SLABS), np.bool_)
    for point in range(len(points)):
        up = points[point, 2]
        step = int(-_off(points, point, shaft) / _STEP_M)
        if low_m <= up < high_m and 0 < step < _STEPS:
            counts[step] += 1
            seen[step, min(int(up / SLAB_M), MOST_SLABS - 1)] = True
    best = int(counts.argmax())
    if seen[best].sum() < RISE * (high_m - low_m) / SLAB_M:
        return 1.0
    return -(best + 0.5) * _STEP_M


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
    near = np.ones(MOST_SLABS)
    for number in range(drawn.size):
        up = points[drawn[number], 2]
        about[0, number] = points[drawn[number], 0] - line[0] - line[2] * up
        about[1, number] = points[drawn[number], 1] - line[1] - line[3] * up
        about[2, number] = math.sqrt(about[0, number] ** 2 + about[1, number] ** 2)
        slabs[number] = min(max(int(up / SLAB_M), 0), MOST_SLABS - 1)
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
    on, beside = np.zeros(MOST_SLABS, np.int64), np.zeros(MOST_SLABS, np.int64)
    low, top = int(shaft[LOW] / SLAB_M), min(int(shaft[TOP] / SLAB_M) + 1, MOST_SLABS)
    for point in range(len(points)):
        slab = int(points[point, 2] / SLAB_M)
        if points[point, 2] < 0 or slab < low or slab >= top:
            continue
        off = abs(_off(points, point, shaft))
        if off < ON_LINE_M:
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
            if up < 0 or not is_clear[min(int(up / SLAB_M), MOST_SLABS - 1)]:
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
    seen = np.zeros(MOST_SLABS, np.int64)
    about = np.zeros((MOST_SLABS, _ROUND_SECTORS), np.int64)
    tolerance = max(0.008, 3 * shaft[NOISE])
    middle, weight = 0.0, 0
    for point in range(len(points)):
        up = points[point, 2]
        off = _off(points, point, shaft)
        if not 0.0 < up < MOST_SLABS * SLAB_M or off < -tolerance or off > BESIDE_M:
            continue
        if off > tolerance:
            about[int(up / SLAB_M), _sector(points, point, shaft, _ROUND_SECTORS)] += 1
            continue
        seen[int(up / SLAB_M)] += 1
        if limits.low_m <= up <= limits.high_m:
            middle += up
            weight += 1
    _without_leaves(seen, about, shaft, tolerance)
    start = int(middle / max(weight, 1) / SLAB_M)
    most = int(limits.gap_m / SLAB_M)
    low, top = _last_seen(seen, start, -1, most), _last_seen(seen, start, 1, most)
    shaft[LOW], shaft[TOP] = low * SLAB_M, (top + 1) * SLAB_M
    return float(shaft[TOP])


@kernel
def _last_seen(seen: Integers, start: int, step: int, most: int) -> int:
    """The last slab upwards or downwards before more are hidden than may be."""
    last, slab = start, start
    while 0 <= slab < MOST_SLABS and abs(slab - last) <= most:
        if seen[slab] > 0:
            last = slab
        slab += step
    return last


@kernel
def _without_leaves(seen: Integers, about: Integers, shaft: Floats, tolerance: float) -> None:
    """Clear slabs that show no more on a shaft than the leaves about it put there by chance."""
    ring = BESIDE_M * (2 * shaft[RADIUS] + BESIDE_M)
    share = 4 * shaft[RADIUS] * tolerance / ring
    leaves = np.empty(MOST_SLABS)
    for slab in range(MOST_SLABS):
        leaves[slab] = share * _ROUND_SECTORS * np.sort(about[slab])[_NO_PLATE]
    on = seen.copy()
    for slab in range(MOST_SLABS):
        low, high = max(slab - _POOLED, 0), slab + _POOLED + 1
        if on[low:high].sum() <= _CHANCE * leaves[low:high].sum():
            seen[slab] = 0


@kernel
def _sector(points: Floats, point: int, shaft: Floats, sectors: int) -> int:
    """In which of the sectors about a shaft's axis a point lies."""
    up = points[point, 2] - LEVEL_M
    east = points[point, 0] - shaft[EAST] - shaft[LEAN_EAST] * up
    north = points[point, 1] - shaft[NORTH] - shaft[LEAN_NORTH] * up
    turn = (math.atan2(north, east) / math.pi + 1) / 2
    return int(min(int(turn * sectors), sectors - 1))


@kernel
def _tell(points: Floats, shaft: Floats) -> None:
    """Count what is on, in and beside the shaft."""
    on, beside = np.zeros(MOST_SLABS, np.int64), np.zeros(MOST_SLABS, np.int64)
    arc = np.zeros(_SECTORS, np.bool_)
    inside = 0
    tolerance = max(0.008, 3 * shaft[NOISE])
    top = 0.0
    for point in range(len(points)):
        up = points[point, 2]
        if up < shaft[LOW] or up >= shaft[TOP]:
            continue
        off = _off(points, point, shaft)
        slab = min(int(up / SLAB_M), MOST_SLABS - 1)
        if abs(off) < tolerance:
            on[slab] += 1
            top = max(top, up)
            arc[_sector(points, point, shaft, _SECTORS)] = True
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
