"""The reliability curve: how often a tool was right, by how sure it was; on screen and on paper.

Painted here: Qt Charts has no intervals of a value, and no map of cells for studies of two
parameters.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPalette, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget
from typing_extensions import override

from processing.scoring.points.reliability import Reliability

_STEPS = (0.0, 0.25, 0.5, 0.75, 1.0)
_STRIP = 0.16
"""The part of the height in which bars tell how many candidates there are."""


@dataclass(frozen=True)
class PlotColours:
    """What a plot is painted with: told apart by lightness, so they survive printing in grey."""

    ground: QColor
    ink: QColor
    faint: QColor
    bars: QColor
    curve: QColor

    @staticmethod
    def of(palette: QPalette) -> PlotColours:
        """Those of the window."""
        return PlotColours(
            palette.color(QPalette.ColorRole.Base),
            palette.color(QPalette.ColorRole.Text),
            palette.color(QPalette.ColorRole.PlaceholderText),
            palette.color(QPalette.ColorRole.Midlight),
            palette.color(QPalette.ColorRole.Link),
        )

    @staticmethod
    def on_paper() -> PlotColours:
        """Black and dark blue on white."""
        return PlotColours(
            QColor("#ffffff"),
            QColor("#000000"),
            QColor("#808080"),
            QColor("#c8c8c8"),
            QColor("#0b4f8a"),
        )


@dataclass(frozen=True)
class PlotWords:
    """What is written on a plot, in the user's language."""

    title: str
    confidence: str
    accepted: str
    decided: str
    error: str
    empty: str


