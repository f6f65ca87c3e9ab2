"""The loops that follow the surface along a row and note where it is open.

A row is followed from the vehicle outwards, to each side. The surface is the straight line through
the last points taken for it; what dips below and comes back to that line is an opening, what leaves
it for good is the end of a stretch, and so is all of a wall. Lines are sums over runs of taken
points, so a point costs the same however many points a line has.

Work arrays: ``taken`` (7, n + 1) float64 holds along, height, and the running sums of along,
height, along², along × height, height²; ``origin`` (2, n) int64 holds the point's place in the row
and the number of its piece of surface.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

SURFACE_X, SURFACE_Y, SURFACE_Z, DEPTH, WIDTH, SIGNIFICANCE, SIDES_OFF, LOST_PULSES, PATTERN = (
    range(9)
)
FOUND = 9
"""Columns of what is found: x, y, z on the surface, depth, width, m; significance; RMS of the
sides, m; lost pulses; pattern."""

_SWEEP, _POINT_BEFORE, _POINT_AFTER = range(3)
"""Columns of where it was found: sweep, point before, point after."""

_ALONG, _HEIGHT, _SUMS = 0, 1, 2
"""Rows of ``taken``; running sums begin with the last."""

_TAKEN_ROWS, _SUM_ROWS = 7, 5
_IN_ROW, _PIECE = range(2)
"""Rows of ``origin``: a taken point's place in the row, the number of its piece of surface."""

_OPENING, _DENT, _LOST, _JOINT = 1.0, 2.0, 4.0, 8.0
"""Bits of a pattern: see `notches`."""

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_FEWEST, _MOST, _LINE_M = 5, 24, 0.30
"""Points of a line, at least and at most; between them as many as lie within so much: half a lid.
By trial."""

_OVERLAP = 12
"""Points on the other side with which a side begins, more than twice the fewest of a line."""

_BEHIND = 2
"""Points that may do behind an opening, where a wall or a curb follows. Of 29 crossings of holes
beside a curb on a street of a phase scanner 6 were noted before it, 21 with it and with rows that
are followed outwards."""

_BREAK_M = 0.30
"""A longer gap between two points of the surface ends it: half a lid. By trial."""

_WIDEST_M = 0.70
"""Openings are no wider along a row: a lid of 66 cm (Takahashi 2022, Table 7-2) that is missing."""

_LOOKED_AT, _LOOKED_AT_ABOVE = 80, 4
"""Points beyond a drop among which the surface may go on, 70 cm at 9 mm; beyond a point that is too
high, which is noise or litter. By trial."""

_DEEPEST_M = 0.8
"""Below a gutter's floor there is nothing."""

_BELOW = 0.6
"""Of the limit above: stricter below, so that the line doesn't sink between a grating's bars. By
trial."""

_STEEPEST = 0.3
"""Slope of a surface: walls are even too; no street is as steep as this."""

_BEND = 0.06
"""What the surface may turn across an opening, m per m: 1.8° to either side (Takahashi 2022, Table
7-3, 88.2°)."""

_MOST_UNSURE, _TOO_HIGH = 3.0, 3.0
"""A short line, which says little of what is far from it, widens the limit up to so many times;
what comes back to the line higher than so many limits is another surface. By trial."""

_OF_NOISE, _TEXTURE_M = 1.6, 0.0015
"""A side is smooth if its RMS is less than so many times the noise, and the pavement's texture. By
trial."""

_LEAST_OF_NOISE = 0.7
"""Share of the noise measured that a side has at least, however still its few points happen to
be."""

_SIGNIFICANT, _LEAST_LOW_M = 3.0, 0.0015
"""A dip is noted from so many standard deviations on, exceeded by normal noise once in 740 points;
a low point also only from so much, the pavement's texture."""

_LEAST_SCALE_M, _LEAST_LENGTH_M, _LEAST_SPACING_M, _LEAST_SPREAD_M2 = 1e-4, 1e-9, 1e-4, 1e-12
"""Guards of divisions."""


