"""Painting features and the sketch over the tiles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPainter

from processing.core.arrays import Floats
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Position, Vertex
from widgets.feature_drawing.crowded_marks import FEW
from widgets.feature_drawing.feature_style import colour_of_kind, sketch_style, style_of
from widgets.feature_drawing.own_point_marks import OwnPointPlaces, paint_own_points
from widgets.feature_drawing.screen_marks import preview_pens
from widgets.image_view.features.feature_positions import FeaturePositions
from widgets.image_view.features.marks import MarkPainter
from widgets.image_view.features.picture_feature import (
    PictureFeature,
    path_of_segments,
    segments_between,
)
from widgets.image_view.orientation.oriented_image import OrientedImage, Span
from widgets.image_view.orientation.viewport import Viewport
from widgets.shared.sketch import Drawing
from widgets.shared.view_settings import ViewSettings

_MARGIN_PX = 16.0
_MOST_SMOOTH = 300
"""More features than these are painted without smoothed edges, four times as fast."""


def hollow_of(vertices: tuple[Vertex, ...]) -> NDArray[np.bool_]:
    """(n,) which vertices rest on no measured point."""
    return np.array([vertex.is_occluded for vertex in vertices], dtype=bool)


def _segments_in(viewport: Viewport, segments: Floats) -> Floats:
    """Those whose bounds touch the window."""
    seen = viewport.span_with(_MARGIN_PX)
    low = np.minimum(segments[:, :2], segments[:, 2:4])
    high = np.maximum(segments[:, :2], segments[:, 2:4])
    touches = (low <= (seen.right, seen.bottom)) & (high >= (seen.left, seen.top))
    inside: Floats = segments[touches.all(axis=1)]
    return inside


class FeatureOverlay:
    """Paints what the map holds, the same look in every view.

    Parameters
    ----------
    positions : FeaturePositions
    settings : ViewSettings
        What is shown.
    chosen : OwnPointPlaces
    """

    def __init__(
        self, positions: FeaturePositions, settings: ViewSettings, chosen: OwnPointPlaces
    ) -> None:
        self._positions = positions
        self._chosen = chosen
        self._settings = settings
        self._marks = MarkPainter()
        self.selected: frozenset[str] = frozenset()

    def shown_in(self, span: Span, replaced: str = "") -> list[PictureFeature]:
        """The features that touch a part of the picture and are shown, the chosen ones last."""
        found = self._positions.within(span)
        shown = [
            one for one in found if one.feature.id != replaced and self._settings.shows(one.feature)
        ]
        return sorted(shown, key=lambda one: one.feature.id in self.selected)

    def paint(
        self, painter: QPainter, viewport: Viewport, catalogue: Catalogue, drawing: Drawing | None
    ) -> None:
        """Paint features, without the one that is being edited."""
        replaced = "" if drawing is None else drawing.replaces
        shown = self.shown_in(viewport.span_with(_MARGIN_PX), replaced)
        for feature in self._chosen.features():
            spots = viewport.to_screen(self._positions.own_places(feature))
            paint_own_points(painter, spots, colour_of_kind(catalogue, feature.kind))
        is_smooth = len(shown) <= _MOST_SMOOTH
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, is_smooth)
        for one in shown:
            is_selected = one.feature.id in self.selected
            style = style_of(catalogue, one.feature, is_selected=is_selected)
            is_area = one.feature.geometry is Geometry.AREA
            self._marks.paint_line(painter, one.path, viewport, style, is_area=is_area)
            is_point = one.feature.geometry is Geometry.POINT
            hollow = hollow_of(one.feature.vertices) if is_selected else None
            self._marks.paint_marks(
                painter, one.positions, viewport, style, is_point=is_point, hollow=hollow
            )

    def paint_sketch(
        self,
        painter: QPainter,
        viewport: Viewport,
        picture: OrientedImage,
        *,
        catalogue: Catalogue,
        drawing: Drawing,
    ) -> None:
        """Paint what is being drawn, and thinly where the next click would lead."""
        style = sketch_style(catalogue, drawing.kind)
        vertices = self._positions.places_of(drawing.vertices)
        shape = drawing.geometry if drawing.replaces else Geometry.LINE
        seen = _segments_in(viewport, segments_between(vertices, shape, picture))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, len(seen) <= FEW)
        path = path_of_segments(seen)
        self._marks.paint_line(painter, path, viewport, style, is_area=False)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
        if drawing.preview and vertices.size:
            self._paint_preview(painter, viewport, picture, drawing, vertices)
        is_point = drawing.geometry is Geometry.POINT
        hollow = hollow_of(drawing.vertices)
        self._marks.paint_marks(
            painter, vertices, viewport, style, is_point=is_point, hollow=hollow
        )

    def screen_position(self, viewport: Viewport, xyz: Position) -> tuple[float, float] | None:
        """Where a place is in the window; None where no point of the drive is near it."""
        u, v = self._positions.places_of((Vertex(xyz),))[0].tolist()
        return viewport.position_of(u, v) if np.isfinite(u) else None

    def _paint_preview(
        self,
        painter: QPainter,
        viewport: Viewport,
        picture: OrientedImage,
        drawing: Drawing,
        vertices: Floats,
    ) -> None:
        line = [vertices[-1], *self._positions.places_of(drawing.preview)]
        if drawing.geometry is Geometry.AREA and vertices.shape[0] > 1:
            line.append(vertices[0])
        path = path_of_segments(segments_between(np.array(line), Geometry.LINE, picture))
        screen = viewport.transform().map(path)
        for pen in preview_pens():
            painter.strokePath(screen, pen)
