"""Loops that join neighbouring points into components; a component's root is its first point."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

_COLUMNS_ASIDE = 3
"""A neighbour in the next row is looked for so many columns to either side: rows are shifted by a
pixel or two. By trial; no measurement is recorded."""

_POINTS_AHEAD = 2
"""Next points of a row that are tried: one stray may lie between two of a surface."""

_SAMPLED = 4
"""Every fourth point of a row tells how far the next row lies: a median needs no more."""

_FEWEST = 8
"""Points that must tell it. By trial; no measurement is recorded."""

_FAR = 1e30
"""m; stands for: there is no neighbour."""

_CHORD_M = 0.15
"""Length over which the direction of a row is taken: noise of 4 mm turns it by 2 degrees."""

_CHORD_POINTS = 40
"""Points at most for it, which bounds the time where they are dense."""


class JoiningRows(NamedTuple):
    """Points in their rows, and what is being found about them.

    ``limits``: distance, ratio, farthest, cosine of the largest bend; ``scratch`` has a place for
    every point of a row; ``tangents``: direction of the row at every point; ``is_bent``: the row
    has a corner there or too few points; ``parents`` lead from every point to the first of its
    component.
    """

    xyz: Floats
    columns: NDArray[np.int32]
    row_starts: Integers
    segments: NDArray[np.int32]
    limits: Floats
    scratch: Floats
    tangents: NDArray[np.float32]
    is_bent: NDArray[np.bool_]
    parents: Integers


@kernel
def tangents_kernel(rows: JoiningRows, first: int, end: int) -> None:
    """Directions and corners of the rows ``first … end − 1``, each from the row alone."""
    left, right = np.empty(3), np.empty(3)
    for row in range(first, end):
        start, stop = rows.row_starts[row], rows.row_starts[row + 1]
        for point in range(start, stop):
            before, steps_before = _chord(rows, point, -1, start, stop, left)
            behind, steps_behind = _chord(rows, point, 1, start, stop, right)
            rows.is_bent[point] = True
            if before > 0 and behind > 0:
                cosine = -(left[0] * right[0] + left[1] * right[1] + left[2] * right[2])
                rows.is_bent[point] = cosine < rows.limits[3] * before * behind
            elif max(steps_before, steps_behind) > 1:
                # The end of a surface is as flat as the one side that is there.
                rows.is_bent[point] = False
            for axis in range(3):
                left[axis] = right[axis] - left[axis]
            length = math.sqrt(left[0] ** 2 + left[1] ** 2 + left[2] ** 2)
            for axis in range(3):
                rows.tangents[point, axis] = left[axis] / length if length > 0 else 0.0


@kernel
def join_rows_kernel(rows: JoiningRows, first: int, end: int) -> None:
    """Join the points of the rows ``first … end − 1`` with each other and the next row."""
    last = rows.row_starts.size - 2
    for row in range(first, end):
        start, stop = rows.row_starts[row], rows.row_starts[row + 1]
        has_next = row < last and rows.segments[row + 1] == rows.segments[row]
        after = rows.row_starts[row + 2] if has_next else stop
        _join_along(rows, start, stop, after)
        if start < stop < after:
            limit = _limit(rows.limits, _row_distance(rows, start, stop, after))
            below = stop
            for point in range(start, stop):
                below = _first_near(rows, below, after, point)
                near, _ = _nearest(rows, point, below, after)
                if near >= 0:
                    _join_near(rows, point, near, limit)


@kernel
def roots_kernel(parents: Integers) -> None:
    """Let every point name its component's first point itself."""
    for point in range(parents.size):
        # Parents come before their children, so the parent's own root is known already.
        parents[point] = parents[parents[point]]


@kernel
def unite_kernel(parents: Integers, one: Integers, other: Integers) -> None:
    """Join pairs of numbers."""
    for i in range(one.size):
        _join(parents, one[i], other[i])


@kernel
def renumber_kernel(numbers: NDArray[np.int32], gone: Integers, ranks: Integers) -> None:
    """Close up numbers of which some give way to others.

    ``gone``: those that give way, rising; ``ranks``: what each becomes. Any other falls by as many
    as are gone below it.
    """
    before, after = -1, -1
    for i in range(numbers.size):
        number = numbers[i]
        if number != before:
            low, high = 0, gone.size
            while low < high:
                middle = (low + high) // 2
                if gone[middle] < number:
                    low = middle + 1
                else:
                    high = middle
            before, after = number, number - low
            if low < gone.size and gone[low] == number:
                after = ranks[low]
        numbers[i] = after


