"""Cells of a map joined to areas of one class: what a drawing fills with one colour."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.heat_map import ColourClass, class_numbers
from processing.methods.ground.filters.cells import CellGrid

MOST_CELLS = 160_000
"""More are joined to larger cells first: on paper nobody tells them apart."""

_NOTHING = 255
"""Number of no class."""


@dataclass(frozen=True)
class ClassAreas:
    """What is to be filled.

    Attributes
    ----------
    of_class : dict of int to list of shapely.Polygon
        By the number of the class, from 0; only classes that occur. Easting and northing, m.
    unmeasured : list of shapely.Polygon
        Where there is a change, but a ground was not measured on a date.
    cell_m : float
        Side of the cells that were joined.
    """

    of_class: dict[int, list[shapely.Polygon]]
    unmeasured: list[shapely.Polygon]
    cell_m: float


def class_areas(
    change: ChangeGrid, classes: tuple[ColourClass, ...], *, most_cells: int = MOST_CELLS
) -> ClassAreas:
    """Areas of each class of change, with their holes.

    Parameters
    ----------
    most_cells : int
        A map of more is thinned: the mean of a block of cells, where most of them have a change.
    """
    factor = max(1, int(np.ceil(np.sqrt(change.change_m.size / most_cells))))
    values = _block_means(change.change_m, factor)
    is_measured = np.where(np.isnan(change.change_m), np.nan, change.is_measured)
    measured = _block_means(is_measured.astype(np.float32), factor)
    grid = CellGrid(change.grid.origin, change.grid.size_m * factor, *values.shape)
    of_class = _areas(class_numbers(values, classes), grid)
    unmeasured = np.where(np.isfinite(values) & (measured < 0.5), np.uint8(0), np.uint8(_NOTHING))
    return ClassAreas(of_class, _areas(unmeasured, grid).get(0, []), grid.size_m)


def _block_means(values: NDArray[np.float32], factor: int) -> NDArray[np.float32]:
    """Means of blocks of cells; NaN where no more than half of one has a number."""
    if factor == 1:
        return values
    rows, columns = (-(-length // factor) for length in values.shape)
    padded = np.full((rows * factor, columns * factor), np.nan, np.float32)
    padded[: values.shape[0], : values.shape[1]] = values
    blocks = padded.reshape(rows, factor, columns, factor)
    is_known = np.isfinite(blocks)
    counts = is_known.sum(axis=(1, 3))
    sums = np.where(is_known, blocks, np.float32(0.0)).sum(axis=(1, 3), dtype=np.float64)
    means = sums / np.maximum(counts, 1)
    return np.where(2 * counts > factor * factor, means, np.nan).astype(np.float32)


def _areas(numbers: NDArray[np.uint8], grid: CellGrid) -> dict[int, list[shapely.Polygon]]:
    """Areas of each number but 255, by number.

    Runs of cells in a row, then equal runs in rows that follow each other, become rectangles;
    those of a number are united.
    """
    number, rows, starts, ends = _runs(numbers)
    order = np.lexsort((rows, ends, starts, number))
    number, rows, starts, ends = (one[order] for one in (number, rows, starts, ends))
    same = np.stack([np.diff(number) == 0, np.diff(starts) == 0, np.diff(ends) == 0])
    begins = np.append(True, ~(same.all(axis=0) & (np.diff(rows) == 1)))[: len(rows)]
    first = np.flatnonzero(begins)
    last = np.append(first, len(rows))[1:] - 1
    boxes = shapely.box(starts[first], rows[first], ends[first], rows[last] + 1)
    found = {}
    for one in np.unique(number[first]).tolist():
        # In whole cells, so that corners along a straight side are found exactly.
        joined = shapely.simplify(shapely.union_all(boxes[number[first] == one]), 0.0)
        placed = shapely.transform(joined, lambda xy: grid.origin[:2] + xy * grid.size_m)
        found[one] = shapely.get_parts(shapely.orient_polygons(placed)).tolist()
    return found


def _runs(numbers: NDArray[np.uint8]) -> tuple[NDArray[np.int64], ...]:
    """Number, row, first column and column after the last of each run of equal cells."""
    rows, columns = numbers.shape
    flat = numbers.astype(np.int64).ravel()
    is_start = np.append(True, np.diff(flat) != 0)[: flat.size]
    is_start[::columns] = True
    starts = np.flatnonzero(is_start)
    ends = np.append(starts[1:], rows * columns)
    is_kept = flat[starts] != _NOTHING
    starts, ends = starts[is_kept], ends[is_kept]
    row = starts // columns
    return flat[starts], row, starts - row * columns, ends - row * columns
