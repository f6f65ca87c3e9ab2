"""Loops that follow scan lines over upright things and cut what they draw into straight pieces."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import cell_of
from processing.methods.road.signs.brightness import NO_BRIGHTNESS, SHINING, Brightness

ORIGIN_EVERY = 256
"""Points that share a place of the scanner: a thousandth of a second, 3 cm of the way."""

LOW, DULL, BRIGHT = 0, 1, 2
"""Of a point: too near to the ground, or so bright."""

FREE, STEP, HIDDEN, GOES_ON = 0, 1, 2, 3
"""What lies beyond the end of a piece: nothing or something far behind; something a little behind;
something nearer; the same thing."""

PIECE = 19
FROM, TO, COUNT, BRIGHTS, BEFORE, BEHIND, FIRST, LAST, SPACING, NOISE, VIEW = (
    0, 3, 6, 7, 8, 9, 10, 11, 12, 13, 14,
)  # fmt: skip
SHINE = 18
"""Values of a piece; `FROM`, `TO` (its ends, m) take three, `VIEW` (from the scanner, and how far)
four; `SHINE` is the sum of how many standard deviations its points are brighter than the middle of
diffuse things at their range."""

_MOST_SHINE = 2 * SHINING
"""Of a point: twice what a face has at least, so that one mirror on a back doesn't outshine it."""

_OPEN_RUNS = 4
"""Runs that are followed at a time: a plate, the leaves before it and what shows between them."""

_MISSING = 6
"""Pulses that a run may lack: leaves before a plate."""

_LOOSE = 2.5
"""Distance of neighbours over that of a surface seen straight on: one seen under 66 degrees."""

_GRAZED, _GRAZED_M = 20.0, 0.25
"""The same, over that of a surface seen straight on and in m, of a face seen under 87 degrees, as
scanners see it that look straight across the road. What shines beside what shines is one face; of
dull things the next point has to lie as far again on the same line."""

_AS_BEFORE = 1.5
"""Of a run that is looser already: the next step over the last one."""

_FAR_M = 0.25
"""What lies so far behind the end of a plate is no part of what it hangs on; a window's recess is
less deep (サッシ: 10 to 20 cm)."""


_SLIT_M = 0.03
"""So far beyond its end a piece goes on behind what passed before it; plates hang farther apart."""

_SYMBOL_M, _DULL_BEYOND, _MOST_BEYOND = 0.25, 3, 100
"""Beyond a bright piece so far nothing shines and so many pulses, of at most so many, met dull
things: the rim of a plate on a wall or a pole. Dark symbols on a face are smaller (標識令,
別表第二), and it shines again behind them."""


class PieceLimits(NamedTuple):
    """What is followed.

    ``lowest_m``: above the ground; ``radians``: between pulses; ``straight_m``: off a line;
    ``shortest_m``, ``longest_m``: of a piece; ``has_origin``: whether the scanner's place is known;
    ``usual_m``: range where it is not; ``brightness``: of diffuse things.
    """

    lowest_m: float
    radians: float
    straight_m: float
    shortest_m: float
    longest_m: float
    has_origin: bool
    usual_m: float
    brightness: Brightness = NO_BRIGHTNESS


class ChunkPoints(NamedTuple):
    """Points of a drive in the order of its pulses, and where the scanner was at every 256th.

    Places are in m about the origin of the plan.
    """

    local: Floats
    pulses: Integers
    is_noise: NDArray[np.bool_]
    intensity: NDArray[np.uint16]
    origins: Floats


