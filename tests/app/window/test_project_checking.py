"""File ▸ Check project: damage is shown, repaired while the project is closed, and gone after."""

from __future__ import annotations

import shutil
from pathlib import Path

from PySide6.QtWidgets import QDialogButtonBox, QPushButton

from app.importing.project_checking import ProjectChecking
from tests.processing.project.labelled import labelled_project
from widgets.dialogs.project_check import ProjectCheckForm


def _form(window) -> ProjectCheckForm | None:
    return next((one for one in window.findChildren(ProjectCheckForm) if one.isVisible()), None)


def test_a_damaged_column_is_shown_and_repaired(qtbot, parts, tmp_path: Path) -> None:
    whole = labelled_project(tmp_path)
    project = Path(shutil.copytree(whole, tmp_path / "p.zuka"))
    (column,) = project.glob("drives/*/classification.bin")
    before = column.read_bytes()
    column.write_bytes(b"\x07" * len(before))
    window, document = parts.window, parts.document
    assert document.open(project)
    (checking,) = document.findChildren(ProjectChecking)
    checking.choose()
    qtbot.waitUntil(lambda: _form(window) is not None, timeout=60_000)
    form = _form(window)
    assert form is not None
    (box,) = form.findChildren(QDialogButtonBox)
    (button,) = (
        one
        for one in box.findChildren(QPushButton)
        if box.buttonRole(one) == QDialogButtonBox.ButtonRole.AcceptRole
    )
    button.click()
    assert document.project is None
    qtbot.waitUntil(lambda: document.project is not None, timeout=120_000)
    assert column.read_bytes() == before
    shown = _form(window)
    assert shown is not None
    shown.close()
    document.close()
