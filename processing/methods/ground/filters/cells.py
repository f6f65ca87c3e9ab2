"""Cells: a horizontal grid that blocks of points are counted into, in any order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.ground.filters.cell_positions import Blocks, require_three_positions

MOST_CELLS = 48_000_000
_MOST_COARSE = 256
_MOST_PARTS = 4096
_COARSE_M = 5.0
_POINTS_OF_COARSE = 50
_SMALLEST_CELL_M = 0.20
_LARGEST_CELL_M = 10.0
_THIN_SHARE = 0.40
_SHRINKS = 4
_SHRINK = 0.5
_PARTS = 1024
_FEW_POINTS = 1000
_FAR_SHARE = 1e-3
_EMPTY_BINS = 64


@dataclass(frozen=True)
class CellGrid:
    """Square cells over the horizontal extent of a cloud.

    Attributes
    ----------
    origin : (3,) float64
        Lower left corner of the first cell and the height that others are counted from, m.
    size_m : float
        Side of a cell.
    rows, columns : int
        Rows count north, columns east.
    """

    origin: NDArray[np.float64]
    size_m: float
    rows: int
    columns: int


@dataclass(frozen=True)
class LevelsAboveFloor:
    """What the cells hold above a floor.

    Attributes
    ----------
    lowest : (rows, columns) float32
        Lowest height above the grid's origin, m; NaN without a point.
    second : (rows, columns) float32
        Lowest height that lies clearly above the lowest; +inf where there is none.
    near, above : (rows, columns) uint16
        Points close above the lowest, and clearly above it but within reach of a person.
    """

    lowest: NDArray[np.float32]
    second: NDArray[np.float32]
    near: NDArray[np.uint16]
    above: NDArray[np.uint16]


def choose_cells(
    blocks: Blocks, grid_m: float = 0.0, most_cells: int | None = MOST_CELLS
) -> CellGrid:
    """A grid whose cells hold about one point where the cloud is thin.

    Parameters
    ----------
    blocks : callable
        Gives the cloud's blocks, each (n, 3) float64, m, afresh at every call; rows that are not
        finite are passed over.
    grid_m : float
        Side of a cell; 0 lets the data choose it.
    most_cells : int or None
        Cells are larger where the extent would need more; None for who cuts the plan into tiles.

    Raises
    ------
    OutOfRange
        Points at fewer than three places.
    """
    require_three_positions(blocks)
    low, high, count = _extent(blocks)
    low, high = _without_far_points(blocks, low, high, count)
    extent = high[:2] - low[:2]
    # Whole centimetres, so that what was chosen can be said and set.
    size_m = grid_m if grid_m > 0.0 else round(_spacing(blocks, low, extent, count), 2)
    if most_cells is not None:
        largest = max(float(np.sqrt(extent.prod() / most_cells)), float(extent.max() / most_cells))
        size_m = max(size_m, largest)
    columns, rows = (np.floor(extent / size_m).astype(np.int64) + 1).tolist()
    return CellGrid(low, size_m, rows, columns)


def _spacing(
    blocks: Blocks, low: NDArray[np.float64], extent: NDArray[np.float64], count: int
) -> float:
    # On a long street a share of its extent says little: parts are some metres wide there.
    most = int(np.clip(extent.max() / _COARSE_M, _MOST_COARSE, _MOST_PARTS))
    parts = int(np.clip(np.sqrt(count / _POINTS_OF_COARSE), 1, most))
    # A little more, so that the farthest point doesn't count as a thin part of its own.
    coarse_m = max(float(extent.max()) / parts * (1.0 + 1e-9), 1e-3)
    counts = np.zeros((parts + 1, parts + 1), np.int64)
    for xyz in blocks():
        _count_kernel(np.ascontiguousarray(xyz), low, coarse_m, counts)
    held = np.sort(counts[counts > 0])
    typical = max(float(held[int(_THIN_SHARE * (len(held) - 1))]), 1.0)
    return float(np.clip(coarse_m / np.sqrt(typical), _SMALLEST_CELL_M, _LARGEST_CELL_M))


def levels_above(
    blocks: Blocks, grid: CellGrid, floor: NDArray[np.float32], gap_m: float
) -> LevelsAboveFloor:
    """Lowest height of each cell above its ``floor``, and the lowest ``gap_m`` above that."""
    shape = (grid.rows, grid.columns)
    lowest = np.full(shape, np.inf, np.float32)
    for xyz in blocks():
        _lowest_kernel(np.ascontiguousarray(xyz), grid.origin, grid.size_m, floor, lowest)
    second = np.full(shape, np.inf, np.float32)
    near = np.zeros(shape, np.uint16)
    above = np.zeros(shape, np.uint16)
    for xyz in blocks():
        _second_kernel(
            np.ascontiguousarray(xyz), grid.origin, grid.size_m, gap_m, lowest, second, near, above
        )
    lowest[np.isinf(lowest)] = np.nan
    return LevelsAboveFloor(lowest, second, near, above)


def _extent(blocks: Blocks) -> tuple[NDArray[np.float64], NDArray[np.float64], int]:
    low = np.full(3, np.inf)
    high = np.full(3, -np.inf)
    count = 0
    for xyz in blocks():
        count += _extent_kernel(np.ascontiguousarray(xyz), low, high)
    return low, high, count


def _without_far_points(
    blocks: Blocks, low: NDArray[np.float64], high: NDArray[np.float64], count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Shrink the extent until few points no longer stretch it: a spike of 10 km is no terrain."""
    for _ in range(_SHRINKS):
        step = (high - low) / _PARTS
        if count < _FEW_POINTS or not np.all(step[:2] > 0.0):
            break
        counts = np.zeros((3, _PARTS + 1), np.int64)
        for xyz in blocks():
            _profile_kernel(np.ascontiguousarray(xyz), low, np.where(step > 0, step, 1.0), counts)
        bounds = [_held_bins(counts[axis]) for axis in range(3)]
        first, last = np.array(bounds).T
        kept = (last[:2] + 1 - first[:2]) / _PARTS
        low, high = low + first * step, np.minimum(high, low + (last + 1) * step)
        if np.all(kept > _SHRINK):
            break
    return low, high


