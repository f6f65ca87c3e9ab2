"""What changes with every move of the mouse: the sketch, the cursor, the mark of a snap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter

from processing.core.arrays import Floats
from processing.core.text import Language
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Position, Vertex
from widgets.feature_drawing.crowded_marks import FEW
from widgets.feature_drawing.feature_marks import FeatureMarks
from widgets.feature_drawing.feature_shapes import local_positions, segments_of
from widgets.feature_drawing.feature_style import sketch_style
from widgets.feature_drawing.screen_marks import paint_cross, paint_note, paint_snap, preview_pens
from widgets.plane_view.feature_painter import MARGIN_PX, paint_pieces
from widgets.plane_view.line_pieces import as_lines, clip_pieces
from widgets.plane_view.projected_map import pieces_of
from widgets.plane_view.projection import PlaneProjection
from widgets.plane_view.viewport import PlaneViewport
from widgets.shared.cursor import PickedPosition
from widgets.shared.sketch import Drawing
from widgets.shared.snap_state import SNAP_NAMES, SnapMark

_NO_ORIGIN = np.zeros(3)
_WORDS = QColor("#c9d1d9")


@dataclass(frozen=True)
class LiveContent:
    """What there is to paint.

    Attributes
    ----------
    cursor, cursor_before : PickedPosition or None
        Where the shared cursor is and was.
    """

    catalogue: Catalogue
    drawing: Drawing | None
    cursor: PickedPosition | None
    cursor_before: PickedPosition | None
    snap: SnapMark | None
    language: Language


class LivePainter:
    """Paints over the still picture."""

    def __init__(self) -> None:
        self._marks = FeatureMarks()

    def paint(
        self,
        painter: QPainter,
        projection: PlaneProjection,
        viewport: PlaneViewport,
        content: LiveContent,
    ) -> None:
        """Paint the sketch, then the cursor, the notes and where the next click would land."""
        drawing = content.drawing
        if drawing is not None:
            self._paint_drawing(painter, projection, viewport, content.catalogue, drawing)
        cursor, before = content.cursor, content.cursor_before
        spot = None if cursor is None else spot_of(projection, viewport, cursor.xyz)
        if spot is not None:
            trail = None if before is None else spot_of(projection, viewport, before.xyz)
            paint_cross(painter, spot, trail)
        for note in () if drawing is None else drawing.notes:
            at = spot_of(projection, viewport, note.xyz)
            if at is not None:
                paint_note(painter, at, note)
        snap = content.snap
        at = None if snap is None else spot_of(projection, viewport, snap.xyz)
        if snap is not None and at is not None:
            paint_snap(painter, at, snap.mode, SNAP_NAMES[snap.mode].in_language(content.language))

    def _paint_drawing(
        self,
        painter: QPainter,
        projection: PlaneProjection,
        viewport: PlaneViewport,
        catalogue: Catalogue,
        drawing: Drawing,
    ) -> None:
        style = sketch_style(catalogue, drawing.kind)
        xyz = local_positions(drawing.vertices, _NO_ORIGIN)
        shape = drawing.geometry if drawing.replaces else Geometry.LINE
        pieces = _pieces(projection, viewport, xyz, shape)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, len(pieces) <= FEW)
        paint_pieces(painter, pieces, style)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
        if drawing.preview and len(xyz):
            lines = as_lines(_pieces(projection, viewport, _preview_of(drawing), Geometry.LINE))
            for pen in preview_pens():
                painter.setPen(pen)
                painter.drawLines(lines)
        if len(xyz):
            hollow = np.array([vertex.is_occluded for vertex in drawing.vertices])
            spots = viewport.to_screen(projection.to_plane(xyz))
            is_point = drawing.geometry is Geometry.POINT
            self._marks.paint(painter, spots, style, is_point=is_point, hollow=hollow)


def spot_of(
    projection: PlaneProjection, viewport: PlaneViewport, xyz: Position
) -> tuple[float, float] | None:
    """Where a place is in the widget; None where it isn't shown."""
    x, y = viewport.to_screen(projection.to_plane(np.array([xyz], dtype=np.float64)))[0].tolist()
    return (x, y) if np.isfinite(x) and np.isfinite(y) else None


def paint_words(painter: QPainter, room: QRectF, words: str) -> None:
    """Write in the middle why there is nothing to see."""
    painter.setPen(_WORDS)
    flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
    painter.drawText(room.adjusted(24, 24, -24, -24), int(flags), words)


def _pieces(
    projection: PlaneProjection, viewport: PlaneViewport, xyz: Floats, shape: Geometry
) -> Floats:
    """(k, 2, 2) px within the window."""
    pieces, _ = pieces_of(projection, xyz, segments_of(shape, len(xyz)))
    low = np.array([-MARGIN_PX, -MARGIN_PX])
    high = np.array([viewport.width + MARGIN_PX, viewport.height + MARGIN_PX])
    return clip_pieces(viewport.to_screen(pieces), low, high)[0]


def _preview_of(drawing: Drawing) -> Floats:
    """(n, 3): from the last vertex over what is coming; of an area, back to its first one."""
    way: list[Vertex] = [drawing.vertices[-1], *drawing.preview]
    if drawing.geometry is Geometry.AREA and len(drawing.vertices) > 1:
        way.append(drawing.vertices[0])
    return local_positions(way, _NO_ORIGIN)
