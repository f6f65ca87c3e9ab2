"""RunChooser: which runs' candidates are judged, and in which order."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QComboBox, QMenu, QPushButton, QSizePolicy, QVBoxLayout, QWidget

from processing.core.text import Language
from processing.project.review.review_state import ReviewOrder
from widgets.panels.feature_tally import RunOfTool, RunTally
from widgets.panels.run_words import name_of_run
from widgets.parts.literal_text import literal
from widgets.shared.map_source import MapSource


class RunChooser(QWidget):
    """A menu of runs that can be marked, and a list of orders.

    Signals
    -------
    runs_chosen(runs: tuple[str, ...])
        Their ids; at least one.
    order_chosen(order: ReviewOrder)
    """

    runs_chosen = Signal(object)
    order_chosen = Signal(object)

    def __init__(self, source: MapSource, language: Language, parent: QWidget) -> None:
        super().__init__(parent)
        self._source = source
        self._language = language
        self._names: dict[str, str] = {}
        self._chosen: tuple[str, ...] = ()
        self._button = QPushButton(self)
        self._button.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self._button.setToolTip(self.tr("The runs whose candidates are judged"))
        self._menu = QMenu(self._button)
        self._menu.aboutToShow.connect(self._fill)
        self._button.setMenu(self._menu)
        self._tallies: dict[RunOfTool, RunTally] = {}
        self._order = QComboBox(self)
        self._order.addItem(self.tr("Worst first"), ReviewOrder.CONFIDENCE)
        self._order.addItem(self.tr("Along the street"), ReviewOrder.STREET)
        self._order.setToolTip(
            self.tr("Whether the least certain candidates come first, or the nearest on the drive")
        )
        self._order.activated.connect(self._on_order_activated)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        layout.addWidget(self._button)
        layout.addWidget(self._order)

    @property
    def order(self) -> ReviewOrder:
        """The order that is chosen."""
        return ReviewOrder(self._order.currentData())

    @property
    def words(self) -> str:
        """What the button says."""
        if len(self._chosen) == 1:
            return self._names[self._chosen[0]]
        if len(self._chosen) == len(self._names):
            return self.tr("All runs")
        return self.tr("%n run(s)", "", len(self._chosen))

    @property
    def menu(self) -> QMenu:
        """The runs, once it is about to show."""
        return self._menu

    def show_runs(
        self, tallies: dict[RunOfTool, RunTally], chosen: tuple[str, ...], order: ReviewOrder
    ) -> None:
        """Offer these runs, with some of them chosen."""
        known = {origin.run for origin in tallies}
        if known != set(self._names):
            runs = {run.id: run for run in self._source.runs()}
            self._names = {one.run: name_of_run(one, runs, self._language) for one in tallies}
        self._tallies = tallies
        self._chosen = tuple(run for run in chosen if run in known)
        self._order.setCurrentIndex(self._order.findData(order))
        self._button.setText(literal(self.words))

    def _fill(self) -> None:
        self._menu.clear()
        everything = self._menu.addAction(self.tr("All runs"))
        everything.triggered.connect(lambda: self._choose(tuple(self._names)))
        self._menu.addSeparator()
        for origin, tally in self._tallies.items():
            name = self._names[origin.run]
            left = self.tr("%n left", "", tally.candidates)
            action = self._menu.addAction(literal(f"{name}  ({left})"))
            action.setCheckable(True)
            action.setChecked(origin.run in self._chosen)
            self._connect(action, origin.run)

    def _connect(self, action: QAction, run: str) -> None:
        action.triggered.connect(lambda: self._toggle(run))

    def _toggle(self, run: str) -> None:
        is_chosen = run in self._chosen
        wanted = {*self._chosen} - {run} if is_chosen else {*self._chosen, run}
        self._choose(tuple(one for one in self._names if one in wanted))

    def _choose(self, runs: tuple[str, ...]) -> None:
        if runs:
            self.runs_chosen.emit(runs)

    def _on_order_activated(self) -> None:
        self.order_chosen.emit(self.order)
