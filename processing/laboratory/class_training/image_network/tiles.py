"""Tiles of an image for a network, and values of its coarser output back at pixels.

References
----------
Takahashi 2022, section 4.6: 513 × 513 pixels, 50 of which overlap, so that no seam shows.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers

TILE_PX, OVERLAP_PX = 513, 50


@dataclass(frozen=True)
class Tile:
    """A square of an image, and the part of it that it speaks for.

    Attributes
    ----------
    row, column : int
        Its first pixel.
    own_rows, own_columns : range
        Pixels of the image that are farther from this tile's edge than from its neighbours'.
    """

    row: int
    column: int
    own_rows: range
    own_columns: range


def tiles_of(rows: int, columns: int) -> Iterator[Tile]:
    """Tiles over an image; the last of a row or column ends at the border."""
    for row, own_rows in _stretches(rows):
        for column, own_columns in _stretches(columns):
            yield Tile(row, column, own_rows, own_columns)


def _stretches(length: int) -> list[tuple[int, range]]:
    """First pixels of the tiles along an axis, and the pixels that are each one's own."""
    last = max(0, length - TILE_PX)
    starts = [*range(0, last, TILE_PX - OVERLAP_PX), last]
    cuts = [(one + TILE_PX + other) // 2 for one, other in itertools.pairwise(starts)]
    edges = [0, *cuts, length]
    return [(start, range(*edges[at : at + 2])) for at, start in enumerate(starts)]


def cut_out(values: NDArray[np.float16], tile: Tile) -> NDArray[np.float32]:
    """(channels, 513, 513) a tile of an image (channels, rows, columns); 0 beyond its border."""
    cut = values[:, tile.row : tile.row + TILE_PX, tile.column : tile.column + TILE_PX]
    whole = np.zeros((values.shape[0], TILE_PX, TILE_PX), np.float32)
    whole[:, : cut.shape[1], : cut.shape[2]] = cut
    return whole


def at_pixels(
    coarse: NDArray[np.float32], rows: Integers, columns: Integers
) -> NDArray[np.float32]:
    """Values of a tile's coarse output at pixels, linear between its own.

    Parameters
    ----------
    coarse : (k, m, m) float32
        Its corners are the tile's corners, as 129 × 129 to 513 × 513.
    rows, columns : (n,) int64
        In the tile.

    Returns
    -------
    (n, k) float32
    """
    last = coarse.shape[1] - 1
    down, across = rows * last / (TILE_PX - 1), columns * last / (TILE_PX - 1)
    top = np.minimum(down.astype(np.int64), last - 1)
    left = np.minimum(across.astype(np.int64), last - 1)
    low, right = (down - top).astype(np.float32), (across - left).astype(np.float32)
    found = np.zeros((coarse.shape[0], rows.size), np.float32)
    for row, share_down in ((top, 1 - low), (top + 1, low)):
        for column, share_across in ((left, 1 - right), (left + 1, right)):
            found += coarse[:, row, column] * (share_down * share_across)
    return np.ascontiguousarray(found.T)