def _held_bins(counts: NDArray[np.int64]) -> tuple[int, int]:
    total = np.cumsum(counts)
    least = _FAR_SHARE * total[-1]
    first = int(np.searchsorted(total, least, side="right"))
    last = int(np.searchsorted(total, total[-1] - least))
    occupied = np.flatnonzero(counts)
    # Only an empty stretch makes the points beyond it far ones.
    while first > 0 and counts[first - 1] > 0:
        first -= 1
    while last < len(counts) - 1 and counts[last + 1] > 0:
        last += 1
    if first - occupied[0] < _EMPTY_BINS:
        first = int(occupied[0])
    if occupied[-1] - last < _EMPTY_BINS:
        last = int(occupied[-1])
    return first, last


@kernel
def _extent_kernel(
    xyz: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]
) -> int:
    count = 0
    for point in range(xyz.shape[0]):
        x, y, z = xyz[point, 0], xyz[point, 1], xyz[point, 2]
        if not np.isfinite(x + y + z):
            continue
        count += 1
        low[0], high[0] = min(low[0], x), max(high[0], x)
        low[1], high[1] = min(low[1], y), max(high[1], y)
        low[2], high[2] = min(low[2], z), max(high[2], z)
    return count


@kernel
def _profile_kernel(
    xyz: NDArray[np.float64],
    low: NDArray[np.float64],
    step: NDArray[np.float64],
    counts: NDArray[np.int64],
) -> None:
    for point in range(xyz.shape[0]):
        if not np.isfinite(xyz[point, 0] + xyz[point, 1] + xyz[point, 2]):
            continue
        for axis in range(3):
            position = (xyz[point, axis] - low[axis]) / step[axis]
            if 0.0 <= position <= counts.shape[1] - 1:
                counts[axis, int(position)] += 1


@kernel
def _count_kernel(
    xyz: NDArray[np.float64],
    low: NDArray[np.float64],
    size_m: float,
    counts: NDArray[np.int64],
) -> None:
    for point in range(xyz.shape[0]):
        x = (xyz[point, 0] - low[0]) / size_m
        y = (xyz[point, 1] - low[1]) / size_m
        inside = 0.0 <= x < counts.shape[1] and 0.0 <= y < counts.shape[0]
        if inside and np.isfinite(xyz[point, 2]):
            counts[int(y), int(x)] += 1


@kernel
def _lowest_kernel(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    size_m: float,
    floor: NDArray[np.float32],
    lowest: NDArray[np.float32],
) -> None:
    for point in range(xyz.shape[0]):
        x = (xyz[point, 0] - origin[0]) / size_m
        y = (xyz[point, 1] - origin[1]) / size_m
        z = xyz[point, 2] - origin[2]
        if np.isfinite(z) and 0.0 <= x < lowest.shape[1] and 0.0 <= y < lowest.shape[0]:
            row, column = int(y), int(x)
            # Lower than the grid begins are only spikes, which stretched no extent.
            if z >= max(floor[row, column], np.float32(0.0)):
                lowest[row, column] = min(lowest[row, column], np.float32(z))


@kernel
def _second_kernel(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    size_m: float,
    gap_m: float,
    lowest: NDArray[np.float32],
    second: NDArray[np.float32],
    near: NDArray[np.uint16],
    above: NDArray[np.uint16],
) -> None:
    for point in range(xyz.shape[0]):
        x = (xyz[point, 0] - origin[0]) / size_m
        y = (xyz[point, 1] - origin[1]) / size_m
        z = xyz[point, 2] - origin[2]
        if np.isfinite(z) and 0.0 <= x < lowest.shape[1] and 0.0 <= y < lowest.shape[0]:
            row, column = int(y), int(x)
            off = z - lowest[row, column]
            if off > gap_m:
                second[row, column] = min(second[row, column], np.float32(z))
                if off < 3.0 and above[row, column] < 60000:
                    above[row, column] += 1
            elif off >= -1e-3 and near[row, column] < 60000:
                near[row, column] += 1


def warm_up() -> None:
    """Compile the kernels of this file."""
    xyz = np.array([[0.0, 0.0, 0.0], [0.5, 0.5, 1.0], [0.5, 0.0, 1.0]])
    grid = choose_cells(lambda: [xyz])
    levels_above(lambda: [xyz], grid, np.full((grid.rows, grid.columns), -np.inf, np.float32), 0.1)
