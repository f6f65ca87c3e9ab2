"""The form of the keys: press a new one, hear at once what speaks against it."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QKeySequenceEdit, QLabel, QLineEdit, QPushButton, QTreeWidget
from pytestqt.qtbot import QtBot

from widgets.dialogs.shortcuts import KeyProblem, ShortcutRow, ShortcutsForm

TAKEN = KeyProblem("Ctrl+E already does: Export; it would lose its key.", may_be_taken=True)
FIXED = KeyProblem("Space belongs to the views.", may_be_taken=False)
ROWS = (
    ShortcutRow("export", "Export", "書き出し", "File", "Ctrl+E", "Ctrl+E"),
    ShortcutRow("curb", "Draw: Curb", "作図: 縁石", "Draw", "1", "1", is_changed=True),
    ShortcutRow("", "Zoom at the mouse", "拡大・縮小", "Views (fixed)", "Wheel"),
)


@pytest.fixture
def form(qtbot: QtBot) -> ShortcutsForm:
    form = ShortcutsForm()
    form.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, on=False)
    qtbot.addWidget(form)
    troubles = {"Ctrl+E": TAKEN, "Space": FIXED}
    form.ask_trouble_from(lambda _id, key: troubles.get(key))
    form.show_rows(ROWS)
    form.show()
    qtbot.waitExposed(form)
    return form


def part(form: ShortcutsForm, kind: type) -> object:
    found = form.findChild(kind)
    assert found is not None
    return found


def button(form: ShortcutsForm, text: str) -> QPushButton:
    (found,) = [one for one in form.findChildren(QPushButton) if one.text() == text]
    return found


def said(form: ShortcutsForm) -> str:
    return " ".join(label.text() for label in form.findChildren(QLabel))


def press(qtbot: QtBot, form: ShortcutsForm, key: Qt.Key, *, ctrl: bool = False) -> None:
    modifier = Qt.KeyboardModifier.ControlModifier if ctrl else Qt.KeyboardModifier.NoModifier
    qtbot.keyClick(part(form, QKeySequenceEdit), key, modifier)


def test_a_key_that_is_free_is_given_at_once(qtbot: QtBot, form: ShortcutsForm) -> None:
    form.choose("curb")
    with qtbot.waitSignal(form.key_chosen) as chosen:
        press(qtbot, form, Qt.Key.Key_K, ctrl=True)
    assert chosen.args == ["curb", "Ctrl+K"]


def test_a_key_in_use_is_only_given_when_one_says_so(qtbot: QtBot, form: ShortcutsForm) -> None:
    form.choose("curb")
    with qtbot.assertNotEmitted(form.key_chosen):
        press(qtbot, form, Qt.Key.Key_E, ctrl=True)
    assert TAKEN.sentence in said(form)
    with qtbot.waitSignal(form.key_chosen) as chosen:
        qtbot.mouseClick(button(form, "Use it here"), Qt.MouseButton.LeftButton)
    assert chosen.args == ["curb", "Ctrl+E"]


def test_a_key_of_the_views_is_refused(qtbot: QtBot, form: ShortcutsForm) -> None:
    form.choose("curb")
    with qtbot.assertNotEmitted(form.key_chosen):
        press(qtbot, form, Qt.Key.Key_Space)
    assert FIXED.sentence in said(form)
    assert not button(form, "Use it here").isVisible()


def test_what_is_fixed_is_listed_and_can_not_be_changed(form: ShortcutsForm) -> None:
    rows = part(form, QTreeWidget)
    rows.setCurrentItem(rows.topLevelItem(2))
    assert not part(form, QKeySequenceEdit).isEnabled()


def test_a_command_may_have_no_key(qtbot: QtBot, form: ShortcutsForm) -> None:
    form.choose("export")
    with qtbot.waitSignal(form.key_chosen) as chosen:
        qtbot.mouseClick(button(form, "No key"), Qt.MouseButton.LeftButton)
    assert chosen.args == ["export", ""]


def test_holding_ctrl_alone_takes_no_key_away(qtbot: QtBot, form: ShortcutsForm) -> None:
    form.choose("export")
    with qtbot.assertNotEmitted(form.key_chosen):
        press(qtbot, form, Qt.Key.Key_Control)


def test_only_a_changed_key_can_be_reset(qtbot: QtBot, form: ShortcutsForm) -> None:
    form.choose("export")
    assert not button(form, "Reset this one").isEnabled()
    form.choose("curb")
    with qtbot.waitSignal(form.default_requested) as asked:
        qtbot.mouseClick(button(form, "Reset this one"), Qt.MouseButton.LeftButton)
    assert asked.args == ["curb"]


@pytest.mark.parametrize(("typed", "left"), [("書き", 0), ("ctrl+e", 0), ("draw", 1), ("wheel", 2)])
def test_a_line_is_found_by_name_in_either_language_menu_and_key(
    qtbot: QtBot, form: ShortcutsForm, typed: str, left: int
) -> None:
    search = next(one for one in form.findChildren(QLineEdit) if one.placeholderText())
    search.setText(typed)
    rows = part(form, QTreeWidget)
    shown = [at for at in range(3) if not rows.topLevelItem(at).isHidden()]
    assert shown == [left]


def test_the_chosen_line_stays_chosen_when_the_list_is_new(form: ShortcutsForm) -> None:
    form.choose("curb")
    form.show_rows(ROWS)
    assert part(form, QTreeWidget).currentItem().text(0) == "Draw: Curb"