@kernel
def _limit(limits: Floats, expected: float) -> float:
    return float(min(max(limits[0], limits[1] * expected), limits[2]))


@kernel
def _join_along(rows: JoiningRows, start: int, stop: int, after: int) -> None:
    steps = rows.scratch
    for point in range(start, stop - 1):
        steps[point - start] = _distance(rows.xyz, point, point + 1)
    for point in range(start, stop):
        before = steps[point - start - 1] if point > start else _FAR
        behind = steps[point - start + 1] if point + 2 < stop else _FAR
        expected = min(before, behind)
        limit = _limit(rows.limits, expected if expected < _FAR else 0.0)
        if point + 1 == stop and stop < after:
            # The scanner went on from the end of a row to the next one without a break.
            _join_near(rows, point, stop, limit)
        for other in range(point + 1, min(point + 1 + _POINTS_AHEAD, stop)):
            if rows.columns[other] - rows.columns[point] <= _COLUMNS_ASIDE:
                _join_near(rows, point, other, limit)


@kernel
def _join_near(rows: JoiningRows, one: int, other: int, limit: float) -> None:
    if _distance(rows.xyz, one, other) <= limit and _go_together(rows, one, other):
        _join(rows.parents, one, other)


@kernel
def _go_together(rows: JoiningRows, one: int, other: int) -> bool:
    """Whether two near points lie on one surface, or both on none."""
    if rows.is_bent[one] or rows.is_bent[other]:
        return bool(rows.is_bent[one] and rows.is_bent[other])
    cosine = 0.0
    for axis in range(3):
        cosine += rows.tangents[one, axis] * rows.tangents[other, axis]
    return bool(cosine >= rows.limits[3])


@kernel
def _chord(
    rows: JoiningRows, point: int, side: int, start: int, stop: int, chord: Floats
) -> tuple[float, int]:
    """Distance and steps to the first point at least a chord away in the row; 0 if none is."""
    chord[:] = 0
    other = point
    for step in range(1, _CHORD_POINTS + 1):
        before, other = other, other + side
        if other < start or other >= stop:
            return 0.0, 0
        if _distance(rows.xyz, before, other) > rows.limits[2]:
            return 0.0, 0
        distance = _distance(rows.xyz, point, other)
        if distance >= _CHORD_M:
            for axis in range(3):
                chord[axis] = rows.xyz[other, axis] - rows.xyz[point, axis]
            return distance, step
    return 0.0, 0


@kernel
def _row_distance(rows: JoiningRows, start: int, stop: int, after: int) -> float:
    """Median distance of a row's points from the nearest in the next row; 0 for too few."""
    below, count = stop, 0
    for point in range(start, stop, _SAMPLED):
        below = _first_near(rows, below, after, point)
        _, distance = _nearest(rows, point, below, after)
        if distance < _FAR:
            rows.scratch[count] = distance
            count += 1
    if count < _FEWEST:
        return 0.0
    return float(np.median(rows.scratch[:count]))


@kernel
def _first_near(rows: JoiningRows, below: int, after: int, point: int) -> int:
    while below < after and rows.columns[below] < rows.columns[point] - _COLUMNS_ASIDE:
        below += 1
    return below


@kernel
def _nearest(rows: JoiningRows, point: int, below: int, after: int) -> tuple[int, float]:
    near, best = -1, _FAR
    other = below
    while other < after and rows.columns[other] <= rows.columns[point] + _COLUMNS_ASIDE:
        distance = _distance(rows.xyz, point, other)
        if distance < best:
            near, best = other, distance
        other += 1
    return near, best


@kernel
def _distance(xyz: Floats, one: int, other: int) -> float:
    dx = xyz[other, 0] - xyz[one, 0]
    dy = xyz[other, 1] - xyz[one, 1]
    dz = xyz[other, 2] - xyz[one, 2]
    return math.sqrt(dx * dx + dy * dy + dz * dz)


@kernel
def _join(parents: Integers, one: int, other: int) -> None:
    while parents[one] != one:
        parents[one] = parents[parents[one]]
        one = parents[one]
    while parents[other] != other:
        parents[other] = parents[parents[other]]
        other = parents[other]
    if one < other:
        parents[other] = one
    elif other < one:
        parents[one] = other
