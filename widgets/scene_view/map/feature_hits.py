"""Which feature, vertex or segment is under a pixel, and which features a rectangle holds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPolygonF

from widgets.scene_view.map.feature_shapes import FlatShapes
from widgets.scene_view.projection import Projection
from widgets.shared.outlines import are_inside

Floats = NDArray[np.float64]

VERTEX_PX = 8.0
SEGMENT_PX = 6.0


@dataclass(frozen=True)
class FeatureHit:
    """A feature under the mouse; ``vertex`` or ``segment`` is −1."""

    feature: str = ""
    vertex: int = -1
    segment: int = -1


def feature_at(
    flat: FlatShapes,
    projection: Projection,
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
    mouse = np.array(position)
    is_chosen = np.array([shape.feature.id in selected for shape in flat.shapes])
    pixels, _ = projection.to_screen(flat.local_xyz)
    found = _nearest(np.hypot(*(pixels - mouse).T), is_chosen[flat.owners], VERTEX_PX)
    if found >= 0:
        owner = int(flat.owners[found])
        vertex = found - int(flat.first_vertices[owner])
        return FeatureHit(flat.shapes[owner].feature.id, vertex=vertex)
    ends = projection.segments_on_screen(flat.local_xyz, flat.segments)
    away = _distances(ends[:, 0], ends[:, 1], mouse)
    found = _nearest(away, is_chosen[flat.segment_owners], SEGMENT_PX)
    if found < 0:
        return FeatureHit()
    owner = int(flat.segment_owners[found])
    segment = int(flat.segments[found, 0] - flat.first_vertices[owner])
    return FeatureHit(flat.shapes[owner].feature.id, segment=segment)


def features_within(flat: FlatShapes, projection: Projection, outline: QPolygonF) -> frozenset[str]:
    """Ids of the features that lie wholly inside an outline in the picture."""
    if not flat.shapes:
        return frozenset()
    pixels, _ = projection.to_screen(flat.local_xyz)
    is_outside = ~are_inside(pixels, outline)
    outside = np.bincount(flat.owners, weights=is_outside, minlength=len(flat.shapes))
    counts = np.bincount(flat.owners, minlength=len(flat.shapes))
    inside = np.flatnonzero((outside == 0) & (counts > 0))
    return frozenset(flat.shapes[number].feature.id for number in inside)


def _nearest(away: Floats, is_chosen: NDArray[np.bool_], within_px: float) -> int:
    near = np.flatnonzero(away <= within_px)  # NaN isn't
    if not near.size:
        return -1
    return int(near[np.lexsort((away[near], ~is_chosen[near]))[0]])


def _distances(starts: Floats, ends: Floats, mouse: Floats) -> Floats:
    """(n,) distances of a pixel from segments."""
    along = ends - starts
    squared = np.maximum((along**2).sum(axis=1), 1e-12)
    share = np.clip(((mouse - starts) * along).sum(axis=1) / squared, 0.0, 1.0)
    away: Floats = np.hypot(*(starts + share[:, None] * along - mouse).T)
    return away
