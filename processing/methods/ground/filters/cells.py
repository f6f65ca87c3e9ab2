"""Cells: a horizontal grid that blocks of points are counted into, in any order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.ground.filters.cell_positions import Blocks, require_three_positions

MOST_CELLS = 48_000_000
"""Of a grid that is not cut into tiles: at some 80 bytes a cell 4 GB of memory."""

_MOST_COARSE, _MOST_PARTS = 256, 4096
"""Coarse parts along one side, at most: of a small extent, and of a long one, where a share of
the extent says little about a street. Counts of 4,096 by 4,096 parts take 128 MiB."""

_COARSE_M = 5.0
"""Width of a coarse part on a long extent: about a lane, narrower than a road."""

_POINTS_OF_COARSE = 50
"""Points that a coarse part would hold if the cloud were even; by trial, enough to count by."""

_SMALLEST_CELL_M, _LARGEST_CELL_M = 0.20, 10.0
"""What the data may choose, by trial."""

_THIN_SHARE = 0.10
"""Of the points, from the thinnest parts on: the part that shall have one point in a cell. Nine
points of ten lie where cells hold more, however fast the density falls with the range. Of the area
it is no measure: around one spinning scanner 40 % of it had a tenth of the points and cells of
1.1 m, in which walls, vehicles and road lay together."""

_SPACING_DECIMALS = 2
"""A chosen cell has whole centimetres, so that it can be said and set."""

_A_LITTLE_MORE = 1.0 + 1e-9
"""Makes the parts so much wider that the farthest point is no thin part of its own."""

_LEAST_COARSE_M = 1e-3
"""Keeps parts of a cloud without extent from being empty."""

_SHRINKS = 4
"""Most looks for far points, each a pass over the cloud; ``_SHRINK_SHARE`` ends them earlier."""

_SHRINK_SHARE = 0.5
"""A look that leaves more than this of each side ends them: the next would see as finely."""

_PARTS = 1024
"""Bins along each axis in such a look."""

_FEW_POINTS = 1000
"""Fewer points have no far ones: a thousandth of them is less than one."""

_FAR_SHARE = 1e-3
"""Share of the points at either end that may be far ones; by trial."""

_EMPTY_BINS = 64
"""Far points lie beyond so many bins, a sixteenth of the extent; by trial. Nearer ones stay."""

_CORE_SHARE, _CORE_WIDTHS = 0.02, 20.0
"""All but so many points at either end make the core; so many of its widths away a bin counts only
where a share of the points is in it that a place of its own would have. A tripod's points, whose
density falls with the square of the range, reach some ten widths."""

_PERSON_M = 3.0
"""Height above the lowest point within which points above it are counted: as high as a person with
a tool reaches, and no crown or roof. By trial; ``layers`` takes the same."""

_ROUNDING_M = 1e-3
"""The lowest height is kept in single precision, which rounds by less than this up to 16 km."""

_MOST_COUNTED = 60_000
"""Counts stop here, below what 16 bits hold: shares are known well enough."""


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
        Points at fewer than three positions.
    """
    require_three_positions(blocks)
    low, high, count = _extent(blocks)
    low, high = _without_far_points(blocks, low, high, count)
    extent = high[:2] - low[:2]
    size_m = grid_m
    if size_m <= 0.0:
        size_m = round(_spacing(blocks, low, extent, count), _SPACING_DECIMALS)
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
    coarse_m = max(float(extent.max()) / parts * _A_LITTLE_MORE, _LEAST_COARSE_M)
    counts = np.zeros((parts + 1, parts + 1), np.int64)
    for xyz in blocks():
        _count_kernel(np.ascontiguousarray(xyz), low, coarse_m, counts)
    held = np.sort(counts[counts > 0])
    up_to = np.cumsum(held)
    typical = max(float(held[np.searchsorted(up_to, _THIN_SHARE * up_to[-1])]), 1.0)
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
        _forget_strewn(counts, step)
        bounds = [_held_bins(counts[axis]) for axis in range(3)]
        first, last = np.array(bounds).T
        kept = (last[:2] + 1 - first[:2]) / _PARTS
        low, high = low + first * step, np.minimum(high, low + (last + 1) * step)
        if np.all(kept > _SHRINK_SHARE):
            break
    return low, high


def _forget_strewn(counts: NDArray[np.int64], step: NDArray[np.float64]) -> None:
    """Take out of the profiles what is strewn far around the cloud, thinly along its whole way."""
    total = counts.sum(axis=1, keepdims=True)
    share = np.cumsum(counts, axis=1) / np.maximum(total, 1)
    first = np.argmax(share > _CORE_SHARE, axis=1)
    last = np.argmax(share >= 1.0 - _CORE_SHARE, axis=1)
    reach = _CORE_WIDTHS * float(np.max((last + 1 - first) * step))
    bins = np.arange(counts.shape[1])
    for axis in range(3):
        width = reach / step[axis] if step[axis] > 0.0 else np.inf
        is_far = (bins < first[axis] - width) | (bins > last[axis] + width)
        counts[axis, is_far & (counts[axis] < _FAR_SHARE * total[axis])] = 0


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
        x = (xyz[point, 0] - low[0]) / step[0]
        y = (xyz[point, 1] - low[1]) / step[1]
        z = (xyz[point, 2] - low[2]) / step[2]
        most = counts.shape[1] - 1
        # A point that is far out along one axis says nothing along the others.
        if 0.0 <= x <= most and 0.0 <= y <= most and 0.0 <= z <= most:
            counts[0, int(x)] += 1
            counts[1, int(y)] += 1
            counts[2, int(z)] += 1


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
                if off < _PERSON_M and above[row, column] < _MOST_COUNTED:
                    above[row, column] += 1
            elif off >= -_ROUNDING_M and near[row, column] < _MOST_COUNTED:
                near[row, column] += 1


def warm_up() -> None:
    """Compile the kernels of this file."""
    xyz = np.array([[0.0, 0.0, 0.0], [0.5, 0.5, 1.0], [0.5, 0.0, 1.0]])
    grid = choose_cells(lambda: [xyz])
    levels_above(lambda: [xyz], grid, np.full((grid.rows, grid.columns), -np.inf, np.float32), 0.1)
