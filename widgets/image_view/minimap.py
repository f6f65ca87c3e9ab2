"""Minimap: the whole drive as a strip, with the part that the view shows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget
from typing_extensions import override

from processing.image.tile_cache import TileCache
from widgets.image_view.mosaic import Mosaic
from widgets.image_view.picture import Picture
from widgets.image_view.tile_images import TileImages
from widgets.image_view.viewport import Viewport
from widgets.shared.feature_style import ACCENT
from widgets.shared.view_settings import PointLook

HEIGHT_PX = 40
_LIMIT_BYTES = 16 * 2**20
_BACKGROUND = QColor("#101216")
_SHADE = QColor(0, 0, 0, 110)


class Minimap(QWidget):
    """The drive from end to end; a press or a drag moves the view there.

    Signals
    -------
    place_chosen(u: float)
        A place along the picture.
    """

    place_chosen = Signal(float)

    def __init__(self, tiles: TileCache, parent: QWidget) -> None:
        super().__init__(parent)
        self._images = TileImages(tiles, limit_bytes=_LIMIT_BYTES)
        self._images.changed.connect(self.update)
        self._mosaic = Mosaic(self._images)
        self._picture: Picture | None = None
        self._shown = (0.0, 0.0)
        self.setToolTip(self.tr("The whole recording; click or drag to go there"))

    def show_picture(self, picture: Picture | None, look: PointLook) -> None:
        """Show a drive in a look."""
        self._picture = picture
        self._images.show(picture, look)
        self.update()

    def make_anew(self) -> None:
        """What tiles show has changed."""
        self._images.make_anew()
        self.update()

    def show_labels(self, drive_id: str, points: NDArray[np.int64]) -> None:
        """The labels of these points of a drive have changed."""
        self._images.show_labels(drive_id, points)

    def mark(self, left: float, right: float) -> None:
        """Mark the part from one place to another, picture coordinates."""
        if (left, right) != self._shown:
            self._shown = (left, right)
            self.update()

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        picture = self._picture
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), _BACKGROUND)
            if picture is not None:
                viewport = self._viewport(picture)
                self._mosaic.paint(painter, picture, viewport)
                left, right = (viewport.x_of(place) for place in self._shown)
                self._paint_part(painter, left, right)

    @override
    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._go_to(event)

    @override
    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._go_to(event)

    def _go_to(self, event: QMouseEvent) -> None:
        picture = self._picture
        if picture is not None:
            place, _ = self._viewport(picture).to_picture(event.position().x(), 0.0)
            self.place_chosen.emit(min(max(place, 0.0), float(picture.size[0])))

    def _viewport(self, picture: Picture) -> Viewport:
        """The whole picture, pressed into the strip."""
        u, v = picture.size
        width, height = max(self.width(), 1), max(self.height(), 1)
        zoom_v = height / max(v, 1)
        stretch = width / max(u, 1) / zoom_v
        return Viewport(
            width, height, (max(u, 1), max(v, 1)), stretch, zoom_v, centre=(u / 2, v / 2)
        )

    def _paint_part(self, painter: QPainter, left: float, right: float) -> None:
        height, width = float(self.height()), float(self.width())
        left, right = max(left, 0.0), min(right, width)
        painter.fillRect(QRectF(0, 0, left, height), _SHADE)
        painter.fillRect(QRectF(right, 0, width - right, height), _SHADE)
        painter.setPen(QPen(ACCENT, 2.0))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(QRectF(left + 1, 1, max(right - left - 2, 4.0), height - 2))