class Limits(NamedTuple):
    """What notches are looked for by: see `NotchParameters`; m but for the factor.

    Attributes
    ----------
    reach_m, height_range_m : float
        How far beside the vehicle's path, and above or below the road, points are looked at.
    noise_m : float
        Height noise of the road.
    aside_m, down_m, step_m : float
        h_t, z_t and z_t2.
    noise_factor : float
        Limits are at least so many times the noise.
    """

    reach_m: float
    height_range_m: float
    noise_m: float
    aside_m: float
    down_m: float
    step_m: float
    noise_factor: float


class Sweeps(NamedTuple):
    """Rows: first point and end (s, 2), road below the vehicle (s, 3), unit to the right (s, 2)."""

    spans: Integers
    positions: Floats
    rights: Floats


class _Line(NamedTuple):
    """A line: middle along, height there, m; slope; sum of squares along, m²; RMS, m; points."""

    middle: float
    height: float
    slope: float
    spread: float
    off: float
    points: int


class _Surface(NamedTuple):
    """The surface about an opening: height at 0 along, slope, limit, its last point along; m."""

    level: float
    slope: float
    floor: float
    last: float


class _Gap(NamedTuple):
    """Points of the row before and after an opening, and how many pulses were lost in it."""

    before: int
    after: int
    lost: int


class _Low(NamedTuple):
    """Points of the row before and at a low one, and how low it lies, m."""

    before: int
    at: int
    low: float


@kernel
def notches_kernel(
    xyz: Floats,
    pulse: Integers,
    sweeps: Sweeps,
    limits: Limits,
    out: tuple[Floats, Integers],
) -> int:
    """Notches of rows; returns how many were noted.

    Parameters
    ----------
    xyz : (n, 3)
        Local, m, in the order of measurement.
    sweeps : Sweeps
    limits : Limits
    out : (m, FOUND), (m, 3)
        What is found, and where.
    """
    spans, positions, rights = sweeps
    longest = 1
    for sweep in range(len(positions)):
        longest = max(longest, spans[sweep, 1] - spans[sweep, 0])
    near, outwards = np.empty(longest, np.int64), np.empty(longest, np.int64)
    along = np.empty(longest)
    taken = np.zeros((_TAKEN_ROWS, longest + 1))
    origin = np.empty((2, longest), np.int64)
    count = 0
    for sweep in range(len(positions)):
        row = (spans[sweep, 0], spans[sweep, 1])
        size, middle = _near_kernel(xyz, row, positions[sweep], rights[sweep], limits, near)
        before = count
        for side in range(2):
            used = _side_kernel(near, (size, middle), side, outwards)
            if used < 2 * _FEWEST:
                continue
            _along_kernel(xyz, outwards, used, along)
            used = _follow_kernel((xyz, outwards, along), used, limits, taken, origin)
            count = _weigh_kernel((xyz, pulse, outwards), taken, origin, used, limits, count, out)
        for one in range(before, count):
            out[1][one, _SWEEP] = sweep
    return count


@kernel
def _side_kernel(near: Integers, row: tuple[int, int], side: int, outwards: Integers) -> int:
    """Points of one side of a row, from the vehicle outwards: from the road to what is rough."""
    size, middle = row
    if side == 0:
        first = max(middle - _OVERLAP, 0)
        outwards[: size - first] = near[first:size]
        return size - first
    count = min(middle + _OVERLAP, size)
    outwards[:count] = near[:count][::-1]
    return count


@kernel
def _near_kernel(
    xyz: Floats,
    row: tuple[int, int],
    position: Floats,
    right: Floats,
    limits: Limits,
    near: Integers,
) -> tuple[int, int]:
    """Points of a row that may be on the road or beside it; how many, and the nearest of them."""
    size, middle, least = 0, 0, np.inf
    for point in range(row[0], row[1]):
        east, north = xyz[point, 0] - position[0], xyz[point, 1] - position[1]
        across = east * right[0] + north * right[1]
        ahead, above = north * right[0] - east * right[1], xyz[point, 2] - position[2]
        if (
            max(abs(across), abs(ahead) / 2.0) <= limits.reach_m
            and abs(above) <= limits.height_range_m
        ):
            near[size] = point
            if abs(across) < least:
                least, middle = abs(across), size
            size += 1
    return size, middle


