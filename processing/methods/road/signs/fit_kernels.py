"""Loops that lay outlines on the scan lines of a plate: where each lies best, and how well.

A scan line that crosses a plate tells two places of its rim: between the last pulse on the plate
and the next one that missed it. So an outline fits where it leaves each line within one spacing
of pulses beyond its end. An end with something nearer before it tells only that the plate reaches
at least so far, and a turn of the scanner that met nothing tells that no plate was there.
"""

from __future__ import annotations

import math

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

LINE = 8
U, V, ALONG_U, ALONG_V, LONG, SPACING, OPEN_START, OPEN_END = range(LINE)
"""Values of a line: its start (m), direction, length, spacing of its pulses; 1 where the rim lies
within a spacing of an end, 0 where the plate may go on behind something, 2 where the line was cut
at the rim of another plate, −1 of a line that met nothing from its start on."""

_CUT = 2.0

_GAP_M = 0.12
"""Between plates on one post, at most: a pulse or two pass between them, so that scan lines go on
from one to the other."""

SIGMA_M = 0.012
"""How far ends lie off: noise, the width of the beam, an outline that was bent."""

CAP = 9.0
"""Most that an end counts: what is farther off than three times that is another thing."""

SPLIT_M = 3 * SIGMA_M
"""What goes on so far beyond an outline belongs to another plate."""

ROLL_RAD = math.radians(3.0)
"""How far plates hang askew: posts lean and clamps turn by some degrees."""

_MISSED_M = 0.05
"""How far turns that met nothing lie off where they are expected."""

_MISSED_CAP = 5.0
"""Most that such a turn counts: something may have hidden the plate from it."""

_PULL = 0.25
"""Of the middle of the interval that an end leaves: where nothing else tells, the likeliest place
is the middle; small against what lies outside of it."""

_MOST_ROLL_RAD = math.radians(12.0)
_ROLL_PER_M = 2.0
"""rad/m; so much a plate is turned where it is moved by a metre: the same at half a metre from its
middle."""

_FINE_STEP_M = 0.05
"""Plates are turned in steps finer than this."""

_LEAST_SIDE_M = 0.05
"""Of a rectangle: half of the smallest there is."""

_ROUNDS = 16
"""Steps of one length at most."""

_BACK = (3, 2, 1, 0, 7, 6, 5, 4, 9, 8, 11, 10, 13, 12)
"""Of each way in which a rectangle is changed, the one that undoes it."""

STARTS = 9
"""Places from which an outline is moved, at most."""

_MOVED = 40
"""Of all outlines at all starts that are moved: those that fit best before."""


@kernel
def chord_of(corners: Floats, line: Floats, pose: Floats) -> tuple[float, float]:
    """Where a line enters and leaves an outline, m from the line's start.

    The second is less than the first where it passes beside it.

    Parameters
    ----------
    corners : (n, 2)
        Of a convex outline, anticlockwise; of a circle one: its radius.
    """
    c, s = math.cos(pose[2]), math.sin(pose[2])
    du, dv = line[U] - pose[0], line[V] - pose[1]
    a, b = c * line[ALONG_U] + s * line[ALONG_V], c * line[ALONG_V] - s * line[ALONG_U]
    return _chord(corners, c * du + s * dv, c * dv - s * du, a, b)


@kernel
def _chord(corners: Floats, u: float, v: float, a: float, b: float) -> tuple[float, float]:
    """The same for a line from (u, v) on along (a, b), as the outline has right and up."""
    if corners.shape[0] == 1:
        along = -(u * a + v * b)
        inside = corners[0, 0] ** 2 - (u * u + v * v - along * along)
        if inside < 0.0:
            return 1.0, 0.0
        half = math.sqrt(inside)
        return along - half, along + half
    enters, leaves = -1e9, 1e9
    last = corners.shape[0] - 1
    from_u, from_v = corners[last, 0], corners[last, 1]
    for k in range(corners.shape[0]):
        to_u, to_v = corners[k, 0], corners[k, 1]
        eu, ev = to_u - from_u, to_v - from_v
        # Left of each side is inside: side × (place − corner) ≥ 0.
        height = eu * (v - from_v) - ev * (u - from_u)
        slope = eu * b - ev * a
        from_u, from_v = to_u, to_v
        if abs(slope) < 1e-12:
            if height < 0.0:
                return 1.0, 0.0
            continue
        at = -height / slope
        if slope > 0.0:
            enters = max(enters, at)
        else:
            leaves = min(leaves, at)
    return enters, leaves