@kernel
def range_of(chunk: ChunkPoints, point: int, limits: PieceLimits) -> float:
    """How far a point is from the scanner, m."""
    if not limits.has_origin:
        return limits.usual_m
    place = chunk.origins[point // ORIGIN_EVERY]
    east = chunk.local[point, 0] - place[0]
    north = chunk.local[point, 1] - place[1]
    up = chunk.local[point, 2] - place[2]
    return math.sqrt(east * east + north * north + up * up)


def ranges_of(chunk: ChunkPoints, limits: PieceLimits) -> Floats:
    """(n,) how far points are from the scanner, m."""
    if not limits.has_origin:
        return np.full(len(chunk.local), limits.usual_m)
    places = np.repeat(chunk.origins, ORIGIN_EVERY, axis=0)[: len(chunk.local)]
    return np.asarray(np.linalg.norm(chunk.local - places, axis=1))


@kernel
def heights_kernel(
    local: Floats,
    table: NDArray[np.int32],
    ground: NDArray[np.float32],
    heights: NDArray[np.float32],
) -> None:
    """Heights above the ground; NaN where none is known."""
    for point in range(len(local)):
        cell = cell_of(local[point, 0], local[point, 1], table, GROUND_CELLS)
        heights[point] = local[point, 2] - ground[cell] if cell >= 0 else np.nan


@kernel
def brightness_kernel(
    chunk: ChunkPoints,
    heights: NDArray[np.float32],
    limits: PieceLimits,
    kinds: NDArray[np.uint8],
) -> None:
    """Whether points are low, dull or bright."""
    for point in range(len(heights)):
        kinds[point] = LOW
        if chunk.is_noise[point] or not heights[point] >= limits.lowest_m:
            continue
        kinds[point] = BRIGHT if shine_of(chunk, point, limits) >= SHINING else DULL


@kernel
def shine_of(chunk: ChunkPoints, point: int, limits: PieceLimits) -> float:
    """How many standard deviations a point is brighter than the middle of diffuse things."""
    brightness = limits.brightness
    number = range_class(range_of(chunk, point, limits), len(brightness.steps))
    above = chunk.intensity[point] - brightness.middles[number]
    shine: float = above / brightness.steps[number]
    return shine


@kernel
def range_class(range_m: float, classes: int) -> int:
    """Classes of ranges, each half as wide again as the one before: the first ends at 4 m."""
    if range_m <= 4.0:
        return 0
    return min(int(math.log(range_m / 4.0) / math.log(1.5)) + 1, classes - 1)


def range_classes(ranges: Floats, classes: int) -> Integers:
    """(n,) int64: the class of each of (n,) ranges, as of `range_class`."""
    found = np.empty(len(ranges), np.int64)
    range_classes_kernel(ranges, classes, found)
    return found


@kernel
def range_classes_kernel(ranges: Floats, classes: int, found: Integers) -> None:
    """Write the class of each range."""
    for one in range(len(ranges)):
        found[one] = range_class(ranges[one], classes)


@kernel
def runs_kernel(
    chunk: ChunkPoints,
    kinds: NDArray[np.uint8],
    limits: PieceLimits,
    runs: NDArray[np.int32],
) -> int:
    """Number the runs of points that follow each other closely in the order of the pulses.

    Parameters
    ----------
    runs : (n,) int32
        Filled: the run of each point, −1: none.

    Returns
    -------
    int
        How many runs there are.
    """
    count = 0
    last, steps = np.full(_OPEN_RUNS, -1, np.int64), np.zeros(_OPEN_RUNS)
    for point in range(len(kinds)):
        runs[point] = -1
        if kinds[point] == LOW:
            continue
        step = range_of(chunk, point, limits) * limits.radians
        best, least = _nearest_run(chunk, point, last)
        loose = _LOOSE * step + 2 * limits.straight_m
        if best >= 0 and least > loose:
            loose = _AS_BEFORE * steps[best]
            if least > loose and _is_grazed(chunk, kinds, last[best], point, limits.straight_m):
                loose = min(_GRAZED * step, _GRAZED_M)
        if best < 0 or least > loose:
            # The run that was followed last of all gives way.
            best = 0
            for slot in range(_OPEN_RUNS):
                if last[slot] < last[best]:
                    best = slot
            runs[point] = count
            steps[best] = 0.0
            count += 1
        else:
            runs[point] = runs[last[best]]
            steps[best] = least
        last[best] = point
    return count


@kernel
def _is_grazed(
    chunk: ChunkPoints, kinds: NDArray[np.uint8], last: int, point: int, straight_m: float
) -> bool:
    """Whether two points far apart may follow each other on a surface that is seen askew."""
    if kinds[last] == BRIGHT and kinds[point] == BRIGHT:
        return True
    ahead = chunk.pulses[point] - chunk.pulses[last]
    follower = point + 1
    if follower >= len(kinds) or chunk.pulses[follower] - chunk.pulses[point] != ahead:
        return False
    off = 0.0
    for axis in range(3):
        expected = 2 * chunk.local[point, axis] - chunk.local[last, axis]
        off += (chunk.local[follower, axis] - expected) ** 2
    return off <= (2 * straight_m) ** 2


@kernel
def _nearest_run(chunk: ChunkPoints, point: int, last: Integers) -> tuple[int, float]:
    """The open run whose last point is nearest, over the pulses between; −1: none is open.

    Runs that ended too long ago are closed.
    """
    best, least = -1, math.inf
    for slot in range(_OPEN_RUNS):
        if last[slot] < 0:
            continue
        ahead = chunk.pulses[point] - chunk.pulses[last[slot]]
        if ahead > _MISSING or ahead < 0:
            last[slot] = -1
        elif ahead > 0:
            off = _apart(chunk.local, point, last[slot]) / ahead
            if off < least:
                best, least = slot, off
    return best, least


@kernel
def _apart(local: Floats, one: int, other: int) -> float:
    east = local[one, 0] - local[other, 0]
    north = local[one, 1] - local[other, 1]
    up = local[one, 2] - local[other, 2]
    return math.sqrt(east * east + north * north + up * up)


@kernel
def pieces_kernel(
    chunk: ChunkPoints,
    kinds: NDArray[np.uint8],
    runs: NDArray[np.int32],
    limits: PieceLimits,
    pieces: Floats,
) -> int:
    """Cut runs into straight pieces and keep those that may be of a plate.

    Parameters
    ----------
    pieces : (m, PIECE) float64
        Filled from the start; with room for a piece of every third point.

    Returns
    -------
    int
        How many pieces were kept.
    """
    starts, points = _by_run(runs)
    kept = 0
    stack = np.empty((256, 2), np.int64)
    for run in range(len(starts) - 1):
        first, stop = starts[run], starts[run + 1]
        if stop - first < 2:
            continue
        depth = 1
        stack[0, 0], stack[0, 1] = first, stop - 1
        while depth > 0:
            depth -= 1
            low, high = stack[depth, 0], stack[depth, 1]
            cut = _cut_of(chunk.local, points, low, high, limits.straight_m)
            if cut < 0:
                cut = _change_of(kinds, points, low, high)
            if cut < 0:
                kept += _keep(chunk, kinds, points[low : high + 1], limits, pieces[kept])
            elif depth + 2 < len(stack):
                stack[depth, 0], stack[depth, 1] = low, cut
                stack[depth + 1, 0], stack[depth + 1, 1] = cut + 1, high
                depth += 2
    return kept


@kernel
def _by_run(runs: NDArray[np.int32]) -> tuple[Integers, Integers]:
    """Where the points of each run begin, and the points run by run, in their order."""
    total = 0
    for point in range(len(runs)):
        total = max(total, runs[point] + 1)
    starts = np.zeros(total + 1, np.int64)
    for point in range(len(runs)):
        if runs[point] >= 0:
            starts[runs[point] + 1] += 1
    for run in range(total):
        starts[run + 1] += starts[run]
    filled = starts.copy()
    points = np.empty(starts[total], np.int64)
    for point in range(len(runs)):
        if runs[point] >= 0:
            points[filled[runs[point]]] = point
            filled[runs[point]] += 1
    return starts, points


@kernel
def _cut_of(local: Floats, points: Integers, low: int, high: int, straight_m: float) -> int:
    """Behind which point a run is cut; −1: it is straight."""
    if high - low < 2:
        return -1
    a, b = points[low], points[high]
    east = local[b, 0] - local[a, 0]
    north = local[b, 1] - local[a, 1]
    up = local[b, 2] - local[a, 2]
    long_m = math.sqrt(east * east + north * north + up * up)
    if long_m < 1e-6:
        return (low + high) // 2
    east, north, up = east / long_m, north / long_m, up / long_m
    worst, at = 0.0, -1
    for k in range(low + 1, high):
        x = local[points[k], 0] - local[a, 0]
        y = local[points[k], 1] - local[a, 1]
        z = local[points[k], 2] - local[a, 2]
        along = x * east + y * north + z * up
        off = x * x + y * y + z * z - along * along
        if off > worst:
            worst, at = off, k
    if worst <= straight_m * straight_m:
        return -1
    # The farther point stays with the nearer end of its own.
    before = _apart(local, points[at], points[at - 1])
    after = _apart(local, points[at], points[at + 1])
    return at - 1 if before > after else at


@kernel
def _change_of(kinds: NDArray[np.uint8], points: Integers, low: int, high: int) -> int:
    """Behind which point at least three bright ones follow three dull ones or the reverse."""
    for k in range(low + 2, high - 2):
        one = kinds[points[k]]
        if (
            kinds[points[k - 1]] == one
            and kinds[points[k - 2]] == one
            and kinds[points[k + 1]] != one
            and kinds[points[k + 2]] != one
            and kinds[points[k + 3]] != one
        ):
            return k
    return -1


@kernel
def _keep(
    chunk: ChunkPoints,
    kinds: NDArray[np.uint8],
    points: Integers,
    limits: PieceLimits,
    piece: Floats,
) -> int:
    """Measure a piece; 1 if it may be of a plate, else 0."""
    count, bright = len(points), 0
    for k in range(count):
        bright += kinds[points[k]] == BRIGHT
    is_bright = 2 * bright > count
    if count < (2 if is_bright else 3):
        return 0
    _fit_line(chunk.local, points, piece)
    long_m = math.sqrt(
        (piece[TO] - piece[FROM]) ** 2
        + (piece[TO + 1] - piece[FROM + 1]) ** 2
        + (piece[TO + 2] - piece[FROM + 2]) ** 2
    )
    if long_m > limits.longest_m or (long_m < limits.shortest_m and not is_bright):
        return 0
    before = _beyond(chunk, points, -1, long_m, limits)
    behind = _beyond(chunk, points, 1, long_m, limits)
    middle = points[count // 2]
    piece[COUNT], piece[BRIGHTS] = count, bright
    if is_bright and before == GOES_ON and _is_dull_beyond(chunk, kinds, points, -1, long_m):
        before = STEP
    if is_bright and behind == GOES_ON and _is_dull_beyond(chunk, kinds, points, 1, long_m):
        behind = STEP
    piece[BEFORE], piece[BEHIND] = before, behind
    piece[FIRST], piece[LAST] = points[0], points[count - 1]
    pulses = chunk.pulses[points[count - 1]] - chunk.pulses[points[0]]
    piece[SPACING] = long_m / max(1, pulses)
    range_m = range_of(chunk, middle, limits)
    for axis in range(3):
        place = chunk.origins[middle // ORIGIN_EVERY, axis]
        piece[VIEW + axis] = (chunk.local[middle, axis] - place) / range_m
    piece[VIEW + 3] = range_m
    shine = 0.0
    for k in range(count):
        shine += min(shine_of(chunk, points[k], limits), _MOST_SHINE)
    piece[SHINE] = shine
    return 1


@kernel
def _fit_line(local: Floats, points: Integers, piece: Floats) -> None:
    """Ends of the straight line through points, and how far they lie off it."""
    a, b = points[0], points[len(points) - 1]
    long_m = max(_apart(local, a, b), 1e-9)
    sum_t, sum_tt = 0.0, 0.0
    sums, products = np.zeros(3), np.zeros(3)
    for k in range(len(points)):
        t = 0.0
        for axis in range(3):
            t += (local[points[k], axis] - local[a, axis]) * (local[b, axis] - local[a, axis])
        t /= long_m
        sum_t += t
        sum_tt += t * t
        for axis in range(3):
            value = local[points[k], axis] - local[a, axis]
            sums[axis] += value
            products[axis] += t * value
    n = len(points)
    spread = sum_tt - sum_t * sum_t / n
    for axis in range(3):
        slope = (products[axis] - sum_t * sums[axis] / n) / spread if spread > 1e-12 else 0.0
        start = (sums[axis] - slope * sum_t) / n
        piece[FROM + axis] = local[a, axis] + start
        piece[TO + axis] = local[a, axis] + start + slope * long_m
    off = 0.0
    for k in range(n):
        t = 0.0
        for axis in range(3):
            t += (local[points[k], axis] - local[a, axis]) * (local[b, axis] - local[a, axis])
        t /= long_m
        for axis in range(3):
            line = piece[FROM + axis] + (piece[TO + axis] - piece[FROM + axis]) * t / long_m
            off += (local[points[k], axis] - line) ** 2
    piece[NOISE] = math.sqrt(off / max(1, n - 2))


@kernel
def _beyond(
    chunk: ChunkPoints, points: Integers, way: int, long_m: float, limits: PieceLimits
) -> int:
    """What the pulses beyond an end of a piece met."""
    end = points[len(points) - 1] if way > 0 else points[0]
    other = points[0] if way > 0 else points[len(points) - 1]
    steps = max(1, abs(chunk.pulses[end] - chunk.pulses[other]))
    step = long_m / steps
    point = end + way
    found, is_first = FREE, True
    while 0 <= point < len(chunk.pulses):
        ahead = abs(chunk.pulses[point] - chunk.pulses[end])
        if ahead > 2 and ahead * step > _SLIT_M:
            break
        if ahead > 0 and not chunk.is_noise[point]:
            gap, off = 0.0, 0.0
            for axis in range(3):
                along = (chunk.local[end, axis] - chunk.local[other, axis]) / max(long_m, 1e-9)
                expected = chunk.local[end, axis] + along * step * ahead
                off += (chunk.local[point, axis] - expected) ** 2
                if limits.has_origin:
                    place = chunk.origins[end // ORIGIN_EVERY, axis]
                    gap += (chunk.local[point, axis] - expected) * (chunk.local[end, axis] - place)
            off = math.sqrt(off)
            gap = gap / range_of(chunk, end, limits) if limits.has_origin else off
            least = 3 * limits.straight_m + 0.5 * step
            if off <= least or (is_first and abs(gap) <= least):
                return GOES_ON
            if is_first and ahead <= 2:
                if gap < 0:
                    found = HIDDEN
                elif gap < _FAR_M:
                    found = STEP
            is_first = False
        point += way
    return found


@kernel
def _is_dull_beyond(
    chunk: ChunkPoints, kinds: NDArray[np.uint8], points: Integers, way: int, long_m: float
) -> bool:
    """Whether nothing shines for some way beyond the end of a bright piece, and dull things do.

    One dull point alone is of a pulse that met the rim.
    """
    end = points[len(points) - 1] if way > 0 else points[0]
    other = points[0] if way > 0 else points[len(points) - 1]
    step = long_m / max(1, abs(chunk.pulses[end] - chunk.pulses[other]))
    farthest = min(int(_SYMBOL_M / max(step, 1e-3)) + 1, _MOST_BEYOND)
    dull = 0
    point = end + way
    while 0 <= point < len(kinds) and abs(chunk.pulses[point] - chunk.pulses[end]) <= farthest:
        if kinds[point] == BRIGHT:
            return False
        dull += kinds[point] == DULL
        point += way
    return dull == 1 or dull >= _DULL_BEYOND


def warm_up() -> None:
    """Compile the kernels."""
    none = np.zeros((2, 3))
    limits = PieceLimits(1.0, 0.003, 0.02, 0.1, 6.0, has_origin=True, usual_m=10.0)
    chunk = ChunkPoints(
        none, np.arange(2), np.zeros(2, np.bool_), np.zeros(2, np.uint16), np.ones((1, 3))
    )
    heights, kinds = np.full(2, 2.0, np.float32), np.zeros(2, np.uint8)
    heights_kernel(none, np.zeros((1, 1), np.int32), np.zeros(256, np.float32), heights.copy())
    brightness_kernel(chunk, heights, limits, kinds)
    runs = np.zeros(2, np.int32)
    runs_kernel(chunk, kinds, limits, runs)
    pieces_kernel(chunk, kinds, runs, limits, np.empty((2, PIECE)))