@kernel
def _along_kernel(xyz: Floats, near: Integers, size: int, along: Floats) -> None:
    """Where points are along their row: in plan from its first to its last point."""
    first, last = near[0], near[size - 1]
    east, north = xyz[last, 0] - xyz[first, 0], xyz[last, 1] - xyz[first, 1]
    length = max(np.sqrt(east * east + north * north), _LEAST_LENGTH_M)
    east, north = east / length, north / length
    for one in range(size):
        point = near[one]
        along[one] = (xyz[point, 0] - xyz[first, 0]) * east + (
            xyz[point, 1] - xyz[first, 1]
        ) * north


@kernel
def _take(taken: Floats, at: int, along: float, height: float) -> None:
    taken[_ALONG, at] = along
    taken[_HEIGHT, at] = height
    for k, value in enumerate((along, height, along * along, along * height, height * height)):
        taken[_SUMS + k, at + 1] = taken[_SUMS + k, at] + value


@kernel
def _line(taken: Floats, first: tuple[int, int], second: tuple[int, int]) -> _Line:
    """Line through two runs of taken points."""
    count = (first[1] - first[0]) + (second[1] - second[0])
    sums = np.zeros(_SUM_ROWS)
    for one in range(_SUM_ROWS):
        row = taken[_SUMS + one]
        sums[one] = row[first[1]] - row[first[0]] + row[second[1]] - row[second[0]]
    along, heights, along_2, shared, heights_2 = sums[0], sums[1], sums[2], sums[3], sums[4]
    middle, height = along / count, heights / count
    spread = max(along_2 - along * middle, _LEAST_SPREAD_M2)
    shared -= along * height
    slope = shared / spread
    rest = max(heights_2 - heights * height - slope * shared, 0.0)
    return _Line(middle, height, slope, spread, np.sqrt(rest / max(count - 2, 1)), count)


@kernel
def _reach_of(taken: Floats, start: int, at: int) -> int:
    """How many of the taken points before ``at`` make a line."""
    step = min(at - start, _FEWEST) - 1
    if step < 1:
        return at - start
    spacing = max((taken[_ALONG, at - 1] - taken[_ALONG, at - 1 - step]) / step, _LEAST_SPACING_M)
    return min(at - start, max(_FEWEST, min(_MOST, int(_LINE_M / spacing))))


@kernel
def _follow_kernel(
    row: tuple[Floats, Integers, Floats], size: int, limits: Limits, taken: Floats, origin: Integers
) -> int:
    """Take the points of a row that are on the surface; how many."""
    xyz, near, along = row
    floor = max(limits.down_m, limits.noise_factor * limits.noise_m)
    base = xyz[near[0], 2]
    used, start, piece, one = 0, 0, 0, 0
    while one < size:
        height = xyz[near[one], 2] - base
        following = one
        is_far = used > start and abs(along[one] - taken[_ALONG, used - 1]) > _BREAK_M
        is_off = False
        if used - start >= _FEWEST:
            lengths = _reach_of(taken, start, used)
            line = _line(taken, (used - lengths, used), (used, used))
            slope, aside = line.slope, along[one] - line.middle
            # A short line says little of what is far from it.
            sure = np.sqrt(1.0 + 1.0 / line.points + aside * aside / line.spread)
            limit = min(floor * sure, _MOST_UNSURE * floor)
            off = height - line.height - slope * aside
            is_off = off > limit or off < -limit * _BELOW
            # A beam that fell through a hole comes down far beyond it.
            if is_off and (off < 0.0 or not is_far) and abs(slope) <= _STEEPEST:
                level = line.height - slope * line.middle + base
                surface = _Surface(level, slope, floor, taken[_ALONG, used - 1])
                following = _return_kernel(row, one, size, surface)
        if following == one and (is_far or is_off):
            start, piece = used, piece + 1
        if following > one:
            one = following
            continue
        _take(taken, used, along[one], height)
        origin[_IN_ROW, used] = one
        origin[_PIECE, used] = piece
        used += 1
        one += 1
    return used


