"""Depth pictures of the synthetic street: what is in front is known exactly."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.cameras.depth import DepthPicture
from processing.core.errors import Cancelled
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.image_list import CameraImage, ProjectionName
from processing.recording.drive import Drive
from tests.builders import START
from tests.camera_scene import looking, seen_by
from tests.processing.image.recordings import drive_of, simulated_drive
from tests.street_scene import POLE_AT_M, POLE_RADIUS_M, WALL_AT_M

LEFT_POLE = START + np.array([-POLE_AT_M, 2.0, 0.0])


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    street = simulated_drive(3, pulses_per_revolution=1000.0)
    return drive_of(street, tmp_path_factory.mktemp("depth") / "d")


def camera_at(
    ahead: tuple[float, float, float], projection: ProjectionName = "perspective"
) -> CameraImage:
    return looking(Path("a.jpg"), (-0.5, 2.0, 2.0), ahead, projection=projection)


def test_nearly_all_of_the_picture_is_as_far_away_as_it_is(drive: Drive) -> None:
    image = camera_at((-1.0, -0.4, -0.2))
    picture = DepthPicture(image, [drive])
    rows, columns = np.indices(picture.front_m.shape)
    middles = (np.column_stack([columns.ravel(), rows.ravel()]) + 0.5) * picture.cell_px
    true, surface = seen_by(image, middles)
    found = picture.front_m.ravel()
    is_measured = np.isfinite(found) & np.isfinite(true) & (surface <= 3) & (true < 12)
    assert is_measured.sum() > 4000
    off = np.abs(found[is_measured] - true[is_measured])
    assert np.percentile(off, 90) < 0.25


def test_a_pole_hides_the_wall_behind_it_and_nothing_beside(drive: Drive) -> None:
    image = camera_at((-1.0, 0.0, 0.0))
    picture = DepthPicture(image, [drive])
    way = LEFT_POLE - image.xyz
    behind = START + np.array([-WALL_AT_M, 2.0, 1.5])
    beside = behind + np.array([[0, 0.8, 0], [0, -0.8, 0]])
    before = np.array(image.xyz) + 0.6 * way
    before[2] = START[2] + 1.5
    on_pole = LEFT_POLE + np.array([POLE_RADIUS_M, 0.0, 1.5])
    hidden = picture.hides(np.vstack([behind, beside, before, on_pole]))
    assert hidden.tolist() == [True, False, False, False, False]


def test_measured_points_in_sight_are_not_hidden_by_their_own_surface(drive: Drive) -> None:
    image = camera_at((0.2, 1.0, -0.3))
    picture = DepthPicture(image, [drive])
    points = drive.xyz(slice(0, drive.count, 7))
    camera = Camera(image)
    pixels = camera.pixels_of(points)
    ranges = camera.distances_to(points)
    true, _ = seen_by(image, np.nan_to_num(pixels))
    is_front = camera.shows(pixels) & (np.abs(true - ranges) < 0.03) & (ranges > 2)
    assert is_front.sum() > 1000
    assert picture.hides(points[is_front]).mean() < 0.01


def test_a_road_seen_at_a_flat_angle_doesnt_hide_itself(tmp_path: Path) -> None:
    drive = drive_of(simulated_drive(5, length_m=30.0, range_noise_m=0.006), tmp_path / "d")
    image = looking(Path("a.jpg"), (-0.5, 0.0, 2.2), (0.0, 1.0, 0.0), focal_px=400.0)
    picture = DepthPicture(image, [drive])
    points = drive.xyz(slice(0, drive.count))
    east, north, up = (points - START).T
    is_road = (np.abs(east) < 3.8) & (up < 0.02) & (north > 12) & (north < 26)
    assert is_road.sum() > 2000
    assert picture.hides(points[is_road]).mean() < 0.02


@pytest.mark.parametrize("projection", ["perspective", "equirectangular"])
def test_a_click_goes_to_the_surface_that_the_pixel_shows(
    drive: Drive, projection: ProjectionName
) -> None:
    image = camera_at((-1.0, -0.1, -0.1), projection)
    picture = DepthPicture(image, [drive])
    on_pole = LEFT_POLE + np.array([POLE_RADIUS_M, 0.0, 1.8])
    beside = START + np.array([-WALL_AT_M, 0.5, 1.8])
    for position, off_m in ((on_pole, 0.12), (beside, 0.25)):
        pixel = Camera(image).pixels_of(position[None])[0]
        found = picture.point_at((float(pixel[0]), float(pixel[1])))
        assert found is not None
        assert found.drive == drive.id
        np.testing.assert_array_equal(drive.xyz(np.array([found.point]))[0], found.xyz)
        assert np.linalg.norm(np.array(found.xyz) - position) < off_m


def test_a_quick_look_finds_the_same_surface(drive: Drive) -> None:
    image = camera_at((-1.0, -0.1, -0.1))
    picture = DepthPicture(image, [drive])
    pixel = Camera(image).pixels_of(START[None] + np.array([-WALL_AT_M, 0.5, 1.8]))[0]
    found = picture.quick_point_at((float(pixel[0]), float(pixel[1])))
    assert found is not None
    assert found.xyz[0] == pytest.approx(START[0] - WALL_AT_M, abs=0.1)


def test_the_sky_and_places_outside_the_image_have_no_point(drive: Drive) -> None:
    picture = DepthPicture(camera_at((0.0, 1.0, 1.5)), [drive])
    assert picture.point_at((200.0, 5.0)) is None
    assert picture.quick_point_at((200.0, 5.0)) is None
    assert picture.quick_point_at((-30.0, 5.0)) is None


def test_the_vehicle_itself_and_what_moved_hide_nothing(tmp_path: Path) -> None:
    street = simulated_drive(3)
    moving = np.abs(street.xyz[:, 0] - (START[0] - WALL_AT_M)) < 0.2
    street.columns["classification"][moving] = 64
    drive = drive_of(street, tmp_path / "d")
    picture = DepthPicture(camera_at((-1.0, 0.0, 0.0)), [drive])
    shown = picture.point_at((200.0, 120.0))
    assert shown is None or shown.xyz[0] > START[0] - WALL_AT_M + 0.5
    close = looking(Path("a.jpg"), (-WALL_AT_M + 1.0, 5.0, 2.0), (-1.0, 0.0, 0.0))
    assert not np.isfinite(DepthPicture(close, [drive]).front_m[40:60, 90:110]).any()


def test_far_from_every_drive_nothing_is_measured(drive: Drive) -> None:
    image = looking(Path("a.jpg"), (5000.0, 0.0, 2.0), (0.0, 1.0, 0.0))
    picture = DepthPicture(image, [drive])
    assert picture.is_empty
    assert picture.point_at((200.0, 200.0)) is None
    assert not picture.hides(START[None]).any()


def test_it_can_be_stopped_between_tiles(drive: Drive) -> None:
    def stop() -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        DepthPicture(camera_at((-1.0, 0.0, 0.0)), [drive], check=stop)
