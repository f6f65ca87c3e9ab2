"""Outlines in the window: which positions a rectangle or a lasso holds."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray
from PySide6.QtGui import QPolygonF

_CORNERS = 4


def is_rectangle(outline: QPolygonF) -> bool:
    """Whether an outline is an upright rectangle."""
    bounds = QPolygonF(outline.boundingRect())
    return set(_corners(outline)) == set(_corners(bounds))


def are_inside(positions: NDArray[np.float64], outline: QPolygonF) -> NDArray[np.bool_]:
    """(n,) whether (n, 2) positions lie in an outline, its border included; NaN ones don't."""
    corners = _corners(outline)
    if is_rectangle(outline):
        (left, top), (right, bottom) = np.min(corners, axis=0), np.max(corners, axis=0)
        x, y = positions.T
        within: NDArray[np.bool_] = (x >= left) & (x <= right) & (y >= top) & (y <= bottom)
        return within
    if len(corners) < _CORNERS - 1:
        return np.zeros(len(positions), dtype=bool)
    area = shapely.make_valid(shapely.Polygon(corners))
    shapely.prepare(area)
    inside: NDArray[np.bool_] = shapely.intersects_xy(area, positions[:, 0], positions[:, 1])
    return inside & np.isfinite(positions[:, 0])


def _corners(outline: QPolygonF) -> list[tuple[float, float]]:
    return [(corner.x(), corner.y()) for corner in outline.toList()]
