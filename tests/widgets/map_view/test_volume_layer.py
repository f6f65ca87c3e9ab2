"""The map of change from above: colours, a reading under the mouse, contours, a legend."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint
from PySide6.QtGui import QColor

from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.contours import LevelLine
from processing.methods.earthwork.maps.heat_map import change_classes
from processing.methods.ground.filters.cells import CellGrid
from tests.widgets.map_view.conftest import MapViewUser
from widgets.shared.cursor import PickedPosition
from widgets.shared.shown_volume import VolumeStyle

SIZE_M = 0.05
OPAQUE = VolumeStyle(limit_m=1.0, opacity=1.0)
ROWS, COLUMNS = 60, 80


def _change(user: MapViewUser) -> ChangeGrid:
    """Beside the middle of the street: 0.3 m cut in the west, 0.7 m fill in the east."""
    low, high = (np.array(ends) for ends in (user.drive.info.lowest, user.drive.info.highest))
    corner = np.array([*((low + high) / 2)[:2], low[2]])
    after = np.full((ROWS, COLUMNS), -0.3, np.float32)
    after[:, COLUMNS // 2 :] = 0.7
    shape = (ROWS, COLUMNS)
    return ChangeGrid(
        CellGrid(corner, SIZE_M, ROWS, COLUMNS),
        np.zeros(shape, np.float32),
        after,
        np.ones(shape, np.bool_),
        np.ones(shape, np.float32),
    )


def _middle(change: ChangeGrid, row: int, column: int) -> PickedPosition:
    west, south, base = change.grid.origin.tolist()
    return PickedPosition((west + (column + 0.5) * SIZE_M, south + (row + 0.5) * SIZE_M, base))


@pytest.fixture
def change(user: MapViewUser) -> ChangeGrid:
    """Give a map of change that is shown, opaque, its middle in the window's."""
    change = _change(user)
    volume = user.map.shared.volume
    volume.use_look(OPAQUE)
    volume.show(change)
    user.look_at(_middle(change, ROWS // 2, COLUMNS // 2), 100.0)
    return change


def _colour(user: MapViewUser, spot: QPoint) -> QColor:
    return user.view.grab().toImage().pixelColor(spot)


def _expected(change_m: float, limit_m: float = 1.0) -> QColor:
    classes = change_classes(limit_m)
    return QColor(*next(one.rgb for one in classes if one.low <= change_m < one.high))


def test_cut_and_fill_have_the_colours_of_the_legend(user: MapViewUser, change: ChangeGrid) -> None:
    west, east = (user.spot(_middle(change, 20, column)) for column in (10, 60))
    assert _colour(user, west) == _expected(-0.3)
    assert _colour(user, east) == _expected(0.7)


def test_north_is_up(user: MapViewUser, change: ChangeGrid) -> None:
    change.after[ROWS // 2 :] = 0.0
    user.map.shared.volume.show(None)
    turned = replace(change)  # the change of the first one is counted already
    user.map.shared.volume.show(turned)
    south, north = (user.spot(_middle(turned, row, 10)) for row in (20, 40))
    assert north.y() < south.y()
    assert _colour(user, north) == _expected(0.0)
    assert _colour(user, south) == _expected(-0.3)


def test_another_range_changes_colours_at_once(user: MapViewUser, change: ChangeGrid) -> None:
    spot = user.spot(_middle(change, 20, 10))
    before = _colour(user, spot)
    user.map.shared.volume.use_look(replace(OPAQUE, limit_m=0.2))
    assert _colour(user, spot) == _expected(-0.3, 0.2) != before


def test_it_can_be_hidden_and_shown_again(user: MapViewUser, change: ChangeGrid) -> None:
    spot = user.spot(_middle(change, 20, 10))
    user.map.shared.volume.use_look(replace(OPAQUE, is_shown=False))
    assert _colour(user, spot) != _expected(-0.3)
    user.move(spot)
    assert user.map.shared.volume.reading is None
    user.map.shared.volume.use_look(OPAQUE)
    assert _colour(user, spot) == _expected(-0.3)


def test_what_was_filled_in_is_hatched(user: MapViewUser, change: ChangeGrid) -> None:
    change.is_measured[:30] = False
    user.map.shared.volume.show(None)
    user.map.shared.volume.show(replace(change))
    picture = user.view.grab().toImage()

    def colours(row: int) -> set[str]:
        spot = user.spot(_middle(change, row, 10))
        return {
            picture.pixelColor(spot + QPoint(x, y)).name()
            for x in range(-8, 9)
            for y in range(-8, 9)
        }

    assert colours(50) == {_expected(-0.3).name()}
    assert _expected(-0.3).name() in colours(10)
    assert len(colours(10)) > 1


def test_the_mouse_reads_the_map_where_no_point_is_too(
    user: MapViewUser, change: ChangeGrid
) -> None:
    volume = user.map.shared.volume
    for column, change_m in ((10, -0.3), (60, 0.7)):
        user.move(user.spot(_middle(change, 20, column)))
        reading = volume.reading
        assert reading is not None
        assert reading.change_m == pytest.approx(change_m, abs=1e-5)
        assert reading.before_m == pytest.approx(change.grid.origin[2])
    user.move(user.spot(_middle(change, 20, -6)))
    assert volume.reading is None


def test_contours_are_painted_over_the_colours(user: MapViewUser, change: ChangeGrid) -> None:
    positions = np.array([_middle(change, row, 20).xyz for row in (5, 50)])
    at = user.spot(_middle(change, 27, 20))
    plain = _colour(user, at)
    lines = (LevelLine(0.5, is_index=True, xyz=positions),)
    user.map.shared.volume.take_contours(change, lines)
    picture = user.view.grab().toImage()
    assert any(picture.pixelColor(at + QPoint(x, 0)) != plain for x in range(-2, 3))
    user.map.shared.volume.take_contours(replace(change), ())
    assert user.map.shared.volume.contours == lines, "what was asked for another map came too late"


def test_a_map_of_many_cells_is_painted_in_parts(user: MapViewUser, change: ChangeGrid) -> None:
    """Twelve million cells: as many are coloured as the window can show."""
    rows, columns = 3000, 4000
    grid = CellGrid(change.grid.origin, 0.01, rows, columns)
    ground = np.zeros((rows, columns), np.float32)
    after = np.where(np.arange(columns) % 400 < 200, 0.7, -0.3).astype(np.float32)
    large = ChangeGrid(
        grid,
        ground,
        np.broadcast_to(after, ground.shape),
        np.ones(ground.shape, np.bool_),
        np.ones(ground.shape, np.float32),
    )
    user.map.shared.volume.show(large)
    for px_per_m in (200.0, 30.0):
        for metres, expected in ((1.0, 0.7), (3.0, -0.3)):
            position = PickedPosition((grid.origin[0] + metres, grid.origin[1] + 15.0, 0.0))
            user.look_at(position, px_per_m)
            assert _colour(user, user.spot(position)) == _expected(expected)
