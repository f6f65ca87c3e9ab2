"""ClassPanel: how good each run was that gives classes, by a truth; and which points were wrong."""

from __future__ import annotations

import math
from collections.abc import Sequence

from PySide6.QtCore import QSignalBlocker, Qt, QTimer, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from processing.core.text import Language
from processing.image.attributes.colour_maps import ERROR_MAP_COLOURS
from processing.project.evaluation.class_evaluation import ClassEvaluation
from processing.project.evaluation.truth_store import Truth
from processing.recording.columns.error_map import ERROR_MAP, ErrorMapValue
from processing.scoring.points.asked_classes import NOISE_ASKED
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.tools.listed.registry import asked_classes
from widgets.feature_drawing.swatch import SWATCH_PX, swatch_of
from widgets.panels.class_evaluation.setting_words import moment_of, settings_words
from widgets.panels.class_evaluation.truth_bar import TruthBar
from widgets.panels.run_words import name_of_tool
from widgets.shared.shared_state import SharedState

_WAIT_MS = 400


class ClassPanel(QWidget):
    """Truths above, a table of runs, and below it what shows the points right and wrong.

    Parameters
    ----------
    shared : SharedState
    language : Language

    Signals
    -------
    error_map_requested(truth: str)
        What is shown is out of date and can be seen: :meth:`show_evaluations` is to be called.
    points_requested(truth: str, evaluation: ClassEvaluation)
        The points are to be coloured by what was right and wrong.
    export_requested
        The table is to be written.
    """

    error_map_requested = Signal(str)
    points_requested = Signal(str, object)
    export_requested = Signal()

    def __init__(
        self, shared: SharedState, language: Language, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._settings = shared.view_settings
        self._language: Language = language
        self._evaluations: tuple[ClassEvaluation, ...] = ()
        self._rows: list[ClassEvaluation | None] = []
        self._is_stale = True
        self._look_before = "intensity"
        self._refresh = QTimer(self, interval=_WAIT_MS, singleShot=True)
        self._refresh.timeout.connect(self._ask_if_seen)
        self.truths = TruthBar(language, self)
        self._table = self._new_table()
        self._show_points = QCheckBox(self.tr("Show right and wrong"), self)
        self._show_points.setToolTip(
            self.tr("Colours the points in all views by what the chosen run did with them")
        )
        self._export = QPushButton(self.tr("Export"), self)
        self._export.setToolTip(self.tr("Table (CSV)"))
        self._sides = QLabel(self)
        self._lay_out()
        self.truths.truth_chosen.connect(self._on_truth_chosen)
        self._table.currentCellChanged.connect(self._on_table_current_changed)
        self._show_points.clicked.connect(self._on_show_points_clicked)
        self._export.clicked.connect(self.export_requested)
        changes = shared.map_changes
        for changed in (changes.features_changed, changes.labels_changed, changes.drives_changed):
            changed.connect(self.refresh)
        self._settings.look_changed.connect(self._on_settings_look_changed)
        self._show_state()

    @property
    def evaluations(self) -> tuple[ClassEvaluation, ...]:
        """What the table shows."""
        return self._evaluations

    @property
    def chosen(self) -> ClassEvaluation | None:
        """The run of the current row; None where there is none."""
        row = self._table.currentRow()
        return self._rows[row] if 0 <= row < len(self._rows) else None

    @property
    def truth(self) -> Truth | None:
        """The truth that judges."""
        return next((one for one in self.truths.truths if one.id == self.truths.truth), None)

    def refresh(self) -> None:
        """What is shown is out of date; it is asked for again when it can be seen."""
        self._is_stale = True
        self._refresh.start()

    def show_evaluations(self, truth: str, evaluations: Sequence[ClassEvaluation]) -> None:
        """Show what came of a judgement; that of another truth than the chosen one is dropped."""
        if truth != self.truths.truth:
            return
        chosen = self.chosen
        self._evaluations = tuple(evaluations)
        self._rows = []
        rows: list[tuple[str, BinaryConfusionMatrix]] = []
        for one in self._evaluations:
            tool = name_of_tool(one.tool, self._language)
            if not self._rows or self._rows[-1] is None or self._rows[-1].tool != one.tool:
                self._rows.append(None)
                rows.append((self._untouched_name(one.tool), _make_untouched(one)))
            self._rows.append(one)
            rows.append((self._name_of(one, tool), one.counts))
        with QSignalBlocker(self._table):  # nobody chose another row
            self._table.setRowCount(len(rows))
            for number, (name, counts) in enumerate(rows):
                self._fill(number, name, counts, is_run=self._rows[number] is not None)
            if rows:
                self._table.setCurrentCell(self._row_like(chosen), 0)
                self._table.scrollTo(self._table.currentIndex())
        self._show_state()

    def _row_like(self, chosen: ClassEvaluation | None) -> int:
        """Where what was chosen is now; at first the classes as they stand."""
        keys = [None if one is None else (one.tool, one.run) for one in self._rows]
        if chosen is not None and (chosen.tool, chosen.run) in keys:
            return keys.index((chosen.tool, chosen.run))
        return next(number for number, key in enumerate(keys) if key is not None and not key[1])

    def _name_of(self, one: ClassEvaluation, tool: str) -> str:
        if one.run is None:
            return self.tr("{tool}: as it stands now").format(tool=tool)
        settings = settings_words(one.tool, one.run.parameters, self._language)
        moment = moment_of(one.run, self._language)
        return f"{tool}: {settings}  ({moment})" if settings else f"{tool}  ({moment})"

    def _untouched_name(self, tool: str) -> str:
        name = name_of_tool(tool, self._language)
        if asked_classes()[tool].removes:
            return self.tr("{tool}: if nothing were removed").format(tool=name)
        return self.tr("{tool}: if everything were kept").format(tool=name)

    def _fill(self, row: int, name: str, counts: BinaryConfusionMatrix, *, is_run: bool) -> None:
        before = self._rows[row] or self._rows[row + 1]
        asked = NOISE_ASKED if before is None else asked_classes()[before.tool]
        removed = counts if asked.removes else counts.turned()
        kept = removed.turned()
        words = (
            name,
            *map(_percent, (kept.precision, kept.recall, kept.f_measure)),
            *map(_percent, (removed.precision, removed.recall, removed.f_measure)),
            "–" if math.isnan(counts.kappa) else f"{counts.kappa:.3f}",
            f"{kept.misses:,}",
            f"{removed.misses:,}",
            f"{counts.count:,}",
        )
        sides = asked.kept.in_language(self._language), asked.removed.in_language(self._language)
        for column, word in enumerate(words):
            item = QTableWidgetItem(word)
            side = Qt.AlignmentFlag.AlignRight if column else Qt.AlignmentFlag.AlignLeft
            item.setTextAlignment(side | Qt.AlignmentFlag.AlignVCenter)
            if 1 <= column <= 6:
                item.setToolTip(sides[(column - 1) // 3])
            if not is_run:
                item.setForeground(self.palette().placeholderText())
            self._table.setItem(row, column, item)

    def _new_table(self) -> QTableWidget:
        columns = self._columns()
        table = QTableWidget(0, len(columns), self)
        for number, (title, explanation) in enumerate(columns):
            item = QTableWidgetItem(title)
            item.setToolTip(explanation)
            table.setHorizontalHeaderItem(number, item)
        table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        table.verticalHeader().hide()
        table.verticalHeader().setDefaultSectionSize(24)
        header = table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setMinimumSectionSize(48)
        return table

    def _columns(self) -> tuple[tuple[str, str], ...]:
        kept = self.tr("Positive is the point that is kept: no noise; ground")
        removed = self.tr("Positive is the point that is removed: noise; an object on the ground")
        precision = self.tr("Of the points called so, the share that is")
        recall = self.tr("Of the points that are so, the share that is called so")
        mean = self.tr("Harmonic mean of precision and recall")
        return (
            (self.tr("Tool and run"), ""),
            (self.tr("Kept:\nprecision"), f"{kept}\n{precision}"),
            (self.tr("Kept:\nrecall"), f"{kept}\n{recall}"),
            (self.tr("Kept:\nF"), f"{kept}\n{mean}"),
            (self.tr("Removed:\nprecision"), f"{removed}\n{precision}"),
            (self.tr("Removed:\nrecall"), f"{removed}\n{recall}"),
            (self.tr("Removed:\nF"), f"{removed}\n{mean}"),
            (self.tr("Kappa"), self.tr("Agreement beyond chance")),
            (self.tr("Wrongly\nremoved"), self.tr("Points that should have been kept")),
            (self.tr("Wrongly\nkept"), self.tr("Points that should have been removed")),
            (self.tr("Points"), self.tr("Points whose truth is known")),
        )

    def _lay_out(self) -> None:
        below = QHBoxLayout()
        below.setSpacing(8)
        below.addWidget(self._show_points)
        for judgement, words in (
            (ErrorMapValue.RIGHTLY_KEPT, self.tr("rightly kept")),
            (ErrorMapValue.RIGHTLY_REMOVED, self.tr("rightly removed")),
            (ErrorMapValue.WRONGLY_REMOVED, self.tr("wrongly removed")),
            (ErrorMapValue.WRONGLY_KEPT, self.tr("wrongly kept")),
        ):
            square = QLabel(self)
            square.setPixmap(swatch_of(ERROR_MAP_COLOURS[judgement]).pixmap(SWATCH_PX, SWATCH_PX))
            below.addWidget(square)
            below.addWidget(QLabel(words, self))
        below.addStretch(1)
        below.addWidget(self._sides)
        below.addWidget(self._export)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 8)
        layout.setSpacing(8)
        layout.addWidget(self.truths)
        layout.addWidget(self._table, 1)
        layout.addLayout(below)

    def _show_state(self) -> None:
        chosen = self.chosen
        self._show_points.setEnabled(chosen is not None)
        self._show_points.setChecked(self._settings.look.attribute == ERROR_MAP)
        self._export.setEnabled(bool(self._evaluations))
        if self.truth is None:
            words = self.tr("Say first what is true: paint, check, then “New truth”.")
        elif chosen is not None:
            asked = asked_classes()[chosen.tool]
            words = self.tr("kept: {kept}; removed: {removed}").format(
                kept=asked.kept.in_language(self._language),
                removed=asked.removed.in_language(self._language),
            )
        elif not self._evaluations:
            words = self.tr("Run a tool that gives classes on the drive of this truth.")
        else:
            words = ""
        self._sides.setText(words)

    def _on_truth_chosen(self) -> None:
        self._evaluations, self._rows = (), []
        self._table.setRowCount(0)
        self._show_state()
        self.refresh()

    def _on_table_current_changed(self) -> None:
        self._show_state()
        if self._show_points.isChecked() and self.chosen is not None:
            self.points_requested.emit(self.truths.truth, self.chosen)

    def _on_show_points_clicked(self, is_wanted: bool) -> None:  # noqa: FBT001 - a slot of a signal
        if not is_wanted:
            self._settings.change_look(attribute=self._look_before)
        elif self.chosen is not None:
            self.points_requested.emit(self.truths.truth, self.chosen)

    def _on_settings_look_changed(self) -> None:
        attribute = self._settings.look.attribute
        if attribute != ERROR_MAP:
            self._look_before = attribute
        self._show_points.setChecked(attribute == ERROR_MAP)

    def _ask_if_seen(self) -> None:
        if self._is_stale and self.isVisible():
            self._is_stale = False
            self.error_map_requested.emit(self.truths.truth)

    @override
    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._ask_if_seen()


def _make_untouched(one: ClassEvaluation) -> BinaryConfusionMatrix:
    """What the same truth gives where every point is kept."""
    if asked_classes()[one.tool].removes:
        return one.counts.if_nothing_was_positive()
    return one.counts.turned().if_nothing_was_positive().turned()


def _percent(share: float) -> str:
    return "–" if math.isnan(share) else f"{100 * share:.2f} %"
