"""The attributes of one and of many features: what they share is changed in one step."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication, QComboBox, QLabel, QLineEdit, QPushButton
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.map.catalogue import AttributeField, Catalogue, FeatureKind, Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import (
    AttributeValue,
    Feature,
    PointReference,
    Provenance,
    Status,
    Vertex,
)
from tests.widgets.builders import OpenMap
from widgets.panels.attributes.attribute_field import format_attribute, read_value
from widgets.panels.attributes.attribute_panel import AttributePanel
from widgets.shared.cursor import PickedPosition

NUMBER = AttributeField("number", Text("Number", "番号"), "text")
HEIGHT = AttributeField("height_m", Text("Height", "高さ"), "number", "m")
CABLES = AttributeField("cables", Text("Cables", "条数"), "count")
MADE_OF = AttributeField("made_of", Text("Material", "材質"), "choice", "", ("wood", "steel"))
SEEN = AttributeField("seen", Text("Seen", "調査日"), "date")
OTHER_MATERIAL = replace(MADE_OF, choices=("concrete",))


def kind(id_: str, name: Text, geometry: Geometry, *fields: AttributeField) -> FeatureKind:
    return FeatureKind(id_, name, geometry, "", id_, "#009e73", 96, attributes=fields)


CATALOGUE = Catalogue(
    (
        kind("pole", Text("Pole", "電柱"), Geometry.POINT, NUMBER, HEIGHT, CABLES, MADE_OF, SEEN),
        kind("sign", Text("Sign", "標識"), Geometry.POINT, HEIGHT, OTHER_MATERIAL),
        kind("curb", Text("Curb", "縁石"), Geometry.LINE, HEIGHT),
    )
)


class MapOfPoles(OpenMap):
    refuses: bool = False

    def catalogue(self) -> Catalogue:
        return CATALOGUE

    def apply(self, label: Text, change: Change) -> None:
        if not self.refuses:
            super().apply(label, change)


def pole(name: str, **attributes: AttributeValue) -> Feature:
    return Feature(name, "pole", Geometry.POINT, (Vertex((1.0, 2.0, 3.0)),), attributes)


@pytest.fixture
def open_map() -> MapOfPoles:
    return MapOfPoles()


@pytest.fixture
def panel(qtbot: QtBot, open_map: MapOfPoles) -> AttributePanel:
    made = AttributePanel(open_map, open_map.shared, "en")
    made.change_requested.connect(open_map.apply)
    qtbot.addWidget(made)
    made.resize(290, 500)
    made.show()
    return made


def draw_and_choose(open_map: OpenMap, *features: Feature) -> None:
    open_map.apply(Text.same("draw"), Change(added=features))
    choose(open_map, *features)


def choose(open_map: OpenMap, *features: Feature) -> None:
    open_map.shared.selection.choose_features(frozenset(one.id for one in features))


def line(panel: AttributePanel, id_: str) -> QLineEdit:
    field = panel.field(id_)
    assert isinstance(field, QLineEdit)
    return field


def box(panel: AttributePanel, id_: str) -> QComboBox:
    field = panel.field(id_)
    assert isinstance(field, QComboBox)
    return field


def pick(panel: AttributePanel, id_: str, words: str) -> None:
    chosen = box(panel, id_)
    index = chosen.findText(words)
    assert index >= 0
    chosen.setCurrentIndex(index)
    chosen.activated.emit(index)


def type_in(qtbot: QtBot, field: QLineEdit, words: str) -> None:
    field.selectAll()
    qtbot.keyClicks(field, words)
    qtbot.keyClick(field, Qt.Key.Key_Return)


def values_of(open_map: OpenMap, id_: str) -> list[AttributeValue]:
    return [one.attributes.get(id_) for one in open_map.features()]


def test_a_value_typed_for_many_is_written_to_all_in_one_step(
    qtbot: QtBot, panel: AttributePanel, open_map: MapOfPoles
) -> None:
    draw_and_choose(open_map, pole("a", height_m=1.0), pole("b"), pole("c", height_m=8.5))
    type_in(qtbot, line(panel, "height_m"), "8.5")
    assert values_of(open_map, "height_m") == [8.5, 8.5, 8.5]
    label, change = open_map.applied[-1]
    assert label == Text("Change Height of 2 features", "2個の地物の「高さ」を変更")
    assert len(change.replaced) == 2


def test_equal_values_are_shown_and_different_ones_are_said_to_be_several(
    panel: AttributePanel, open_map: MapOfPoles
) -> None:
    draw_and_choose(
        open_map,
        pole("a", number="7", height_m=1.0, made_of="wood"),
        pole("b", number="7", height_m=2.0),
    )
    assert line(panel, "number").text() == "7"
    height = line(panel, "height_m")
    assert (height.text(), height.placeholderText()) == ("", "(several values)")
    material = box(panel, "made_of")
    assert (material.currentIndex(), material.placeholderText()) == (-1, "(several values)")


def test_only_the_field_that_was_changed_is_written(
    qtbot: QtBot, panel: AttributePanel, open_map: MapOfPoles
) -> None:
    first = pole("a", number="1", height_m=1.0, made_of="wood")
    other = pole("b", number="2", height_m=2.0, made_of="steel")
    draw_and_choose(open_map, first, other)
    for name in ("number", "height_m", "seen"):
        qtbot.keyClick(line(panel, name), Qt.Key.Key_Return)
    type_in(qtbot, line(panel, "cables"), "4")
    assert len(open_map.applied) == 2
    assert open_map.feature("a") == replace(first, attributes={**first.attributes, "cables": 4})
    assert open_map.feature("b") == replace(other, attributes={**other.attributes, "cables": 4})


def test_typing_and_taking_it_back_leaves_several_values_as_they_are(
    qtbot: QtBot, panel: AttributePanel, open_map: MapOfPoles
) -> None:
    draw_and_choose(open_map, pole("a", number="1"), pole("b", number="2"))
    field = line(panel, "number")
    qtbot.keyClicks(field, "x")
    qtbot.keyClick(field, Qt.Key.Key_Backspace)
    qtbot.keyClick(field, Qt.Key.Key_Return)
    assert values_of(open_map, "number") == ["1", "2"]


def test_several_values_are_emptied_by_the_button_in_the_field(
    panel: AttributePanel, open_map: MapOfPoles
) -> None:
    draw_and_choose(open_map, pole("a", number="1"), pole("b", number="2", height_m=1.0))
    (clear,) = [one for one in line(panel, "number").actions() if one.isVisible()]
    clear.trigger()
    assert [one.attributes for one in open_map.features()] == [{}, {"height_m": 1.0}]
    assert line(panel, "number").placeholderText() == ""


def test_a_choice_for_many_is_made_in_the_list(panel: AttributePanel, open_map: MapOfPoles) -> None:
    draw_and_choose(open_map, pole("a", made_of="wood"), pole("b"))
    pick(panel, "made_of", "steel")
    assert values_of(open_map, "made_of") == ["steel", "steel"]


@pytest.mark.parametrize(
    ("id_", "typed"),
    [("cables", "-3"), ("cables", "1.5"), ("height_m", "tall"), ("seen", "2026-02-30")],
)
def test_the_limits_of_a_type_hold_for_many(
    qtbot: QtBot, panel: AttributePanel, open_map: MapOfPoles, id_: str, typed: str
) -> None:
    draw_and_choose(open_map, pole("a", cables=1, height_m=1.0), pole("b"))
    type_in(qtbot, line(panel, id_), typed)
    for value in values_of(open_map, "cables"):
        assert value is None or (isinstance(value, int) and value >= 0)
    assert set(values_of(open_map, "height_m")) == {1.0, None}
    assert set(values_of(open_map, "seen")) == {None}


def test_status_and_kind_are_changed_for_all(panel: AttributePanel, open_map: MapOfPoles) -> None:
    draw_and_choose(open_map, pole("a", height_m=3.0), replace(pole("b"), status=Status.CANDIDATE))
    assert box(panel, "status").currentIndex() == -1
    pick(panel, "status", "Rejected")
    assert {one.status for one in open_map.features()} == {Status.REJECTED}
    pick(panel, "kind", "Sign")
    assert {one.kind for one in open_map.features()} == {"sign"}
    assert values_of(open_map, "height_m") == [3.0, None]
    assert len(open_map.applied) == 3
    assert panel.field("cables") is None


def test_kinds_of_another_geometry_are_not_offered(
    panel: AttributePanel, open_map: MapOfPoles
) -> None:
    draw_and_choose(open_map, pole("a"), pole("b"))
    kinds = box(panel, "kind")
    assert [kinds.itemText(i) for i in range(kinds.count())] == ["Pole", "Sign"]
    ends = (Vertex((0.0, 0.0, 0.0)), Vertex((1.0, 0.0, 0.0)))
    draw_and_choose(open_map, pole("c"), Feature("d", "curb", Geometry.LINE, ends))
    assert not box(panel, "kind").isEnabled()


def test_fields_that_kinds_do_not_share_are_not_offered(
    panel: AttributePanel, open_map: MapOfPoles
) -> None:
    draw_and_choose(open_map, pole("a"), replace(pole("b"), kind="sign"))
    assert panel.field("height_m") is not None
    # Both have a material, but not the same choices.
    assert panel.field("made_of") is None
    assert panel.field("number") is None
    assert "Pole: 1\nSign: 1" in panel.lines()


def test_a_kind_that_the_catalogue_lacks_shows_its_id_and_values(
    panel: AttributePanel, open_map: MapOfPoles
) -> None:
    stray = replace(pole("a", height_m=2.5, note=None), kind="old_kind")
    draw_and_choose(open_map, stray)
    assert {"old_kind", "height_m", "2.5", "note"} <= set(panel.lines())
    draw_and_choose(open_map, stray.with_vertices(()), pole("b"))
    assert panel.field("height_m") is None
    pick(panel, "kind", "Pole")
    assert {one.kind for one in open_map.features()} == {"pole"}


def test_values_of_the_wrong_type_are_shown_and_can_be_put_right(
    qtbot: QtBot, panel: AttributePanel, open_map: MapOfPoles
) -> None:
    wrong = pole("a", height_m="tall", cables=2.5, number=12, made_of="paper", seen=True)
    draw_and_choose(open_map, wrong)
    shown = [line(panel, id_).text() for id_ in ("height_m", "cables", "number", "seen")]
    assert shown == ["tall", "2.5", "12", "True"]
    assert box(panel, "made_of").currentText() == "paper"
    type_in(qtbot, line(panel, "height_m"), "7")
    assert values_of(open_map, "height_m") == [7.0]
    assert values_of(open_map, "made_of") == ["paper"]


def test_features_removed_while_they_are_chosen_leave_the_form_to_the_others(
    qtbot: QtBot, panel: AttributePanel, open_map: MapOfPoles
) -> None:
    poles = [pole(name, number="1") for name in "abc"]
    draw_and_choose(open_map, *poles)
    open_map.apply(Text.same("away"), Change(removed=(poles[0],)))
    type_in(qtbot, line(panel, "number"), "2")
    assert values_of(open_map, "number") == ["2", "2"]
    open_map.apply(Text.same("away"), Change(removed=tuple(open_map.features())))
    assert panel.lines() == ("Choose a feature to see what is known about it.",)


def test_what_was_typed_goes_to_those_that_were_chosen_then(
    qtbot: QtBot, panel: AttributePanel, open_map: MapOfPoles
) -> None:
    first, other = pole("a"), pole("b")
    draw_and_choose(open_map, other)
    draw_and_choose(open_map, first)
    qtbot.keyClicks(line(panel, "number"), "12")
    choose(open_map, other)
    assert values_of(open_map, "number") == [None, "12"]
    assert line(panel, "number").text() == ""


def test_a_refused_change_shows_what_is_stored(
    qtbot: QtBot, panel: AttributePanel, open_map: MapOfPoles
) -> None:
    draw_and_choose(open_map, pole("a", number="1"), pole("b", number="1"))
    open_map.refuses = True
    type_in(qtbot, line(panel, "number"), "2")
    pick(panel, "status", "Rejected")
    pick(panel, "kind", "Sign")
    assert line(panel, "number").text() == "1"
    assert box(panel, "status").currentText() == "Accepted"
    assert box(panel, "kind").currentText() == "Pole"


def test_a_form_being_typed_in_stays_when_its_features_change(
    panel: AttributePanel, open_map: MapOfPoles
) -> None:
    draw_and_choose(open_map, pole("a"), pole("b"))
    field = line(panel, "number")
    changed = pole("a", height_m=4.0)
    pair = Replacement(pole("a"), changed)
    open_map.apply(Text.same("elsewhere"), Change(replaced=(pair,)))
    assert line(panel, "number") is field
    assert line(panel, "height_m").placeholderText() == "(several values)"


def test_the_button_goes_from_one_occluded_vertex_to_the_next(
    qtbot: QtBot, panel: AttributePanel, open_map: MapOfPoles
) -> None:
    seen = Vertex((0.0, 0.0, 0.0), PointReference("d", 1))
    hidden = [Vertex((1.0, float(i), 0.0), is_occluded=True) for i in range(2)]
    curb = Feature("c", "curb", Geometry.LINE, (seen, *hidden, seen))
    draw_and_choose(open_map, curb, Feature("d", "curb", Geometry.LINE, (seen, hidden[1])))
    assert "3 of 6 vertices without a measured point" in panel.lines()
    (button,) = [one for one in panel.findChildren(QPushButton) if one.isVisible()]
    went = []
    for _ in range(4):
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
        went.append(open_map.shared.cursor.position)
    positions = [PickedPosition(vertex.xyz) for vertex in (*hidden, hidden[1], hidden[0])]
    assert went == positions


def test_without_occluded_vertices_nothing_is_said_of_them(
    panel: AttributePanel, open_map: MapOfPoles
) -> None:
    draw_and_choose(open_map, pole("a"))
    assert not [one for one in panel.findChildren(QPushButton) if one.isVisible()]
    labels = [one.text() for one in panel.findChildren(QLabel) if one.isVisible()]
    assert not any("without a measured point" in words for words in labels)


def test_a_candidate_shows_how_sure_the_tool_was(
    panel: AttributePanel, open_map: MapOfPoles
) -> None:
    found = replace(
        pole("a"), status=Status.CANDIDATE, provenance=Provenance("normals", 1, confidence=0.8)
    )
    draw_and_choose(open_map, found)
    assert "80 %" in panel.lines()
    pick(panel, "status", "Accepted")
    assert "80 %" not in panel.lines()


def test_the_next_feature_of_a_kind_is_shown_in_the_same_fields(
    panel: AttributePanel, open_map: MapOfPoles
) -> None:
    first, second = (
        replace(
            pole(id_),
            status=Status.CANDIDATE,
            provenance=Provenance("normals", 1, confidence=confidence),
        )
        for id_, confidence in (("a", 0.8), ("b", 0.4))
    )
    draw_and_choose(open_map, first, second)
    open_map.shared.selection.choose_features(frozenset({"a"}))
    status, lines = panel.field("status"), panel.lines()
    open_map.shared.selection.choose_features(frozenset({"b"}))
    assert panel.field("status") is status
    assert "80 %" in lines
    assert "40 %" in panel.lines()
    assert "80 %" not in panel.lines()
    pick(panel, "status", "Accepted")
    statuses = {one.id: one.status for one in open_map.features()}
    assert statuses == {"a": Status.CANDIDATE, "b": Status.ACCEPTED}


def test_the_wheel_over_a_list_that_is_only_passed_changes_nothing(
    panel: AttributePanel, open_map: MapOfPoles
) -> None:
    draw_and_choose(open_map, pole("a", made_of="wood"))
    lists = box(panel, "made_of")
    turned = QWheelEvent(
        QPointF(5, 5),
        QPointF(lists.mapToGlobal(QPoint(5, 5))),
        QPoint(),
        QPoint(0, -120),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(lists, turned)
    assert lists.currentText() == "wood"


def test_ten_thousand_features_are_changed_in_one_step(
    qtbot: QtBot, panel: AttributePanel, open_map: MapOfPoles
) -> None:
    draw_and_choose(open_map, *(pole(f"{i:05}", number=str(i % 2)) for i in range(10_000)))
    type_in(qtbot, line(panel, "number"), "x")
    assert len(open_map.applied) == 2
    assert set(values_of(open_map, "number")) == {"x"}
    assert open_map.applied[-1][0].en == "Change Number of 10,000 features"


@pytest.mark.parametrize(
    ("field", "typed", "value"),
    [
        (HEIGHT, "１２．５", 12.5),
        (HEIGHT, "－2", -2.0),
        (CABLES, "３", 3),
        (SEEN, "２０２６／3／1", "2026-03-01"),
        (NUMBER, "Ｎｏ．１", "Ｎｏ．１"),
    ],
)
def test_full_width_input_is_read_as_it_is_meant(
    field: AttributeField, typed: str, value: AttributeValue
) -> None:
    assert read_value(field, typed) == value


@pytest.mark.parametrize("number", [0.1, 1e-7, 1234567.125, -3.0, 1e22])
def test_a_number_is_written_so_that_it_reads_back_the_same(number: float) -> None:
    assert read_value(HEIGHT, format_attribute(number)) == number
