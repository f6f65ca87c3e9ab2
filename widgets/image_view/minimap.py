"""Minimap: the whole drive as a strip, with the part that the view shows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QSizeF, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget
from typing_extensions import override

from processing.image.attributes.tile_cache import TileCache
from widgets.feature_drawing.feature_style import ACCENT
from widgets.image_view.mosaic import Mosaic
from widgets.image_view.orientation.oriented_image import OrientedImage, Span
from widgets.image_view.orientation.viewport import Viewport
from widgets.image_view.tile_images import TileImages
from widgets.shared.image_orientation import ImageOrientation
from widgets.shared.view_settings import PointStyle

_LIMIT_BYTES = 16 * 2**20
_BACKGROUND = QColor("#101216")
_SHADE = QColor(0, 0, 0, 110)


class Minimap(QWidget):
    """The drive from end to end; a press or a drag moves the view there.

    Signals
    -------
    position_chosen(u: float)
        A place along the picture.
    """

    position_chosen = Signal(float)

    def __init__(self, tiles: TileCache, parent: QWidget) -> None:
        super().__init__(parent)
        self._images = TileImages(tiles, limit_bytes=_LIMIT_BYTES)
        self._images.changed.connect(self.update)
        self._mosaic = Mosaic(self._images)
        self._picture: OrientedImage | None = None
        self._shown = (0.0, 0.0)
        self._orientation = ImageOrientation()
        self.setToolTip(self.tr("The whole recording; click or drag to go there"))

    def show_picture(self, picture: OrientedImage | None, look: PointStyle) -> None:
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

    def mark(self, left: float, right: float, orientation: ImageOrientation) -> None:
        """Mark the part from one place to another, picture coordinates."""
        if (left, right, orientation) != (*self._shown, self._orientation):
            self._shown, self._orientation = (left, right), orientation
            self.update()

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        picture = self._picture
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), _BACKGROUND)
            if picture is not None:
                viewport = self._viewport(picture)
                self._mosaic.paint(painter, picture, viewport)
                self._paint_part(painter, viewport)

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
            mouse = event.position()
            position, _ = self._viewport(picture).to_picture(mouse.x(), mouse.y())
            self.position_chosen.emit(min(max(position, 0.0), float(picture.size[0])))

    def _viewport(self, picture: OrientedImage) -> Viewport:
        """The whole picture, pressed into the strip."""
        u, v = picture.size
        strip = Viewport(
            max(self.width(), 1),
            max(self.height(), 1),
            (max(u, 1), max(v, 1)),
            centre=(u / 2, v / 2),
            orientation=self._orientation,
        )
        zoom_v = strip.across_px / max(v, 1)
        return replace(strip, zoom=zoom_v, stretch=strip.along_px / max(u, 1) / zoom_v)

    def _paint_part(self, painter: QPainter, viewport: Viewport) -> None:
        (u, v), (start, end) = viewport.extent, self._shown
        start, end = min(max(start, 0.0), u), min(max(end, 0.0), u)
        painter.fillRect(viewport.rectangle_of(Span(0.0, 0.0, start, v)), _SHADE)
        painter.fillRect(viewport.rectangle_of(Span(end, 0.0, u, v)), _SHADE)
        frame = viewport.rectangle_of(Span(start, 0.0, end, v)).adjusted(1, 1, -1, -1)
        frame.setSize(frame.size().expandedTo(QSizeF(4.0, 4.0)))
        painter.setPen(QPen(ACCENT, 2.0))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(frame)
