"""What an office writes on its papers, entered in the window and kept with the project."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialogButtonBox, QFileDialog, QLineEdit
from pytestqt.qtbot import QtBot

from app.window.window_parts import WindowParts
from processing.core.errors import NoSpace
from processing.core.text import Text
from processing.methods.earthwork.as_built.limits_file import as_built_limits, read_limits
from processing.project.store.project_settings import ProjectSettings
from processing.project.work_details import WorkDetails
from processing.project.work_store import WorkStore
from resources import path_of
from tests.app.conftest import shown_window
from widgets.dialogs.work_details import WorkDetailsForm
from widgets.panels.volume.limits_box import LimitsBox

WAIT_MS = 60_000


@pytest.fixture
def parts(qtbot: QtBot, tmp_path: Path) -> Iterator[WindowParts]:
    """The window with an empty project."""
    with shown_window(qtbot, tmp_path) as parts:
        assert parts.document.create(tmp_path / "造成.zuka", "EPSG:6677")
        yield parts


@pytest.fixture
def office(tmp_path: Path) -> Path:
    """The program's table with other names."""
    text = path_of("catalogue/as_built_limits.toml").read_text(encoding="utf-8")
    path = tmp_path / "事務所.toml"
    path.write_text(text.replace("Cutting", "Excavation"), encoding="utf-8")
    return path


def store_of(parts: WindowParts) -> WorkStore:
    project = parts.document.project
    assert project is not None
    return WorkStore(project.settings)


def open_form(qtbot: QtBot, parts: WindowParts) -> WorkDetailsForm:
    parts.window.actions_by_id["work-details"].trigger()
    form = parts.window.findChild(WorkDetailsForm)
    assert isinstance(form, WorkDetailsForm)
    qtbot.waitExposed(form)
    return form


def line(form: WorkDetailsForm, id_: str) -> QLineEdit:
    found = form.findChild(QLineEdit, id_)
    assert isinstance(found, QLineEdit)
    return found


def accept(qtbot: QtBot, form: WorkDetailsForm) -> None:
    buttons = form.findChild(QDialogButtonBox)
    assert isinstance(buttons, QDialogButtonBox)
    button = buttons.button(QDialogButtonBox.StandardButton.Ok)
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def wait_until_gone(qtbot: QtBot, parts: WindowParts) -> None:
    """Wait until the form is closed; a closed one is deleted."""
    qtbot.waitUntil(lambda: parts.window.findChild(WorkDetailsForm) is None, timeout=WAIT_MS)


def pick(box: LimitsBox, words: str) -> None:
    number = box.findText(words)
    assert number >= 0, words
    box.setCurrentIndex(number)
    box.activated.emit(number)


def test_details_are_typed_once_and_there_when_the_project_is_opened_again(
    qtbot: QtBot, parts: WindowParts, tmp_path: Path
) -> None:
    form = open_form(qtbot, parts)
    assert line(form, "work").placeholderText() == "造成"
    qtbot.keyClicks(line(form, "client"), "A-Prefecture")
    qtbot.keyClicks(line(form, "surveyor"), "Taro")
    accept(qtbot, form)
    wait_until_gone(qtbot, parts)
    parts.document.close()
    assert parts.document.open(tmp_path / "造成.zuka")
    assert store_of(parts).details() == WorkDetails(client="A-Prefecture", surveyor="Taro")
    again = open_form(qtbot, parts)
    assert line(again, "client").text() == "A-Prefecture"
    again.close()


def test_a_form_of_a_project_that_is_closed_goes_with_it(qtbot: QtBot, parts: WindowParts) -> None:
    form = open_form(qtbot, parts)
    assert form.isVisible()
    parts.document.close()
    wait_until_gone(qtbot, parts)
    assert not parts.window.actions_by_id["work-details"].isEnabled()


