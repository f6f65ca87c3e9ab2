"""Loops over nested cells: what lies around a cell, above and below it, and what hangs together."""

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

SUMS = 11
COUNT, SURE, SUM_X, SUM_Y, SUM_Z, SUM_XX, SUM_XY, SUM_XZ, SUM_YY, SUM_YZ, SUM_ZZ = range(SUMS)
"""What is kept of a cell: points, sure points, and the sums of coordinates and their products."""

AROUND = 9
_POINTS, _SURE, _LINE, _PLANE, _THICKNESS, _NORMAL_X, _NORMAL_Y, _NORMAL_Z, _DISTANCE = range(
    AROUND
)
"""Columns of :func:`around_kernel`."""

COLUMN = 6
"""Columns of :func:`column_kernel`."""

SIDES, _SIDES_BEFORE = 27, 13
"""Cubes in a block of three by three by three, and those before its middle."""

_COLUMN_CELLS = 16
"""Cells straight above and below that are looked at; by trial, the trees learned with it."""

_NO_VARIANCE = 1e-12
"""m², keeps shares of a variance of nothing finite."""

_ALL_EQUAL = 1e-18
"""m⁴, below which the three variances are the same to rounding."""

_HASH_FACTOR, _HASH_SHIFT = 0x1E3779B97F4A7C15, 29
"""Spread codes over the slots: 2^64 over the golden ratio without its first bit, as in Fibonacci
hashing (Knuth, The Art of Computer Programming 3, section 6.4)."""


class CellLevel(NamedTuple):
    """``codes`` (c,) rising; ``sums`` (c, 11); ``side`` m; ``slots``: where a code is found."""

    codes: _Integers
    sums: _Floats
    side: float
    slots: NDArray[np.int32]


@kernel
def number_kernel(codes: _Integers, numbers: NDArray[np.int32]) -> int:
    """Number codes that don't decrease, equal ones alike; how many there are."""
    number = -1
    for position in range(codes.size):
        if position == 0 or codes[position] != codes[position - 1]:
            number += 1
        numbers[position] = number
    return number + 1


@kernel
def slots_kernel(codes: _Integers, slots: NDArray[np.int32]) -> None:
    """Enter every code at the first free slot from its own on."""
    mask = slots.size - 1
    for cell in range(codes.size):
        slot = _slot(codes[cell], mask)
        while slots[slot] >= 0:
            slot = (slot + 1) & mask
        slots[slot] = cell


@kernel
def point_sums_kernel(xyz: _Floats, group: NDArray[np.int32], sums: _Floats) -> None:
    """Add every point to the sums of its cell; none is sure as yet."""
    for point in range(xyz.shape[0]):
        row = sums[group[point]]
        x, y, z = xyz[point, 0], xyz[point, 1], xyz[point, 2]
        row[COUNT] += 1
        row[SUM_X] += x
        row[SUM_Y] += y
        row[SUM_Z] += z
        row[SUM_XX] += x * x
        row[SUM_XY] += x * y
        row[SUM_XZ] += x * z
        row[SUM_YY] += y * y
        row[SUM_YZ] += y * z
        row[SUM_ZZ] += z * z


@kernel
def cell_sums_kernel(below: _Floats, group: NDArray[np.int32], sums: _Floats) -> None:
    """Add the sums of every cell to those of the cell that holds it."""
    for cell in range(group.size):
        for m in range(SUMS):
            sums[group[cell], m] += below[cell, m]


@kernel
def sure_points_kernel(is_sure: NDArray[np.bool_], group: NDArray[np.int32], sums: _Floats) -> None:
    """Count the sure points of every cell."""
    for point in range(group.size):
        sums[group[point], SURE] += is_sure[point]


@kernel
def sure_cells_kernel(below: _Floats, group: NDArray[np.int32], sums: _Floats) -> None:
    """Count those of every cell that holds cells."""
    for cell in range(group.size):
        sums[group[cell], SURE] += below[cell, SURE]


@kernel
def held_kernel(
    numbers: tuple[NDArray[np.int32], ...],
    levels: NDArray[np.int8],
    positions: _Integers,
    found: NDArray[np.int32],
) -> None:
    """The cell that holds each of some positions along the curve, each at a level of its own."""
    for i in range(positions.size):
        cell = numbers[0][positions[i]]
        for above in range(1, levels[i] + 1):
            cell = numbers[above][cell]
        found[i] = cell


