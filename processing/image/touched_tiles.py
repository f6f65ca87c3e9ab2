"""Which tiles of an image show some points: only those are made anew when points change."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.image.point_image import PointCloudImage
from processing.image.tiles import TILE, TileKey

_POINTS_AT_ONCE = 1_000_000


class TouchedTiles:
    """The tiles whose area holds at least one of some points, at every level.

    Parameters
    ----------
    image : PointCloudImage
    points : (n,) int64
        Of the image's recording, in any order.
    """

    def __init__(self, image: PointCloudImage, points: NDArray[np.int64]) -> None:
        rows, columns = -(-image.rows // TILE), -(-image.width // TILE)
        self._finest = np.zeros((max(1, rows), max(1, columns)), dtype=bool)
        for start in range(0, points.size, _POINTS_AT_ONCE):
            of_row, of_column = image.pixel_of(points[start : start + _POINTS_AT_ONCE])
            is_shown = of_row >= 0
            self._finest[of_row[is_shown] // TILE, of_column[is_shown] // TILE] = True

    def __contains__(self, key: TileKey) -> bool:
        """Whether a tile shows one of the points, or would if it were sharper."""
        rows = slice(key.row << key.level, (key.row + 1) << key.level)
        columns = slice(key.column << key.level, (key.column + 1) << key.level)
        return bool(self._finest[rows, columns].any())
