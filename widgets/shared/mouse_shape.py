"""MouseShape: what the mouse looks like over a view: a cross, or the circle that is searched."""

from __future__ import annotations

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QCursor, QPainter, QPen, QPixmap

from widgets.shared.snap_state import SnapMode

_SIDE_PX = 31
_SEARCHING = frozenset({SnapMode.LOWEST, SnapMode.HIGHEST})


def drawing_cursor(modes: frozenset[SnapMode], radius_px: float) -> QCursor:
    """A cross; with the lowest or the highest point wanted, a circle of what is searched."""
    if not modes & _SEARCHING:
        return QCursor(Qt.CursorShape.CrossCursor)
    picture = QPixmap(_SIDE_PX, _SIDE_PX)
    picture.fill(Qt.GlobalColor.transparent)
    middle = QPointF(_SIDE_PX / 2, _SIDE_PX / 2)
    with QPainter(picture) as painter:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for pen in (QPen(QColor(0, 0, 0, 200), 3.0), QPen(QColor("#ffffff"), 1.25)):
            painter.setPen(pen)
            painter.drawEllipse(middle, radius_px, radius_px)
            painter.drawPoint(middle)
    return QCursor(picture, _SIDE_PX // 2, _SIDE_PX // 2)
