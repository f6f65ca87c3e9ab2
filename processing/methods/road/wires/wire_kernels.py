"""Points of thin things in the air, the lines through them, and which of them hang together."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel

Singles = NDArray[np.float32]
Bins = NDArray[np.int32]

_BACK = 8
"""Points before one that may be of the pulse before: four returns of each."""

_MOST_NEAR = 96
"""Points about one that are looked at; a vehicle that waits measures thousands."""

_DIRECTIONS = 20
"""Of these points, how many give a direction."""

_BIN, _SIDE = 0.05, 64
"""Directions are told apart by their tangents to this: a wire's points, off by a centimetre half a
metre away, share a bin or lie in the next one. Bins along a side of a map, margins included."""

_NO_BIN = 2 * _SIDE * _SIDE
"""Stands for no direction in a map; the votes for it aren't looked at."""

_OVERLAP = 1.15
"""Tangent up to which a direction counts in both maps, of the one axis and of the other."""

_BESIDE_SEEDS = 8
"""Points beside a line through which another one along it is looked for."""

_SAME_WAY = 0.985
"""Cosine between the directions of two points of one line: 10°, what points 16 cm off by 3 cm
leave open."""

_AGREED = 3
"""Points that give one direction: the fewest of a line without the one that it goes through."""


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
def _spans_about(
    cell: int, cells: Integers, starts: Integers, grid: WireGrid, spans: Integers
) -> int:
    """Write where the points of the columns of cells about a filled one lie; how many there are."""
    total = 0
    for number in range(9):
        i, j = number // 3 - 1, number % 3 - 1
        base = cells[cell] + (i * grid.shape[1] + j) * grid.shape[2] - 1
        first = np.searchsorted(cells, base)
        last = first
        while last < cells.size and cells[last] <= base + 2:
            last += 1
        spans[number, 0], spans[number, 1] = starts[first], starts[last]
        total += starts[last] - starts[first]
    return total


@kernel
def _near(
    points: Floats, point: int, spans: Integers, grid: WireGrid, every: int, found: Integers
) -> int:
    """Points within the reach of a point, by their number, thinned; how many.

    ``found`` has room for one more than are told.
    """
    count, most = 0, found.size - 1
    east, north, up = points[point, 0], points[point, 1], points[point, 2]
    reach = grid.size_m * grid.size_m
    for number in range(9):
        for other in range(spans[number, 0], spans[number, 1], every):
            aside, ahead = points[other, 0] - east, points[other, 1] - north
            above = points[other, 2] - up
            # Without a branch, since a quarter of them are near, in no order.
            found[count] = other
            off = aside * aside + ahead * ahead + above * above
            count += int((off <= reach) & (count < most))
    return count


@kernel
def crowded_kernel(
    points: Floats,
    starts: Integers,
    grid: WireGrid,
    most: int,
    some: tuple[int, int],
    crowded: Flags,
) -> None:
    """Mark the points of cells of which more than so many of 64 parts are filled: crowns.

    Parameters
    ----------
    some : (int, int)
        The first of the cells that are asked, and the one after the last.
    """
    part_m = grid.size_m / 4
    for cell in range(some[0], some[1]):
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
    some: tuple[int, int],
    directions: Floats,
) -> None:
    """The direction of the thin line through each point of some cells; 0 where there is none.

    Parameters
    ----------
    points : (n, 3) float64
        Sorted by cells.
    cells, starts : (c,) and (c + 1,) int64
        Filled cells, rising, and where the points of each begin.
    some : (int, int)
        The first of the cells, and the one after the last.
    directions : (n, 3) float64
        Unit vectors. Written for the points of these cells.
    """
    found = np.empty(2 * _MOST_NEAR + 1, np.int64)
    # Metres about a point, so that single precision tells micrometres.
    offs = np.empty((4, found.size), np.float32)
    bins = np.empty((2, found.size), np.int32)
    votes = np.zeros(_NO_BIN + 1, np.int32)
    spans = np.empty((9, 2), np.int64)
    for cell in range(some[0], some[1]):
        # Of the cells about it a sphere holds a sixth.
        every = _spans_about(cell, cells, starts, grid, spans) // (6 * _MOST_NEAR) + 1
        for point in range(starts[cell], starts[cell + 1]):
            directions[point] = 0.0
            count = _near(points, point, spans, grid, every, found)
            if count >= limits.fewest:
                _measure_offs(points, point, found[:count], offs)
                _vote(offs, count, limits, bins, votes)
                _best_line(offs, count, limits, (bins, votes), directions[point])
                for one in range(count):
                    votes[bins[0, one]] = votes[bins[1, one]] = 0


