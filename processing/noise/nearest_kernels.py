"""Mean distance of every point to its k nearest, exact, on points in nested cells.

1. Points are taken in groups: the largest cube that holds no more than k.
2. The 27 cubes around a group are searched for all its points. What is found is exact for a point
   when the k-th neighbour is nearer than the outside of these cubes. For what is left the next
   larger cubes are taken.
3. No point's k-th neighbour is farther than that of another point and the way to that one: this
   bounds what is looked at. Mostly it is about as far as that of the point before, so that few
   distances have to be put in order.
4. Any other point descends the tree of cubes, nearest cube first, and leaves out the cubes that
   are farther than its k-th neighbour so far.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_X = 0x1249249249249249
_TOP = 20
_LEAF = 24
_MOST_GATHERED = 16_384
_STACK = 8 * (_TOP + 2)
_AND_A_BIT = 1 + 1e-9  # for roundings
_PROBABLY = 1.06  # of the square of the radius of the point before
_BLOCK = 32
_GATHERINGS = 2


class CellPoints(NamedTuple):
    """``codes`` (n,) int64 rising, ``xyz`` (n, 3) float64 m from the cubes' origin, ``side`` m."""

    codes: _Integers
    xyz: _Floats
    side: float


@kernel
def nearest_kernel(
    points: CellPoints,
    is_wanted: NDArray[np.bool_],
    nearest: int,
    first: int,
    stop: int,
    found: _Floats,
) -> None:
    """Distances of wanted points to their nearest, of which the point itself is one.

    ``found`` (n, 2): the sum of the distances and the largest of them.
    """
    near = np.empty((3, _MOST_GATHERED))
    squares = np.empty(_MOST_GATHERED)
    heap = np.empty(nearest)
    stack = np.empty((_STACK, 3), np.int64)
    bounds = np.empty(_STACK)
    position, before = first, -1
    while position < stop:
        level, end = _group_at(points.codes, position, nearest)
        end = min(end, stop)
        found[position:end, 0] = -1.0
        for wider in range(_GATHERINGS):
            if not _is_any_open(is_wanted, found, position, end):
                break
            count = _gather(points, position, level + wider, near)
            if count >= nearest:
                group = (position, end, level + wider)
                before = _sum_group(
                    points, is_wanted, nearest, group, before, near, count, squares, found
                )
        for point in range(position, end):
            if is_wanted[point] and found[point, 0] < 0.0:
                heap[:] = math.inf
                if before >= 0:
                    bound = (found[before, 1] + _apart(points, before, point)) * _AND_A_BIT
                    heap[:] = bound * bound
                _sum_by_descent(points, point, heap, stack, bounds, found[point])
                before = point
        position = end


@kernel
def _is_any_open(is_wanted: NDArray[np.bool_], found: _Floats, first: int, end: int) -> bool:
    """Whether a wanted point has no sum yet."""
    left = 0
    for point in range(first, end):
        left += is_wanted[point] and found[point, 0] < 0.0
    return left > 0


@kernel
def _sum_group(
    points: CellPoints,
    is_wanted: NDArray[np.bool_],
    nearest: int,
    group: tuple[int, int, int],
    before: int,
    near: _Floats,
    count: int,
    squares: _Floats,
    found: _Floats,
) -> int:
    """Measure those points of a group that aren't yet; gives the last point that was."""
    position, end, level = group
    for point in range(position, end):
        if not is_wanted[point] or found[point, 0] >= 0.0:
            continue
        reach, probable = _margin(points, point, level), math.inf
        if before >= 0:
            probable = found[before, 1]
            reach = min(reach, (probable + _apart(points, before, point)) * _AND_A_BIT)
        reaches = (reach, probable)
        _sum_within(points.xyz[point], near, count, reaches, squares, nearest, found[point])
        if found[point, 0] >= 0.0:
            before = point
    return before


@kernel
def _apart(points: CellPoints, one: int, other: int) -> float:
    square = 0.0
    for axis in range(3):
        square += (points.xyz[one, axis] - points.xyz[other, axis]) ** 2
    return math.sqrt(square)