@kernel
def around_kernel(level: CellLevel, codes: _Integers, around: _Floats) -> None:
    """What lies in the 27 cubes around each of some cubes, which rise.

    ``around`` (k, 9): points, sure points, linearity, planarity, thickness in cells, then normal
    (3); the last is the normal's distance from the origin, so that n · p − it is a point's offset.
    """
    total = np.empty(SUMS)
    covariance = np.empty((3, 3))
    for i in range(codes.size):
        total[:] = 0
        add_around(level, codes[i], total)
        count = max(total[COUNT], 1.0)
        around[i, _POINTS] = total[COUNT]
        around[i, _SURE] = total[SURE]
        mx, my, mz = total[SUM_X] / count, total[SUM_Y] / count, total[SUM_Z] / count
        covariance_of(total, covariance)
        large, middle, small = eigenvalues(covariance)
        around[i, _LINE] = (large - middle) / max(large, _NO_VARIANCE)
        around[i, _PLANE] = (middle - small) / max(large, _NO_VARIANCE)
        around[i, _THICKNESS] = math.sqrt(max(small, 0.0)) / level.side
        nx, ny, nz = eigenvector(covariance, small)
        around[i, _NORMAL_X], around[i, _NORMAL_Y], around[i, _NORMAL_Z] = nx, ny, nz
        around[i, _DISTANCE] = nx * mx + ny * my + nz * mz


@kernel
def mean_around_kernel(
    level: CellLevel, codes: _Integers, totals: _Floats, found: NDArray[np.float32]
) -> None:
    """The mean of a value over the points in the 27 cubes around each of some cubes.

    ``totals`` (c,): the value's sum over the points of each cube of the level; ``found`` (k,).
    """
    for i in range(codes.size):
        total, count = 0.0, 0.0
        for side in range(SIDES):
            cell = beside(level, codes[i], side)
            if cell >= 0:
                total += totals[cell]
                count += level.sums[cell, COUNT]
        found[i] = total / max(count, 1.0)


@kernel
def point_features_kernel(
    level: CellLevel,
    around: _Floats,
    cells: _Integers,
    local_xyz: _Floats,
    positions: _Integers,
    directions: _Floats,
    found: NDArray[np.float32],
) -> None:
    """Numbers of points from what lies around their cells.

    ``around`` (k, 9) as from :func:`around_kernel`; ``cells`` (m,) into it; ``positions`` (m,) into
    ``local_xyz``; ``directions`` (m, 3), or no rows where beams aren't known. ``found`` (m, 8):
    log2 of points and of sure points, linearity, planarity, thickness, distance from the plane in
    cells, how level the plane is, and how squarely the beam met it.
    """
    for i in range(positions.size):
        mine, xyz = around[cells[i]], local_xyz[positions[i]]
        nx, ny, nz = mine[_NORMAL_X], mine[_NORMAL_Y], mine[_NORMAL_Z]
        found[i, 0] = math.log2(1 + mine[_POINTS])
        found[i, 1] = math.log2(1 + mine[_SURE])
        found[i, 2], found[i, 3], found[i, 4] = mine[_LINE], mine[_PLANE], mine[_THICKNESS]
        found[i, 5] = abs(nx * xyz[0] + ny * xyz[1] + nz * xyz[2] - mine[_DISTANCE]) / level.side
        found[i, 6] = abs(nz)
        if directions.shape[0]:
            found[i, 7] = abs(nx * directions[i, 0] + ny * directions[i, 1] + nz * directions[i, 2])
        else:
            found[i, 7] = 0.0


@kernel
def column_kernel(level: CellLevel, codes: _Integers, found: NDArray[np.float32]) -> None:
    """What lies straight above and straight below each of some cells.

    ``found`` (k, 6): upwards, then downwards: cells that are occupied without a break; cells to
    the first occupied one after a break, 0 where there is none; log2 of the points in that one.
    """
    zs = _X << 2
    for i in range(codes.size):
        rest, height = codes[i] & ~zs, codes[i] & zs
        for downwards in range(2):
            value, run, gap, points = height, 0, 0, 0.0
            for step in range(1, _COLUMN_CELLS + 1):
                value = _stepped(value, 1 - 2 * downwards, zs, 4)
                if value < 0:
                    break
                cell = _cell_of(level, rest | value)
                if cell >= 0 and run == step - 1:
                    run = step
                elif cell >= 0:
                    gap, points = step, level.sums[cell, COUNT]
                    break
            first = COLUMN // 2 * downwards
            found[i, first] = run
            found[i, first + 1] = gap
            found[i, first + 2] = math.log2(1 + points)