@kernel
def _end_cost(beyond: float, spacing: float, is_open: float, sigma_m: float) -> float:
    """What an end says against a rim so far beyond it."""
    off = 0.0
    if is_open == _CUT and beyond < 0.0:
        off = max(0.0, -beyond - _GAP_M) / sigma_m
    elif beyond < 0.0:
        off = -beyond / sigma_m
    elif is_open > 0.0 and beyond > spacing:
        off = (beyond - spacing) / sigma_m
    cost = off * off
    if is_open == 1.0:
        middle = (beyond - spacing / 2) / max(spacing, 1e-3)
        cost += _PULL * min(middle * middle, 1.0)
    return min(cost, CAP)


@kernel
def cost_of(corners: Floats, lines: Floats, pose: Floats, sigma_m: float, enough: float) -> float:
    """What all lines say against an outline; no more than `enough` is added up."""
    total = float((pose[2] / ROLL_RAD) ** 2)
    c, s = math.cos(pose[2]), math.sin(pose[2])
    for k in range(lines.shape[0]):
        if total > enough:
            break
        du, dv = lines[k, U] - pose[0], lines[k, V] - pose[1]
        a = c * lines[k, ALONG_U] + s * lines[k, ALONG_V]
        b = c * lines[k, ALONG_V] - s * lines[k, ALONG_U]
        enters, leaves = _chord(corners, c * du + s * dv, c * dv - s * du, a, b)
        spacing, start, end = lines[k, SPACING], lines[k, OPEN_START], lines[k, OPEN_END]
        if start < 0.0:
            missed = leaves - max(enters, 0.0) - spacing
            if missed > 0.0:
                total += min((missed / max(_MISSED_M, sigma_m)) ** 2, _MISSED_CAP)
        elif leaves <= enters:
            total += 2 * CAP
        else:
            total += _end_cost(-enters, spacing, start, sigma_m)
            total += _end_cost(leaves - lines[k, LONG], spacing, end, sigma_m)
    return total


@kernel
def fit_kernel(
    corners: Floats, lines: Floats, steps: Floats, sigma_m: float, pose: Floats
) -> float:
    """Move an outline to where it fits best; gives the cost there.

    Parameters
    ----------
    corners : (n, 2)
    lines : (m, LINE)
    steps : (k,)
        m, falling.
    pose : (3,)
        Right and up (m) and roll (rad); where to begin, made better.
    """
    best = cost_of(corners, lines, pose, sigma_m, math.inf)
    tested = np.empty(3)
    for number in range(steps.shape[0]):
        step = steps[number]
        ways, failed, back = 10 if step <= _FINE_STEP_M else 8, 0, -1
        for count in range(_ROUNDS * ways):
            # All ways fail from here, or lead back to where it cost more.
            if failed == ways:
                break
            way = count % ways
            failed += 1
            if way == back:
                continue
            tested[:] = pose
            if way < 8:
                turn = way * math.pi / 4
                tested[0] += step * math.cos(turn)
                tested[1] += step * math.sin(turn)
            else:
                tested[2] += _ROLL_PER_M * step * (1.0 if way == 8 else -1.0)
                if abs(tested[2]) > _MOST_ROLL_RAD:
                    continue
            cost = cost_of(corners, lines, tested, sigma_m, best)
            if cost < best - 1e-9:
                best = cost
                pose[:] = tested
                failed, back = 0, (way + 4) % 8 if way < 8 else 17 - way
    return best