def test_what_can_not_be_stored_is_said_and_what_was_typed_stays(
    qtbot: QtBot, parts: WindowParts, monkeypatch: pytest.MonkeyPatch
) -> None:
    form = open_form(qtbot, parts)
    qtbot.keyClicks(line(form, "client"), "A")

    def full(*_: object) -> None:
        raise NoSpace(Text.same("The disk is full."), Text.same("x"), Text.same("y"))

    with monkeypatch.context() as patched:
        patched.setattr(ProjectSettings, "put", full)
        with qtbot.waitSignal(parts.document.refused):
            accept(qtbot, form)
    assert form.isVisible()
    accept(qtbot, form)
    wait_until_gone(qtbot, parts)
    assert store_of(parts).details().client == "A"


def test_damaged_details_are_said_and_can_be_entered_anew(qtbot: QtBot, parts: WindowParts) -> None:
    project = parts.document.project
    assert project is not None
    project.settings.put("work_details", {"work": 3})
    with qtbot.waitSignal(parts.document.refused):
        form = open_form(qtbot, parts)
    qtbot.keyClicks(line(form, "work"), "W")
    accept(qtbot, form)
    wait_until_gone(qtbot, parts)
    assert store_of(parts).details() == WorkDetails(work="W")


def test_an_office_s_own_table_counts_in_the_project_until_the_program_s_is_chosen(
    parts: WindowParts, office: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    box = parts.volume_panel.limits
    assert box.itemText(0) == "Road embankment (road body, subgrade)"
    pick(box, "Cutting")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(office), ""))
    pick(box, "Other table…")
    assert box.currentText() == "Excavation  [事務所.toml]"
    office.unlink()
    parts.document.close()
    assert parts.document.open(tmp_path / "造成.zuka")
    assert box.currentText() == "Excavation  [事務所.toml]"
    assert store_of(parts).limits().work_type == "cutting"
    pick(box, "Table of the program")
    assert box.currentText() == "Cutting"
    assert store_of(parts).limits().file_name == ""


def test_another_project_has_its_own_table(
    parts: WindowParts, office: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    box = parts.volume_panel.limits
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(office), ""))
    pick(box, "Other table…")
    assert parts.document.create(tmp_path / "other.zuka", "EPSG:6677")
    assert box.currentText() == "Road embankment (road body, subgrade)"


def test_the_table_is_written_for_an_office_to_start_from(
    qtbot: QtBot, parts: WindowParts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "own.toml"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(path), ""))
    with qtbot.waitSignal(parts.document.reported) as reported:
        pick(parts.volume_panel.limits, "Write this table as a file…")
    assert reported.args[0].en == "Wrote own.toml."
    assert read_limits(path) == as_built_limits()
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path), ""))
    with qtbot.waitSignal(parts.document.refused):
        pick(parts.volume_panel.limits, "Write this table as a file…")


@pytest.mark.parametrize("content", [b"\x00\xff" * 50, b"[standard]\n", b"x" * (2 << 20)])
def test_a_bad_table_is_said_in_a_sentence_and_nothing_changes(
    qtbot: QtBot,
    parts: WindowParts,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    content: bytes,
) -> None:
    box = parts.volume_panel.limits
    pick(box, "Cutting")
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    with qtbot.waitSignal(parts.document.refused) as reported:
        pick(box, "Other table…")
    assert "bad.toml" in reported.args[0].where.en
    assert box.currentText() == "Cutting"
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: ("", ""))
    pick(box, "Other table…")
    assert box.currentText() == "Cutting"


def test_limits_that_are_damaged_are_said_and_another_table_can_be_chosen(
    qtbot: QtBot, parts: WindowParts, office: Path, tmp_path: Path, monkeypatch
) -> None:
    project = parts.document.project
    assert project is not None
    project.settings.put("as_built_limits", {"file_name": "a.toml", "content": "x"})
    parts.document.close()
    with qtbot.waitSignal(parts.document.refused):
        assert parts.document.open(tmp_path / "造成.zuka")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(office), ""))
    pick(parts.volume_panel.limits, "Other table…")
    assert store_of(parts).limits().file_name == "事務所.toml"
