"""The camera view shows the image that sees the cursor best, and clicks find what it shows."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from processing.map.catalogue import Geometry
from processing.recording.camera_images.calibration import CameraOffset
from processing.recording.camera_images.image_list import CameraImage, ImageList
from processing.recording.camera_images.image_store import write_images
from processing.recording.drive import Drive
from tests.camera_scene import SURFACE_COLOURS, looking, photograph
from tests.widgets.builders import OpenMap, path_tool
from tests.widgets.camera_view.conftest import CameraViewUser, position_at, shown
from widgets.camera_view.projection import CameraProjection
from widgets.shared.cursor import PickedPosition

ROAD, WALL = 0, 3
ON_WALL = position_at(-8.0, -1.0, 1.5)
ON_ROAD = position_at(0.5, 7.0, -0.01)


def with_images(tmp_path: Path, drive: Drive, images: tuple[CameraImage, ...]) -> Drive:
    """Give the same drive in a folder of its own, with other images."""
    folder = tmp_path / "drive"
    shutil.copytree(drive.folder, folder)
    write_images(folder, ImageList(images))
    return Drive(folder)


def colour_at(user: CameraViewUser, spot: QPoint) -> tuple[int, ...]:
    colour = user.view.grab().toImage().pixelColor(spot)
    return colour.red(), colour.green(), colour.blue()


def test_the_image_that_sees_the_cursor_best_is_shown_and_others_by_keys(
    user: CameraViewUser,
) -> None:
    names = []
    user.view.image_changed.connect(names.append)
    user.look_at(ON_WALL)
    assert user.name == "left_0000"
    user.look_at(ON_ROAD)
    assert user.name == "front_0001"
    with user.qtbot.waitActive(user.panel):
        user.panel.activateWindow()
    user.view.setFocus()
    user.qtbot.keyClick(user.view, Qt.Key.Key_PageDown)
    assert user.name == "front_0000"
    user.qtbot.keyClick(user.view, Qt.Key.Key_PageUp)
    assert user.name == "front_0001"
    assert names == ["left_0000.png", "front_0001.png", "front_0000.png", "front_0001.png"]


def test_the_photograph_lies_where_places_are_projected(user: CameraViewUser) -> None:
    user.look_at(ON_ROAD)
    user.map.shared.cursor.clear()
    user.view.read_images()
    user.view.show_position(ON_ROAD)
    user.wait_sharp()
    user.view.show_everything()
    for position, surface in ((position_at(0.0, 9.0), ROAD), (position_at(-8.0, 16.0, 2.0), WALL)):
        wanted = SURFACE_COLOURS[surface].tolist()
        assert np.abs(np.subtract(colour_at(user, user.spot(position)), wanted)).max() < 12


def test_a_place_that_is_shown_is_in_the_middle(user: CameraViewUser) -> None:
    user.view.show_position(ON_WALL)
    user.wait_sharp()
    position = user.view.position_of(ON_WALL)
    assert position is not None
    assert position.x() == pytest.approx(user.view.width() / 2, abs=0.01)
    assert position.y() == pytest.approx(user.view.height() / 2, abs=0.01)


def test_a_prepared_place_is_shown_at_once(user: CameraViewUser) -> None:
    user.look_at(ON_ROAD)
    user.view.prepare([ON_WALL])
    images = user.view.showing.images.images
    wanted = next(taken.image for taken in images if taken.image.path.stem == "left_0000")
    image_loader = user.view._image_loader
    user.qtbot.waitUntil(lambda: image_loader.photo(wanted) is not None, timeout=30_000)
    user.qtbot.waitUntil(lambda: image_loader.depth(wanted) is not None, timeout=30_000)
    user.view.show_position(ON_WALL)
    assert user.name == "left_0000"
    assert user.view.is_sharp


def test_a_click_goes_to_the_measured_point_that_the_image_shows(user: CameraViewUser) -> None:
    user.look_at(ON_WALL)
    moved: list[PickedPosition] = []
    user.map.shared.cursor.moved.connect(moved.append)
    user.click(user.spot(ON_WALL))
    (position,) = moved
    assert position.measured is not None
    drive = user.map.drive(position.measured.drive)
    np.testing.assert_array_equal(drive.xyz(np.array([position.measured.point]))[0], position.xyz)
    assert np.linalg.norm(np.subtract(position.xyz, ON_WALL.xyz)) < 0.35
    assert user.name == "left_0000"


def test_a_click_in_an_image_stays_in_it_though_another_is_better(user: CameraViewUser) -> None:
    user.look_at(ON_ROAD)
    user.view.step(1)
    user.wait_sharp()
    assert user.name == "front_0000"
    user.click(user.spot(ON_ROAD))
    assert user.name == "front_0000"


def test_lines_are_drawn_by_clicks_on_measured_points(user: CameraViewUser) -> None:
    user.look_at(ON_ROAD)
    tool = path_tool(user.map, Geometry.LINE)
    user.view.set_mouse_tool(user.map.listen_to(tool))
    for position in (ON_ROAD, position_at(1.5, 8.0, -0.03)):
        user.click(user.spot(position))
    drawing = user.map.shared.sketch.drawing
    assert drawing is not None
    assert all(vertex.measured is not None for vertex in drawing.vertices)
    user.qtbot.mouseClick(user.view, Qt.MouseButton.RightButton, pos=QPoint(10, 10))
    (feature,) = user.map.stored.values()
    for vertex, position in zip(feature.vertices, (ON_ROAD, position_at(1.5, 8.0)), strict=True):
        assert np.linalg.norm(np.subtract(vertex.xyz, position.xyz)) < 0.2


def test_fields_of_view_follow_the_images(user: CameraViewUser) -> None:
    reported: list[tuple[object, int]] = []
    user.view.fields_of_view_changed.connect(lambda fields, best: reported.append((fields, best)))
    user.look_at(ON_ROAD)
    fields, best = reported[-1]
    assert best == 0
    assert len(fields) == len(user.view.showing.sightings)  # type: ignore[arg-type]
    user.view.step(1)
    assert reported[-1][1] == 1


def test_two_images_give_a_place_where_nothing_was_measured(user: CameraViewUser) -> None:
    in_the_air = position_at(-1.5, 9.0, 2.6)
    user.look_at(in_the_air)
    first = user.name
    user.view.set_stereo(True)
    moved: list[PickedPosition] = []
    user.map.shared.cursor.moved.connect(moved.append)
    user.view.set_viewport(user.view.viewport.zoomed(4.0, *user.spot(in_the_air).toTuple()))
    user.click(user.spot(in_the_air))
    assert user.name != first
    user.view.center_on(in_the_air)
    user.click(user.spot(in_the_air))
    (position,) = moved
    assert position.is_occluded
    assert position.measured is None
    assert np.linalg.norm(np.subtract(position.xyz, in_the_air.xyz)) < 0.25
    user.view.set_stereo(False)
    assert not user.view.is_stereo


def test_escape_forgets_the_first_click_of_stereo(user: CameraViewUser) -> None:
    user.look_at(ON_ROAD)
    user.view.set_stereo(True)
    user.click(user.spot(ON_ROAD))
    assert user.view.clicks.stereo is not None
    assert user.view.clicks.stereo.marked is not None
    with user.qtbot.waitActive(user.panel):
        user.panel.activateWindow()
    user.view.setFocus()
    user.qtbot.keyClick(user.view, Qt.Key.Key_Escape)
    assert user.view.clicks.stereo.marked is None


def test_offsets_show_at_once_and_are_asked_to_be_kept(user: CameraViewUser) -> None:
    def column_px() -> float:
        projection = user.view.projection()
        assert projection is not None
        return float(projection.to_plane(np.array([ON_ROAD.xyz]))[0, 0])

    user.look_at(ON_ROAD)
    before_px = column_px()
    user.panel.show_calibration(True)
    form = user.panel.form
    form._fields["yaw_deg"].setValue(1.0)
    assert column_px() < before_px - 3
    with user.qtbot.waitSignal(user.panel.offsets_save_requested) as asked:
        form._save.click()
    assert asked.args == [{"front": CameraOffset(yaw_deg=1.0)}]
    user.panel.show_calibration(False)
    assert abs(column_px() - before_px) <= 1


def test_the_offset_is_estimated_from_clicked_pairs(user: CameraViewUser) -> None:
    user.look_at(ON_ROAD)
    user.panel.show_calibration(True)
    form = user.panel.form
    form._points.setChecked(True)
    taken = user.view.showing.taken
    assert taken is not None
    turned = looking(taken.image.path, (-0.5, 4.0, 2.0), (0.02, 1.0, -0.2))
    for position in (
        position_at(0.5, 8.0),
        position_at(-2.0, 9.0),
        position_at(2.0, 12.0),
        position_at(0.0, 14.0, 1.0),
    ):
        pixel = CameraProjection(turned, None).to_plane(np.array([position.xyz]))
        user.click(QPoint(*np.rint(user.view.viewport.to_screen(pixel)[0]).astype(int).tolist()))
        user.map.shared.cursor.move_to(position)
        user.wait_sharp()
        user.view.show_sighting(
            [one.image.path.stem for one in user.view.showing.sightings].index("front_0001")
        )
    assert len(form.pairs) == 4
    form._estimate.click()
    assert form._fields["yaw_deg"].value() == pytest.approx(np.degrees(np.arctan(0.02)), abs=0.15)
    assert "4 pair" in form._facts.text()
    form._reset.click()
    assert form._fields["yaw_deg"].value() == 0
    user.panel.show_calibration(False)


def test_without_images_the_view_says_how_to_get_some(qtbot: QtBot, left_drive: Drive) -> None:
    user = shown(qtbot, OpenMap((left_drive,)))
    assert "Add camera images" in user.view.words()
    assert user.view.projection() is None
    user.view.close()


def test_a_place_that_no_image_sees_is_told_with_the_nearest_image(user: CameraViewUser) -> None:
    assert "Click a place" in user.view.words()
    user.map.shared.cursor.move_to(position_at(0.0, 300.0))
    assert user.view.projection() is None
    assert "front_0001.png, was taken 296 m away" in user.view.words()


def test_a_missing_file_is_named_and_the_next_image_shown(
    qtbot: QtBot, tmp_path: Path, photographed: Drive
) -> None:
    assert photographed.delivered_images is not None
    images = tuple(
        replace(image, path=tmp_path / image.path.name) for image in photographed.delivered_images
    )
    photograph(images[0])
    drive = with_images(tmp_path, photographed, images)
    user = shown(qtbot, OpenMap((drive,)))
    user.look_at(ON_ROAD)
    assert user.name == "front_0000"
    user.map.shared.cursor.move_to(ON_WALL)
    qtbot.waitUntil(lambda: user.view.projection() is None, timeout=30_000)
    assert "left_000" in user.view.words()
    user.view.close()


def test_images_of_another_reference_system_are_told(
    qtbot: QtBot, tmp_path: Path, photographed: Drive
) -> None:
    assert photographed.delivered_images is not None
    images = tuple(
        replace(image, xyz=(389_000.0, 3_947_000.0, 30.0))
        for image in photographed.delivered_images
    )
    user = shown(qtbot, OpenMap((with_images(tmp_path, photographed, images),)))
    user.map.shared.cursor.move_to(ON_ROAD)
    assert "another reference system" in user.view.words()
    user.view.close()


def test_what_is_hidden_in_one_image_is_shown_in_another(
    qtbot: QtBot, tmp_path: Path, photographed: Drive
) -> None:
    # The first camera is nearer but a wall stands between it and the place.
    inside = looking(tmp_path / "a_0000.png", (-10.0, -1.0, 2.0), (1.0, 0.0, -0.2))
    far = looking(tmp_path / "b_0000.png", (3.5, -1.0, 2.0), (-1.0, 0.0, -0.1))
    for image in (inside, far):
        photograph(image)
    drive = with_images(tmp_path, photographed, (inside, far))
    user = shown(qtbot, OpenMap((drive,)))
    position = position_at(-7.0, -1.0, 1.0)
    user.map.shared.cursor.move_to(position)
    assert user.name == "a_0000"
    qtbot.waitUntil(lambda: user.name == "b_0000", timeout=30_000)
    sightings = user.view.showing.sightings
    assert [one.is_hidden for one in sightings if one.image == inside] == [True]
    user.view.close()


def test_projects_that_are_closed_leave_nothing_shown(user: CameraViewUser) -> None:
    user.look_at(ON_ROAD)
    user.map.all_drives = ()
    user.map.shared.cursor.clear()
    user.map.shared.map_changes.drives_changed.emit()
    assert user.view.projection() is None
    assert user.name == ""
