"""Low growth: how far blades of grass lift the mean of a cell's ground points.

Points on blades that stand within the ground's roughness pass for ground. They lie above it and
never below: heights of grown ground scatter by more than those of bare ground and are skewed
upward, which those of bare ground, rough or smooth, are not. There the lowest tenth of the points
says where the ground is: as far below it as the lowest tenth of bare ground lies.

Where a constant says “by trial”, no measurement varied it alone: docs/accuracy.md judges all values
together, on simulated sites whose volumes are known.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.earthwork.surfaces.sides import EpochGround
from processing.methods.ground.filters.cells import CellGrid

Floats = NDArray[np.float64]
CellCounts = NDArray[np.int32]

_BLOCK_M = 1.0
"""Side of the squares whose heights are looked at together; by trial, enough points in each."""

_BIN_M, _BINS = 0.004, 60
"""Heights are counted in bins finer than a scanner's noise, 12 cm to either side of the plane:
twice ``_STEP_M``."""

_FEWEST = 30
"""Points of a square whose scatter and skewness say something; by trial."""

_STEP_M = 0.06
"""Scatter from which a square holds a step and no growth; by trial."""

_BARE_PERCENT = 25
"""Of all squares' scatter: that of bare ground. By trial, as most sites have bare ground."""

_SMOOTH_M = 0.006
"""Least of that scatter: a scanner's noise."""

_CLEARLY = 1.5
"""Times the scatter of bare ground, from which a square is grown over; by trial."""

_SURE = 3.0
"""Standard deviations by which a skewness is more than chance: once in some 700 bare squares."""

_SKEWNESS_VARIANCE = 6.0
"""Variance of a normal sample's skewness, times its size."""

_LOWEST_SHARE, _LOWEST_SIGMAS = 0.1, 1.2816
"""The lowest tenth of a normal distribution lies so many standard deviations below its mean."""


class CellPlanes(NamedTuple):
    """Planes through the points of cells, each (rows, columns) float64; NaN without points.

    Attributes
    ----------
    heights
        m at a cell's middle.
    slopes_x, slopes_y
        m per m, to the east and to the north.
    """

    heights: Floats
    slopes_x: Floats
    slopes_y: Floats


def lift_of_growth(
    epoch: EpochGround, grid: CellGrid, planes: CellPlanes, monitor: Monitor
) -> Floats:
    """How far the mean of each cell lies above the ground between the blades: (rows, columns), m.

    Parameters
    ----------
    grid : CellGrid
        Its origin as the epoch's points count from it.
    planes : CellPlanes
        Of the points in each cell.

    Notes
    -----
    Asked of blocks of a metre. Those that scatter by more than 6 cm hold a step and stay.
    """
    times = max(1, round(_BLOCK_M / grid.size_m))
    rows, columns = -(-grid.rows // times), -(-grid.columns // times)
    counts = np.zeros((rows, columns, _BINS), np.int32)
    for block in epoch.blocks():
        monitor.check()
        xyz = np.ascontiguousarray(block.xyz)
        _heights_kernel(xyz, grid.origin, (grid.size_m, times), planes, counts)
    lift = _lift(counts).repeat(times, axis=0).repeat(times, axis=1)
    return lift[: grid.rows, : grid.columns]


def _lift(counts: CellCounts) -> Floats:
    """From how many points of each block lie how far above their cells' planes."""
    middles = (np.arange(_BINS) + 0.5 - _BINS / 2) * _BIN_M
    count = np.maximum(counts.sum(axis=2), 1)
    mean = counts @ middles / count
    spread = np.sqrt(np.maximum(counts @ middles**2 / count - mean**2, 0.0))
    third = counts @ middles**3 / count - 3 * mean * spread**2 - mean**3
    is_asked = (counts.sum(axis=2) >= _FEWEST) & (spread < _STEP_M)
    if not is_asked.any():
        return np.zeros(count.shape)
    bare = max(float(np.percentile(spread[is_asked], _BARE_PERCENT)), _SMOOTH_M)
    by_chance = _SURE * np.sqrt(_SKEWNESS_VARIANCE / count) * spread**3
    is_grown = is_asked & (spread > _CLEARLY * bare) & (third > by_chance)
    is_low = np.cumsum(counts, axis=2) >= _LOWEST_SHARE * count[..., None]
    lowest = middles[np.argmax(is_low, axis=2)]
    lift: Floats = np.where(is_grown, np.maximum(-lowest - _LOWEST_SIGMAS * bare, 0.0), 0.0)
    return lift


@kernel
def _heights_kernel(
    xyz: Floats,
    origin: Floats,
    sizes: tuple[float, int],
    planes: CellPlanes,
    counts: CellCounts,
) -> None:
    size_m, times = sizes
    heights = planes.heights
    rows, columns = heights.shape
    bins = counts.shape[2]
    for point in range(xyz.shape[0]):
        x, y = xyz[point, 0] - origin[0], xyz[point, 1] - origin[1]
        # NaN fails each of these tests.
        if not (x >= 0.0 and y >= 0.0 and x < columns * size_m and y < rows * size_m):
            continue
        column, row = min(int(x / size_m), columns - 1), min(int(y / size_m), rows - 1)
        above = xyz[point, 2] - origin[2] - heights[row, column]
        above -= planes.slopes_x[row, column] * (x - (column + 0.5) * size_m)
        above -= planes.slopes_y[row, column] * (y - (row + 0.5) * size_m)
        if np.isfinite(above):
            own = min(max(int(np.floor(above / _BIN_M)) + bins // 2, 0), bins - 1)
            counts[row // times, column // times, own] += 1


def warm_up() -> None:
    """Compile the kernel of this file."""
    flat, counts = np.zeros((1, 1)), np.zeros((1, 1, _BINS), np.int32)
    _heights_kernel(np.zeros((1, 3)), np.zeros(3), (1.0, 1), CellPlanes(flat, flat, flat), counts)
