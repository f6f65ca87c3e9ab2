"""FeatureMarks: symbols of point features and squares of vertices, in screen pixels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen

from processing.core.arrays import Floats
from widgets.feature_drawing.crowded_marks import marks_to_paint
from widgets.feature_drawing.feature_style import FeatureStyle
from widgets.feature_drawing.symbol_pictures import SYMBOL_PX, SymbolPictures

_VERTEX_PX = 7.0
_DISC_PX = 9.0
_RING_PX = 28.0


class FeatureMarks:
    """Paints marks; makes each symbol once."""

    def __init__(self) -> None:
        self._symbols = SymbolPictures()
        self._discs: dict[tuple[FeatureStyle, float], QImage] = {}

    def paint(
        self,
        painter: QPainter,
        spots: Floats,
        style: FeatureStyle,
        *,
        is_point: bool,
        hollow: NDArray[np.bool_] | None = None,
    ) -> None:
        """Paint the symbols of points, and squares where vertices are shown.

        Parameters
        ----------
        spots : (n, 2) float64
            Pixels of the widget; NaN where there is nothing to paint.
        hollow : (n,) bool or None
            Vertices whose squares are open: no measured point is there.
        """
        if not (is_point or style.has_vertices):
            return
        device = painter.device()
        ratio = device.devicePixelRatioF()
        symbol = self._symbols.picture(style.symbol, style.colour, ratio) if is_point else None
        disc = self._disc(style, ratio) if is_point and symbol is None else None
        is_open = np.zeros(len(spots), bool) if hollow is None else hollow
        shown = marks_to_paint(spots, device.width(), device.height())
        squares: dict[bool, list[QRectF]] = {False: [], True: []}
        for (x, y), is_hollow in zip(spots[shown].tolist(), is_open[shown].tolist(), strict=True):
            if symbol is not None:
                _paint_picture(painter, x, y, symbol, style)
            elif disc is not None:
                painter.drawImage(QPointF(x - SYMBOL_PX / 2, y - SYMBOL_PX / 2), disc)
            side = _RING_PX - 4 if is_point else _VERTEX_PX
            squares[is_point or is_hollow].append(_box(x, y, side))
        if style.has_vertices:
            for is_empty, boxes in squares.items():
                _paint_squares(painter, boxes, style, is_open=is_empty)
        painter.setBrush(Qt.BrushStyle.NoBrush)

    def _disc(self, style: FeatureStyle, ratio: float) -> QImage:
        """What stands for a kind without a symbol, painted once: there may be thousands."""
        key = style, ratio
        if key not in self._discs:
            side = round(SYMBOL_PX * ratio)
            image = QImage(side, side, QImage.Format.Format_ARGB32_Premultiplied)
            image.fill(Qt.GlobalColor.transparent)
            image.setDevicePixelRatio(ratio)
            with QPainter(image) as painter:
                painter.setRenderHint(QPainter.RenderHint.Antialiasing)
                _paint_disc(painter, _box(SYMBOL_PX / 2, SYMBOL_PX / 2, _DISC_PX), style)
            self._discs[key] = image
        return self._discs[key]


def _box(x: float, y: float, side: float) -> QRectF:
    return QRectF(x - side / 2, y - side / 2, side, side)


def _paint_squares(
    painter: QPainter, boxes: list[QRectF], style: FeatureStyle, *, is_open: bool
) -> None:
    painter.setBrush(Qt.BrushStyle.NoBrush if is_open else QColor(style.colour))
    for pen in (QPen(style.halo_pen().color(), 3.5), QPen(QColor("#ffffff"), 1.25)):
        painter.setPen(pen)
        painter.drawRects(boxes)


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
