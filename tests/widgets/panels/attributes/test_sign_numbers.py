"""A sign's legal number: chosen by the shape of its plate, with the class that it says."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QApplication, QLineEdit, QMenu
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.change import Change
from processing.map.feature import AttributeValue, Feature, Vertex
from processing.map.sign_numbers import numbers_for, sign_numbers
from processing.project.photos import photo_folder, photo_name, write_photos
from resources import path_of
from tests.widgets.builders import OpenMap
from widgets.panels.attributes.attribute_panel import AttributePanel
from widgets.panels.attributes.photo_row import PhotoRow
from widgets.panels.attributes.sign_numbers import SignNumberMenu, implied_kind


class MapOfSigns(OpenMap):
    """A map with the catalogue that comes with the program."""

    listed = read_catalogue(path_of("catalogue/level500.toml"))

    def catalogue(self) -> Catalogue:
        return self.listed


def sign(name: str, **attributes: AttributeValue) -> Feature:
    return Feature(name, "sign", Geometry.POINT, (Vertex((1.0, 2.0, 3.0)),), attributes)


def entries(menu: QMenu) -> list[QAction]:
    """All that can be chosen, those of further menus too."""
    found = []
    for one in menu.actions():
        below = one.menu()
        found += entries(below) if isinstance(below, QMenu) else [] if one.isSeparator() else [one]
    return found


def numbers_in(menu: QMenu) -> list[str]:
    return [one.text().split()[0] for one in entries(menu)]


def test_each_number_is_listed_once_with_names_and_a_plate() -> None:
    numbers = [one.number for one in sign_numbers()]
    assert len(set(numbers)) == len(numbers) > 100
    assert all(one.name.en and one.name.ja and one.shapes for one in sign_numbers())
    stop = next(one for one in sign_numbers() if one.number == "330")
    assert (stop.name.ja, stop.shapes, stop.colour) == ("一時停止", ("triangle",), "red")


def test_plates_below_others_are_supplements_and_no_others_are() -> None:
    assert {one.sign_class for one in numbers_for("rectangle", is_supplement=True)} == {
        "supplement"
    }
    alone = {one.sign_class for one in numbers_for("rectangle", is_supplement=False)}
    assert alone == {"guide", "regulation", "instruction"}


@pytest.mark.parametrize(
    ("shape", "offered", "left_out"),
    [("triangle", "330", "323"), ("circle", "323", "330"), ("diamond", "208", "407-A"),
     ("pentagon", "407-A", "403")],
)  # fmt: skip
def test_the_signs_of_a_plates_shape_are_offered(
    qtbot: QtBot, shape: str, offered: str, left_out: str
) -> None:
    menu = SignNumberMenu((sign("a", shape=shape),), "ja")
    qtbot.addWidget(menu)
    assert offered in numbers_in(menu)
    assert left_out not in numbers_in(menu)
    assert not any(one.icon().isNull() for one in entries(menu))


def test_signs_of_several_shapes_are_offered_every_number(qtbot: QtBot) -> None:
    menu = SignNumberMenu((sign("a", shape="circle"), sign("b", shape="diamond")), "en")
    qtbot.addWidget(menu)
    assert len(numbers_in(menu)) == len(sign_numbers())


def test_a_number_chosen_by_keys_is_written_with_its_class_in_one_step(qtbot: QtBot) -> None:
    open_map = MapOfSigns()
    panel = AttributePanel(open_map, open_map.shared, "en")
    qtbot.addWidget(panel)
    steps: list[Text] = []
    panel.change_requested.connect(lambda label, _change: steps.append(label))
    panel.change_requested.connect(open_map.apply)
    panel.show()
    stop = sign("a", shape="triangle")
    open_map.apply(Text.same("draw"), Change(added=(stop,)))
    open_map.shared.selection.choose_features(frozenset({"a"}))
    field = panel.field("sign_number")
    assert isinstance(field, QLineEdit)
    field.setFocus()
    qtbot.keyClick(field, Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
    qtbot.waitUntil(lambda: isinstance(QApplication.activePopupWidget(), SignNumberMenu))
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, SignNumberMenu)
    menu.setActiveAction(next(one for one in entries(menu) if one.text().startswith("330")))
    qtbot.keyClick(menu, Qt.Key.Key_Return)
    (written,) = open_map.features()
    assert written.attributes["sign_number"] == "330"
    assert written.attributes["sign_class"] == "regulation"
    assert written.kind == "sign_regulation"  # 2244: a number was confirmed
    shown = panel.field("sign_number")
    assert isinstance(shown, QLineEdit)
    assert shown.text() == "330"
    assert len(steps) == 1


@pytest.mark.parametrize(
    ("kind", "number", "becomes"),
    [("sign", "208", "sign_warning"), ("sign", "407-A", "sign_regulation"),
     ("sign_warning", "101", "sign_guide"), ("sign", "501", "sign"),
     ("sign", "something else", "sign"), ("info_board", "101", "info_board")],
)  # fmt: skip
def test_a_sign_has_an_official_code_once_its_number_is_confirmed(
    kind: str, number: str, becomes: str
) -> None:
    signs = (replace(sign("a"), kind=kind),)
    found = implied_kind(signs, MapOfSigns.listed, "sign_number", number)
    assert (found.id if found is not None else kind) == becomes
    assert implied_kind(signs, MapOfSigns.listed, "number", number) is None


def test_the_picture_of_a_sign_is_shown_and_goes_with_it(qtbot: QtBot, tmp_path: Path) -> None:
    open_map = MapOfSigns(folder=tmp_path)
    (tmp_path / photo_folder("r1")).mkdir(parents=True)
    face = np.full((20, 40, 3), (215, 0, 15), np.uint8)
    write_photos({photo_name("r1", 1): face}, tmp_path / photo_folder("r1"))
    panel = AttributePanel(open_map, open_map.shared, "en")
    qtbot.addWidget(panel)
    panel.show()
    stop, other = sign("a", photo=photo_name("r1", 1)), sign("b", photo="DSC_0815")
    open_map.apply(Text.same("draw"), Change(added=(stop, other)))
    choose = open_map.shared.selection.choose_features
    choose(frozenset({"a"}))
    row = panel.findChild(PhotoRow)
    assert isinstance(row, PhotoRow)
    assert row.isVisible()
    shown = row.pixmap().toImage()
    assert shown.width() == 2 * shown.height() == 160
    assert shown.pixelColor(80, 40).name() == "#d7000f"
    choose(frozenset({"b"}))
    assert not row.isVisible()
