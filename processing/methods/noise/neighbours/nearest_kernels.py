"""Mean distance of every point to its k nearest, exact, on points in nested cells.

1. Points are taken in groups: the largest cube that holds no more than k.
2. The 27 cubes around a group are searched for all its points. What is found is exact for a point
   when the k-th neighbour is nearer than the outside of these cubes. For what is left the next
   larger cubes are taken.
3. Mostly a point's k-th neighbour is about as far as that of the point before: what is a tenth
   nearer is added up as it is, and only what lies between has to be put in order. No k-th
   neighbour is farther than that of another point and the way to that one.

Candidates lie in blocks of those that follow each other on the curve, the first of all blocks
first, then the second of all: so the processor finds the least of several blocks at a time, and
blocks that are too far are never looked at again.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_X = 0x1249249249249249
"""Every third binary digit: those of x in a cube's number; y and z have the next two."""

_TOP = 20
"""Levels of nested cubes that their numbers hold."""

# What follows changes the time only, not the result; it was set by timing clouds of streets.

_MOST_GATHERED = 16_384
"""Candidates held for a group: 400 kB, which a core's second cache holds."""

_AND_A_BIT, _LESS_A_BIT = 1 + 1e-9, 1 - 1e-9
"""For roundings, which must not leave a neighbour out."""

_PROBABLY = 1.1
"""Of the square of the radius of the point before, or its reciprocal."""

_WIDER = 1.5
"""Of a square, where too few were within it."""

_LEAST = 1 / 64
"""Of the square of the reach: after a point among duplicates."""

_BLOCK = 16
"""Candidates of a block, of which the least is kept."""

_BLOCKS_AT_ONCE = 8
"""Blocks whose least is found at a time: as many doubles as a processor's registers compare."""

_GATHERINGS = 2
"""Sizes of cubes that are gathered before what is left over goes down the tree."""


class _Group(NamedTuple):
    """Points ``first … end − 1``, and the level of the cubes gathered around them."""

    first: int
    end: int
    level: int


class _Reaches(NamedTuple):
    """How far all points are gathered, and how far the k-th neighbour probably is, m."""

    surely: float
    probably: float


class CellPoints(NamedTuple):
    """``codes`` (n,) int64 rising, ``xyz`` (n, 3) float64 m from the cubes' origin, ``side`` m."""

    codes: _Integers
    xyz: _Floats
    side: float


class _Room(NamedTuple):
    """Room for one thread: squares of distances.

    ``squares`` of all candidates, ``least`` of each block, ``low`` those surely among the nearest,
    ``apart`` those that are to be put in order.
    """

    squares: _Floats
    least: _Floats
    low: _Floats
    apart: _Floats


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

    ``found`` (n, 2): the sum of the distances and the largest of them; the sum is negative where
    the neighbours are too far away, which is left to
    :func:`processing.methods.noise.neighbours.descent_kernels.descent_kernel`.
    """
    near = np.empty((3, _MOST_GATHERED))
    room = _Room(
        np.empty(_MOST_GATHERED),
        np.empty(_MOST_GATHERED // _BLOCK),
        np.empty(_MOST_GATHERED + 1),
        np.empty(_MOST_GATHERED + 1),
    )
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
                group = _Group(position, end, level + wider)
                before = _sum_group(
                    points, is_wanted, nearest, group, before, near, count, room, found
                )
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
    group: _Group,
    before: int,
    near: _Floats,
    count: int,
    room: _Room,
    found: _Floats,
) -> int:
    """Measure those points of a group that aren't yet; gives the last point that was."""
    for point in range(group.first, group.end):
        if not is_wanted[point] or found[point, 0] >= 0.0:
            continue
        reach, probable = _margin(points, point, group.level), math.inf
        if before >= 0:
            probable = found[before, 1]
            reach = min(reach, (probable + _apart(points, before, point)) * _AND_A_BIT)
        reaches = _Reaches(reach, probable)
        _sum_within(points.xyz[point], near, count, reaches, room, nearest, found[point])
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
    runs = np.empty((27, 2), np.int64)
    used, count = 0, 0
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
                count += end - start
                if count > near.shape[1]:
                    return 0
                runs[used, 0], runs[used, 1] = start, end
                used += 1
    _copy(points.xyz, runs[:used], _width(count), near)
    return count


