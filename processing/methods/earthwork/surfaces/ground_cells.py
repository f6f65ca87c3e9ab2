"""GroundCells: the ground points of an epoch counted into cells, one mean height in each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import OutOfRange
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.earthwork.surfaces.low_growth import CellPlanes, lift_of_growth
from processing.methods.earthwork.surfaces.sides import EpochGround
from processing.methods.ground.filters.cells import MOST_CELLS, CellGrid

Floats = NDArray[np.float64]

_X, _Y, _Z = range(3)
"""Sums of a cell's points: from its middle to the east and north, and above the grid's origin."""

# Of strays, which are all there is in some shadows. The values were set by trial; no measurement
# varied one alone.

_AMONG_M, _FEW_SHARE = 3.0, 0.05
"""A cell is thin that holds less than this share of the fullest within this distance."""

_NEAR_M = 0.6
"""Distance within which thin cells are held against each other."""

_SCATTER_M = 0.08
"""From their plane, on average, above which they are strays at any height."""

_FEWEST = 6
"""Thin cells below which there is no plane."""

_HELD_SHARE = 0.3
"""Of the cells about, empty and thin, of which a true surface holds this share at least."""

ABOUT_M = 1.0
"""To each side of a cell, within which others of its ground lie. On fourteen development sites
(seeds 2401 to 2414) whole cut and fill were off by 1.7 and 4.3 % of what was moved, root mean
square; with 1.4 m and twelve others by 2.3 and 4.9 %; with 0.6 m and three on eleven of them by 2.1
and 4.8 against 1.7 and 4.6 %."""

_MOST_ABOUT = 8
"""Others that a cell needs at most: two crossing lines of points, or one with a point every quarter
metre, as scanners that are set to 6 cm 10 m away lay it 40 m away."""

_LONELY_SHARE = 0.02
"""Of all cells, as many may be dropped for want of others: where points are sparse everywhere, few
others are no sign of a stray. By the same sites mixed pixels and ghosts that pass for ground are
fewer than one cell in a hundred."""

LEVEL_M, STEEP = 0.1, 0.75
"""How far another may lie above or below to be of the same ground: the scatter of rough ground, and
37° between, the angle of repose of spoil, the steepest ground that isn't walled or cut."""

_ACROSS_CELLS2 = 0.1
"""Variance of positions, in cells squared, added along both axes: cells in one line say nothing of
the slope across it, which is then nearly none."""

_ON_CORNER = 1e-9
"""Cells by which rounding may move a rectangle's side off a corner of the mesh."""

_SUMS = 9
_N, _SX, _SY, _SZ, _SXX, _SXY, _SYY, _SXZ, _SYZ = range(_SUMS)
"""What is summed for a plane."""


class _StrayLimits(NamedTuple):
    """``_FEWEST`` and ``_SCATTER_M``, as the kernel takes them."""

    fewest: int
    scatter_m: float


class _Window(NamedTuple):
    """Rows and columns of a window, the ends left out."""

    first_row: int
    end_row: int
    first_column: int
    end_column: int


@dataclass(frozen=True)
class GroundCells:
    """Ground points of one epoch by cell; row = north, column = east.

    Attributes
    ----------
    grid : CellGrid
    counts : (rows, columns) int32
        Points in a cell.
    heights : (rows, columns) float64
        Mean height, m above the grid's origin, carried to the middle of the cell along the
        ground's slope and freed of what low growth lifts it by; NaN without a point.
    """

    grid: CellGrid
    counts: NDArray[np.int32]
    heights: Floats

    @property
    def is_counted(self) -> NDArray[np.bool_]:
        """Cells with a point: (rows, columns) bool."""
        is_counted: NDArray[np.bool_] = self.counts > 0
        return is_counted


def grid_over(
    low: tuple[float, float], high: tuple[float, float], size_m: float, height_m: float
) -> CellGrid:
    """Cells over a rectangle, their corners on whole multiples of the mesh.

    So the same position falls into the same cell, whatever else was measured.

    Parameters
    ----------
    low, high : (float, float)
        Corners, m, project CRS.
    height_m : float
        What heights are counted from.

    Raises
    ------
    OutOfRange
        More cells than memory holds.
    """
    first = np.floor(np.asarray(low) / size_m + _ON_CORNER).astype(np.int64)
    last = np.ceil(np.asarray(high) / size_m - _ON_CORNER).astype(np.int64)
    columns, rows = (int(count) for count in np.maximum(last - first, 1))
    if rows * columns > MOST_CELLS:
        raise OutOfRange(
            Text("The mesh is too fine for so large an area.", "範囲に対して格子が細かすぎます。"),
            Text(
                f"{rows * columns:,} cells of {size_m:g} m; {MOST_CELLS:,} are possible.",
                f"{size_m:g} mの格子が{rows * columns:,}個（上限{MOST_CELLS:,}個）",
            ),
            Text(
                "Choose a larger mesh, or a boundary around the work.",
                "格子間隔を大きくするか、施工範囲の境界を指定してください。",
            ),
        )
    origin = np.array([first[0] * size_m, first[1] * size_m, height_m])
    return CellGrid(origin, size_m, rows, columns)


