"""Project, layers and attributes: views of shared objects that ask for changes."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QComboBox, QLineEdit, QTreeWidget, QTreeWidgetItem
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.map.catalogue import AttributeField, Catalogue, FeatureKind, Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import Provenance, Vertex
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.widgets.builders import KINDS, OpenMap
from widgets.panels.attributes.attribute_field import read_value
from widgets.panels.attributes.attribute_panel import AttributePanel
from widgets.panels.geometry_facts import facts_of
from widgets.panels.project.layers_panel import LayersPanel
from widgets.panels.project.project_tree import ProjectTree
from widgets.panels.tree_items import children_of

LEFT = Qt.MouseButton.LeftButton

POLE = FeatureKind(
    "pole",
    Text("Pole", "電柱"),
    Geometry.POINT,
    "",
    "pole",
    "#009e73",
    96,
    attributes=(
        AttributeField("number", Text("Number", "番号"), "text"),
        AttributeField("height_m", Text("Height", "高さ"), "number", "m"),
        AttributeField("cables", Text("Cables", "条数"), "count"),
        AttributeField("made_of", Text("Material", "材質"), "choice", "", ("wood", "steel")),
        AttributeField("seen", Text("Seen", "調査日"), "date"),
    ),
)


class MapWithAttributes(OpenMap):
    def catalogue(self) -> Catalogue:
        return Catalogue((*(kind for kind in KINDS if kind.id != "pole"), POLE))


@pytest.fixture
def open_map(left_drive: Drive, right_drive: Drive) -> OpenMap:
    return MapWithAttributes((left_drive, right_drive))


def rows_of(tree: QTreeWidget) -> list[QTreeWidgetItem]:
    return [item for group in children_of(tree) for item in children_of(group)]


def click_on(qtbot: QtBot, tree: QTreeWidget, item: QTreeWidgetItem, column: int = 0) -> None:
    rect = tree.visualItemRect(item)
    x = tree.columnViewportPosition(column) + tree.columnWidth(column) // 2
    spot = QPoint(x, rect.center().y())
    qtbot.mouseClick(tree.viewport(), LEFT, Qt.KeyboardModifier.NoModifier, spot)


def tree_in(panel: ProjectTree | LayersPanel) -> QTreeWidget:
    tree = panel.findChild(QTreeWidget)
    assert tree is not None
    return tree


def test_a_click_on_a_drive_chooses_it(qtbot: QtBot, open_map: OpenMap) -> None:
    panel = ProjectTree(open_map, open_map.shared, "en")
    qtbot.addWidget(panel)
    panel.show()
    tree = tree_in(panel)
    wanted = open_map.drives()[1]
    item = next(one for one in rows_of(tree) if one.text(0) == wanted.info.name)
    assert f"Points: {wanted.count:,}" in item.toolTip(0)
    with qtbot.waitSignal(panel.drive_chosen) as chosen:
        click_on(qtbot, tree, item)
    assert chosen.args == [wanted.id]
    open_map.shared.view_settings.show_image(wanted.id, ImageKind.REVERSIBLE)
    assert item.font(0).bold()


def test_runs_of_tools_are_listed_with_their_features(
    qtbot: QtBot, open_map: OpenMap, left_drive: Drive
) -> None:
    panel = ProjectTree(open_map, open_map.shared, "en")
    qtbot.addWidget(panel)
    made = Provenance(tool="curbs", run="run-1")
    open_map.add(Geometry.POINT, left_drive, 5, provenance=made)
    open_map.add(Geometry.POINT, left_drive, 9, provenance=made)
    open_map.add(Geometry.POINT, left_drive, 12)
    words = [item.text(0) for item in rows_of(tree_in(panel))]
    assert any("Curbs" in word and "2" in word for word in words)


def test_an_empty_project_says_what_would_be_here(qtbot: QtBot) -> None:
    empty = OpenMap()
    panel = ProjectTree(empty, empty.shared, "en")
    qtbot.addWidget(panel)
    panel.show()
    assert not tree_in(panel).isVisible()


@pytest.fixture
def layers(qtbot: QtBot, open_map: OpenMap) -> LayersPanel:
    panel = LayersPanel(open_map, open_map.shared, "en")
    qtbot.addWidget(panel)
    panel.resize(260, 400)
    panel.show()
    return panel


def row_of(panel: LayersPanel, name: str) -> QTreeWidgetItem:
    return next(item for item in rows_of(tree_in(panel)) if item.text(0) == name)


def test_kinds_on_the_map_are_counted(
    layers: LayersPanel, open_map: OpenMap, left_drive: Drive
) -> None:
    assert row_of(layers, "Pole").text(1) == ""
    first = open_map.add(Geometry.POINT, left_drive, 5)
    open_map.add(Geometry.POINT, left_drive, 9)
    assert row_of(layers, "Pole").text(1) == "2"
    open_map.apply(Text.same("away"), Change(removed=(first,)))
    assert row_of(layers, "Pole").text(1) == "1"


def test_the_check_box_hides_a_kind_and_draws_nothing(
    qtbot: QtBot, layers: LayersPanel, open_map: OpenMap, left_drive: Drive
) -> None:
    open_map.add(Geometry.POINT, left_drive, 5)
    with qtbot.assertNotEmitted(layers.kind_chosen):
        click_on(qtbot, tree_in(layers), row_of(layers, "Pole"), 3)
    assert open_map.shared.view_settings.hidden_kinds == {"pole"}
    click_on(qtbot, tree_in(layers), row_of(layers, "Pole"), 3)
    assert open_map.shared.view_settings.hidden_kinds == frozenset()


def test_kinds_hidden_elsewhere_are_unchecked_here(
    layers: LayersPanel, open_map: OpenMap, left_drive: Drive
) -> None:
    open_map.add(Geometry.POINT, left_drive, 5)
    open_map.shared.view_settings.hide_kinds(frozenset({"pole"}))
    assert row_of(layers, "Pole").checkState(3) == Qt.CheckState.Unchecked


def test_a_click_on_a_kind_chooses_what_is_drawn(qtbot: QtBot, layers: LayersPanel) -> None:
    with qtbot.waitSignal(layers.kind_chosen) as chosen:
        click_on(qtbot, tree_in(layers), row_of(layers, "Lid"))
    assert chosen.args == ["lid"]
    layers.mark_kind(KINDS["lid"])
    assert row_of(layers, "Lid").font(0).bold()
    assert not row_of(layers, "Curb").font(0).bold()


def test_kinds_are_found_in_both_languages(layers: LayersPanel) -> None:
    search = layers.findChild(QLineEdit)
    assert search is not None
    search.setText("側溝")
    visible = [item.text(0) for item in rows_of(tree_in(layers)) if not item.isHidden()]
    assert visible == ["Lid"]


@pytest.fixture
def attributes(qtbot: QtBot, open_map: OpenMap) -> AttributePanel:
    panel = AttributePanel(open_map, open_map.shared, "en")
    panel.change_requested.connect(open_map.apply)
    qtbot.addWidget(panel)
    panel.resize(260, 500)
    panel.show()
    return panel


def test_an_edited_attribute_is_asked_for_as_one_change(
    qtbot: QtBot, attributes: AttributePanel, open_map: OpenMap, left_drive: Drive
) -> None:
    pole = open_map.add(Geometry.POINT, left_drive, 5)
    open_map.shared.selection.choose_features(frozenset({pole.id}))
    field = attributes.field("height_m")
    assert isinstance(field, QLineEdit)
    qtbot.keyClicks(field, "8.25")
    qtbot.keyClick(field, Qt.Key.Key_Return)
    label, change = open_map.applied[-1]
    after = replace(pole, attributes={"height_m": 8.25})
    assert change == Change(replaced=(Replacement(pole, after),))
    assert "Height" in label.en
    assert "高さ" in label.ja
    shown = attributes.field("height_m")
    assert isinstance(shown, QLineEdit)
    assert shown.text() == "8.25"


def test_a_field_that_was_only_visited_changes_nothing(
    qtbot: QtBot, attributes: AttributePanel, open_map: OpenMap, left_drive: Drive
) -> None:
    pole = open_map.add(Geometry.POINT, left_drive, 5, attributes={"height_m": 1.123456789})
    open_map.shared.selection.choose_features(frozenset({pole.id}))
    before = len(open_map.applied)
    field = attributes.field("height_m")
    assert field is not None
    qtbot.keyClick(field, Qt.Key.Key_Return)
    assert len(open_map.applied) == before


@pytest.mark.parametrize("typed", [("height_m", "tall"), ("cables", "-3"), ("seen", "x")])
def test_what_is_not_of_the_attributes_type_cannot_be_typed(
    qtbot: QtBot,
    attributes: AttributePanel,
    open_map: OpenMap,
    left_drive: Drive,
    typed: tuple[str, str],
) -> None:
    id_, text = typed
    pole = open_map.add(Geometry.POINT, left_drive, 5)
    open_map.shared.selection.choose_features(frozenset({pole.id}))
    field = attributes.field(id_)
    assert isinstance(field, QLineEdit)
    qtbot.keyClicks(field, text)
    qtbot.keyClick(field, Qt.Key.Key_Return)
    values = [change.replaced[0].after.attributes.get(id_) for _, change in open_map.applied[1:]]
    assert values in ([], [3])


def test_a_choice_is_a_list(
    qtbot: QtBot, attributes: AttributePanel, open_map: OpenMap, left_drive: Drive
) -> None:
    pole = open_map.add(Geometry.POINT, left_drive, 5)
    open_map.shared.selection.choose_features(frozenset({pole.id}))
    box = attributes.field("made_of")
    assert isinstance(box, QComboBox)
    qtbot.keyClick(box, Qt.Key.Key_Down)
    assert open_map.feature(pole.id).attributes == {"made_of": "wood"}


def test_several_features_show_what_they_have_in_common(
    attributes: AttributePanel, open_map: OpenMap, left_drive: Drive
) -> None:
    chosen = [open_map.add(Geometry.POINT, left_drive, point) for point in (5, 9, 12)]
    open_map.shared.selection.choose_features(frozenset(one.id for one in chosen))
    assert any("3" in line for line in attributes.lines())
    assert "Pole" in attributes.lines()


def test_nothing_chosen_says_so(attributes: AttributePanel) -> None:
    assert attributes.lines() == ("Choose a feature to see what is known about it.",)


def test_facts_of_a_square_are_its_perimeter_and_area(open_map: OpenMap, left_drive: Drive) -> None:
    area = open_map.add(Geometry.AREA, left_drive, 1, 2, 3, 4)
    corners = ((0, 0, 5), (10, 0, 5), (10, 10, 6), (0, 10, 5))
    square = area.with_vertices(
        tuple(Vertex((e - 11_000.0, n - 35_000.0, float(h))) for e, n, h in corners)
    )
    facts = {title.en: words for title, words in facts_of(square)}
    assert facts["Area in plan"] == "100.000 m²"
    assert facts["Height difference"] == "1.000 m"
    assert facts["Vertices"] == "4"
    assert facts["Perimeter"] == f"{20 + 2 * 101**0.5:,.3f} m"


@pytest.mark.parametrize(
    ("type_", "text", "value"),
    [
        ("number", "1.5", 1.5),
        ("number", "1,5", 1.5),
        ("number", "−2", -2.0),
        ("number", ".", None),
        ("count", "12", 12),
        ("count", "1.5", None),
        ("date", "2026-02-28", "2026-02-28"),
        ("date", "2026-02-30", None),
        ("text", "縁石", "縁石"),
        ("text", "", None),
    ],
)
def test_texts_are_read_as_the_attributes_type(type_: str, text: str, value: object) -> None:
    assert read_value(AttributeField("a", Text.same("a"), type_), text) == value
