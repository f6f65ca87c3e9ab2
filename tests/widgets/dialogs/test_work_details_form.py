"""The form of work details: typed by keys, given as a whole, refused with a reason."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialogButtonBox, QLabel, QLineEdit
from pytestqt.qtbot import QtBot

from processing.core.parameters import MOST_LETTERS, parameters_of
from processing.core.text import Language
from processing.project.work_details import WorkDetails
from widgets.dialogs.work_details import WorkDetailsForm

LEFT = Qt.MouseButton.LeftButton
DETAILS = WorkDetails(client="A県", contractor="B建設", height_datum="JGD2024")


def shown(qtbot: QtBot, language: Language = "en") -> WorkDetailsForm:
    form = WorkDetailsForm(DETAILS, "造成-1", language)
    qtbot.addWidget(form)
    form.show()
    qtbot.waitExposed(form)
    return form


def line(form: WorkDetailsForm, id_: str) -> QLineEdit:
    found = form.findChild(QLineEdit, id_)
    assert isinstance(found, QLineEdit)
    return found


def press(qtbot: QtBot, form: WorkDetailsForm, which: QDialogButtonBox.StandardButton) -> None:
    buttons = form.findChild(QDialogButtonBox)
    assert isinstance(buttons, QDialogButtonBox)
    qtbot.mouseClick(buttons.button(which), LEFT)


def test_what_is_typed_is_given_with_what_was_there(qtbot: QtBot) -> None:
    form = shown(qtbot)
    qtbot.keyClicks(line(form, "surveyor"), " Taro ")
    line(form, "client").clear()
    qtbot.keyClicks(line(form, "client"), "C")
    with qtbot.waitSignal(form.details_given) as given:
        press(qtbot, form, QDialogButtonBox.StandardButton.Ok)
    expected = WorkDetails(client="C", contractor="B建設", surveyor="Taro", height_datum="JGD2024")
    assert given.args == [expected]
    assert form.isVisible(), "until they are kept"


def test_cancel_gives_nothing(qtbot: QtBot) -> None:
    form = shown(qtbot)
    with qtbot.assertNotEmitted(form.details_given):
        qtbot.keyClicks(line(form, "client"), "C")
        press(qtbot, form, QDialogButtonBox.StandardButton.Cancel)
    assert not form.isVisible()


def test_the_name_of_the_project_stands_where_the_work_has_none(qtbot: QtBot) -> None:
    form = shown(qtbot)
    assert line(form, "work").text() == ""
    assert line(form, "work").placeholderText() == "造成-1"


@pytest.mark.parametrize("language", ["en", "ja"])
def test_every_detail_has_a_line_with_its_name(qtbot: QtBot, language: Language) -> None:
    form = shown(qtbot, language)
    words = {one.text() for one in form.findChildren(QLabel)}
    for one in parameters_of(WorkDetails):
        assert one.name.in_language(language) in words
        assert line(form, one.id).isVisible()


def test_a_line_takes_no_more_than_papers_have_room_for(qtbot: QtBot) -> None:
    form = shown(qtbot)
    line(form, "place").insert("あ" * (MOST_LETTERS + 50))
    assert len(line(form, "place").text()) == MOST_LETTERS


def test_letters_that_no_paper_takes_are_refused_and_the_form_stays(qtbot: QtBot) -> None:
    form = shown(qtbot)
    line(form, "place").setText("a\x07b")
    with qtbot.assertNotEmitted(form.details_given):
        press(qtbot, form, QDialogButtonBox.StandardButton.Ok)
    assert any("one line of up to 100 letters" in one.text() for one in form.findChildren(QLabel))
    line(form, "place").setText("ab")
    with qtbot.waitSignal(form.details_given):
        press(qtbot, form, QDialogButtonBox.StandardButton.Ok)
