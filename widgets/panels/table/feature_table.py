"""FeatureTable: all features of the map in rows, in step with the views."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from PySide6.QtCore import QPoint, Qt, QTimer, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QLabel, QStackedWidget, QVBoxLayout, QWidget
from typing_extensions import override

from processing.core.text import Language
from processing.map.feature import Feature, Vertex
from processing.map.feature_query import FeatureQuery
from widgets.mouse_tools.removal import removal_of
from widgets.panels.table.feature_filter import FeatureFilter
from widgets.panels.table.feature_menu import FeatureMenu
from widgets.panels.table.feature_table_model import FeatureTableModel, ids_of
from widgets.panels.table.rows_view import FeatureRowsView
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_READ_AHEAD = 2_000


class FeatureTable(QWidget):
    """The table, and above it the filter.

    It reads the map when it is first shown, and keeps up with changes from then on.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language

    Signals
    -------
    change_requested(label: Text, change: Change)
        Features were judged, made another kind or deleted.
    """

    change_requested = Signal(object, object)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._cursor = shared.cursor
        self._selection = shared.selection
        self._language = language
        self._is_read = False
        self._current_id = ""
        self._changed_unseen: dict[str, None] = {}
        self._unread: Iterator[Feature] = iter(())
        self._reading = QTimer(self)
        self._reading.timeout.connect(self._on_reading_timeout)
        self._filter = FeatureFilter(language, self)
        self._model = FeatureTableModel(source, language, self)
        self._table = FeatureRowsView(self._model, self)
        self._empty = QLabel(self)
        self._empty.setEnabled(False)
        self._empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._pages = QStackedWidget(self)
        self._pages.addWidget(self._table)
        self._pages.addWidget(self._empty)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self._filter)
        layout.addWidget(self._pages, 1)
        self._connect(shared)
        self._show_state()

    def _connect(self, shared: SharedState) -> None:
        self._filter.query_changed.connect(self._on_filter_query_changed)
        self._filter.select_requested.connect(self._on_filter_select_requested)
        self._table.centre_requested.connect(self._on_table_centre_requested)
        self._table.delete_requested.connect(self._on_table_delete_requested)
        self._table.customContextMenuRequested.connect(self._on_table_menu_requested)
        self._table.marked.connect(self._on_table_marked)
        self._table.went_to.connect(self._on_table_went_to)
        self._model.modelReset.connect(self._on_model_reset)
        shared.selection.features_changed.connect(self._on_selection_features_changed)
        shared.map_changes.features_changed.connect(self._on_map_features_changed)
        shared.map_changes.drives_changed.connect(self._on_map_drives_changed)

    @property
    def query(self) -> FeatureQuery:
        """The rule by which rows are found."""
        return self._filter.query

    def selected_features(self) -> tuple[Feature, ...]:
        """The features of the chosen rows; those that the filter hides are not among them."""
        rows, ranges = self._model.rows, sorted(self._table.marked_ranges())
        return tuple(one for top, bottom in ranges for one in rows.between(top, bottom))

    def menu(self) -> FeatureMenu | None:
        """The menu for the chosen rows, to be popped up; None when there are none."""
        features = self.selected_features()
        if not features:
            return None
        menu = FeatureMenu(features, self._source.catalogue(), self._language, self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.change_requested.connect(self.change_requested)
        menu.centre_requested.connect(self._on_table_centre_requested)
        menu.kinds_requested.connect(self._on_menu_kinds_requested)
        return menu

    @override
    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if not self._is_read:
            self._read_all()
        elif self._changed_unseen:
            self._read(tuple(self._changed_unseen))
        self._changed_unseen.clear()
        self._follow_selection()

    def _read_all(self) -> None:
        self._is_read = True
        self._model.read_all()
        self._table.fit_widths()
        self._show_state()
        self._unread = iter(self._model.rows.features)
        self._reading.start()

    def _read(self, ids: tuple[str, ...]) -> None:
        columns = self._model.columnCount()
        with self._table.reported():
            self._model.read(ids)
        if self._model.columnCount() != columns:
            self._table.fit_widths()
        self._table.mark_rows(self._rows_of(self._selection.features.intersection(ids)), adds=True)
        self._table.make_current(self._model.rows.row_of(self._current_id))
        self._show_state()

    def _rows_of(self, ids: frozenset[str]) -> list[int]:
        rows = map(self._model.rows.row_of, ids)
        return [row for row in rows if row >= 0]

    def _follow_selection(self) -> None:
        ids = self._selection.features
        if ids == ids_of(self.selected_features()):
            return
        rows = self._rows_of(ids)
        self._table.mark_rows(rows)
        if rows:
            self._current_id = self._model.rows.at(min(rows)).id
            self._go_to_current()

    def _go_to_current(self) -> None:
        self._table.make_current(self._model.rows.row_of(self._current_id))
        self._table.scrollTo(self._table.currentIndex())

    def _show_state(self) -> None:
        rows = self._model.rows
        self._filter.offer(rows.kinds, self._source.catalogue())
        self._filter.show_count(len(rows), rows.total)
        self._empty.setText(
            self.tr("No feature fits the filter.")
            if rows.total
            else self.tr("Features appear here once something is drawn.")
        )
        self._pages.setCurrentIndex(0 if len(rows) else 1)

    def _position_to_go(self, feature: Feature) -> Vertex | None:
        vertices = feature.vertices
        if self.query.has_occluded:
            return next((one for one in vertices if one.is_occluded), None)
        return vertices[0] if vertices else None

    def _on_filter_query_changed(self, query: FeatureQuery) -> None:
        columns = self._model.columnCount()
        self._model.find(query)
        if self._model.columnCount() != columns:
            self._table.fit_widths()
        self._show_state()

    def _on_filter_select_requested(self, adds: bool) -> None:  # noqa: FBT001 - a signal's
        rows = self._model.rows
        shown = ids_of(rows.between(0, len(rows) - 1))
        self._selection.choose_features(self._selection.features | shown if adds else shown)

    def _on_table_centre_requested(self) -> None:
        row = self._model.rows.row_of(self._current_id)
        feature = self._model.rows.at(row) if row >= 0 else None
        vertex = None if feature is None else self._position_to_go(feature)
        if vertex is not None:
            self._cursor.move_to(PickedPosition(vertex.xyz, vertex.measured))

    def _on_table_delete_requested(self) -> None:
        features = self.selected_features()
        if features:
            self.change_requested.emit(*removal_of(features))

    def _on_table_menu_requested(self, spot: QPoint) -> None:
        menu = self.menu()
        if menu is not None:
            menu.popup(self._table.viewport().mapToGlobal(spot))

    def _on_menu_kinds_requested(self, kinds: frozenset[str]) -> None:
        self._selection.choose_features(
            ids_of(one for one in self._source.features() if one.kind in kinds)
        )

    def _on_table_went_to(self, row: int) -> None:
        self._current_id = self._model.rows.at(row).id

    def _on_table_marked(self) -> None:
        self._selection.choose_features(ids_of(self.selected_features()))

    def _on_selection_features_changed(self) -> None:
        if self.isVisible():
            self._follow_selection()

    def _on_model_reset(self) -> None:
        self._table.show_order()
        self._table.mark_rows(self._rows_of(self._selection.features))
        if self._current_id in self._selection.features:
            self._go_to_current()

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        if not self._is_read:
            return
        if self.isVisible():
            self._read(ids)
        else:
            self._changed_unseen.update(dict.fromkeys(ids))

    def _on_map_drives_changed(self) -> None:
        self._is_read = False
        self._changed_unseen.clear()
        if self.isVisible():
            self._read_all()

    def _on_reading_timeout(self) -> None:
        """Read the words of attributes between events, so that the first search is quick too."""
        some = list(islice(self._unread, _READ_AHEAD))
        if not some:
            self._reading.stop()
        self._model.rows.search_texts_of(some)
