"""What the surroundings of points look like at many sizes, as rows of numbers for trees.

Points are taken together in cubes of 10 cm, each of which weighs the same, so that neither the
density of a scanner nor its range changes what a wall, a pole or a crown looks like. Nothing is
asked that depends on where the vehicle drove or how its scanner is mounted: on streets of another
simulator the thesis' distances from the trajectory cost more than they gave (docs/accuracy.md).

References
----------
Takahashi 2022, section 4.3 (features at several scales); Weinmann et al. 2017.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor
from processing.methods.classes.shape_kernels import (
    SHAPES,
    add_rows_kernel,
    beside_columns_kernel,
    even_kernel,
    extremes_kernel,
    means_around_kernel,
    shapes_kernel,
)
from processing.methods.noise.features.cell_kernels import (
    COLUMN,
    SUM_Z,
    SUMS,
    CellLevel,
    column_kernel,
    number_kernel,
    point_sums_kernel,
)
from processing.methods.noise.features.cell_levels import level_of, levels_above
from processing.methods.noise.neighbours.morton import nested_cells
from processing.methods.noise.neighbours.sharing import share_out

CELL_M = 0.1
"""Side of the finest cells: the width of a post, half that of a kerb stone. A class is given to a
cell; 99 to 99.7 % of the points of simulated streets are of the class that most of their cell's
points have."""

_LEVELS = 6
"""Sizes of cells, each twice the one before: 0.1 to 3.2 m."""

_SHAPE_LEVELS = range(1, _LEVELS)
"""Of 27 cubes: 0.6 to 9.6 m, as far as the thesis' largest sphere of radius 5 m."""

_COLUMN_LEVELS = (1, 3)
"""Cells of 0.2 and 0.8 m, 16 of which are looked through upwards and downwards: 3.2 and 12.8 m."""

_PLAN_LEVELS = (1, 3)
"""Columns of 0.2 and 0.8 m, nine of which are looked at: 0.6 m across a curb, 2.4 m across a
person's or a plate's surroundings."""

FEATURES = SHAPES * len(_SHAPE_LEVELS) + COLUMN * len(_COLUMN_LEVELS) + 2 * len(_PLAN_LEVELS) + 3
"""Numbers in a row: shapes, columns, heights in plan; height, intensity and its spread."""

AGREE_LEVELS = (1, 3)
"""Sizes of cells within which neighbours are asked what they are: 0.6 and 2.4 m around."""

_CELLS_AT_ONCE = 4_096
"""Of a share of a core's work."""

_HEIGHT_BITS = 0x1249249249249249 << 2
"""Every third binary digit of a cube's number: its height."""

REACH: float = 1.5 * 2 ** (_LEVELS - 1)
"""How far from a point others are looked at, in cells: 4.8 m where these are as fine as usual."""


@dataclass(frozen=True)
class ClassCells:
    """The finest cells of points, with what is around them.

    Attributes
    ----------
    rows : (c, f) float32
        Features of each.
    cell_of : (n,) int32
        The cell of each point.
    levels : tuple of CellLevel
        From the finest cells on.
    held_by : tuple of (c,) int64
        For each level, the cell that holds each of the finest.
    """

    rows: NDArray[np.float32]
    cell_of: NDArray[np.int32]
    levels: tuple[CellLevel, ...]
    held_by: tuple[Integers, ...]

    def with_neighbours(
        self,
        shares: NDArray[np.float32],
        monitor: Monitor,
        *,
        averaged: NDArray[np.float32] | None = None,
    ) -> NDArray[np.float32]:
        """The features, and what the cells around each are likely to be.

        Parameters
        ----------
        shares : (c, k) float32
            How likely each class is in each cell.
        averaged : (c, l) float32, optional
            What averaged trees say of it.

        Returns
        -------
        (c, f + 3 k + l) float32
            Features, the cell's own shares, means of those within 0.6 and 2.4 m; then the mean of
            what averaged trees say of the cell and within both.
        """
        own = shares if averaged is None else np.hstack([shares, averaged])
        near = [self.means_around(own, number, monitor) for number in AGREE_LEVELS]
        count = shares.shape[1]
        columns = [self.rows, shares, *(one[:, :count] for one in near)]
        if averaged is not None:
            smoothed = sum((one[:, count:] for one in near), averaged)
            columns.append(smoothed / np.float32(1 + len(near)))
        return np.hstack(columns)

    def means_around(
        self, values: NDArray[np.float32], number: int, monitor: Monitor
    ) -> NDArray[np.float32]:
        """Means over the finest cells in the 27 cubes of one size about each of the finest.

        Parameters
        ----------
        values : (c, k) float32
        number : int
            The size's place among the levels.

        Returns
        -------
        (c, k) float32
        """
        level, held = self.levels[number], self.held_by[number]
        sums = np.zeros((level.codes.size, values.shape[1] + 1))
        add_rows_kernel(held.astype(np.int32), np.ascontiguousarray(values), sums)
        means = np.empty((level.codes.size, values.shape[1]), np.float32)
        share_out(
            lambda start, stop: means_around_kernel(level, sums, start, stop, means),
            level.codes.size,
            _CELLS_AT_ONCE,
            monitor,
        )
        return np.asarray(means[held], np.float32)


