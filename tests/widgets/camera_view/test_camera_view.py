"""The camera view shows the image that sees the cursor best, and clicks find what it shows."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from processing.cameras.calibration import CameraOffset
from processing.cameras.image_list import CameraImage, ImageList
from processing.cameras.image_store import write_images
from processing.points.drive import Drive
from processing.project.catalogue import Geometry
from tests.camera_scene import SURFACE_COLOURS, looking, photograph
from tests.widgets.builders import OpenMap, path_tool
from tests.widgets.camera_view.conftest import Hand, place_at, shown
from widgets.camera_view.lay import CameraLay
from widgets.shared.cursor import Place

ROAD, WALL = 0, 3
ON_WALL = place_at(-8.0, -1.0, 1.5)
ON_ROAD = place_at(0.5, 7.0, -0.01)


def with_images(tmp_path: Path, drive: Drive, images: tuple[CameraImage, ...]) -> Drive:
    """Give the same drive in a folder of its own, with other images."""
    folder = tmp_path / "drive"
    shutil.copytree(drive.folder, folder)
    write_images(folder, ImageList(images))
    return Drive(folder)


def colour_at(hand: Hand, spot: QPoint) -> tuple[int, ...]:
    colour = hand.view.grab().toImage().pixelColor(spot)
    return colour.red(), colour.green(), colour.blue()


def test_the_image_that_sees_the_cursor_best_is_shown_and_others_by_keys(hand: Hand) -> None:
    names = []
    hand.view.image_changed.connect(names.append)
    hand.look_at(ON_WALL)
    assert hand.name == "left_0000"
    hand.look_at(ON_ROAD)
    assert hand.name == "front_0001"
    with hand.qtbot.waitActive(hand.panel):
        hand.panel.activateWindow()
    hand.view.setFocus()
    hand.qtbot.keyClick(hand.view, Qt.Key.Key_PageDown)
    assert hand.name == "front_0000"
    hand.qtbot.keyClick(hand.view, Qt.Key.Key_PageUp)
    assert hand.name == "front_0001"
    assert names == ["left_0000.png", "front_0001.png", "front_0000.png", "front_0001.png"]


def test_the_photograph_lies_where_places_are_projected(hand: Hand) -> None:
    hand.look_at(ON_ROAD)
    hand.map.shared.cursor.clear()
    hand.view.read_images()
    hand.view.show_place(ON_ROAD)
    hand.wait_sharp()
    hand.view.show_everything()
    for place, surface in ((place_at(0.0, 9.0), ROAD), (place_at(-8.0, 16.0, 2.0), WALL)):
        wanted = SURFACE_COLOURS[surface].tolist()
        assert np.abs(np.subtract(colour_at(hand, hand.spot(place)), wanted)).max() < 12


def test_a_place_that_is_shown_is_in_the_middle(hand: Hand) -> None:
    hand.view.show_place(ON_WALL)
    hand.wait_sharp()
    position = hand.view.position_of(ON_WALL)
    assert position is not None
    assert position.x() == pytest.approx(hand.view.width() / 2, abs=0.01)
    assert position.y() == pytest.approx(hand.view.height() / 2, abs=0.01)


def test_a_prepared_place_is_shown_at_once(hand: Hand) -> None:
    hand.look_at(ON_ROAD)
    hand.view.prepare([ON_WALL])
    images = hand.view.showing.images.images
    wanted = next(taken.image for taken in images if taken.image.path.stem == "left_0000")
    darkroom = hand.view._darkroom
    hand.qtbot.waitUntil(lambda: darkroom.photo(wanted) is not None, timeout=30_000)
    hand.qtbot.waitUntil(lambda: darkroom.depth(wanted) is not None, timeout=30_000)
    hand.view.show_place(ON_WALL)
    assert hand.name == "left_0000"
    assert hand.view.is_sharp


def test_a_click_goes_to_the_measured_point_that_the_image_shows(hand: Hand) -> None:
    hand.look_at(ON_WALL)
    moved: list[Place] = []
    hand.map.shared.cursor.moved.connect(moved.append)
    hand.click(hand.spot(ON_WALL))
    (place,) = moved
    assert place.measured is not None
    drive = hand.map.drive(place.measured.drive)
    np.testing.assert_array_equal(drive.xyz(np.array([place.measured.point]))[0], place.xyz)
    assert np.linalg.norm(np.subtract(place.xyz, ON_WALL.xyz)) < 0.35
    assert hand.name == "left_0000"


def test_a_click_in_an_image_stays_in_it_though_another_is_better(hand: Hand) -> None:
    hand.look_at(ON_ROAD)
    hand.view.step(1)
    hand.wait_sharp()
    assert hand.name == "front_0000"
    hand.click(hand.spot(ON_ROAD))
    assert hand.name == "front_0000"


def test_lines_are_drawn_by_clicks_on_measured_points(hand: Hand) -> None:
    hand.look_at(ON_ROAD)
    tool = path_tool(hand.map, Geometry.LINE)
    hand.view.set_mouse_tool(hand.map.listen_to(tool))
    for place in (ON_ROAD, place_at(1.5, 8.0, -0.03)):
        hand.click(hand.spot(place))
    drawing = hand.map.shared.sketch.drawing
    assert drawing is not None
    assert all(vertex.measured is not None for vertex in drawing.vertices)
    hand.qtbot.mouseClick(hand.view, Qt.MouseButton.RightButton, pos=QPoint(10, 10))
    (feature,) = hand.map.stored.values()
    for vertex, place in zip(feature.vertices, (ON_ROAD, place_at(1.5, 8.0)), strict=True):
        assert np.linalg.norm(np.subtract(vertex.xyz, place.xyz)) < 0.2


def test_fields_of_view_follow_the_images(hand: Hand) -> None:
    told: list[tuple[object, int]] = []
    hand.view.fields_of_view_changed.connect(lambda fields, best: told.append((fields, best)))
    hand.look_at(ON_ROAD)
    fields, best = told[-1]
    assert best == 0
    assert len(fields) == len(hand.view.showing.sightings)  # type: ignore[arg-type]
    hand.view.step(1)
    assert told[-1][1] == 1


def test_two_images_give_a_place_where_nothing_was_measured(hand: Hand) -> None:
    in_the_air = place_at(-1.5, 9.0, 2.6)
    hand.look_at(in_the_air)
    first = hand.name
    hand.view.set_stereo(True)
    moved: list[Place] = []
    hand.map.shared.cursor.moved.connect(moved.append)
    hand.view.set_viewport(hand.view.viewport.zoomed(4.0, *hand.spot(in_the_air).toTuple()))
    hand.click(hand.spot(in_the_air))
    assert hand.name != first
    hand.view.center_on(in_the_air)
    hand.click(hand.spot(in_the_air))
    (place,) = moved
    assert place.is_occluded
    assert place.measured is None
    assert np.linalg.norm(np.subtract(place.xyz, in_the_air.xyz)) < 0.25
    hand.view.set_stereo(False)
    assert not hand.view.is_stereo


def test_escape_forgets_the_first_click_of_stereo(hand: Hand) -> None:
    hand.look_at(ON_ROAD)
    hand.view.set_stereo(True)
    hand.click(hand.spot(ON_ROAD))
    assert hand.view.clicks.stereo is not None
    assert hand.view.clicks.stereo.marked is not None
    with hand.qtbot.waitActive(hand.panel):
        hand.panel.activateWindow()
    hand.view.setFocus()
    hand.qtbot.keyClick(hand.view, Qt.Key.Key_Escape)
    assert hand.view.clicks.stereo.marked is None


def test_offsets_show_at_once_and_are_asked_to_be_kept(hand: Hand) -> None:
    def column_px() -> float:
        lay = hand.view.lay()
        assert lay is not None
        return float(lay.to_plane(np.array([ON_ROAD.xyz]))[0, 0])

    hand.look_at(ON_ROAD)
    before_px = column_px()
    hand.panel.show_calibration(True)
    form = hand.panel.form
    form._fields["yaw_deg"].setValue(1.0)
    assert column_px() < before_px - 3
    with hand.qtbot.waitSignal(hand.panel.offsets_save_requested) as asked:
        form._save.click()
    assert asked.args == [{"front": CameraOffset(yaw_deg=1.0)}]
    hand.panel.show_calibration(False)
    assert abs(column_px() - before_px) <= 1


def test_the_offset_is_estimated_from_clicked_pairs(hand: Hand) -> None:
    hand.look_at(ON_ROAD)
    hand.panel.show_calibration(True)
    form = hand.panel.form
    form._points.setChecked(True)
    taken = hand.view.showing.taken
    assert taken is not None
    turned = looking(taken.image.path, (-0.5, 4.0, 2.0), (0.02, 1.0, -0.2))
    for place in (
        place_at(0.5, 8.0),
        place_at(-2.0, 9.0),
        place_at(2.0, 12.0),
        place_at(0.0, 14.0, 1.0),
    ):
        pixel = CameraLay(turned, None).to_plane(np.array([place.xyz]))
        hand.click(QPoint(*np.rint(hand.view.viewport.to_screen(pixel)[0]).astype(int).tolist()))
        hand.map.shared.cursor.move_to(place)
        hand.wait_sharp()
        hand.view.show_sighting(
            [one.image.path.stem for one in hand.view.showing.sightings].index("front_0001")
        )
    assert len(form.pairs) == 4
    form._estimate.click()
    assert form._fields["yaw_deg"].value() == pytest.approx(np.degrees(np.arctan(0.02)), abs=0.15)
    assert "4 pair" in form._facts.text()
    form._reset.click()
    assert form._fields["yaw_deg"].value() == 0
    hand.panel.show_calibration(False)


def test_without_images_the_view_says_how_to_get_some(qtbot: QtBot, left_drive: Drive) -> None:
    hand = shown(qtbot, OpenMap((left_drive,)))
    assert "Add camera images" in hand.view.words()
    assert hand.view.lay() is None
    hand.view.close()


def test_a_place_that_no_image_sees_is_told_with_the_nearest_image(hand: Hand) -> None:
    assert "Click a place" in hand.view.words()
    hand.map.shared.cursor.move_to(place_at(0.0, 300.0))
    assert hand.view.lay() is None
    assert "front_0001.png, was taken 296 m away" in hand.view.words()


def test_a_missing_file_is_named_and_the_next_image_shown(
    qtbot: QtBot, tmp_path: Path, photographed: Drive
) -> None:
    assert photographed.delivered_images is not None
    images = tuple(
        replace(image, path=tmp_path / image.path.name) for image in photographed.delivered_images
    )
    photograph(images[0])
    drive = with_images(tmp_path, photographed, images)
    hand = shown(qtbot, OpenMap((drive,)))
    hand.look_at(ON_ROAD)
    assert hand.name == "front_0000"
    hand.map.shared.cursor.move_to(ON_WALL)
    qtbot.waitUntil(lambda: hand.view.lay() is None, timeout=30_000)
    assert "left_000" in hand.view.words()
    hand.view.close()


def test_images_of_another_reference_system_are_told(
    qtbot: QtBot, tmp_path: Path, photographed: Drive
) -> None:
    assert photographed.delivered_images is not None
    images = tuple(
        replace(image, xyz=(389_000.0, 3_947_000.0, 30.0))
        for image in photographed.delivered_images
    )
    hand = shown(qtbot, OpenMap((with_images(tmp_path, photographed, images),)))
    hand.map.shared.cursor.move_to(ON_ROAD)
    assert "another reference system" in hand.view.words()
    hand.view.close()


def test_what_is_hidden_in_one_image_is_shown_in_another(
    qtbot: QtBot, tmp_path: Path, photographed: Drive
) -> None:
    # The first camera is nearer but a wall stands between it and the place.
    inside = looking(tmp_path / "a_0000.png", (-10.0, -1.0, 2.0), (1.0, 0.0, -0.2))
    far = looking(tmp_path / "b_0000.png", (3.5, -1.0, 2.0), (-1.0, 0.0, -0.1))
    for image in (inside, far):
        photograph(image)
    drive = with_images(tmp_path, photographed, (inside, far))
    hand = shown(qtbot, OpenMap((drive,)))
    place = place_at(-7.0, -1.0, 1.0)
    hand.map.shared.cursor.move_to(place)
    assert hand.name == "a_0000"
    qtbot.waitUntil(lambda: hand.name == "b_0000", timeout=30_000)
    sightings = hand.view.showing.sightings
    assert [one.is_hidden for one in sightings if one.image == inside] == [True]
    hand.view.close()


def test_projects_that_are_closed_leave_nothing_shown(hand: Hand) -> None:
    hand.look_at(ON_ROAD)
    hand.map.all_drives = ()
    hand.map.shared.cursor.clear()
    hand.map.shared.map_changes.drives_changed.emit()
    assert hand.view.lay() is None
    assert hand.name == ""