@kernel
def _group_at(codes: _Integers, position: int, most: int) -> tuple[int, int]:
    """Level and end of the largest cube that begins here and holds at most so many points."""
    level = 0
    end = _cube_end(codes, position, 0)
    while level < _TOP:
        above = codes[position] >> (3 * (level + 1))
        if position > 0 and codes[position - 1] >> (3 * (level + 1)) == above:
            break
        last = position + most
        if last < codes.size and codes[last] >> (3 * (level + 1)) == above:
            break
        level += 1
        end = _cube_end(codes, position, level)
    return level, end


@kernel
def _cube_end(codes: _Integers, position: int, level: int) -> int:
    limit = ((codes[position] >> (3 * level)) + 1) << (3 * level)
    step = 1
    while position + step < codes.size and codes[position + step] < limit:
        step *= 2
    low, high = position + step // 2, min(position + step, codes.size)
    while low < high:
        middle = (low + high) // 2
        if codes[middle] < limit:
            low = middle + 1
        else:
            high = middle
    return low


@kernel
def _gather(points: CellPoints, position: int, level: int, near: _Floats) -> int:
    """Copy the points of the 27 cubes around one; 0 when they are too many."""
    codes = points.codes
    code = codes[position] >> (3 * level)
    size = 1 << max(_TOP + 1 - level, 0)
    count = 0
    axes = (code & _X, (code >> 1) & _X, (code >> 2) & _X)
    x, y, z = _packed(axes[0]), _packed(axes[1]), _packed(axes[2])
    for i in range(max(x - 1, 0), min(x + 2, size)):
        for j in range(max(y - 1, 0), min(y + 2, size)):
            for k in range(max(z - 1, 0), min(z + 2, size)):
                wanted = _spread(i) | (_spread(j) << 1) | (_spread(k) << 2)
                start = int(np.searchsorted(codes, wanted << (3 * level)))
                if start == codes.size or codes[start] >> (3 * level) != wanted:
                    continue
                end = _cube_end(codes, start, level)
                if count + end - start > near.shape[1]:
                    return 0
                for point in range(start, end):
                    for axis in range(3):
                        near[axis, count] = points.xyz[point, axis]
                    count += 1
    return count


@kernel
def _margin(points: CellPoints, point: int, level: int) -> float:
    """Distance from a point to the outside of the 27 cubes around it."""
    side = points.side * (1 << level)
    margin = 2 * side
    for axis in range(3):
        place = points.xyz[point, axis]
        inside = place - math.floor(place / side) * side
        margin = min(margin, side + min(inside, side - inside))
    return margin * (1 - 1e-9)


@kernel
def _sum_within(
    place: _Floats,
    near: _Floats,
    count: int,
    reaches: tuple[float, float],
    squares: _Floats,
    nearest: int,
    found: _Floats,
) -> None:
    """Sum of the distances to the nearest, and the farthest; nothing when that is beyond reach.

    ``reaches``: how far all points are in ``near``; how far the k-th probably is.
    """
    x, y, z = place[0], place[1], place[2]
    for other in range(count):
        dx, dy, dz = near[0, other] - x, near[1, other] - y, near[2, other] - z
        squares[other] = dx * dx + dy * dy + dz * dz
    limit = reaches[0] * reaches[0]
    guess = reaches[1] * reaches[1] * _PROBABLY
    inside = 0
    for other in range(count):
        inside += 1 if squares[other] <= guess else 0
    if guess < limit and inside >= nearest:
        limit = guess
    used = _kept_within(squares, count, limit)
    if used < nearest:
        return
    _select(squares, used, nearest)
    found[1] = math.sqrt(squares[nearest - 1])
    for k in range(nearest):
        squares[k] = math.sqrt(squares[k])
    total = 0.0
    for k in range(nearest):
        total += squares[k]
    found[0] = total


@kernel
def _kept_within(squares: _Floats, count: int, limit: float) -> int:
    """Bring the values within a limit to the front; gives how many they are."""
    used = 0
    for start in range(0, count, _BLOCK):
        end = min(start + _BLOCK, count)
        inside = 0
        for other in range(start, end):
            inside += 1 if squares[other] <= limit else 0
        if inside == 0:
            continue
        for other in range(start, end):
            square = squares[other]
            squares[used] = square
            used += 1 if square <= limit else 0
    return used


