"""Ruler: metres along the drive at the edge of the picture; a scan has none to show."""

from __future__ import annotations

import math

import numpy as np
from PySide6.QtCore import QLineF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget
from typing_extensions import override

from processing.recording.kinds import ImageKind
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.image_view.orientation.viewport import Viewport

_LABEL_EVERY_PX = 96.0
_BACKGROUND = QColor("#1b1e23")
_INK = QColor("#b9c0c9")
_MINOR = QColor("#5b636d")


class Ruler(QWidget):
    """Shows where along the vehicle's path the picture is, by the stations of sections."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._picture: OrientedImage | None = None
        self._viewport = Viewport()
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)

    def show_part(self, picture: OrientedImage | None, viewport: Viewport) -> None:
        """Measure this part of this picture."""
        self._picture, self._viewport = picture, viewport
        self.update()

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        picture = self._picture
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), _BACKGROUND)
            # A pixel of a scan is an angle; how wide that is on the ground differs by place.
            is_measured = picture is not None and picture.image.kind is not ImageKind.SCAN
            if picture is not None and is_measured and picture.orientation.length_m > 0:
                self._paint_ticks(painter, picture)

    def _paint_ticks(self, painter: QPainter, picture: OrientedImage) -> None:
        span = self._viewport.span
        ends = np.clip([span.left, span.right], 0.0, picture.size[0])
        start_m, end_m = picture.orientation.station_m(ends).tolist()
        shown_px = (ends[1] - ends[0]) * self._viewport.zoom_u
        if end_m <= start_m or shown_px <= 0:
            return
        step_m = round_step((end_m - start_m) / shown_px * _LABEL_EVERY_PX)
        fifths = np.arange(math.ceil(start_m / step_m * 5), math.floor(end_m / step_m * 5) + 1)
        positions = picture.orientation.rows_at_stations(fifths * step_m / 5)
        digits = max(0, -math.floor(math.log10(step_m)))
        room_px, height = self._turn(painter)
        for fifth, position in zip(fifths.tolist(), positions.tolist(), strict=True):
            x = self._along(position)
            is_labelled = fifth % 5 == 0
            painter.setPen(QPen(_INK if is_labelled else _MINOR, 1.0))
            painter.drawLine(QLineF(x, height - (8 if is_labelled else 4), x, height))
            if is_labelled:
                label = f"{fifth * step_m / 5:,.{digits}f} m"
                box = QRectF(x + 4, 0, _LABEL_EVERY_PX, height - 2)
                if x + 4 + painter.fontMetrics().horizontalAdvance(label) <= room_px:
                    painter.drawText(box, Qt.AlignmentFlag.AlignVCenter, label)

    def _turn(self, painter: QPainter) -> tuple[float, float]:
        """Turn what is painted, so that it is read upwards; gives length and breadth of the band.

        The ticks' end stays beside the picture.
        """
        if not self._viewport.orientation.is_vertical:
            return float(self.width()), float(self.height())
        painter.translate(0.0, float(self.height()))
        painter.rotate(-90.0)
        return float(self.height()), float(self.width())

    def _along(self, position: float) -> float:
        """Where a place along the drive is on the band."""
        x, y = self._viewport.position_of(position, 0.0)
        return float(self.height()) - y if self._viewport.orientation.is_vertical else x


def round_step(least: float) -> float:
    """The smallest of 1, 2, 5 × 10^k that is not less."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= least * 0.999)
