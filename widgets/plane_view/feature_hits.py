"""PlaneHits: from pixels of a plane view to hits that mouse tools understand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Protocol

import numpy as np
import shapely
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QPolygonF

from processing.core.arrays import Floats
from processing.map.catalogue import Geometry
from widgets.feature_drawing.feature_hits import (
    SEGMENT_PX,
    FeatureHit,
    features_inside,
    segment_at,
    vertex_at,
)
from widgets.mouse_tools.gesture import REACH_PX
from widgets.mouse_tools.mouse_tool import EnclosedHits, Hit
from widgets.plane_view.projected_map import PlaneFeatures
from widgets.plane_view.projection import PlanePoint, PlaneProjection
from widgets.plane_view.viewport import PlaneViewport
from widgets.shared.cursor import PickedPosition

EnclosedPoints = Mapping[str, NDArray[np.int64]]


class PointLocator(Protocol):
    """The view that knows which measured points are where."""

    def position_at(
        self, position: PlanePoint, reach: float, *, exact: bool
    ) -> PickedPosition | None:
        """The measured point at a place of the plane."""

    def points_inside(self, outline: QPolygonF) -> EnclosedPoints:
        """The measured points in an outline in the widget."""

    def finder_inside(self, outline: QPolygonF) -> Callable[[], EnclosedPoints] | None:
        """What looks up all of them; None where those are all."""


class PlaneHits:
    """What is in the picture now; the view keeps it up to date.

    Parameters
    ----------
    measured : PointLocator

    Attributes
    ----------
    projection : PlaneProjection or None
    features : PlaneFeatures or None
        What is drawn.
    viewport : PlaneViewport
    selected : frozenset of str
        Chosen features, which are hit before others.
    """

    def __init__(self, measured: PointLocator) -> None:
        self._measured = measured
        self.projection: PlaneProjection | None = None
        self.features: PlaneFeatures | None = None
        self.viewport = PlaneViewport()
        self.selected: frozenset[str] = frozenset()

    def exact_hit(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> Hit:
        """What is under a pixel, among all measured points."""
        return self._hit(position, modifiers, is_exact=True)

    def quick_hit(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> Hit:
        """What is under a pixel, among the points that are drawn."""
        return self._hit(position, modifiers, is_exact=False)

    def enclosed(self, outline: QPolygonF, modifiers: Qt.KeyboardModifier) -> EnclosedHits:
        """The features wholly inside an outline in the widget, and the points inside it."""
        features = self.features
        if self.projection is None or features is None:
            return EnclosedHits(frozenset(), {}, modifiers)
        pixels = self.viewport.to_screen(features.positions)
        pixels[~features.is_near] = np.nan
        inside = features_inside(features.flat, pixels, outline)
        measured = self._measured
        return EnclosedHits(
            inside, measured.points_inside(outline), modifiers, measured.finder_inside(outline)
        )

    def _hit(self, mouse: QPointF, modifiers: Qt.KeyboardModifier, *, is_exact: bool) -> Hit:
        projection, viewport = self.projection, self.viewport
        if projection is None:
            return Hit(None, modifiers=modifiers)
        spot = viewport.to_plane(mouse.x(), mouse.y())
        reach = REACH_PX / viewport.scale
        position = self._measured.position_at(spot, reach, exact=is_exact)
        feature = self._feature_at((mouse.x(), mouse.y()))
        return Hit(
            position,
            feature.feature,
            feature.vertex,
            feature.segment,
            modifiers,
            reach_m=projection.reach_m(spot, reach, None if position is None else position.xyz),
            ray=projection.ray(spot),
        )

    def _feature_at(self, mouse: tuple[float, float]) -> FeatureHit:
        """Vertices go before segments, those before the inside of an area, chosen ones first."""
        features, viewport = self.features, self.viewport
        if features is None or not features.shapes:
            return FeatureHit()
        pixels = viewport.to_screen(features.positions)
        pixels[~features.is_near] = np.nan
        found = vertex_at(features.flat, pixels, mouse, self.selected)
        if found is not None:
            return found
        # Only what comes near the mouse is measured; a map has very many pieces.
        reach = np.array([SEGMENT_PX / viewport.scale, SEGMENT_PX / viewport.scale_y])
        spot = np.array(viewport.to_plane(*mouse))
        low, high = features.pieces.min(axis=1), features.pieces.max(axis=1)
        near = np.flatnonzero(((low <= spot + reach) & (high >= spot - reach)).all(axis=1))
        found = segment_at(
            features.flat,
            viewport.to_screen(features.pieces[near]),
            features.piece_numbers[near],
            mouse,
            self.selected,
        )
        return found or self._area_at(features, spot)

    def _area_at(self, features: PlaneFeatures, spot: Floats) -> FeatureHit:
        found = ""
        for one in features.shapes:
            feature, bounds = one.shape.feature, one.bounds
            if feature.geometry is not Geometry.AREA or bounds is None or not one.is_whole:
                continue
            if not ((bounds[:2] <= spot).all() and (spot <= bounds[2:]).all()):
                continue
            is_better = not found or feature.id in self.selected
            if is_better and _holds(one.pieces[:, 0], spot):
                found = feature.id
        return FeatureHit(found)


def _holds(ring: Floats, spot: Floats) -> bool:
    area = shapely.make_valid(shapely.Polygon(ring)) if len(ring) > 2 else shapely.Polygon()
    return bool(shapely.intersects_xy(area, *spot.tolist()))
