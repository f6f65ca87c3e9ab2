"""An import that was interrupted is offered in the window when its project is opened."""

from __future__ import annotations

from contextlib import closing

import pytest
from PySide6.QtWidgets import QToolButton

from processing.project.importing import import_journal
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.project.importing.unfinished_imports import import_folder, unfinished_imports
from processing.project.project import Project
from tests.builders import simulated_drive, write_laz, write_trajectory_csv


class _EndsEarly:
    """A program that ends while it reads."""

    def report(self, fraction, text=None):
        if fraction > 0.1:
            raise RuntimeError

    def check(self):
        """Go on."""


@pytest.fixture
def interrupted(tmp_path, monkeypatch):
    """A project into which an import began."""
    monkeypatch.setattr(import_journal, "SECONDS", 0.0)
    simulated = simulated_drive(length_m=4.0)
    request = ImportRequest(
        (write_laz(simulated, tmp_path / "通り.laz"),),
        (write_trajectory_csv(simulated, tmp_path / "軌跡.csv"),),
    )
    with closing(Project.create(tmp_path / "a.zuka", "")) as project:
        with pytest.raises(RuntimeError):
            import_drives(request, import_folder(project.folder, request), _EndsEarly())
        return project.folder


def _button(parts, words: str) -> QToolButton:
    buttons = parts.message_bar.findChildren(QToolButton)
    return next(one for one in buttons if one.isVisible() and one.text() == words)


def test_going_on_brings_the_drive_into_the_project(qtbot, parts, interrupted):
    assert parts.document.open(interrupted)
    assert "通り.laz" in parts.message_bar.text
    with qtbot.waitSignal(parts.document.reported, timeout=30_000):
        _button(parts, "Go on").click()
    assert [drive.info.name for drive in parts.document.drives()] == ["通り"]
    assert unfinished_imports(interrupted) == ()
    assert parts.message_bar.text == ""


def test_discarding_leaves_nothing_of_it(parts, interrupted):
    assert parts.document.open(interrupted)
    _button(parts, "Discard").click()
    assert unfinished_imports(interrupted) == ()
    assert parts.message_bar.text == ""
    parts.document.close()
    assert parts.document.open(interrupted)
    assert parts.message_bar.text == ""