@kernel
def search_kernel(
    outlines: Floats,
    counts: Integers,
    lines: Floats,
    box: Floats,
    steps: Floats,
    costs: Floats,
    poses: Floats,
) -> None:
    """Lay each of some outlines on lines, from the middle of a box and from its sides.

    Parameters
    ----------
    outlines : (t, c, 2)
    counts : (t,)
        Corners of each; 0 leaves it out.
    box : (2, 2)
        Lowest and highest right and up, m.
    steps : (k,)
        m, falling; the largest is what ends may lie off, too.
    costs : (t, STARTS), poses : (t, STARTS, 3)
        Filled; infinite where a start is not needed, or far from the best ones.
    """
    pose = np.empty(3)
    least = np.full(_MOVED + 1, math.inf)
    for number in range(outlines.shape[0]):
        costs[number, :] = math.inf
        if counts[number] == 0:
            continue
        corners = outlines[number, : counts[number]]
        wide, high = _size_of(corners)
        spare_u = box[1, 0] - box[0, 0] - wide
        spare_v = box[1, 1] - box[0, 1] - high
        start = 0
        for i in range(-1, 2):
            for j in range(-1, 2):
                if (i != 0 and spare_u < steps[0]) or (j != 0 and spare_v < steps[0]):
                    continue
                pose[0] = (box[0, 0] + box[1, 0]) / 2 + i * spare_u / 2
                pose[1] = (box[0, 1] + box[1, 1]) / 2 + j * spare_v / 2
                pose[2] = 0.0
                poses[number, start] = pose
                cost = cost_of(corners, lines, pose, 2 * steps[0], least[_MOVED])
                costs[number, start] = cost
                _insert(cost, least)
                start += 1
    for number in range(outlines.shape[0]):
        for start in range(STARTS):
            if costs[number, start] > least[_MOVED] or math.isinf(costs[number, start]):
                costs[number, start] = math.inf
                continue
            corners = outlines[number, : counts[number]]
            pose = poses[number, start]
            costs[number, start] = fit_kernel(corners, lines, steps, steps[0], pose)


@kernel
def _insert(value: float, rising: Floats) -> None:
    """Put a value in its place among rising ones; the last of them falls out."""
    place = len(rising) - 1
    if value >= rising[place]:
        return
    while place > 0 and rising[place - 1] > value:
        rising[place] = rising[place - 1]
        place -= 1
    rising[place] = value


@kernel
def _size_of(corners: Floats) -> tuple[float, float]:
    if corners.shape[0] == 1:
        return 2 * corners[0, 0], 2 * corners[0, 0]
    return (
        corners[:, 0].max() - corners[:, 0].min(),
        corners[:, 1].max() - corners[:, 1].min(),
    )


@kernel
def stretch_kernel(
    lines: Floats, steps: Floats, pose: Floats, sides: Floats, fixed: Floats
) -> float:
    """Move and stretch a rectangle to where it fits best; gives the cost there.

    Parameters
    ----------
    sides : (2,)
        Width and height, m; made better.
    fixed : (2,)
        1 for a side that is kept.
    """
    corners = np.empty((4, 2))
    _set_corners(corners, sides[0], sides[1])
    best, sigma_m = math.inf, 0.0
    tested, other = np.empty(3), np.empty(2)
    for number in range(steps.shape[0]):
        step = steps[number]
        if number == 0 or max(SIGMA_M, step / 2) != sigma_m:
            sigma_m = max(SIGMA_M, step / 2)
            _set_corners(corners, sides[0], sides[1])
            best = cost_of(corners, lines, pose, sigma_m, math.inf)
        ways, failed, back = 14 if step <= _FINE_STEP_M else 12, 0, -1
        for count in range(_ROUNDS * ways):
            if failed == ways:
                break
            way = count % ways
            failed += 1
            tested[:] = pose
            other[:] = sides
            if way == back or not _changed(way, step, fixed, tested, other):
                continue
            _set_corners(corners, other[0], other[1])
            cost = cost_of(corners, lines, tested, sigma_m, best)
            if cost < best - 1e-9:
                best = cost
                pose[:] = tested
                sides[:] = other
                failed, back = 0, _BACK[way]
    return best


