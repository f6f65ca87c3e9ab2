"""Coordinates, messages and progress."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QToolButton
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.recording.drive import Drive
from tests.widgets.builders import OpenMap
from widgets.parts.job_view import JobView
from widgets.parts.number_field import NumberField, coordinate, decimals_for
from widgets.parts.status_line import StatusLine
from widgets.shared.cursor import PickedPosition


@pytest.fixture
def open_map(left_drive: Drive) -> OpenMap:
    return OpenMap((left_drive,))


@pytest.fixture
def line(qtbot: QtBot, open_map: OpenMap) -> StatusLine:
    line = StatusLine(open_map, open_map.shared, "ja")
    qtbot.addWidget(line)
    line.show()
    return line


def test_coordinates_have_a_dot_and_three_decimals(line: StatusLine, open_map: OpenMap) -> None:
    open_map.shared.cursor.move_to(PickedPosition((-11_394.6084, -35_139.9151, 125.682)))
    assert line.position_text == "E −11,394.608  N −35,139.915  H 125.682"


def test_what_the_mouse_is_over_goes_before_the_cursor(line: StatusLine, open_map: OpenMap) -> None:
    open_map.shared.cursor.move_to(PickedPosition((1.0, 2.0, 3.0)))
    open_map.shared.cursor.hover_over(PickedPosition((4.0, 5.0, 6.0)))
    assert line.position_text == "E 4.000  N 5.000  H 6.000"
    open_map.shared.cursor.hover_over(None)
    assert line.position_text == "E 1.000  N 2.000  H 3.000"


def test_the_reference_system_is_shown(line: StatusLine) -> None:
    assert "EPSG:6677" in [label.text() for label in line.findChildren(QLabel)]


def test_messages_are_said_in_the_language(line: StatusLine) -> None:
    line.show_message(Text("Drawn.", "作図しました。"))
    assert line.currentMessage() == "作図しました。"


def test_the_job_that_runs_is_shown_until_none_does(line: StatusLine) -> None:
    line.show_job(JobView("a", "Curbs", 0.62, "", 4.0, "running"))
    assert line.job_text == "Curbs 62 %, 0:04 left"
    line.show_job(None)
    assert line.job_text == ""


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (0.0, "0.000"),
        (-0.0001, "0.000"),
        (-0.0006, "−0.001"),
        (1_234_567.8904, "1,234,567.890"),
        (-12.3456, "−12.346"),
    ],
)
def test_coordinates_are_written_as_surveyors_read_them(value: float, words: str) -> None:
    assert coordinate(value) == words


def test_a_number_field_writes_no_zeros_that_say_nothing(qtbot: QtBot) -> None:
    field = NumberField(0.0, 10.0, unit="m", decimals=3)
    qtbot.addWidget(field)
    field.setValue(0.5)
    assert field.text() == "0.5 m"
    assert decimals_for(0.0001, 5.0) == 4


def test_the_wheel_over_a_form_changes_no_number(qtbot: QtBot) -> None:
    field = NumberField(0.0, 10.0)
    qtbot.addWidget(field)
    assert field.focusPolicy() == Qt.FocusPolicy.StrongFocus


def test_the_button_beside_a_job_cancels_just_that_one(qtbot: QtBot, line: StatusLine) -> None:
    button = line.findChild(QToolButton)
    assert isinstance(button, QToolButton)
    assert not button.isVisible()
    line.show_job(JobView("7", "模擬計測", 0.3, "", None, "running", ""))
    with qtbot.waitSignal(line.cancel_requested) as asked:
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert asked.args == ["7"]
    line.show_job(None)
    assert not button.isVisible()
