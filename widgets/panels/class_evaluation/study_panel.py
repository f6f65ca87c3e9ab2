"""StudyPanel: parameter studies, each a plot; the best setting can be used at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from PySide6.QtCore import QEvent, QPointF, QRectF, QSignalBlocker, QSize, Qt, Signal
from PySide6.QtGui import QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QLabel,
    QMenu,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from processing.core.parameters import ParameterValue
from processing.core.text import Language
from processing.project.evaluation.study_store import KeptStudy
from processing.tools.listed.registry import asked_classes
from widgets.panels.class_evaluation.setting_words import (
    parameter_name,
    settings_words,
    value_words,
)
from widgets.panels.class_evaluation.study_form import StudyForm
from widgets.panels.class_evaluation.study_plot import StudyPlot, StudyWords
from widgets.panels.reliability_plot import PlotColours
from widgets.panels.run_words import name_of_tool

_FORM_PX, _BESIDE_PX = 520, 220
_REMOVED, _KEPT = "removed", "kept"

ValuesOf = Callable[[str], Mapping[str, ParameterValue]]
"""From a tool's id to its parameters as they are set."""


class StudyPanel(QWidget):
    """A form at the left, the plot of a study at the right.

    Parameters
    ----------
    language : Language

    Signals
    -------
    study_requested
        What the form says is to be studied.
    values_wanted(tool: str, values: dict)
        These are to be the tool's settings.
    export_requested(format: str)
        ``"csv"``: the table; ``"png"``, ``"pdf"``: the plot.
    removal_requested(study: str)
    """

    study_requested = Signal()
    values_wanted = Signal(str, object)
    export_requested = Signal(str)
    removal_requested = Signal(str)

    def __init__(self, language: Language, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._language: Language = language
        self._studies: tuple[KeptStudy, ...] = ()
        self._values_of: ValuesOf | None = None
        self._chosen = -1
        self.form = StudyForm(language, self)
        self._choice = QComboBox(self)
        self._choice.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._choice.setMinimumContentsLength(12)
        self._side = QComboBox(self)
        self._facts = QLabel(self)
        self._use = QPushButton(self.tr("Use these values"), self)
        self._use.setToolTip(self.tr("Sets them in the tool's form; click on the plot for others"))
        self._export = QPushButton(self.tr("Export"), self)
        self._remove = QToolButton(self)
        self._remove.setText("✕")
        self._remove.setToolTip(self.tr("Forget this study"))
        self.view = StudyView(self)
        self._lay_out()
        self.form.study_requested.connect(self.study_requested)
        self.form.tool_chosen.connect(self.refresh)
        self._choice.activated.connect(self._on_choice_activated)
        self._side.activated.connect(self.refresh)
        self._use.clicked.connect(self._on_use_clicked)
        self._remove.clicked.connect(self._on_remove_clicked)
        self.view.cell_clicked.connect(self._on_view_cell_clicked)
        self.show_studies(())

    def ask_values_from(self, values_of: ValuesOf) -> None:
        """Ask this how tools are set now."""
        self._values_of = values_of
        self.refresh()

    @property
    def kept(self) -> KeptStudy | None:
        """The study shown."""
        wanted = self._choice.currentData()
        return next((one for one in self._studies if one.id == wanted), None)

    @property
    def plot(self) -> StudyPlot | None:
        """The plot shown, to be painted elsewhere; None when there is none."""
        return self.view.plot

    def show_studies(self, studies: Sequence[KeptStudy], *, chosen: str = "") -> None:
        """Offer these, the newest one first.

        Parameters
        ----------
        chosen : str
            Id of the one to show; empty: the one that is shown, or else the newest.
        """
        wanted = chosen or self._choice.currentData()
        self._studies = tuple(studies)
        with QSignalBlocker(self._choice):
            self._choice.clear()
            for one in reversed(self._studies):
                self._choice.addItem(self._title_of(one), one.id)
            if not self._studies:
                self._choice.addItem(self.tr("No study yet"), "")
            self._choice.setCurrentIndex(max(0, self._choice.findData(wanted)))
        self._choice.setEnabled(bool(self._studies))
        self._on_choice_activated()

    def refresh(self) -> None:
        """Paint the plot again: a tool's settings may be others."""
        tool = self.form.tool
        if tool:
            self.form.show_settings(settings_words(tool, self._values(tool), self._language))
        kept = self.kept
        for one in (self._use, self._export, self._remove, self._side):
            one.setEnabled(kept is not None)
        if kept is None:
            self._facts.clear()
            self.view.show_plot(None, self.tr("A study shows here how good each setting is."))
            return
        current = self._values(kept.study.tool)
        where = (
            kept.where
            if not kept.is_part
            else self.tr("a part of {drive}").format(drive=kept.where)
        )
        fixed = settings_words(kept.study.tool, kept.study.fixed, self._language)
        facts = " · ".join(
            one for one in (fixed, kept.truth.in_language(self._language), where) if one
        )
        plot = StudyPlot(
            study=kept.study,
            words=StudyWords(
                title=f"{self._title_of(kept)} – {self._side.currentText()}",
                facts=facts,
                precision=self.tr("precision"),
                recall=self.tr("recall"),
                f_measure="F",
                now=self.tr("now"),
                best=self.tr("best"),
            ),
            language=self._language,
            shows_removed=self._side.currentData() == _REMOVED,
            current=current,
            chosen=self._chosen,
        )
        self.view.show_plot(plot, "")
        self._show_chosen(plot)

    def _values(self, tool: str) -> Mapping[str, ParameterValue]:
        return {} if self._values_of is None else self._values_of(tool)

    def _lay_out(self) -> None:
        menu = QMenu(self)
        menu.addAction(self.tr("Table (CSV)"), lambda: self.export_requested.emit("csv"))
        menu.addAction(self.tr("Plot (PNG)"), lambda: self.export_requested.emit("png"))
        menu.addAction(self.tr("Plot (PDF)"), lambda: self.export_requested.emit("pdf"))
        self._export.setMenu(menu)
        above, below = QHBoxLayout(), QHBoxLayout()
        for row, widgets in (
            (above, (self._side, self._remove)),
            (below, (self._use, self._export)),
        ):
            row.setSpacing(8)
            for widget in widgets:
                row.addWidget(widget)
        above.setStretch(0, 1)
        beside = QVBoxLayout()
        beside.setSpacing(4)
        beside.addWidget(self._choice)
        beside.addLayout(above)
        beside.addWidget(self._facts)
        beside.addStretch(1)
        beside.addLayout(below)
        self.form.setMaximumWidth(_FORM_PX)
        self._choice.setFixedWidth(_BESIDE_PX)
        self._facts.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 8)
        layout.setSpacing(12)
        layout.addWidget(self.form, 3)
        layout.addWidget(self.view, 4)
        layout.addLayout(beside)

    def _title_of(self, kept: KeptStudy) -> str:
        tool = kept.study.tool
        names = [parameter_name(tool, one.parameter, self._language) for one in kept.study.varied]
        return f"{name_of_tool(tool, self._language)}: {' × '.join(names)}"

    def _show_chosen(self, plot: StudyPlot) -> None:
        cell = plot.chosen_cell
        self._use.setEnabled(cell is not None)
        if cell is None:
            self._facts.clear()
            return
        tool = plot.study.tool
        words = [
            f"{parameter_name(tool, one.parameter, self._language)} "
            f"{value_words(tool, one.parameter, value, self._language)}"
            for one, value in zip(plot.study.varied, cell.values, strict=True)
        ]
        counts = plot.counts_of(cell)
        words.append(f"F {100 * counts.f_measure:.2f} %")
        self._facts.setText("\n".join(words))

    def _on_choice_activated(self) -> None:
        self._chosen = -1
        kept = self.kept
        with QSignalBlocker(self._side):
            wanted = self._side.currentData()
            self._side.clear()
            if kept is not None and kept.study.tool in asked_classes():
                asked = asked_classes()[kept.study.tool]
                self._side.addItem(asked.removed.in_language(self._language), _REMOVED)
                self._side.addItem(asked.kept.in_language(self._language), _KEPT)
                self._side.setCurrentIndex(max(0, self._side.findData(wanted)))
        self.refresh()

    def _on_view_cell_clicked(self, number: int) -> None:
        self._chosen = number
        self.refresh()

    def _on_use_clicked(self) -> None:
        plot = self.plot
        cell = None if plot is None else plot.chosen_cell
        if plot is None or cell is None:
            return
        names = [one.parameter for one in plot.study.varied]
        values = {**plot.study.fixed, **dict(zip(names, cell.values, strict=True))}
        self.values_wanted.emit(plot.study.tool, values)
        self.refresh()

    def _on_remove_clicked(self) -> None:
        if self.kept is not None:
            self.removal_requested.emit(self.kept.id)