def ground_cells(
    epoch: EpochGround,
    grid: CellGrid,
    monitor: Monitor,
    shift_m: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> GroundCells:
    """Count the ground points of an epoch into cells.

    Parameters
    ----------
    shift_m : (float, float, float)
        Taken from every point first.
    """
    counts = np.zeros((grid.rows, grid.columns), np.int32)
    sums = np.zeros((grid.rows, grid.columns, 3))
    origin = grid.origin + np.asarray(shift_m)
    for block in epoch.blocks():
        monitor.check()
        _sum_kernel(np.ascontiguousarray(block.xyz), origin, grid.size_m, counts, sums)
    _drop_strays(counts, sums, grid.size_m)
    planes = _planes(counts, sums, grid.size_m)
    shifted = replace(grid, origin=origin)
    heights: Floats = planes.heights - lift_of_growth(epoch, shifted, planes, monitor)
    return GroundCells(grid, counts, heights)


def _drop_strays(counts: NDArray[np.int32], sums: Floats, size_m: float) -> None:
    """Forget cells that hold only strays, in place.

    Where the ground was hidden, a few points that came by way of a mirror or a puddle, or hang
    between a crest and what lies behind it, are all there is.
    """
    for strays in (_thin_strays, _lonely_strays):
        dropped = strays(counts, sums, size_m)
        counts[dropped] = 0
        sums[dropped] = 0.0


def _thin_strays(counts: NDArray[np.int32], sums: Floats, size_m: float) -> NDArray[np.bool_]:
    """Cells with few points among many about them, at any height or at the filled one.

    At the height that was filled in there, a surface fills several cells and strays one of them.
    """
    from scipy.ndimage import maximum_filter, uniform_filter

    strays = np.zeros(counts.shape, np.bool_)
    reach = max(1, round(_AMONG_M / size_m))
    most = maximum_filter(counts, 2 * reach + 1)
    thin = (counts > 0) & (counts < _FEW_SHARE * most)
    if not thin.any():
        return strays
    near = max(1, round(_NEAR_M / size_m))
    heights = _mean_heights(thin, counts, sums)
    _stray_kernel(heights, near, _StrayLimits(_FEWEST, _SCATTER_M), strays)
    empty = uniform_filter((counts == 0).astype(np.float32), 2 * near + 1)
    held = uniform_filter(thin.astype(np.float32), 2 * near + 1)
    strays |= thin & (held < _HELD_SHARE * (held + empty))
    return strays


def _lonely_strays(counts: NDArray[np.int32], sums: Floats, size_m: float) -> NDArray[np.bool_]:
    """Cells that hardly another of their height lies about, where points are sparse anyway.

    A beam that grazes a crest and comes back from the crest and from what lies behind gives one
    point between them, over ground that nobody saw. A filled hole would hang from it.
    """
    known = counts > 0
    others = np.full(counts.shape, _MOST_ABOUT, np.int8)
    reach = max(1, round(ABOUT_M / size_m))
    _others_kernel(_mean_heights(known, counts, sums), reach, size_m, others)
    fewest = np.cumsum(np.bincount(others[known], minlength=_MOST_ABOUT + 1))
    needed = int(np.searchsorted(fewest, _LONELY_SHARE * fewest[-1], side="right"))
    lonely: NDArray[np.bool_] = known & (others < needed)
    return lonely


def _mean_heights(wanted: NDArray[np.bool_], counts: NDArray[np.int32], sums: Floats) -> Floats:
    """Of the points in each wanted cell, m above the grid's origin; NaN in others."""
    heights: Floats = np.where(wanted, sums[..., _Z] / np.maximum(counts, 1), np.nan)
    return heights


def _planes(counts: NDArray[np.int32], sums: Floats, size_m: float) -> CellPlanes:
    """Heights at the middles of cells and slopes to the east and north.

    Where points lie to one side of a cell, their mean says the height of that side.
    """
    with np.errstate(invalid="ignore"):
        means = sums / counts[..., None]
    heights = means[..., _Z]
    slope_x, slope_y = (_slope(heights, size_m, axis) for axis in (1, 0))
    carried: Floats = heights - slope_x * means[..., _X] - slope_y * means[..., _Y]
    return CellPlanes(carried, slope_x, slope_y)


def _slope(heights: Floats, size_m: float, axis: int) -> Floats:
    """Rise per metre along an axis from the neighbours that there are; 0 where there is none."""
    z = np.moveaxis(heights, axis, 0)
    step = np.full((z.shape[0] + 1, *z.shape[1:]), np.nan)
    step[1:-1] = (z[1:] - z[:-1]) / size_m
    back, ahead = step[:-1], step[1:]
    both = np.where(np.isnan(back), ahead, np.where(np.isnan(ahead), back, (back + ahead) / 2))
    return np.moveaxis(np.nan_to_num(both), 0, axis)


@kernel
def _sum_kernel(
    xyz: Floats, origin: Floats, size_m: float, counts: NDArray[np.int32], sums: Floats
) -> None:
    rows, columns = counts.shape
    for point in range(xyz.shape[0]):
        x, y = xyz[point, 0] - origin[0], xyz[point, 1] - origin[1]
        # NaN fails each of these tests.
        if not (x >= 0.0 and y >= 0.0 and x < columns * size_m and y < rows * size_m):
            continue
        column, row = min(int(x / size_m), columns - 1), min(int(y / size_m), rows - 1)
        counts[row, column] += 1
        sums[row, column, _X] += x - (column + 0.5) * size_m
        sums[row, column, _Y] += y - (row + 0.5) * size_m
        sums[row, column, _Z] += xyz[point, 2] - origin[2]


@kernel
def _stray_kernel(
    heights: Floats, near: int, limits: _StrayLimits, strays: NDArray[np.bool_]
) -> None:
    """Cells (NaN: passed over) with few others about them, or on no plane with those."""
    rows, columns = heights.shape
    for row in range(rows):
        for column in range(columns):
            if not np.isnan(heights[row, column]):
                window = _Window(
                    max(0, row - near),
                    min(rows, row + near + 1),
                    max(0, column - near),
                    min(columns, column + near + 1),
                )
                count, apart = _apart_kernel(heights, window, heights[row, column])
                strays[row, column] = count < limits.fewest or apart > limits.scatter_m


@kernel
def _others_kernel(heights: Floats, reach: int, size_m: float, others: NDArray[np.int8]) -> None:
    """How many cells about each (NaN: passed over) are of its ground, up to ``_MOST_ABOUT``."""
    rows, columns = heights.shape
    for row in range(rows):
        for column in range(columns):
            if np.isnan(heights[row, column]):
                continue
            count = -1  # itself
            for at in range(max(0, row - reach), min(rows, row + reach + 1)):
                for beside in range(max(0, column - reach), min(columns, column + reach + 1)):
                    # NaN fails both tests; the second is asked where ground isn't level.
                    apart_m = abs(heights[at, beside] - heights[row, column])
                    if apart_m <= LEVEL_M or apart_m <= LEVEL_M + STEEP * size_m * np.hypot(
                        at - row, beside - column
                    ):
                        count += 1
                        if count == _MOST_ABOUT:
                            break
                if count == _MOST_ABOUT:
                    break
            others[row, column] = max(count, 0)


@kernel
def _apart_kernel(heights: Floats, window: _Window, base: float) -> tuple[int, float]:
    """How many cells of a window are known, and how far they lie from their plane on average."""
    sums = np.zeros(_SUMS)
    for row in range(window.first_row, window.end_row):
        for column in range(window.first_column, window.end_column):
            z = heights[row, column] - base
            if not np.isnan(z):
                x, y = float(column - window.first_column), float(row - window.first_row)
                sums[_N] += 1.0
                sums[_SX] += x
                sums[_SY] += y
                sums[_SZ] += z
                sums[_SXX] += x * x
                sums[_SXY] += x * y
                sums[_SYY] += y * y
                sums[_SXZ] += x * z
                sums[_SYZ] += y * z
    count = sums[_N]
    x, y, z = sums[_SX] / count, sums[_SY] / count, sums[_SZ] / count
    xx, xy = sums[_SXX] / count - x * x, sums[_SXY] / count - x * y
    yy = sums[_SYY] / count - y * y
    xz, yz = sums[_SXZ] / count - x * z, sums[_SYZ] / count - y * z
    xx, yy = xx + _ACROSS_CELLS2, yy + _ACROSS_CELLS2
    spread = xx * yy - xy * xy
    slope_x, slope_y = (yy * xz - xy * yz) / spread, (xx * yz - xy * xz) / spread
    apart = 0.0
    for row in range(window.first_row, window.end_row):
        for column in range(window.first_column, window.end_column):
            away_x, away_y = column - window.first_column - x, row - window.first_row - y
            miss = heights[row, column] - base - z
            miss -= slope_x * away_x + slope_y * away_y
            if not np.isnan(miss):
                apart += abs(miss)
    return int(count), apart / count


def warm_up() -> None:
    """Compile the kernels of this file."""
    counts, sums = np.zeros((1, 1), np.int32), np.zeros((1, 1, 3))
    _sum_kernel(np.zeros((1, 3)), np.zeros(3), 1.0, counts, sums)
    _stray_kernel(np.zeros((2, 2)), 1, _StrayLimits(1, 1.0), np.zeros((2, 2), np.bool_))
    _others_kernel(np.zeros((2, 2)), 1, 1.0, np.zeros((2, 2), np.int8))
