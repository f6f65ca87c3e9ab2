"""Cells of the plan of a survey, only where something was measured: tiles of cells in a table.

A road is long and narrow, so a raster over its extent would mostly be empty. What is kept per cell
is bounded by the ground that was seen and not by the number of points.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.errors import OutOfRange
from processing.core.kernels import kernel
from processing.core.text import Text

CELL_M = 0.2
"""Width of a cell: a post or a trunk seen from one side fills one to three of them."""

TILE = 64
"""Cells along the side of a tile: 12.8 m, about the width of a road."""

_SIZE_M = CELL_M * TILE
_SIZE_BEGINS_M = float(np.float32(_SIZE_M))
_SIZE_ENDS_M = _SIZE_M - _SIZE_BEGINS_M
"""Width of a tile, its first 24 bits, and the others: a number of tiles times either is exact."""

_MOST_TILES = 50_000_000
"""In the table over the whole extent: 200 MB, 90 km by 90 km."""


class SparsePlan:
    """Tiles of a plan; they are added as points come.

    Parameters
    ----------
    lowest, highest : (3,) float64
        Extent of all points, m, project CRS.

    Attributes
    ----------
    origin : (3,) float64
        m, project CRS; what is told about the plan is told about it.
    table : (nx, ny) int32
        The number of each tile of the extent; −1: nothing was measured there.
    """

    def __init__(self, lowest: Floats, highest: Floats) -> None:
        size_m = CELL_M * TILE
        first = np.floor(lowest / size_m)
        shape = (np.floor(highest / size_m) - first + 1)[:2]
        if not np.isfinite(shape).all() or shape.prod() > _MOST_TILES:
            raise OutOfRange(
                Text("The drives lie too far apart.", "走行データ同士が離れすぎています。"),
                Text.same(f"{np.ptp([lowest[:2], highest[:2]]) / 1000:,.0f} km"),
                Text(
                    "Choose drives of one survey.",
                    "同じ計測の走行データを選んでください。",
                ),
            )
        self.origin: Floats = first * size_m
        self.table: NDArray[np.int32] = np.full(shape.astype(np.int64), -1, np.int32)
        self._positions: list[tuple[int, int]] = []

    def __len__(self) -> int:
        return len(self._positions)

    def add(self, local: Floats) -> None:
        """Make tiles for points: (n, 3) float64, m about `origin`."""
        touched = np.zeros(self.table.shape, np.bool_)
        touch_kernel(local, touched)
        for position in np.argwhere(touched & (self.table < 0)).tolist():
            self.table[tuple(position)] = len(self._positions)
            self._positions.append((position[0], position[1]))

    def grown(self, values: NDArray[Any], fill: float) -> NDArray[Any]:
        """Values of the tiles with room for those that were added: (tiles, …) of the same type."""
        added = np.full((len(self) - len(values), *values.shape[1:]), fill, values.dtype)
        return np.concatenate([values, added]) if len(added) else values

    def window(self, values: NDArray[Any], tile: int, halo: int, fill: float) -> NDArray[Any]:
        """The cells of a tile with those around it.

        Parameters
        ----------
        values : (tiles, c, c) array
            Cells of any width that divides the tile.
        halo : int
            Cells around it, c at most.

        Returns
        -------
        (c + 2·halo, c + 2·halo) array
            First axis to the east; ``fill`` where there is no tile.
        """
        size = values.shape[1]
        wide: NDArray[Any] = np.full((3 * size, 3 * size), fill, values.dtype)
        east, north = self._positions[tile]
        shape = self.table.shape
        for i, j in ((i, j) for i in range(3) for j in range(3)):
            at = (east + i - 1, north + j - 1)
            if 0 <= at[0] < shape[0] and 0 <= at[1] < shape[1]:
                number = int(self.table[at])
                if number >= 0:
                    part = (slice(i * size, (i + 1) * size), slice(j * size, (j + 1) * size))
                    wide[part] = values[number]
        kept = slice(size - halo, 2 * size + halo)
        return wide[kept, kept]

    def middles(self, tile: int, cells: Integers) -> Floats:
        """(k, 2) float64: the middles of cells of `CELL_M` of a tile, m about `origin`."""
        corner = np.array(self._positions[tile], np.float64) * (CELL_M * TILE)
        middles: Floats = corner + (cells + 0.5) * CELL_M
        return middles


@kernel
def touch_kernel(local: Floats, touched: NDArray[np.bool_]) -> None:
    """Mark the tiles of points."""
    for point in range(len(local)):
        i, j = _tile_at(local[point, 0]), _tile_at(local[point, 1])
        # A damaged description of a drive may tell a smaller extent.
        if 0 <= i < touched.shape[0] and 0 <= j < touched.shape[1]:
            touched[i, j] = True


@kernel
def _tile_at(place: float) -> int:
    """``place // size``, exactly, in an eighth of its time.

    A rounded quotient can only be too large, by one: the rest is below 0 then. What is multiplied
    has few enough bits for nothing to be rounded.
    """
    number = math.floor(place / _SIZE_M)
    rest = (place - number * _SIZE_BEGINS_M) - number * _SIZE_ENDS_M
    return int(number) - int(rest < 0.0)


@kernel
def cell_of(east: float, north: float, table: NDArray[np.int32], per_tile: int) -> int:
    """Number of the cell at a place among those of all tiles, ``per_tile`` a side; −1: none."""
    i, j = _tile_at(east), _tile_at(north)
    if i < 0 or j < 0 or i >= table.shape[0] or j >= table.shape[1]:
        return -1
    number = table[i, j]
    if number < 0:
        return -1
    cell_m = _SIZE_M / per_tile
    a = min(int((east - i * _SIZE_M) / cell_m), per_tile - 1)
    b = min(int((north - j * _SIZE_M) / cell_m), per_tile - 1)
    return int((number * per_tile + a) * per_tile + b)


def plan_of(extents: Sequence[tuple[Sequence[float], Sequence[float]]]) -> SparsePlan:
    """An empty plan that holds all extents: lowest and highest corners, m, project CRS."""
    lowest = np.min([low for low, _ in extents], axis=0)
    highest = np.max([high for _, high in extents], axis=0)
    return SparsePlan(np.asarray(lowest, np.float64), np.asarray(highest, np.float64))
