"""Marks over a picture, in screen pixels: the same look in every view."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen, QPolygonF

from widgets.feature_drawing.feature_style import ACCENT, CURSOR_COLOUR
from widgets.shared.sketch import Note
from widgets.shared.snap_state import SnapMode

ScreenPoint = tuple[float, float]

SNAP_COLOUR = QColor("#ffd23f")
_SHADOW = QColor(0, 0, 0, 200)
_PLATE = QColor(16, 18, 22, 205)
_INK = QColor("#eef2f6")
_COMING = QColor("#8fc6ff")
"""Paler than what is chosen: it reads on dark points, on its shadow on bright ones."""

_GAP_PX, _ARM_PX = 4.0, 14.0
_TRAIL_PX = 72.0
_SNAP_PX = 6.0


def paint_cross(painter: QPainter, at: ScreenPoint, before: ScreenPoint | None) -> None:
    """The shared cursor: a cross with a gap in its middle, and a trail to where it was."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    x, y = at
    if before is not None:
        _paint_trail(painter, QPointF(x, y), QPointF(*before))
    arms = [
        QLineF(x + dx * _GAP_PX, y + dy * _GAP_PX, x + dx * _ARM_PX, y + dy * _ARM_PX)
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1))
    ]
    for pen in (QPen(_SHADOW, 4.0), QPen(CURSOR_COLOUR, 1.75)):
        painter.setPen(pen)
        painter.drawLines(arms)


def paint_outline(painter: QPainter, outline: QPolygonF) -> None:
    """The rectangle or the lasso that is being drawn."""
    fill = QColor(ACCENT)
    fill.setAlpha(40)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=False)
    painter.setPen(QPen(ACCENT, 1.0, Qt.PenStyle.DashLine))
    painter.setBrush(fill)
    painter.drawPolygon(outline)
    painter.setBrush(Qt.BrushStyle.NoBrush)


def paint_snap(painter: QPainter, at: ScreenPoint, mode: SnapMode, name: str) -> None:
    """Where the next click would land: a sign for what it is drawn to, and its name."""
    x, y = at
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for pen in (QPen(_SHADOW, 4.5), QPen(SNAP_COLOUR, 2.0)):
        painter.setPen(pen)
        _SIGNS[mode](painter, x, y)
    _paint_plate(painter, x + 2 * _SNAP_PX, y - 2 * _SNAP_PX, name)


def preview_pens() -> tuple[QPen, QPen]:
    """The dark line below and the dashes of where the next click would lead."""
    dashes = QPen(_COMING, 1.75)
    dashes.setCapStyle(Qt.PenCapStyle.FlatCap)
    dashes.setDashPattern([4.0, 2.0])
    return QPen(_SHADOW, 3.5), dashes


def paint_note(painter: QPainter, at: ScreenPoint, note: Note) -> None:
    """A short text beside a place."""
    _paint_plate(painter, at[0] + 14.0, at[1] + 22.0, note.text)


def _paint_plate(painter: QPainter, x: float, y: float, text: str) -> None:
    if not text:
        return
    metrics = QFontMetricsF(painter.font())
    width, height = metrics.horizontalAdvance(text) + 8.0, metrics.height() + 2.0
    room = painter.viewport()
    left = min(x, room.right() - width)
    top = max(min(y - height / 2, room.bottom() - height), 0.0)
    plate = QRectF(left, top, width, height)
    painter.fillRect(plate, _PLATE)
    painter.setPen(_INK)
    painter.drawText(plate, int(Qt.AlignmentFlag.AlignCenter), text)


def _paint_trail(painter: QPainter, now: QPointF, before: QPointF) -> None:
    """Fading away towards where the cursor was."""
    way = QLineF(now, before)
    length = way.length()
    if length < 20.0:
        return
    reach = min(length, _TRAIL_PX)
    for step in range(4):
        colour = QColor(CURSOR_COLOUR)
        colour.setAlpha(165 - 40 * step)
        painter.setPen(QPen(colour, 1.5))
        begin = max(_ARM_PX, reach * step / 4) / length
        end = reach * (step + 1) / 4 / length
        if end > begin:
            painter.drawLine(QLineF(way.pointAt(begin), way.pointAt(end)))


def _square(painter: QPainter, x: float, y: float) -> None:
    painter.drawRect(QRectF(x - _SNAP_PX, y - _SNAP_PX, 2 * _SNAP_PX, 2 * _SNAP_PX))


def _diagonals(painter: QPainter, x: float, y: float) -> None:
    s = _SNAP_PX
    painter.drawLines([QLineF(x - s, y - s, x + s, y + s), QLineF(x - s, y + s, x + s, y - s)])


def _hourglass(painter: QPainter, x: float, y: float) -> None:
    s = _SNAP_PX
    corners = [(-s, -s), (s, -s), (-s, s), (s, s)]
    painter.drawPolygon(QPolygonF([QPointF(x + dx, y + dy) for dx, dy in corners]))


def _dashes(painter: QPainter, x: float, y: float) -> None:
    s = _SNAP_PX
    painter.drawLines([QLineF(x + at, y, x + at + s / 2, y) for at in (-1.5 * s, -0.25 * s, s)])


def _triangle(sense: float) -> Callable[[QPainter, float, float], None]:
    def paint(painter: QPainter, x: float, y: float) -> None:
        s = _SNAP_PX * sense
        corners = [(-s, -s), (s, -s), (0.0, s)]
        painter.drawPolygon(QPolygonF([QPointF(x + dx, y + dy) for dx, dy in corners]))

    return paint


def _step(painter: QPainter, x: float, y: float) -> None:
    s = _SNAP_PX
    corners = [(-1.5 * s, -s), (0.0, -s), (0.0, s), (1.5 * s, s)]
    painter.drawPolyline(QPolygonF([QPointF(x + dx, y + dy) for dx, dy in corners]))


_SIGNS: dict[SnapMode, Callable[[QPainter, float, float], None]] = {
    SnapMode.VERTEX: _square,
    SnapMode.CROSSING: _diagonals,
    SnapMode.LINE: _hourglass,
    SnapMode.EXTENSION: _dashes,
    SnapMode.LOWEST: _triangle(1.0),
    SnapMode.HIGHEST: _triangle(-1.0),
    SnapMode.EDGE: _step,
}