@kernel
def join_kernel(level: CellLevel, joins: NDArray[np.bool_], parents: _Integers) -> None:
    """Give every cell the number of the first cell of its part; only cells that join are joined."""
    for cell in range(level.codes.size):
        if not joins[cell]:
            continue
        for side in range(_SIDES_BEFORE):
            other = beside(level, level.codes[cell], side)
            if other >= 0 and joins[other]:
                a, b = _root(parents, cell), _root(parents, other)
                if a < b:
                    parents[b] = a
                elif b < a:
                    parents[a] = b
    for cell in range(level.codes.size):
        parents[cell] = _root(parents, cell)


@kernel
def largest_kernel(
    level: CellLevel, joins: NDArray[np.bool_], totals: _Floats, found: _Floats
) -> None:
    """Each cell's total, or the largest beside it where the cell itself doesn't join."""
    for cell in range(level.codes.size):
        found[cell] = totals[cell] if joins[cell] else 0.0
        if joins[cell]:
            continue
        for side in range(SIDES):
            other = beside(level, level.codes[cell], side)
            if other >= 0 and joins[other]:
                found[cell] = max(found[cell], totals[other])


@kernel
def spread_kernel(sums: _Floats, found: _Floats) -> None:
    """Standard deviations (m) along the three main axes of points, falling, from their sums."""
    covariance = np.empty((3, 3))
    for i in range(sums.shape[0]):
        covariance_of(sums[i], covariance)
        values = eigenvalues(covariance)
        for axis in range(3):
            found[i, axis] = math.sqrt(max(values[axis], 0.0))


@kernel
def _root(parents: _Integers, cell: int) -> int:
    while parents[cell] != cell:
        parents[cell] = parents[parents[cell]]
        cell = parents[cell]
    return cell


