"""The items of trees as lists."""

from __future__ import annotations

from PySide6.QtWidgets import QTreeWidget, QTreeWidgetItem


def children_of(parent: QTreeWidget | QTreeWidgetItem) -> list[QTreeWidgetItem]:
    """The items directly below, in their order."""
    if isinstance(parent, QTreeWidget):
        found = [parent.topLevelItem(i) for i in range(parent.topLevelItemCount())]
    else:
        found = [parent.child(i) for i in range(parent.childCount())]
    return [item for item in found if item is not None]
