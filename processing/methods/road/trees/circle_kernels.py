"""Circles through the points of thin level slabs: the loops.

A trunk shows in each slab as an arc; its inside is empty, since no beam gets there. Stakes, guards
and twigs show beside it, so a slab may give several circles.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

MOST_CIRCLES = 5
"""In a slab: a trunk and four stakes, or five stems."""

EAST, NORTH, RADIUS, INLIERS, ARC, WORTH = range(6)
"""What is told of a circle: middle, m about the column; radius, m; points on it; the share of its
circumference that they cover; how much speaks for it."""

CIRCLE_WIDTH = 6

_DRAWS = 250
"""Of three points each: with a third of the points on the circle one of these is good in all but
one case in ten thousand."""

_EVERY, _ABOUT = 4, 0.6
"""Of the points, every fourth is asked first, and how much fewer on a circle may then be a matter
of chance: with forty asked, one in a hundred good circles is lost."""

_SURE = 9.2
"""Natural logarithm of ten thousand: no more draws than that take for the best circle so far."""

_FACTOR, _MODULUS = 1_664_525, 1 << 32
"""Of the generator of draws (Press et al., Numerical Recipes, 7.1): the same ones each time."""

_SECTORS = 24
"""Of 15 degrees, in which an arc is covered or not."""

_HOLE = 2
"""Sectors without a point within an arc: few points lie on a slender stem."""

_LINE_FROM = 4
"""Circles from which a line through their middles tells the lean."""

_LINE_OVER = 6
"""Slabs to either side that a line which leans is taken from."""

_LEANS_BY = 2.0
"""Times as much worth has to lie on a line that leans as on an upright one: most stems stand."""


class CircleLimits(NamedTuple):
    """What a circle must be.

    ``least_m``, ``most_m``: radius; ``noise_m``: how far off it a point may lie; ``fewest``:
    points; ``least_arc``: share of the circumference that they cover; ``most_inside``: points well
    inside it for each on it.
    """

    least_m: float
    most_m: float
    noise_m: float
    fewest: int
    least_arc: float
    most_inside: float


@kernel
def circles_kernel(plan: Floats, starts: Integers, limits: CircleLimits, circles: Floats) -> None:
    """The circles of slabs, the best of each first; radius 0 where there are no more.

    Parameters
    ----------
    plan : (n, 2) float64
        Points in plan, m about their column, slab after slab.
    starts : (slabs + 1,) int64
    circles : (slabs, MOST_CIRCLES, CIRCLE_WIDTH) float64
        Written.
    """
    for slab in range(starts.size - 1):
        left = np.ascontiguousarray(plan[starts[slab] : starts[slab + 1]].T)
        circles[slab] = 0.0
        for number in range(MOST_CIRCLES):
            if left.shape[1] < limits.fewest:
                break
            best = _best_circle(left, limits)
            if best[RADIUS] == 0.0:
                break
            circles[slab, number] = best
            left = _others(left, best, 2 * limits.noise_m)


@kernel
def _best_circle(left: Floats, limits: CircleLimits) -> Floats:
    """The circle that most speaks for among (2, n) points."""
    best = np.zeros(CIRCLE_WIDTH)
    best_score = 0.0
    found = np.zeros(CIRCLE_WIDTH)
    some = np.ascontiguousarray(left[:, ::_EVERY])
    count = left.shape[1]
    state, needed = 1, float(_DRAWS)
    for draw in range(_DRAWS):
        if draw >= needed:
            break
        state = (state * _FACTOR + 1) % _MODULUS
        a = state * count // _MODULUS
        state = (state * _FACTOR + 1) % _MODULUS
        b = state * count // _MODULUS
        state = (state * _FACTOR + 1) % _MODULUS
        c = state * count // _MODULUS
        if a in (b, c) or b == c or not _through(left, a, b, c, found):
            continue
        if not limits.least_m <= found[RADIUS] <= limits.most_m:
            continue
        if not _is_promising(some, limits, found, best[INLIERS]):
            continue
        score = _rate(left, limits, found, best_score)
        if score > best_score:
            best_score = score
            best[:] = found
            share = min(found[INLIERS] / count, 0.99)
            needed = _SURE / -math.log1p(-(share**3))
    if best_score > 0:
        for _ in range(3):
            _refit(left, limits, best)
        if _rate(left, limits, best, 0.0) <= 0 or not (
            limits.least_m <= best[RADIUS] <= limits.most_m
        ):
            best[:] = 0.0
    return best


@kernel
def _through(left: Floats, a: int, b: int, c: int, circle: Floats) -> bool:
    """The circle through three points; False where they are on a line."""
    bx, by = left[0, b] - left[0, a], left[1, b] - left[1, a]
    cx, cy = left[0, c] - left[0, a], left[1, c] - left[1, a]
    cross = 2 * (bx * cy - by * cx)
    if abs(cross) < 1e-9:
        return False
    b2, c2 = bx * bx + by * by, cx * cx + cy * cy
    east, north = (cy * b2 - by * c2) / cross, (bx * c2 - cx * b2) / cross
    circle[EAST], circle[NORTH] = left[0, a] + east, left[1, a] + north
    circle[RADIUS] = math.hypot(east, north)
    return True


@kernel
def _is_promising(some: Floats, limits: CircleLimits, circle: Floats, most: float) -> bool:
    """Whether a few of the points speak for a circle as much as for the best so far, about."""
    middle_east, middle_north = circle[EAST], circle[NORTH]
    outer, inner = circle[RADIUS] + limits.noise_m, circle[RADIUS] - limits.noise_m
    outer_square, inner_square = outer * outer, inner * inner if inner > 0 else 0.0
    on, inside = 0, 0
    # Without a branch, so that several points are counted at a time.
    for point in range(some.shape[1]):
        east, north = some[0, point] - middle_east, some[1, point] - middle_north
        square = east * east + north * north
        on += (square <= outer_square) & (square >= inner_square)
        inside += square < inner_square
    return _EVERY * on >= _ABOUT * most - _EVERY and inside <= 2 + limits.most_inside * on / _ABOUT


@kernel
def _rate(left: Floats, limits: CircleLimits, circle: Floats, least: float) -> float:
    """How much speaks for a circle; 0 where it isn't one, or where no more than so much does.

    Its points and arc are written where it is more.
    """
    middle_east, middle_north, radius = circle[EAST], circle[NORTH], circle[RADIUS]
    on, inside = 0, 0
    for point in range(left.shape[1]):
        east, north = left[0, point] - middle_east, left[1, point] - middle_north
        off = math.sqrt(east * east + north * north) - radius
        on += abs(off) <= limits.noise_m
        inside += off < -limits.noise_m
    if on < limits.fewest or inside > limits.most_inside * on or 1.5 * on - inside <= least:
        return 0.0
    sectors = np.zeros(_SECTORS, np.int64)
    for point in range(left.shape[1]):
        east, north = left[0, point] - middle_east, left[1, point] - middle_north
        if abs(math.sqrt(east * east + north * north) - radius) <= limits.noise_m:
            sector = int((math.atan2(north, east) / math.pi + 1) / 2 * _SECTORS)
            sectors[min(sector, _SECTORS - 1)] += 1
    circle[INLIERS], circle[ARC] = on, np.count_nonzero(sectors) / _SECTORS
    circle[WORTH] = _worth_of_arcs(sectors) - inside
    return (
        float(circle[WORTH]) if circle[ARC] >= limits.least_arc and circle[WORTH] > least else 0.0
    )


@kernel
def _worth_of_arcs(sectors: Integers) -> float:
    """What the longest arc of a circle is worth: its points by how much of the circle it covers.

    A trunk hides its far side, so its points follow each other; a wide circle through several stems
    has those of each in an arc of its own.
    """
    best = 0.0
    for begin in range(_SECTORS):
        if sectors[begin] == 0 or sectors[begin - 1] > 0:
            continue
        points, covered, hole = 0, 0, 0
        for one in range(_SECTORS):
            here = sectors[(begin + one) % _SECTORS]
            hole = 0 if here > 0 else hole + 1
            if hole > _HOLE:
                break
            points += here
            covered += here > 0
        best = max(best, points * (0.5 + covered / _SECTORS))
    # All round there is no beginning.
    return best if best > 0 else 1.5 * sectors.sum()


@kernel
def _refit(left: Floats, limits: CircleLimits, circle: Floats) -> None:
    """One step of Gauss and Newton on the points that lie on the circle."""
    normal, right = np.zeros((3, 3)), np.zeros(3)
    row = np.ones(3)
    for point in range(left.shape[1]):
        east, north = left[0, point] - circle[EAST], left[1, point] - circle[NORTH]
        away = math.sqrt(east * east + north * north)
        if away == 0.0 or abs(away - circle[RADIUS]) > limits.noise_m:
            continue
        row[0], row[1] = east / away, north / away
        for i in range(3):
            right[i] += row[i] * (away - circle[RADIUS])
            for j in range(3):
                normal[i, j] += row[i] * row[j]
    # A short arc leaves middle and radius open along one direction: it is moved no farther.
    for i in range(3):
        normal[i, i] += 1e-3
    step = np.linalg.solve(normal, right)
    circle[EAST] += step[0]
    circle[NORTH] += step[1]
    circle[RADIUS] += step[2]


@kernel
def _others(left: Floats, circle: Floats, band_m: float) -> Floats:
    """The points that are neither on a circle nor inside it."""
    kept = np.zeros(left.shape[1], np.bool_)
    for point in range(left.shape[1]):
        away = math.hypot(left[0, point] - circle[EAST], left[1, point] - circle[NORTH])
        kept[point] = away > circle[RADIUS] + band_m
    return left[:, kept]


class ChainLimits(NamedTuple):
    """How circles of slabs join to a stem.

    ``shift_m``, ``swell_m``: how far middle and radius may be off what the circles below tell;
    ``lean_m``: how far a middle moves from slab to slab at most;
    ``swell``: the second as a share of the radius besides; ``skipped``: slabs without a circle that
    may lie between two; ``remembered``: circles that tell where the next is.
    """

    shift_m: float
    lean_m: float
    swell_m: float
    swell: float
    skipped: int
    remembered: int


@kernel
def chains_kernel(
    circles: Floats, worth: Floats, limits: ChainLimits, fewest: int, chains: Integers
) -> int:
    """Join circles that follow each other upwards, from the likeliest on; how many chains.

    Parameters
    ----------
    circles : (slabs, MOST_CIRCLES, CIRCLE_WIDTH) float64
    worth : (slabs, MOST_CIRCLES) float64
        Becomes 0.
    fewest : int
        Circles of a chain.
    chains : (k, slabs) int64
        The circle of each slab, −1: none; k is larger than all circles give chains. Written.
    """
    found = 0
    while True:
        slab, number = divmod(int(worth.argmax()), MOST_CIRCLES)
        if worth[slab, number] <= 0:
            return found
        chain = chains[found]
        chain[:] = -1
        lean = lean_kernel(circles, worth, slab, number, limits)
        chain_kernel(circles, worth, (slab, number, 1), lean, limits, chain)
        chain_kernel(circles, worth, (slab, number, -1), lean, limits, chain)
        count = 0
        for at in range(len(chain)):
            if chain[at] >= 0:
                worth[at, chain[at]] = 0.0
                count += 1
        found += count >= fewest


@kernel
def chain_kernel(
    circles: Floats,
    worth: Floats,
    seed: tuple[int, int, int],
    lean: tuple[float, float],
    limits: ChainLimits,
    chain: Integers,
) -> None:
    """Follow a circle upwards or downwards.

    Parameters
    ----------
    circles : (slabs, MOST_CIRCLES, CIRCLE_WIDTH) float64
    worth : (slabs, MOST_CIRCLES) float64
        0: belongs to another stem already.
    seed : (slab, number, step)
        The circle, and 1 for upwards, −1 for downwards.
    lean : (float, float)
        m to the east and north from slab to slab, until the circles tell it.
    chain : (slabs,) int64
        The circle of each slab, −1: none; those of earlier calls are built on. Written.
    """
    slabs = len(circles)
    slab, number, step = seed
    chain[slab] = number
    last = slab
    for ahead in range(1, slabs):
        at = slab + step * ahead
        if at < 0 or at >= slabs or abs(at - last) > limits.skipped + 1:
            break
        if chain[at] >= 0:
            last = at
            continue
        east, north, radius = _expected(circles, chain, (last, step, at), lean, limits.remembered)
        allowed = limits.shift_m * (1 + 0.3 * abs(at - last)) + 0.1 * radius
        best, nearest = -1, allowed
        for one in range(MOST_CIRCLES):
            if worth[at, one] <= 0:
                continue
            row = circles[at, one]
            shift = math.hypot(row[EAST] - east, row[NORTH] - north)
            swell = abs(row[RADIUS] - radius)
            if shift <= nearest and swell <= limits.swell_m + limits.swell * radius:
                best, nearest = one, shift
        if best >= 0:
            chain[at] = best
            last = at


@kernel
def _expected(
    circles: Floats,
    chain: Integers,
    steps: tuple[int, int, int],
    lean: tuple[float, float],
    remembered: int,
) -> tuple[float, float, float]:
    """Middle and radius that the circles behind tell of a slab: a line, and the median."""
    last, step, at = steps
    slabs = np.zeros(remembered)
    rows = np.zeros((remembered, 3))
    count = 0
    behind = last
    while 0 <= behind < len(circles) and count < remembered:
        if chain[behind] >= 0:
            slabs[count] = behind
            rows[count] = circles[behind, chain[behind], EAST : RADIUS + 1]
            count += 1
        behind -= step
    radius = np.median(rows[:count, 2])
    if count < _LINE_FROM:
        ahead = at - slabs[0]
        return rows[0, 0] + ahead * lean[0], rows[0, 1] + ahead * lean[1], radius
    middle = slabs[:count].mean()
    off = slabs[:count] - middle
    ahead = (at - middle) / (off**2).sum()
    east = rows[:count, 0].mean() + (off * rows[:count, 0]).sum() * ahead
    north = rows[:count, 1].mean() + (off * rows[:count, 1]).sum() * ahead
    return east, north, radius


@kernel
def lean_kernel(
    circles: Floats, worth: Floats, slab: int, number: int, limits: ChainLimits
) -> tuple[float, float]:
    """How a stem leans whose circle this is, from slab to slab: by the line that meets most worth.

    Upright unless a line that leans meets clearly more.
    """
    own = circles[slab, number]
    best, east, north = (
        _LEANS_BY * _met_by(circles, worth, (slab, number), (0.0, 0.0), limits),
        0.0,
        0.0,
    )
    for at in range(max(0, slab - _LINE_OVER), min(len(circles), slab + _LINE_OVER + 1)):
        for one in range(MOST_CIRCLES):
            if at == slab or worth[at, one] <= 0:
                continue
            row = circles[at, one]
            steps = at - slab
            lean = ((row[EAST] - own[EAST]) / steps, (row[NORTH] - own[NORTH]) / steps)
            if math.hypot(lean[0], lean[1]) > limits.lean_m:
                continue
            met = _met_by(circles, worth, (slab, number), lean, limits)
            if met > best:
                best, east, north = met, lean[0], lean[1]
    return east, north


@kernel
def _met_by(
    circles: Floats,
    worth: Floats,
    seed: tuple[int, int],
    lean: tuple[float, float],
    limits: ChainLimits,
) -> float:
    """The worth of the circles like one on a line through its middle, the nearest of each slab."""
    own, total = circles[seed[0], seed[1]], 0.0
    for at in range(len(circles)):
        nearest, most = limits.shift_m, 0.0
        for one in range(MOST_CIRCLES):
            row = circles[at, one]
            swell = abs(row[RADIUS] - own[RADIUS])
            if worth[at, one] <= 0 or swell > limits.swell_m + limits.swell * own[RADIUS]:
                continue
            steps = at - seed[0]
            away = math.hypot(
                row[EAST] - own[EAST] - steps * lean[0], row[NORTH] - own[NORTH] - steps * lean[1]
            )
            if away <= nearest:
                nearest, most = away, worth[at, one]
        total += most
    return total
