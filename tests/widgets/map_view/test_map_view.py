"""The street from above: exact points, paths and what hides them."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QPolygonF
from PySide6.QtWidgets import QPushButton
from pytestqt.qtbot import QtBot

from processing.image.attributes.tile_cache import TileCache
from processing.map.catalogue import Geometry
from processing.recording.drive import Drive
from tests.widgets.builders import OpenMap, position_on
from tests.widgets.map_view.conftest import MapViewUser
from widgets.map_view.view import LIMIT_M, MapView
from widgets.mouse_tools.editing.edit_vertices import EditVertices
from widgets.plane_view.still_picture import BACKGROUND
from widgets.shared.cursor import PickedPosition

NEAR = 150.0


def test_a_click_on_a_points_pixel_gives_that_points_coordinate(user: MapViewUser) -> None:
    for point in user.road_points(3):
        position = position_on(user.drive, point)
        user.look_at(position, NEAR)
        user.click(user.spot(position))
        found = user.map.shared.cursor.position
        assert found is not None
        assert found.measured is not None
        # At this scale a pixel is 7 mm: of two points that are nearer to each other, either one.
        assert np.hypot(*np.subtract(found.xyz, position.xyz)[:2]) <= 0.012
        assert found == position_on(user.drive, found.measured.point)


def test_a_vertex_is_dragged_to_the_same_coordinate_as_in_the_image(user: MapViewUser) -> None:
    start, middle, end = user.road_points(3)
    line = user.map.add(Geometry.LINE, user.drive, start, middle)
    user.look_at(position_on(user.drive, middle), 60.0)
    user.take(EditVertices(user.map, user.map.shared))
    target = position_on(user.drive, end)
    user.drag(user.spot(position_on(user.drive, middle)), user.spot(target))
    _, moved = user.map.stored[line.id].vertices
    assert moved.measured is not None
    assert np.hypot(*np.subtract(moved.xyz, target.xyz)[:2]) <= 0.03
    assert moved.xyz == position_on(user.drive, moved.measured.point).xyz
    assert not moved.is_occluded


def test_a_click_beside_the_street_does_no_harm(user: MapViewUser) -> None:
    user.click(QPoint(2, 2))
    user.move(QPoint(3, 3))
    assert user.map.shared.cursor.position is None
    assert user.map.shared.cursor.hover is None


def test_what_is_drawn_under_the_mouse_is_told(user: MapViewUser) -> None:
    (point,) = user.road_points(1)
    position = position_on(user.drive, point)
    user.look_at(position, NEAR)
    user.move(user.spot(position))
    hover = user.map.shared.cursor.hover
    assert hover is not None
    assert np.hypot(*np.subtract(hover.xyz, position.xyz)[:2]) <= 0.05


def _wall_top(drive: Drive) -> PickedPosition:
    """The top of a wall, five metres above the road."""
    return position_on(drive, int(drive.xyz(slice(None))[:, 2].argmax()))


def test_what_is_high_above_the_road_is_hidden_until_it_is_wanted(user: MapViewUser) -> None:
    top = _wall_top(user.drive)
    user.look_at(top, NEAR)
    user.click(user.spot(top))
    below = user.map.shared.cursor.position
    assert below is None or below.xyz[2] <= top.xyz[2] - 1.0
    reported: list[object] = []
    user.view.limit_changed.connect(reported.append)
    with user.qtbot.waitSignal(user.view.sharpened, timeout=30_000):
        user.view.set_limit(None)
    user.view.set_limit(None)
    assert reported == [None]
    user.click(user.spot(top))
    shown = user.map.shared.cursor.position
    assert shown is not None
    assert shown.xyz[2] > top.xyz[2] - 0.11


def test_the_limit_is_chosen_in_the_menu(user: MapViewUser) -> None:
    menu = user.view.view_menu()
    (limits,) = [one.menu() for one in menu.actions() if one.menu() is not None]
    checked = [one for one in limits.actions() if one.isChecked()]
    assert [one.data() for one in checked] == [LIMIT_M]
    with user.qtbot.waitSignal(user.view.limit_changed, timeout=30_000):
        limits.actions()[0].trigger()
    assert user.view.limit_m is None
    menu.deleteLater()


def test_the_picture_is_never_blank_while_the_wheel_turns(user: MapViewUser) -> None:
    (point,) = user.road_points(1)
    spot = user.spot(position_on(user.drive, point))
    around = QRect(spot - QPoint(60, 60), QSize(120, 120))
    for _ in range(5):
        user.wheel(spot, 2)
        image = user.view.grab(around).toImage()
        pixels = [image.pixelColor(x, y) for x in range(0, 120, 2) for y in range(0, 120, 2)]
        assert sum(pixel != BACKGROUND for pixel in pixels) > 0.02 * len(pixels)


def test_a_request_that_is_overtaken_still_ends_in_a_sharp_picture(user: MapViewUser) -> None:
    with user.qtbot.waitSignal(user.view.sharpened, timeout=30_000):
        for _ in range(12):
            user.view.set_viewport(user.view.viewport.panned(5.0, 3.0))


def test_another_colour_is_shown(user: MapViewUser) -> None:
    before = user.view.grab().toImage()
    with user.qtbot.waitSignal(user.view.sharpened, timeout=30_000):
        user.map.shared.view_settings.change_look(attribute="height")
    assert user.view.grab().toImage() != before


def test_a_colour_that_a_drive_does_not_have_leaves_the_view_alive(user: MapViewUser) -> None:
    with user.qtbot.waitSignal(user.view.sharpened, timeout=30_000):
        user.map.shared.view_settings.change_look(attribute="segment")
    with user.qtbot.waitSignal(user.view.sharpened, timeout=30_000):
        user.map.shared.view_settings.change_look(attribute="intensity")


def test_results_of_a_tool_are_shown_when_they_come(user: MapViewUser) -> None:
    with user.qtbot.waitSignal(user.view.sharpened, timeout=30_000):
        user.map.shared.map_changes.drive_columns_changed.emit(user.drive.id)


def test_the_wheel_with_shift_follows_the_path(user: MapViewUser) -> None:
    user.view.zoom_by(4.0)
    before = np.array(user.view.viewport.centre)
    user.wheel(QPoint(450, 350), -1, Qt.KeyboardModifier.ShiftModifier)
    moved = np.array(user.view.viewport.centre) - before
    # The street leads north, and the view goes on in the direction of travel.
    assert moved[1] < -0.1
    assert abs(moved[0]) < 0.2 * abs(moved[1])


def test_a_lasso_holds_the_points_that_are_drawn_in_it(user: MapViewUser) -> None:
    (point,) = user.road_points(1)
    position = position_on(user.drive, point)
    user.look_at(position, NEAR)
    spot = user.spot(position)
    box = QPolygonF(QRectF(spot.x() - 40, spot.y() - 40, 80, 80))
    inside = user.view.points_inside(box)
    points = inside[user.drive.id]
    assert (np.diff(points) > 0).all()
    away = np.abs(user.drive.xyz(points)[:, :2] - np.array(position.xyz[:2])).max()
    assert away <= 40 / NEAR + 0.04


def test_fields_of_view_are_marked(user: MapViewUser) -> None:
    before = user.view.grab().toImage()
    low, high = np.array(user.drive.info.lowest[:2]), np.array(user.drive.info.highest[:2])
    triangle = np.array([low, high, [low[0], high[1]]])
    user.view.show_fields_of_view([triangle, triangle + 2.0], 0)
    after = user.view.grab().toImage()
    assert after != before
    user.view.show_fields_of_view([], -1)
    assert user.view.grab().toImage() == before


def test_an_empty_map_offers_what_brings_a_recording(qtbot: QtBot) -> None:
    empty = OpenMap()
    tiles = TileCache()
    tiles.use(empty.drive)
    view = MapView(empty, empty.shared, tiles)
    qtbot.addWidget(view)
    view.show()
    buttons = view.findChildren(QPushButton)
    assert len(buttons) == 2
    with qtbot.waitSignals([view.import_requested, view.open_requested]):
        for button in buttons:
            button.click()
    assert view.extent() is None
    view.close()
    tiles.close()


def test_a_closed_project_leaves_nothing_and_another_one_is_shown_whole(
    user: MapViewUser, right_drive: Drive
) -> None:
    user.view.zoom_by(20.0)
    user.map.all_drives = ()
    user.map.shared.map_changes.drives_changed.emit()
    assert user.view.projection() is None
    user.click(QPoint(450, 350))
    user.map.all_drives = (right_drive,)
    with user.qtbot.waitSignal(user.view.sharpened, timeout=30_000):
        user.map.shared.map_changes.drives_changed.emit()
    corners = (PickedPosition(right_drive.info.lowest), PickedPosition(right_drive.info.highest))
    assert all(user.view.rect().contains(user.spot(corner)) for corner in corners)


def test_a_drive_without_trajectory_is_shown_without_a_limit(
    qtbot: QtBot, left_drive: Drive, tmp_path: Path
) -> None:
    folder = tmp_path / "copy"
    shutil.copytree(left_drive.folder, folder)
    (folder / "trajectory.npy").unlink()
    drive = Drive(folder)
    alone = OpenMap((drive,))
    tiles = TileCache()
    tiles.use(alone.drive)
    view = MapView(alone, alone.shared, tiles)
    qtbot.addWidget(view)
    view.resize(600, 500)
    with qtbot.waitSignal(view.sharpened, timeout=30_000):
        view.show()
    top = _wall_top(drive)
    spot = view.position_of(top)
    assert spot is not None
    position = view.position_at(view.viewport.to_plane(spot.x(), spot.y()), 0.5, exact=True)
    assert position is not None
    assert position.xyz[2] > top.xyz[2] - 0.11
    view.move_along(1.0)
    view.close()
    tiles.close()


@pytest.mark.parametrize("times", [1, 2])
def test_a_closed_view_stops_its_worker(user: MapViewUser, times: int) -> None:
    for _ in range(times):
        user.view.close()
    user.view.set_viewport(user.view.viewport.panned(5.0, 5.0))
    user.view.set_limit(5.0)
