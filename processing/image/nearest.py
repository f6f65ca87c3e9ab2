"""The measured point nearest to a place in space, found by the tiles' bounds."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from processing.image.point_image import PointCloudImage
from processing.image.tiles import TileKey

NONE = -1
XyzOf = Callable[[NDArray[np.int64]], NDArray[np.float64]]
"""Gives (k, 3) coordinates of points, m, project CRS."""


def nearest_point(
    image: PointCloudImage, xyz_of: XyzOf, xyz: NDArray[np.float64], within_m: float
) -> int:
    """The point of an image's recording nearest to a place.

    Tiles whose bounds come within the distance are followed down to single rows; only the points
    of those are measured.

    Parameters
    ----------
    xyz : (3,) float64
        m, project CRS.
    within_m : float
        Points further away don't count.

    Returns
    -------
    int
        −1 where no point is that near.
    """
    pyramid = image.pyramid
    nearest, limit = NONE, within_m
    waiting = [pyramid.top]
    while waiting:
        # The nearest tile first, so that most others are already too far.
        waiting.sort(key=lambda key: _distance(image, key, xyz), reverse=True)
        key = waiting.pop()
        if _distance(image, key, xyz) > limit:
            break
        if key.level > 0:
            waiting.extend(pyramid.children(key))
            continue
        found, distance = _nearest_in_tile(image, xyz_of, key, xyz)
        if distance <= limit and (nearest == NONE or distance < limit):
            nearest, limit = found, distance
    return nearest


def _distance(image: PointCloudImage, key: TileKey, xyz: NDArray[np.float64]) -> float:
    bounds = image.pyramid.bounds(key)
    if bounds is None:
        return np.inf
    outside = np.maximum(np.maximum(bounds[0] - xyz, xyz - bounds[1]), 0.0)
    return float(np.sqrt((outside**2).sum()))


def _nearest_in_tile(
    image: PointCloudImage, xyz_of: XyzOf, key: TileKey, xyz: NDArray[np.float64]
) -> tuple[int, float]:
    rows, columns = image.pyramid.rows_columns(key)
    start, stop = int(image.row_starts[rows.start]), int(image.row_starts[rows.stop])
    of_points = image.columns_of(start, stop)
    inside = np.flatnonzero((of_points >= columns.start) & (of_points < columns.stop)) + start
    if not inside.size:
        return NONE, np.inf
    squares = ((xyz_of(inside) - xyz) ** 2).sum(axis=1)
    best = int(squares.argmin())
    return int(inside[best]), float(np.sqrt(squares[best]))