@kernel
def _changed(way: int, step: float, fixed: Floats, pose: Floats, sides: Floats) -> bool:
    """Move or stretch a rectangle in one of 14 ways; False where that may not be.

    Of the first eight one side moves and the opposite one stays.
    """
    sign = 1.0 if way % 2 == 0 else -1.0
    if way < 8:
        axis = way // 4
        sides[axis] += sign * step
        pose[axis] += (0.5 if way % 4 < 2 else -0.5) * step
        return bool(fixed[axis] == 0.0 and sides[axis] >= _LEAST_SIDE_M)
    if way < 12:
        pose[(way - 8) // 2] += sign * step
        return True
    pose[2] += _ROLL_PER_M * step * sign
    return bool(abs(pose[2]) <= _MOST_ROLL_RAD)


@kernel
def _set_corners(corners: Floats, wide: float, high: float) -> None:
    corners[0, 0], corners[0, 1] = -wide / 2, -high / 2
    corners[1, 0], corners[1, 1] = wide / 2, -high / 2
    corners[2, 0], corners[2, 1] = wide / 2, high / 2
    corners[3, 0], corners[3, 1] = -wide / 2, high / 2


@kernel
def explain_kernel(
    corners: Floats, lines: Floats, pose: Floats, rest: Floats, blocked: Floats
) -> tuple[float, int, float, int, int]:
    """What an outline explains of lines.

    Parameters
    ----------
    rest : (2 m, LINE)
        Filled with what is left of the lines: those beside it and what goes on beyond it.
    blocked : (2 m, LINE)
        Filled with where no plate can be: beyond free ends.

    Returns
    -------
    cost, ends, pulses, lines left, lines blocked
        Cost and number of the ends on it, and how many pulses met it.
    """
    cost, ends, pulses, left, free = 0.0, 0, 0.0, 0, 0
    for k in range(lines.shape[0]):
        line = lines[k]
        enters, leaves = chord_of(corners, line, pose)
        low, high = max(enters, 0.0), min(leaves, line[LONG])
        if leaves <= enters or high - low < 0.25 * min(line[LONG], 0.1):
            rest[left] = line
            left += 1
            continue
        pulses += (high - low) / line[SPACING] + 1.0
        if enters > (_GAP_M if line[OPEN_START] == _CUT else SPLIT_M):
            _cut(line, 0.0, enters, rest[left])
            left += 1
        else:
            cost += _end_cost(-enters, line[SPACING], line[OPEN_START], SIGMA_M)
            ends += 1
            if line[OPEN_START] == 1.0:
                _block(line, -line[SPACING], -1.0, blocked[free])
                free += 1
        if line[LONG] - leaves > (_GAP_M if line[OPEN_END] == _CUT else SPLIT_M):
            _cut(line, leaves, line[LONG], rest[left])
            left += 1
        else:
            cost += _end_cost(leaves - line[LONG], line[SPACING], line[OPEN_END], SIGMA_M)
            ends += 1
            if line[OPEN_END] == 1.0:
                _block(line, line[LONG] + line[SPACING], 1.0, blocked[free])
                free += 1
    return cost, ends, pulses, left, free


@kernel
def clean_kernel(
    outlines: Floats, counts: Integers, lines: Floats, poses: Floats, costs: Floats, cleans: Floats
) -> None:
    """What the ends on each outline that was laid say against it, each; much where hardly any is.

    Parameters
    ----------
    poses : (t, n, 3), costs : (t, n)
        As of `search_kernel`.
    cleans : (t, n)
        Filled; infinite where the cost is.
    """
    rest, blocked = np.empty((2 * len(lines), LINE)), np.empty((2 * len(lines), LINE))
    for number in range(outlines.shape[0]):
        for start in range(costs.shape[1]):
            cleans[number, start] = math.inf
            if math.isinf(costs[number, start]):
                continue
            corners, pose = outlines[number, : counts[number]], poses[number, start]
            cost, ends, _, _, _ = explain_kernel(corners, lines, pose, rest, blocked)
            cleans[number, start] = (cost + CAP) / max(ends, 1)


@kernel
def _cut(line: Floats, start: float, end: float, part: Floats) -> None:
    """A part of a line; where it was cut, another plate begins somewhere."""
    part[:] = line
    part[U] = line[U] + start * line[ALONG_U]
    part[V] = line[V] + start * line[ALONG_V]
    part[LONG] = end - start
    if start > 0.0:
        part[OPEN_START] = _CUT
    if end < line[LONG]:
        part[OPEN_END] = _CUT


@kernel
def _block(line: Floats, start: float, sign: float, beyond: Floats) -> None:
    """Where a line goes on in the free."""
    beyond[:] = line
    beyond[U] = line[U] + start * line[ALONG_U]
    beyond[V] = line[V] + start * line[ALONG_V]
    beyond[ALONG_U], beyond[ALONG_V] = sign * line[ALONG_U], sign * line[ALONG_V]
    beyond[LONG] = 0.0
    beyond[OPEN_START] = -1.0


@kernel
def overlap_kernel(one: Floats, one_pose: Floats, other: Floats, other_pose: Floats) -> float:
    """How deep two outlines lie in each other, m; negative where they are apart.

    Sides of either tell, and of circles the line between the middles.
    """
    deep = math.inf
    between = np.array([one_pose[0] - other_pose[0], one_pose[1] - other_pose[1]])
    long_m = math.hypot(between[0], between[1])
    if long_m > 0.0:
        deep = _deep(one, one_pose, other, other_pose, between / long_m)
    for corners, pose in ((one, one_pose), (other, other_pose)):
        c, s = math.cos(pose[2]), math.sin(pose[2])
        for k in range(corners.shape[0] if corners.shape[0] > 1 else 0):
            u, v = corners[k, 0] - corners[k - 1, 0], corners[k, 1] - corners[k - 1, 1]
            size = max(math.hypot(u, v), 1e-9)
            way = np.array([c * v + s * u, s * v - c * u]) / size
            deep = min(deep, _deep(one, one_pose, other, other_pose, way))
    return deep


@kernel
def _deep(one: Floats, one_pose: Floats, other: Floats, other_pose: Floats, way: Floats) -> float:
    """By how much the shadows of two outlines along a way cover each other, m."""
    one_low, one_high = _shadow(one, one_pose, way)
    other_low, other_high = _shadow(other, other_pose, way)
    return min(one_high - other_low, other_high - one_low)


@kernel
def _shadow(corners: Floats, pose: Floats, way: Floats) -> tuple[float, float]:
    at = pose[0] * way[0] + pose[1] * way[1]
    if corners.shape[0] == 1:
        return at - corners[0, 0], at + corners[0, 0]
    c, s = math.cos(pose[2]), math.sin(pose[2])
    low, high = math.inf, -math.inf
    for k in range(corners.shape[0]):
        u = c * corners[k, 0] - s * corners[k, 1]
        v = s * corners[k, 0] + c * corners[k, 1]
        along = at + u * way[0] + v * way[1]
        low, high = min(low, along), max(high, along)
    return low, high


def warm_up() -> None:
    """Compile the kernels."""
    lines = np.array([[-0.1, 0.0, 1.0, 0.0, 0.2, 0.02, 1.0, 1.0]])
    corners = np.array([[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]])
    steps, pose = np.array([0.01]), np.zeros(3)
    fit_kernel(corners, lines, steps, SIGMA_M, pose)
    stretch_kernel(lines, steps, pose, np.full(2, 0.2), np.zeros(2))
    costs, poses = np.zeros((1, STARTS)), np.zeros((1, STARTS, 3))
    box = np.array([[-0.1, -0.1], [0.1, 0.1]])
    search_kernel(corners[None], np.array([4]), lines, box, steps, costs, poses)
    explain_kernel(corners, lines, pose, np.empty((2, LINE)), np.empty((2, LINE)))
    clean_kernel(corners[None], np.array([4]), lines, poses, costs, np.zeros((1, STARTS)))
    overlap_kernel(corners, pose, corners, pose)
