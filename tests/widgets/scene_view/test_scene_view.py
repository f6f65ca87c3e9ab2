"""The 3D view by mouse and keys, drawn by software: positions are computed from points."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor, QImage
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.image.attributes.tile_cache import TileCache
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Status
from processing.recording.drive import Drive
from tests.widgets.builders import OpenMap, path_tool, position_on
from tests.widgets.scene_view.conftest import RIGHT, SceneViewUser
from widgets.mouse_tools.editing.select import Select
from widgets.mouse_tools.menu_request import MenuRequest
from widgets.scene_view.view import SceneView
from widgets.shared.cursor import PickedPosition

MIDDLE = QPoint(400, 300)


def image_of(user: SceneViewUser) -> QImage:
    """What is on the screen once all is drawn."""
    user.sharpen()
    # Two frames: features are put into the scene by the event loop, and then drawn.
    for _ in range(2):
        with user.qtbot.waitSignal(user.picture.frame_painted, timeout=30_000):
            user.picture.redraw()
    return user.view.grab().toImage()


def shown_near(
    user: SceneViewUser, position: PickedPosition, colour: str, within_px: int = 4
) -> bool:
    """Whether a colour is on the screen next to a place."""
    image, spot, wanted = image_of(user), user.spot(position), QColor(colour)
    span = range(-within_px, within_px + 1)
    pixels = [image.pixelColor(spot.x() + dx, spot.y() + dy) for dx in span for dy in span]
    return any(_alike(pixel, wanted) for pixel in pixels)


def _alike(one: QColor, other: QColor) -> bool:
    pairs = zip(one.getRgb()[:3], other.getRgb()[:3], strict=True)
    return all(abs(a - b) <= 12 for a, b in pairs)


def is_in_middle_third(user: SceneViewUser, position: PickedPosition) -> bool:
    spot = user.spot(position)
    return 800 / 3 <= spot.x() <= 1600 / 3 and 200 <= spot.y() <= 400


def test_a_click_on_a_point_gives_its_exact_coordinate(user: SceneViewUser) -> None:
    for point in user.road_points(3):
        position = position_on(user.drive, point)
        user.look_at(position, 2.0)
        user.click(user.spot(position))
        found = user.map.shared.cursor.position
        assert found is not None
        assert found.measured is not None
        drive = user.map.drive(found.measured.drive)
        assert found == position_on(drive, found.measured.point)
        # A pixel is some 2 mm wide here; both scanners measured this road.
        assert np.linalg.norm(np.subtract(found.xyz, position.xyz)) < 0.02


def test_a_click_into_the_sky_leaves_the_cursor(user: SceneViewUser) -> None:
    vehicle_path = user.drive.trajectory
    assert vehicle_path is not None
    above_the_vehicle = PickedPosition(
        tuple(vehicle_path.xyz[len(vehicle_path.xyz) // 2] + [0.0, 0.0, 30.0])
    )
    user.look_at(above_the_vehicle, 20.0, pitch_deg=89.0)
    user.click(MIDDLE)
    assert user.map.shared.cursor.position is None


def test_the_mouse_tells_the_point_below_it(user: SceneViewUser) -> None:
    position = position_on(user.drive, user.road_points(1)[0])
    user.look_at(position, 2.0)
    with user.qtbot.waitSignal(user.map.shared.cursor.hovered, timeout=30_000):
        user.move(user.spot(position))
    hover = user.map.shared.cursor.hover
    assert hover is not None
    assert np.linalg.norm(np.subtract(hover.xyz, position.xyz)) < 0.05


def test_a_cursor_set_elsewhere_comes_into_the_middle_and_the_camera_keeps_its_direction(
    user: SceneViewUser,
) -> None:
    first, *_, last = (position_on(user.drive, point) for point in user.road_points(4))
    user.look_at(first, 2.0)
    before = user.view.camera
    user.map.shared.cursor.move_to(last)
    after = user.view.camera
    assert is_in_middle_third(user, last)
    assert (after.heading_deg, after.pitch_deg) == (before.heading_deg, before.pitch_deg)


def test_a_cursor_that_is_in_the_middle_already_moves_nothing(user: SceneViewUser) -> None:
    position = position_on(user.drive, user.road_points(1)[0])
    user.look_at(position)
    before = user.view.camera
    user.map.shared.cursor.move_to(position)
    assert user.view.camera == before


def test_a_click_in_this_view_does_not_move_the_picture_under_the_mouse(
    user: SceneViewUser,
) -> None:
    first, *_, last = (position_on(user.drive, point) for point in user.road_points(4))
    user.look_at(first)
    # So far that the other place is near the picture's edge.
    user.view.look_from(user.view.camera.centred_on(user.local(first), 12.0))
    user.sharpen()
    assert not is_in_middle_third(user, last)
    before = user.view.camera
    user.click(user.spot(last))
    assert user.map.shared.cursor.position is not None
    assert user.view.camera == before


def test_the_cursor_is_a_cross_with_a_gap(user: SceneViewUser) -> None:
    position = position_on(user.drive, user.road_points(1)[0])
    user.look_at(position)
    user.map.shared.cursor.move_to(position)
    image, spot = image_of(user), user.spot(position)
    arm = image.pixelColor(spot.x() + 9, spot.y())
    assert arm.red() > 200
    assert arm.blue() < 120
    gap = image.pixelColor(spot)
    assert abs(gap.red() - gap.blue()) < 60


def test_the_points_drawn_stay_within_the_budget(user: SceneViewUser) -> None:
    cloud = user.view.cloud
    assert cloud is not None
    user.view.show_everything()
    user.sharpen()
    drawn = sum(one.tile.points.size for one in cloud.drawn)
    assert 0 < drawn <= cloud.budget.still_points
    total = sum(drive.count for drive in user.map.drives())
    assert drawn <= total


@pytest.mark.parametrize("geometry", list(Geometry))
def test_features_appear_and_vanish(user: SceneViewUser, geometry: Geometry) -> None:
    points = user.road_points(3)
    count = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}[geometry]
    position = position_on(user.drive, points[0])
    user.look_at(position)
    colour = user.map.catalogue()[user.map.kind_of(geometry)].colour
    assert not shown_near(user, position, colour)
    feature = user.map.add(geometry, user.drive, *points[:count])
    assert shown_near(user, position, colour)
    user.map.shared.view_settings.hide_kinds(frozenset({feature.kind}))
    assert not shown_near(user, position, colour)
    user.map.shared.view_settings.hide_kinds(frozenset())
    assert shown_near(user, position, colour)
    user.map.apply(Text.same("away"), Change(removed=(feature,)))
    assert not shown_near(user, position, colour)


def test_rejected_features_are_not_drawn(user: SceneViewUser) -> None:
    (point,) = user.road_points(1)
    position = position_on(user.drive, point)
    user.look_at(position)
    user.map.add(Geometry.POINT, user.drive, point, status=Status.REJECTED)
    assert not shown_near(user, position, user.map.catalogue()["pole"].colour)


def test_a_line_is_drawn_with_clicks_and_finished_with_the_right_button(
    user: SceneViewUser,
) -> None:
    tool = path_tool(user.map, Geometry.LINE)
    user.take(tool)
    positions = [position_on(user.drive, point) for point in user.road_points(2)]
    for position in positions:
        user.look_at(position, 2.0)
        user.click(user.spot(position))
    user.click(MIDDLE, button=RIGHT)
    (feature,) = user.map.features()
    assert [vertex.measured is not None for vertex in feature.vertices] == [True, True]
    for vertex, position in zip(feature.vertices, positions, strict=True):
        assert np.linalg.norm(np.subtract(vertex.xyz, position.xyz)) < 0.02


def test_a_click_on_a_line_chooses_it_and_its_vertices_are_marked(user: SceneViewUser) -> None:
    first, second = user.road_points(2)
    user.look_at(position_on(user.drive, first))
    feature = user.map.add(Geometry.LINE, user.drive, first, second)
    image_of(user)
    user.take(Select(user.map, user.map.shared))
    user.click(user.spot(position_on(user.drive, first)))
    assert user.map.shared.selection.features == {feature.id}


def test_a_box_chooses_the_features_and_the_drawn_points_in_it(user: SceneViewUser) -> None:
    (point,) = user.road_points(1)
    position = position_on(user.drive, point)
    user.look_at(position)
    inside = user.map.add(Geometry.POINT, user.drive, point)
    image_of(user)
    user.take(Select(user.map, user.map.shared))
    spot = user.spot(position)
    user.drag(spot - QPoint(40, 40), spot + QPoint(40, 40))
    assert user.map.shared.selection.features == {inside.id}
    chosen = user.map.shared.selection.points
    assert chosen
    for drive_id, points in chosen.items():
        for one in points[:: max(1, points.size // 20)].tolist():
            offset = user.spot(position_on(user.map.drive(drive_id), one)) - spot
            assert max(abs(offset.x()), abs(offset.y())) <= 41


def test_a_right_drag_turns_about_the_point_under_the_mouse(user: SceneViewUser) -> None:
    position = position_on(user.drive, user.road_points(1)[0])
    user.look_at(position)
    before, spot = user.view.camera, user.spot(position)
    user.drag(spot, spot + QPoint(120, 40), button=RIGHT)
    after = user.view.camera
    assert after.heading_deg != before.heading_deg
    assert after.pitch_deg != before.pitch_deg
    moved = user.spot(position) - spot
    assert max(abs(moved.x()), abs(moved.y())) <= 6


@pytest.mark.parametrize("by", ["middle button", "space"])
def test_a_drag_pushes_the_picture_with_the_mouse(user: SceneViewUser, by: str) -> None:
    position = position_on(user.drive, user.road_points(1)[0])
    user.look_at(position)
    spot = user.spot(position)
    if by == "space":
        user.qtbot.keyPress(user.picture, Qt.Key.Key_Space)
        user.drag(spot, spot + QPoint(90, -50))
        user.qtbot.keyRelease(user.picture, Qt.Key.Key_Space)
    else:
        user.drag(spot, spot + QPoint(90, -50), button=Qt.MouseButton.MiddleButton)
    moved = user.spot(position) - spot - QPoint(90, -50)
    assert max(abs(moved.x()), abs(moved.y())) <= 4


@pytest.mark.parametrize("notches", [3, -2])
def test_the_wheel_zooms_at_the_mouse(user: SceneViewUser, notches: int) -> None:
    position = position_on(user.drive, user.road_points(1)[0])
    user.look_at(position)
    user.view.look_from(user.view.camera.panned(0.5, 0.3))
    user.sharpen()
    spot, before = user.spot(position), user.view.camera
    user.wheel(spot, notches)
    assert user.view.camera.distance_m == pytest.approx(before.distance_m / 1.25**notches)
    moved = user.spot(position) - spot
    assert max(abs(moved.x()), abs(moved.y())) <= 8


def test_the_wheel_with_control_changes_the_size_of_points(user: SceneViewUser) -> None:
    before = user.map.shared.view_settings.look.point_size_px
    user.wheel(MIDDLE, 2, Qt.KeyboardModifier.ControlModifier)
    assert user.map.shared.view_settings.look.point_size_px == before + 1.0


def test_the_wheel_with_shift_moves_along_the_drive(user: SceneViewUser) -> None:
    user.key(Qt.Key.Key_Home)
    before = np.array(user.view.camera.position)
    user.wheel(MIDDLE, 2, Qt.KeyboardModifier.ShiftModifier)
    moved = np.array(user.view.camera.position) - before
    assert moved[1] > 1.0  # the simulated road leads north
    assert abs(moved[0]) < 0.2 * moved[1]
    assert abs(moved[2]) < 1e-6


def test_home_looks_along_the_drive_from_behind_and_above(user: SceneViewUser) -> None:
    user.look_at(position_on(user.drive, user.road_points(1)[0]))
    user.key(Qt.Key.Key_Home)
    camera = user.view.camera
    assert abs((camera.heading_deg + 180) % 360 - 180) < 5
    assert -60 < camera.pitch_deg < -5
    vehicle_path = user.drive.trajectory
    assert vehicle_path is not None
    height = camera.position[2] + user.map.origin()[2]
    assert height > vehicle_path.xyz[:, 2].max()


def test_f_centres_on_the_selection(user: SceneViewUser) -> None:
    points = user.road_points(4)
    feature = user.map.add(Geometry.LINE, user.drive, points[2], points[3])
    user.map.shared.selection.choose_features(frozenset({feature.id}))
    user.key(Qt.Key.Key_F)
    width, height = user.view.width(), user.view.height()
    for point in points[2:4]:
        spot = user.spot(position_on(user.drive, point))
        assert 0 < spot.x() < width
        assert 0 < spot.y() < height


def test_from_above_north_is_up(user: SceneViewUser) -> None:
    user.view.look_from_above()
    camera = user.view.camera
    assert (camera.heading_deg, camera.pitch_deg) == (0.0, -90.0)
    low, high = (position_on(user.drive, point) for point in user.road_points(4)[::3])
    assert user.spot(high).y() < user.spot(low).y()


def test_another_attribute_colours_the_points_anew(user: SceneViewUser) -> None:
    before = image_of(user)
    with user.qtbot.waitSignal(user.view.sharpened, timeout=20_000):
        user.map.shared.view_settings.change_look(attribute="height")
    after = image_of(user)
    assert _colourfulness(before) < 0.02
    assert _colourfulness(after) > 0.1


def _colourfulness(image: QImage) -> float:
    """Share of pixels that are neither grey nor background."""
    spots = [(x, y) for x in range(0, image.width(), 5) for y in range(0, image.height(), 5)]
    colours = [image.pixelColor(*spot) for spot in spots]
    return float(np.mean([max(c.getRgb()[:3]) - min(c.getRgb()[:3]) > 30 for c in colours]))


def test_chosen_points_are_marked(user: SceneViewUser) -> None:
    position = position_on(user.drive, user.road_points(1)[0])
    user.look_at(position, 2.0)
    assert position.measured is not None
    nearby = np.arange(user.drive.count, dtype=np.int64)
    user.map.shared.selection.choose_points({user.drive.id: nearby})
    image = image_of(user)
    assert _colourfulness(image) > 0.02


def test_the_right_button_opens_a_menu_when_nothing_is_being_drawn(user: SceneViewUser) -> None:
    requests: list[MenuRequest] = []
    user.view.menu_requested.connect(requests.append)
    user.click(MIDDLE, button=RIGHT)
    (request,) = requests
    assert len(request.menu.actions()) >= 5
    assert request.where == user.view.mapToGlobal(MIDDLE)
    request.menu.popup(request.where)
    request.menu.close()


def test_shading_can_be_turned_off(user: SceneViewUser) -> None:
    with_shading = image_of(user)
    user.view.set_shading(is_on=False)
    assert image_of(user) != with_shading


def test_drives_that_go_leave_an_empty_picture_that_says_so(
    user: SceneViewUser, capfd: pytest.CaptureFixture[str]
) -> None:
    user.map.all_drives = ()
    user.map.shared.map_changes.drives_changed.emit()
    assert user.view.cloud is not None
    assert user.view.cloud.drawn == ()
    user.click(MIDDLE)
    assert user.map.shared.cursor.position is None


def test_closing_twice_leaves_no_noise(
    qtbot: QtBot,
    open_map: OpenMap,
    tiles: TileCache,
    left_drive: Drive,
    capfd: pytest.CaptureFixture[str],
) -> None:
    view = SceneView(open_map, open_map.shared, tiles)
    qtbot.addWidget(view)
    with qtbot.waitSignal(view.sharpened, timeout=60_000):
        view.show()
    view.close()
    view.close()
    assert capfd.readouterr().err == ""
    open_map.shared.cursor.move_to(position_on(left_drive, 5))
    open_map.shared.view_settings.change_look(attribute="height")
    open_map.shared.map_changes.drives_changed.emit()


def test_a_view_that_is_closed_before_it_was_shown_closes(
    qtbot: QtBot, open_map: OpenMap, tiles: TileCache
) -> None:
    view = SceneView(open_map, open_map.shared, tiles)
    qtbot.addWidget(view)
    view.close()
    assert view.picture is None


def test_a_view_that_is_closed_while_it_starts_stays_closed(
    qtbot: QtBot, open_map: OpenMap, tiles: TileCache
) -> None:
    view = SceneView(open_map, open_map.shared, tiles)
    qtbot.addWidget(view)
    view.show()
    view.close()
    qtbot.wait(50)
    assert view.picture is None