@kernel
def _select(values: _Floats, count: int, wanted: int) -> None:
    """Bring the smallest values to the front, the largest of them last, in any order else."""
    low, high = 0, count - 1
    while low < high:
        pivot = values[(low + high) // 2]
        i, j = low, high
        while i <= j:
            while values[i] < pivot:
                i += 1
            while values[j] > pivot:
                j -= 1
            if i <= j:
                values[i], values[j] = values[j], values[i]
                i += 1
                j -= 1
        if wanted - 1 <= j:
            high = j
        elif wanted - 1 >= i:
            low = i
        else:
            return


@kernel
def _sum_by_descent(
    points: CellPoints,
    point: int,
    heap: _Floats,
    stack: _Integers,
    bounds: _Floats,
    found: _Floats,
) -> None:
    """Sum of the distances and the farthest; ``heap`` holds squares that none of them reaches."""
    place = points.xyz[point]
    stack[0, 0], stack[0, 1], stack[0, 2] = _TOP + 1, 0, points.codes.size
    bounds[0] = 0.0
    depth = 1
    while depth > 0:
        depth -= 1
        if bounds[depth] >= heap[0]:
            continue
        level, start, end = stack[depth, 0], stack[depth, 1], stack[depth, 2]
        if level == 0 or end - start <= _LEAF:
            for other in range(start, end):
                square = 0.0
                for axis in range(3):
                    square += (points.xyz[other, axis] - place[axis]) ** 2
                if square < heap[0]:
                    _replace_largest(heap, square)
            continue
        depth = _push_parts(points, place, level - 1, start, end, depth, stack, bounds)
    total = 0.0
    for k in range(heap.size):
        total += math.sqrt(heap[k])
    found[0], found[1] = total, math.sqrt(heap[0])


@kernel
def _push_parts(
    points: CellPoints,
    place: _Floats,
    level: int,
    start: int,
    end: int,
    depth: int,
    stack: _Integers,
    bounds: _Floats,
) -> int:
    """Put the smaller cubes of a cube on the stack, the nearest on top; gives the new depth."""
    base = depth
    side = points.side * 2.0**level
    while start < end:
        code = points.codes[start] >> (3 * level)
        stop = min(end, _cube_end(points.codes, start, level))
        square = 0.0
        for axis in range(3):
            low = _packed((code >> axis) & _X) * side
            gap = max(low - place[axis], place[axis] - low - side, 0.0)
            square += gap * gap
        square *= 1 - 1e-9
        at = depth
        while at > base and bounds[at - 1] < square:
            bounds[at] = bounds[at - 1]
            stack[at] = stack[at - 1]
            at -= 1
        bounds[at] = square
        stack[at, 0], stack[at, 1], stack[at, 2] = level, start, stop
        depth += 1
        start = stop
    return depth


@kernel
def _replace_largest(heap: _Floats, value: float) -> None:
    """Put a value in the place of the largest, which is first, and bring the largest there."""
    at = 0
    while True:
        child = 2 * at + 1
        if child >= heap.size:
            break
        if child + 1 < heap.size and heap[child + 1] > heap[child]:
            child += 1
        if heap[child] <= value:
            break
        heap[at] = heap[child]
        at = child
    heap[at] = value


@kernel
def _spread(value: int) -> int:
    value = (value | (value << 32)) & 0x1F00000000FFFF
    value = (value | (value << 16)) & 0x1F0000FF0000FF
    value = (value | (value << 8)) & 0x100F00F00F00F00F
    value = (value | (value << 4)) & 0x10C30C30C30C30C3
    return (value | (value << 2)) & _X


@kernel
def _packed(value: int) -> int:
    value = (value | (value >> 2)) & 0x10C30C30C30C30C3
    value = (value | (value >> 4)) & 0x100F00F00F00F00F
    value = (value | (value >> 8)) & 0x1F0000FF0000FF
    value = (value | (value >> 16)) & 0x1F00000000FFFF
    return (value | (value >> 32)) & 0x1FFFFF
