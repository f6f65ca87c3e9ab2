"""Mean distance to the k nearest of the points whose neighbours are far, exact.

A point descends the tree of nested cubes, nearest cube first, and leaves out the cubes that are
farther than its k-th neighbour so far.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.noise.neighbours.nearest_kernels import CellPoints

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_X = 0x1249249249249249
"""Every third binary digit: those of x in a cube's number; y and z have the next two."""

_TOP = 20
"""Levels of nested cubes that their numbers hold."""

_LEAF = 24
"""Points of a cube that are measured one by one; it changes the time only. By timing."""

_STACK = 8 * (_TOP + 2)
"""Cubes that may wait: the eight parts of one on every level."""

_AND_A_BIT, _LESS_A_BIT = 1 + 1e-9, 1 - 1e-9
"""For roundings, which must not leave a neighbour out."""


@kernel
def descent_kernel(
    points: CellPoints,
    is_wanted: NDArray[np.bool_],
    nearest: int,
    first: int,
    stop: int,
    found: _Floats,
) -> None:
    """Distances of the wanted points that are still open, with a negative sum in ``found``.

    No point's k-th neighbour is farther than that of the point before plus the distance to it.
    """
    heap = np.empty(nearest)
    stack = np.empty((_STACK, 3), np.int64)
    bounds = np.empty(_STACK)
    before = -1
    for point in range(first, stop):
        if not is_wanted[point]:
            continue
        if found[point, 0] < 0.0:
            heap[:] = math.inf
            if before >= 0:
                bound = (found[before, 1] + _apart(points, before, point)) * _AND_A_BIT
                heap[:] = bound * bound
            _sum_by_descent(points, point, heap, stack, bounds, found[point])
        before = point


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
    position = points.xyz[point]
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
                    square += (points.xyz[other, axis] - position[axis]) ** 2
                if square < heap[0]:
                    _replace_largest(heap, square)
            continue
        depth = _push_parts(points, position, level - 1, start, end, depth, stack, bounds)
    total = 0.0
    for k in range(heap.size):
        total += math.sqrt(heap[k])
    found[0], found[1] = total, math.sqrt(heap[0])


@kernel
def _push_parts(
    points: CellPoints,
    position: _Floats,
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
            gap = max(low - position[axis], position[axis] - low - side, 0.0)
            square += gap * gap
        square *= _LESS_A_BIT
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
def _apart(points: CellPoints, one: int, other: int) -> float:
    square = 0.0
    for axis in range(3):
        square += (points.xyz[one, axis] - points.xyz[other, axis]) ** 2
    return math.sqrt(square)


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
def _packed(value: int) -> int:
    value = (value | (value >> 2)) & 0x10C30C30C30C30C3
    value = (value | (value >> 4)) & 0x100F00F00F00F00F
    value = (value | (value >> 8)) & 0x1F0000FF0000FF
    value = (value | (value >> 16)) & 0x1F00000000FFFF
    return (value | (value >> 32)) & 0x1FFFFF
