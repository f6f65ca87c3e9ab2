"""Points of thin things in the air, the lines through them, and which of them hang together."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel

_BACK = 8
"""Points before one that may be of the pulse before: four returns of each."""

_MOST_NEAR = 96
"""Points about one that are looked at; a vehicle that waits measures thousands."""

_DIRECTIONS = 20
"""Of these points, how many give a direction."""


class LineLimits(NamedTuple):
    """What a piece of a wire is.

    ``reach_m``: how far along it is looked for; ``core_m``: how far a point may lie off it;
    ``ring_m``, ``free_m``: between which distances nothing may lie; ``fewest``: points;
    ``steepest``: rise over run; ``beside``: points in the ring for each on the line.
    """

    reach_m: float
    core_m: float
    ring_m: float
    free_m: float
    fewest: int
    steepest: float
    beside: float


class WireGrid(NamedTuple):
    """Cells of space; points are sorted by them.

    ``low``: corner, m; ``shape``: (3,) cells along each axis; ``size_m``: of a cell.
    """

    low: Floats
    shape: Integers
    size_m: float


@kernel
def short_runs_kernel(
    local: Floats, time_s: Floats, near_m: float, pulse_s: float, longest_m: float, short: Flags
) -> None:
    """Mark points whose neighbours along the scan line end within a short distance.

    Parameters
    ----------
    near_m : float
        Points of neighbouring pulses that are nearer are of one thing.
    pulse_s : float
        Time between pulses, s, with what it may vary; a missing one ends a run.
    longest_m : float
        Extent of a run that is short.
    short : (n,) bool
        Written.
    """
    count = len(local)
    run = np.arange(count)
    low = local.copy()
    high = local.copy()
    for point in range(count):
        for before in range(max(point - _BACK, 0), point):
            later = time_s[point] - time_s[before]
            if later > pulse_s or later <= 0.0:
                continue
            off = 0.0
            for axis in range(3):
                off += (local[point, axis] - local[before, axis]) ** 2
            if off < near_m * near_m:
                run[point] = run[before]
                break
        first = run[point]
        for axis in range(3):
            low[first, axis] = min(low[first, axis], local[point, axis])
            high[first, axis] = max(high[first, axis], local[point, axis])
    for point in range(count):
        first = run[point]
        extent = 0.0
        for axis in range(3):
            extent += (high[first, axis] - low[first, axis]) ** 2
        short[point] = extent < longest_m * longest_m


@kernel
def _cell_of(place: Floats, shape: Integers, low: Floats, size_m: float) -> int:
    i = int((place[0] - low[0]) / size_m)
    j = int((place[1] - low[1]) / size_m)
    k = int((place[2] - low[2]) / size_m)
    return int((i * shape[1] + j) * shape[2] + k)


@kernel
def _near(
    points: Floats, point: int, cells: Integers, starts: Integers, grid: WireGrid, found: Integers
) -> int:
    """Points within the reach of a point, by their number, thinned; how many."""
    centre = points[point]
    home = _cell_of(centre, grid.shape, grid.low, grid.size_m)
    spans = np.empty((9, 2), np.int64)
    total = 0
    for number in range(9):
        i, j = number // 3 - 1, number % 3 - 1
        base = home + (i * grid.shape[1] + j) * grid.shape[2] - 1
        first = np.searchsorted(cells, base)
        last = first
        while last < cells.size and cells[last] <= base + 2:
            last += 1
        spans[number, 0], spans[number, 1] = starts[first], starts[last]
        total += starts[last] - starts[first]
    # Of the cells about it a sphere holds a sixth.
    every = total // (6 * _MOST_NEAR) + 1
    count = 0
    for number in range(9):
        for other in range(spans[number, 0], spans[number, 1], every):
            east = points[other, 0] - centre[0]
            north = points[other, 1] - centre[1]
            up = points[other, 2] - centre[2]
            off = east * east + north * north + up * up
            if off <= grid.size_m * grid.size_m and count < found.size:
                found[count] = other
                count += 1
    return count


@kernel
def crowded_kernel(
    points: Floats, starts: Integers, grid: WireGrid, most: int, crowded: Flags
) -> None:
    """Mark the points of cells of which more than so many of 64 parts are filled: crowns."""
    part_m = grid.size_m / 4
    for cell in range(starts.size - 1):
        filled = np.uint64(0)
        for point in range(starts[cell], starts[cell + 1]):
            bit = 0
            for axis in range(3):
                bit = 4 * bit + int((points[point, axis] - grid.low[axis]) / part_m) % 4
            filled |= np.uint64(1) << np.uint64(bit)
        count = 0
        for bit in range(64):
            count += (filled >> np.uint64(bit)) & np.uint64(1) != 0
        for point in range(starts[cell], starts[cell + 1]):
            crowded[point] = count > most


@kernel
def lines_kernel(
    points: Floats,
    cells: Integers,
    starts: Integers,
    grid: WireGrid,
    limits: LineLimits,
    directions: Floats,
) -> None:
    """The direction of the thin line through each point; 0 where there is none.

    Parameters
    ----------
    points : (n, 3) float64
        Sorted by cells.
    cells, starts : (c,) and (c + 1,) int64
        Filled cells, rising, and where the points of each begin.
    directions : (n, 3) float64
        Unit vectors. Written.
    """
    found = np.empty(2 * _MOST_NEAR, np.int64)
    way = np.empty(3)
    best = np.empty(3)
    for point in range(len(points)):
        directions[point] = 0.0
        count = _near(points, point, cells, starts, grid, found)
        if count < limits.fewest:
            continue
        step = max(1, count // _DIRECTIONS)
        most = 0.0
        for one in range(0, count, step):
            other = found[one]
            for axis in range(3):
                way[axis] = points[other, axis] - points[point, axis]
            away = math.sqrt(way[0] ** 2 + way[1] ** 2 + way[2] ** 2)
            if away < limits.reach_m / 5 or abs(way[2]) > limits.steepest * math.hypot(
                way[0], way[1]
            ):
                continue
            way /= away
            score = _on_line(points, point, found[:count], way, limits)
            if score > most:
                most = score
                best[:] = way
        if most > 0.0:
            directions[point] = best


@kernel
def _on_line(points: Floats, point: int, found: Integers, way: Floats, limits: LineLimits) -> float:
    """How many points lie on a line through a point; 0 where too few or others lie beside it."""
    on, beside = 0, 0
    low, high = 0.0, 0.0
    for other in found:
        east = points[other, 0] - points[point, 0]
        north = points[other, 1] - points[point, 1]
        up = points[other, 2] - points[point, 2]
        along = east * way[0] + north * way[1] + up * way[2]
        off = math.sqrt(max(east * east + north * north + up * up - along * along, 0.0))
        if off < limits.core_m:
            on += 1
            low, high = min(low, along), max(high, along)
        elif limits.ring_m < off < limits.free_m:
            beside += 1
    if on < limits.fewest or high - low < limits.reach_m / 2 or beside > limits.beside * on:
        return 0.0
    return float(on - beside)


@kernel
def groups_kernel(
    points: Floats,
    directions: Floats,
    cells: Integers,
    starts: Integers,
    grid: WireGrid,
    core_m: float,
    group: NDArray[np.int64],
) -> None:
    """Join points that lie on each other's lines: the first of its group is written for each."""
    found = np.empty(2 * _MOST_NEAR, np.int64)
    for point in range(len(points)):
        group[point] = point
    for point in range(len(points)):
        count = _near(points, point, cells, starts, grid, found)
        for one in range(count):
            other = found[one]
            if other <= point:
                continue
            turn = 0.0
            for axis in range(3):
                turn += directions[point, axis] * directions[other, axis]
            if abs(turn) < 0.985:
                continue
            if (
                _off(points, point, other, directions[point]) < core_m
                and _off(points, point, other, directions[other]) < core_m
            ):
                a, b = _first(group, point), _first(group, other)
                group[max(a, b)] = min(a, b)
    for point in range(len(points)):
        group[point] = _first(group, point)


@kernel
def _off(points: Floats, point: int, other: int, way: Floats) -> float:
    along, square = 0.0, 0.0
    for axis in range(3):
        off = points[other, axis] - points[point, axis]
        along += off * way[axis]
        square += off * off
    return math.sqrt(max(square - along * along, 0.0))


@kernel
def _first(group: NDArray[np.int64], point: int) -> int:
    while group[point] != point:
        group[point] = group[group[point]]
        point = group[point]
    return point
