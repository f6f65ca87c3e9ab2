"""EvaluationPanel: how good each tool and run was, by what the operator decided and drew."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from PySide6.QtCore import QEvent, QLocale, Qt, QTimer, Signal
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QLabel,
    QMenu,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QSplitter,
    QStackedWidget,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from processing.core.text import Language
from processing.project.evaluation.run_evaluation import RunEvaluation
from processing.project.store.runs import Run
from processing.scoring.features.file_scores import FileScore
from processing.scoring.points.reliability import ShareInterval
from widgets.panels.feature_tally import RunOfTool
from widgets.panels.reliability_plot import PlotWords, ReliabilityPlot, ReliabilityView
from widgets.panels.run_words import name_of_run, name_of_tool
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_WAIT_MS = 400
_WIDE = 1.4
_BESIDE_TABLE_PX = 24


class EvaluationPanel(QWidget):
    """A table of tools and their runs, and the reliability curve of the chosen one.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language

    Signals
    -------
    evaluation_wanted
        What is shown is out of date and can be seen: :meth:`show_evaluations` is to be called.
    export_requested(format: str)
        ``"csv"``: the table; ``"png"``, ``"pdf"``: the curve shown.
    """

    evaluation_wanted = Signal()
    export_requested = Signal(str)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._language = language
        self._locale = QLocale(language)
        self._evaluations: tuple[RunEvaluation, ...] = ()
        self._is_stale = True
        self._refresh = QTimer(self, interval=_WAIT_MS, singleShot=True)
        self._refresh.timeout.connect(self._ask_if_seen)
        self._map_scores: Mapping[str, FileScore] = {}
        self._against_map = QLabel(self)
        self._against_map.setWordWrap(True)
        self._around_map_score = self._make_scroll_area(self._against_map)
        self._table = self._new_table()
        self._plot = ReliabilityView(self)
        self._halves = QSplitter(Qt.Orientation.Horizontal, self)
        self._halves.setChildrenCollapsible(False)
        self._halves.addWidget(self._left_half())
        self._halves.addWidget(self._plot)
        self._halves.setStretchFactor(0, 1)
        self._halves.setStretchFactor(1, 0)
        self._pages = QStackedWidget(self)
        self._pages.addWidget(self._empty_page())
        self._pages.addWidget(self._halves)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._pages)
        shared.map_changes.features_changed.connect(self._on_map_changed)
        shared.map_changes.drives_changed.connect(self._on_map_changed)

    @property
    def evaluations(self) -> tuple[RunEvaluation, ...]:
        """What the table shows, row by row."""
        return self._evaluations

    @property
    def plot(self) -> ReliabilityPlot | None:
        """The curve shown, to be painted elsewhere; None when there is none."""
        return self._plot.plot

    def show_evaluations(self, evaluations: Sequence[RunEvaluation]) -> None:
        """Show these; the row that was chosen stays so."""
        row = max(self._table.currentRow(), 0)
        self._evaluations = tuple(evaluations)
        self._is_stale = False
        runs = {run.id: run for run in self._source.runs()}
        self._table.setRowCount(len(self._evaluations))
        for number, one in enumerate(self._evaluations):
            name = self._name_of(one, runs)
            for column, words in enumerate((name, *self._words_of(one))):
                self._set_cell(number, column, words)
        self._pages.setCurrentIndex(1 if self._evaluations else 0)
        self._table.setCurrentCell(min(row, len(self._evaluations) - 1), 0)
        self._share_room()
        self._show_plot()

    def show_map_scores(self, scores: Mapping[str, FileScore]) -> None:
        """Show, by the ids of runs, how what they found fits the map of a person."""
        self._map_scores = scores
        self._show_map_score()

    def _show_map_score(self) -> None:
        row = self._table.currentRow()
        chosen = self._evaluations[row].runs if 0 <= row < len(self._evaluations) else ()
        score = self._map_scores.get(chosen[0]) if len(chosen) == 1 else None
        self._around_map_score.setVisible(score is not None)
        if score is None:
            self._against_map.clear()
            return
        lines = [self.tr("Against what was drawn and accepted, place by place:")]
        for one in score.counts:
            if one.counts.count:
                words = self.tr("{what}: precision {p}, recall {r}, F {f}")
                counts = one.counts
                shares = counts.precision, counts.recall, counts.f_measure
                p, r, f = (_percent(ShareInterval(share, 1.0)) or "–" for share in shares)
                name = one.name.in_language(self._language)
                lines.append(words.format(what=name, p=p, r=r, f=f))
        self._against_map.setText("\n".join(lines))

    def _name_of(self, one: RunEvaluation, runs: Mapping[str, Run]) -> str:
        """A tool over several runs, with those below it; or a tool that was run once."""
        if len(one.runs) > 1:
            tool = name_of_tool(one.tool, self._language)
            runs_of_it = self.tr("%n run(s)", "", len(one.runs))
            return f"{tool}  ({runs_of_it})"
        name = name_of_run(RunOfTool(one.tool, one.runs[0]), runs, self._language)
        return name if one.is_whole_tool else f"    {name}"

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
        header = table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        table.currentCellChanged.connect(self._show_plot)
        return table

    def _columns(self) -> tuple[tuple[str, str], ...]:
        return (
            (self.tr("Tool and run"), ""),
            (
                self.tr("Precision"),
                self.tr("Accepted of all decided, with the 95 % interval"),
            ),
            (
                self.tr("Recall"),
                self.tr("Accepted of accepted and drawn by hand, with the 95 % interval"),
            ),
            (self.tr("Accepted"), self.tr("As they were found, or corrected")),
            (self.tr("Rejected"), ""),
            (self.tr("Undecided"), self.tr("Candidates that nobody has judged")),
            (
                self.tr("Drawn by hand"),
                self.tr("Features of the same kinds on the same drives that the tool missed"),
            ),
            (self.tr("Recall by length"), self.tr("The same in metres, for lines")),
            (self.tr("Corrected"), self.tr("Accepted after they were changed")),
            (
                self.tr("Mean shift"),
                self.tr(
                    "How far the vertices of corrected features lie from where they were found"
                ),
            ),
            (
                self.tr("Calibration error"),
                self.tr("How far the share accepted is from the confidence, on average"),
            ),
        )

    def _words_of(self, one: RunEvaluation) -> tuple[str, ...]:
        shift = "" if math.isnan(one.shift_m) else f"{self._locale.toString(one.shift_m, 'f', 3)} m"
        error = one.reliability.calibration_error
        return (
            _percent(one.precision),
            _percent(one.recall),
            self._locale.toString(one.accepted),
            self._locale.toString(one.rejected),
            self._locale.toString(one.undecided),
            self._locale.toString(one.drawn),
            _percent(one.recall_by_length),
            self._locale.toString(one.corrected),
            shift,
            "" if math.isnan(error) else f"{error:.2f}",
        )

    def _set_cell(self, row: int, column: int, words: str) -> None:
        item = QTableWidgetItem(words)
        side = Qt.AlignmentFlag.AlignRight if column else Qt.AlignmentFlag.AlignLeft
        item.setTextAlignment(side | Qt.AlignmentFlag.AlignVCenter)
        self._table.setItem(row, column, item)

    def _left_half(self) -> QWidget:
        menu = QMenu(self)
        menu.addAction(self.tr("Table (CSV)"), lambda: self.export_requested.emit("csv"))
        menu.addAction(self.tr("Curve (PNG)"), lambda: self.export_requested.emit("png"))
        menu.addAction(self.tr("Curve (PDF)"), lambda: self.export_requested.emit("pdf"))
        button = QPushButton(self.tr("Export"), self)
        button.setMenu(menu)
        half = QWidget(self)
        layout = QVBoxLayout(half)
        layout.setContentsMargins(8, 8, 8, 8)
        layout.setSpacing(8)
        layout.addWidget(self._table, 1)
        layout.addWidget(self._around_map_score)
        layout.addWidget(button, 0, Qt.AlignmentFlag.AlignLeft)
        return half

    def _make_scroll_area(self, label: QLabel) -> QScrollArea:
        """Words that ask for no height on a low screen; hidden until there are some."""
        area = QScrollArea(self)
        area.setWidget(label)
        area.setWidgetResizable(True)
        area.setFrameShape(QScrollArea.Shape.NoFrame)
        area.setMinimumHeight(1)
        area.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        area.hide()
        return area

    def _empty_page(self) -> QLabel:
        words = QLabel(
            self.tr("Once candidates of a run are judged, this says how good the tool was."), self
        )
        words.setWordWrap(True)
        words.setEnabled(False)
        words.setContentsMargins(8, 8, 8, 8)
        words.setAlignment(Qt.AlignmentFlag.AlignTop)
        return words

    def _show_plot(self) -> None:
        self._show_map_score()
        row = self._table.currentRow()
        if not 0 <= row < len(self._evaluations):
            self._plot.show_plot(None)
            return
        name = self._table.item(row, 0)
        words = PlotWords(
            title="" if name is None else name.text().strip(),
            confidence=self.tr("Confidence of the tool"),
            accepted=self.tr("Share accepted"),
            decided=self.tr("{count} decided"),
            error=self.tr("calibration error {error}"),
            empty=self.tr("Nothing is decided yet."),
        )
        self._plot.show_plot(ReliabilityPlot(self._evaluations[row].reliability, words))

    def _on_map_changed(self) -> None:
        self._is_stale = True
        self._refresh.start()

    def _ask_if_seen(self) -> None:
        if self._is_stale and self.isVisible():
            self.evaluation_wanted.emit()

    @override
    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._ask_if_seen()

    @override
    def resizeEvent(self, event: QResizeEvent) -> None:
        """Beside each other where there is room for it."""
        super().resizeEvent(event)
        is_wide = self.width() > _WIDE * self.height()
        wanted = Qt.Orientation.Horizontal if is_wide else Qt.Orientation.Vertical
        if self._halves.orientation() is not wanted:
            self._halves.setOrientation(wanted)
        self._share_room()

    def _share_room(self) -> None:
        """Beside each other the table takes what its columns need, the curve the rest."""
        if self._halves.orientation() is Qt.Orientation.Horizontal:
            columns = self._table.horizontalHeader().length() + _BESIDE_TABLE_PX
            table = min(columns, self.width() - self._plot.sizeHint().width())
            self._halves.setSizes([table, self.width() - table])

    @override
    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() is QEvent.Type.PaletteChange:
            self._plot.update()


def _percent(share: ShareInterval) -> str:
    """``83 % (77–88)``; empty where there is no share."""
    if math.isnan(share.value):
        return ""
    words = f"{100 * share.value:.0f} %"
    if math.isnan(share.low):
        return words
    return f"{words} ({100 * share.low:.0f}–{100 * share.high:.0f})"
