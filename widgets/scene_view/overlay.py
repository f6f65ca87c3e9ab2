"""SceneOverlay: what is painted over the 3D picture without drawing the cloud again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget
from typing_extensions import override

from processing.project.catalogue import Catalogue, Geometry
from widgets.scene_view.map.feature_shapes import local_places, segments_of
from widgets.scene_view.projection import Projection
from widgets.shared.feature_style import ACCENT, CURSOR_COLOUR, FeatureStyle, sketch_style
from widgets.shared.sketch import Drawing

Floats = NDArray[np.float64]

_GAP_PX, _ARM_PX = 4.0, 14.0
_TRAIL_PX = 72.0
_VERTEX_PX = 7.0
_WORDS = QColor("#c9d1d9")


@dataclass(frozen=True)
class OverlayContent:
    """What there is to paint.

    Attributes
    ----------
    origin : (3,) float64
        The view's local origin, m, project CRS.
    cursor, cursor_before : (3,) float64 or None
        Where the shared cursor is and was, metres from the origin.
    box : QRectF or None
        The rectangle that is being drawn.
    words : str
        A line in the middle: why there is nothing to see.
    """

    origin: Floats
    catalogue: Catalogue
    drawing: Drawing | None = None
    cursor: Floats | None = None
    cursor_before: Floats | None = None
    box: QRectF | None = None
    words: str = ""


class SceneOverlay(QWidget):
    """Lies over the picture and lets the mouse through."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._projection: Projection | None = None
        self._content: OverlayContent | None = None
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)

    def show_content(self, projection: Projection, content: OverlayContent) -> None:
        """Paint this from now on."""
        self._projection, self._content = projection, content
        self.update()

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        projection, content = self._projection, self._content
        if projection is None or content is None:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
        if content.words:
            painter.setPen(_WORDS)
            area = QRectF(self.rect()).adjusted(24, 24, -24, -24)
            flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
            painter.drawText(area, flags, content.words)
        if content.drawing is not None:
            _paint_drawing(painter, projection, content, content.drawing)
        if content.cursor is not None:
            _paint_cursor(painter, projection, content.cursor, content.cursor_before)
        if content.box is not None:
            painter.setPen(QPen(ACCENT, 1.0))
            fill = QColor(ACCENT)
            fill.setAlpha(40)
            painter.setBrush(fill)
            painter.drawRect(content.box)
        painter.end()


def _paint_drawing(
    painter: QPainter, projection: Projection, content: OverlayContent, drawing: Drawing
) -> None:
    style = sketch_style(content.catalogue, drawing.kind)
    places = local_places(drawing.vertices, content.origin)
    is_edited = bool(drawing.replaces)
    shape = drawing.geometry if is_edited else Geometry.LINE
    lines = _lines(projection, places, segments_of(shape, len(places)))
    for pen in (style.halo_pen(), style.pen()):
        painter.setPen(pen)
        painter.drawLines(lines)
    if drawing.preview is not None and len(places):
        preview = local_places((drawing.preview,), content.origin)
        way = [places[-1], preview[0]]
        if drawing.geometry is Geometry.AREA and len(places) > 1:
            way.append(places[0])
        to_preview = _lines(projection, np.array(way), segments_of(Geometry.LINE, len(way)))
        dashes = QPen(ACCENT, 1.25)
        dashes.setDashPattern([4.0, 3.0])
        for pen in (QPen(QColor(0, 0, 0, 150), 3.0), dashes):
            painter.setPen(pen)
            painter.drawLines(to_preview)
    _paint_vertices(painter, projection, places, style)


def _paint_vertices(
    painter: QPainter, projection: Projection, places: Floats, style: FeatureStyle
) -> None:
    painter.setPen(QPen(QColor(0, 0, 0, 190), 1.5))
    painter.setBrush(QColor(style.colour))
    pixels, _ = projection.to_screen(places)
    for x, y in pixels[np.isfinite(pixels[:, 0])].tolist():
        half = _VERTEX_PX / 2
        painter.drawRect(QRectF(x - half, y - half, _VERTEX_PX, _VERTEX_PX))


def _lines(projection: Projection, places: Floats, ends: NDArray[np.int64]) -> list[QLineF]:
    pixels = projection.segments_on_screen(places, ends).reshape(-1, 4)
    return [QLineF(*line) for line in pixels[np.isfinite(pixels).all(axis=1)].tolist()]


def _paint_cursor(
    painter: QPainter, projection: Projection, cursor: Floats, before: Floats | None
) -> None:
    pixels, _ = projection.to_screen(np.stack([cursor, cursor if before is None else before]))
    (x, y), (x_before, y_before) = pixels.tolist()
    if not np.isfinite(x):
        return
    if np.isfinite(x_before):
        _paint_trail(painter, QPointF(x, y), QPointF(x_before, y_before))
    arms = [
        QLineF(x + dx * _GAP_PX, y + dy * _GAP_PX, x + dx * _ARM_PX, y + dy * _ARM_PX)
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1))
    ]
    for pen in (QPen(QColor(0, 0, 0, 200), 4.0), QPen(CURSOR_COLOUR, 1.75)):
        painter.setPen(pen)
        painter.drawLines(arms)


def _paint_trail(painter: QPainter, now: QPointF, before: QPointF) -> None:
    """Fading away towards where the cursor was."""
    way = QLineF(now, before)
    length = way.length()
    if length < 20.0:
        return
    reach = min(length, _TRAIL_PX)
    for step in range(4):
        colour = QColor(CURSOR_COLOUR)
        colour.setAlpha(150 - 35 * step)
        painter.setPen(QPen(colour, 1.5))
        begin = max(_ARM_PX, reach * step / 4) / length
        end = reach * (step + 1) / 4 / length
        if end > begin:
            painter.drawLine(QLineF(way.pointAt(begin), way.pointAt(end)))
