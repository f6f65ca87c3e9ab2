"""QualityPanel: what stands against handing in the map, place by place."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from processing.core.text import Language, Text
from processing.map.quality.findings import RULES, Finding
from processing.map.quality.map_check import MapCheck, check_map
from processing.map.quality.repairs import MENDABLE, repair
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

BackgroundRunner = Callable[[Callable[[], object], Callable[[object | None], None]], None]

_MENDED = (
    Text("Mend a finding of the check", "点検の指摘を1件修正"),
    Text("Mend {count} findings of the check", "点検の指摘を{count}件修正"),
)
_COLUMNS = 4


class QualityPanel(QWidget):
    """A button that checks the map, and the findings: a row goes to its place in every view.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    in_background : callable
        Does the check beside the window: ``(work, take)``; ``take`` gets None where it failed.
    language : Language

    Signals
    -------
    change_requested(label: Text, change: Change)
        What can be mended by rule is to be mended, in one step.
    """

    change_requested = Signal(object, object)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        in_background: BackgroundRunner,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._selection = shared.selection
        self._cursor = shared.cursor
        self._in_background = in_background
        self._language: Language = language
        self._found: tuple[Finding, ...] | None = None
        self._is_checking = False
        self.check_button = QPushButton(self.tr("Check the map"), self)
        self.mend_button = QPushButton(self.tr("Mend"), self)
        self.mend_button.setToolTip(
            self.tr("Deletes copies and slips, joins ends: the rows marked, or all where none is")
        )
        self._words = QLabel(self)
        self._words.setWordWrap(True)
        self.table = self._new_table()
        self._lay_out()
        self.check_button.clicked.connect(self.check)
        self.mend_button.clicked.connect(self._on_mend_clicked)
        self.table.currentCellChanged.connect(self._on_table_current_changed)
        self.table.itemSelectionChanged.connect(self._show_state)
        changes = shared.map_changes
        changes.features_changed.connect(self._on_map_changed)
        changes.drives_changed.connect(self._on_map_changed)
        self._show_state()

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What the table shows; empty before the map was checked."""
        return self._found or ()

    def words(self) -> str:
        """What is written above the table."""
        return self._words.text()

    def check(self) -> None:
        """Look the map through beside the window, and show what was found."""
        features = tuple(self._source.features())
        if self._is_checking or not features:
            return
        self._is_checking = True
        self._show_state()
        check = partial(
            check_map,
            features,
            self._source.catalogue(),
            crs=self._source.crs(),
            drives={drive.id for drive in self._source.drives()},
        )
        self._in_background(check, self._take)

    def _new_table(self) -> QTableWidget:
        table = QTableWidget(0, _COLUMNS, self)
        table.setHorizontalHeaderLabels(
            [self.tr("Rule"), self.tr("Kind"), self.tr("Size"), self.tr("What to do")]
        )
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        table.setTabKeyNavigation(False)
        table.setWordWrap(False)
        table.verticalHeader().hide()
        header = table.horizontalHeader()
        header.setHighlightSections(False)
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setStretchLastSection(True)
        return table

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        row.addWidget(self.check_button)
        row.addWidget(self.mend_button)
        row.addWidget(self._words, stretch=1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(6, 6, 6, 6)
        layout.addLayout(row)
        layout.addWidget(self.table, stretch=1)

    def _take(self, found: object | None) -> None:
        self._is_checking = False
        self._found = found.findings if isinstance(found, MapCheck) else None
        with QSignalBlocker(self.table):  # nobody chose a row
            self.table.setRowCount(len(self.findings))
            for number, one in enumerate(self.findings):
                self._fill(number, one)
            self.table.setCurrentCell(-1, -1)
            self.table.clearSelection()
        self._show_state()

    def _fill(self, row: int, finding: Finding) -> None:
        rule, catalogue = RULES[finding.rule], self._source.catalogue()
        kind = catalogue[finding.kind].name if finding.kind in catalogue else finding.kind
        unit = "m" if finding.rule in ("gap", "sheet_gap") else "m²"
        size = "" if finding.extent_m is None else f"{finding.extent_m:.3f} {unit}"
        for column, words in enumerate((rule.name, kind, size, rule.remedy)):
            shown = words if isinstance(words, str) else words.in_language(self._language)
            item = QTableWidgetItem(shown)
            if column == 2:
                item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            self.table.setItem(row, column, item)

    def _marked(self) -> tuple[Finding, ...]:
        """The findings whose rows are marked; all where none is."""
        rows = sorted({index.row() for index in self.table.selectedIndexes()})
        return tuple(self.findings[row] for row in rows) or self.findings

    def _show_state(self) -> None:
        has_features = any(True for _ in self._source.features())
        self.check_button.setEnabled(has_features and not self._is_checking)
        can_mend = any(one.rule in MENDABLE for one in self._marked())
        self.mend_button.setEnabled(can_mend and not self._is_checking)
        self._words.setText(self._state(has_features=has_features))

    def _state(self, *, has_features: bool) -> str:
        if not has_features:
            return self.tr("Nothing is drawn yet.")
        if self._is_checking:
            return self.tr("Checking…")
        if self._found is None:
            return self.tr("Finds crossings, open ends, copies, overlaps and what is missing.")
        if not self._found:
            return self.tr("Nothing was found.")
        errors = sum(RULES[one.rule].is_error for one in self._found)
        return self.tr("{errors} errors, {others} to look at").format(
            errors=f"{errors:,}", others=f"{len(self._found) - errors:,}"
        )

    def _on_table_current_changed(self, row: int) -> None:
        if not 0 <= row < len(self.findings):
            return
        finding = self.findings[row]
        there = [id_ for id_ in finding.features if self._source.feature(id_) is not None]
        self._selection.choose_features(frozenset(there))
        self._cursor.move_to(PickedPosition(finding.position))

    def _on_mend_clicked(self) -> None:
        involved = {id_ for one in self._marked() for id_ in one.features}
        features = {id_: one for id_ in involved if (one := self._source.feature(id_)) is not None}
        change = repair([one for one in self._marked() if one.rule in MENDABLE], features)
        if change.is_empty:
            return
        count = len(change.removed) + len(change.replaced)
        self.change_requested.emit(_MENDED[count != 1].filled(count=f"{count:,}"), change)
        self.check()

    def _on_map_changed(self) -> None:
        # What was found may be mended, or gone with its project; nobody is shown old findings.
        if self._found is not None and not self._is_checking:
            self._take(None)
        else:
            self._show_state()
