"""The ground that the tool “ground” found is drawn in the section, until it is turned off."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QImage
from pytestqt.qtbot import QtBot

from processing.labels.label_column import make_column, write_labels
from processing.methods.ground.filters.cells import CellGrid
from processing.methods.ground.stored_surface import (
    FILE_NAME,
    SurfaceTile,
    SurfaceWriter,
    copy_surface,
)
from processing.project.results.run_findings import finding_path
from processing.recording.columns.counted_classes import class_columns
from tests.widgets.builders import OpenMap, imported_drive
from tests.widgets.section_view.conftest import SectionViewUser, shown

GROUND = 2
YELLOW = np.array([0xF0, 0xE4, 0x42])


def ground_in(user: SectionViewUser, folder: Path, height_m: float) -> None:
    """Let the drive keep a flat ground, filled in east of the middle."""
    (drive,) = user.map.drives()
    low, high = np.array(drive.info.lowest), np.array(drive.info.highest)
    low, high = np.floor(low) - 30.0, np.ceil(high) + 30.0
    columns, rows = (high - low)[:2].astype(int).tolist()
    grid = CellGrid(np.array([low[0], low[1], height_m]), 1.0, rows, columns)
    filled = np.zeros((rows, columns), np.bool_)
    cut = user.view.cut
    assert cut is not None
    filled[:, int(cut.middle[0] - low[0]) :] = True
    with SurfaceWriter(folder / "ground", grid, "") as writer:
        writer.add(SurfaceTile(0, 0, np.zeros((rows, columns), np.float32), filled))
    kept = drive.folder / FILE_NAME
    kept.unlink(missing_ok=True)
    copy_surface(folder / "ground", kept)
    user.do(lambda: user.map.shared.map_changes.drive_columns_changed.emit(drive.id))


def yellow(user: SectionViewUser) -> NDArray[np.int64]:
    """Columns of the window's pixels, below the legend, that are the line's."""
    image = user.pane.grab().toImage().convertToFormat(QImage.Format.Format_RGBA8888)
    pixels = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1, 4)
    is_line = np.abs(pixels[80:, :, :3] - YELLOW).max(axis=2) < 24
    return np.flatnonzero(is_line.any(axis=0))


def test_ground_is_solid_where_measured_dashed_where_filled_and_can_be_hidden(
    qtbot: QtBot, tmp_path: Path
) -> None:
    user = shown(qtbot, OpenMap((imported_drive(tmp_path / "street"),)))
    picture, projection = user.pane.picture, user.pane.projection()
    assert picture is not None
    assert projection is not None
    assert picture.ground == ()
    assert not yellow(user).size
    viewport = user.pane.viewport
    ground_in(
        user, tmp_path, projection.height_of(viewport.to_plane(0.0, viewport.height * 0.6)[1])
    )
    picture = user.pane.picture
    assert picture is not None
    assert {line.is_filled for line in picture.ground} == {False, True}
    columns = yellow(user)
    assert columns.size
    # Without a gap on one side, with gaps on the other.
    middle = user.pane.viewport.to_screen(np.zeros((1, 2)))[0, 0]
    sides = [columns[columns < middle - 80], columns[columns > middle + 80]]
    gaps = sorted(int((np.diff(side) > 2).sum()) for side in sides)
    assert gaps[0] == 0
    assert gaps[1] > 5
    user.do(lambda: user.view.use_settings(replace(user.view.settings, shows_ground=False)))
    assert not yellow(user).size
    user.view.close()


def test_a_damaged_surface_is_just_not_there(qtbot: QtBot, tmp_path: Path) -> None:
    user = shown(qtbot, OpenMap((imported_drive(tmp_path / "street"),)))
    (drive,) = user.map.drives()
    (drive.folder / FILE_NAME).write_bytes(b"ZUKAGND1" + bytes(20))
    user.do(lambda: user.map.shared.map_changes.drive_columns_changed.emit(drive.id))
    picture = user.pane.picture
    assert picture is not None
    assert picture.points.size
    assert picture.ground == ()
    user.view.close()


def test_the_line_follows_what_is_made_ground_since_and_goes_back_with_undo(
    qtbot: QtBot, tmp_path: Path
) -> None:
    user = shown(qtbot, OpenMap((imported_drive(tmp_path / "street"),)))
    (drive,) = user.map.drives()
    delivered = class_columns(drive.columns).codes_of(np.arange(drive.count))
    said = finding_path(drive, "ground", "run")
    said.parent.mkdir(parents=True)
    said.write_bytes(np.packbits(delivered == GROUND).tobytes())
    ground_in(user, tmp_path, -1000.0)
    picture = user.pane.picture
    assert picture is not None
    found = picture.ground
    near = picture.points[np.abs(picture.section[:, 0]) < 1.0]
    heights = picture.section[np.abs(picture.section[:, 0]) < 1.0, 1]
    assert near.size > 10
    make_column(drive)
    for code, is_ground in ((GROUND, True), (0, False)):
        write_labels(drive, np.sort(near), np.full(near.size, code, np.uint8))
        user.do(lambda: user.map.shared.map_changes.labels_changed.emit(drive.id, near))
        picture = user.pane.picture
        assert picture is not None
        middle = [line.positions[np.abs(line.positions[:, 0]) < 0.5, 1] for line in picture.ground]
        inside = np.concatenate(middle)
        assert inside.size
        if is_ground:
            assert heights.min() - 0.01 <= inside.min() <= inside.max() <= heights.max() + 0.01
        else:
            assert len(picture.ground) == len(found)
            for line, before in zip(picture.ground, found, strict=True):
                np.testing.assert_array_equal(line.positions, before.positions)
    user.view.close()
