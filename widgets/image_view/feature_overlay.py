"""Painting features and the sketch over the tiles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QPainter, QPainterPath, QPen, QTransform

from processing.project.catalogue import Catalogue, Geometry
from widgets.image_view.feature_places import FeaturePlaces
from widgets.image_view.picture import Picture
from widgets.image_view.placed_feature import (
    PlacedFeature,
    path_of_segments,
    segments_between,
)
from widgets.image_view.viewport import Viewport
from widgets.shared.feature_style import ACCENT, FeatureStyle, sketch_style, style_of
from widgets.shared.sketch import Drawing

Floats = NDArray[np.float64]

_MARGIN_PX = 16.0
_VERTEX_PX = 7.0
_SYMBOL_PX = 9.0
_FILL_ALPHA = 34


class FeatureOverlay:
    """Paints what the map holds, the same look in every view.

    Parameters
    ----------
    places : FeaturePlaces
    """

    def __init__(self, places: FeaturePlaces) -> None:
        self._places = places
        self.selected: frozenset[str] = frozenset()
        self.hidden_kinds: frozenset[str] = frozenset()

    def visible(self, viewport: Viewport, replaced: str = "") -> list[PlacedFeature]:
        """The features in the window that are shown, the chosen ones last."""
        span = viewport.span
        u, v = _MARGIN_PX / viewport.zoom_u, _MARGIN_PX / viewport.zoom_v
        found = self._places.within(span.left - u, span.top - v, span.right + u, span.bottom + v)
        shown = [
            one
            for one in found
            if one.feature.kind not in self.hidden_kinds and one.feature.id != replaced
        ]
        return sorted(shown, key=lambda one: one.feature.id in self.selected)

    def paint(
        self, painter: QPainter, viewport: Viewport, catalogue: Catalogue, drawing: Drawing | None
    ) -> None:
        """Paint features, without the one that is being edited."""
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
        for one in self.visible(viewport, "" if drawing is None else drawing.replaces):
            is_selected = one.feature.id in self.selected
            style = style_of(catalogue, one.feature, is_selected=is_selected)
            if style.is_shown:
                is_area = one.feature.geometry is Geometry.AREA
                _paint_lines(painter, one.path, viewport, style, is_area=is_area)
                is_point = one.feature.geometry is Geometry.POINT
                _paint_marks(painter, one.places, viewport, style, is_point=is_point)

    def paint_sketch(
        self,
        painter: QPainter,
        viewport: Viewport,
        picture: Picture,
        *,
        catalogue: Catalogue,
        drawing: Drawing,
    ) -> None:
        """Paint what is being drawn, and thinly where the next click would lead."""
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
        style = sketch_style(catalogue, drawing.kind)
        vertices = self._places.places_of(drawing.vertices)
        is_edited = bool(drawing.replaces)
        shape = drawing.geometry if is_edited else Geometry.LINE
        path = path_of_segments(segments_between(vertices, shape, picture))
        _paint_lines(painter, path, viewport, style, is_area=False)
        if drawing.preview is not None and vertices.size:
            self._paint_preview(painter, viewport, picture, drawing, vertices)
        _paint_marks(
            painter, vertices, viewport, style, is_point=drawing.geometry is Geometry.POINT
        )

    def _paint_preview(
        self,
        painter: QPainter,
        viewport: Viewport,
        picture: Picture,
        drawing: Drawing,
        vertices: Floats,
    ) -> None:
        preview = () if drawing.preview is None else (drawing.preview,)
        line = [vertices[-1], self._places.places_of(preview)[0]]
        if drawing.geometry is Geometry.AREA and vertices.shape[0] > 1:
            line.append(vertices[0])
        path = path_of_segments(segments_between(np.array(line), Geometry.LINE, picture))
        _stroke(painter, path, viewport, QPen(QColor(0, 0, 0, 150), 3.0))
        pen = QPen(ACCENT, 1.25)
        pen.setDashPattern([4.0, 3.0])
        _stroke(painter, path, viewport, pen)


def _paint_lines(
    painter: QPainter,
    path: QPainterPath,
    viewport: Viewport,
    style: FeatureStyle,
    *,
    is_area: bool,
) -> None:
    if path.isEmpty():
        return
    fill = QColor(style.colour)
    fill.setAlpha(_FILL_ALPHA)
    _stroke(painter, path, viewport, style.halo_pen(), QBrush(fill) if is_area else None)
    _stroke(painter, path, viewport, style.pen())


def _stroke(
    painter: QPainter,
    path: QPainterPath,
    viewport: Viewport,
    pen: QPen,
    brush: QBrush | None = None,
) -> None:
    turned = QTransform()
    turned.translate(viewport.x_of(0.0), viewport.y_of(0.0))
    turned.scale(viewport.zoom_u, viewport.zoom_v)
    painter.setPen(pen)
    painter.setBrush(QBrush(Qt.BrushStyle.NoBrush) if brush is None else brush)
    # Mapped first: the pen's width then counts screen pixels in both directions.
    painter.drawPath(turned.map(path))


def _paint_marks(
    painter: QPainter, places: Floats, viewport: Viewport, style: FeatureStyle, *, is_point: bool
) -> None:
    if not (is_point or style.has_vertices):
        return
    painter.setBrush(QColor(style.colour))
    size = _SYMBOL_PX if is_point else _VERTEX_PX
    for x, y in viewport.to_screen(places[np.isfinite(places[:, 0])]).tolist():
        painter.setPen(QPen(QColor(0, 0, 0, style.halo_alpha), 1.5))
        box = QRectF(x - size / 2, y - size / 2, size, size)
        if is_point:
            _paint_symbol(painter, box, style)
        if style.has_vertices:
            painter.drawRect(box)


def _paint_symbol(painter: QPainter, box: QRectF, style: FeatureStyle) -> None:
    """A disc with a dot; dashed candidates get an open ring."""
    if style.is_dashed:
        painter.setBrush(QColor(0, 0, 0, style.halo_alpha))
        painter.drawEllipse(box)
        painter.setPen(QPen(QColor(style.colour), 2.0, Qt.PenStyle.DotLine))
        painter.drawEllipse(box)
        painter.setBrush(QColor(style.colour))
        return
    painter.drawEllipse(box)
    painter.setBrush(QColor(0, 0, 0, style.halo_alpha))
    painter.drawEllipse(box.center(), 1.0, 1.0)
    painter.setBrush(QColor(style.colour))


def paint_cross(
    painter: QPainter, x: float, y: float, before: tuple[float, float] | None, colour: QColor
) -> None:
    """The shared cursor: a cross with a gap in its middle, and a trail to where it was."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    if before is not None:
        _paint_trail(painter, (x, y), before, colour)
    arms = [
        (QPointF(x + dx * 4, y + dy * 4), QPointF(x + dx * 14, y + dy * 14))
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1))
    ]
    for pen in (QPen(QColor(0, 0, 0, 200), 4.0), QPen(colour, 1.75)):
        painter.setPen(pen)
        for start, end in arms:
            painter.drawLine(start, end)


def _paint_trail(
    painter: QPainter, now: tuple[float, float], before: tuple[float, float], colour: QColor
) -> None:
    way = np.array(before) - np.array(now)
    length = float(np.hypot(*way))
    if length < 20:
        return
    direction = way / length
    reach = min(length, 72.0)
    for step in range(4):
        faded = QColor(colour)
        faded.setAlpha(180 - 45 * step)
        painter.setPen(QPen(faded, 1.5))
        start, end = (16 + (reach - 16) * share / 4 for share in (step, step + 1))
        painter.drawLine(
            QPointF(*(np.array(now) + direction * start)),
            QPointF(*(np.array(now) + direction * end)),
        )