@kernel
def _measure_offs(points: Floats, point: int, found: Integers, offs: Singles) -> None:
    """Write how far points lie to the east, north and up of one, and the square of all three."""
    for one in range(found.size):
        square = 0.0
        for axis in range(3):
            off = points[found[one], axis] - points[point, axis]
            offs[axis, one] = off
            square += off * off
        offs[3, one] = square


@kernel
def _vote(offs: Singles, count: int, limits: LineLimits, bins: Bins, votes: Bins) -> None:
    """Count how many points about one lie in each direction from it, whichever way along it.

    Without a branch, so that several are divided at a time; what 0 gives isn't looked at.
    """
    near, steepest = (limits.reach_m / 5) ** 2, limits.steepest**2
    for one in range(count):
        east, north, up = offs[0, one], offs[1, one], offs[2, one]
        level = east * east + north * north
        is_apart = (level + up * up >= near) & (up * up <= steepest * level)
        i = np.int32(np.divide(north, east) / _BIN + _SIDE / 2)
        j = np.int32(np.divide(up, east) / _BIN + _SIDE / 2)
        is_along = is_apart & (abs(north) <= _OVERLAP * abs(east))
        bins[0, one] = i * _SIDE + j if is_along else _NO_BIN
        i = np.int32(np.divide(east, north) / _BIN + _SIDE / 2)
        j = np.int32(np.divide(up, north) / _BIN + _SIDE / 2)
        is_along = is_apart & (abs(east) <= _OVERLAP * abs(north))
        bins[1, one] = (_SIDE + i) * _SIDE + j if is_along else _NO_BIN
    for one in range(count):
        votes[bins[0, one]] += 1
        votes[bins[1, one]] += 1


