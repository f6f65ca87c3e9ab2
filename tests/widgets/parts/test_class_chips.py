"""Classes at hand while a paint tool is: a click puts one on the brush."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QToolButton
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.recording.columns.classes import class_key, point_classes
from tests.widgets.builders import shared_state
from widgets.parts.class_chips import INTERACTIVE, ClassChips
from widgets.parts.drawing_bar import DrawingBar
from widgets.shared.label_palette import LabelPalette


def test_a_click_puts_a_class_on_the_brush_and_shows_it(qtbot: QtBot) -> None:
    palette = LabelPalette()
    chips = ClassChips(palette, "ja")
    qtbot.addWidget(chips)
    chips.show()
    assert [chips.chip(code).text() for code in INTERACTIVE] == [
        "地面",
        "その他",
        "低ノイズ",
        "高ノイズ",
    ]
    for code in INTERACTIVE:
        for _ in range(2):
            qtbot.mouseClick(chips.chip(code), Qt.MouseButton.LeftButton)
            assert palette.rule.code == code
            assert [one for one in INTERACTIVE if chips.chip(one).isChecked()] == [code]


def test_another_class_is_shown_as_long_as_it_is_on_the_brush(qtbot: QtBot) -> None:
    palette = LabelPalette()
    chips = ClassChips(palette, "en")
    qtbot.addWidget(chips)
    chips.show()
    assert not chips.chip(6).isVisible()
    palette.choose(6)
    assert chips.chip(6).isVisible()
    assert chips.chip(6).isChecked()
    palette.choose(0)
    assert not chips.chip(6).isVisible()
    assert not any(chips.chip(code).isChecked() for code in INTERACTIVE)


def test_classes_without_a_chip_are_in_a_list_that_puts_them_on_the_brush(qtbot: QtBot) -> None:
    palette = LabelPalette()
    chips = ClassChips(palette, "ja")
    qtbot.addWidget(chips)
    (button,) = (one for one in chips.findChildren(QToolButton) if one.menu() is not None)
    listed = {action.text(): action for action in button.menu().actions()}
    known = {one.code: one.name.ja for one in point_classes() if one.code}
    assert list(listed) == [name for code, name in known.items() if code not in INTERACTIVE]
    for code in (65, 67):
        listed[known[code]].trigger()
        assert palette.rule.code == code
        assert chips.chip(code).isVisibleTo(chips)


def test_every_class_at_hand_has_a_key_and_no_key_two_classes(qtbot: QtBot) -> None:
    keys = [key for one in point_classes() if (key := class_key(one.code))]
    assert len(keys) == len(set(keys))
    chips = ClassChips(LabelPalette(), "en")
    qtbot.addWidget(chips)
    for code in INTERACTIVE:
        assert class_key(code) in keys
        assert f"({class_key(code)})" in chips.chip(code).toolTip()


def test_the_drawing_bar_has_classes_for_paint_tools_and_kinds_for_others(qtbot: QtBot) -> None:
    hints = {"paint-lasso": Text.same("a"), "line": Text.same("b")}
    bar = DrawingBar(shared_state(), hints, "en")
    qtbot.addWidget(bar)
    bar.show()
    chips = bar.findChild(ClassChips)
    assert chips is not None
    assert not chips.isVisible()
    high = bar.height()
    bar.show_tool("paint-lasso")
    assert chips.isVisible()
    bar.show_tool("line")
    assert not chips.isVisible()
    assert bar.height() == high
