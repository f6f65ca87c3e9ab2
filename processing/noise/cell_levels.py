"""How points lie around a place, at several sizes at once: sums over nested cells.

A level keeps, for every occupied cube, the number of points, of points on sure surfaces, and the
first and second moments. Twenty-seven cubes around a place are added up and their spread is taken
apart into line, plane and scatter.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.kernels import kernel
from processing.noise.morton import NestedCells

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_X = 0x1249249249249249
SUMS = 11  # points, sure points, x y z, xx xy xz yy yz zz
AROUND = 9  # see around_kernel


class CellLevel(NamedTuple):
    """``codes`` (c,) rising; ``sums`` (c, 11); ``side`` m; ``slots``: where a code is found."""

    codes: _Integers
    sums: _Floats
    side: float
    slots: NDArray[np.int32]


def cell_levels(cells: NestedCells, is_sure: NDArray[np.bool_], count: int) -> list[CellLevel]:
    """Levels 0 … count − 1 of points in nested cells.

    Parameters
    ----------
    is_sure : (n,) bool
        In the cells' order.
    """
    codes = cells.codes
    is_first = np.r_[True, codes[1:] != codes[:-1]] if codes.size else np.zeros(0, bool)
    group = np.cumsum(is_first) - 1
    sums = np.zeros((int(is_first.sum()), SUMS))
    point_sums_kernel(cells.local_xyz, is_sure, group, sums)
    levels = [_level_of(codes[is_first], sums, cells.cell_m)]
    for _ in range(1, count):
        below = levels[-1]
        parents = below.codes >> 3
        is_first = np.r_[True, parents[1:] != parents[:-1]] if parents.size else is_first
        sums = np.add.reduceat(below.sums, np.flatnonzero(is_first)) if parents.size else below.sums
        levels.append(_level_of(parents[is_first], sums, below.side * 2))
    return levels


def _level_of(codes: _Integers, sums: _Floats, side: float) -> CellLevel:
    size = 1 << max(4, int(2 * max(codes.size, 1)).bit_length())
    slots = np.full(size, -1, np.int32)
    slots_kernel(codes, slots)
    return CellLevel(codes, np.ascontiguousarray(sums), side, slots)


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
def point_sums_kernel(
    xyz: _Floats, is_sure: NDArray[np.bool_], group: _Integers, sums: _Floats
) -> None:
    """Add every point to the sums of its cell."""
    for point in range(xyz.shape[0]):
        row = sums[group[point]]
        x, y, z = xyz[point, 0], xyz[point, 1], xyz[point, 2]
        row[0] += 1
        row[1] += is_sure[point]
        row[2] += x
        row[3] += y
        row[4] += z
        row[5] += x * x
        row[6] += x * y
        row[7] += x * z
        row[8] += y * y
        row[9] += y * z
        row[10] += z * z


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
        _add_around(level, codes[i], total)
        count = max(total[0], 1.0)
        around[i, 0] = total[0]
        around[i, 1] = total[1]
        mx, my, mz = total[2] / count, total[3] / count, total[4] / count
        covariance[0, 0] = total[5] / count - mx * mx
        covariance[0, 1] = total[6] / count - mx * my
        covariance[0, 2] = total[7] / count - mx * mz
        covariance[1, 1] = total[8] / count - my * my
        covariance[1, 2] = total[9] / count - my * mz
        covariance[2, 2] = total[10] / count - mz * mz
        large, middle, small = _eigenvalues(covariance)
        around[i, 2] = (large - middle) / max(large, 1e-12)
        around[i, 3] = (middle - small) / max(large, 1e-12)
        around[i, 4] = math.sqrt(max(small, 0.0)) / level.side
        nx, ny, nz = _eigenvector(covariance, small)
        around[i, 5], around[i, 6], around[i, 7] = nx, ny, nz
        around[i, 8] = nx * mx + ny * my + nz * mz


@kernel
def _slot(code: int, mask: int) -> int:
    mixed = code * 0x1E3779B97F4A7C15
    return (mixed ^ (mixed >> 29)) & mask


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
def _add_around(level: CellLevel, code: int, total: _Floats) -> None:
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
def _eigenvalues(a: _Floats) -> tuple[float, float, float]:
    p1 = a[0, 1] ** 2 + a[0, 2] ** 2 + a[1, 2] ** 2
    q = (a[0, 0] + a[1, 1] + a[2, 2]) / 3
    p2 = (a[0, 0] - q) ** 2 + (a[1, 1] - q) ** 2 + (a[2, 2] - q) ** 2 + 2 * p1
    if p2 <= 1e-18:
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
def _eigenvector(a: _Floats, value: float) -> tuple[float, float, float]:
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
    from processing.noise.morton import nested_cells

    levels = cell_levels(nested_cells(np.eye(3), 0.1), np.ones(3, np.bool_), 2)
    around_kernel(levels[0], levels[0].codes[:1], np.empty((1, AROUND)))
