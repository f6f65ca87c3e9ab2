"""A map with poles, and a hand at the table of features."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QComboBox,
    QLabel,
    QLineEdit,
    QMenu,
    QTableView,
)
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.map.catalogue import AttributeField, Catalogue, FeatureKind, Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import AttributeValue, Feature, Vertex
from tests.widgets.builders import KINDS, OpenMap
from widgets.panels.table.feature_table import FeatureTable

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
    position = Vertex((float(number), 0.0, 5.0))
    attributes: dict[str, AttributeValue] = {
        "number": f"No. {number}",
        "height_m": float(number),
    }
    feature = Feature(f"pole-{number:05}", "pole", Geometry.POINT, (position,), attributes)
    return replace(feature, **fields)  # type: ignore[arg-type]


def curb(name: str, length_m: float, **fields: object) -> Feature:
    ends = Vertex((-11_000.0, -35_000.0, 5.0)), Vertex((-11_000.0 + length_m, -35_000.0, 5.0))
    feature = Feature(f"curb-{name}", "curb", Geometry.LINE, ends)
    return replace(feature, **fields)  # type: ignore[arg-type]


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
