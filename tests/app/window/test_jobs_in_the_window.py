"""Work that goes on while the window is closed, and what the list of jobs tells of it later."""

from __future__ import annotations

import threading
from pathlib import Path

from PySide6.QtWidgets import QMessageBox, QPushButton, QToolButton
from pytestqt.qtbot import QtBot

from app.window.window_parts import WindowParts
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.operations.export import ExportRequest
from resources import path_of
from tests.app.conftest import WAIT_MS
from widgets.dialogs.import_drive import ImportForm, ImportOptions

TITLE = Text("Long work", "長い作業")


def endless(parts: WindowParts) -> threading.Event:
    began = threading.Event()

    def work(monitor: Monitor) -> None:
        began.set()
        while True:
            monitor.check()
            threading.Event().wait(0.01)

    parts.jobs.start(TITLE, work)
    return began


def question_of(parts: WindowParts) -> QMessageBox | None:
    found = [one for one in parts.window.findChildren(QMessageBox) if one.isVisible()]
    return found[0] if found else None


def test_quitting_in_the_middle_of_a_job_asks_and_the_work_goes_on(
    parts: WindowParts, qtbot: QtBot
) -> None:
    began = endless(parts)
    qtbot.waitUntil(began.is_set, timeout=WAIT_MS)
    assert not parts.window.close()
    question = question_of(parts)
    assert question is not None
    assert "Long work" in question.informativeText()
    stay = question.escapeButton()
    assert isinstance(stay, QPushButton)
    stay.click()
    assert parts.window.isVisible()
    assert parts.jobs.is_busy
    assert not parts.window.close()
    question = question_of(parts)
    assert question is not None
    (leave,) = [one for one in question.buttons() if one is not question.escapeButton()]
    leave.click()
    assert not parts.window.isVisible()


def test_without_a_job_the_window_closes_unasked(parts: WindowParts) -> None:
    assert parts.window.close()
    assert question_of(parts) is None


def test_a_cancelled_job_says_so(parts: WindowParts, qtbot: QtBot) -> None:
    began = endless(parts)
    qtbot.waitUntil(began.is_set, timeout=WAIT_MS)
    with qtbot.waitSignal(parts.jobs.cancelled, timeout=WAIT_MS):
        parts.window.actions_by_id["cancel-jobs"].trigger()
    assert parts.status_line.currentMessage() == "Cancelled: Long work"


def test_the_list_tells_what_a_job_made_and_forgets_it_with_its_project(
    parts: WindowParts, qtbot: QtBot, tmp_path: Path
) -> None:
    assert parts.document.create(tmp_path / "street.zuka", "EPSG:6677")
    with qtbot.waitSignal(parts.document.exported, timeout=WAIT_MS):
        parts.document.export(ExportRequest(formats=("geojson",), folder=tmp_path / "out"))
    (job,) = parts.jobs_panel.shown()
    assert job.state == "finished"
    assert job.started
    assert "Exported" in job.result
    parts.document.close()
    assert parts.jobs_panel.shown() == ()


def test_after_an_export_its_folder_and_files_are_offered(
    parts: WindowParts, qtbot: QtBot, tmp_path: Path
) -> None:
    assert parts.document.create(tmp_path / "street.zuka", "EPSG:6677")
    with qtbot.waitSignal(parts.document.exported, timeout=WAIT_MS):
        parts.document.export(ExportRequest(formats=("geojson",), folder=tmp_path / "out"))
    shown = [one for one in parts.message_bar.findChildren(QToolButton) if one.isVisible()]
    offered = {one.text(): one for one in shown}
    assert {"Open the folder", "Open a file"} <= set(offered)
    menu = offered["Open a file"].defaultAction().menu()
    assert [one.text() for one in menu.actions()] == ["street.geojson"]  # type: ignore[attr-defined]
    assert parts.message_bar.error is None


def test_a_failed_import_keeps_what_was_chosen(
    parts: WindowParts, qtbot: QtBot, tmp_path: Path
) -> None:
    damaged = tmp_path / "street.laz"
    damaged.write_bytes(path_of("sample_street/left.laz").read_bytes()[:4000])
    parts.window.actions_by_id["import"].trigger()
    (form,) = parts.window.findChildren(ImportForm)
    asked = ImportOptions((damaged,), tmp_path / "通り.zuka", "EPSG:6677")
    with qtbot.waitSignal(parts.jobs.failed, timeout=WAIT_MS):
        form.import_requested.emit(asked)
        form.close()
    shown = [one for one in parts.window.findChildren(ImportForm) if one.isVisible()]
    (again,) = shown
    assert again.files == (damaged,)
    assert again.crs == "EPSG:6677"
    assert parts.message_bar.error is not None
    again.close()
