"""The 3D view by mouse and keys, drawn by software: positions are computed from points."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor, QImage
from pytestqt.qtbot import QtBot

from processing.image.tile_cache import TileCache
from processing.points.drive import Drive
from processing.project.catalogue import Geometry
from processing.project.change import Change
from processing.project.feature import Status
from processing.text import Text
from tests.widgets.builders import OpenMap, path_tool, place_on
from tests.widgets.scene_view.conftest import RIGHT, Hand
from widgets.mouse_tools.menu_wish import MenuWish
from widgets.mouse_tools.select import Select
from widgets.scene_view.view import SceneView
from widgets.shared.cursor import Place

MIDDLE = QPoint(400, 300)


def image_of(hand: Hand) -> QImage:
    """What is on the screen once all is drawn."""
    hand.sharpen()
    # Two frames: features are put into the scene by the event loop, and then drawn.
    for _ in range(2):
        with hand.qtbot.waitSignal(hand.picture.frameSwapped, timeout=30_000):
            hand.picture.update()
    return hand.view.grab().toImage()


def shown_near(hand: Hand, place: Place, colour: str, within_px: int = 4) -> bool:
    """Whether a colour is on the screen next to a place."""
    image, spot, wanted = image_of(hand), hand.spot(place), QColor(colour)
    span = range(-within_px, within_px + 1)
    pixels = [image.pixelColor(spot.x() + dx, spot.y() + dy) for dx in span for dy in span]
    return any(_alike(pixel, wanted) for pixel in pixels)


def _alike(one: QColor, other: QColor) -> bool:
    pairs = zip(one.getRgb()[:3], other.getRgb()[:3], strict=True)
    return all(abs(a - b) <= 12 for a, b in pairs)


def is_in_middle_third(hand: Hand, place: Place) -> bool:
    spot = hand.spot(place)
    return 800 / 3 <= spot.x() <= 1600 / 3 and 200 <= spot.y() <= 400


def test_a_click_on_a_point_gives_its_exact_coordinate(hand: Hand) -> None:
    for point in hand.road_points(3):
        place = place_on(hand.drive, point)
        hand.look_at(place, 2.0)
        hand.click(hand.spot(place))
        found = hand.map.shared.cursor.place
        assert found is not None
        assert found.measured is not None
        drive = hand.map.drive(found.measured.drive)
        assert found == place_on(drive, found.measured.point)
        # A pixel is some 2 mm wide here; both scanners measured this road.
        assert np.linalg.norm(np.subtract(found.xyz, place.xyz)) < 0.02


def test_a_click_into_the_sky_leaves_the_cursor(hand: Hand) -> None:
    way = hand.drive.trajectory
    assert way is not None
    above_the_vehicle = Place(tuple(way.xyz[len(way.xyz) // 2] + [0.0, 0.0, 30.0]))
    hand.look_at(above_the_vehicle, 20.0, pitch_deg=89.0)
    hand.click(MIDDLE)
    assert hand.map.shared.cursor.place is None


def test_the_mouse_tells_the_point_below_it(hand: Hand) -> None:
    place = place_on(hand.drive, hand.road_points(1)[0])
    hand.look_at(place, 2.0)
    with hand.qtbot.waitSignal(hand.map.shared.cursor.hovered, timeout=30_000):
        hand.move(hand.spot(place))
    hover = hand.map.shared.cursor.hover
    assert hover is not None
    assert np.linalg.norm(np.subtract(hover.xyz, place.xyz)) < 0.05


def test_a_cursor_set_elsewhere_comes_into_the_middle_and_the_camera_keeps_its_direction(
    hand: Hand,
) -> None:
    first, *_, last = (place_on(hand.drive, point) for point in hand.road_points(4))
    hand.look_at(first, 2.0)
    before = hand.view.camera
    hand.map.shared.cursor.move_to(last)
    after = hand.view.camera
    assert is_in_middle_third(hand, last)
    assert (after.heading_deg, after.pitch_deg) == (before.heading_deg, before.pitch_deg)


def test_a_cursor_that_is_in_the_middle_already_moves_nothing(hand: Hand) -> None:
    place = place_on(hand.drive, hand.road_points(1)[0])
    hand.look_at(place)
    before = hand.view.camera
    hand.map.shared.cursor.move_to(place)
    assert hand.view.camera == before


def test_a_click_in_this_view_does_not_move_the_picture_under_the_mouse(hand: Hand) -> None:
    first, *_, last = (place_on(hand.drive, point) for point in hand.road_points(4))
    hand.look_at(first)
    # So far that the other place is near the picture's edge.
    hand.view.look_from(hand.view.camera.centred_on(hand.local(first), 12.0))
    hand.sharpen()
    assert not is_in_middle_third(hand, last)
    before = hand.view.camera
    hand.click(hand.spot(last))
    assert hand.map.shared.cursor.place is not None
    assert hand.view.camera == before


def test_the_cursor_is_a_cross_with_a_gap(hand: Hand) -> None:
    place = place_on(hand.drive, hand.road_points(1)[0])
    hand.look_at(place)
    hand.map.shared.cursor.move_to(place)
    image, spot = image_of(hand), hand.spot(place)
    arm = image.pixelColor(spot.x() + 9, spot.y())
    assert arm.red() > 200
    assert arm.blue() < 120
    gap = image.pixelColor(spot)
    assert abs(gap.red() - gap.blue()) < 60


def test_the_points_drawn_stay_within_the_budget(hand: Hand) -> None:
    cloud = hand.view.cloud
    assert cloud is not None
    hand.view.show_everything()
    hand.sharpen()
    drawn = sum(one.tile.points.size for one in cloud.drawn)
    assert 0 < drawn <= cloud.budget.still_points
    total = sum(drive.count for drive in hand.map.drives())
    assert drawn <= total


@pytest.mark.parametrize("geometry", list(Geometry))
def test_features_appear_and_vanish(hand: Hand, geometry: Geometry) -> None:
    points = hand.road_points(3)
    count = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}[geometry]
    place = place_on(hand.drive, points[0])
    hand.look_at(place)
    colour = hand.map.catalogue()[hand.map.kind_of(geometry)].colour
    assert not shown_near(hand, place, colour)
    feature = hand.map.add(geometry, hand.drive, *points[:count])
    assert shown_near(hand, place, colour)
    hand.map.shared.view_settings.hide_kinds(frozenset({feature.kind}))
    assert not shown_near(hand, place, colour)
    hand.map.shared.view_settings.hide_kinds(frozenset())
    assert shown_near(hand, place, colour)
    hand.map.apply(Text.same("away"), Change(removed=(feature,)))
    assert not shown_near(hand, place, colour)


def test_rejected_features_are_not_drawn(hand: Hand) -> None:
    (point,) = hand.road_points(1)
    place = place_on(hand.drive, point)
    hand.look_at(place)
    hand.map.add(Geometry.POINT, hand.drive, point, status=Status.REJECTED)
    assert not shown_near(hand, place, hand.map.catalogue()["pole"].colour)


def test_a_line_is_drawn_with_clicks_and_finished_with_the_right_button(hand: Hand) -> None:
    tool = path_tool(hand.map, Geometry.LINE)
    hand.take(tool)
    places = [place_on(hand.drive, point) for point in hand.road_points(2)]
    for place in places:
        hand.look_at(place, 2.0)
        hand.click(hand.spot(place))
    hand.click(MIDDLE, button=RIGHT)
    (feature,) = hand.map.features()
    assert [vertex.measured is not None for vertex in feature.vertices] == [True, True]
    for vertex, place in zip(feature.vertices, places, strict=True):
        assert np.linalg.norm(np.subtract(vertex.xyz, place.xyz)) < 0.02


def test_a_click_on_a_line_chooses_it_and_its_vertices_are_marked(hand: Hand) -> None:
    first, second = hand.road_points(2)
    hand.look_at(place_on(hand.drive, first))
    feature = hand.map.add(Geometry.LINE, hand.drive, first, second)
    image_of(hand)
    hand.take(Select(hand.map, hand.map.shared))
    hand.click(hand.spot(place_on(hand.drive, first)))
    assert hand.map.shared.selection.features == {feature.id}


def test_a_box_chooses_the_features_and_the_drawn_points_in_it(hand: Hand) -> None:
    (point,) = hand.road_points(1)
    place = place_on(hand.drive, point)
    hand.look_at(place)
    inside = hand.map.add(Geometry.POINT, hand.drive, point)
    image_of(hand)
    hand.take(Select(hand.map, hand.map.shared))
    spot = hand.spot(place)
    hand.drag(spot - QPoint(40, 40), spot + QPoint(40, 40))
    assert hand.map.shared.selection.features == {inside.id}
    chosen = hand.map.shared.selection.points
    assert chosen
    for drive_id, points in chosen.items():
        for one in points[:: max(1, points.size // 20)].tolist():
            position = hand.spot(place_on(hand.map.drive(drive_id), one)) - spot
            assert max(abs(position.x()), abs(position.y())) <= 41


def test_a_right_drag_turns_about_the_point_under_the_mouse(hand: Hand) -> None:
    place = place_on(hand.drive, hand.road_points(1)[0])
    hand.look_at(place)
    before, spot = hand.view.camera, hand.spot(place)
    hand.drag(spot, spot + QPoint(120, 40), button=RIGHT)
    after = hand.view.camera
    assert after.heading_deg != before.heading_deg
    assert after.pitch_deg != before.pitch_deg
    moved = hand.spot(place) - spot
    assert max(abs(moved.x()), abs(moved.y())) <= 6


@pytest.mark.parametrize("by", ["middle button", "space"])
def test_a_drag_pushes_the_picture_with_the_mouse(hand: Hand, by: str) -> None:
    place = place_on(hand.drive, hand.road_points(1)[0])
    hand.look_at(place)
    spot = hand.spot(place)
    if by == "space":
        hand.qtbot.keyPress(hand.picture, Qt.Key.Key_Space)
        hand.drag(spot, spot + QPoint(90, -50))
        hand.qtbot.keyRelease(hand.picture, Qt.Key.Key_Space)
    else:
        hand.drag(spot, spot + QPoint(90, -50), button=Qt.MouseButton.MiddleButton)
    moved = hand.spot(place) - spot - QPoint(90, -50)
    assert max(abs(moved.x()), abs(moved.y())) <= 4


@pytest.mark.parametrize("notches", [3, -2])
def test_the_wheel_zooms_at_the_mouse(hand: Hand, notches: int) -> None:
    place = place_on(hand.drive, hand.road_points(1)[0])
    hand.look_at(place)
    hand.view.look_from(hand.view.camera.panned(0.5, 0.3))
    hand.sharpen()
    spot, before = hand.spot(place), hand.view.camera
    hand.wheel(spot, notches)
    assert hand.view.camera.distance_m == pytest.approx(before.distance_m / 1.25**notches)
    moved = hand.spot(place) - spot
    assert max(abs(moved.x()), abs(moved.y())) <= 8


def test_the_wheel_with_control_changes_the_size_of_points(hand: Hand) -> None:
    before = hand.map.shared.view_settings.look.point_size_px
    hand.wheel(MIDDLE, 2, Qt.KeyboardModifier.ControlModifier)
    assert hand.map.shared.view_settings.look.point_size_px == before + 1.0


def test_the_wheel_with_shift_moves_along_the_drive(hand: Hand) -> None:
    hand.key(Qt.Key.Key_Home)
    before = np.array(hand.view.camera.position)
    hand.wheel(MIDDLE, 2, Qt.KeyboardModifier.ShiftModifier)
    moved = np.array(hand.view.camera.position) - before
    assert moved[1] > 1.0  # the simulated road leads north
    assert abs(moved[0]) < 0.2 * moved[1]
    assert abs(moved[2]) < 1e-6


def test_home_looks_along_the_drive_from_behind_and_above(hand: Hand) -> None:
    hand.look_at(place_on(hand.drive, hand.road_points(1)[0]))
    hand.key(Qt.Key.Key_Home)
    camera = hand.view.camera
    assert abs((camera.heading_deg + 180) % 360 - 180) < 5
    assert -60 < camera.pitch_deg < -5
    way = hand.drive.trajectory
    assert way is not None
    height = camera.position[2] + hand.map.origin()[2]
    assert height > way.xyz[:, 2].max()


def test_f_centres_on_the_selection(hand: Hand) -> None:
    points = hand.road_points(4)
    feature = hand.map.add(Geometry.LINE, hand.drive, points[2], points[3])
    hand.map.shared.selection.choose_features(frozenset({feature.id}))
    hand.key(Qt.Key.Key_F)
    width, height = hand.view.width(), hand.view.height()
    for point in points[2:4]:
        spot = hand.spot(place_on(hand.drive, point))
        assert 0 < spot.x() < width
        assert 0 < spot.y() < height


def test_from_above_north_is_up(hand: Hand) -> None:
    hand.view.look_from_above()
    camera = hand.view.camera
    assert (camera.heading_deg, camera.pitch_deg) == (0.0, -90.0)
    low, high = (place_on(hand.drive, point) for point in hand.road_points(4)[::3])
    assert hand.spot(high).y() < hand.spot(low).y()


def test_another_attribute_colours_the_points_anew(hand: Hand) -> None:
    before = image_of(hand)
    with hand.qtbot.waitSignal(hand.view.sharpened, timeout=20_000):
        hand.map.shared.view_settings.change_look(attribute="height")
    after = image_of(hand)
    assert _colourfulness(before) < 0.02
    assert _colourfulness(after) > 0.1


def _colourfulness(image: QImage) -> float:
    """Share of pixels that are neither grey nor background."""
    spots = [(x, y) for x in range(0, image.width(), 5) for y in range(0, image.height(), 5)]
    colours = [image.pixelColor(*spot) for spot in spots]
    return float(np.mean([max(c.getRgb()[:3]) - min(c.getRgb()[:3]) > 30 for c in colours]))


def test_chosen_points_are_marked(hand: Hand) -> None:
    place = place_on(hand.drive, hand.road_points(1)[0])
    hand.look_at(place, 2.0)
    assert place.measured is not None
    nearby = np.arange(hand.drive.count, dtype=np.int64)
    hand.map.shared.selection.choose_points({hand.drive.id: nearby})
    image = image_of(hand)
    assert _colourfulness(image) > 0.02


def test_the_right_button_opens_a_menu_when_nothing_is_being_drawn(hand: Hand) -> None:
    wishes: list[MenuWish] = []
    hand.view.menu_requested.connect(wishes.append)
    hand.click(MIDDLE, button=RIGHT)
    (wish,) = wishes
    assert len(wish.menu.actions()) >= 5
    assert wish.where == hand.view.mapToGlobal(MIDDLE)
    wish.menu.popup(wish.where)
    wish.menu.close()


def test_shading_can_be_turned_off(hand: Hand) -> None:
    with_shading = image_of(hand)
    hand.view.set_shading(is_on=False)
    assert image_of(hand) != with_shading


def test_drives_that_go_leave_an_empty_picture_that_says_so(
    hand: Hand, capfd: pytest.CaptureFixture[str]
) -> None:
    hand.map.all_drives = ()
    hand.map.shared.map_changes.drives_changed.emit()
    assert hand.view.cloud is not None
    assert hand.view.cloud.drawn == ()
    hand.click(MIDDLE)
    assert hand.map.shared.cursor.place is None


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
    open_map.shared.cursor.move_to(place_on(left_drive, 5))
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
