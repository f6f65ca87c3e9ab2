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

from processing.image.tile_cache import TileCache
from processing.points.drive import Drive
from processing.project.catalogue import Geometry
from tests.widgets.builders import OpenMap, place_on
from tests.widgets.map_view.conftest import Hand
from widgets.map_view.view import LIMIT_M, MapView
from widgets.mouse_tools.edit_vertices import EditVertices
from widgets.plane_view.still_picture import BACKGROUND
from widgets.shared.cursor import Place

NEAR = 150.0


def test_a_click_on_a_points_pixel_gives_that_points_coordinate(hand: Hand) -> None:
    for point in hand.road_points(3):
        place = place_on(hand.drive, point)
        hand.look_at(place, NEAR)
        hand.click(hand.spot(place))
        found = hand.map.shared.cursor.place
        assert found is not None
        assert found.measured is not None
        # At this scale a pixel is 7 mm: of two points that are nearer to each other, either one.
        assert np.hypot(*np.subtract(found.xyz, place.xyz)[:2]) <= 0.012
        assert found == place_on(hand.drive, found.measured.point)


def test_a_vertex_is_dragged_to_the_same_coordinate_as_in_the_image(hand: Hand) -> None:
    start, middle, end = hand.road_points(3)
    line = hand.map.add(Geometry.LINE, hand.drive, start, middle)
    hand.look_at(place_on(hand.drive, middle), 60.0)
    hand.take(EditVertices(hand.map, hand.map.shared))
    target = place_on(hand.drive, end)
    hand.drag(hand.spot(place_on(hand.drive, middle)), hand.spot(target))
    _, moved = hand.map.stored[line.id].vertices
    assert moved.measured is not None
    assert np.hypot(*np.subtract(moved.xyz, target.xyz)[:2]) <= 0.03
    assert moved.xyz == place_on(hand.drive, moved.measured.point).xyz
    assert not moved.is_occluded


def test_a_click_beside_the_street_does_no_harm(hand: Hand) -> None:
    hand.click(QPoint(2, 2))
    hand.move(QPoint(3, 3))
    assert hand.map.shared.cursor.place is None
    assert hand.map.shared.cursor.hover is None


def test_what_is_drawn_under_the_mouse_is_told(hand: Hand) -> None:
    (point,) = hand.road_points(1)
    place = place_on(hand.drive, point)
    hand.look_at(place, NEAR)
    hand.move(hand.spot(place))
    hover = hand.map.shared.cursor.hover
    assert hover is not None
    assert np.hypot(*np.subtract(hover.xyz, place.xyz)[:2]) <= 0.05


def _wall_top(drive: Drive) -> Place:
    """The top of a wall, five metres above the road."""
    return place_on(drive, int(drive.xyz(slice(None))[:, 2].argmax()))


def test_what_is_high_above_the_road_is_hidden_until_it_is_wanted(hand: Hand) -> None:
    top = _wall_top(hand.drive)
    hand.look_at(top, NEAR)
    hand.click(hand.spot(top))
    below = hand.map.shared.cursor.place
    assert below is None or below.xyz[2] <= top.xyz[2] - 1.0
    told: list[object] = []
    hand.view.limit_changed.connect(told.append)
    with hand.qtbot.waitSignal(hand.view.sharpened, timeout=30_000):
        hand.view.set_limit(None)
    hand.view.set_limit(None)
    assert told == [None]
    hand.click(hand.spot(top))
    shown = hand.map.shared.cursor.place
    assert shown is not None
    assert shown.xyz[2] > top.xyz[2] - 0.11


def test_the_limit_is_chosen_in_the_menu(hand: Hand) -> None:
    menu = hand.view.view_menu()
    (limits,) = [one.menu() for one in menu.actions() if one.menu() is not None]
    checked = [one for one in limits.actions() if one.isChecked()]
    assert [one.data() for one in checked] == [LIMIT_M]
    with hand.qtbot.waitSignal(hand.view.limit_changed, timeout=30_000):
        limits.actions()[0].trigger()
    assert hand.view.limit_m is None
    menu.deleteLater()


def test_the_picture_is_never_blank_while_the_wheel_turns(hand: Hand) -> None:
    (point,) = hand.road_points(1)
    spot = hand.spot(place_on(hand.drive, point))
    around = QRect(spot - QPoint(60, 60), QSize(120, 120))
    for _ in range(5):
        hand.wheel(spot, 2)
        image = hand.view.grab(around).toImage()
        pixels = [image.pixelColor(x, y) for x in range(0, 120, 2) for y in range(0, 120, 2)]
        assert sum(pixel != BACKGROUND for pixel in pixels) > 0.02 * len(pixels)


