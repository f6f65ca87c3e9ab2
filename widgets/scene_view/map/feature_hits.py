"""Which feature, vertex or segment is under a pixel, and which features a rectangle holds."""

from __future__ import annotations

import numpy as np
from PySide6.QtGui import QPolygonF

from widgets.feature_drawing.feature_hits import FeatureHit, features_inside, segment_at, vertex_at
from widgets.feature_drawing.feature_shapes import FlatShapes
from widgets.scene_view.rendering.projection import SceneProjection


def feature_at(
    flat: FlatShapes,
    projection: SceneProjection,
    position: tuple[float, float],
    selected: frozenset[str],
) -> FeatureHit:
    """What is under a pixel: vertices go before segments, chosen features before others.

    Parameters
    ----------
    position : tuple of float
        Pixel of the widget.
    """
    if not flat.shapes:
        return FeatureHit()
    pixels, _ = projection.to_screen(flat.local_xyz)
    vertex = vertex_at(flat, pixels, position, selected)
    if vertex is not None:
        return vertex
    ends = projection.segments_on_screen(flat.local_xyz, flat.segments)
    numbers = np.arange(len(flat.segments), dtype=np.int64)
    return segment_at(flat, ends, numbers, position, selected) or FeatureHit()


def features_within(
    flat: FlatShapes, projection: SceneProjection, outline: QPolygonF
) -> frozenset[str]:
    """Ids of the features that lie wholly inside an outline in the picture."""
    pixels, _ = projection.to_screen(flat.local_xyz)
    return features_inside(flat, pixels, outline)
