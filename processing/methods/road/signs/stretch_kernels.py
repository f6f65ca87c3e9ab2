"""Loops that stretch rectangles to where they fit the scan lines of a plate, and part its stacks.

What lines say against one is told as of other outlines (:mod:`.fit_kernels`).
"""

from __future__ import annotations

import math

import numpy as np

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.methods.road.signs.fit_kernels import (
    FINE_STEP_M,
    LONG,
    MOST_ROLL_RAD,
    ROLL_PER_M,
    ROLL_RAD,
    ROUNDS,
    SIGMA_M,
    U,
    V,
    line_cost,
)

_LEAST_SIDE_M = 0.08
"""Of a rectangle: the smallest plate is 10 cm high (標識令, 補助標識), its rims are uncertain."""

_FAR_OFF = 12.0
"""What a rectangle may cost more before it is moved finely: that takes it to some millimetres."""

_LEVEL = 1e-12
"""Sine of an angle between a line and a side that never meet."""

_BACK = (3, 2, 1, 0, 7, 6, 5, 4, 9, 8, 11, 10, 13, 12)
"""Of each way in which a rectangle is changed, the one that undoes it."""


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
    best, sigma_m = math.inf, 0.0
    tested, other = np.empty(3), np.empty(2)
    seen, rolled = np.empty((lines.shape[0], 4)), np.empty((lines.shape[0], 4))
    _turned(lines, pose[2], seen)
    for number in range(steps.shape[0]):
        step = steps[number]
        if number == 0 or max(SIGMA_M, step / 2) != sigma_m:
            sigma_m = max(SIGMA_M, step / 2)
            best = _box_cost(sides, lines, seen, pose, (sigma_m, math.inf))
        ways, failed, back = 14 if step <= FINE_STEP_M else 12, 0, -1
        for count in range(ROUNDS * ways):
            if failed == ways:
                break
            way = count % ways
            failed += 1
            tested[:] = pose
            other[:] = sides
            if way == back or not _changed(way, step, fixed, tested, other):
                continue
            is_rolled = tested[2] != pose[2]
            if is_rolled:
                _turned(lines, tested[2], rolled)
            cost = _box_cost(other, lines, rolled if is_rolled else seen, tested, (sigma_m, best))
            if cost < best - 1e-9:
                best = cost
                if is_rolled:
                    seen, rolled = rolled, seen
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
    pose[2] += ROLL_PER_M * step * sign
    return bool(abs(pose[2]) <= MOST_ROLL_RAD)


@kernel
def snap_kernel(
    lines: Floats, steps: Floats, costs: tuple[float, float, float], pose: Floats, sides: Floats
) -> float:
    """Give a rectangle usual sides where that costs little; gives the cost then.

    Parameters
    ----------
    costs : (float, float, float)
        What it costs as it lies, what a usual side may cost besides, and of what usual sides are
        whole multiples, m.
    pose : (3,), sides : (2,)
        Made better.
    """
    cost, most, unit = costs
    fixed = np.zeros(2)
    start_pose, start_sides = np.empty(3), np.empty(2)
    place, other, keep = np.empty(3), np.empty(2), np.empty(2)
    for axis in range(2):
        best = cost + most
        start_pose[:] = pose
        start_sides[:] = sides
        keep[:] = fixed
        keep[axis] = 1.0
        nearest = np.rint(sides[axis] / unit) * unit
        for way in (0, -1, 1):
            side = nearest + way * unit
            if side < unit / 2:
                continue
            place[:] = start_pose
            other[:] = start_sides
            other[axis] = side
            enough = best + _FAR_OFF
            if not _may_fit(lines, place, other, (axis, start_sides[axis] - side), enough):
                continue
            changed = stretch_kernel(lines, steps, place, other, keep)
            if changed < best:
                best = changed
                pose[:] = place
                sides[:] = other
                fixed[axis] = 1.0
        if fixed[axis] == 1.0:
            cost = best
    return cost


@kernel
def _may_fit(
    lines: Floats, pose: Floats, sides: Floats, spare: tuple[int, float], enough: float
) -> bool:
    """Whether a rectangle costs little anywhere between either of two sides kept in its place."""
    axis, free = spare
    tested, seen = pose.copy(), np.empty((lines.shape[0], 4))
    _turned(lines, pose[2], seen)
    for share in (-0.5, -0.25, 0.0, 0.25, 0.5):
        tested[axis] = pose[axis] + share * free
        if _box_cost(sides, lines, seen, tested, (SIGMA_M, enough)) <= enough:
            return True
    return False


