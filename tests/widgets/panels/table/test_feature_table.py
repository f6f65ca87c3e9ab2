"""The table of features: in step with the selection and the map, sorted, filtered, by keys."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QCheckBox,
    QPushButton,
)
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.map.change import Change
from processing.map.feature import Provenance, Status, Vertex
from tests.widgets.builders import OpenMap
from tests.widgets.panels.table_user import (
    LEFT,
    NONE,
    SHIFT,
    cells,
    change,
    choose,
    click_row,
    column,
    curb,
    draw,
    middle_of,
    pick,
    pole,
    rows_in,
    type_words,
    written,
)
from widgets.panels.table.feature_table import FeatureTable
from widgets.panels.table.feature_table_model import MOST_SINGLE_CHANGES
from widgets.shared.cursor import PickedPosition


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
    with qtbot.waitSignal(model.dataChanged) as reported, qtbot.assertNotEmitted(model.modelReset):
        change(open_map, pole(7, status=Status.REJECTED))
    assert reported.args is not None
    assert (reported.args[0].row(), reported.args[1].row()) == (7, 7)


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
    reported: list[frozenset[str]] = []
    open_map.shared.selection.features_changed.connect(reported.append)
    click_row(qtbot, table, 1, NONE)
    click_row(qtbot, table, 3, SHIFT)
    assert reported == [frozenset({"pole-00001"}), frozenset({f"pole-0000{i}" for i in (1, 2, 3)})]


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
    reported: list[object] = []
    open_map.shared.selection.features_changed.connect(reported.append)
    open_map.apply(Text.same("away"), Change(removed=(poles[1],)))
    assert reported == []
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
    assert open_map.shared.cursor.position == PickedPosition((1.0, 0.0, 5.0))
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
    assert open_map.shared.cursor.position == PickedPosition((4.0, 0.0, 5.0))


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
    assert open_map.shared.cursor.position == PickedPosition((7.0, 8.0, 9.0))


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