@kernel
def beside(level: CellLevel, code: int, side: int) -> int:
    """The cell on one of 27 sides, of which 13 is the cell itself, or −1."""
    ys, zs = _X << 1, _X << 2
    x = _stepped(code & _X, side % 3 - 1, _X, 1)
    y = _stepped(code & ys, side // 3 % 3 - 1, ys, 2)
    z = _stepped(code & zs, side // 9 - 1, zs, 4)
    if x < 0 or y < 0 or z < 0:
        return -1
    return _cell_of(level, x | y | z)


@kernel
def _slot(code: int, mask: int) -> int:
    mixed = code * _HASH_FACTOR
    return (mixed ^ (mixed >> _HASH_SHIFT)) & mask


@kernel
def _cell_of(level: CellLevel, code: int) -> int:
    mask = level.slots.size - 1
    slot = _slot(code, mask)
    while level.slots[slot] >= 0:
        cell = int(level.slots[slot])
        if level.codes[cell] == code:
            return cell
        slot = (slot + 1) & mask
    return -1


@kernel
def add_around(level: CellLevel, code: int, total: _Floats) -> None:
    """Add the sums of the 27 cubes around a cube to a total."""
    ys, zs = _X << 1, _X << 2
    x0, y0, z0 = code & _X, code & ys, code & zs
    for i in range(-1, 2):
        x = _stepped(x0, i, _X, 1)
        for j in range(-1, 2):
            y = _stepped(y0, j, ys, 2)
            for k in range(-1, 2):
                z = _stepped(z0, k, zs, 4)
                if x < 0 or y < 0 or z < 0:
                    continue
                cell = _cell_of(level, x | y | z)
                if cell >= 0:
                    for m in range(SUMS):
                        total[m] += level.sums[cell, m]


@kernel
def _stepped(value: int, step: int, mask: int, one: int) -> int:
    """A cube's index along one axis, its bits spread, one further or one back; −1 below zero."""
    if step == 0:
        return value
    if step < 0:
        return (value - one) & mask if value > 0 else -1
    return ((value | ~mask) + one) & mask


@kernel
def covariance_of(sums: _Floats, covariance: _Floats) -> None:
    """The spread of points from their sums; the upper triangle only."""
    count = max(sums[COUNT], 1.0)
    mx, my, mz = sums[SUM_X] / count, sums[SUM_Y] / count, sums[SUM_Z] / count
    covariance[0, 0] = sums[SUM_XX] / count - mx * mx
    covariance[0, 1] = sums[SUM_XY] / count - mx * my
    covariance[0, 2] = sums[SUM_XZ] / count - mx * mz
    covariance[1, 1] = sums[SUM_YY] / count - my * my
    covariance[1, 2] = sums[SUM_YZ] / count - my * mz
    covariance[2, 2] = sums[SUM_ZZ] / count - mz * mz


@kernel
def eigenvalues(a: _Floats) -> tuple[float, float, float]:
    """Those of a symmetric matrix, falling, by Cardano's formula in its trigonometric form."""
    p1 = a[0, 1] ** 2 + a[0, 2] ** 2 + a[1, 2] ** 2
    q = (a[0, 0] + a[1, 1] + a[2, 2]) / 3
    p2 = (a[0, 0] - q) ** 2 + (a[1, 1] - q) ** 2 + (a[2, 2] - q) ** 2 + 2 * p1
    if p2 <= _ALL_EQUAL:
        return q, q, q
    p = math.sqrt(p2 / 6)
    b00, b11, b22 = (a[0, 0] - q) / p, (a[1, 1] - q) / p, (a[2, 2] - q) / p
    b01, b02, b12 = a[0, 1] / p, a[0, 2] / p, a[1, 2] / p
    half = b00 * (b11 * b22 - b12 * b12) - b01 * (b01 * b22 - b12 * b02)
    half = (half + b02 * (b01 * b12 - b11 * b02)) / 2
    phi = math.acos(min(1.0, max(-1.0, half))) / 3
    large = q + 2 * p * math.cos(phi)
    small = q + 2 * p * math.cos(phi + 2 * math.pi / 3)
    return large, 3 * q - large - small, small


@kernel
def eigenvector(a: _Floats, value: float) -> tuple[float, float, float]:
    """Unit vector across the rows of a − value · 1: the longest cross product of two of them."""
    x0, y0, z0 = a[0, 0] - value, a[0, 1], a[0, 2]
    x1, y1, z1 = a[0, 1], a[1, 1] - value, a[1, 2]
    x2, y2, z2 = a[0, 2], a[1, 2], a[2, 2] - value
    best, nx, ny, nz = 0.0, 0.0, 0.0, 1.0
    for pair in range(3):
        if pair == 0:
            cx, cy, cz = y0 * z1 - z0 * y1, z0 * x1 - x0 * z1, x0 * y1 - y0 * x1
        elif pair == 1:
            cx, cy, cz = y0 * z2 - z0 * y2, z0 * x2 - x0 * z2, x0 * y2 - y0 * x2
        else:
            cx, cy, cz = y1 * z2 - z1 * y2, z1 * x2 - x1 * z2, x1 * y2 - y1 * x2
        length = math.sqrt(cx * cx + cy * cy + cz * cz)
        if length > best:
            best, nx, ny, nz = length, cx / length, cy / length, cz / length
    return nx, ny, nz


def warm_up() -> None:
    """Compile the kernels."""
    codes = np.array([0, 3], np.int64)
    slots = np.full(16, -1, np.int32)
    slots_kernel(codes, slots)
    sums, numbers = np.zeros((2, SUMS)), np.zeros(2, np.int32)
    number_kernel(codes, numbers)
    point_sums_kernel(np.zeros((2, 3)), numbers, sums)
    cell_sums_kernel(sums, numbers, np.zeros((2, SUMS)))
    sure_points_kernel(np.ones(2, np.bool_), numbers, sums)
    sure_cells_kernel(sums, numbers, np.zeros((2, SUMS)))
    level = CellLevel(codes, sums, 1.0, slots)
    around, found = np.zeros((2, AROUND)), np.empty((2, 8), np.float32)
    around_kernel(level, codes, around)
    for directions in (np.zeros((0, 3)), np.zeros((2, 3))):
        point_features_kernel(
            level, around, codes // 3, np.zeros((2, 3)), codes // 3, directions, found
        )
    mean_around_kernel(level, codes, sums[:, 0].copy(), np.empty(2, np.float32))
    column_kernel(level, codes, np.empty((2, COLUMN), np.float32))
    parents = np.arange(2)
    join_kernel(level, sums[:, 0] > 0, parents)
    largest_kernel(level, sums[:, 0] > 0, sums[:, 0], np.empty(2))
    spread_kernel(sums, np.empty((2, 3)))
