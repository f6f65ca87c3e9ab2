"""The picture of a parameter study: curves over one parameter, a map of F over two."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from processing.core.parameters import ParameterValue
from processing.core.text import Language
from processing.project.evaluation.parameter_study import ParameterStudy, StudyCell
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.tools.listed.registry import asked_classes
from widgets.panels.class_evaluation.setting_words import parameter_name, value_words
from widgets.panels.reliability_plot import PlotColours

_LEAST_SPAN = 0.1
_LEAST_LINES = 16
_STEPS = 5
_LIGHT, _DARK = QColor("#f2f6fb"), QColor("#08306b")
"""Ends of the map's ramp; its lightness alone tells, so it survives printing in grey."""

_CENTRE = int(Qt.AlignmentFlag.AlignCenter)
_RIGHT = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
_LEFT = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)


@dataclass(frozen=True)
class StudyWords:
    """What is written on a plot, in the user's language."""

    title: str
    facts: str
    precision: str
    recall: str
    f_measure: str
    now: str
    best: str


@dataclass(frozen=True)
class StudyPlot:
    """A study with its words, to be painted anywhere.

    Attributes
    ----------
    shows_removed : bool
        Whether the scores are those of the points that are removed, or of those that are kept.
    current : mapping of str to value
        The tool's parameters as they are set; empty where that is not to be marked.
    chosen : int
        Number of the cell that is marked as chosen; −1: the best one.
    """

    study: ParameterStudy
    words: StudyWords
    language: Language
    shows_removed: bool
    current: Mapping[str, ParameterValue]
    chosen: int = -1

    @property
    def title(self) -> str:
        """What it is a picture of."""
        return self.words.title

    @property
    def chosen_cell(self) -> StudyCell | None:
        """The cell that was chosen, or else the best one."""
        if 0 <= self.chosen < len(self.study.cells):
            return self.study.cells[self.chosen]
        return self.best

    @property
    def best(self) -> StudyCell | None:
        """The first of those with the greatest F of the points shown."""
        scored = [one for one in self.study.cells if not math.isnan(self.counts_of(one).f_measure)]
        return max(scored, key=lambda one: self.counts_of(one).f_measure, default=None)

    def counts_of(self, cell: StudyCell) -> BinaryConfusionMatrix:
        """A cell's counts with the points shown as the positive class."""
        is_as_found = asked_classes()[self.study.tool].removes is self.shows_removed
        return cell.counts if is_as_found else cell.counts.turned()

    def paint(self, painter: QPainter, area: QRectF, colours: PlotColours) -> None:
        """Paint it into an area, in the painter's font."""
        painter.fillRect(area, colours.ground)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        field = self._field(painter, area)
        line = painter.fontMetrics().height()
        if field.width() < 3 * line or field.height() < 2 * line:
            return
        if self._has_head(painter, area):
            self._paint_head(painter, area, colours)
        if len(self.study.varied) == 1:
            self._paint_curves(painter, field, area, colours)
        else:
            self._paint_map(painter, field, area, colours)

    def cell_at(self, position: QPointF, field: QRectF) -> int:
        """Number of the cell at a place of the picture; −1 where there is none."""
        columns = len(self.study.varied[0].values)
        if len(self.study.varied) == 1:
            x = [self._x_of(field, one) for one in range(columns)]
            return min(range(columns), key=lambda one: abs(x[one] - position.x()))
        boxes = (
            self._box(field, number).contains(position) for number in range(len(self.study.cells))
        )
        return next((number for number, is_there in enumerate(boxes) if is_there), -1)

    def position_of(self, number: int, field: QRectF) -> QPointF:
        """Where a cell is in the picture."""
        if len(self.study.varied) == 1:
            return QPointF(self._x_of(field, number), field.center().y())
        return self._box(field, number).center()

    def field_in(self, painter: QPainter, area: QRectF) -> QRectF:
        """Where the curves or the map are within the picture."""
        return self._field(painter, area)

    def _field(self, painter: QPainter, area: QRectF) -> QRectF:
        line, metrics = painter.fontMetrics().height(), painter.fontMetrics()
        left = metrics.horizontalAdvance("100 %") + 1.75 * line
        right = line
        if len(self.study.varied) == 1:
            names = (self.words.precision, self.words.recall, self.words.f_measure)
            right = max(map(metrics.horizontalAdvance, names)) + line
        else:
            tool, second = self.study.tool, self.study.varied[1]
            words = [
                value_words(tool, second.parameter, one, self.language) for one in second.values
            ]
            left = max(map(metrics.horizontalAdvance, words)) + 2 * line
        above = 2.75 * line if self._has_head(painter, area) else 0.75 * line
        return area.adjusted(left, above, -right, -2.5 * line)

    def _has_head(self, painter: QPainter, area: QRectF) -> bool:
        """A low picture is all curve: what it shows is written beside it."""
        return area.height() > _LEAST_LINES * painter.fontMetrics().height()

    def _paint_head(self, painter: QPainter, area: QRectF, colours: PlotColours) -> None:
        line = painter.fontMetrics().height()
        top = QRectF(area.left() + line / 2, area.top() + line / 4, area.width() - line, line)
        painter.save()
        font = painter.font()
        font.setBold(True)
        painter.setFont(font)
        painter.setPen(colours.ink)
        painter.drawText(top, _LEFT, _short(painter, self.words.title, top.width()))
        painter.restore()
        painter.setPen(colours.faint)
        below = top.translated(0, line)
        painter.drawText(below, _LEFT, _short(painter, self.words.facts, below.width()))

    def _paint_curves(
        self, painter: QPainter, field: QRectF, area: QRectF, colours: PlotColours
    ) -> None:
        counts = [self.counts_of(one) for one in self.study.cells]
        series = (
            (self.words.precision, [one.precision for one in counts], Qt.PenStyle.DashLine, 1.5),
            (self.words.recall, [one.recall for one in counts], Qt.PenStyle.DotLine, 1.5),
            (self.words.f_measure, [one.f_measure for one in counts], Qt.PenStyle.SolidLine, 2.0),
        )
        known = [one for _, values, _, _ in series for one in values if not math.isnan(one)]
        low = math.floor(min(known, default=0.0) * 10) / 10
        low = max(0.0, min(low, 1.0 - _LEAST_SPAN))
        self._paint_scale(painter, field, area, colours, low)
        self._paint_marks(painter, field, colours)
        ends: list[tuple[float, str]] = []
        for name, values, style, width in series:
            positions = [
                QPointF(self._x_of(field, position), _y_of(field, value, low))
                for position, value in enumerate(values)
                if not math.isnan(value)
            ]
            painter.setPen(QPen(colours.curve, width, style))
            painter.drawPolyline(positions)
            side = painter.fontMetrics().height() / 6
            for one in positions:
                square = QRectF(one.x() - side, one.y() - side, 2 * side, 2 * side)
                painter.fillRect(square, colours.curve)
            if positions:
                ends.append((positions[-1].y(), name))
        line = painter.fontMetrics().height()
        painter.setPen(colours.ink)
        y = -math.inf
        for end, name in sorted(ends):
            y = max(end, y + line * 0.9)
            beside = QRectF(field.right() + line / 2, y - line / 2, area.right(), line)
            painter.drawText(beside, _LEFT, name)

    def _paint_scale(
        self, painter: QPainter, field: QRectF, area: QRectF, colours: PlotColours, low: float
    ) -> None:
        line = painter.fontMetrics().height()
        for step in range(_STEPS + 1):
            value = low + (1.0 - low) * step / _STEPS
            y = _y_of(field, value, low)
            painter.setPen(QPen(colours.faint, 0.5))
            painter.drawLine(QPointF(field.left(), y), QPointF(field.right(), y))
            painter.setPen(colours.ink)
            beside = QRectF(area.left(), y - line / 2, field.left() - area.left() - line / 4, line)
            painter.drawText(beside, _RIGHT, f"{100 * value:.3g} %")
        self._paint_values(painter, field, area, colours)

    def _paint_values(
        self, painter: QPainter, field: QRectF, area: QRectF, colours: PlotColours
    ) -> None:
        """Values of the first parameter below the field, as many as there is room for."""
        varied, tool = self.study.varied[0], self.study.tool
        line, metrics = painter.fontMetrics().height(), painter.fontMetrics()
        painter.setPen(colours.ink)
        free = -math.inf
        for number, value in enumerate(varied.values):
            word = value_words(tool, varied.parameter, value, self.language)
            half = metrics.horizontalAdvance(word) / 2
            x = self._x_of(field, number)
            if x - half < free:
                continue
            free = x + half + line / 2
            position = QRectF(x - half - line, field.bottom() + line / 8, 2 * (half + line), line)
            painter.drawText(position, _CENTRE, word)
        below = QRectF(area.left(), field.bottom() + 1.25 * line, area.width(), line)
        name = parameter_name(tool, varied.parameter, self.language)
        painter.drawText(below, _CENTRE, _short(painter, name, below.width()))

    def _paint_marks(self, painter: QPainter, field: QRectF, colours: PlotColours) -> None:
        """Where the setting stands now, and which one is chosen."""
        line = painter.fontMetrics().height()
        marks = [(self._current_x(field), self.words.now, Qt.PenStyle.DashDotLine)]
        chosen = self.chosen_cell
        if chosen is not None:
            x = self._x_of(field, self.study.cells.index(chosen))
            name = self.words.best if chosen is self.best else ""
            marks.append((x, name, Qt.PenStyle.SolidLine))
        for height, (x, word, style) in enumerate(marks):
            if math.isnan(x):
                continue
            painter.setPen(QPen(colours.faint, 1.5, style))
            painter.drawLine(QPointF(x, field.top()), QPointF(x, field.bottom()))
            painter.setPen(colours.ink)
            width = painter.fontMetrics().horizontalAdvance(word) + line / 2
            left = x + line / 4 if x + width < field.right() else x - width
            y = field.bottom() - (height + 1) * line
            painter.drawText(QRectF(left, y, width, line), _LEFT, word)

    def _x_of(self, field: QRectF, number: int) -> float:
        """The place of a value: true to scale for numbers, evenly spaced for words."""
        values = self.study.varied[0].values
        if len(values) == 1:
            return field.center().x()
        if _are_numbers(values):
            low, high = float(values[0]), float(values[-1])
            return field.left() + field.width() * (float(values[number]) - low) / (high - low)
        return field.left() + field.width() * number / (len(values) - 1)

    def _current_x(self, field: QRectF) -> float:
        varied = self.study.varied[0]
        value = self.current.get(varied.parameter)
        if value in varied.values:
            return self._x_of(field, varied.values.index(value))
        if not _are_numbers(varied.values) or isinstance(value, (str, type(None))):
            return math.nan
        low, high = float(varied.values[0]), float(varied.values[-1])
        if high == low or not min(low, high) <= float(value) <= max(low, high):
            return math.nan
        return field.left() + field.width() * (float(value) - low) / (high - low)

    def _paint_map(
        self, painter: QPainter, field: QRectF, area: QRectF, colours: PlotColours
    ) -> None:
        first, second = self.study.varied
        scores = [self.counts_of(one).f_measure for one in self.study.cells]
        known = [one for one in scores if not math.isnan(one)]
        low, high = min(known, default=0.0), max(known, default=1.0)
        width, height = field.width() / len(first.values), field.height() / len(second.values)
        for number, score in enumerate(scores):
            box = self._box(field, number)
            share = 0.0 if math.isnan(score) or high == low else (score - low) / (high - low)
            colour = _mix_colours(share)
            painter.fillRect(box.adjusted(0.5, 0.5, -0.5, -0.5), colour)
            word = "–" if math.isnan(score) else f"{100 * score:.1f}"
            if painter.fontMetrics().horizontalAdvance(word) < width and (
                painter.fontMetrics().height() < height
            ):
                painter.setPen(_LIGHT if share > 0.5 else _DARK)
                painter.drawText(box, _CENTRE, word)
        self._mark_boxes(painter, field, colours)
        self._paint_columns_and_rows(painter, field, area, colours)

    def _box(self, field: QRectF, number: int) -> QRectF:
        first, second = self.study.varied
        column, row = divmod(number, len(second.values))
        width, height = field.width() / len(first.values), field.height() / len(second.values)
        top = field.bottom() - (row + 1) * height
        return QRectF(field.left() + column * width, top, width, height)

    def _mark_boxes(self, painter: QPainter, field: QRectF, colours: PlotColours) -> None:
        chosen = self.chosen_cell
        names = [one.parameter for one in self.study.varied]
        now = tuple(self.current.get(name) for name in names)
        for number, cell in enumerate(self.study.cells):
            box = self._box(field, number)
            if cell is self.best:
                painter.setPen(QPen(QColor("#e69f00"), 3))
                painter.drawRect(box.adjusted(2, 2, -2, -2))
            if cell.values == now:
                painter.setPen(QPen(QColor("#808080"), 2, Qt.PenStyle.DashLine))
                painter.drawRect(box.adjusted(5, 5, -5, -5))
            if cell is chosen and cell is not self.best:
                painter.setPen(QPen(colours.ink, 2))
                painter.drawRect(box.adjusted(2, 2, -2, -2))

    def _paint_columns_and_rows(
        self, painter: QPainter, field: QRectF, area: QRectF, colours: PlotColours
    ) -> None:
        line, metrics = painter.fontMetrics().height(), painter.fontMetrics()
        first, second = self.study.varied
        tool = self.study.tool
        painter.setPen(colours.ink)
        free = -math.inf
        for number, value in enumerate(first.values):
            box = self._box(field, number * len(second.values))
            word = value_words(tool, first.parameter, value, self.language)
            half = metrics.horizontalAdvance(word) / 2
            x = box.center().x()
            if x - half >= free:
                free = x + half + line / 2
                position = QRectF(x - half - 1, field.bottom() + line / 8, 2 * half + 2, line)
                painter.drawText(position, _CENTRE, word)
        for number, value in enumerate(second.values):
            box = self._box(field, number)
            if number and box.height() < 0.8 * line:
                continue
            word = value_words(tool, second.parameter, value, self.language)
            beside = QRectF(
                area.left(), box.center().y() - line / 2, field.left() - area.left() - 4, line
            )
            painter.drawText(beside, _RIGHT, word)
        below = QRectF(area.left(), field.bottom() + 1.25 * line, area.width(), line)
        name = parameter_name(tool, first.parameter, self.language)
        painter.drawText(below, _CENTRE, _short(painter, name, below.width()))
        painter.save()
        painter.translate(area.left() + line / 4, field.center().y())
        painter.rotate(-90)
        beside = QRectF(-field.height() / 2, 0, field.height(), line)
        name = parameter_name(tool, second.parameter, self.language)
        painter.drawText(beside, _CENTRE, _short(painter, name, beside.width()))
        painter.restore()


def _are_numbers(values: tuple[ParameterValue, ...]) -> bool:
    return all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in values)


def _y_of(field: QRectF, value: float, low: float) -> float:
    return field.bottom() - field.height() * (value - low) / (1.0 - low)


def _mix_colours(share: float) -> QColor:
    """Between the ends of the ramp."""
    one, other = _LIGHT, _DARK
    red = one.red() + (other.red() - one.red()) * share
    green = one.green() + (other.green() - one.green()) * share
    blue = one.blue() + (other.blue() - one.blue()) * share
    return QColor(round(red), round(green), round(blue))


def _short(painter: QPainter, words: str, width: float) -> str:
    return painter.fontMetrics().elidedText(words, Qt.TextElideMode.ElideRight, int(width))
