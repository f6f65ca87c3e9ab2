"""ProjectRuns: the runs of tools as items of the project's tree, with what can be done to them."""

from __future__ import annotations

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QMenu, QTreeWidget, QTreeWidgetItem

from processing.core.text import Language, Text
from processing.map.change import Change
from processing.map.feature import Status
from widgets.panels.feature_tally import FeatureTally, RunOfTool, RunTally
from widgets.panels.run_words import counts_of_run, facts_of_run, name_of_run
from widgets.panels.tree_items import children_of
from widgets.shared.map_source import MapSource
from widgets.shared.view_settings import ViewSettings

RUN = Qt.ItemDataRole.UserRole + 1
"""Where an item keeps the id of its run."""

_DELETE = Text("Delete {count} undecided candidates", "未判定の候補{count}件を削除")


class ProjectRuns(QObject):
    """Lists the runs that features on the map come from.

    Parameters
    ----------
    source : MapSource
    settings : ViewSettings
    tree : QTreeWidget
        Its owner too.

    Signals
    -------
    review_requested(run: str), comparison_requested(run: str)
    change_requested(label: Text, change: Change)
    """

    review_requested = Signal(str)
    comparison_requested = Signal(str)
    change_requested = Signal(object, object)

    def __init__(
        self, source: MapSource, settings: ViewSettings, tree: QTreeWidget, language: Language
    ) -> None:
        super().__init__(tree)
        self._source = source
        self._settings = settings
        self._tree = tree
        self._language = language
        self._tally = FeatureTally(source)
        self._items: dict[RunOfTool, QTreeWidgetItem] = {}
        settings.hidden_runs_changed.connect(self._show_counts)

    def read_all(self) -> None:
        """Count the features of all runs."""
        self._tally.read_all()

    def took(self, ids: tuple[str, ...]) -> bool:
        """Count some features again; says whether other runs are to be listed now."""
        self._tally.read(ids)
        if list(self._tally.by_run) != list(self._items):
            return True
        self._show_counts()
        return False

    def add_to(self, folder: QTreeWidgetItem) -> None:
        """Make an item for each run."""
        self._items = {}
        for origin in self._tally.by_run:
            item = QTreeWidgetItem(folder)
            counts = QTreeWidgetItem(item)
            for one in (item, counts):
                one.setData(0, RUN, origin.run)
            counts.setFlags(Qt.ItemFlag.ItemIsEnabled)
            self._items[origin] = item
        self._show_counts()

    def forget(self) -> None:
        """The items are gone."""
        self._items = {}

    @property
    def is_empty(self) -> bool:
        """Whether no feature on the map comes from a run."""
        return not self._tally.by_run

    def menu_of(self, run: str) -> QMenu | None:
        """What can be done to a run; None for one that isn't listed."""
        found = {origin.run: tally for origin, tally in self._tally.by_run.items()}
        if run not in found:
            return None
        menu = QMenu(self._tree)
        is_hidden = run in self._settings.hidden_runs
        review = menu.addAction(self.tr("Review this run"), lambda: self.review_requested.emit(run))
        review.setEnabled(found[run].candidates > 0)
        compare = menu.addAction(
            self.tr("Compare with another run…"), lambda: self.comparison_requested.emit(run)
        )
        tool = next(origin.tool for origin in self._tally.by_run if origin.run == run)
        alike = [one for one in self._source.runs() if one.tool == tool]
        compare.setEnabled(len(alike) > 1)
        words = self.tr("Show its features") if is_hidden else self.tr("Hide its features")
        menu.addAction(words, lambda: self._toggle_hidden(run))
        menu.addSeparator()
        delete = menu.addAction(
            self.tr("Delete its undecided candidates"), lambda: self._delete_undecided(run)
        )
        delete.setEnabled(found[run].candidates > 0)
        menu.aboutToHide.connect(menu.deleteLater)
        return menu

    def _show_counts(self) -> None:
        runs = {run.id: run for run in self._source.runs()}
        names = {drive.id: drive.info.name for drive in self._source.drives()}
        for origin, tally in self._tally.by_run.items():
            item = self._items.get(origin)
            if item is None:
                continue
            name = name_of_run(origin, runs, self._language)
            facts = [name, counts_of_run(tally, self._language)]
            run = runs.get(origin.run)
            if run is not None:
                drives = [names[drive] for drive in run.drives if drive in names]
                facts += facts_of_run(run, drives, self._language)
            self._describe(item, f"{name} ({tally.total:,})", tally, "\n".join(facts))

    def _describe(self, item: QTreeWidgetItem, words: str, tally: RunTally, tooltip: str) -> None:
        is_hidden = item.data(0, RUN) in self._settings.hidden_runs
        (counts,) = children_of(item)
        item.setText(0, words)
        counts.setText(0, counts_of_run(tally, self._language, is_short=True))
        for one in (item, counts):
            one.setToolTip(0, tooltip)
            font = one.font(0)
            font.setItalic(is_hidden)
            font.setStrikeOut(is_hidden)
            one.setFont(0, font)
        counts.setForeground(0, self._tree.palette().placeholderText())

    def _toggle_hidden(self, run: str) -> None:
        hidden = self._settings.hidden_runs
        self._settings.hide_runs(hidden - {run} if run in hidden else hidden | {run})

    def _delete_undecided(self, run: str) -> None:
        features = tuple(
            feature
            for feature in self._source.features()
            if feature.provenance.run == run and feature.status is Status.CANDIDATE
        )
        if features:
            label = _DELETE.filled(count=f"{len(features):,}")
            self.change_requested.emit(label, Change(removed=features))
