"""How high points lie above the ground around them, for a cloud that still holds noise.

Sizes and limits here shape what the trees are told (see :mod:`processing.methods.noise.combined`):
they learned with these values, so that a change asks for new training. They were set by trial, on
simulated scenes; no measurement varied one alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.monitor import SilentMonitor
from processing.methods.noise.neighbours.key_order import order_by_key

GROUND_FEATURES = 4
"""Slope, roughness, height over the mean, share near the ground."""

_LOW_SHARE = 0.1
"""Of a cell's sure points that lie below its ground: few enough to be noise, enough to be met."""

_FEWEST = 3
"""Points of a cell, and sure points of a cloud, that tell a height."""

_SAMPLE, _SAMPLE_OF_EXTENT = 400_000, 40_000
"""Points from which heights and the extent are taken; more change neither, only the time."""

_PASSES = 3
"""Of medians over 25 cells, each of which fills holes two cells farther."""

_STEP_M, _STEPS = 0.001, 1 << 22
"""Heights are put in order in whole millimetres, as far as 22 binary digits go: 4 km."""

_ASIDE = 2
"""Cells to either side whose median a cell takes."""

_ROWS_AT_ONCE = 128
"""Rows of cells whose 25 neighbours are held in memory: 100 MB for the widest cloud."""

_MOST_CELLS = 4_000
"""Along one side; wider clouds get wider cells."""

_ENDS_PERCENT, _BEYOND_CELLS = 0.5, 30
"""The extent of a cloud: all but this share at either end, and so many cells more."""

_LEAST_SIDE_M = 1e-9
"""Keeps the cells of a cloud without extent from having no side."""

_NEAR_M = 0.5
"""Height about the ground within which points show how rough it is."""

_SMOOTHEST_M = 0.005
"""Added to every roughness: a scanner's noise, below which nothing is smooth."""

_MOST_RATIO = 50.0
"""Of a height over the mean, in roughnesses; farther ones all say the same."""


@dataclass(frozen=True)
class GroundGrid:
    """The ground below a cloud, in square cells.

    Attributes
    ----------
    heights : (n,) float64
        m, of every point above it; NaN where none is near.
    cells : (n,) int32
        Which cell each point lies over.
    slopes : (h, w) float64
        Rise per metre.
    """

    heights: NDArray[np.float64]
    cells: NDArray[np.int32]
    slopes: NDArray[np.float64]

    def features(self, points: NDArray[np.int64]) -> NDArray[np.float32]:
        """(k, GROUND_FEATURES): what is usual there, so that clods are no noise on rough ground.

        Rise per metre, log2 of the roughness (m), height over the mean in roughnesses, and how
        many of the points lie near the ground; roughness and mean are of a cell and those around.
        """
        sums = np.zeros((4, self.slopes.size))
        _near_ground_kernel(self.heights, self.cells, sums)
        everything, count, total, squares = (self._added_around(one) for one in sums)
        mean, square = total / np.maximum(count, 1), squares / np.maximum(count, 1)
        rough = np.sqrt(np.maximum(square - mean**2, 0)) + _SMOOTHEST_M
        cells = self.cells[points]
        relative = (np.nan_to_num(self.heights[points]) - mean[cells]) / rough[cells]
        found = np.empty((points.size, GROUND_FEATURES), np.float32)
        found[:, 0] = self.slopes.ravel()[cells]
        found[:, 1] = np.log2(rough)[cells]
        found[:, 2] = np.clip(relative, -_MOST_RATIO, _MOST_RATIO)
        found[:, 3] = (count / np.maximum(everything, 1))[cells]
        return found

    def _added_around(self, sums: NDArray[np.float64]) -> NDArray[np.float64]:
        """(c,): sums of cells, with those of the eight around each."""
        height, width = self.slopes.shape
        padded, total = np.pad(sums.reshape(height, width), 1), np.zeros((height, width))
        for side in range(9):
            i, j = divmod(side, 3)
            total += padded[i : i + height, j : j + width]
        return total.ravel()

    @classmethod
    def none(cls) -> GroundGrid:
        """Of no points."""
        return cls(np.zeros(0), np.zeros(0, np.int32), np.zeros((0, 0)))


