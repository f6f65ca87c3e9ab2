"""DeliveryTable: the files of an import, each with what it holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QHeaderView, QTreeWidget, QTreeWidgetItem, QWidget

_FILE = 0
_PATH = Qt.ItemDataRole.UserRole
_WARNING = QColor("#c2571a")
"""Dark enough on a light ground and light enough on a dark one."""


@dataclass(frozen=True)
class DeliveredRow:
    """What is said of one file.

    Attributes
    ----------
    cells : tuple of str
        Kind, number, extent, scanner, time, reference system, trajectory.
    is_wanting : bool
        Something is missing or wrong: the last cell that says something says what.
    """

    path: Path
    cells: tuple[str, ...]
    is_wanting: bool = False


class DeliveryTable(QTreeWidget):
    """A line a file; files that were not looked at yet have their names only."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        titles = (
            self.tr("File"),
            self.tr("Kind"),
            self.tr("Number"),
            self.tr("Extent"),
            self.tr("Scanner"),
            self.tr("Time"),
            self.tr("Reference system"),
            self.tr("Trajectory"),
        )
        self.setColumnCount(len(titles))
        self.setHeaderLabels(titles)
        self.setRootIsDecorated(False)
        self.setUniformRowHeights(True)
        self.setAllColumnsShowFocus(True)
        self.setSelectionMode(QTreeWidget.SelectionMode.ExtendedSelection)
        self.header().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        self.header().setStretchLastSection(True)

    @property
    def files(self) -> tuple[Path, ...]:
        """The files, in the order in which they were added."""
        return tuple(item.data(_FILE, _PATH) for item in self._items())

    def add_files(self, files: Sequence[Path]) -> None:
        """Add files; those that are there already stay once."""
        known = set(self.files)
        for file in files:
            if file not in known:
                known.add(file)
                item = QTreeWidgetItem(self, [file.name])
                item.setData(_FILE, _PATH, file)
                item.setToolTip(_FILE, str(file))

    def remove_selected(self) -> None:
        """Take the chosen files out."""
        for item in self.selectedItems():
            self.takeTopLevelItem(self.indexOfTopLevelItem(item))

    def show_rows(self, rows: Sequence[DeliveredRow]) -> None:
        """Say what files hold; a folder's files stand below it."""
        items = {item.data(_FILE, _PATH): item for item in self._items()}
        for item in items.values():
            item.takeChildren()
            for column in range(1, self.columnCount()):
                item.setText(column, "")
        for row in rows:
            found = items.get(row.path)
            if found is None:
                folder = items.get(row.path.parent)
                found = QTreeWidgetItem(folder, [row.path.name]) if folder is not None else None
            if found is not None:
                _fill(found, row)
        self.expandAll()

    def _items(self) -> list[QTreeWidgetItem]:
        found = (self.topLevelItem(row) for row in range(self.topLevelItemCount()))
        return [item for item in found if item is not None]


def _fill(item: QTreeWidgetItem, row: DeliveredRow) -> None:
    said = [column for column, words in enumerate(row.cells, start=1) if words]
    for column, words in enumerate(row.cells, start=1):
        item.setText(column, words)
        item.setToolTip(column, words)
    if row.is_wanting and said:
        item.setForeground(said[-1], _WARNING)
