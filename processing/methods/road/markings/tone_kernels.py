"""Loops over points and cells: how bright the road is, and where it is painted."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import CELL_M, TILE, cell_of

BINS = 64
"""Of a head's intensities; a byte numbers them."""

PAINT_SCALE, MOST_PAINT = 100.0, 1.5
"""Units of a full coat of paint in the raster, and the brightest that counts: so that 255 points
fit into two bytes."""

_SIGMAS = 4.0
"""What is brighter by so many standard deviations of the road's own tones is none of them."""

_LOW, _QUARTER, _BETWEEN = 0.10, 0.25, 0.607
"""Shares of the tones of a place that the road's own begin with, and the standard deviations
between them for a normal distribution: up to half of a place may be painted (crossings)."""

_FEWEST = 40
"""Points that tell the tones of a place."""

_FEWEST_BRIGHT, _BRIGHT_SHARE = 8, 0.01


@kernel
def ceilings_kernel(
    ground: NDArray[np.float32],
    table: NDArray[np.int32],
    tiles: Integers,
    above_m: float,
    ceiling: Floats,
) -> None:
    """How high the road reaches in each cell: above its lowest points by its own slope.

    The smaller of the slopes to both sides counts, so that the cells beside a curb don't rise.
    """
    cells = GROUND_CELLS
    for one in range(len(tiles)):
        for number in range(cells * cells):
            east, north = (
                tiles[one, 0] * cells + number // cells,
                tiles[one, 1] * cells + number % cells,
            )
            cell = _neighbour(east, north, table, cells)
            rise = 0.0
            for axis in range(2):
                i, j = (1, 0) if axis == 0 else (0, 1)
                after = _neighbour(east + i, north + j, table, cells)
                before = _neighbour(east - i, north - j, table, cells)
                least = np.inf
                if after >= 0 and not math.isnan(ground[after]):
                    least = abs(ground[after] - ground[cell])
                if before >= 0 and not math.isnan(ground[before]):
                    least = min(least, abs(ground[before] - ground[cell]))
                rise += least if least < np.inf else 0.0
            ceiling[cell] = ground[cell] + above_m + rise


@kernel
def _neighbour(east: int, north: int, table: NDArray[np.int32], cells: int) -> int:
    """Number of a cell by its place in the whole extent; −1: none."""
    if east < 0 or north < 0:
        return -1
    i, j = east // cells, north // cells
    if i >= table.shape[0] or j >= table.shape[1] or table[i, j] < 0:
        return -1
    return int((table[i, j] * cells + east % cells) * cells + north % cells)


@kernel
def road_points_kernel(
    local: Floats, is_noise: Flags, table: NDArray[np.int32], ceiling: Floats, is_road: Flags
) -> None:
    """Mark the points on the ground of known cells."""
    for point in range(len(local)):
        is_road[point] = False
        if is_noise[point]:
            continue
        cell = cell_of(local[point, 0], local[point, 1], table, GROUND_CELLS)
        is_road[point] = cell >= 0 and local[point, 2] < ceiling[cell]


@kernel
def count_tones_kernel(
    local: Floats,
    is_road: Flags,
    bins: NDArray[np.uint8],
    table: NDArray[np.int32],
    tones: NDArray[np.uint16],
) -> None:
    """Count the points of each cell by their tone."""
    for point in range(len(local)):
        if is_road[point]:
            cell = cell_of(local[point, 0], local[point, 1], table, GROUND_CELLS)
            if tones[cell, bins[point]] < 65_535:
                tones[cell, bins[point]] += 1


@kernel
def levels_kernel(
    tones: NDArray[np.uint16],
    table: NDArray[np.int32],
    tiles: Integers,
    ends: Floats,
    levels: NDArray[np.float32],
) -> None:
    """What the tones around each cell of some tiles tell.

    Parameters
    ----------
    ends : (BINS + 1,) float64
        Of the bins.
    levels : (cells, 3) float32
        The road's own tone, its standard deviation, and the tone of what is brighter; NaN where
        nothing tells.
    """
    cells = GROUND_CELLS
    for tile in range(len(tiles)):
        for number in range(cells * cells):
            east, north = (
                tiles[tile, 0] * cells + number // cells,
                tiles[tile, 1] * cells + number % cells,
            )
            cell = _neighbour(east, north, table, cells)
            for reach in range(1, 3):
                around = np.zeros(BINS)
                total = 0.0
                for i in range(east - reach, east + reach + 1):
                    for j in range(north - reach, north + reach + 1):
                        other = _neighbour(i, j, table, cells)
                        if other >= 0:
                            for one in range(BINS):
                                around[one] += tones[other, one]
                                total += tones[other, one]
                if total >= _FEWEST:
                    _levels(around, total, ends, levels[cell])
                    break


