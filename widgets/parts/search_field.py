"""SearchField: words that narrow a tree; arrows and Enter choose in it, Escape leaves."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QLineEdit, QTreeWidget, QTreeWidgetItem, QWidget
from typing_extensions import override

_STEPS = {
    Qt.Key.Key_Down: 1,
    Qt.Key.Key_Up: -1,
    Qt.Key.Key_PageDown: 10,
    Qt.Key.Key_PageUp: -10,
}


class SearchField(QLineEdit):
    """A line above a tree; the keys stay here while entries are chosen there.

    Enter acts as a click on the current entry does. The first Escape empties the line, the next
    gives the keys to the tree.

    Parameters
    ----------
    tree : QTreeWidget
        What is searched.
    """

    def __init__(self, tree: QTreeWidget, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._tree = tree
        self.setClearButtonEnabled(True)

    @override
    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = Qt.Key(event.key())
        if key in _STEPS:
            self._step(_STEPS[key])
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            item = self._tree.currentItem()
            if item is not None and not item.isHidden():
                self._tree.itemClicked.emit(item, 0)
        elif key == Qt.Key.Key_Escape and self.text():
            self.clear()
        elif key == Qt.Key.Key_Escape:
            self._tree.setFocus()
        else:
            super().keyPressEvent(event)
            return
        event.accept()

    def _step(self, count: int) -> None:
        items = self._choosable()
        if not items:
            return
        current = self._tree.currentItem()
        position = items.index(current) + count if current in items else max(count - 1, 0)
        self._tree.setCurrentItem(items[min(max(position, 0), len(items) - 1)])

    def _choosable(self) -> list[QTreeWidgetItem]:
        """Entries that are shown and can be chosen, from top to bottom."""
        found: list[QTreeWidgetItem] = []
        item = self._tree.topLevelItem(0)
        while item is not None:
            if not item.isHidden() and item.flags() & Qt.ItemFlag.ItemIsSelectable:
                found.append(item)
            item = self._tree.itemBelow(item)
        return found
