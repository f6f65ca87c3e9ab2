"""Jobs as people see them."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QProgressBar, QToolButton
from pytestqt.qtbot import QtBot

from widgets.panels.jobs_panel import JobsPanel
from widgets.parts.job_view import JobView, time_left

RUNNING = JobView("a", "Curbs", 0.62, "Block 3 of 7", 4.2, "running")


@pytest.fixture
def panel(qtbot: QtBot) -> JobsPanel:
    panel = JobsPanel("en")
    qtbot.addWidget(panel)
    panel.resize(300, 400)
    panel.show()
    return panel


def words_in(panel: JobsPanel) -> str:
    return "\n".join(label.text() for label in panel.findChildren(QLabel) if not label.isHidden())


def test_a_running_job_says_what_how_far_and_how_long(panel: JobsPanel) -> None:
    panel.show_job(RUNNING)
    words = words_in(panel)
    for part in ("Curbs", "62 %", "0:04 left", "Block 3 of 7"):
        assert part in words
    bar = panel.findChild(QProgressBar)
    assert bar is not None
    assert bar.value() == 620


def test_cancel_names_the_job(qtbot: QtBot, panel: JobsPanel) -> None:
    panel.show_job(RUNNING)
    button = panel.findChild(QToolButton)
    assert button is not None
    with qtbot.waitSignal(panel.cancel_requested) as asked:
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert asked.args == ["a"]


def test_a_failed_job_tells_what_where_and_what_to_do(panel: JobsPanel) -> None:
    error = "The file ends early. | street.laz, byte 48 | Copy it again."
    panel.show_job(JobView("a", "Import", 0.3, "", None, "failed", error))
    words = words_in(panel)
    assert "failed" in words
    assert "The file ends early.\nstreet.laz, byte 48\nCopy it again." in words
    buttons = panel.findChildren(QToolButton)
    assert all(button.isHidden() for button in buttons)


def test_a_job_that_goes_on_stays_one_line_of_the_list(panel: JobsPanel) -> None:
    panel.show_job(RUNNING)
    panel.show_job(JobView("a", "Curbs", 1.0, "", 0.0, "finished"))
    assert [job.state for job in panel.shown()] == ["finished"]
    assert "done" in words_in(panel)


def test_many_ended_jobs_are_forgotten_but_none_that_runs(panel: JobsPanel) -> None:
    panel.show_job(RUNNING)
    for number in range(60):
        panel.show_job(JobView(str(number), "Noise", 1.0, "", None, "cancelled"))
    shown = panel.shown()
    assert len(shown) == 51
    assert RUNNING in shown


@pytest.mark.parametrize(
    ("seconds", "words"), [(None, ""), (0.2, "0:00"), (64.6, "1:05"), (3_723, "1:02:03")]
)
def test_time_left_is_short(seconds: float | None, words: str) -> None:
    assert time_left(seconds) == words
