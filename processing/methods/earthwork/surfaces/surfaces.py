"""SideHeights: one side of a comparison as heights on cells, measured, filled in, or designed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.surfaces.filling import relax_heights
from processing.methods.earthwork.surfaces.ground_cells import GroundCells
from processing.methods.earthwork.surfaces.hidden_ground import SeenBeside, fill_ground
from processing.methods.earthwork.surfaces.sides import EpochGround, Level
from processing.methods.earthwork.surfaces.sight_lines import Floor, SightLines
from processing.methods.ground.filters.cells import CellGrid

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

HOLE_M = 0.5
"""Side of the cells on which holes are filled: what hides ground is larger."""

_BELOW_M = 0.1
"""Points this far below the ground came by way of a mirror: no beam went there. By trial."""

_BRIDGED_M = 0.2
"""Half width of gaps between cells with points that count as measured: by trial, two or three cells
of the usual mesh, over which graded ground keeps its height."""

_FEW_IN_CELL = 3.0
"""Points a cell, in the fullest block of ``HOLE_M`` about, below which an empty cell says nothing:
of points scattered at random with that mean, one cell in twenty is empty."""

_NO_WEIGHT = 1e-12
"""Keeps the mean of no heights finite; it is not used."""


def cells_of_hole(size_m: float) -> int:
    """How many cells of a side holes are filled in at a time."""
    return max(1, round(HOLE_M / size_m))


@dataclass(frozen=True)
class SideHeights:
    """Heights of a side on cells; row = north, column = east.

    Attributes
    ----------
    heights : (rows, columns) float64
        m above the grid's origin; NaN where the side has none.
    is_measured : (rows, columns) bool
        Points lie in the cell or close by; a design is known wherever it is.
    spread : (rows, columns) float64
        Standard deviation of a height that was filled in, m; 0 where measured.
    """

    heights: Floats
    is_measured: Mask
    spread: Floats


@dataclass(frozen=True)
class EpochContext:
    """What is known of an epoch beside its own points.

    Attributes
    ----------
    shift_m : (float, float, float)
        What was taken from its points when they were counted.
    others : tuple of (rows, columns) float64
        Mean heights of the ground points of other dates in the same cells, m; NaN without a point.
    """

    shift_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    others: tuple[Floats, ...] = ()


ALONE = EpochContext()
"""An epoch that lies as it was measured, and no other."""


def designed_surface(side: TriangleSurface | Level, grid: CellGrid) -> SideHeights:
    """A design or a level at the middles of cells."""
    if isinstance(side, Level):
        heights = np.full((grid.rows, grid.columns), side.height_m - grid.origin[2])
    else:
        x = grid.origin[0] + (np.arange(grid.columns) + 0.5) * grid.size_m
        y = grid.origin[1] + (np.arange(grid.rows) + 0.5) * grid.size_m
        middles = np.column_stack([np.tile(x, grid.rows), np.repeat(y, grid.columns)])
        heights = side.heights_at(middles).reshape(grid.rows, grid.columns) - grid.origin[2]
    return SideHeights(heights, np.isfinite(heights), np.zeros_like(heights))


def measured_surface(
    epoch: EpochGround,
    cells: GroundCells,
    is_wanted: Mask,
    monitor: Monitor,
    context: EpochContext = ALONE,
) -> SideHeights:
    """The ground of an epoch, holes filled in from what is around them.

    Gaps between points are bridged; larger holes are filled on cells of half a metre, where a
    crest or a machine is larger than a cell. Beyond the last points there is no ground.

    Parameters
    ----------
    is_wanted : (rows, columns) bool
        Where ground is asked for.
    context : EpochContext
    """
    grid = cells.grid
    times = cells_of_hole(grid.size_m)
    coarse, wanted = coarse_means(cells.heights, times), coarse_any(is_wanted, times)
    origin = grid.origin + np.asarray(context.shift_m)
    lines = _sight_lines(epoch, origin, (coarse, times * grid.size_m), monitor)
    others = np.full(coarse.shape, np.nan)
    for counted in context.others:
        others = np.where(np.isfinite(others), others, coarse_means(counted, times))
    seen = SeenBeside(lines, others)
    filled = fill_ground(coarse, wanted, seen, times * grid.size_m, monitor)
    shape = cells.heights.shape
    heights = np.where(cells.is_counted, cells.heights, fine_heights(filled.heights, times, shape))
    # Larger holes keep what was found for them: a crest would be smoothed away again.
    relax_heights(heights, cells.is_counted | np.isnan(repeated_cells(coarse, times, shape)))
    is_measured = _bridged(cells) | _thinly_measured(cells, times)
    spread = np.where(is_measured, 0.0, repeated_cells(filled.spread, times, shape))
    is_filled = is_wanted & np.isfinite(repeated_cells(filled.heights, times, shape))
    heights[~is_filled & ~cells.is_counted] = np.nan
    return SideHeights(heights, is_measured & np.isfinite(heights), spread)


def _bridged(cells: GroundCells) -> Mask:
    """Cells with points, and those between them: a gap of two or three cells is none."""
    from scipy.ndimage import binary_closing

    reach = round(_BRIDGED_M / cells.grid.size_m)
    if reach == 0:
        return cells.is_counted
    square = np.ones((3, 3), np.bool_)
    padded = np.pad(cells.is_counted, reach)
    closed: Mask = binary_closing(padded, square, iterations=reach)[reach:-reach, reach:-reach]
    return closed


def _thinly_measured(cells: GroundCells, times: int) -> Mask:
    """Cells without a point where points are few anyway: there the next one is a gap away.

    Where points are many about it, an empty cell was hidden from the scanner.
    """
    from scipy.ndimage import maximum_filter

    counts = np.nansum(_blocks(cells.counts.astype(np.float64), times), axis=(1, 3))
    densest = maximum_filter(counts, 3) / times**2
    is_thin = (counts > 0) & (densest < _FEW_IN_CELL)
    return repeated_cells(is_thin.astype(np.float64), times, cells.counts.shape) > 0


def _sight_lines(
    epoch: EpochGround, origin: Floats, ground: tuple[Floats, float], monitor: Monitor
) -> SightLines:
    """Beams of all that was measured but what lies below the ground: no beam went there."""
    lines = SightLines.without_beams(epoch.stands - origin)
    if not len(epoch.stands) or epoch.measured is None:
        return lines
    heights, size_m = ground
    floor = Floor(np.nan_to_num(heights, nan=-np.inf) - _BELOW_M, size_m)
    for block in epoch.measured():
        monitor.check()
        if block.station in epoch.stations:
            lines.add(epoch.stations.index(block.station), block.xyz, origin, floor)
    return lines.finished()


def _blocks(values: Floats, times: int) -> Floats:
    """Blocks of cells: (rows, times, columns, times), NaN beyond the edge."""
    rows, columns = (-size % times for size in values.shape)
    whole = np.pad(values, ((0, rows), (0, columns)), constant_values=np.nan)
    return whole.reshape(whole.shape[0] // times, times, whole.shape[1] // times, times)


def coarse_means(heights: Floats, times: int) -> Floats:
    """Means of blocks of ``times`` cells a side; NaN where all are."""
    blocks = _blocks(heights, times)
    known = np.isfinite(blocks)
    counts = known.sum(axis=(1, 3))
    sums = np.where(known, blocks, 0.0).sum(axis=(1, 3))
    means: Floats = np.where(counts > 0, sums / np.maximum(counts, 1), np.nan)
    return means


def coarse_any(mask: Mask, times: int) -> Mask:
    """Whether any cell of a block of ``times`` cells a side is true."""
    found: Mask = np.any(_blocks(mask.astype(np.float64), times) == 1.0, axis=(1, 3))
    return found


def repeated_cells(values: Floats, times: int, shape: tuple[int, int]) -> Floats:
    """Values of coarse cells, each in all of its fine ones."""
    return values.repeat(times, axis=0).repeat(times, axis=1)[: shape[0], : shape[1]]


def fine_heights(coarse: Floats, times: int, shape: tuple[int, int]) -> Floats:
    """Heights of coarse cells at the middles of fine ones, linear between their middles."""
    if times == 1:
        return coarse.copy()
    rows, columns = (
        np.clip((np.arange(count) + 0.5) / times - 0.5, 0, size - 1)
        for count, size in zip(shape, coarse.shape, strict=True)
    )
    low_row, low_column = (np.floor(at).astype(np.int64) for at in (rows, columns))
    high_row = np.minimum(low_row + 1, coarse.shape[0] - 1)
    high_column = np.minimum(low_column + 1, coarse.shape[1] - 1)
    up, right = (rows - low_row)[:, None], (columns - low_column)[None, :]
    corners = (
        (low_row, low_column, (1 - up) * (1 - right)),
        (low_row, high_column, (1 - up) * right),
        (high_row, low_column, up * (1 - right)),
        (high_row, high_column, up * right),
    )
    sums, weights = np.zeros(shape), np.zeros(shape)
    for row, column, weight in corners:
        values = coarse[np.ix_(row, column)]
        known = np.isfinite(values)
        sums += np.where(known, values, 0.0) * weight
        weights += known * weight
    fine: Floats = np.where(weights > 0, sums / np.maximum(weights, _NO_WEIGHT), np.nan)
    return fine
