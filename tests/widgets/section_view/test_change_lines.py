"""Both grounds of a shown volume in a section, with cut and fill between them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtGui import QColor, QImage
from pytestqt.qtbot import QtBot

from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.ground.filters.cells import CellGrid
from tests.widgets.builders import OpenMap, imported_drive
from tests.widgets.section_view.conftest import SectionViewUser, shown
from widgets.section_view.picture.change_lines import ChangePainter
from widgets.shared.shown_volume import ShownVolume

BEFORE, AFTER = QColor("#f0e442"), QColor("#ff8c5a")
SIZE_M = 0.1


@pytest.fixture
def user(qtbot: QtBot, tmp_path: Path) -> SectionViewUser:
    """Give a section across a street of ten metres."""
    return shown(qtbot, OpenMap((imported_drive(tmp_path / "street"),)))


def _change(user: SectionViewUser, cut_m: float, fill_m: float) -> ChangeGrid:
    """Half of the window's height up: level before; lower left of the middle, higher right."""
    projection, viewport, cut = user.pane.projection(), user.pane.viewport, user.view.cut
    assert projection is not None
    assert cut is not None
    height_m = projection.height_of(viewport.to_plane(0.0, viewport.height * 0.5)[1])
    corner = np.array([*(np.array(cut.middle[:2]) - 30.0), height_m])
    count = 600
    grid = CellGrid(corner, SIZE_M, count, count)
    middles = (np.arange(count) + 0.5) * SIZE_M - 30.0
    east, north = np.meshgrid(middles, middles)
    is_left = east * cut.direction[0] + north * cut.direction[1] < 0
    after = np.where(is_left, -cut_m, fill_m).astype(np.float32)
    shape = (count, count)
    ones = np.ones(shape, np.float32)
    return ChangeGrid(grid, np.zeros(shape, np.float32), after, np.ones(shape, np.bool_), ones)


def _pixels(user: SectionViewUser) -> NDArray[np.uint8]:
    image = user.pane.grab().toImage().convertToFormat(QImage.Format.Format_RGBA8888)
    flat = np.frombuffer(image.constBits(), np.uint8)
    return flat.reshape(image.height(), -1, 4)[:, :, :3].copy()


def _rows_of(pixels: NDArray[np.uint8], colour: QColor, column: int) -> NDArray[np.int64]:
    """Rows below the legend in which a column has a line's colour.

    A line of a pixel and a half may share two rows with what is behind it, a quarter of each.
    """
    wanted = np.array(colour.getRgb()[:3])
    is_line = np.abs(pixels[130:, column].astype(int) - wanted).max(axis=1) < 64
    return np.flatnonzero(is_line) + 130


def test_lines_lie_at_the_heights_of_both_grounds_and_go_with_the_map(
    user: SectionViewUser,
) -> None:
    volume = user.map.shared.volume
    user.do(lambda: user.view.use_settings(replace(user.view.settings, shows_ground=False)))
    volume.show(_change(user, cut_m=0.5, fill_m=0.8))
    pixels, viewport = _pixels(user), user.pane.viewport
    middle = float(viewport.to_screen(np.zeros((1, 2)))[0, 0])
    before_y = viewport.height * 0.5
    for side, change_m in ((-1, -0.5), (1, 0.8)):
        column = int(middle + side * 100)
        rows = _rows_of(pixels, BEFORE, column)
        assert np.abs(rows - before_y).min() <= 1.5
        rows = _rows_of(pixels, AFTER, column)
        assert np.abs(rows - (before_y - change_m * viewport.scale_y)).min() <= 1.5
    volume.use_look(replace(volume.look, is_shown=False))
    assert not _rows_of(_pixels(user), AFTER, int(middle + 100)).size
    user.view.close()


def test_cut_is_blue_and_fill_is_orange(user: SectionViewUser) -> None:
    user.do(lambda: user.view.use_settings(replace(user.view.settings, shows_ground=False)))
    plain = _pixels(user).astype(int)
    user.map.shared.volume.show(_change(user, cut_m=0.6, fill_m=0.6))
    tinted, viewport = _pixels(user).astype(int), user.pane.viewport
    middle = int(viewport.to_screen(np.zeros((1, 2)))[0, 0])
    half = int(0.3 * viewport.scale_y)
    for side, row in ((-1, 0.5 * viewport.height + half), (1, 0.5 * viewport.height - half)):
        red, _, blue = (tinted - plain)[int(row), middle + side * 100]
        assert (blue > red) if side < 0 else (red > blue)
    user.view.close()


def test_a_cut_beside_the_map_has_no_lines(user: SectionViewUser) -> None:
    cut = user.view.cut
    assert cut is not None
    volume = ShownVolume()
    painter = ChangePainter(volume)
    assert painter.line_in(cut) is None
    change = _change(user, 0.5, 0.5)
    volume.show(change)
    line = painter.line_in(cut)
    assert line is not None
    assert painter.line_in(cut) is line, "a cut is looked up once"
    east, north, height = cut.middle
    assert painter.line_in(replace(cut, middle=(east + 500.0, north, height))) is None
    user.view.close()
