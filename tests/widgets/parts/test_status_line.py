"""Coordinates, messages, progress and the start page."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QListWidget, QPushButton
from pytestqt.qtbot import QtBot

from processing.points.drive import Drive
from processing.text import Text
from tests.widgets.builders import OpenMap
from widgets.panels.jobs_panel import JobView
from widgets.parts.number_field import NumberField, coordinate, decimals_for
from widgets.parts.start_page import StartPage
from widgets.parts.status_line import StatusLine
from widgets.shared.cursor import Place


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
    open_map.shared.cursor.move_to(Place((-11_394.6084, -35_139.9151, 125.682)))
    assert line.place_text == "E −11,394.608  N −35,139.915  H 125.682"


def test_what_the_mouse_is_over_goes_before_the_cursor(line: StatusLine, open_map: OpenMap) -> None:
    open_map.shared.cursor.move_to(Place((1.0, 2.0, 3.0)))
    open_map.shared.cursor.hover_over(Place((4.0, 5.0, 6.0)))
    assert line.place_text == "E 4.000  N 5.000  H 6.000"
    open_map.shared.cursor.hover_over(None)
    assert line.place_text == "E 1.000  N 2.000  H 3.000"


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


@pytest.mark.parametrize("wish", ["open", "import", "demo"])
def test_the_start_page_has_three_ways_to_begin(qtbot: QtBot, wish: str) -> None:
    page = StartPage()
    qtbot.addWidget(page)
    page.show()
    order = ["import", "open", "demo"]
    button = page.findChildren(QPushButton)[order.index(wish)]
    with qtbot.waitSignal(getattr(page, f"{wish}_requested")):
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def test_a_click_on_a_recent_project_opens_it_once(qtbot: QtBot, tmp_path: Path) -> None:
    page = StartPage()
    qtbot.addWidget(page)
    page.show_recent((tmp_path / "国道.zuka", tmp_path / "Street.zuka"))
    page.show()
    recent = page.findChild(QListWidget)
    assert recent is not None
    chosen: list[Path] = []
    page.recent_chosen.connect(chosen.append)
    spot = recent.visualItemRect(recent.item(0)).center()
    qtbot.mouseClick(
        recent.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, spot
    )
    assert chosen == [tmp_path / "国道.zuka"]


def test_without_recent_projects_there_is_no_empty_list(qtbot: QtBot) -> None:
    page = StartPage()
    qtbot.addWidget(page)
    page.show()
    recent = page.findChild(QListWidget)
    assert recent is not None
    assert not recent.isVisible()
