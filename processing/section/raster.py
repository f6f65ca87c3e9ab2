"""The picture of a section's points: squares of a few pixels, the nearer ones in front."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel

Colours = NDArray[np.uint8]


def paint_points(
    pixels: Floats, depths: Floats, colours: Colours, side_px: int, out: Colours
) -> None:
    """Paint points into a picture as squares.

    Parameters
    ----------
    pixels : (n, 2) float64
        Columns and rows of their middles; those outside the picture and NaN are left out.
    depths : (n,) float64
        The nearest to zero, in the plane of the section, is in front.
    colours : (n, 3) uint8
    side_px : int
        Of a square.
    out : (height, width, 3) uint8
        Painted into.
    """
    nearest = np.full(out.shape[:2], np.inf, np.float32)
    _paint_kernel(pixels, depths, colours, side_px, nearest, out)


@kernel
def _paint_kernel(
    pixels: Floats,
    depths: Floats,
    colours: Colours,
    side_px: int,
    nearest: NDArray[np.float32],
    out: Colours,
) -> None:
    height, width = out.shape[:2]
    for i in range(pixels.shape[0]):
        x, y = pixels[i, 0], pixels[i, 1]
        if not (-side_px < x < width + side_px and -side_px < y < height + side_px):
            continue
        left, top = int(np.floor(x - (side_px - 1) / 2)), int(np.floor(y - (side_px - 1) / 2))
        depth = abs(depths[i])
        for row in range(max(top, 0), min(top + side_px, height)):
            for column in range(max(left, 0), min(left + side_px, width)):
                if depth < nearest[row, column]:
                    nearest[row, column] = depth
                    for band in range(3):
                        out[row, column, band] = colours[i, band]


def warm_up() -> None:
    """Compile the kernel."""
    out = np.zeros((2, 2, 3), np.uint8)
    paint_points(np.zeros((1, 2)), np.zeros(1), np.zeros((1, 3), np.uint8), 1, out)