@kernel
def _copy(xyz: _Floats, runs: _Integers, width: int, near: _Floats) -> None:
    """Lay points out so that the first of all blocks come first, then the second of all."""
    near[:, : width * _BLOCK] = math.inf
    count = 0
    for run in range(runs.shape[0]):
        for point in range(runs[run, 0], runs[run, 1]):
            position = count % _BLOCK * width + count // _BLOCK
            near[0, position] = xyz[point, 0]
            near[1, position] = xyz[point, 1]
            near[2, position] = xyz[point, 2]
            count += 1


@kernel
def _margin(points: CellPoints, point: int, level: int) -> float:
    """Distance from a point to the outside of the 27 cubes around it."""
    side = points.side * (1 << level)
    margin = 2 * side
    for axis in range(3):
        position = points.xyz[point, axis]
        inside = position - math.floor(position / side) * side
        margin = min(margin, side + min(inside, side - inside))
    return margin * _LESS_A_BIT


@kernel
def _sum_within(
    position: _Floats,
    near: _Floats,
    count: int,
    reaches: _Reaches,
    room: _Room,
    nearest: int,
    found: _Floats,
) -> None:
    """Sum of the distances to the nearest, and the farthest; nothing when that is beyond reach."""
    width = _width(count)
    limit = reaches.surely * reaches.surely
    probable = reaches.probably * reaches.probably
    guess = min(limit, probable * _PROBABLY)
    surely = min(guess, probable / _PROBABLY)
    _measure(position, near, width, room)
    low, apart = _sort_out(room, width, surely, guess)
    while low + apart < nearest and guess < limit:
        surely, guess = guess, min(limit, max(guess * _WIDER, limit * _LEAST))
        low, apart = _sort_out(room, width, surely, guess)
    if low + apart < nearest:
        return
    if low >= nearest:
        _select(room.low, low, nearest)
    else:
        _select(room.apart, apart, nearest - low)
        room.low[low:nearest] = room.apart[: nearest - low]
    found[1] = math.sqrt(room.low[nearest - 1])
    found[0] = _sum_of_roots(room.low, nearest)


@kernel
def _width(count: int) -> int:
    """How many blocks so many candidates take, in eights."""
    return -(-count // (_BLOCK * _BLOCKS_AT_ONCE)) * _BLOCKS_AT_ONCE


@kernel
def _measure(position: _Floats, near: _Floats, width: int, room: _Room) -> None:
    """Squares of the distances to all candidates, and the least of each block."""
    x, y, z = position[0], position[1], position[2]
    count = width * _BLOCK
    eastings, northings, heights = near[0, :count], near[1, :count], near[2, :count]
    squares = room.squares[:count]
    for other in range(count):
        dx, dy, dz = eastings[other] - x, northings[other] - y, heights[other] - z
        squares[other] = dx * dx + dy * dy + dz * dz
    least = room.least[:width]
    least[:] = squares[:width]
    for start in range(width, count, width):
        others = squares[start : start + width]
        for block in range(width):
            least[block] = others[block] if others[block] < least[block] else least[block]


@kernel
def _sort_out(room: _Room, width: int, low: float, limit: float) -> tuple[int, int]:
    """Bring the squares that are low together, and the other ones within a limit."""
    used, others = np.uint64(0), np.uint64(0)  # unsigned: no index counts from the end
    for block in range(width):
        if room.least[block] > limit:
            continue
        for k in range(_BLOCK):
            square = room.squares[k * width + block]
            room.low[used] = square
            room.apart[others] = square
            is_low = np.uint64(square <= low)
            used += is_low
            others += np.uint64(square <= limit) - is_low
    return int(used), int(others)


@kernel
def _sum_of_roots(squares: _Floats, count: int) -> float:
    """Sum of the square roots, in four rows that the processor adds side by side."""
    for k in range(count):
        squares[k] = math.sqrt(squares[k])
    sums = (0.0, 0.0, 0.0, 0.0)
    one, two, three, four = sums
    for k in range(0, count - 3, 4):
        one += squares[k]
        two += squares[k + 1]
        three += squares[k + 2]
        four += squares[k + 3]
    for k in range(count - count % 4, count):
        one += squares[k]
    return (one + two) + (three + four)


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
