"""How points lie around a position, at several sizes at once: sums over nested cells.

A level keeps, for every occupied cube, the number of points, of points on sure surfaces, and the
first and second moments. Twenty-seven cubes around it are added up and their spread is taken
apart into line, plane and scatter.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from processing.methods.noise.features.cell_kernels import (
    SUMS,
    CellLevel,
    cell_sums_kernel,
    number_kernel,
    point_sums_kernel,
    slots_kernel,
    sure_cells_kernel,
    sure_points_kernel,
)
from processing.methods.noise.neighbours.morton import NestedCells

_SLOTS_PER_CELL, _LEAST_BITS = 2, 4
"""Room of the table in which codes are found: at most half full, so that a search is short."""

_CHILD_BITS = 3
"""Binary digits of a code for each level: one along every axis."""

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]


def cell_levels(cells: NestedCells, count: int) -> tuple[list[CellLevel], list[NDArray[np.int32]]]:
    """Levels 0 … count − 1 of points in nested cells, none of them sure.

    Returns
    -------
    levels : list of CellLevel
    numbers : list of (…,) int32
        The cell of level 0 of each point along the curve; then, for each cell of a level, the one
        of the next that holds it.
    """
    codes, positions = cells.codes, np.empty(cells.codes.size, np.int32)
    used = number_kernel(codes, positions)
    sums, kept = np.zeros((used, SUMS)), np.empty(used, np.int64)
    point_sums_kernel(cells.local_xyz, positions, sums)
    kept[positions] = codes
    levels, parents = levels_above(level_of(kept, sums, cells.cell_m), count)
    return levels, [positions, *parents]


def count_sure(
    levels: list[CellLevel], numbers: list[NDArray[np.int32]], is_sure: NDArray[np.bool_]
) -> None:
    """Enter into the sums of all levels, as from :func:`cell_levels`, which points are sure.

    Parameters
    ----------
    is_sure : (n,) bool
        In the cells' order.
    """
    sure_points_kernel(is_sure, numbers[0], levels[0].sums)
    for (below, above), group in zip(pairwise(levels), numbers[1:], strict=True):
        sure_cells_kernel(below.sums, group, above.sums)


def levels_above(finest: CellLevel, count: int) -> tuple[list[CellLevel], list[NDArray[np.int32]]]:
    """Levels 0 … count − 1 over finest cells.

    Returns
    -------
    levels : list of CellLevel
    numbers : list of (…,) int32
        For each cell of a level but the last, the one of the next that holds it.
    """
    levels, numbers = [finest], []
    for _ in range(1, count):
        below = levels[-1]
        parents, positions = below.codes >> _CHILD_BITS, np.empty(below.codes.size, np.int32)
        used = number_kernel(parents, positions)
        sums, kept = np.zeros((used, SUMS)), np.empty(used, np.int64)
        cell_sums_kernel(below.sums, positions, sums)
        kept[positions] = parents
        levels.append(level_of(kept, sums, below.side * 2))
        numbers.append(positions)
    return levels, numbers


def level_of(codes: _Integers, sums: _Floats, side: float) -> CellLevel:
    """A level of cells, rising, that can be found by their codes."""
    size = 1 << max(_LEAST_BITS, int(_SLOTS_PER_CELL * max(codes.size, 1)).bit_length())
    slots = np.full(size, -1, np.int32)
    slots_kernel(codes, slots)
    return CellLevel(codes, sums, side, slots)
