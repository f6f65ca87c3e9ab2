"""PictureFeature: a feature in picture coordinates, as lines that can be painted and hit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF
from PySide6.QtGui import QPainterPath, QPolygonF

from processing.core.arrays import Floats
from processing.map.catalogue import Geometry
from processing.map.feature import Feature
from widgets.image_view.orientation.oriented_image import OrientedImage


@dataclass(frozen=True, eq=False)
class PictureFeature:
    """Where a feature is in the picture.

    Attributes
    ----------
    positions : (n, 2) float64
        Of its vertices, picture coordinates; NaN where no measured point of the drive is near.
    segments : (k, 5) float64
        Start, end and the number of the segment; one that crosses the picture's seam is there
        twice, reaching beyond the edge on both sides.
    bounds : (4,) float64
        Left, top, right, bottom; NaN when nothing of it is in the picture.
    """

    feature: Feature
    positions: Floats
    segments: Floats
    bounds: Floats
    path: QPainterPath


def join_vertices(feature: Feature, positions: Floats, picture: OrientedImage) -> PictureFeature:
    """Join a feature's vertices as its geometry says."""
    segments = segments_between(positions, feature.geometry, picture)
    ends = np.concatenate([positions, segments[:, :2], segments[:, 2:4]])
    ends = ends[np.isfinite(ends[:, 0])]
    bounds = (
        np.concatenate([ends.min(axis=0), ends.max(axis=0)]) if ends.size else np.full(4, np.nan)
    )
    return PictureFeature(feature, positions, segments, bounds, path_of_segments(segments))


def segments_between(positions: Floats, geometry: Geometry, picture: OrientedImage) -> Floats:
    """(k, 5) segments of a shape; those with an end that has no place are left out."""
    count = positions.shape[0]
    if geometry is Geometry.POINT or count < 2:
        return np.empty((0, 5))
    closes = geometry is Geometry.AREA and count > 2
    starts = np.arange(count if closes else count - 1)
    joined = np.column_stack([positions[starts], positions[(starts + 1) % count], starts])
    joined = joined[np.isfinite(joined[:, :4]).all(axis=1)]
    return _around_the_seam(joined, picture) if picture.image.kind.follows_path else joined


def path_of_segments(segments: Floats) -> QPainterPath:
    """Segments as a path, joined where one begins at the end of the one before."""
    path = QPainterPath()
    line: list[QPointF] = []
    for u, v, next_u, next_v, _ in segments.tolist():
        start = QPointF(u, v)
        if not line or line[-1] != start:
            _add(path, line)
            line = [start]
        line.append(QPointF(next_u, next_v))
    _add(path, line)
    return path


def _add(path: QPainterPath, line: Sequence[QPointF]) -> None:
    if len(line) > 1:
        path.addPolygon(QPolygonF(line))


def _around_the_seam(segments: Floats, picture: OrientedImage) -> Floats:
    """A row is a ring: what jumps over half of it passes the edge where the ring was cut."""
    width = picture.image.width
    jump = segments[:, 3] - segments[:, 1]
    crosses = np.abs(jump) > width / 2
    if not crosses.any():
        return segments
    ahead, behind = segments[crosses].copy(), segments[crosses].copy()
    shift = np.sign(jump[crosses]) * width
    ahead[:, 3] -= shift
    behind[:, 1] += shift
    joined = np.concatenate([segments[~crosses], ahead, behind])
    return joined[np.argsort(joined[:, 4], kind="stable")]
