"""Dialogs belong to the project they were opened for, and close with it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import (
    QApplication,
    QDialog,
    QFileDialog,
    QLineEdit,
    QMessageBox,
    QPushButton,
)
from pytestqt.qtbot import QtBot

from app.classes.truth_evaluations import TruthEvaluations
from app.window.window_parts import WindowParts
from tests.app.conftest import shown_window
from widgets.dialogs.export_map import ExportForm
from widgets.dialogs.import_drive import ImportForm
from widgets.dialogs.reference_systems import ReferenceSystemForm
from widgets.dialogs.shortcuts import ShortcutsForm
from widgets.dialogs.simulate import SimulateForm
from widgets.dialogs.work_details import WorkDetailsForm

WAIT_MS = 30_000
FORMS = {
    "export": ExportForm,
    "import": ImportForm,
    "reference-system": ReferenceSystemForm,
    "work-details": WorkDetailsForm,
}
FILE_DIALOGS = ("find-files", "adopt-catalogue", "export-catalogue")


@pytest.fixture
def parts(qtbot: QtBot, tmp_path: Path) -> Iterator[WindowParts]:
    """The window with the empty project A; B lies beside it."""
    with shown_window(qtbot, tmp_path) as parts:
        assert parts.document.create(tmp_path / "B.zuka", "EPSG:6677")
        assert parts.document.create(tmp_path / "A.zuka", "EPSG:6677")
        yield parts


def type_key(qtbot: QtBot, parts: WindowParts, key: Qt.Key) -> None:
    with qtbot.waitActive(parts.window):
        parts.window.activateWindow()
    qtbot.keyClick(parts.window, key, Qt.KeyboardModifier.ControlModifier)


def shown(parts: WindowParts, kind: type[QDialog] = QDialog) -> list[QDialog]:
    return [one for one in parts.window.findChildren(kind) if one.isVisible()]


def test_a_drawing_never_lands_in_the_folder_of_the_project_that_was_closed(
    qtbot: QtBot, parts: WindowParts, tmp_path: Path
) -> None:
    type_key(qtbot, parts, Qt.Key.Key_E)
    assert len(shown(parts, ExportForm)) == 1
    type_key(qtbot, parts, Qt.Key.Key_W)
    assert shown(parts) == []
    assert parts.document.open(tmp_path / "B.zuka")
    type_key(qtbot, parts, Qt.Key.Key_E)
    (form,) = shown(parts, ExportForm)
    assert form.findChildren(QLineEdit)[0].text() == str(tmp_path / "B-export")
    (button,) = (one for one in form.findChildren(QPushButton) if one.text() == "Export")
    with qtbot.waitSignal(parts.jobs.finished, timeout=WAIT_MS):
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert (tmp_path / "B-export").is_dir()
    assert not (tmp_path / "A-export").exists()


@pytest.mark.parametrize("action", FORMS)
def test_a_form_of_a_project_goes_with_it(parts: WindowParts, action: str, tmp_path: Path) -> None:
    parts.window.actions_by_id[action].trigger()
    assert len(shown(parts, FORMS[action])) == 1
    assert parts.document.open(tmp_path / "B.zuka")
    assert shown(parts) == []


@pytest.mark.parametrize("action", FORMS)
def test_a_form_that_is_open_is_raised_and_keeps_what_was_typed(
    qtbot: QtBot, parts: WindowParts, action: str
) -> None:
    parts.window.actions_by_id[action].trigger()
    (form,) = shown(parts)
    qtbot.waitExposed(form)
    qtbot.keyClicks(form.findChildren(QLineEdit)[-1], "7")
    typed = [line.text() for line in form.findChildren(QLineEdit)]
    type_key(qtbot, parts, Qt.Key.Key_F12)  # the window is in front again
    parts.window.actions_by_id[action].trigger()
    assert shown(parts) == [form]
    assert [line.text() for line in form.findChildren(QLineEdit)] == typed
    qtbot.waitUntil(form.isActiveWindow, timeout=WAIT_MS)


def test_an_import_form_of_no_project_is_not_taken_for_one_of_the_project_opened_since(
    parts: WindowParts, tmp_path: Path
) -> None:
    parts.document.close()
    parts.window.actions_by_id["import"].trigger()
    assert len(shown(parts, ImportForm)) == 1
    assert parts.document.open(tmp_path / "B.zuka")
    parts.window.actions_by_id["import"].trigger()
    (form,) = shown(parts, ImportForm)
    assert str(tmp_path / "B.zuka") in [line.text() for line in form.findChildren(QLineEdit)]


def test_another_language_shows_its_own_form(qtbot: QtBot, parts: WindowParts) -> None:
    parts.window.actions_by_id["export"].trigger()
    parts.window.actions_by_id["language-ja"].trigger()
    qtbot.waitUntil(lambda: parts.language == "ja", timeout=WAIT_MS)
    parts.window.actions_by_id["export"].trigger()
    assert len(shown(parts, ExportForm)) == 1


def during_the_file_dialog(qtbot: QtBot, parts: WindowParts, act: Callable[[], object]) -> None:
    """Wait for the dialog that holds everything up until it is answered, and act then."""
    timer = QTimer(parts.window, interval=20)

    def look() -> None:
        if isinstance(QApplication.activeModalWidget(), QFileDialog):
            timer.stop()
            act()

    timer.timeout.connect(look)
    timer.start()


@pytest.mark.parametrize("action", FILE_DIALOGS)
def test_a_file_dialog_of_a_project_gives_no_answer_after_it(
    qtbot: QtBot, parts: WindowParts, action: str, tmp_path: Path
) -> None:
    opened: list[bool] = []
    during_the_file_dialog(
        qtbot, parts, lambda: opened.append(parts.document.open(tmp_path / "B.zuka"))
    )
    before = set(tmp_path.rglob("*.toml"))
    parts.window.actions_by_id[action].trigger()
    assert opened == [True]
    assert shown(parts) == []
    assert set(tmp_path.rglob("*.toml")) == before


def test_the_file_dialog_of_a_form_goes_before_the_form(qtbot: QtBot, parts: WindowParts) -> None:
    parts.window.actions_by_id["export"].trigger()
    (form,) = shown(parts, ExportForm)
    (choose,) = (one for one in form.findChildren(QPushButton) if one.text() == "Choose…")
    during_the_file_dialog(qtbot, parts, parts.document.close)
    qtbot.mouseClick(choose, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not parts.window.findChildren(QDialog), timeout=WAIT_MS)


def test_a_question_about_a_project_is_answered_with_no_when_it_closes(
    qtbot: QtBot, parts: WindowParts
) -> None:
    removed: list[str] = []
    parts.of(TruthEvaluations).remove_truth = removed.append
    parts.class_panel.truths.removal_requested.emit("one")
    (box,) = shown(parts, QMessageBox)
    assert isinstance(box, QMessageBox)
    parts.document.close()
    qtbot.waitUntil(lambda: not parts.window.findChildren(QDialog), timeout=WAIT_MS)
    assert removed == []


def test_forms_of_the_program_stay_when_a_project_closes(parts: WindowParts) -> None:
    parts.window.actions_by_id["shortcuts"].trigger()
    parts.window.actions_by_id["simulate"].trigger()
    parts.document.close()
    assert {type(form) for form in shown(parts)} == {ShortcutsForm, SimulateForm}
    for form in shown(parts):
        form.close()
