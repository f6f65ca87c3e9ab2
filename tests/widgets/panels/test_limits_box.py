"""The box of limits: a work type is chosen, or another table is asked for."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from widgets.panels.volume.limits_box import LimitsBox

ROAD, CUTTING = ("road", Text("Embankment", "盛土")), ("cutting", Text("Cutting", "掘削"))


@pytest.fixture
def box(qtbot: QtBot) -> LimitsBox:
    made = LimitsBox("en")
    qtbot.addWidget(made)
    made.show_table((ROAD, CUTTING), "cutting", "")
    return made


def pick(box: LimitsBox, words: str) -> None:
    """Choose as the mouse would."""
    number = box.findText(words)
    assert number >= 0, words
    box.setCurrentIndex(number)
    box.activated.emit(number)


def test_the_chosen_work_type_is_shown_and_another_one_can_be_chosen(
    qtbot: QtBot, box: LimitsBox
) -> None:
    assert box.currentText() == "Cutting"
    with qtbot.waitSignal(box.work_type_chosen) as chosen:
        pick(box, "Embankment")
    assert chosen.args == ["road"]
    assert box.currentText() == "Embankment"


def test_another_table_is_asked_for_and_until_then_nothing_changes(
    qtbot: QtBot, box: LimitsBox
) -> None:
    assert box.findText("Table of the program") < 0
    with qtbot.waitSignal(box.table_wanted), qtbot.assertNotEmitted(box.work_type_chosen):
        pick(box, "Other table…")
    assert box.currentText() == "Cutting"


def test_an_own_table_says_its_name_and_leads_back(qtbot: QtBot, box: LimitsBox) -> None:
    box.show_table((ROAD,), "road", "office.toml")
    assert box.currentText() == "Embankment  [office.toml]"
    assert "Limits from office.toml" in box.toolTip()
    with qtbot.waitSignal(box.bundled_wanted):
        pick(box, "Table of the program")
    assert box.currentText() == "Embankment  [office.toml]"


def test_the_table_can_be_asked_for_as_a_file(qtbot: QtBot, box: LimitsBox) -> None:
    with qtbot.waitSignal(box.copy_wanted), qtbot.assertNotEmitted(box.work_type_chosen):
        pick(box, "Write this table as a file…")
    assert box.currentText() == "Cutting"


def test_without_any_work_type_another_table_can_still_be_chosen(
    qtbot: QtBot, box: LimitsBox
) -> None:
    box.show_table((), "", "?")
    assert box.currentText() == ""
    assert box.findText("Write this table as a file…") < 0
    with qtbot.waitSignal(box.table_wanted):
        pick(box, "Other table…")
