"""SceneOverlay: what is painted over the 3D picture without drawing the cloud again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QLineF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget
from typing_extensions import override

from processing.core.arrays import Floats
from processing.core.text import Language
from processing.map.catalogue import Catalogue, Geometry
from widgets.feature_drawing.crowded_marks import FEW, marks_to_paint
from widgets.feature_drawing.feature_shapes import local_positions, segments_of
from widgets.feature_drawing.feature_style import FeatureStyle, sketch_style
from widgets.feature_drawing.screen_marks import (
    paint_cross,
    paint_note,
    paint_outline,
    paint_snap,
    preview_pens,
)
from widgets.scene_view.rendering.projection import SceneProjection
from widgets.shared.sketch import Drawing
from widgets.shared.snap_state import SNAP_NAMES, SnapMark

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
    outline : QPolygonF or None
        The rectangle or the lasso that is being drawn.
    snap : SnapMark or None
        Where the next click would land.
    language : Language
        Of the mark's name.
    words : str
        A line in the middle: why there is nothing to see.
    """

    origin: Floats
    catalogue: Catalogue
    drawing: Drawing | None = None
    cursor: Floats | None = None
    cursor_before: Floats | None = None
    outline: QPolygonF | None = None
    snap: SnapMark | None = None
    language: Language = "en"
    words: str = ""


class SceneOverlay(QWidget):
    """Lies over the picture and lets the mouse through."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._projection: SceneProjection | None = None
        self._content: OverlayContent | None = None
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)

    def show_content(self, projection: SceneProjection, content: OverlayContent) -> None:
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
        _paint_marks(painter, projection, content)
        if content.outline is not None:
            paint_outline(painter, content.outline)
        painter.end()


def _paint_marks(painter: QPainter, projection: SceneProjection, content: OverlayContent) -> None:
    """The cursor, notes beside the drawing, and where the next click would land."""
    cursor = None if content.cursor is None else _pixel(projection, content.cursor)
    if cursor is not None:
        before = content.cursor_before
        paint_cross(painter, cursor, None if before is None else _pixel(projection, before))
    notes = () if content.drawing is None else content.drawing.notes
    for note in notes:
        at = _pixel(projection, np.array(note.xyz) - content.origin)
        if at is not None:
            paint_note(painter, at, note)
    snap = content.snap
    at = None if snap is None else _pixel(projection, np.array(snap.xyz) - content.origin)
    if snap is not None and at is not None:
        paint_snap(painter, at, snap.mode, SNAP_NAMES[snap.mode].in_language(content.language))


def _paint_drawing(
    painter: QPainter, projection: SceneProjection, content: OverlayContent, drawing: Drawing
) -> None:
    style = sketch_style(content.catalogue, drawing.kind)
    positions = local_positions(drawing.vertices, content.origin)
    is_edited = bool(drawing.replaces)
    shape = drawing.geometry if is_edited else Geometry.LINE
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, len(positions) <= FEW)
    lines = _lines(projection, positions, segments_of(shape, len(positions)))
    for pen in (style.halo_pen(), style.pen()):
        painter.setPen(pen)
        painter.drawLines(lines)
    if drawing.preview and len(positions):
        vehicle_path = [positions[-1], *local_positions(drawing.preview, content.origin)]
        if drawing.geometry is Geometry.AREA and len(positions) > 1:
            vehicle_path.append(positions[0])
        to_preview = _lines(
            projection, np.array(vehicle_path), segments_of(Geometry.LINE, len(vehicle_path))
        )
        for pen in preview_pens():
            painter.setPen(pen)
            painter.drawLines(to_preview)
    hollow = [vertex.is_occluded for vertex in drawing.vertices]
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    _paint_vertices(painter, projection, positions, style, hollow)


def _paint_vertices(
    painter: QPainter,
    projection: SceneProjection,
    positions: Floats,
    style: FeatureStyle,
    hollow: list[bool],
) -> None:
    """Squares; open ones where no measured point is."""
    pixels, _ = projection.to_screen(positions)
    half = _VERTEX_PX / 2
    for index in marks_to_paint(pixels, painter.device().width(), painter.device().height()):
        (x, y), is_hollow = pixels[index].tolist(), hollow[index]
        ink = QColor(style.colour) if is_hollow else QColor(0, 0, 0, 190)
        painter.setPen(QPen(ink, 1.5))
        painter.setBrush(Qt.BrushStyle.NoBrush if is_hollow else QColor(style.colour))
        painter.drawRect(QRectF(x - half, y - half, _VERTEX_PX, _VERTEX_PX))


def _lines(projection: SceneProjection, positions: Floats, ends: NDArray[np.int64]) -> list[QLineF]:
    pixels = projection.segments_on_screen(positions, ends).reshape(-1, 4)
    return [QLineF(*line) for line in pixels[np.isfinite(pixels).all(axis=1)].tolist()]


def _pixel(projection: SceneProjection, local: Floats) -> tuple[float, float] | None:
    """Where a place is in the picture; None behind the camera."""
    pixels, _ = projection.to_screen(local[None])
    x, y = pixels[0].tolist()
    return (x, y) if np.isfinite(x) else None
