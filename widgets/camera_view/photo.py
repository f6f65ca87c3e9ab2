"""Photo: the pixels of a camera image, in sizes that Qt paints quickly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QImage, QPainter

from processing.core.text import Text
from processing.recording.camera_images.image_pixels import ImagePixels
from widgets.plane_view.viewport import PlaneViewport

_SMALLEST_PX = 256


@dataclass(frozen=True, eq=False)
class Photo:
    """An image whole, at a half, a quarter and so on.

    Attributes
    ----------
    levels : tuple of QImage
        The first as read; each of the others half as wide as the one before.
    size : tuple of int
        Width and height of the listed image, to whose pixels places refer.
    note : Text or None
        What the user should know about it.
    """

    levels: tuple[QImage, ...]
    size: tuple[int, int]
    note: Text | None
    held: tuple[NDArray[np.uint8], ...]  # Qt's images only borrow these

    @property
    def bytes(self) -> int:
        """What it takes of memory."""
        return sum(level.nbytes for level in self.held)

    def paint(self, painter: QPainter, viewport: PlaneViewport) -> None:
        """Paint what a view shows of it."""
        # Middles of pixels are at whole numbers, so the image begins half a pixel before.
        whole = QRectF(-0.5, -0.5, *self.size)
        part = whole.intersected(viewport.seen)
        if part.isEmpty():
            return
        level = self._level_for(viewport.scale * painter.device().devicePixelRatioF())
        across = level.width() / self.size[0]
        down = level.height() / self.size[1]
        source = QRectF(
            (part.x() + 0.5) * across,
            (part.y() + 0.5) * down,
            part.width() * across,
            part.height() * down,
        )
        painter.setRenderHint(
            QPainter.RenderHint.SmoothPixmapTransform, on=viewport.scale / across < 2.0
        )
        target = viewport.transform().mapRect(part)
        painter.drawImage(target, level, source, Qt.ImageConversionFlag.AutoColor)

    def _level_for(self, scale: float) -> QImage:
        """The coarsest level that has at least a pixel for one of the screen."""
        wanted = self.size[0] * scale
        fine = [level for level in self.levels if level.width() >= wanted]
        return fine[-1] if fine else self.levels[0]


def photo_of(pixels: ImagePixels) -> Photo:
    """A photo from pixels; takes a while for large images."""
    import cv2

    held = [pixels.pixels]
    while max(held[-1].shape[:2]) >= 2 * _SMALLEST_PX:
        height, width = held[-1].shape[:2]
        size = max(1, width // 2), max(1, height // 2)
        smaller = cv2.resize(held[-1], size, interpolation=cv2.INTER_AREA)
        held.append(np.ascontiguousarray(smaller, dtype=np.uint8))
    levels = tuple(
        QImage(
            level.data,
            level.shape[1],
            level.shape[0],
            level.strides[0],
            QImage.Format.Format_RGB888,
        )
        for level in held
    )
    image = pixels.image
    return Photo(levels, (image.width_px, image.height_px), pixels.note, tuple(held))