def class_cells(
    local: Floats,
    heights: Floats,
    intensity: NDArray[np.float32],
    monitor: Monitor,
    cell_m: float = CELL_M,
) -> ClassCells:
    """Cells of points with their features.

    Parameters
    ----------
    local : (n, 3) float64
        m about an origin near by; finite.
    heights : (n,) float64
        m above the ground.
    intensity : (n,) float32
        log2 of the intensity over that of the ground; 0 where a recording has none.
    cell_m : float
        Side of the finest cells.
    """
    cells = nested_cells(local, cell_m)
    positions = np.empty(cells.codes.size, np.int32)
    used = number_kernel(cells.codes, positions)
    sums, codes = np.zeros((used, SUMS)), np.empty(used, np.int64)
    point_sums_kernel(cells.local_xyz, positions, sums)
    codes[positions] = cells.codes
    even_kernel(sums)
    levels, numbers = levels_above(level_of(codes, sums, cells.cell_m), _LEVELS)
    held: list[Integers] = [np.arange(used)]
    for parents in numbers:
        held.append(parents[held[-1]].astype(np.int64))
    cell_of = np.empty(local.shape[0], np.int32)
    cell_of[cells.order] = positions
    parts = [_shapes(levels[one], monitor)[held[one]] for one in _SHAPE_LEVELS]
    parts += [_columns(levels[one], monitor)[held[one]] for one in _COLUMN_LEVELS]
    z = np.ascontiguousarray(sums[:, SUM_Z])
    parts += [_in_plan(levels[one], held[one], z) for one in _PLAN_LEVELS]
    parts.append(_means(cell_of, heights, intensity, used))
    return ClassCells(np.hstack(parts), cell_of, tuple(levels), tuple(held))


def _shapes(level: CellLevel, monitor: Monitor) -> NDArray[np.float32]:
    found = np.empty((level.codes.size, SHAPES), np.float32)
    share_out(
        lambda start, stop: shapes_kernel(level, start, stop, found),
        level.codes.size,
        _CELLS_AT_ONCE,
        monitor,
    )
    return found


def _columns(level: CellLevel, monitor: Monitor) -> NDArray[np.float32]:
    found = np.empty((level.codes.size, COLUMN), np.float32)

    def look(start: int, stop: int) -> None:
        column_kernel(level, level.codes[start:stop], found[start:stop])

    share_out(look, level.codes.size, _CELLS_AT_ONCE, monitor)
    return found


def _in_plan(level: CellLevel, held: Integers, z: Floats) -> NDArray[np.float32]:
    """(c, 2) heights over the lowest and below the highest point near by, m."""
    flat, column_of = np.unique(level.codes[held] & ~_HEIGHT_BITS, return_inverse=True)
    low, high = np.full(flat.size, np.inf), np.full(flat.size, -np.inf)
    extremes_kernel(column_of.astype(np.int64), z, low, high)
    plan = level_of(flat, np.zeros((flat.size, SUMS)), level.side)
    both = np.empty((flat.size, 2))
    beside_columns_kernel(plan, low, high, both)
    near = both[column_of]
    return np.stack([z - near[:, 0], near[:, 1] - z], axis=1).astype(np.float32)


def _means(
    cell_of: NDArray[np.int32], heights: Floats, intensity: NDArray[np.float32], used: int
) -> NDArray[np.float32]:
    """(c, 3) mean height above the ground, mean intensity and its standard deviation."""
    values = np.column_stack([heights.astype(np.float32), intensity, intensity * intensity])
    sums = np.zeros((used, values.shape[1] + 1))
    add_rows_kernel(cell_of, np.ascontiguousarray(values), sums)
    means: NDArray[np.float32] = (sums[:, :-1] / sums[:, -1:]).astype(np.float32)
    means[:, 2] = np.sqrt(np.maximum(means[:, 2] - means[:, 1] ** 2, 0))
    return means


def warm_up() -> None:
    """Compile what the features call."""
    from processing.core.monitor import SilentMonitor

    cells = class_cells(np.zeros((2, 3)), np.zeros(2), np.zeros(2, np.float32), SilentMonitor())
    cells.with_neighbours(np.ones((len(cells.rows), 2), np.float32), SilentMonitor())
