"""Marks: lines, vertices, symbols and the cursor's cross, in screen pixels at any zoom."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QImage, QPainter, QPainterPath, QPen

from widgets.image_view.viewport import Viewport
from widgets.shared.feature_style import FeatureStyle
from widgets.shared.symbol_pictures import SYMBOL_PX, SymbolPictures

Floats = NDArray[np.float64]

_VERTEX_PX = 7.0
_DISC_PX = 9.0
_RING_PX = 28.0
_FILL_ALPHA = 34
_TRAIL_PX = 72.0


class MarkPainter:
    """Paints features; makes each pen and each symbol once."""

    def __init__(self) -> None:
        self._pens: dict[FeatureStyle, tuple[QPen, QPen]] = {}
        self._symbols = SymbolPictures()

    def paint_line(
        self,
        painter: QPainter,
        path: QPainterPath,
        viewport: Viewport,
        style: FeatureStyle,
        *,
        is_area: bool,
    ) -> None:
        """Paint a path in picture coordinates: halo, then line; areas are filled lightly."""
        if path.isEmpty():
            return
        if style not in self._pens:
            self._pens[style] = style.halo_pen(), style.pen()
        # Mapped first: the pen's width then counts screen pixels in both directions.
        screen = viewport.transform().map(path)
        if is_area:
            fill = QColor(style.colour)
            fill.setAlpha(_FILL_ALPHA)
            painter.fillPath(screen, QBrush(fill))
        for pen in self._pens[style]:
            painter.strokePath(screen, pen)

    def paint_marks(
        self,
        painter: QPainter,
        places: Floats,
        viewport: Viewport,
        style: FeatureStyle,
        *,
        is_point: bool,
    ) -> None:
        """Paint the symbols of points, and squares where vertices are shown."""
        if not (is_point or style.has_vertices):
            return
        ratio = painter.device().devicePixelRatioF()
        symbol = self._symbols.picture(style.symbol, style.colour, ratio) if is_point else None
        for x, y in viewport.to_screen(places[np.isfinite(places[:, 0])]).tolist():
            if symbol is not None:
                _paint_picture(painter, x, y, symbol, style)
            elif is_point:
                _paint_disc(painter, _box(x, y, _DISC_PX), style)
            if style.has_vertices:
                side = _RING_PX - 4 if is_point else _VERTEX_PX
                _paint_square(painter, _box(x, y, side), style, is_open=is_point)
        painter.setBrush(Qt.BrushStyle.NoBrush)


def _box(x: float, y: float, side: float) -> QRectF:
    return QRectF(x - side / 2, y - side / 2, side, side)


def _paint_square(painter: QPainter, box: QRectF, style: FeatureStyle, *, is_open: bool) -> None:
    painter.setBrush(Qt.BrushStyle.NoBrush if is_open else QColor(style.colour))
    painter.setPen(QPen(style.halo_pen().color(), 3.5))
    painter.drawRect(box)
    painter.setPen(QPen(QColor("#ffffff"), 1.25))
    painter.drawRect(box)


def _paint_picture(
    painter: QPainter, x: float, y: float, symbol: QImage, style: FeatureStyle
) -> None:
    """A survey symbol; candidates stand in a dashed ring."""
    painter.drawImage(QPointF(x - SYMBOL_PX / 2, y - SYMBOL_PX / 2), symbol)
    if style.is_dashed:
        painter.setBrush(Qt.BrushStyle.NoBrush)
        ring = _box(x, y, _RING_PX)
        for pen in (QPen(style.halo_pen().color(), 1.0 + 2 * style.halo_px), style.pen()):
            painter.setPen(pen)
            painter.drawEllipse(ring)


def _paint_disc(painter: QPainter, box: QRectF, style: FeatureStyle) -> None:
    """What stands for a kind without a symbol; candidates have an open one."""
    halo = style.halo_pen().color()
    painter.setPen(QPen(halo, 2.0 + 2 * style.halo_px))
    painter.setBrush(halo)
    painter.drawEllipse(box)
    painter.setPen(QPen(QColor(style.colour), 2.0))
    painter.setBrush(Qt.BrushStyle.NoBrush if style.is_dashed else QColor(style.colour))
    painter.drawEllipse(box)


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
    reach = min(length, _TRAIL_PX)
    for step in range(4):
        faded = QColor(colour)
        faded.setAlpha(180 - 45 * step)
        painter.setPen(QPen(faded, 1.5))
        start, end = (16 + (reach - 16) * share / 4 for share in (step, step + 1))
        painter.drawLine(
            QPointF(*(np.array(now) + direction * start)),
            QPointF(*(np.array(now) + direction * end)),
        )
