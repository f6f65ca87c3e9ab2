"""Loops over points and cells beside the ways."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import cell_of

_MOST_STEPS = 8
"""From the station nearest to a coarse cell's middle to that of a point: 0.6 m and a bend."""


@kernel
def ceilings_kernel(
    ground: NDArray[np.float32],
    table: NDArray[np.int32],
    tiles: Integers,
    limits: tuple[float, float],
    ceiling: Floats,
) -> None:
    """How high the surface reaches in each coarse cell: over the highest ground around it.

    ``limits``: how far above the ground, and how much higher the ground beside it may lie, m.
    """
    cells = GROUND_CELLS
    above_m, lower_m = limits
    for one in range(len(tiles)):
        for number in range(cells * cells):
            east = tiles[one, 0] * cells + number // cells
            north = tiles[one, 1] * cells + number % cells
            own = ground[table[tiles[one, 0], tiles[one, 1]] * cells * cells + number]
            highest = own
            for i in range(east - 1, east + 2):
                for j in range(north - 1, north + 2):
                    a, b = i // cells, j // cells
                    if a < 0 or b < 0 or a >= table.shape[0] or b >= table.shape[1]:
                        continue
                    if table[a, b] < 0:
                        continue
                    other = ground[(table[a, b] * cells + i % cells) * cells + j % cells]
                    if other > highest and other - own < lower_m:
                        highest = other
            ceiling[table[tiles[one, 0], tiles[one, 1]] * cells * cells + number] = (
                highest + above_m
            )


@kernel
def cross_sums_kernel(
    local: Floats,
    is_noise: Flags,
    intensity: NDArray[np.uint16],
    about: tuple[NDArray[np.int32], Floats, NDArray[np.int32]],
    ways: tuple[Floats, Floats, Integers],
    measures: tuple[float, float, float, float, float],
    sums: NDArray[np.float32],
) -> None:
    """Add points to the cells across the ways.

    Parameters
    ----------
    about : tuple
        Tiles, and for each coarse cell how high the surface reaches and the nearest station.
    ways : tuple
        Places, directions and ways of the stations.
    measures : tuple of float
        How far the road lies below the path, step between stations, reach, width of a cell, m; and
        the unit of intensities.
    sums : (stations, cells, 4) float32
        Counts, sums of heights, of their squares, and of intensities.
    """
    table, ceiling, nearest = about
    places, directions, way = ways
    under_m, step_m, reach_m, cell_m, unit = measures
    last = len(places) - 1
    for point in range(len(local)):
        if is_noise[point]:
            continue
        east, north = local[point, 0], local[point, 1]
        cell = cell_of(east, north, table, GROUND_CELLS)
        if cell < 0 or not local[point, 2] < ceiling[cell]:
            continue
        k = int(nearest[cell])
        ahead = 0.0
        for _ in range(_MOST_STEPS):
            ahead = (east - places[k, 0]) * directions[k, 0]
            ahead += (north - places[k, 1]) * directions[k, 1]
            if ahead > 0.5 * step_m and k < last and way[k + 1] == way[k]:
                k += 1
            elif ahead < -0.5 * step_m and k > 0 and way[k - 1] == way[k]:
                k -= 1
            else:
                break
        if abs(ahead) > step_m:
            continue
        left = (north - places[k, 1]) * directions[k, 0] - (east - places[k, 0]) * directions[k, 1]
        column = math.floor((left + reach_m) / cell_m)
        if column < 0 or column >= sums.shape[1]:
            continue
        # The path's own rise is taken out: the road rises with it.
        other = k + 1 if k < last and way[k + 1] == way[k] else k - 1
        rise = (places[other, 2] - places[k, 2]) * (1.0 if other > k else -1.0) / step_m
        height = local[point, 2] - (places[k, 2] + rise * ahead - under_m)
        bright = intensity[point] / unit
        sums[k, column, 0] += 1.0
        sums[k, column, 1] += height
        sums[k, column, 2] += height * height
        sums[k, column, 3] += bright
