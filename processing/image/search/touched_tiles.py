"""Which tiles of an image show some points: only those are made anew when points change."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.image.point_image import PointCloudImage
from processing.image.rows.point_image_kernels import PixelLayout
from processing.image.tiles.tiles import TILE, TileKey


class TouchedTiles:
    """The tiles whose area holds at least one of some points, at every level.

    Parameters
    ----------
    image : PointCloudImage
    points : (n,) int64
        Of the image's recording, rising.
    """

    def __init__(self, image: PointCloudImage, points: NDArray[np.int64]) -> None:
        rows, columns = -(-image.rows // TILE), -(-image.width // TILE)
        self._finest = np.zeros((max(1, rows), max(1, columns)), dtype=np.bool_)
        if points.size and image.rows:
            row = int(np.searchsorted(image.row_starts, points[0], side="right")) - 1
            _touch_kernel(image.layout, points, min(max(row, 0), image.rows - 1), self._finest)

    def __contains__(self, key: TileKey) -> bool:
        """Whether a tile shows one of the points, or would if it were sharper."""
        rows = slice(key.row << key.level, (key.row + 1) << key.level)
        columns = slice(key.column << key.level, (key.column + 1) << key.level)
        return bool(self._finest[rows, columns].any())


@kernel
def _touch_kernel(
    layout: PixelLayout, points: NDArray[np.int64], row: int, touched: NDArray[np.bool_]
) -> None:
    """Mark the tile of every point; the first is in ``row`` or behind it.

    Points that the recording doesn't have, and those whose pulse is damaged, are in no tile.
    """
    rows = layout.row_starts.size - 1
    for k in range(points.size):
        point = points[k]
        if not 0 <= point < layout.pulses.size:
            continue
        while row < rows - 1 and layout.row_starts[row + 1] <= point:
            row += 1
        doubled = 2 * layout.pulses[point] - layout.origins[row]
        column = doubled * layout.per_span // layout.spans[row]
        if 0 <= column < TILE * touched.shape[1]:
            touched[row // TILE, column // TILE] = True


def warm_up() -> None:
    """Compile the kernel."""
    one = np.zeros(1, np.int64)
    layout = PixelLayout(one, np.array([0, 1]), one, np.array([2]), 1)
    _touch_kernel(layout, one, 0, np.zeros((1, 1), np.bool_))