@kernel
def _best_line(
    offs: Singles,
    count: int,
    limits: LineLimits,
    voted: tuple[Bins, Bins],
    direction: Floats,
) -> None:
    """Write the direction through a point that has the most on it, of those that others share."""
    bins, votes = voted
    most = 0
    for one in range(0, count, max(1, count // _DIRECTIONS)):
        home = bins[0, one] if bins[0, one] != _NO_BIN else bins[1, one]
        if home == _NO_BIN:
            continue
        agreed = 0
        for i in range(-1, 2):
            for j in range(-1, 2):
                agreed += votes[home + i * _SIDE + j]
        if agreed < _AGREED:
            continue
        long = np.float32(math.sqrt(offs[3, one]))
        way = (offs[0, one] / long, offs[1, one] / long, offs[2, one] / long)
        score = _on_line(offs, count, way, limits, most)
        if score > most:
            most = score
            direction[0], direction[1], direction[2] = way


@kernel
def _on_line(
    offs: Singles,
    count: int,
    way: tuple[np.float32, np.float32, np.float32],
    limits: LineLimits,
    most: int,
) -> int:
    """How many points lie on a line through one, less those beside it.

    0 where too few lie on it, or too many beside it, or no more than `most` are told.
    """
    east, north, up, square = offs[0], offs[1], offs[2], offs[3]
    core = np.float32(limits.core_m**2)
    ring, free = np.float32(limits.ring_m**2), np.float32(limits.free_m**2)
    on, beside = np.int32(0), np.int32(0)
    # Without a branch and in single precision, so that eight points are counted at a time.
    for one in range(count):
        along = east[one] * way[0] + north[one] * way[1] + up[one] * way[2]
        off = square[one] - along * along
        on = np.int32(on + (off < core))
        beside = np.int32(beside + ((off > ring) & (off < free)))
    if on < limits.fewest or on <= most:
        return 0
    if beside > limits.beside * on:
        beside -= _on_neighbours(offs, count, way, limits)
    if beside > limits.beside * on or on - beside <= most:
        return 0
    low, high = 0.0, 0.0
    for one in range(count):
        along = east[one] * way[0] + north[one] * way[1] + up[one] * way[2]
        if square[one] - along * along < core:
            low, high = min(low, along), max(high, along)
    return int(on - beside) if high - low >= limits.reach_m / 2 else 0


@kernel
def _on_neighbours(
    offs: Singles,
    count: int,
    way: tuple[np.float32, np.float32, np.float32],
    limits: LineLimits,
) -> int:
    """How many of the points beside a line lie on two others along it: cables of one route."""
    core, ring, free = limits.core_m**2, limits.ring_m**2, limits.free_m**2
    inside, number = np.empty(count + 1, np.int64), 0
    for one in range(count):
        along = offs[0, one] * way[0] + offs[1, one] * way[1] + offs[2, one] * way[2]
        off = offs[3, one] - along * along
        inside[number] = one
        number += int((ring < off) & (off < free))
    beside = np.empty((4, number))
    for one in range(number):
        at = inside[one]
        along = offs[0, at] * way[0] + offs[1, at] * way[1] + offs[2, at] * way[2]
        beside[3, one] = along
        for axis in range(3):
            beside[axis, one] = offs[axis, at] - along * way[axis]
    total = 0
    for _ in range(2):
        best, home = _fullest_neighbour(beside, number, core, limits)
        if best < limits.fewest:
            break
        total += best
        east, north, up = beside[0, home], beside[1, home], beside[2, home]
        left = 0
        for one in range(number):
            aside, ahead = beside[0, one] - east, beside[1, one] - north
            above = beside[2, one] - up
            if aside * aside + ahead * ahead + above * above >= core:
                for axis in range(4):
                    beside[axis, left] = beside[axis, one]
                left += 1
        number = left
    return total


@kernel
def _fullest_neighbour(
    beside: Floats, number: int, core: float, limits: LineLimits
) -> tuple[int, int]:
    """How many points lie on the line along the way that holds the most, and one of them.

    No line of fewer points than a wire has is told.
    """
    best, home = limits.fewest - 1, 0
    easts, norths, ups, alongs = beside[0], beside[1], beside[2], beside[3]
    for seed in range(0, number, max(1, number // _BESIDE_SEEDS)):
        east, north, up = easts[seed], norths[seed], ups[seed]
        on = 0
        # Without a branch, so that several points are counted at a time.
        for one in range(number):
            aside, ahead, above = easts[one] - east, norths[one] - north, ups[one] - up
            on += int(aside * aside + ahead * ahead + above * above < core)
        if on <= best:
            continue
        low, high = math.inf, -math.inf
        for one in range(number):
            aside, ahead, above = easts[one] - east, norths[one] - north, ups[one] - up
            if aside * aside + ahead * ahead + above * above < core:
                low, high = min(low, alongs[one]), max(high, alongs[one])
        if high - low >= limits.reach_m / 2:
            best, home = on, seed
    return best, home


@kernel
def groups_kernel(
    points: Floats,
    directions: Floats,
    cells: Integers,
    starts: Integers,
    grid: WireGrid,
    core_m: float,
    some: tuple[int, int],
    group: NDArray[np.int64],
) -> None:
    """Join points of some cells with those that lie on each other's lines.

    Parameters
    ----------
    some : (int, int)
        The first of the cells, and the one after the last.
    group : (n,) int64
        Another point of the same group, or the point itself, from which all of them begin.
    """
    found = np.empty(2 * _MOST_NEAR + 1, np.int64)
    spans = np.empty((9, 2), np.int64)
    for cell in range(some[0], some[1]):
        every = _spans_about(cell, cells, starts, grid, spans) // (6 * _MOST_NEAR) + 1
        for point in range(starts[cell], starts[cell + 1]):
            count = _near(points, point, spans, grid, every, found)
            _join(points, point, found[:count], directions, core_m, group)


@kernel
def both_kernel(group: NDArray[np.int64], other: NDArray[np.int64]) -> None:
    """Join what is joined in another array, too; each points to an earlier point or itself."""
    for point in range(group.size):
        a, b = _first(group, point), _first(group, other[point])
        group[max(a, b)] = min(a, b)


@kernel
def firsts_kernel(group: NDArray[np.int64]) -> None:
    """Write the first of its group for each point."""
    for point in range(group.size):
        group[point] = _first(group, point)


@kernel
def _join(
    points: Floats,
    point: int,
    found: Integers,
    directions: Floats,
    core_m: float,
    group: NDArray[np.int64],
) -> None:
    """Join a point with those about it that lie on its line, and it on theirs."""
    for other in found:
        if other <= point:
            continue
        turn = 0.0
        for axis in range(3):
            turn += directions[point, axis] * directions[other, axis]
        if abs(turn) < _SAME_WAY:
            continue
        if (
            _off(points, point, other, directions[point]) < core_m
            and _off(points, point, other, directions[other]) < core_m
        ):
            a, b = _first(group, point), _first(group, other)
            group[max(a, b)] = min(a, b)


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