@kernel
def parts_kernel(low: Floats, high: Floats, least_m: float, level_m: float, share: float) -> Floats:
    """Between which levels the parts of a stack of plates lie: (m, 2), between strips few cross.

    Parameters
    ----------
    low, high : (n,)
        Where each line begins and ends, m.
    least_m : float
        The lowest and the highest part are no smaller.
    level_m : float
        Between levels that are looked at.
    share : float
        Of the lines that cross the fullest level: few.
    """
    first = low.min() + least_m
    count = max(0, math.ceil((high.max() - least_m - first) / level_m))
    crossed = np.zeros(count + 1, np.int64)
    for k in range(len(low)):
        begins = min(max(math.ceil((low[k] - first) / level_m), 0), count)
        ends = min(max(math.floor((high[k] - first) / level_m) + 1, 0), count)
        if ends > begins:
            crossed[begins] += 1
            crossed[ends] -= 1
    most = 0
    for k in range(1, count):
        crossed[k] += crossed[k - 1]
    for k in range(count):
        most = max(most, crossed[k])
    parts = np.empty((count // 2 + 1, 2))
    found, is_inside = 0, False
    for k in range(count):
        is_part = crossed[k] > share * most
        if is_part and not is_inside:
            parts[found, 0] = first + (k - 0.5) * level_m if k > 0 else -math.inf
            found += 1
        if is_part:
            parts[found - 1, 1] = first + (k + 0.5) * level_m if k < count - 1 else math.inf
        is_inside = is_part
    return parts[:found]


@kernel
def _turned(lines: Floats, roll: float, seen: Floats) -> None:
    """Write starts and directions of lines, (m, 4), as a rectangle that is rolled has right and up.

    About the origin of the plane.
    """
    c, s = math.cos(roll), math.sin(roll)
    for k in range(lines.shape[0]):
        for column in range(0, 4, 2):
            right, up = lines[k, U + column], lines[k, V + column]
            seen[k, column] = c * right + s * up
            seen[k, column + 1] = c * up - s * right


@kernel
def _box_cost(
    sides: Floats,
    lines: Floats,
    seen: Floats,
    pose: Floats,
    limits: tuple[float, float],
) -> float:
    """What all lines say against a rectangle so wide and high, by what they are to its roll.

    Parameters
    ----------
    limits : (float, float)
        How far ends lie off, m, and the cost from which no more is added up.
    """
    sigma_m, enough = limits
    total = float((pose[2] / ROLL_RAD) ** 2)
    c, s = math.cos(pose[2]), math.sin(pose[2])
    right, up = c * pose[0] + s * pose[1], c * pose[1] - s * pose[0]
    low_u, high_u = right - sides[0] / 2, right + sides[0] / 2
    low_v, high_v = up - sides[1] / 2, up + sides[1] / 2
    for k in range(lines.shape[0]):
        if total > enough:
            break
        chord = _chord_of_box((low_u, high_u, low_v, high_v), seen, k)
        total += line_cost(lines, k, chord, sigma_m)
    return total


@kernel
def _chord_of_box(
    box: tuple[float, float, float, float], seen: Floats, k: int
) -> tuple[float, float, float, float]:
    """Where a line enters and leaves a box, and the sines of its angles with its rim."""
    low_u, high_u, low_v, high_v = box
    enters, leaves, sine_in, sine_out = -1e9, 1e9, 1.0, 1.0
    along, steep = seen[k, 2], abs(seen[k, 2])
    if steep >= _LEVEL:
        first, last = (low_u - seen[k, 0]) / along, (high_u - seen[k, 0]) / along
        enters, leaves = min(first, last), max(first, last)
        sine_in = sine_out = steep
    elif not low_u <= seen[k, 0] <= high_u:
        return 1.0, 0.0, 1.0, 1.0
    along, steep = seen[k, 3], abs(seen[k, 3])
    if steep >= _LEVEL:
        first, last = (low_v - seen[k, 1]) / along, (high_v - seen[k, 1]) / along
        if min(first, last) > enters:
            enters, sine_in = min(first, last), steep
        if max(first, last) < leaves:
            leaves, sine_out = max(first, last), steep
    elif not low_v <= seen[k, 1] <= high_v:
        return 1.0, 0.0, 1.0, 1.0
    return enters, leaves, sine_in, sine_out


def warm_up() -> None:
    """Compile the kernels."""
    lines = np.array([[-0.1, 0.0, 1.0, 0.0, 0.2, 0.02, 1.0, 1.0, 0.0, 0.0]])
    steps, pose = np.array([0.01]), np.zeros(3)
    stretch_kernel(lines, steps, pose, np.full(2, 0.2), np.zeros(2))
    snap_kernel(lines, steps, (0.0, 1.0, 0.1), pose, np.full(2, 0.2))
    parts_kernel(lines[:, U], lines[:, LONG], 0.1, 0.01, 0.1)
