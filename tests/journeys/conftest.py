"""A real window on a real project, used by mouse and keys."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from app.application import build_window, make_application
from app.settings.settings import Settings
from app.window.window_parts import WindowParts
from processing.image.images_of_drives import image_of
from processing.map.feature import PointReference
from processing.project.importing.dropped_files import request_of_files
from processing.recording.drive import Drive
from resources import path_of
from widgets.shared.cursor import PickedPosition

WAIT_MS = 60_000


@dataclass
class Surveyor:
    """Somebody in front of the window."""

    bot: QtBot
    parts: WindowParts
    sample: Path
    """The imported street to copy."""

    @property
    def document(self):
        return self.parts.document

    @property
    def drive(self) -> Drive:
        return self.document.drive(self.document.shared.view_settings.drive_id)

    def position_of(self, point: int) -> PickedPosition:
        x, y, z = self.drive.xyz(np.array([point]))[0]
        reference = PointReference(self.drive.id, point)
        return PickedPosition((float(x), float(y), float(z)), reference)

    def shown_point(self, row: int, column: int) -> int:
        """The point in or near a pixel of the image that is shown."""
        image = image_of(self.drive, self.document.shared.view_settings.image_kind)
        point = image.nearest_filled(row, column, 40)
        assert point >= 0
        return point

    def pixel_of(self, point: int) -> QPoint:
        """Where a point is painted; the view goes there first."""
        view, position = self.parts.image_view, self.position_of(point)
        view.show_one_to_one()
        view.zoom_by(4.0)
        view.center_on(position)
        return view.position_of(position).toPoint()

    def click(self, point: int) -> None:
        """Left click on a point's pixel."""
        position = self.pixel_of(point)
        self.bot.mouseMove(self.parts.image_view, position)
        self.bot.mouseClick(self.parts.image_view, Qt.MouseButton.LeftButton, pos=position)

    def key(self, key: Qt.Key, modifier=Qt.KeyboardModifier.NoModifier) -> None:
        self.bot.keyClick(self.parts.image_view, key, modifier)

    def wait_for_job(self, start) -> None:
        started = []

        def is_it(job, *_):
            return job in started

        with self.bot.waitSignal(self.parts.jobs.finished, timeout=WAIT_MS, check_params_cb=is_it):
            started.append(start())

    def open_sample_street(self, project: Path) -> None:
        """Open a copy of the street; only what is about importing needs to import it."""
        shutil.copytree(self.sample, project)
        assert self.document.open(project)

    def import_sample_street(self, project: Path) -> None:
        assert self.document.create(project, "")
        request = request_of_files((path_of("sample_street"),), "")
        self.wait_for_job(lambda: self.document.import_files(request))


@pytest.fixture
def surveyor(qtbot, tmp_path, sample_project) -> Iterator[Surveyor]:
    make_application()
    parts = build_window(Settings(tmp_path / "settings.ini"), tmp_path / "projects")
    parts.window.resize(1400, 900)
    parts.window.show()
    qtbot.waitExposed(parts.window)
    yield Surveyor(qtbot, parts, sample_project)
    parts.window.close_at_once()
    parts.window.deleteLater()
