"""The frame of a section: heights at its left, metres at its bottom, a title above."""

from __future__ import annotations

import math
from dataclasses import dataclass

from PySide6.QtCore import QLineF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen

from processing.section.cut import Cut
from widgets.plane_view.viewport import PlaneViewport
from widgets.section_view.picture.projection import SectionProjection

LEFT_PX, BOTTOM_PX = 60.0, 22.0
"""Room that the rulers take."""

_BAND = QColor("#1b1e23")
_INK = QColor("#b9c0c9")
_MINOR = QColor("#5b636d")
_GRID = QColor(255, 255, 255, 26)
_MIDDLE = QColor(255, 255, 255, 70)
_PLATE = QColor(16, 18, 22, 205)
_WORDS = QColor("#eef2f6")
_EVERY_X_PX, _EVERY_Y_PX = 72.0, 40.0
_FIFTHS = 5
_SEPARATOR = " · "


@dataclass(frozen=True)
class FrameWords:
    """What is written round a section.

    Attributes
    ----------
    title : tuple of str
        What matters most first; what there is no room for is left out.
    left, right : str
        What lies at the two ends of the ruler.
    """

    title: tuple[str, ...]
    left: str
    right: str


def paint_frame(painter: QPainter, viewport: PlaneViewport, cut: Cut, words: FrameWords) -> None:
    """Paint rulers with a faint grid, and the title."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=False)
    width, height = float(viewport.width), float(viewport.height)
    bottom = height - BOTTOM_PX
    painter.fillRect(QRectF(0.0, 0.0, LEFT_PX, height), _BAND)
    painter.fillRect(QRectF(0.0, bottom, width, BOTTOM_PX), _BAND)
    _paint_heights(painter, viewport, cut)
    _paint_offsets(painter, viewport, words)
    _paint_title(painter, viewport, words.title)


def round_step(least: float) -> float:
    """The smallest of 1, 2, 5 × 10^k that is not less."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= least * 0.999)


def _paint_heights(painter: QPainter, viewport: PlaneViewport, cut: Cut) -> None:
    bottom = viewport.height - BOTTOM_PX
    projection = SectionProjection(cut)
    low, high = (projection.height_of(viewport.to_plane(0.0, y)[1]) for y in (bottom, 0.0))
    per_m = bottom / max(high - low, 1e-9)
    step = round_step(_EVERY_Y_PX / per_m)
    digits = max(1, -math.floor(math.log10(step) + 1e-9))
    first, last = math.ceil(low / step * _FIFTHS), math.floor(high / step * _FIFTHS)
    for fifth in range(first, last + 1):
        y = bottom - (fifth * step / _FIFTHS - low) * per_m
        is_labelled = fifth % _FIFTHS == 0
        painter.setPen(QPen(_INK if is_labelled else _MINOR, 1.0))
        painter.drawLine(QLineF(LEFT_PX - (8 if is_labelled else 4), y, LEFT_PX, y))
        if not is_labelled:
            continue
        painter.setPen(_INK)
        box = QRectF(0.0, y - 10.0, LEFT_PX - 11.0, 20.0)
        if box.bottom() <= bottom + 8.0 and box.top() >= -2.0:
            flags = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            painter.drawText(box, flags, f"{fifth * step / _FIFTHS:.{digits}f}")
        painter.setPen(QPen(_GRID, 1.0))
        painter.drawLine(QLineF(LEFT_PX, y, viewport.width, y))


def _paint_offsets(painter: QPainter, viewport: PlaneViewport, words: FrameWords) -> None:
    bottom, width = viewport.height - BOTTOM_PX, float(viewport.width)
    left_m, right_m = (viewport.to_plane(x, 0.0)[0] for x in (LEFT_PX, width))
    per_m = (width - LEFT_PX) / max(right_m - left_m, 1e-9)
    step = round_step(_EVERY_X_PX / per_m)
    digits = max(0, -math.floor(math.log10(step) + 1e-9))
    metrics = QFontMetricsF(painter.font())
    from_x = LEFT_PX + metrics.horizontalAdvance(words.left) + 12.0
    to_x = width - metrics.horizontalAdvance(words.right) - 12.0
    first, last = math.ceil(left_m / step * _FIFTHS), math.floor(right_m / step * _FIFTHS)
    for fifth in range(first, last + 1):
        x = LEFT_PX + (fifth * step / _FIFTHS - left_m) * per_m
        is_labelled = fifth % _FIFTHS == 0
        painter.setPen(QPen(_INK if is_labelled else _MINOR, 1.0))
        painter.drawLine(QLineF(x, bottom, x, bottom + (6 if is_labelled else 3)))
        if not is_labelled:
            continue
        painter.setPen(QPen(_MIDDLE if fifth == 0 else _GRID, 1.0))
        painter.drawLine(QLineF(x, 0.0, x, bottom))
        offset = fifth * step / _FIFTHS
        label = f"{offset:.{digits}f}".replace("-", "−") if fifth else "0 m"
        half = metrics.horizontalAdvance(label) / 2
        if from_x <= x - half and x + half <= to_x:
            painter.setPen(_INK)
            box = QRectF(x - half - 4.0, bottom + 4.0, 2 * half + 8.0, BOTTOM_PX - 4.0)
            painter.drawText(box, int(Qt.AlignmentFlag.AlignCenter), label)
    _paint_ends(painter, words, QRectF(LEFT_PX, bottom + 4.0, width - LEFT_PX, BOTTOM_PX - 4.0))


def _paint_ends(painter: QPainter, words: FrameWords, band: QRectF) -> None:
    painter.setPen(_INK)
    middle = Qt.AlignmentFlag.AlignVCenter
    inner = band.adjusted(6.0, 0.0, -6.0, 0.0)
    painter.drawText(inner, int(Qt.AlignmentFlag.AlignLeft | middle), words.left)
    painter.drawText(inner, int(Qt.AlignmentFlag.AlignRight | middle), words.right)


def _paint_title(painter: QPainter, viewport: PlaneViewport, title: tuple[str, ...]) -> None:
    metrics = QFontMetricsF(painter.font())
    room = viewport.width - LEFT_PX - 24.0
    longer = (_SEPARATOR.join(title[:count]) for count in range(len(title), 1, -1))
    whole = next((one for one in longer if metrics.horizontalAdvance(one) <= room), title[0])
    shown = metrics.elidedText(whole, Qt.TextElideMode.ElideRight, room)
    plate = QRectF(
        LEFT_PX + 6.0, 6.0, metrics.horizontalAdvance(shown) + 12.0, metrics.height() + 4.0
    )
    painter.fillRect(plate, _PLATE)
    painter.setPen(_WORDS)
    painter.drawText(plate, int(Qt.AlignmentFlag.AlignCenter), shown)