@kernel
def _return_kernel(
    row: tuple[Floats, Integers, Floats],
    one: int,
    size: int,
    surface: _Surface,
) -> int:
    """The first point after ``one`` that is on the line again; or ``one``.

    What follows it may be low again, as between the bars of a grating, but not high.
    """
    xyz, near, along = row
    level, slope, floor, last = surface
    is_below = xyz[near[one], 2] < level + slope * along[one]
    for other in range(
        one + 1, min(size - 1, one + (_LOOKED_AT if is_below else _LOOKED_AT_ABOVE))
    ):
        gap = abs(along[other] - last)
        limit = floor + _BEND * min(gap, _WIDEST_M)
        off = xyz[near[other], 2] - level - slope * along[other]
        if off < -_BELOW * limit:
            continue
        if gap > _WIDEST_M or (is_below and off > _TOO_HIGH * limit):
            return one
        after = xyz[near[other + 1], 2] - level - slope * along[other + 1]
        if off <= limit and after <= limit + floor:
            return other
    return one


@kernel
def _weigh_kernel(
    row: tuple[Floats, Integers, Integers],
    taken: Floats,
    origin: Integers,
    used: int,
    limits: Limits,
    count: int,
    out: tuple[Floats, Integers],
) -> int:
    """Note the openings between taken points, and taken points that lie low; how many there are."""
    noise = limits.noise_m
    smooth = _OF_NOISE * noise + _TEXTURE_M
    start = 0
    quiet = -1
    for at in range(1, used - _BEHIND):
        if origin[_PIECE, at] != origin[_PIECE, at - 1]:
            start = at
        before, after = origin[_IN_ROW, at - 1], origin[_IN_ROW, at]
        lost = _lost(row[1], row[2][before], row[2][after], after - before)
        is_open = after - before > 1 or lost > 0
        if count >= len(out[0]) or at - start < _FEWEST or at <= quiet:
            continue
        ahead = at if is_open else at + 1
        lengths = _reach_of(taken, start, at)
        end = ahead
        while end < used and end - ahead < lengths and origin[_PIECE, end] == origin[_PIECE, at]:
            end += 1
        is_long = is_open and at - start >= 2 * _FEWEST
        if end - ahead < (_BEHIND if is_long else _FEWEST):
            continue
        line = _sides(taken, (at, ahead), (at - lengths, end), smooth if is_open else np.inf)
        # Noise alone never gets the benefit of a window that happens to be still.
        scale = max(line.off, _LEAST_OF_NOISE * noise)
        if line.off > smooth or abs(line.slope) > _STEEPEST:
            continue
        if is_open:
            _note_opening(row, _Gap(before, after, lost), taken, at, line, limits, count, out)
            depth = out[0][count, DEPTH]
            if depth <= _DEEPEST_M and (lost > 0 or depth > _SIGNIFICANT * scale):
                count += 1
            continue
        low = line.height + line.slope * (taken[_ALONG, at] - line.middle) - taken[_HEIGHT, at]
        if low > _SIGNIFICANT * scale and low > _LEAST_LOW_M:
            _note_low(row, _Low(before, after, low), taken, at, line, scale, count, out)
            quiet = at + 1
            count += 1
    return count


@kernel
def _sides(taken: Floats, inner: tuple[int, int], outer: tuple[int, int], smooth: float) -> _Line:
    """The line through what is taken before and after a place; the nearest if all is not smooth.

    A lid may lie a little higher or lower than what is beside it.
    """
    line = _line(taken, (outer[0], inner[0]), (inner[1], outer[1]))
    if line.off > smooth:
        before = max(outer[0], inner[0] - _FEWEST)
        line = _line(taken, (before, inner[0]), (inner[1], min(outer[1], inner[1] + _FEWEST)))
    return line


@kernel
def _lost(pulse: Integers, before: int, after: int, steps: int) -> int:
    """Pulses without return between two points."""
    first, last = min(before, after), max(before, after)
    if pulse[last] - pulse[first] <= steps:
        return 0
    lost = 0
    for point in range(first + 1, last + 1):
        lost += max(pulse[point] - pulse[point - 1] - 1, 0)
    return lost


