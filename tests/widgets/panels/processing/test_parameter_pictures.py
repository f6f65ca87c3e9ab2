"""Pictures of parameters: every named one is there, and the one at hand is shown."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from PySide6.QtCore import QPoint
from PySide6.QtGui import QColor, QPalette
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QComboBox
from pytestqt.qtbot import QtBot

from processing.core.parameters import angle, count, length, parameters_of, switch
from processing.core.text import Text
from processing.recording.kinds import ImageKind
from processing.tools.listed.registry import TOOLS
from processing.tools.tool import CandidateResult, Finder, Needs, Tool
from resources import UnknownResource, path_of
from widgets.panels.processing.parameter_form import ParameterForm
from widgets.panels.processing.processing_panel import ProcessingPanel
from widgets.pictures.image_kind_list import ImageKindList
from widgets.pictures.parameter_picture import PICTURE_PX, ParameterPicture, picture_source

SCENES = sorted(path.stem for path in path_of("pictures/parameters").glob("*.svg"))


@dataclass(frozen=True)
class ShownForm:
    lowest_m: float = length(
        0.03, low=0.01, high=0.2, name=Text("Least", "最小"), picture="curb/lowest"
    )
    most: int = count(5, low=1, high=20, name=Text("Most", "最大"), picture="lids/most")
    lean_deg: float = angle(30.0, low=0.0, high=90.0, name=Text("Lean", "傾き"))
    is_strict: bool = switch(default=False, name=Text("Strict", "厳密"), picture="curb/edges")


def tool(id_: str, parameters: type[object]) -> Tool:
    name = Text.same(id_)
    method = Finder(lambda *_: CandidateResult())
    return Tool(id_, name, name, Text("Road", "道路"), Needs.POINTS, parameters, method)


@dataclass(frozen=True)
class Plain:
    size_m: float = length(0.5, low=0.1, high=1.0, name=Text("Size", "大きさ"))


@pytest.fixture
def panel(qtbot: QtBot) -> ProcessingPanel:
    panel = ProcessingPanel(
        "en", {"shown": tool("shown", ShownForm), "plain": tool("plain", Plain)}
    )
    qtbot.addWidget(panel)
    panel.resize(300, 700)
    panel.show()
    panel.activateWindow()
    qtbot.waitUntil(panel.isActiveWindow, timeout=5_000)
    return panel


def picture_of(panel: ProcessingPanel) -> ParameterPicture:
    found = panel.findChild(ParameterPicture)
    assert found is not None
    return found


def form_of(panel: ProcessingPanel) -> ParameterForm:
    assert panel.form is not None
    return panel.form


def test_the_pictures_that_parameters_name_are_there() -> None:
    for tool_of_program in TOOLS.values():
        for parameter in parameters_of(tool_of_program.parameters):
            if parameter.picture:
                assert 'id="' in picture_source(parameter.picture)


@pytest.mark.parametrize("scene", SCENES)
def test_pictures_have_one_size_four_colours_and_no_words(scene: str) -> None:
    source = picture_source(scene)
    wide, high = PICTURE_PX.width(), PICTURE_PX.height()
    assert f'viewBox="0 0 {wide} {high}"' in source
    assert "<text" not in source
    colours = {source[at : at + 7] for at in range(len(source)) if source[at] == "#"}
    assert colours <= {"#202020", "#9a9a9a", "#dcdcdc", "#0b6bcb"}


def test_the_list_of_pictures_names_each_of_them() -> None:
    reported = path_of("pictures/parameters/README.md").read_text(encoding="utf-8")
    for scene in SCENES:
        assert f"| `{scene}`" in reported
        for piece in picture_source(scene).split('<g id="')[1:]:
            assert f"`{piece.partition(chr(34))[0]}`" in reported


def test_only_the_part_that_is_meant_is_in_the_picture() -> None:
    assert 'id="lowest"' in picture_source("curb/lowest")
    assert 'id="highest"' not in picture_source("curb/lowest")
    assert 'id="highest"' in picture_source("curb")
    with pytest.raises(KeyError):
        picture_source("curb/nothing")
    with pytest.raises(UnknownResource):
        picture_source("nothing")


def test_the_first_picture_is_shown_until_a_field_is_at_hand(panel: ProcessingPanel) -> None:
    assert picture_of(panel).isVisible()
    assert picture_of(panel).name == "curb/lowest"


def test_the_field_that_is_typed_into_is_shown(qtbot: QtBot, panel: ProcessingPanel) -> None:
    form_of(panel).field("most").setFocus()
    qtbot.waitUntil(lambda: picture_of(panel).name == "lids/most", timeout=5_000)
    form_of(panel).field("is_strict").setFocus()
    qtbot.waitUntil(lambda: picture_of(panel).name == "curb/edges", timeout=5_000)


def test_the_mouse_goes_before_the_keyboard(qtbot: QtBot, panel: ProcessingPanel) -> None:
    form = form_of(panel)
    form.field("most").setFocus()
    qtbot.waitUntil(lambda: picture_of(panel).name == "lids/most", timeout=5_000)
    strict = form.field("is_strict")
    QTest.mouseMove(panel, strict.mapTo(panel, strict.rect().center()))
    qtbot.waitUntil(lambda: picture_of(panel).name == "curb/edges", timeout=5_000)
    QTest.mouseMove(panel, QPoint(20, 8))
    qtbot.waitUntil(lambda: picture_of(panel).name == "lids/most", timeout=5_000)


def test_a_tool_without_pictures_leaves_no_room_for_them(panel: ProcessingPanel) -> None:
    panel.show_tool("plain")
    assert not picture_of(panel).isVisible()
    panel.show_tool("shown")
    assert picture_of(panel).isVisible()


def test_a_picture_takes_the_colours_of_the_window(qtbot: QtBot) -> None:
    picture = ParameterPicture()
    qtbot.addWidget(picture)
    picture.resize(PICTURE_PX)
    picture.show_picture("curb/lowest")
    for ground, ink in (("#f4f4f4", "#101010"), ("#202124", "#f0f0f0")):
        palette = QPalette(picture.palette())
        palette.setColor(QPalette.ColorRole.Window, QColor(ground))
        palette.setColor(QPalette.ColorRole.WindowText, QColor(ink))
        picture.setPalette(palette)
        image = picture.grab().toImage()
        # The carriageway's line, and the empty air above it.
        column = [image.pixelColor(20, y).name() for y in range(60, 130)]
        assert ink in column
        assert image.pixelColor(20, 20).name() == ground


def test_a_tool_is_run_as_its_form_stands_by_one_word(qtbot: QtBot, panel: ProcessingPanel) -> None:
    asked: list[tuple[str, object]] = []
    panel.run_requested.connect(lambda tool_id, values: asked.append((tool_id, values)))
    assert panel.run_tool("plain")
    form_of(panel).set_values({"most": 7})
    assert panel.run_tool("shown")
    assert asked == [("plain", Plain()), ("shown", ShownForm(most=7))]
    panel.ask_reasons_from(lambda tool_id: Text("No.", "不可。") if tool_id == "plain" else None)
    assert not panel.run_tool("plain")
    assert len(asked) == 2


def test_every_kind_of_image_has_a_picture_and_a_sentence() -> None:
    for kind in ImageKind:
        assert f'id="{kind.value}"' in picture_source(f"image_kind/{kind.value}")
        assert kind.explanation.en.endswith(".")
        assert kind.explanation.ja.endswith("。")


def test_the_list_of_kinds_has_room_for_picture_and_words(qtbot: QtBot) -> None:
    box = QComboBox()
    qtbot.addWidget(box)
    for kind in ImageKind:
        box.addItem(kind.title.en, kind.value)
    ImageKindList(box, "en")
    box.show()
    box.showPopup()
    view = box.view()
    qtbot.waitUntil(view.isVisible, timeout=5_000)
    row = view.visualRect(box.model().index(0, 0))
    assert row.height() >= 4 * view.fontMetrics().lineSpacing()
    assert row.width() >= 378
    painted = view.grab(row).toImage()
    spots = [(x, y) for x in range(10, 130, 2) for y in range(10, 60, 2)]
    assert len({painted.pixel(*spot) for spot in spots}) > 3
    box.hidePopup()
