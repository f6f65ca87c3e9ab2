"""Which feature is under a pixel, and which an outline encloses, wherever they are projected to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPolygonF

from processing.core.arrays import Floats, Integers
from widgets.feature_drawing.feature_shapes import FlatShapes
from widgets.feature_drawing.outlines import are_inside

VERTEX_PX = 8.0
SEGMENT_PX = 6.0


@dataclass(frozen=True)
class FeatureHit:
    """A feature under the mouse; ``vertex`` or ``segment`` is −1."""

    feature: str = ""
    vertex: int = -1
    segment: int = -1


def vertex_at(
    flat: FlatShapes, pixels: Floats, mouse: tuple[float, float], selected: frozenset[str]
) -> FeatureHit | None:
    """The nearest vertex within reach of a pixel, one of a chosen feature before others.

    Parameters
    ----------
    pixels : (n, 2) float64
        Of the vertices of ``flat``; NaN for those that aren't in the picture.
    """
    is_chosen = _are_chosen(flat, selected)
    away = np.hypot(*(pixels - np.array(mouse)).T)
    found = _nearest(away, is_chosen[flat.owners], VERTEX_PX)
    if found < 0:
        return None
    owner = int(flat.owners[found])
    return FeatureHit(flat.shapes[owner].feature.id, vertex=found - int(flat.first_vertices[owner]))


def segment_at(
    flat: FlatShapes,
    pieces: Floats,
    numbers: Integers,
    mouse: tuple[float, float],
    selected: frozenset[str],
) -> FeatureHit | None:
    """The nearest segment within reach of a pixel, one of a chosen feature before others.

    Parameters
    ----------
    pieces : (k, 2, 2) float64
        Pixels of both ends of straight pieces; NaN for those that aren't in the picture.
    numbers : (k,) int64
        The segment of ``flat`` that each piece is a part of.
    """
    is_chosen = _are_chosen(flat, selected)
    owners = flat.segment_owners[numbers]
    away = _distances(pieces[:, 0], pieces[:, 1], np.array(mouse))
    found = _nearest(away, is_chosen[owners], SEGMENT_PX)
    if found < 0:
        return None
    owner = int(owners[found])
    first = int(flat.segments[numbers[found], 0])
    segment = first - int(flat.first_vertices[owner])
    return FeatureHit(flat.shapes[owner].feature.id, segment=segment)


def features_inside(flat: FlatShapes, pixels: Floats, outline: QPolygonF) -> frozenset[str]:
    """Ids of the features whose vertices all lie in an outline.

    Parameters
    ----------
    pixels : (n, 2) float64
        Of the vertices of ``flat``; NaN for those that aren't in the picture.
    """
    if not flat.shapes:
        return frozenset()
    is_outside = ~are_inside(pixels, outline)
    outside = np.bincount(flat.owners, weights=is_outside, minlength=len(flat.shapes))
    counts = np.bincount(flat.owners, minlength=len(flat.shapes))
    inside = np.flatnonzero((outside == 0) & (counts > 0))
    return frozenset(flat.shapes[number].feature.id for number in inside)


def _are_chosen(flat: FlatShapes, selected: frozenset[str]) -> NDArray[np.bool_]:
    return np.array([shape.feature.id in selected for shape in flat.shapes], dtype=bool)


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
