"""The key to the colours of points: a bar of heights, or a swatch for each meaning."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QColor, QImage, QPainter

from processing.core.text import Language, Text
from processing.image.attributes.attributes import height_ends_m
from processing.image.attributes.colour_maps import (
    SHAPE_COLOURS,
    confidence_ramp,
    height_ramp,
    normal_ramp,
)
from processing.recording.drive import Drive

_PLATE = QColor(16, 18, 22, 190)
_INK = QColor("#d5dae0")
_BAR_PX, _HIGH_PX, _GAP_PX = 150.0, 10.0, 8.0
_ENDS = {
    "normal": (Text("upright", "鉛直面"), Text("level", "水平面")),
    "confidence": (Text("doubtful", "低い"), Text("sure", "高い")),
}
_RAMPS = {"height": height_ramp, "normal": normal_ramp, "confidence": confidence_ramp}
_SHAPES = (Text("line", "線状"), Text("plane", "面状"), Text("scattered", "散乱"))


def paint_colour_key(
    painter: QPainter,
    corner: QPointF,
    drive: Drive,
    attribute: str,
    percents: tuple[float, float],
    *,
    language: Language,
) -> QRectF:
    """Paint what colours mean with the lower right corner here; gives the room it took.

    Parameters
    ----------
    attribute : str
        What points are coloured by; without a key of its own nothing is painted.
    percents : tuple of float
        Between which percentiles colours are shared out.
    """
    if attribute == "shape":
        return _paint_swatches(painter, corner, language)
    if attribute not in _RAMPS:
        return QRectF(corner, corner)
    if attribute == "height":
        low, high = (f"{value:,.2f} m" for value in height_ends_m(drive, percents))
    else:
        low, high = (end.in_language(language) for end in _ENDS[attribute])
    metrics = painter.fontMetrics()
    low_px, high_px = metrics.horizontalAdvance(low), metrics.horizontalAdvance(high)
    plate = _plate(painter, corner, low_px + high_px + _BAR_PX + 4 * _GAP_PX)
    base = plate.bottom() - 2 - metrics.descent()
    left = plate.left() + _GAP_PX
    painter.setPen(_INK)
    painter.drawText(QPointF(left, base), low)
    bar = QRectF(left + low_px + _GAP_PX, plate.center().y() - _HIGH_PX / 2, _BAR_PX, _HIGH_PX)
    ramp = _RAMPS[attribute]().copy()
    image = QImage(ramp.data, len(ramp), 1, 3 * len(ramp), QImage.Format.Format_RGB888)
    painter.drawImage(bar, image)
    painter.drawText(QPointF(bar.right() + _GAP_PX, base), high)
    return plate


def _paint_swatches(painter: QPainter, corner: QPointF, language: Language) -> QRectF:
    metrics = painter.fontMetrics()
    names = [name.in_language(language) for name in _SHAPES]
    widths = [metrics.horizontalAdvance(name) + _HIGH_PX + 2 * _GAP_PX for name in names]
    plate = _plate(painter, corner, sum(widths) + _GAP_PX)
    left = plate.left() + _GAP_PX
    painter.setPen(_INK)
    for name, wide, colour in zip(names, widths, SHAPE_COLOURS, strict=True):
        swatch = QRectF(left, plate.center().y() - _HIGH_PX / 2, _HIGH_PX, _HIGH_PX)
        painter.fillRect(swatch, QColor(*colour))
        base = plate.bottom() - 2 - metrics.descent()
        painter.drawText(QPointF(swatch.right() + _GAP_PX / 2, base), name)
        left += wide
    return plate


def _plate(painter: QPainter, corner: QPointF, wide: float) -> QRectF:
    high = painter.fontMetrics().height() + 4.0
    plate = QRectF(corner.x() - wide, corner.y() - high, wide, high)
    painter.fillRect(plate, _PLATE)
    return plate
