"""PlanPictures: the pictures that are there, painted so that the window is never blank."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QRectF
from PySide6.QtGui import QImage, QPainter, QRegion

from processing.image.from_above.plan_raster import PlanFrame
from widgets.map_view.plan_feed import ShownPlan
from widgets.plane_view.viewport import PlaneViewport


@dataclass(frozen=True, eq=False)
class _Painted:
    """A picture with what Qt paints of it; the image only borrows the picture's memory."""

    shown: ShownPlan
    image: QImage

    @property
    def frame(self) -> PlanFrame:
        return self.shown.picture.frame


class PlanPictures:
    """Keeps the last sharp picture, the one that is coming, and one of everything."""

    def __init__(self) -> None:
        self._overview: _Painted | None = None
        self._sharp: _Painted | None = None
        self._coming: _Painted | None = None

    def clear(self) -> None:
        """Forget all of them: other drives are shown."""
        self._overview = self._sharp = self._coming = None

    def take(self, shown: ShownPlan) -> None:
        """Paint this one from now on."""
        painted = _Painted(shown, _image_of(shown))
        if shown.is_overview:
            self._overview = painted
        elif shown.is_sharp:
            self._sharp, self._coming = painted, None
        else:
            self._coming = painted

    @property
    def newest(self) -> ShownPlan | None:
        """What a place of the window shows."""
        newest = self._coming or self._sharp or self._overview
        return None if newest is None else newest.shown

    def paint(self, painter: QPainter, viewport: PlaneViewport) -> None:
        """Paint what there is: coarse ones below and only where there is nothing sharper."""
        sharp, overview = self._sharp, self._overview
        if overview is not None:
            painter.save()
            if sharp is not None:
                window = QRectF(0, 0, viewport.width, viewport.height).toAlignedRect()
                inside = _on_screen(sharp.frame, viewport).toAlignedRect()
                painter.setClipRegion(QRegion(window) - QRegion(inside))
            _paint(painter, overview, viewport)
            painter.restore()
        for painted in (sharp, self._coming):
            if painted is not None:
                _paint(painter, painted, viewport)


def _image_of(shown: ShownPlan) -> QImage:
    pixels = shown.picture.pixels
    height, width = pixels.shape[:2]
    image_format = QImage.Format.Format_ARGB32_Premultiplied
    return QImage(pixels.data, width, height, 4 * width, image_format)


def _on_screen(frame: PlanFrame, viewport: PlaneViewport) -> QRectF:
    transform = viewport.transform()
    wide, high = frame.width / frame.px_per_m, frame.height / frame.px_per_m
    return transform.mapRect(QRectF(frame.west, -frame.north, wide, high))


def _paint(painter: QPainter, painted: _Painted, viewport: PlaneViewport) -> None:
    """Only the part that is seen: far in, a whole old picture would be of many windows' size."""
    frame = painted.frame
    whole = _on_screen(frame, viewport)
    part = whole.intersected(QRectF(-2, -2, viewport.width + 4, viewport.height + 4))
    if part.isEmpty():
        return
    per_px_x, per_px_y = frame.width / whole.width(), frame.height / whole.height()
    source = QRectF(
        (part.left() - whole.left()) * per_px_x,
        (part.top() - whole.top()) * per_px_y,
        part.width() * per_px_x,
        part.height() * per_px_y,
    )
    is_smaller = per_px_x > 1.01 * painter.device().devicePixelRatioF()
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, is_smaller)
    painter.drawImage(part, painted.image, source)
