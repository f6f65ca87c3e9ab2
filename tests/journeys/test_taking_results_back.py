"""Ctrl+Z takes back what a tool, a comparison or an import gave; the views show what is left."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QImage

from processing.tools.running.runner import tool_of
from resources import path_of
from tests.journeys.conftest import WAIT_MS, Surveyor
from tests.journeys.earthwork_user import Builder, two_epochs

CTRL = Qt.KeyboardModifier.ControlModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier


def _undo(surveyor: Surveyor) -> None:
    surveyor.key(Qt.Key.Key_Z, CTRL)


def _redo(surveyor: Surveyor) -> None:
    surveyor.key(Qt.Key.Key_Z, CTRL | SHIFT)


def _use(surveyor: Surveyor) -> None:
    """Keys reach the menus of the active window only."""
    window = surveyor.parts.window
    with surveyor.bot.waitActive(window):
        window.activateWindow()
    surveyor.parts.image_view.setFocus()


def _undo_text(surveyor: Surveyor) -> str:
    return str(surveyor.parts.window.actions_by_id["undo"].text())


def _picture(surveyor: Surveyor, act: Callable[[], object]) -> QImage:
    """The image once it is sharp after something was done."""
    view = surveyor.parts.image_view
    with surveyor.bot.waitSignal(view.sharpened, timeout=WAIT_MS):
        act()
    picture: QImage = view.grab().toImage()
    return picture


def test_columns_that_are_shown_go_and_come_back_with_undo_and_redo(
    surveyor: Surveyor, tmp_path: Path
) -> None:
    surveyor.open_sample_street(tmp_path / "street.zuka")
    document, drive = surveyor.document, surveyor.drive
    _use(surveyor)
    with drive.columns.replacing("segment"):
        (drive.folder / "segment.bin").unlink()
    settings = document.shared.view_settings
    without = _picture(surveyor, lambda: settings.change_look(attribute="segment"))

    def run(**parameters: float) -> None:
        made = tool_of("segments").parameters(**parameters)
        surveyor.wait_for_job(lambda: document.start_run("segments", drive.id, made))

    first = _picture(surveyor, run)
    columns = [drive.columns["segment"].tobytes()]
    second = _picture(surveyor, lambda: run(distance_m=0.01, spacing_ratio=1.0, farthest_m=0.01))
    columns.append(drive.columns["segment"].tobytes())
    assert columns[0] != columns[1]
    assert without != first
    assert "left: segment" in _undo_text(surveyor)
    assert _picture(surveyor, lambda: _undo(surveyor)) == first
    assert drive.columns["segment"].tobytes() == columns[0]
    assert _picture(surveyor, lambda: _undo(surveyor)) == without
    assert not drive.columns.has("segment")
    assert _picture(surveyor, lambda: _redo(surveyor)) == first
    assert _picture(surveyor, lambda: _redo(surveyor)) == second
    assert drive.columns["segment"].tobytes() == columns[1]


def test_an_import_in_the_view_is_taken_back_and_comes_again(
    surveyor: Surveyor, tmp_path: Path
) -> None:
    document, parts = surveyor.document, surveyor.parts
    for name in ("left.laz", "right.laz", "trajectory.csv"):
        shutil.copy(path_of(f"sample_street/{name}"), tmp_path)
    assert document.create(tmp_path / "street.zuka", "")
    for name in ("left.laz", "right.laz"):
        with surveyor.bot.waitSignal(document.drive_results.taken, timeout=WAIT_MS):
            parts.window.files_dropped.emit((tmp_path / name, tmp_path / "trajectory.csv"))
    _use(surveyor)
    left, right = document.drives()
    settings = document.shared.view_settings
    settings.show_image(right.id, right.image_kinds[0])
    document.shared.cursor.move_to(surveyor.position_of(1000))
    assert _undo_text(surveyor).endswith("Import right")
    _undo(surveyor)
    assert document.drives() == (left,)
    assert settings.drive_id == left.id
    assert document.shared.cursor.position is None
    assert parts.image_view.picture.drive is left
    _redo(surveyor)
    assert [drive.id for drive in document.drives()] == [left.id, right.id]
    _undo(surveyor)
    _undo(surveyor)
    assert document.drives() == ()
    assert settings.drive_id == ""
    _redo(surveyor)
    assert settings.drive_id == left.id


def test_a_volume_in_the_views_is_taken_back_and_comes_again(
    surveyor: Surveyor, tmp_path: Path
) -> None:
    builder = Builder(surveyor)
    builder.open(tmp_path / "現場.zuka", two_epochs(tmp_path))
    builder.find_ground()
    builder.compute()
    (kept,) = builder.earthwork.volumes
    _use(surveyor)
    assert "Volume: 施工前" in _undo_text(surveyor)
    _undo(surveyor)
    assert builder.earthwork.volumes == ()
    assert builder.earthwork.shown is None
    assert builder.volume.change is None
    with surveyor.bot.waitSignal(builder.volume.changed, timeout=WAIT_MS):
        _redo(surveyor)
        surveyor.bot.waitUntil(lambda: builder.volume.change is not None, timeout=WAIT_MS)
    assert builder.earthwork.shown == kept
    builder.earthwork.remove(kept.id)
    assert builder.earthwork.volumes == ()
    _undo(surveyor)
    surveyor.bot.waitUntil(lambda: builder.volume.change is not None, timeout=WAIT_MS)
    assert builder.earthwork.shown == kept
