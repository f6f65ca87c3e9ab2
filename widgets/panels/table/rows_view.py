"""FeatureRowsView: the rows of the feature table, what is marked in them, and their keys."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from PySide6.QtCore import (
    QEvent,
    QItemSelection,
    QItemSelectionModel,
    QModelIndex,
    QPersistentModelIndex,
    QSignalBlocker,
    QSize,
    Qt,
    Signal,
)
from PySide6.QtGui import QKeyEvent, QKeySequence, QPainter, QPalette
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableView,
    QWidget,
)
from typing_extensions import override

from widgets.panels.table.feature_table_model import FeatureTableModel

_ROW_PX = 22
_PAD_PX = 4
_ROWS_MEASURED = 50
_WIDEST_PX = 260
_FLAG = QItemSelectionModel.SelectionFlag


class FeatureRowsView(QTableView):
    """The rows themselves, and their keys.

    Parameters
    ----------
    model : FeatureTableModel

    Signals
    -------
    marked
        The user marked other rows.
    went_to(row: int)
        The user moved the keyboard's row.
    centre_requested
        A double click or Enter.
    delete_requested
        The Delete key.
    """

    marked = Signal()
    went_to = Signal(int)
    centre_requested = Signal()
    delete_requested = Signal()

    def __init__(self, model: FeatureTableModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._is_reported = False
        self._model = model
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.setAlternatingRowColors(True)
        self.setShowGrid(False)
        self.setWordWrap(False)
        self.setTabKeyNavigation(False)
        self.setCornerButtonEnabled(False)
        rows = self.verticalHeader()
        rows.hide()
        rows.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        rows.setDefaultSectionSize(_ROW_PX)
        columns = self.horizontalHeader()
        columns.setHighlightSections(False)
        columns.setResizeContentsPrecision(_ROWS_MEASURED)
        columns.setSortIndicatorClearable(True)
        columns.setSortIndicator(-1, Qt.SortOrder.AscendingOrder)
        self.setSortingEnabled(True)
        self.setModel(model)
        self.setItemDelegate(_PaddedCells(self))
        # A header asks of each column whether all of it is marked, row by row; it needn't know.
        columns.setSelectionModel(QItemSelectionModel(model, columns))
        self.doubleClicked.connect(self.centre_requested)
        self.selectionModel().selectionChanged.connect(self._on_selection_changed)
        self.selectionModel().currentRowChanged.connect(self._on_current_row_changed)

    def marked_ranges(self) -> list[tuple[int, int]]:
        """First and last row of each run of marked rows, in no order."""
        selection = self.selectionModel().selection()
        ranges = map(selection.at, range(selection.size()))
        return [(one.top(), one.bottom()) for one in ranges]

    def mark_rows(self, rows: Iterable[int], *, adds: bool = False) -> None:
        """Mark exactly these rows, or these too; tells nobody."""
        marks = self.selectionModel()
        if adds:
            rows = [row for row in rows if not marks.isRowSelected(row, QModelIndex())]
            if not rows:
                return
        ranges = QItemSelection()
        for top, bottom in _runs(sorted(rows)):
            ranges.append(self._model.rows_between(top, bottom))
        with self.reported():
            if not adds:
                # Qt compares every old range with every new one, unless there are no old ones.
                current = self.currentIndex()
                marks.reset()
                marks.setCurrentIndex(current, _FLAG.NoUpdate)
            marks.select(ranges, _FLAG.Select)
        self.viewport().update()

    @contextmanager
    def reported(self) -> Iterator[None]:
        """A time in which what becomes of the marked rows is not the user's doing."""
        before, self._is_reported = self._is_reported, True
        try:
            yield
        finally:
            self._is_reported = before

    def show_order(self) -> None:
        """Mark the column by which rows are sorted; it may stand elsewhere than before."""
        header = self.horizontalHeader()
        with QSignalBlocker(header):
            header.setSortIndicator(*self._model.sorted_by)

    def make_current(self, row: int) -> None:
        """Put the keyboard's row somewhere without marking it; −1: nowhere."""
        index = self._model.index(row, 0) if row >= 0 else QModelIndex()
        with self.reported():
            self.selectionModel().setCurrentIndex(index, _FLAG.NoUpdate)

    def fit_widths(self) -> None:
        """Make columns as wide as what they show, within reason."""
        self.resizeColumnsToContents()
        for column in range(self._model.columnCount()):
            if self.columnWidth(column) > _WIDEST_PX:
                self.setColumnWidth(column, _WIDEST_PX)

    @override
    def selectAll(self) -> None:
        self.mark_rows(range(self._model.rowCount()))
        self.marked.emit()

    @override
    def event(self, event: QEvent) -> bool:
        # The window has actions with the same keys; here they mean rows.
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            is_ours = event.key() in (Qt.Key.Key_Delete, Qt.Key.Key_Return, Qt.Key.Key_Enter)
            if is_ours or event.matches(QKeySequence.StandardKey.SelectAll):
                event.accept()
                return True
        return super().event(event)

    @override
    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.centre_requested.emit()
        elif event.key() == Qt.Key.Key_Delete:
            self.delete_requested.emit()
        else:
            super().keyPressEvent(event)

    def _on_current_row_changed(self, index: QModelIndex) -> None:
        if not self._is_reported and index.isValid():
            self.went_to.emit(index.row())

    def _on_selection_changed(self) -> None:
        if not self._is_reported:
            self.marked.emit()


class _PaddedCells(QStyledItemDelegate):
    """Keeps numbers at the right of a cell off the words at the left of the next one."""

    @override
    def paint(
        self,
        painter: QPainter,
        option: QStyleOptionViewItem,
        index: QModelIndex | QPersistentModelIndex,
    ) -> None:
        cell = QStyleOptionViewItem(option)
        # A row is what is chosen: no frame about one of its cells.
        cell.state &= ~QStyle.StateFlag.State_HasFocus
        if cell.state & QStyle.StateFlag.State_Selected:
            is_active = bool(cell.state & QStyle.StateFlag.State_Active)
            group = QPalette.ColorGroup.Active if is_active else QPalette.ColorGroup.Inactive
            painter.fillRect(cell.rect, cell.palette.brush(group, QPalette.ColorRole.Highlight))
        cell.rect.adjust(0, 0, -_PAD_PX, 0)
        super().paint(painter, cell, index)

    @override
    def sizeHint(
        self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> QSize:
        return super().sizeHint(option, index) + QSize(_PAD_PX, 0)


def _runs(rows: list[int]) -> Iterator[tuple[int, int]]:
    """First and last of each run of consecutive rows; ``rows`` rise."""
    top = bottom = -1
    for row in rows:
        if row != bottom + 1 or top < 0:
            if top >= 0:
                yield top, bottom
            top = row
        bottom = row
    if top >= 0:
        yield top, bottom