def test_a_wish_that_is_overtaken_still_ends_in_a_sharp_picture(hand: Hand) -> None:
    with hand.qtbot.waitSignal(hand.view.sharpened, timeout=30_000):
        for _ in range(12):
            hand.view.set_viewport(hand.view.viewport.panned(5.0, 3.0))


def test_another_colour_is_shown(hand: Hand) -> None:
    before = hand.view.grab().toImage()
    with hand.qtbot.waitSignal(hand.view.sharpened, timeout=30_000):
        hand.map.shared.view_settings.change_look(attribute="height")
    assert hand.view.grab().toImage() != before


def test_a_colour_that_a_drive_does_not_have_leaves_the_view_alive(hand: Hand) -> None:
    with hand.qtbot.waitSignal(hand.view.sharpened, timeout=30_000):
        hand.map.shared.view_settings.change_look(attribute="segment")
    with hand.qtbot.waitSignal(hand.view.sharpened, timeout=30_000):
        hand.map.shared.view_settings.change_look(attribute="intensity")


def test_results_of_a_tool_are_shown_when_they_come(hand: Hand) -> None:
    with hand.qtbot.waitSignal(hand.view.sharpened, timeout=30_000):
        hand.map.shared.map_changes.drive_columns_changed.emit(hand.drive.id)


def test_the_wheel_with_shift_follows_the_path(hand: Hand) -> None:
    hand.view.zoom_by(4.0)
    before = np.array(hand.view.viewport.centre)
    hand.wheel(QPoint(450, 350), -1, Qt.KeyboardModifier.ShiftModifier)
    moved = np.array(hand.view.viewport.centre) - before
    # The street leads north, and the view goes on in the direction of travel.
    assert moved[1] < -0.1
    assert abs(moved[0]) < 0.2 * abs(moved[1])


def test_a_lasso_holds_the_points_that_are_drawn_in_it(hand: Hand) -> None:
    (point,) = hand.road_points(1)
    place = place_on(hand.drive, point)
    hand.look_at(place, NEAR)
    spot = hand.spot(place)
    box = QPolygonF(QRectF(spot.x() - 40, spot.y() - 40, 80, 80))
    inside = hand.view.points_inside(box)
    points = inside[hand.drive.id]
    assert (np.diff(points) > 0).all()
    away = np.abs(hand.drive.xyz(points)[:, :2] - np.array(place.xyz[:2])).max()
    assert away <= 40 / NEAR + 0.04


def test_fields_of_view_are_marked(hand: Hand) -> None:
    before = hand.view.grab().toImage()
    low, high = np.array(hand.drive.info.lowest[:2]), np.array(hand.drive.info.highest[:2])
    triangle = np.array([low, high, [low[0], high[1]]])
    hand.view.show_fields_of_view([triangle, triangle + 2.0], 0)
    after = hand.view.grab().toImage()
    assert after != before
    hand.view.show_fields_of_view([], -1)
    assert hand.view.grab().toImage() == before


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
    hand: Hand, right_drive: Drive
) -> None:
    hand.view.zoom_by(20.0)
    hand.map.all_drives = ()
    hand.map.shared.map_changes.drives_changed.emit()
    assert hand.view.lay() is None
    hand.click(QPoint(450, 350))
    hand.map.all_drives = (right_drive,)
    with hand.qtbot.waitSignal(hand.view.sharpened, timeout=30_000):
        hand.map.shared.map_changes.drives_changed.emit()
    corners = (Place(right_drive.info.lowest), Place(right_drive.info.highest))
    assert all(hand.view.rect().contains(hand.spot(corner)) for corner in corners)


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
    place = view.place_at(view.viewport.to_plane(spot.x(), spot.y()), 0.5, exact=True)
    assert place is not None
    assert place.xyz[2] > top.xyz[2] - 0.11
    view.move_along(1.0)
    view.close()
    tiles.close()


@pytest.mark.parametrize("times", [1, 2])
def test_a_closed_view_stops_its_worker(hand: Hand, times: int) -> None:
    for _ in range(times):
        hand.view.close()
    hand.view.set_viewport(hand.view.viewport.panned(5.0, 5.0))
    hand.view.set_limit(5.0)
