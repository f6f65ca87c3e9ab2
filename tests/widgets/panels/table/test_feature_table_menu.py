"""The table of features: its menu, its hidden times, ten thousand rows, its language."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QApplication,
)
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.map.change import Change
from processing.map.feature import Status
from tests.widgets.builders import OpenMap
from tests.widgets.panels.table_user import (
    NONE,
    act,
    cells,
    change,
    choose,
    column,
    curb,
    draw,
    menu_of,
    middle_of,
    pick,
    pole,
    rows_in,
    type_words,
)
from widgets.panels.table.feature_table import FeatureTable
from widgets.shared.cursor import PickedPosition


def test_the_menu_judges_the_chosen_rows_in_one_step(
    table: FeatureTable, open_map: OpenMap
) -> None:
    poles = [pole(i, status=Status.CANDIDATE) for i in range(3)]
    draw(open_map, *poles)
    choose(open_map, *poles[:2])
    act(table, "Reject")
    assert cells(table, "Status") == ["Rejected", "Rejected", "Candidate"]
    assert open_map.applied[-1][0] == Text("Reject 2 features", "2個の地物を却下")
    act(table, "Accept")
    act(table, "Make a candidate")
    assert cells(table, "Status") == ["Candidate"] * 3


def test_the_menu_offers_kinds_of_the_same_geometry(table: FeatureTable, open_map: OpenMap) -> None:
    draw(open_map, pole(1), pole(2), curb("a", 2.0))
    choose(open_map, *open_map.features())
    menu = table.menu()
    assert menu is not None
    (kinds,) = [menu_of(one) for one in menu.actions() if one.menu() is not None]
    assert not kinds.isEnabled()
    menu.close()
    choose(open_map, pole(1), pole(2))
    act(table, "Change kind to", "Sign")
    assert cells(table, "Kind") == ["Sign", "Sign", "Curb"]
    assert "Sign" in open_map.applied[-1][0].en


def test_the_menu_selects_all_of_a_kind_and_goes_there(
    table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, pole(1), curb("a", 2.0), pole(2))
    choose(open_map, pole(2))
    act(table, "Go there")
    assert open_map.shared.cursor.position == PickedPosition((2.0, 0.0, 5.0))
    act(table, "Select all of this kind")
    assert open_map.shared.selection.features == {"pole-00001", "pole-00002"}


def test_nothing_chosen_has_no_menu_and_deletes_nothing(
    qtbot: QtBot, table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, pole(1))
    assert table.menu() is None
    qtbot.keyClick(rows_in(table), Qt.Key.Key_Delete)
    qtbot.keyClick(rows_in(table), Qt.Key.Key_Return)
    assert len(open_map.stored) == 1
    assert open_map.shared.cursor.position is None


def test_a_kind_that_the_catalogue_lacks_is_shown_by_its_id(
    table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, pole(1, kind="old_kind"), pole(2, kind="old_kind"))
    assert cells(table, "Kind") == ["old_kind", "old_kind"]
    assert cells(table, "Layer") == ["", ""]
    pick(table, "kind", "old_kind")
    choose(open_map, *open_map.features())
    act(table, "Change kind to", "Pole")
    assert cells(table, "Kind") == ["Pole", "Pole"]


def test_what_changes_while_the_table_is_hidden_is_read_when_it_is_shown(
    table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, pole(1))
    table.hide()
    draw(open_map, pole(2))
    change(open_map, pole(1, status=Status.REJECTED))
    choose(open_map, pole(2))
    table.show()
    assert cells(table, "Status") == ["Rejected", "Accepted"]
    assert [one.id for one in table.selected_features()] == ["pole-00002"]


def test_what_is_selected_while_the_table_is_hidden_is_marked_when_it_is_shown(
    table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, *(pole(i) for i in range(100)))
    table.hide()
    choose(open_map, pole(80))
    assert table.selected_features() == ()
    table.show()
    assert table.selected_features() == (pole(80),)
    view = rows_in(table)
    assert view.viewport().rect().contains(middle_of(view, 80))


def test_another_project_is_read_anew(table: FeatureTable, open_map: OpenMap) -> None:
    draw(open_map, pole(1))
    open_map.stored = {"curb-z": curb("z", 5.0)}
    open_map.shared.map_changes.drives_changed.emit()
    assert cells(table, "Kind") == ["Curb"]


def test_ten_thousand_scattered_rows_are_selected_judged_and_deleted(
    table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, *(pole(i) for i in range(20_000)))
    choose(open_map, *(pole(i) for i in range(0, 20_000, 2)))
    act(table, "Reject")
    assert len(table.selected_features()) == 10_000
    assert open_map.applied[-1][0].en == "Reject 10,000 features"
    act(table, "Delete")
    assert len(cells(table, "Kind")) == 10_000
    assert table.selected_features() == ()


@pytest.mark.parametrize(
    ("key", "modifiers"),
    [
        (Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier),
        (Qt.Key.Key_Return, NONE),
        (Qt.Key.Key_Delete, NONE),
    ],
)
def test_keys_that_the_window_has_too_mean_rows_here(
    table: FeatureTable, open_map: OpenMap, key: Qt.Key, modifiers: Qt.KeyboardModifier
) -> None:
    draw(open_map, pole(1))
    asked = QKeyEvent(QEvent.Type.ShortcutOverride, key, modifiers)
    asked.ignore()
    QApplication.sendEvent(rows_in(table), asked)
    assert asked.isAccepted()


def test_the_order_is_marked_at_its_column_when_columns_come_and_go(
    table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, pole(2), pole(1))
    view = rows_in(table)
    view.sortByColumn(column(table, "Status"), Qt.SortOrder.DescendingOrder)
    view.sortByColumn(column(table, "Vertices"), Qt.SortOrder.DescendingOrder)
    draw(open_map, curb("a", 2.0))
    header = view.horizontalHeader()
    assert header.sortIndicatorSection() == column(table, "Vertices")
    assert cells(table, "Vertices") == ["2", "1", "1"]
    open_map.apply(Text.same("away"), Change(removed=(open_map.stored["curb-a"],)))
    view.sortByColumn(column(table, "Number"), Qt.SortOrder.AscendingOrder)
    assert cells(table, "Number") == ["No. 1", "No. 2"]
    draw(open_map, curb("b", 2.0))
    assert header.sortIndicatorSection() == -1
    assert cells(table, "Kind") == ["Pole", "Pole", "Curb"]


def test_the_table_speaks_japanese(qtbot: QtBot, open_map: OpenMap) -> None:
    table = FeatureTable(open_map, open_map.shared, "ja")
    qtbot.addWidget(table)
    table.show()
    draw(open_map, pole(1, status=Status.REJECTED))
    assert cells(table, "種別") == ["電柱"]
    assert cells(table, "状態") == ["却下"]
    assert cells(table, "作成元") == ["手作業"]
    type_words(table, "pole")
    assert cells(table, "高さ (m)") == ["1"]
