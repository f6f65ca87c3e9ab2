"""Low growth: how far blades of grass lift the mean of a cell's ground points.

Points on blades that stand within the ground's roughness pass for ground. They lie above it and
never below: heights of grown ground scatter by more than those of bare ground and are skewed
upward, which those of bare ground, rough or smooth, are not. There the lowest tenth of the points
says where the ground is: as far below it as the lowest tenth of bare ground lies.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.earthwork.surfaces.sides import EpochGround
from processing.methods.ground.filters.cells import CellGrid

Floats = NDArray[np.float64]
CellCounts = NDArray[np.int32]

_BLOCK_M = 1.0
_BIN_M = 0.004
_BINS = 60
_FEWEST = 30
_STEP_M = 0.06
_BARE = 25
_SMOOTH_M = 0.006
_CLEARLY = 1.5
_SURE = 3.0
_OF_SKEWNESS = 6.0  # variance of a normal sample's skewness, times its size
_LOWEST = 0.1
_BELOW = 1.2816  # of a normal distribution, in standard deviations


def lift_of_growth(
    epoch: EpochGround, grid: CellGrid, planes: tuple[Floats, Floats, Floats], monitor: Monitor
) -> Floats:
    """How far the mean of each cell lies above the ground between the blades: (rows, columns), m.

    Parameters
    ----------
    grid : CellGrid
        Its origin as the epoch's points count from it.
    planes : (heights, slopes to the east, slopes to the north), each (rows, columns) float64
        Of the points in each cell, m at its middle and m per m; NaN without points.

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
    told = (counts.sum(axis=2) >= _FEWEST) & (spread < _STEP_M)
    if not told.any():
        return np.zeros(count.shape)
    bare = max(float(np.percentile(spread[told], _BARE)), _SMOOTH_M)
    by_chance = _SURE * np.sqrt(_OF_SKEWNESS / count) * spread**3
    is_grown = told & (spread > _CLEARLY * bare) & (third > by_chance)
    lowest = middles[np.argmax(np.cumsum(counts, axis=2) >= _LOWEST * count[..., None], axis=2)]
    lift: Floats = np.where(is_grown, np.maximum(-lowest - _BELOW * bare, 0.0), 0.0)
    return lift


@kernel
def _heights_kernel(
    xyz: Floats,
    origin: Floats,
    sizes: tuple[float, int],
    planes: tuple[Floats, Floats, Floats],
    counts: CellCounts,
) -> None:
    size_m, times = sizes
    heights, slopes_x, slopes_y = planes
    rows, columns = heights.shape
    bins = counts.shape[2]
    for point in range(xyz.shape[0]):
        x, y = xyz[point, 0] - origin[0], xyz[point, 1] - origin[1]
        # NaN fails each of these tests.
        if not (x >= 0.0 and y >= 0.0 and x < columns * size_m and y < rows * size_m):
            continue
        column, row = min(int(x / size_m), columns - 1), min(int(y / size_m), rows - 1)
        above = xyz[point, 2] - origin[2] - heights[row, column]
        above -= slopes_x[row, column] * (x - (column + 0.5) * size_m)
        above -= slopes_y[row, column] * (y - (row + 0.5) * size_m)
        if np.isfinite(above):
            own = min(max(int(np.floor(above / _BIN_M)) + bins // 2, 0), bins - 1)
            counts[row // times, column // times, own] += 1


def warm_up() -> None:
    """Compile the kernel of this file."""
    flat, counts = np.zeros((1, 1)), np.zeros((1, 1, _BINS), np.int32)
    _heights_kernel(np.zeros((1, 3)), np.zeros(3), (1.0, 1), (flat, flat, flat), counts)