class StudyView(QWidget):
    """Shows one plot in the window's colours; a click chooses a setting.

    Signals
    -------
    cell_clicked(number: int)
        Of the study's cells.
    """

    cell_clicked = Signal(int)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._plot: StudyPlot | None = None
        self._empty = ""
        self._field = QRectF()
        self.setMinimumSize(160, 96)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    @property
    def plot(self) -> StudyPlot | None:
        """What it shows."""
        return self._plot

    def show_plot(self, plot: StudyPlot | None, empty: str) -> None:
        """Show a study; None: the words for nothing."""
        self._plot, self._empty = plot, empty
        self.update()

    def position_of(self, number: int) -> QPointF:
        """Where a cell of the study is painted, widget pixels."""
        if self._plot is None:
            return QPointF()
        return self._plot.position_of(number, self._field)

    @override
    def sizeHint(self) -> QSize:
        return QSize(420, 260)

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        with QPainter(self) as painter:
            colours = PlotColours.of(self.palette())
            painter.fillRect(self.rect(), colours.ground)
            if self._plot is None:
                painter.setPen(colours.faint)
                painter.drawText(self.rect(), int(Qt.AlignmentFlag.AlignCenter), self._empty)
                return
            self._field = self._plot.field_in(painter, QRectF(self.rect()))
            self._plot.paint(painter, QRectF(self.rect()), colours)

    @override
    def mousePressEvent(self, event: QMouseEvent) -> None:
        if self._plot is None or event.button() is not Qt.MouseButton.LeftButton:
            return
        number = self._plot.cell_at(event.position(), self._field)
        if number >= 0:
            self.cell_clicked.emit(number)

    @override
    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() is QEvent.Type.PaletteChange:
            self.update()
