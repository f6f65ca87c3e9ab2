"""How points lie around a place, at several sizes at once: sums over nested cells.

A level keeps, for every occupied cube, the number of points, of points on sure surfaces, and the
first and second moments. Twenty-seven cubes around a place are added up and their spread is taken
apart into line, plane and scatter.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.noise.cell_kernels import SUMS, CellLevel, point_sums_kernel, slots_kernel
from processing.noise.morton import NestedCells

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]


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
