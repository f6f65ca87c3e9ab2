"""CompareRunsForm: two runs of a tool side by side, seen from above, and one of them kept."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QGridLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from widgets.parts.plain_buttons import remove_icons

_SIZE_PX, _PLAN_PX = QSize(760, 600), QSize(340, 220)
_GROUND, _IN_BOTH = QColor("#14171c"), QColor("#8b949e")
_ALONE = QColor("#e69f00"), QColor("#56b4e9")
_MARGIN_PX, _DOT_PX, _LINE_PX = 12.0, 6.0, 2.0

Shape = NDArray[np.float64]


@dataclass(frozen=True)
class RunSide:
    """What the form shows of a run.

    Attributes
    ----------
    id, name : str
    shapes : sequence of (n, 2) float64
        Its candidates from above, m.
    in_both : sequence of bool
        For each of them whether the other run has it.
    """

    id: str
    name: str
    shapes: Sequence[Shape]
    in_both: Sequence[bool]


class CompareRunsForm(QDialog):
    """A form beside the window.

    Signals
    -------
    pair_chosen(first: str, second: str)
        These two runs are to be shown.
    keep_requested(run: str)
        Its candidates are to wait, those of the others are to go.
    """

    pair_chosen = Signal(str, str)
    keep_requested = Signal(str)

    def __init__(self, names: Sequence[tuple[str, str]], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Compare runs"))
        self._boxes = QComboBox(self), QComboBox(self)
        self._plans = _RunPlan(_ALONE[0], self), _RunPlan(_ALONE[1], self)
        self._counts = QLabel(self), QLabel(self)
        self._keeps = (
            QPushButton(self.tr("Keep this run"), self),
            QPushButton(self.tr("Keep this run"), self),
        )
        self.table = QTableWidget(0, 3, self)
        self.table.verticalHeader().hide()
        self.table.horizontalHeader().hide()
        self.table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        self.table.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        remove_icons(buttons)
        buttons.rejected.connect(self.close)
        sides = QGridLayout()
        for column, box in enumerate(self._boxes):
            for id_, name in names:
                box.addItem(name, id_)
            box.activated.connect(self._on_box_activated)
            self._keeps[column].clicked.connect(self._on_keep_clicked)
            self._keeps[column].setAutoDefault(False)
            parts = (box, self._plans[column], self._counts[column], self._keeps[column])
            for row, part in enumerate(parts):
                sides.addWidget(part, row, column)
        layout = QVBoxLayout(self)
        layout.addLayout(sides)
        layout.addWidget(self.table, 1)
        layout.addWidget(buttons)
        self.resize(_SIZE_PX)

    def show_pair(
        self, sides: tuple[RunSide, RunSide], facts: Sequence[tuple[str, str, str]]
    ) -> None:
        """Show two runs; of each fact its name and what it is for the one and the other."""
        every = [shape for side in sides for shape in side.shapes if len(shape)]
        extent = np.vstack(every) if every else np.zeros((1, 2))
        for column, side in enumerate(sides):
            box = self._boxes[column]
            box.setCurrentIndex(box.findData(side.id))
            self._plans[column].show_run(side, extent)
            alone = len(side.in_both) - sum(side.in_both)
            words = self.tr("{count} candidates, {alone} of them only here")
            self._counts[column].setText(
                words.format(count=f"{len(side.in_both):,}", alone=f"{alone:,}")
            )
        self.table.setRowCount(len(facts))
        for row, fact in enumerate(facts):
            for column, words in enumerate(fact):
                item = QTableWidgetItem(words)
                font = item.font()
                font.setBold(fact[1] != fact[2])
                item.setFont(font)
                self.table.setItem(row, column, item)

    def _on_box_activated(self) -> None:
        first, second = (str(box.currentData()) for box in self._boxes)
        self.pair_chosen.emit(first, second)

    def _on_keep_clicked(self) -> None:
        column = self._keeps.index(self.sender())
        self.keep_requested.emit(str(self._boxes[column].currentData()))


class _RunPlan(QWidget):
    """The candidates of a run from above, north up; those of this run alone in its colour."""

    def __init__(self, alone: QColor, parent: QWidget) -> None:
        super().__init__(parent)
        self._alone = alone
        self._side: RunSide | None = None
        self._extent: Shape = np.zeros((1, 2))
        self.setMinimumSize(_PLAN_PX)

    def show_run(self, side: RunSide, extent: Shape) -> None:
        """Draw these, in a picture that holds all places of an extent."""
        self._side, self._extent = side, extent
        self.update()

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), _GROUND)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            if self._side is not None:
                for is_shared in (True, False):  # what one run alone found lies above
                    self._draw(painter, self._side, is_shared=is_shared)

    def _draw(self, painter: QPainter, side: RunSide, *, is_shared: bool) -> None:
        low, high = self._extent.min(axis=0), self._extent.max(axis=0)
        room = np.array([self.width(), self.height()]) - 2.0 * _MARGIN_PX
        scale = float((room / np.maximum(high - low, 1.0)).min())
        middle = (low + high) / 2
        colour = _IN_BOTH if is_shared else self._alone
        for shape, in_both in zip(side.shapes, side.in_both, strict=True):
            if in_both is not is_shared:
                continue
            offsets = ((shape - middle) * [scale, -scale]).tolist()
            spots = QPolygonF([QPointF(self.width() / 2 + x, self.height() / 2 + y)
                               for x, y in offsets])  # fmt: skip
            cap = Qt.PenCapStyle.RoundCap
            wide = _DOT_PX if len(shape) == 1 else _LINE_PX
            painter.setPen(QPen(colour, wide, Qt.PenStyle.SolidLine, cap))
            (painter.drawPoints if len(shape) == 1 else painter.drawPolyline)(spots)