def ground_below(xyz: NDArray[np.float64], is_sure: NDArray[np.bool_], cell_m: float) -> GroundGrid:
    """The low surfaces around every point, and its height above them.

    1. In every square cell, the height below which a tenth of its sure points lie.
    2. The median of each cell and those around it, which drops cells without ground and cells
       with a patch below it.
    3. Cells without sure points take the mean of those around, a few cells far.
    4. The same once more of what is left over the slope that each cell shares with those beside
       it: a bank is ground over all its height, too.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.
    is_sure : (n,) bool
        Points on surfaces that go on; where there are too few, all points are taken.
    """
    if not xyz.shape[0]:
        return GroundGrid.none()
    used = np.flatnonzero(is_sure)
    if used.size < _FEWEST:
        used = np.arange(xyz.shape[0])
    used = used[:: max(1, used.size // _SAMPLE)]
    some = xyz[used[:: max(1, used.size // _SAMPLE_OF_EXTENT)], :2]
    lowest = np.percentile(some, _ENDS_PERCENT, axis=0) - _BEYOND_CELLS * cell_m
    highest = np.percentile(some, 100 - _ENDS_PERCENT, axis=0) + _BEYOND_CELLS * cell_m
    shape = np.minimum(np.ceil((highest - lowest) / cell_m).astype(np.int64) + 1, _MOST_CELLS)
    side = np.maximum((highest - lowest) / (shape - 1), _LEAST_SIDE_M)
    cells = np.empty(xyz.shape[0], np.int32)
    aside = np.empty((xyz.shape[0], 2))
    _cells_kernel(xyz, lowest, side, shape, cells, aside)
    level = _known_ground(xyz[used, 2], cells[used], shape)
    steps = [_gentle_steps(level, axis) for axis in (0, 1)]
    flat = [one.ravel() for one in steps]
    inclined = np.empty(xyz.shape[0])
    _inclined_kernel(xyz, cells, aside, flat[0], flat[1], inclined)
    ground = _known_ground(inclined[used], cells[used], shape)
    slopes = np.hypot(steps[0] / side[0], steps[1] / side[1])
    _lower_kernel(ground.ravel(), cells, inclined)
    return GroundGrid(inclined, cells, slopes)


def _known_ground(
    heights: NDArray[np.float64], cells: NDArray[np.int32], shape: NDArray[np.int64]
) -> NDArray[np.float64]:
    """(h, w) heights of the ground from points in cells; NaN where none is near."""
    grid = np.full(int(shape.prod()), np.nan)
    known, low = low_heights(heights, cells.astype(np.int64))
    grid[known] = low
    return ground_of(grid.reshape(shape))


def _gentle_steps(ground: NDArray[np.float64], axis: int) -> NDArray[np.float64]:
    """(h, w) rise per cell along an axis: the gentler of those to either side, else 0.

    So a slope that goes on is followed, and nothing leans at a wall or the edge of a roof.
    """
    steps = np.nan_to_num(np.diff(ground, axis=axis))
    ends = [(1, 0) if one == axis else (0, 0) for one in range(2)]
    before, after = np.pad(steps, ends), np.pad(steps, [pair[::-1] for pair in ends])
    gentle = np.where(np.abs(before) < np.abs(after), before, after)
    return np.where(before * after > 0, gentle, 0.0)


def low_heights(
    heights: NDArray[np.float64], numbers: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """The height below which a tenth of a cell's points lie.

    Parameters
    ----------
    heights : (n,) float64
        m.
    numbers : (n,) int64
        Each point's cell.

    Returns
    -------
    cells : (k,) int64
        Rising.
    low : (k,) float64
        m; NaN for a cell of few points.
    """
    lowest = heights.min(initial=0.0)
    steps = np.minimum((heights - lowest) / _STEP_M, _STEPS - 1).astype(np.int64)
    keys, order = order_by_key(numbers * _STEPS + steps, SilentMonitor())
    numbers = keys // _STEPS
    firsts = np.flatnonzero(np.r_[True, numbers[1:] != numbers[:-1]][: numbers.size])
    sizes = np.diff(np.r_[firsts, numbers.size])
    chosen = heights[order][firsts + (sizes * _LOW_SHARE).astype(np.int64)]
    return numbers[firsts], np.where(sizes >= _FEWEST, chosen, np.nan)


def ground_of(grid: NDArray[np.float64]) -> NDArray[np.float64]:
    """(h, w) heights of the ground from low heights of cells; NaN where none is near."""
    for _ in range(_PASSES):
        grid = _smoothed(grid)
    return grid


def _smoothed(grid: NDArray[np.float64]) -> NDArray[np.float64]:
    """The median of 25 cells; NaN stays where none of them is known."""
    padded = np.pad(grid, _ASIDE, constant_values=np.nan)
    smooth = np.full(grid.shape, np.nan)
    for start in range(0, grid.shape[0], _ROWS_AT_ONCE):
        strip = padded[start : start + _ROWS_AT_ONCE + 2 * _ASIDE]
        if not np.isnan(strip).all():
            smooth[start : start + _ROWS_AT_ONCE] = _medians(strip)
    return smooth


def _medians(strip: NDArray[np.float64]) -> NDArray[np.float64]:
    height, width = strip.shape[0] - 2 * _ASIDE, strip.shape[1] - 2 * _ASIDE
    steps = range(2 * _ASIDE + 1)
    stack = np.stack([strip[i : i + height, j : j + width] for i in steps for j in steps])
    stack.sort(axis=0)  # NaN last
    known = (~np.isnan(stack)).sum(axis=0)
    middle = np.maximum(known - 1, 0) // 2
    medians: NDArray[np.float64] = np.take_along_axis(stack, middle[None], axis=0)[0]
    return medians


@kernel
def _cells_kernel(
    xyz: NDArray[np.float64],
    lowest: NDArray[np.float64],
    side: NDArray[np.float64],
    shape: NDArray[np.int64],
    cells: NDArray[np.int32],
    aside: NDArray[np.float64],
) -> None:
    """The cell of each point, and where it lies in it: in cells from the cell's middle."""
    for point in range(xyz.shape[0]):
        cell = 0
        for axis in range(2):
            share = (xyz[point, axis] - lowest[axis]) / side[axis]
            number = min(max(int(share), 0), shape[axis] - 1)
            aside[point, axis] = share - number - 0.5
            cell = cell * shape[1] + number if axis else number
        cells[point] = cell


@kernel
def _inclined_kernel(
    xyz: NDArray[np.float64],
    cells: NDArray[np.int32],
    aside: NDArray[np.float64],
    eastward: NDArray[np.float64],
    northward: NDArray[np.float64],
    found: NDArray[np.float64],
) -> None:
    """Heights without the slopes of cells, which are given as rises per cell along both axes."""
    for point in range(xyz.shape[0]):
        cell = cells[point]
        rise = eastward[cell] * aside[point, 0] + northward[cell] * aside[point, 1]
        found[point] = xyz[point, 2] - rise


@kernel
def _lower_kernel(
    ground: NDArray[np.float64], cells: NDArray[np.int32], heights: NDArray[np.float64]
) -> None:
    """Take the ground of its cell off each height."""
    for point in range(cells.size):
        heights[point] -= ground[cells[point]]


@kernel
def _near_ground_kernel(
    heights: NDArray[np.float64], cells: NDArray[np.int32], sums: NDArray[np.float64]
) -> None:
    """Count the points of every cell, those near the ground, and sum their heights and squares.

    ``sums`` (4, c). Unknown heights count as 0.
    """
    for point in range(cells.size):
        cell, height = cells[point], heights[point]
        if np.isnan(height):
            height = 0.0
        sums[0, cell] += 1
        if abs(height) < _NEAR_M:
            sums[1, cell] += 1
            sums[2, cell] += height
            sums[3, cell] += height * height


def warm_up() -> None:
    """Compile the kernels of this file."""
    ground = ground_below(np.zeros((2, 3)), np.zeros(2, np.bool_), 1.0)
    ground.features(np.zeros(1, np.int64))
