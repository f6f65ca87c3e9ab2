"""DensityView: how densely a vehicle measures walls and road beside it, with the scale."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QLocale, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QImage, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget
from typing_extensions import override

from processing.core.text import Language
from processing.laboratory.simulate.scanning.density import DensityMap
from processing.laboratory.simulate.scanning.density_files import (
    DECADES,
    LEAST,
    MOST,
    density_colours,
)

_STEP_M = 5
_SCALE_PX = 14
_SCALE_STEPS = 128


class DensityView(QWidget):
    """Walls along the road above, the road below; the mouse tells the figures of a place.

    Parameters
    ----------
    language : Language
        By which numbers are written.
    """

    def __init__(self, language: Language, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._locale = QLocale(language)
        self._density: DensityMap | None = None
        self._wall, self._road, self._scale = QImage(), QImage(), QImage()
        self.setMouseTracking(True)
        self.setMinimumSize(380, 260)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    @property
    def density(self) -> DensityMap | None:
        """What is shown."""
        return self._density

    def show_density(self, density: DensityMap) -> None:
        """Show a density map from now on."""
        self._density = density
        # What is left of the vehicle is left in the picture.
        self._wall = _image_of(density_colours(density.wall[::-1, ::-1]))
        self._road = _image_of(density_colours(density.road[None, ::-1]))
        steps = np.geomspace(MOST, LEAST, _SCALE_STEPS)
        self._scale = _image_of(density_colours(steps)[:, None])
        self.update()

    def told_at(self, position: QPointF) -> str:
        """What is said of a place in the widget; empty where there is nothing."""
        density, (wall, road) = self._density, self._fields()
        if density is None:
            return ""
        field = next((one for one in (wall, road) if one.contains(position)), None)
        if field is None:
            return ""
        share = (field.right() - position.x()) / field.width()
        column = min(int(share * density.across_m.size), density.across_m.size - 1)
        side = abs(float(density.across_m[column]))
        is_left = float(density.across_m[column]) > 0
        if field is road:
            reported = (
                self.tr("Road, {side} m to the left: {density} points/m², {gap} cm between points")
                if is_left
                else self.tr(
                    "Road, {side} m to the right: {density} points/m², {gap} cm between points"
                )
            )
            value, gap = float(density.road[column]), 100 * float(density.spacing_m[column])
        else:
            reported = (
                self.tr("Wall {side} m to the left, {up} m up: {density} points/m²")
                if is_left
                else self.tr("Wall {side} m to the right, {up} m up: {density} points/m²")
            )
            row = int((field.bottom() - position.y()) / field.height() * density.up_m.size)
            row = min(row, density.up_m.size - 1)
            value, gap = float(density.wall[row, column]), math.nan
            if math.isnan(value):
                return self.tr("Here the vehicle drives.")
        up = (field.bottom() - position.y()) / field.height() * float(density.up_m[-1])
        return reported.format(
            side=f"{side:.1f}", up=f"{up:.1f}", density=self._number(value), gap=f"{gap:.1f}"
        )

    @override
    def sizeHint(self) -> QSize:
        return QSize(560, 340)

    @override
    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        reported = self.told_at(event.position())
        QToolTip.showText(event.globalPosition().toPoint(), reported, self)

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        if self._density is None:
            return
        painter = QPainter(self)
        wall, road = self._fields()
        for field, picture, name in (
            (wall, self._wall, self.tr("Walls along the road, by distance and height")),
            (road, self._road, self.tr("Road, by distance from the vehicle")),
        ):
            line = painter.fontMetrics().height()
            above = QRectF(field.left(), field.top() - line - 3, field.width(), line)
            painter.drawText(above, int(Qt.AlignmentFlag.AlignLeft), name)
            painter.drawImage(field, picture)
            self._mark_across(painter, field)
        self._mark_up(painter, wall)
        self._paint_scale(painter, wall, road)
        painter.end()

    def _fields(self) -> tuple[QRectF, QRectF]:
        """Where walls and road are painted."""
        line = float(self.fontMetrics().height())
        left, right = 2.6 * line, self.fontMetrics().horizontalAdvance("10,000") + 3.0 * line
        width = self.width() - left - right
        height = self.height() - 5.2 * line - 6
        wall = QRectF(left, 1.2 * line, width, 0.72 * height)
        road = QRectF(left, wall.bottom() + 2.6 * line, width, 0.28 * height)
        return wall, road

    def _mark_across(self, painter: QPainter, field: QRectF) -> None:
        line = painter.fontMetrics().height()
        half_m = round(abs(float(self._across()[0])))
        for metres in range(-half_m, half_m + 1, _STEP_M):
            x = field.left() + (half_m - metres) / (2 * half_m) * field.width()
            painter.drawLine(QPointF(x, field.bottom()), QPointF(x, field.bottom() + 3))
            position = QRectF(x - 2 * line, field.bottom() + 3, 4 * line, line)
            words = f"{abs(metres)} m" if metres in (-half_m, half_m) else f"{abs(metres)}"
            painter.drawText(position, int(Qt.AlignmentFlag.AlignHCenter), words)

    def _mark_up(self, painter: QPainter, field: QRectF) -> None:
        line = painter.fontMetrics().height()
        most_m = round(float(self._up()[-1]))
        middle = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        for metres in range(0, most_m + 1, _STEP_M):
            y = field.bottom() - metres / most_m * field.height()
            painter.drawLine(QPointF(field.left() - 3, y), QPointF(field.left(), y))
            position = QRectF(0, y - line / 2, field.left() - 5, line)
            painter.drawText(position, int(middle), f"{metres} m" if metres else "0")

    def _paint_scale(self, painter: QPainter, wall: QRectF, road: QRectF) -> None:
        line = painter.fontMetrics().height()
        left = wall.right() + line
        bar = QRectF(left, wall.top() + line / 2, _SCALE_PX, road.bottom() - wall.top() - line / 2)
        painter.drawImage(bar, self._scale)
        unit = QRectF(wall.right() - 4 * line, 0, self.width() - wall.right() + 4 * line, line)
        painter.drawText(unit, int(Qt.AlignmentFlag.AlignRight), self.tr("points/m²"))
        for decade in DECADES:
            y = bar.top() + math.log(MOST / decade) / math.log(MOST / LEAST) * bar.height()
            painter.drawLine(QPointF(bar.right(), y), QPointF(bar.right() + 3, y))
            position = QRectF(bar.right() + 6, y - line / 2, self.width() - bar.right() - 6, line)
            painter.drawText(position, int(Qt.AlignmentFlag.AlignVCenter), self._number(decade))

    def _across(self) -> NDArray[np.float64]:
        return np.zeros(1) if self._density is None else self._density.across_m

    def _up(self) -> NDArray[np.float64]:
        return np.zeros(1) if self._density is None else self._density.up_m

    def _number(self, value: float) -> str:
        return self._locale.toString(round(value)) if value >= 10 else f"{value:.2g}"


def _image_of(colours: NDArray[np.uint8]) -> QImage:
    whole = np.ascontiguousarray(colours)
    height, width, _ = whole.shape
    picture = QImage(whole.tobytes(), width, height, 3 * width, QImage.Format.Format_RGB888)
    return picture.copy()  # of its own, where the bytes above are not
