"""What several tests of the document begin with."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.application import build_window, make_application
from app.document.document import Document
from app.jobs.jobs import JobQueue
from app.settings.settings import Settings
from app.window.window_parts import WindowParts
from processing.project.importing.importing import ImportRequest

WAIT_MS = 30_000


@pytest.fixture
def jobs(qapp: QApplication) -> JobQueue:
    """What works for the document; closed with it."""
    return JobQueue()


@pytest.fixture
def street(
    jobs: JobQueue, delivery: ImportRequest, tmp_path: Path, qtbot: QtBot
) -> Iterator[Document]:
    """A document with what the module's ``delivery`` gives, imported."""
    document = Document(jobs)
    with qtbot.waitSignal(document.shared.map_changes.drives_changed, timeout=WAIT_MS):
        document.create(tmp_path / "p.zuka", "EPSG:6677")
    with qtbot.waitSignal(document.shared.map_changes.drives_changed, timeout=WAIT_MS):
        document.import_files(delivery)
    yield document
    jobs.close()
    document.close()
    document.tiles.close()


@contextmanager
def shown_window(qtbot: QtBot, folder: Path) -> Iterator[WindowParts]:
    """The program's window as at its first start, with settings and projects of its own."""
    make_application()
    parts = build_window(Settings(folder / "settings.ini"), folder / "projects")
    parts.window.resize(1366, 768)
    parts.window.show()
    qtbot.waitExposed(parts.window)
    yield parts
    parts.window.close_at_once()
    parts.window.deleteLater()


@pytest.fixture
def parts(qtbot: QtBot, tmp_path: Path) -> Iterator[WindowParts]:
    """The program's window."""
    with shown_window(qtbot, tmp_path) as parts:
        yield parts