@dataclass(frozen=True)
class ReliabilityPlot:
    """The curve with its words, to be painted anywhere."""

    reliability: Reliability
    words: PlotWords

    def paint(self, painter: QPainter, area: QRectF, colours: PlotColours) -> None:
        """Paint it into an area, in the painter's font."""
        painter.fillRect(area, colours.ground)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        line = painter.fontMetrics().height()
        left = painter.fontMetrics().horizontalAdvance("0.00") + 1.75 * line
        field = area.adjusted(left, 2.5 * line, -line, -2.75 * line)
        if field.width() < 2 * line or field.height() < 2 * line:
            return
        strip = QRectF(field)
        strip.setTop(field.bottom() - field.height() * _STRIP)
        field.setBottom(strip.top() - line / 4)
        self._paint_frame(painter, area, field, strip, colours)
        if self._decided_count == 0:
            painter.setPen(colours.faint)
            painter.drawText(field, int(Qt.AlignmentFlag.AlignCenter), self.words.empty)
            return
        self._paint_counts(painter, strip, colours)
        self._paint_curve(painter, field, colours)

    @property
    def _decided_count(self) -> int:
        return round(sum(one.accepted.of for one in self.reliability.bins))

    def _paint_frame(
        self, painter: QPainter, area: QRectF, field: QRectF, strip: QRectF, colours: PlotColours
    ) -> None:
        line = painter.fontMetrics().height()
        painter.setPen(colours.ink)
        top = QRectF(area.left() + line / 2, area.top() + line / 4, area.width() - line, line)
        font = painter.font()
        font.setBold(True)
        painter.save()
        painter.setFont(font)
        title = painter.fontMetrics().elidedText(
            self.words.title, Qt.TextElideMode.ElideRight, int(top.width())
        )
        painter.drawText(top, int(Qt.AlignmentFlag.AlignLeft), title)
        painter.restore()
        painter.setPen(colours.faint)
        painter.drawText(top.translated(0, line), int(Qt.AlignmentFlag.AlignLeft), self._facts())
        painter.setPen(QPen(colours.faint, 0.5))
        for step in _STEPS:
            x, y = _at(field, step, step)
            painter.drawLine(QPointF(field.left(), y), QPointF(field.right(), y))
            painter.drawLine(QPointF(x, field.top()), QPointF(x, strip.bottom()))
        painter.setPen(QPen(colours.ink, 1, Qt.PenStyle.DashLine))
        painter.drawLine(field.bottomLeft(), field.topRight())
        painter.setPen(colours.ink)
        self._paint_scales(painter, field, strip, area)

    def _paint_scales(self, painter: QPainter, field: QRectF, strip: QRectF, area: QRectF) -> None:
        line = painter.fontMetrics().height()
        for step in _STEPS:
            x, y = _at(field, step, step)
            word = f"{step:g}"
            beside = QRectF(area.left(), y - line / 2, field.left() - area.left() - line / 4, line)
            flags = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
            painter.drawText(beside, int(flags), word)
            below = QRectF(x - 2 * line, strip.bottom() + line / 8, 4 * line, line)
            painter.drawText(below, int(Qt.AlignmentFlag.AlignHCenter), word)
        below = QRectF(area.left(), strip.bottom() + 1.25 * line, area.width(), line)
        painter.drawText(below, int(Qt.AlignmentFlag.AlignHCenter), self.words.confidence)
        painter.save()
        painter.translate(area.left() + line / 4, field.center().y())
        painter.rotate(-90)
        beside = QRectF(-field.height() / 2, 0, field.height(), line)
        painter.drawText(beside, int(Qt.AlignmentFlag.AlignCenter), self.words.accepted)
        painter.restore()

    def _paint_counts(self, painter: QPainter, strip: QRectF, colours: PlotColours) -> None:
        most = max(one.accepted.of for one in self.reliability.bins)
        for one in self.reliability.bins:
            height = strip.height() * one.accepted.of / most
            width = strip.width() * (one.high - one.low)
            bar = QRectF(
                strip.left() + strip.width() * one.low, strip.bottom() - height, width, height
            )
            painter.fillRect(bar.adjusted(1, 0, -1, 0), colours.bars)

    def _paint_curve(self, painter: QPainter, field: QRectF, colours: PlotColours) -> None:
        filled = [one for one in self.reliability.bins if one.accepted.of]
        positions = [
            QPointF(*_at(field, one.mean_confidence, one.accepted.value)) for one in filled
        ]
        painter.setPen(QPen(colours.curve, 2))
        painter.drawPolyline(positions)
        side = painter.fontMetrics().height() / 4
        for one, position in zip(filled, positions, strict=True):
            painter.setPen(QPen(colours.curve, 1.5))
            _, low = _at(field, 0, one.accepted.low)
            _, high = _at(field, 0, one.accepted.high)
            painter.drawLine(QPointF(position.x(), low), QPointF(position.x(), high))
            for end in (low, high):
                painter.drawLine(
                    QPointF(position.x() - side, end), QPointF(position.x() + side, end)
                )
            square = QRectF(position.x() - side, position.y() - side, 2 * side, 2 * side)
            painter.fillRect(square, colours.curve)

    def _facts(self) -> str:
        error = self.reliability.calibration_error
        words = self.words.decided.format(count=f"{self._decided_count:,}")
        if math.isnan(error):
            return words
        return f"{words} · " + self.words.error.format(error=f"{error:.2f}")


class ReliabilityView(QWidget):
    """Shows one plot in the window's colours."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._plot: ReliabilityPlot | None = None
        self.setMinimumSize(160, 120)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    @property
    def plot(self) -> ReliabilityPlot | None:
        """What it shows."""
        return self._plot

    def show_plot(self, plot: ReliabilityPlot | None) -> None:
        """Show a curve; None: nothing."""
        self._plot = plot
        self.update()

    @override
    def sizeHint(self) -> QSize:
        return QSize(320, 320)

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        with QPainter(self) as painter:
            colours = PlotColours.of(self.palette())
            painter.fillRect(self.rect(), colours.ground)
            if self._plot is not None:
                self._plot.paint(painter, QRectF(self.rect()), colours)


def _at(field: QRectF, x: float, y: float) -> tuple[float, float]:
    return field.left() + field.width() * x, field.bottom() - field.height() * y
