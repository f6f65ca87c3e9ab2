"""A sign's legal number: chosen by the shape of its plate, with the class that it says."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QSize, Qt
from PySide6.QtGui import QAction, QColor, QPixmap
from PySide6.QtWidgets import QApplication, QLineEdit, QMenu, QWidget
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.change import Change
from processing.map.feature import AttributeValue, Feature, Vertex
from processing.map.sign_numbers import PlateLook, numbers_for, offered_numbers, sign_numbers
from processing.project.photos import photo_folder, photo_name, write_photos
from resources import path_of
from tests.widgets.builders import OpenMap
from widgets.panels.attributes.attribute_panel import AttributePanel
from widgets.panels.attributes.photo_row import PhotoRow
from widgets.panels.attributes.sign_numbers import SignNumberMenu, implied_kind
from widgets.panels.attributes.sign_plates import sign_picture


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
        is_entry = not one.isSeparator() and bool(one.text())
        found += entries(below) if isinstance(below, QMenu) else [one] if is_entry else []
    return found


def numbers_in(menu: QMenu) -> list[str]:
    return [one.text().split()[0] for one in entries(menu)]


def first_numbers_in(menu: QMenu) -> list[str]:
    """Those that look like the sign, without what else may be chosen."""
    more = {"Other colours and sizes", "Other shapes", "他の色・寸法", "他の形"}
    left = [one for one in menu.actions() if one.text() in more]
    for one in left:
        menu.removeAction(one)
    first = numbers_in(menu)
    menu.addActions(left)
    return first


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
    assert offered in first_numbers_in(menu)
    assert left_out not in first_numbers_in(menu)
    assert len(numbers_in(menu)) == len(sign_numbers())
    assert not any(one.icon().isNull() for one in entries(menu))


@pytest.mark.parametrize(
    ("colour", "first", "later"), [("blue", "316", "323"), ("white", "323", "316")]
)
def test_signs_of_the_plates_colour_come_first_and_others_stay(
    qtbot: QtBot, colour: str, first: str, later: str
) -> None:
    menu = SignNumberMenu((sign("a", shape="circle", colour=colour),), "en")
    qtbot.addWidget(menu)
    assert first in first_numbers_in(menu)
    assert later not in first_numbers_in(menu)
    assert later in numbers_in(menu)


def test_only_guide_signs_are_larger_than_the_order_lets_others_be() -> None:
    small = offered_numbers(PlateLook("rectangle", size_m=0.9))
    large = offered_numbers(PlateLook("rectangle", size_m=2.4))
    assert {one.sign_class for one in small.likely} == {"guide", "regulation", "instruction"}
    assert {one.sign_class for one in large.likely} == {"guide"}
    assert {one.number for one in (*large.likely, *large.unlikely, *large.others)} == {
        one.number for one in sign_numbers()
    }


def test_a_colour_that_no_sign_of_the_shape_has_leaves_all_of_the_shape() -> None:
    offered = offered_numbers(PlateLook("diamond", colour="blue"))
    assert offered.likely == numbers_for("diamond", is_supplement=False)
    assert not offered.unlikely


def colours_of(number: str, shape: str) -> set[str]:
    """What a sign's picture is painted with, the mixtures at edges left out."""
    chosen = next(one for one in sign_numbers() if one.number == number)
    picture = sign_picture(chosen, shape).pixmap(QSize(40, 40), 2.0).toImage()
    pixels = [
        picture.pixelColor(x, y) for x in range(picture.width()) for y in range(picture.height())
    ]
    names = [one.name() for one in pixels if one.alpha() == 255]
    return {one for one in names if names.count(one) > 20}


@pytest.mark.parametrize(
    ("number", "shape", "painted"),
    [("330", "triangle", {"#d7000f", "#ffffff"}), ("316", "circle", {"#0068b7", "#d7000f"}),
     ("323", "circle", {"#ffffff", "#d7000f", "#0068b7"}),
     ("303", "circle", {"#d7000f", "#ffffff"}),
     ("208", "diamond", {"#ffd800", "#111111"}), ("317", "circle", {"#0068b7", "#ffffff"})],
)  # fmt: skip
def test_pictures_show_ground_rim_and_symbol_or_the_number(
    qtbot: QtBot, number: str, shape: str, painted: set[str]
) -> None:
    assert qtbot is not None
    assert painted <= colours_of(number, shape)


def test_the_picture_of_the_sign_stands_above_what_is_offered(qtbot: QtBot) -> None:
    photo = QPixmap(30, 30)
    photo.fill(QColor("#d7000f"))
    menu = SignNumberMenu((sign("a", shape="triangle"),), "ja", photo=photo)
    qtbot.addWidget(menu)
    menu.popup(QPoint(0, 0))
    shown = menu.findChild(QWidget, "photo")
    assert isinstance(shown, QWidget)
    middle = shown.grab().toImage().pixelColor(shown.width() // 2, shown.height() // 2)
    assert middle.name() == "#d7000f"
    qtbot.keyClick(menu, Qt.Key.Key_Down)
    assert menu.activeAction().text().startswith("118")


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