@kernel
def _note_opening(
    row: tuple[Floats, Integers, Integers],
    gap: _Gap,
    taken: Floats,
    at: int,
    line: _Line,
    limits: Limits,
    count: int,
    out: tuple[Floats, Integers],
) -> None:
    xyz, pulse, near = row
    before, after, lost = gap
    point, other = near[before], near[after]
    base = xyz[point, 2] - taken[_HEIGHT, at - 1]
    middle = (taken[_ALONG, at - 1] + taken[_ALONG, at]) / 2
    surface = line.height + line.slope * (middle - line.middle) + base
    depth = 0.0
    pattern = _LOST if lost > 0 else 0.0
    for one in range(before + 1, after):
        depth = max(depth, surface - xyz[near[one], 2])
    for one in range(max(before, 1), min(after, near.size - 2) + 1):
        here, back, on = near[one], near[one - 1], near[one + 1]
        if one == after and after - before == 1:
            break
        if abs(pulse[on] - pulse[here]) > 1 or abs(pulse[here] - pulse[back]) > 1:
            continue
        bent = xyz[on] - 2.0 * xyz[here] + xyz[back]
        is_aside = bent[0] ** 2 + bent[1] ** 2 >= limits.aside_m**2
        if is_aside and abs(bent[2]) >= limits.down_m:
            pattern = pattern + _OPENING if int(pattern) & 1 == 0 else pattern
        if abs(xyz[on, 2] - xyz[back, 2]) >= limits.step_m:
            pattern = pattern + _DENT if int(pattern) & 2 == 0 else pattern
    if after - before > 1 and int(pattern) & 3 == 0:
        pattern += _JOINT
    found = out[0][count]
    found[SURFACE_X] = (xyz[point, 0] + xyz[other, 0]) / 2
    found[SURFACE_Y] = (xyz[point, 1] + xyz[other, 1]) / 2
    found[SURFACE_Z] = surface
    found[DEPTH] = depth
    found[WIDTH] = taken[_ALONG, at] - taken[_ALONG, at - 1]
    scale = max(line.off, _LEAST_OF_NOISE * limits.noise_m, _LEAST_SCALE_M)
    found[SIGNIFICANCE] = depth / scale
    found[SIDES_OFF] = line.off
    found[LOST_PULSES] = lost
    found[PATTERN] = pattern
    out[1][count, _POINT_BEFORE] = min(point, other)
    out[1][count, _POINT_AFTER] = max(point, other)


@kernel
def _note_low(
    row: tuple[Floats, Integers, Integers],
    low_one: _Low,
    taken: Floats,
    at: int,
    line: _Line,
    scale: float,
    count: int,
    out: tuple[Floats, Integers],
) -> None:
    xyz, _, near = row
    before, after, low = low_one
    found = out[0][count]
    found[SURFACE_X], found[SURFACE_Y] = xyz[near[after], 0], xyz[near[after], 1]
    found[SURFACE_Z] = xyz[near[after], 2] + low
    found[DEPTH] = low
    found[WIDTH] = taken[_ALONG, at + 1] - taken[_ALONG, at - 1]
    found[SIGNIFICANCE] = low / scale
    found[SIDES_OFF] = line.off
    found[LOST_PULSES] = 0.0
    found[PATTERN] = _JOINT
    out[1][count, _POINT_BEFORE] = min(near[before], near[after + 1])
    out[1][count, _POINT_AFTER] = max(near[before], near[after + 1])


def warm_up() -> None:
    """Compile the kernels of this file."""
    sweeps = Sweeps(np.array([[0, 4]]), np.zeros((1, 3)), np.array([[1.0, 0.0]]))
    limits = Limits(6.5, 1.5, 0.003, 0.02, 0.01, 0.1, 4.0)
    out = (np.empty((4, FOUND)), np.empty((4, 3), np.int64))
    notches_kernel(np.zeros((4, 3)), np.arange(4), sweeps, limits, out)
