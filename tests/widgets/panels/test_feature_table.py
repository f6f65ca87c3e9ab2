"""The table of features: in step with the selection and the map, sorted, filtered, by keys."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import pytest
from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QAction, QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QComboBox,
    QLabel,
    QLineEdit,
    QMenu,
    QPushButton,
    QTableView,
)
from pytestqt.qtbot import QtBot

from processing.project.catalogue import AttributeField, Catalogue, FeatureKind, Geometry
from processing.project.change import Change, Replacement
from processing.project.feature import AttributeValue, Feature, Provenance, Status, Vertex
from processing.text import Text
from tests.widgets.builders import KINDS, OpenMap
from widgets.panels.feature_table import FeatureTable
from widgets.panels.feature_table_model import MOST_SINGLE_CHANGES
from widgets.shared.cursor import Place

NONE = Qt.KeyboardModifier.NoModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier
LEFT = Qt.MouseButton.LeftButton

POLE = FeatureKind(
    "pole",
    Text("Pole", "電柱"),
    Geometry.POINT,
    "",
    "poles",
    "#009e73",
    96,
    attributes=(
        AttributeField("number", Text("Number", "番号"), "text"),
        AttributeField("height_m", Text("Height", "高さ"), "number", "m"),
    ),
)
SIGN = FeatureKind("sign", Text("Sign", "道路標識"), Geometry.POINT, "", "sign", "#cc79a7", 6)


class MapWithPoles(OpenMap):
    def catalogue(self) -> Catalogue:
        return CATALOGUE


CATALOGUE = Catalogue((*(kind for kind in KINDS if kind.id != "pole"), POLE, SIGN))


def pole(number: int, **fields: object) -> Feature:
    place = Vertex((float(number), 0.0, 5.0))
    attributes: dict[str, AttributeValue] = {
        "number": f"No. {number}",
        "height_m": float(number),
    }
    feature = Feature(f"pole-{number:05}", "pole", Geometry.POINT, (place,), attributes)
    return replace(feature, **fields)  # type: ignore[arg-type]


def curb(name: str, length_m: float, **fields: object) -> Feature:
    ends = Vertex((-11_000.0, -35_000.0, 5.0)), Vertex((-11_000.0 + length_m, -35_000.0, 5.0))
    feature = Feature(f"curb-{name}", "curb", Geometry.LINE, ends)
    return replace(feature, **fields)  # type: ignore[arg-type]


@pytest.fixture
def open_map() -> OpenMap:
    return MapWithPoles()


@pytest.fixture
def table(qtbot: QtBot, open_map: OpenMap) -> FeatureTable:
    made = FeatureTable(open_map, open_map.shared, "en")
    made.change_requested.connect(open_map.apply)
    qtbot.addWidget(made)
    made.resize(1000, 400)
    made.show()
    return made


def draw(open_map: OpenMap, *features: Feature) -> None:
    open_map.apply(Text.same("draw"), Change(added=features))


def change(open_map: OpenMap, *afters: Feature) -> None:
    pairs = tuple(Replacement(open_map.stored[after.id], after) for after in afters)
    open_map.apply(Text.same("change"), Change(replaced=pairs))


def rows_in(table: FeatureTable) -> QTableView:
    view = table.findChild(QTableView)
    assert view is not None
    return view


def type_words(table: FeatureTable, words: str, line: str = "words") -> None:
    field = table.findChild(QLineEdit, line)
    assert field is not None
    field.setText(words)


def pick(table: FeatureTable, box_name: str, words: str) -> None:
    box = table.findChild(QComboBox, box_name)
    assert box is not None
    index = box.findText(words)
    assert index >= 0, [box.itemText(i) for i in range(box.count())]
    box.setCurrentIndex(index)


def written(table: FeatureTable) -> list[str]:
    return [label.text() for label in table.findChildren(QLabel) if label.isVisible()]


def menu_of(entry: QAction) -> QMenu:
    menu = entry.menu()
    assert isinstance(menu, QMenu)
    return menu


def act(table: FeatureTable, *path: str) -> None:
    """Choose from the context menu, by its words."""
    menu = table.menu()
    assert menu is not None
    actions = menu.actions()
    for words in path[:-1]:
        (entry,) = [one for one in actions if one.text() == words]
        actions = menu_of(entry).actions()
    (action,) = [one for one in actions if one.text().split("\t")[0] == path[-1]]
    assert isinstance(action, QAction)
    assert action.isEnabled()
    action.trigger()
    menu.close()


def column(table: FeatureTable, title: str) -> int:
    model = rows_in(table).model()
    titles = [model.headerData(i, Qt.Orientation.Horizontal) for i in range(model.columnCount())]
    return titles.index(title)


def cells(table: FeatureTable, title: str) -> list[str]:
    model = rows_in(table).model()
    number = column(table, title)
    return [model.index(row, number).data() for row in range(model.rowCount())]


def choose(open_map: OpenMap, *features: Feature) -> None:
    open_map.shared.selection.choose_features(frozenset(one.id for one in features))


def click_row(qtbot: QtBot, table: FeatureTable, row: int, modifiers: Qt.KeyboardModifier) -> None:
    view = rows_in(table)
    qtbot.mouseClick(view.viewport(), LEFT, modifiers, middle_of(view, row))


def middle_of(view: QTableView, row: int) -> QPoint:
    return view.visualRect(view.model().index(row, 0)).center()


def test_each_feature_is_a_row_with_what_is_known_of_it(
    table: FeatureTable, open_map: OpenMap
) -> None:
    tool = Provenance("normals", 1, confidence=0.873)
    occluded = Vertex((-10_990.0, -35_000.0, 5.0), is_occluded=True)
    candidate = curb("a", 1234.5, status=Status.CANDIDATE, provenance=tool)
    draw(open_map, candidate.with_vertices((*candidate.vertices, occluded)), pole(1))
    assert cells(table, "Kind") == ["Curb", "Pole"]
    assert cells(table, "Status") == ["Candidate", "Accepted"]
    assert cells(table, "Layer") == ["curb", "poles"]
    assert cells(table, "Length (m)") == ["2,459.000", ""]
    assert cells(table, "Vertices") == ["3", "1"]
    assert cells(table, "Occluded") == ["1", ""]
    assert cells(table, "Confidence (%)") == ["87", ""]
    assert cells(table, "Origin")[1] == "By hand"


def test_attributes_are_columns_while_all_rows_are_of_one_kind(
    table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, pole(1), pole(2))
    assert cells(table, "Height (m)") == ["1", "2"]
    draw(open_map, curb("a", 3.0))
    model = rows_in(table).model()
    titles = [model.headerData(i, Qt.Orientation.Horizontal) for i in range(model.columnCount())]
    assert "Height (m)" not in titles
    pick(table, "kind", "Pole")
    assert cells(table, "Number") == ["No. 1", "No. 2"]


def test_without_features_a_line_says_what_would_be_here(
    table: FeatureTable, open_map: OpenMap
) -> None:
    assert "Features appear here once something is drawn." in written(table)
    draw(open_map, pole(1))
    assert rows_in(table).isVisible()
    type_words(table, "zebra")
    assert "No feature fits the filter." in written(table)


def test_numbers_are_sorted_as_numbers_and_blanks_stay_last(
    table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, curb("a", 9.0), pole(1), curb("b", 10.0), curb("c", 2.0))
    view = rows_in(table)
    view.sortByColumn(column(table, "Length (m)"), Qt.SortOrder.AscendingOrder)
    assert cells(table, "Length (m)") == ["2.000", "9.000", "10.000", ""]
    view.sortByColumn(column(table, "Length (m)"), Qt.SortOrder.DescendingOrder)
    assert cells(table, "Length (m)") == ["10.000", "9.000", "2.000", ""]


def test_a_column_with_values_of_the_wrong_type_is_sorted_all_the_same(
    table: FeatureTable, open_map: OpenMap
) -> None:
    values: Iterable[object] = ("tall", 10, None, 9.5, True, float("nan"))
    draw(open_map, *(pole(i, attributes={"height_m": v}) for i, v in enumerate(values)))
    view = rows_in(table)
    view.sortByColumn(column(table, "Height (m)"), Qt.SortOrder.AscendingOrder)
    assert cells(table, "Height (m)") == ["9.5", "10", "nan", "tall", "yes", ""]


def test_a_changed_feature_goes_to_its_place_in_the_order(
    table: FeatureTable, open_map: OpenMap
) -> None:
    first, second = curb("a", 1.0), curb("b", 2.0)
    draw(open_map, first, second)
    view = rows_in(table)
    view.sortByColumn(column(table, "Length (m)"), Qt.SortOrder.DescendingOrder)
    choose(open_map, first)
    change(open_map, curb("a", 3.0))
    assert cells(table, "Length (m)") == ["3.000", "2.000"]
    assert [one.id for one in table.selected_features()] == [first.id]


def test_only_the_changed_row_is_drawn_again(
    qtbot: QtBot, table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, *(pole(i) for i in range(20)))
    model = rows_in(table).model()
    with qtbot.waitSignal(model.dataChanged) as told, qtbot.assertNotEmitted(model.modelReset):
        change(open_map, pole(7, status=Status.REJECTED))
    assert told.args is not None
    assert (told.args[0].row(), told.args[1].row()) == (7, 7)


def test_one_by_one_or_all_at_once_the_rows_are_the_same(
    table: FeatureTable, open_map: OpenMap
) -> None:
    poles = [pole(i) for i in range(MOST_SINGLE_CHANGES + 20)]
    draw(open_map, *poles)
    for feature in poles[:10]:
        change(open_map, replace(feature, status=Status.CANDIDATE))
    change(open_map, *(replace(one, status=Status.REJECTED) for one in poles[10:]))
    assert cells(table, "Status") == ["Candidate"] * 10 + ["Rejected"] * (len(poles) - 10)
    open_map.apply(Text.same("away"), Change(removed=tuple(open_map.stored.values())))
    assert rows_in(table).model().rowCount() == 0


def test_what_is_selected_elsewhere_is_marked_and_in_sight(
    table: FeatureTable, open_map: OpenMap
) -> None:
    poles = [pole(i) for i in range(200)]
    draw(open_map, *poles)
    choose(open_map, poles[150], poles[3])
    assert [one.id for one in table.selected_features()] == [poles[3].id, poles[150].id]
    choose(open_map, poles[150])
    view = rows_in(table)
    assert view.viewport().rect().contains(middle_of(view, 150))


def test_a_click_on_a_row_selects_once(
    qtbot: QtBot, table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, *(pole(i) for i in range(5)))
    told: list[frozenset[str]] = []
    open_map.shared.selection.features_changed.connect(told.append)
    click_row(qtbot, table, 1, NONE)
    click_row(qtbot, table, 3, SHIFT)
    assert told == [frozenset({"pole-00001"}), frozenset({f"pole-0000{i}" for i in (1, 2, 3)})]


def test_a_filter_that_hides_selected_features_leaves_them_selected(
    table: FeatureTable, open_map: OpenMap
) -> None:
    one, other = pole(1), curb("a", 3.0)
    draw(open_map, one, other)
    choose(open_map, one, other)
    pick(table, "kind", "Curb")
    assert open_map.shared.selection.features == {one.id, other.id}
    assert table.selected_features() == (other,)
    pick(table, "kind", "All kinds")
    assert table.selected_features() == (one, other)


def test_a_removed_feature_that_was_selected_leaves_the_selection_of_others_alone(
    table: FeatureTable, open_map: OpenMap
) -> None:
    poles = [pole(i) for i in range(4)]
    draw(open_map, *poles)
    choose(open_map, poles[1], poles[2])
    told: list[object] = []
    open_map.shared.selection.features_changed.connect(told.append)
    open_map.apply(Text.same("away"), Change(removed=(poles[1],)))
    assert told == []
    assert table.selected_features() == (poles[2],)
    draw(open_map, poles[1])
    assert cells(table, "Number") == ["No. 0", "No. 1", "No. 2", "No. 3"]
    assert table.selected_features() == (poles[1], poles[2])


def test_the_keys_move_select_go_there_and_delete(
    qtbot: QtBot, table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, *(pole(i) for i in range(4)))
    view = rows_in(table)
    click_row(qtbot, table, 0, NONE)
    qtbot.keyClick(view, Qt.Key.Key_Down)
    assert open_map.shared.selection.features == {"pole-00001"}
    qtbot.keyClick(view, Qt.Key.Key_Return)
    assert open_map.shared.cursor.place == Place((1.0, 0.0, 5.0))
    qtbot.keyClick(view, Qt.Key.Key_Delete)
    assert "pole-00001" not in open_map.stored
    assert open_map.applied[-1][0].en == "Delete a feature"
    type_words(table, "No. 2")
    qtbot.keyClick(view, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    assert open_map.shared.selection.features == {"pole-00002"}


def test_a_double_click_goes_to_the_first_vertex(
    qtbot: QtBot, table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, curb("a", 3.0), pole(4))
    view = rows_in(table)
    spot = middle_of(view, 1)
    qtbot.mouseClick(view.viewport(), LEFT, NONE, spot)
    qtbot.mouseDClick(view.viewport(), LEFT, NONE, spot)
    assert open_map.shared.cursor.place == Place((4.0, 0.0, 5.0))


def test_with_the_filter_for_occluded_vertices_the_cursor_goes_to_the_first_of_them(
    qtbot: QtBot, table: FeatureTable, open_map: OpenMap
) -> None:
    hidden = Vertex((7.0, 8.0, 9.0), is_occluded=True)
    line = curb("a", 3.0)
    draw(open_map, curb("b", 4.0), line.with_vertices((*line.vertices, hidden)))
    box = table.findChild(QCheckBox, "occluded")
    assert box is not None
    box.setChecked(True)
    assert cells(table, "Occluded") == ["1"]
    click_row(qtbot, table, 0, NONE)
    qtbot.keyClick(rows_in(table), Qt.Key.Key_Return)
    assert open_map.shared.cursor.place == Place((7.0, 8.0, 9.0))


def test_features_are_found_by_status_and_by_an_attribute(
    table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, *(pole(i) for i in range(5)), pole(8, status=Status.CANDIDATE), curb("a", 2.0))
    pick(table, "attribute", "Height")
    pick(table, "comparison", ">")
    assert len(cells(table, "Kind")) == 7
    type_words(table, "2", "value")
    assert cells(table, "Number") == ["No. 3", "No. 4", "No. 8"]
    pick(table, "status", "Candidate")
    assert cells(table, "Number") == ["No. 8"]


def test_a_kind_that_leaves_the_map_leaves_the_filter(
    table: FeatureTable, open_map: OpenMap
) -> None:
    line = curb("a", 2.0)
    draw(open_map, pole(1), line)
    pick(table, "kind", "Curb")
    open_map.apply(Text.same("away"), Change(removed=(line,)))
    assert cells(table, "Kind") == ["Pole"]


def test_select_shown_replaces_and_with_shift_adds(
    qtbot: QtBot, table: FeatureTable, open_map: OpenMap
) -> None:
    draw(open_map, pole(1), pole(2), curb("a", 2.0))
    button = table.findChild(QPushButton, "select")
    assert button is not None
    pick(table, "kind", "Curb")
    button.click()
    assert open_map.shared.selection.features == {"curb-a"}
    pick(table, "kind", "Pole")
    spot = button.mapTo(table, button.rect().center())
    QTest.mouseClick(table.windowHandle(), LEFT, SHIFT, spot)
    assert open_map.shared.selection.features == {"curb-a", "pole-00001", "pole-00002"}
    QTest.mouseClick(table.windowHandle(), LEFT, NONE, spot)
    assert open_map.shared.selection.features == {"pole-00001", "pole-00002"}


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
    assert open_map.shared.cursor.place == Place((2.0, 0.0, 5.0))
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
    assert open_map.shared.cursor.place is None


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
