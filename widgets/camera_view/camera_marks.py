"""What the camera view paints over the image that isn't part of the map."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen, QPolygonF

_LINE = QColor("#f0e442")
_HALO = QColor(0, 0, 0, 160)
_WORDS, _BEHIND_WORDS = QColor("#e6edf3"), QColor(20, 22, 26, 200)
_PAD_X, _PAD_Y, _EDGE = 8.0, 4.0, 8.0
_FARTHEST_PX = 20_000.0


def paint_line_of_sight(painter: QPainter, line: NDArray[np.float64]) -> None:
    """A line of sight as another image sees it, (n, 2) px; broken at NaN."""
    is_shown = np.asarray((np.abs(line) < _FARTHEST_PX).all(axis=1))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    for pen in (QPen(_HALO, 3.5), QPen(_LINE, 1.5)):
        pen.setCosmetic(True)
        painter.setPen(pen)
        for run in np.split(np.arange(len(line)), np.flatnonzero(np.diff(is_shown)) + 1):
            if is_shown[run[0]]:
                painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in line[run].tolist()]))


def paint_marked(painter: QPainter, spot: NDArray[np.float64]) -> None:
    """The pixel that was clicked first, px."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    middle = QPointF(float(spot[0]), float(spot[1]))
    for pen in (QPen(_HALO, 3.5), QPen(_LINE, 1.5)):
        painter.setPen(pen)
        painter.drawEllipse(middle, 7.0, 7.0)
        painter.drawLine(middle - QPointF(11, 0), middle - QPointF(4, 0))
        painter.drawLine(middle + QPointF(4, 0), middle + QPointF(11, 0))
        painter.drawLine(middle - QPointF(0, 11), middle - QPointF(0, 4))
        painter.drawLine(middle + QPointF(0, 4), middle + QPointF(0, 11))


def paint_remarks(painter: QPainter, area: QRectF, lines: list[str]) -> None:
    """Lines of words at the lower left, broken where they are too long."""
    metrics = QFontMetricsF(painter.font())
    flags = int(Qt.AlignmentFlag.AlignLeft | Qt.TextFlag.TextWordWrap)
    room = area.width() - 2 * _EDGE - 2 * _PAD_X
    bottom = area.bottom() - _EDGE
    for line in reversed(lines):
        words = metrics.boundingRect(QRectF(0, 0, room, 1000.0), flags, line)
        box = QRectF(
            area.left() + _EDGE,
            bottom - words.height() - 2 * _PAD_Y,
            words.width() + 2 * _PAD_X,
            words.height() + 2 * _PAD_Y,
        )
        painter.fillRect(box, _BEHIND_WORDS)
        painter.setPen(_WORDS)
        painter.drawText(box.adjusted(_PAD_X, _PAD_Y, 2.0, 0.0), flags, line)
        bottom = box.top() - 2.0
