"""Search fields: arrows and Enter choose in the tree, Escape empties and then leaves."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QTreeWidget, QTreeWidgetItem, QVBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from widgets.parts.search_field import SearchField


@pytest.fixture
def window(qtbot: QtBot) -> QWidget:
    window = QWidget()
    qtbot.addWidget(window)
    tree = QTreeWidget(window)
    group = QTreeWidgetItem(tree, ["Road"])
    group.setFlags(Qt.ItemFlag.ItemIsEnabled)
    for name in ("Curbs", "Gutters", "Trees"):
        QTreeWidgetItem(group, [name])
    tree.expandAll()
    field = SearchField(tree, window)
    layout = QVBoxLayout(window)
    layout.addWidget(field)
    layout.addWidget(tree)
    window.show()
    with qtbot.waitActive(window):
        window.activateWindow()
    field.setFocus()
    qtbot.waitUntil(field.hasFocus)
    return window


def parts_of(window: QWidget) -> tuple[SearchField, QTreeWidget]:
    field, tree = window.findChild(SearchField), window.findChild(QTreeWidget)
    assert isinstance(field, SearchField)
    assert isinstance(tree, QTreeWidget)
    return field, tree


def test_arrows_choose_entries_but_no_headings_and_enter_acts(
    qtbot: QtBot, window: QWidget
) -> None:
    field, tree = parts_of(window)
    qtbot.keyClick(field, Qt.Key.Key_Down)
    assert tree.currentItem().text(0) == "Curbs"
    qtbot.keyClick(field, Qt.Key.Key_Down)
    with qtbot.waitSignal(tree.itemClicked) as clicked:
        qtbot.keyClick(field, Qt.Key.Key_Return)
    assert clicked.args[0].text(0) == "Gutters"
    qtbot.keyClick(field, Qt.Key.Key_Up)
    qtbot.keyClick(field, Qt.Key.Key_Up)
    assert tree.currentItem().text(0) == "Curbs"


def test_escape_empties_the_field_and_then_leaves_it(qtbot: QtBot, window: QWidget) -> None:
    field, _ = parts_of(window)
    qtbot.keyClicks(field, "curb")
    qtbot.keyClick(field, Qt.Key.Key_Escape)
    assert field.text() == ""
    assert field.hasFocus()
    qtbot.keyClick(field, Qt.Key.Key_Escape)
    assert not field.hasFocus()
