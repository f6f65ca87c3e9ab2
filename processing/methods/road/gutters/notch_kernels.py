"""The loops that follow the surface along a row and note where it is open.

A row is followed from the vehicle outwards, to each side. The surface is the straight line through
the last points taken for it; what dips below and comes back to that line is an opening, what leaves
it for good is the end of a stretch, and so is all of a wall. Lines are sums over runs of taken
points, so a point costs the same however many points a line has.

Work arrays: ``taken`` (7, n + 1) float64 holds along, height, and the running sums of along,
height, along², along × height, height²; ``origin`` (2, n) int64 holds the point's place in the row
and the number of its stretch.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Limits = tuple[float, float, float, float, float, float, float]

FOUND = 9
"""Columns of what is found: x, y, z on the surface, depth, width, significance, sides' RMS, lost
pulses, pattern."""

_OPENING, _DENT, _LOST, _JOINT = 1.0, 2.0, 4.0, 8.0
_FEWEST = 5
_MOST = 24
_OVERLAP = 12  # points on the other side with which a side begins
_BEHIND = 2  # points that may do behind an opening, where a wall or a curb follows
_LINE_M = 0.30
_BREAK_M = 0.30
_WIDEST_M = 0.70
_LOOKED_AT = 80  # points beyond a drop, among which the surface may go on
_DEEPEST_M = 0.8  # below a gutter's floor there is nothing
_BELOW = 0.6
_STEEPEST = 0.3  # walls are even too; no street is as steep as this
_BEND = 0.06  # 1.8 degrees: what the surface may turn across an opening


@kernel
def notches_kernel(
    xyz: Floats,
    pulse: Integers,
    sweeps: tuple[Integers, Floats, Floats],
    limits: Limits,
    out: tuple[Floats, Integers],
) -> int:
    """Notches of rows; returns how many were noted.

    Parameters
    ----------
    xyz : (n, 3)
        Local, m, in the order of measurement.
    sweeps : (s, 2) first point and end; (s, 3) road below the vehicle; (s, 2) units to the right
    limits : reach, range of heights, noise, h_t, z_t, z_t2, noise factor
    out : (m, FOUND), (m, 3): sweep, point before, point after
    """
    spans, positions, rights = sweeps
    longest = 1
    for sweep in range(len(positions)):
        longest = max(longest, spans[sweep, 1] - spans[sweep, 0])
    near, outwards = np.empty(longest, np.int64), np.empty(longest, np.int64)
    along = np.empty(longest)
    taken = np.zeros((7, longest + 1))
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
            out[1][one, 0] = sweep
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
        if max(abs(across), abs(ahead) / 2.0) <= limits[0] and abs(above) <= limits[1]:
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
    length = max(np.sqrt(east * east + north * north), 1e-9)
    east, north = east / length, north / length
    for one in range(size):
        point = near[one]
        along[one] = (xyz[point, 0] - xyz[first, 0]) * east + (
            xyz[point, 1] - xyz[first, 1]
        ) * north


@kernel
def _take(taken: Floats, at: int, along: float, height: float) -> None:
    taken[0, at] = along
    taken[1, at] = height
    taken[2, at + 1] = taken[2, at] + along
    taken[3, at + 1] = taken[3, at] + height
    taken[4, at + 1] = taken[4, at] + along * along
    taken[5, at + 1] = taken[5, at] + along * height
    taken[6, at + 1] = taken[6, at] + height * height


@kernel
def _line(
    taken: Floats, first: tuple[int, int], second: tuple[int, int]
) -> tuple[float, float, float, float, float, int]:
    """Line through two runs of taken points: middle, its height, slope, spread, RMS, points."""
    count = (first[1] - first[0]) + (second[1] - second[0])
    sums = np.zeros(5)
    for one in range(5):
        row = taken[2 + one]
        sums[one] = row[first[1]] - row[first[0]] + row[second[1]] - row[second[0]]
    middle, height = sums[0] / count, sums[1] / count
    spread = max(sums[2] - sums[0] * middle, 1e-12)
    shared = sums[3] - sums[0] * height
    slope = shared / spread
    rest = max(sums[4] - sums[1] * height - slope * shared, 0.0)
    return middle, height, slope, spread, np.sqrt(rest / max(count - 2, 1)), count


@kernel
def _reach_of(taken: Floats, start: int, at: int) -> int:
    """How many of the taken points before ``at`` make a line."""
    step = min(at - start, _FEWEST) - 1
    if step < 1:
        return at - start
    spacing = max((taken[0, at - 1] - taken[0, at - 1 - step]) / step, 1e-4)
    return min(at - start, max(_FEWEST, min(_MOST, int(_LINE_M / spacing))))


@kernel
def _follow_kernel(
    row: tuple[Floats, Integers, Floats], size: int, limits: Limits, taken: Floats, origin: Integers
) -> int:
    """Take the points of a row that are on the surface; how many."""
    xyz, near, along = row
    floor = max(limits[4], limits[6] * limits[2])
    base = xyz[near[0], 2]
    used, start, stretch, one = 0, 0, 0, 0
    while one < size:
        height = xyz[near[one], 2] - base
        following = one
        is_far = used > start and abs(along[one] - taken[0, used - 1]) > _BREAK_M
        is_off = False
        if used - start >= _FEWEST:
            lengths = _reach_of(taken, start, used)
            middle, level, slope, spread, _, count = _line(
                taken, (used - lengths, used), (used, used)
            )
            aside = along[one] - middle
            # A short line says little of what is far from it.
            sure = np.sqrt(1.0 + 1.0 / count + aside * aside / spread)
            limit = min(floor * sure, 3.0 * floor)
            off = height - level - slope * aside
            # Stricter below than above, so that the line doesn't sink between a grating's bars.
            is_off = off > limit or off < -limit * _BELOW
            # A beam that fell through a hole comes down far beyond it.
            if is_off and (off < 0.0 or not is_far) and abs(slope) <= _STEEPEST:
                line = (level - slope * middle + base, slope, floor, taken[0, used - 1])
                following = _return_kernel(row, one, size, line)
        if following == one and (is_far or is_off):
            start, stretch = used, stretch + 1
        if following > one:
            one = following
            continue
        _take(taken, used, along[one], height)
        origin[0, used] = one
        origin[1, used] = stretch
        used += 1
        one += 1
    return used


@kernel
def _return_kernel(
    row: tuple[Floats, Integers, Floats],
    one: int,
    size: int,
    line: tuple[float, float, float, float],
) -> int:
    """The first point after ``one`` that is on the line again; or ``one``.

    What follows it may be low again, as between the bars of a grating, but not high.
    """
    xyz, near, along = row
    level, slope, floor, last = line
    is_below = xyz[near[one], 2] < level + slope * along[one]
    for other in range(one + 1, min(size - 1, one + (_LOOKED_AT if is_below else 4))):
        gap = abs(along[other] - last)
        limit = floor + _BEND * min(gap, _WIDEST_M)
        off = xyz[near[other], 2] - level - slope * along[other]
        if off < -_BELOW * limit:
            continue
        if gap > _WIDEST_M or (is_below and off > 3.0 * limit):
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
    noise = limits[2]
    smooth = 1.6 * noise + 0.0015
    stretch_start = 0
    quiet = -1
    for at in range(1, used - _BEHIND):
        if origin[1, at] != origin[1, at - 1]:
            stretch_start = at
        before, after = origin[0, at - 1], origin[0, at]
        lost = _lost(row[1], row[2][before], row[2][after], after - before)
        is_open = after - before > 1 or lost > 0
        if count >= len(out[0]) or at - stretch_start < _FEWEST or at <= quiet:
            continue
        ahead = at if is_open else at + 1
        lengths = _reach_of(taken, stretch_start, at)
        end = ahead
        while end < used and end - ahead < lengths and origin[1, end] == origin[1, at]:
            end += 1
        is_long = is_open and at - stretch_start >= 2 * _FEWEST
        if end - ahead < (_BEHIND if is_long else _FEWEST):
            continue
        line = _sides(taken, (at, ahead), (at - lengths, end), smooth if is_open else np.inf)
        # Noise alone never gets the benefit of a window that happens to be still.
        scale = max(line[4], 0.7 * noise)
        if line[4] > smooth or abs(line[2]) > _STEEPEST:
            continue
        if is_open:
            _note_opening(row, (before, after, lost), taken, at, line, limits, count, out)
            depth = out[0][count, 3]
            if depth <= _DEEPEST_M and (lost > 0 or depth > 3.0 * scale):
                count += 1
            continue
        low = line[1] + line[2] * (taken[0, at] - line[0]) - taken[1, at]
        if low > 3.0 * scale and low > 0.0015:
            _note_low(row, (before, after, low), taken, at, line, scale, count, out)
            quiet = at + 1
            count += 1
    return count


@kernel
def _sides(
    taken: Floats, inner: tuple[int, int], outer: tuple[int, int], smooth: float
) -> tuple[float, float, float, float, float, int]:
    """The line through what is taken before and after a place; the nearest if all is not smooth.

    A lid may lie a little higher or lower than what is beside it.
    """
    line = _line(taken, (outer[0], inner[0]), (inner[1], outer[1]))
    if line[4] > smooth:
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
    gap: tuple[int, int, int],
    taken: Floats,
    at: int,
    line: tuple[float, float, float, float, float, int],
    limits: Limits,
    count: int,
    out: tuple[Floats, Integers],
) -> None:
    xyz, pulse, near = row
    before, after, lost = gap
    point, other = near[before], near[after]
    base = xyz[point, 2] - taken[1, at - 1]
    middle = (taken[0, at - 1] + taken[0, at]) / 2
    surface = line[1] + line[2] * (middle - line[0]) + base
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
        if bent[0] ** 2 + bent[1] ** 2 >= limits[3] ** 2 and abs(bent[2]) >= limits[4]:
            pattern = pattern + _OPENING if int(pattern) & 1 == 0 else pattern
        if abs(xyz[on, 2] - xyz[back, 2]) >= limits[5]:
            pattern = pattern + _DENT if int(pattern) & 2 == 0 else pattern
    if after - before > 1 and int(pattern) & 3 == 0:
        pattern += _JOINT
    found = out[0][count]
    for axis in range(2):
        found[axis] = (xyz[point, axis] + xyz[other, axis]) / 2
    found[2] = surface
    found[3] = depth
    found[4] = taken[0, at] - taken[0, at - 1]
    found[5] = depth / max(line[4], 0.7 * limits[2], 1e-4)
    found[6] = line[4]
    found[7] = lost
    found[8] = pattern
    out[1][count, 1] = min(point, other)
    out[1][count, 2] = max(point, other)


@kernel
def _note_low(
    row: tuple[Floats, Integers, Integers],
    gap: tuple[int, int, float],
    taken: Floats,
    at: int,
    line: tuple[float, float, float, float, float, int],
    scale: float,
    count: int,
    out: tuple[Floats, Integers],
) -> None:
    xyz, _, near = row
    before, after, low = gap
    found = out[0][count]
    for axis in range(3):
        found[axis] = xyz[near[after], axis]
    found[2] += low
    found[3] = low
    found[4] = taken[0, at + 1] - taken[0, at - 1]
    found[5] = low / scale
    found[6] = line[4]
    found[7] = 0.0
    found[8] = _JOINT
    out[1][count, 1] = min(near[before], near[after + 1])
    out[1][count, 2] = max(near[before], near[after + 1])


def warm_up() -> None:
    """Compile the kernels of this file."""
    sweeps = (np.array([[0, 4]]), np.zeros((1, 3)), np.array([[1.0, 0.0]]))
    limits = (6.5, 1.5, 0.003, 0.02, 0.01, 0.1, 4.0)
    out = (np.empty((4, FOUND)), np.empty((4, 3), np.int64))
    notches_kernel(np.zeros((4, 3)), np.arange(4), sweeps, limits, out)
