"""DeliveryMap: where the files of an import lie, drawn small."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QLineF, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget
from typing_extensions import override

_SIDE_PX = 190
_MARGIN_PX = 14
_GROUND = QColor("#14161a")
_POINTS = (QColor("#56b4e9"), QColor("#e69f00"), QColor("#009e73"), QColor("#cc79a7"))
"""After Okabe and Ito: told apart by colour-blind eyes."""
_WAY = QColor("#f0e442")
_IMAGE = QColor("#ffffff")
_WORDS = QColor("#d0d4da")
_NICE = (1.0, 2.0, 5.0)


@dataclass(frozen=True)
class DeliveryShapes:
    """What is drawn; metres, east and north.

    Attributes
    ----------
    extents : sequence of (4,) float
        Of point files: lowest east and north, highest east and north.
    ways, images : sequence of (n, 2) float64
        Trajectories as lines, places of images as dots.
    """

    extents: Sequence[tuple[float, float, float, float]] = ()
    ways: Sequence[NDArray[np.float64]] = ()
    images: Sequence[NDArray[np.float64]] = ()

    def corners(self) -> NDArray[np.float64]:
        """All places, (n, 2)."""
        extents = [np.array(one).reshape(2, 2) for one in self.extents]
        parts = [one for one in (*extents, *self.ways, *self.images) if len(one)]
        return np.vstack(parts) if parts else np.zeros((0, 2))


class DeliveryMap(QWidget):
    """Extents of points, trajectories and images from above, north up, with a scale."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._shapes = DeliveryShapes()
        self.setFixedSize(_SIDE_PX * 3 // 2, _SIDE_PX)

    @property
    def shapes(self) -> DeliveryShapes:
        """What is drawn now."""
        return self._shapes

    def show_shapes(self, shapes: DeliveryShapes) -> None:
        """Draw these from now on."""
        self._shapes = shapes
        self.update()

    @override
    def sizeHint(self) -> QSize:
        return self.size()

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), _GROUND)
            corners = self._shapes.corners()
            if len(corners):
                painter.setRenderHint(QPainter.RenderHint.Antialiasing)
                self._draw(painter, corners)

    def _draw(self, painter: QPainter, corners: NDArray[np.float64]) -> None:
        low, high = corners.min(axis=0), corners.max(axis=0)
        room = np.array([self.width(), self.height()]) - 2.0 * _MARGIN_PX
        scale = float((room / np.maximum(high - low, 1e-3)).min())
        middle = (low + high) / 2

        def spot(place: NDArray[np.float64]) -> QPointF:
            east, north = (place - middle) * scale
            return QPointF(self.width() / 2 + float(east), self.height() / 2 - float(north))

        for number, extent in enumerate(self._shapes.extents):
            first, last = np.array(extent).reshape(2, 2)
            colour = _POINTS[number % len(_POINTS)]
            painter.setPen(QPen(colour, 1.5))
            filled = QColor(colour)
            filled.setAlpha(50)
            painter.setBrush(filled)
            painter.drawRect(QRectF(spot(first), spot(last)).normalized())
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(_WAY, 2))
        for way in self._shapes.ways:
            painter.drawPolyline(QPolygonF([spot(one) for one in way]))
        painter.setPen(QPen(_IMAGE, 4, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        for places in self._shapes.images:
            painter.drawPoints(QPolygonF([spot(one) for one in places]))
        self._draw_scale(painter, scale)

    def _draw_scale(self, painter: QPainter, scale: float) -> None:
        widest_m = self.width() / 3 / scale
        power = 10.0 ** np.floor(np.log10(widest_m))
        length_m = max(step * power for step in _NICE if step * power <= widest_m)
        below = self.height() - 5.0
        painter.setPen(QPen(_WORDS, 1.5))
        painter.drawLine(QLineF(6.0, below, 6.0 + length_m * scale, below))
        painter.drawText(QPointF(6.0, below - 4), f"{length_m:g} m")