@kernel
def _levels(around: Floats, total: float, ends: Floats, found: NDArray[np.float32]) -> None:
    """The road's own tones are those from the darkest on; what is far brighter is something else.

    A mean and standard deviation are made of the darker quarter, then of all tones within reach of
    them, three times.
    """
    low, quarter = _quantile(around, _LOW * total, ends), _quantile(around, _QUARTER * total, ends)
    spread = max((quarter - low) / _BETWEEN, (ends[-1] - ends[0]) * 1e-4)
    middle = quarter + 0.674 * spread
    for _ in range(3):
        limit = middle + 3.0 * spread
        count, mean, square = 0.0, 0.0, 0.0
        for one in range(BINS):
            tone = (ends[one] + ends[one + 1]) / 2
            if tone <= limit:
                count += around[one]
                mean += around[one] * tone
                square += around[one] * tone * tone
        if count == 0.0:
            break
        middle = mean / count
        wide = (ends[-1] - ends[0]) * 1e-4
        spread = max(math.sqrt(max(square / count - middle * middle, 0.0)), wide)
    found[0], found[1] = middle, spread
    bright = np.zeros(BINS)
    count = 0.0
    for one in range(BINS):
        if (ends[one] + ends[one + 1]) / 2 > middle + _SIGMAS * spread:
            bright[one] = around[one]
            count += around[one]
    if count >= max(_FEWEST_BRIGHT, _BRIGHT_SHARE * total):
        found[2] = _quantile(bright, count / 2, ends)


@kernel
def _quantile(counts: Floats, wanted: float, ends: Floats) -> float:
    """The tone below which so many are."""
    below = 0.0
    for one in range(len(counts)):
        if counts[one] > 0 and below + counts[one] >= wanted:
            share = (wanted - below) / counts[one]
            return float(ends[one] + share * (ends[one + 1] - ends[one]))
        below += counts[one]
    return float(ends[-1])


@kernel
def paint_kernel(
    local: Floats,
    is_road: Flags,
    intensity: NDArray[np.uint16],
    table: NDArray[np.int32],
    levels: NDArray[np.float32],
    contrast: float,
    per_tile: int,
    paint: NDArray[np.uint16],
    counts: NDArray[np.uint8],
    heights: Floats,
) -> None:
    """Add up how painted the road is in fine cells, and how high it lies in coarse ones.

    The road's own tone between the middles of cells is interpolated. ``contrast``: what paint is
    brighter by, over the road's own tone. ``heights``: (cells, 2) sums and counts.
    """
    for point in range(len(local)):
        if not is_road[point]:
            continue
        own = own_tone(local[point, 0], local[point, 1], table, levels)
        if math.isnan(own) or own <= 0.0:
            continue
        share = (intensity[point] - own) / (contrast * own)
        cell = cell_of(local[point, 0], local[point, 1], table, per_tile)
        if counts[cell] < 255:
            counts[cell] += 1
            paint[cell] += np.uint16(PAINT_SCALE * min(max(share, 0.0), MOST_PAINT))
        coarse = cell_of(local[point, 0], local[point, 1], table, TILE)
        heights[coarse, 0] += local[point, 2]
        heights[coarse, 1] += 1.0


@kernel
def own_tone(
    east: float, north: float, table: NDArray[np.int32], levels: NDArray[np.float32]
) -> float:
    """The road's own tone at a place: between the middles of the four cells around it."""
    cell_m = CELL_M * TILE / GROUND_CELLS
    i, j = math.floor(east / cell_m - 0.5), math.floor(north / cell_m - 0.5)
    a, b = east / cell_m - 0.5 - i, north / cell_m - 0.5 - j
    total, weights = 0.0, 0.0
    for p in range(2):
        for q in range(2):
            cell = _neighbour(i + p, j + q, table, GROUND_CELLS)
            if cell >= 0 and not math.isnan(levels[cell, 0]):
                weight = (a if p else 1.0 - a) * (b if q else 1.0 - b)
                total += weight * levels[cell, 0]
                weights += weight
    return total / weights if weights > 0.25 else np.nan


@kernel
def shares_kernel(
    paint: NDArray[Any],
    counts: NDArray[Any],
    table: NDArray[np.int32],
    tile: tuple[int, int],
    per_tile: int,
    shares: NDArray[np.float32],
) -> None:
    """How painted each cell of a tile is, with its neighbours at half weight; NaN without points.

    A cell as wide as points lie apart is often empty; its neighbours tell what lies there.
    """
    first = int(table[tile[0], tile[1]]) * per_tile * per_tile
    for a in range(per_tile):
        for b in range(per_tile):
            total, count = 0.0, 0.0
            is_inner = 0 < a < per_tile - 1 and 0 < b < per_tile - 1
            for i in range(-1, 2):
                for j in range(-1, 2):
                    if is_inner:
                        other = first + (a + i) * per_tile + b + j
                    else:
                        other = _neighbour(
                            tile[0] * per_tile + a + i, tile[1] * per_tile + b + j, table, per_tile
                        )
                    if other >= 0 and counts[other] > 0:
                        weight = (2.0 - abs(i)) * (2.0 - abs(j))
                        total += weight * paint[other]
                        count += weight * counts[other]
            own = first + a * per_tile + b
            shares[own] = total / (PAINT_SCALE * count) if count > 0 else np.nan
