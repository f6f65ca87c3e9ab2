"""The one pass over a recording that tells where its tiles are and how dense."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

LOWEST = slice(0, 3)
HIGHEST = slice(3, 6)
COUNT = 6
STEPS = slice(7, 9)
POINTS = 9
VALUES = 10
"""Columns of the table of tiles; behind them lie the weights of the two distances."""

_ALONG_ROWS, _ACROSS_ROWS, _ALONG_WEIGHT, _ACROSS_WEIGHT = 7, 8, 10, 11
"""Columns of the two steps, along rows and across, and of their weights."""

_TILE_BITS = 8
"""256 pixels: a picture of 200 kB, loaded in some milliseconds."""
TILE = 1 << _TILE_BITS
"""Rows and columns of a tile."""

_SAMPLED_ROWS = 8
"""Distances are taken in every eighth row: a mean needs no more."""


@kernel
def tile_kernel(
    xyz: NDArray[np.int32],
    columns: NDArray[np.int32],
    row_starts: NDArray[np.int64],
    scale: NDArray[np.float64],
    first_row: int,
    level_starts: NDArray[np.int64],
    tile_columns: NDArray[np.int64],
    table: NDArray[np.float64],
) -> None:
    """Extend bounds and count points of level 0, count pixels of all levels, sum distances.

    ``row_starts`` is counted from the first point given, ``first_row`` is the image's. Bounds are
    in integers; sums hold the roots of distances in metres.
    """
    for i in range(row_starts.size - 1):
        row = first_row + i
        start, stop = row_starts[i], row_starts[i + 1]
        tiles = (row >> _TILE_BITS) * tile_columns[0]
        for point in range(start, stop):
            values = table[tiles + (columns[point] >> _TILE_BITS)]
            for axis in range(3):
                value = xyz[point, axis]
                values[axis] = min(values[axis], value)
                values[3 + axis] = max(values[3 + axis], value)
            values[POINTS] += 1
        for level in range(tile_columns.size):
            if row & ((1 << level) - 1):
                break
            _count_pixels(columns, start, stop, row, level, level_starts, tile_columns, table)
        if row % _SAMPLED_ROWS == 0:
            after = row_starts[i + 2] if i + 2 < row_starts.size else stop
            _sum_steps(xyz, columns, scale, start, stop, after, tiles, table)


@kernel
def _count_pixels(
    columns: NDArray[np.int32],
    start: int,
    stop: int,
    row: int,
    level: int,
    level_starts: NDArray[np.int64],
    tile_columns: NDArray[np.int64],
    table: NDArray[np.float64],
) -> None:
    tiles = level_starts[level] + (row >> (_TILE_BITS + level)) * tile_columns[level]
    last = -1
    for point in range(start, stop):
        column = columns[point] >> level
        if column != last:
            table[tiles + (column >> _TILE_BITS), COUNT] += 1
            last = column


@kernel
def _sum_steps(
    xyz: NDArray[np.int32],
    columns: NDArray[np.int32],
    scale: NDArray[np.float64],
    start: int,
    stop: int,
    after: int,
    tiles: int,
    table: NDArray[np.float64],
) -> None:
    """Distances from the points ``start … stop − 1`` to their right and lower neighbours."""
    below = stop
    for point in range(start, stop):
        values = table[tiles + (columns[point] >> _TILE_BITS)]
        right = point + 1
        if right < stop and columns[right] == columns[point] + 1:
            values[_ALONG_ROWS] += _root_distance(xyz, scale, point, right)
            values[_ALONG_WEIGHT] += 1
        while below < after and columns[below] < columns[point]:
            below += 1
        if below < after and columns[below] == columns[point]:
            values[_ACROSS_ROWS] += _root_distance(xyz, scale, point, below)
            values[_ACROSS_WEIGHT] += 1


@kernel
def _root_distance(
    xyz: NDArray[np.int32], scale: NDArray[np.float64], one: int, other: int
) -> float:
    total = 0.0
    for axis in range(3):
        step = (float(xyz[other, axis]) - xyz[one, axis]) * scale[axis]
        total += step * step
    return float(total**0.25)
