"""Loops over nested cells for classes: how cells lie at several sizes, and heights in plan."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.noise.features.cell_kernels import (
    COUNT,
    SIDES,
    SUM_Z,
    SUMS,
    CellLevel,
    add_around,
    beside,
    covariance_of,
    eigenvalues,
    eigenvector,
)

SHAPES = 8
"""Columns of :func:`shapes_kernel`."""

_NO_VARIANCE = 1e-12
"""m², keeps shares of a variance of nothing finite."""

_FIRST_LEVEL_SIDE, _LAST_LEVEL_SIDE = 9, 18
"""Of the 27 sides of a cube, those at its own height."""


@kernel
def even_kernel(sums: Floats) -> None:
    """Let every cell weigh the same, however many points it has."""
    for cell in range(sums.shape[0]):
        count = sums[cell, COUNT]
        for m in range(SUMS):
            sums[cell, m] /= count


@kernel
def shapes_kernel(level: CellLevel, start: int, stop: int, found: NDArray[np.float32]) -> None:
    """How the finest cells in the 27 cubes around each of a level's cubes lie.

    ``found`` (c, 8): linearity and planarity (Weinmann et al. 2017, as in Takahashi 2022, eqs. 4-1
    and 4-2), thickness, verticality of the surface (eq. 4-11) and of the main direction, standard
    deviation of the height, log2 of the occupied finest cells, and the height of the cube's own
    over the middle of all; lengths in sides of a cube.
    """
    total = np.empty(SUMS)
    covariance = np.empty((3, 3))
    for i in range(start, stop):
        total[:] = 0
        add_around(level, level.codes[i], total)
        count = total[COUNT]
        covariance_of(total, covariance)
        large, middle, small = eigenvalues(covariance)
        large = max(large, _NO_VARIANCE)
        found[i, 0] = (large - middle) / large
        found[i, 1] = (middle - small) / large
        found[i, 2] = math.sqrt(max(small, 0.0)) / level.side
        _, _, normal_z = eigenvector(covariance, small)
        found[i, 3] = 1.0 - abs(normal_z)
        _, _, main_z = eigenvector(covariance, large)
        found[i, 4] = abs(main_z)
        found[i, 5] = math.sqrt(max(covariance[2, 2], 0.0)) / level.side
        found[i, 6] = math.log2(count)
        own = level.sums[i, SUM_Z] / level.sums[i, COUNT]
        found[i, 7] = (own - total[SUM_Z] / count) / level.side


@kernel
def extremes_kernel(column_of: Integers, heights: Floats, low: Floats, high: Floats) -> None:
    """Widen what each column holds by the heights in it."""
    for cell in range(column_of.size):
        column, z = column_of[cell], heights[cell]
        low[column] = min(low[column], z)
        high[column] = max(high[column], z)


@kernel
def beside_columns_kernel(plan: CellLevel, low: Floats, high: Floats, found: Floats) -> None:
    """The lowest and the highest height in the nine columns around each: ``found`` (c, 2).

    ``plan``: columns as cubes of the lowest height.
    """
    for column in range(plan.codes.size):
        lowest, highest = low[column], high[column]
        for side in range(_FIRST_LEVEL_SIDE, _LAST_LEVEL_SIDE):
            other = beside(plan, plan.codes[column], side)
            if other >= 0:
                lowest, highest = min(lowest, low[other]), max(highest, high[other])
        found[column, 0], found[column, 1] = lowest, highest


@kernel
def add_rows_kernel(group: NDArray[np.int32], values: NDArray[np.float32], sums: Floats) -> None:
    """Add rows of values to their groups; the last column of ``sums`` counts them."""
    for point in range(group.size):
        row = sums[group[point]]
        for column in range(values.shape[1]):
            row[column] += values[point, column]
        row[values.shape[1]] += 1.0


@kernel
def means_around_kernel(
    level: CellLevel, sums: Floats, start: int, stop: int, found: NDArray[np.float32]
) -> None:
    """Means over the finest cells in the 27 cubes around each of a level's cubes: ``found`` (c, k).

    ``sums`` (c, k + 1): of each cube as from :func:`add_rows_kernel`.
    """
    columns = sums.shape[1] - 1
    total = np.empty(columns + 1)
    for i in range(start, stop):
        total[:] = 0
        for side in range(SIDES):
            cell = beside(level, level.codes[i], side)
            if cell >= 0:
                for column in range(columns + 1):
                    total[column] += sums[cell, column]
        for column in range(columns):
            found[i, column] = total[column] / max(total[columns], 1.0)


def warm_up() -> None:
    """Compile the kernels."""
    codes, slots = np.zeros(1, np.int64), np.zeros(16, np.int32)
    slots[1:] = -1
    level = CellLevel(codes, np.ones((1, SUMS)), 1.0, slots)
    even_kernel(np.ones((1, SUMS)))
    shapes_kernel(level, 0, 1, np.empty((1, SHAPES), np.float32))
    extremes_kernel(codes, np.zeros(1), np.zeros(1), np.zeros(1))
    beside_columns_kernel(level, np.zeros(1), np.zeros(1), np.empty((1, 2)))
    sums = np.zeros((1, 3))
    add_rows_kernel(np.zeros(1, np.int32), np.zeros((1, 2), np.float32), sums)
    means_around_kernel(level, sums, 0, 1, np.empty((1, 2), np.float32))
