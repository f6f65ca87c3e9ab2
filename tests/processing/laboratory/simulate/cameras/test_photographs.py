"""Photographs as files: the list is what the program reads, names don't clash, poses are even."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import Cancelled
from processing.core.monitor import SilentMonitor
from processing.formats.trajectories.image_list import read_image_list
from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.cameras.photographs import (
    DeliveryFrame,
    write_image_list,
    write_images,
)
from processing.laboratory.simulate.cameras.rigs import (
    Pose,
    RigCamera,
    image_of,
    poses_of_pass,
    rig_of,
)
from processing.laboratory.simulate.cameras.seen_street import SeenStreet
from processing.laboratory.simulate.scanning.simulated_passes import Driving, pass_of
from processing.laboratory.simulate.street.styles import RURAL
from processing.recording.camera_images.camera import Camera
from tests.monitors import CancelledAfter

SMALL = (
    RigCamera("front", (0.8, 0, 0.2), 0, -5, 0.3, 60, 39.5, 29.5, 80, 60, (-0.1, 0.01, 0, 0, 0)),
    RigCamera("left", (0.3, 0.4, 0.2), 70, -5, 0, 60, 39.5, 29.5, 80, 60),
)
ORIGIN = np.array([-11_400.0, -35_100.0, 120.0])


@pytest.fixture(scope="module")
def poses() -> list[Pose]:
    street = Street(3, RURAL, 40.0)
    return poses_of_pass(pass_of(street, 0, Driving(10.0, stops=True, drift_m=0.02)))


def test_the_list_is_read_back_as_it_was_written(tmp_path: Path, poses: list[Pose]) -> None:
    written = write_images(
        tmp_path, poses[:2], lambda pose: [], SilentMonitor(),
        seed=3, rig=SMALL, frame=DeliveryFrame(ORIGIN, 376_892_000.0),
    )  # fmt: skip
    write_image_list(tmp_path / "images.csv", written)
    read = read_image_list(tmp_path / "images.csv")
    assert len(read) == 4
    for one, other in zip(written, read, strict=True):
        assert other.path == one.path
        assert other.path.read_bytes()[:3] == b"\xff\xd8\xff"
        assert other.distortion == pytest.approx(one.distortion)
        np.testing.assert_allclose(other.xyz, one.xyz, atol=1e-4)
        turned = Camera(other).rotation @ Camera(one).rotation.T
        np.testing.assert_allclose(turned, np.eye(3), atol=1e-7)


def test_delivered_places_are_off_by_the_trajectorys_error(
    tmp_path: Path, poses: list[Pose]
) -> None:
    pose = poses[1]
    written = write_images(
        tmp_path, [pose], lambda one: [], SilentMonitor(),
        seed=3, rig=SMALL[:1], frame=DeliveryFrame(ORIGIN, 100.0, "pass2_"),
    )  # fmt: skip
    true = image_of(SMALL[0], pose, Path("x.jpg"))
    np.testing.assert_allclose(np.array(written[0].xyz) - ORIGIN - true.xyz, pose.error, atol=1e-9)
    assert written[0].time_s == pose.time_s + 100.0
    assert written[0].path.name == "pass2_front_0000.jpg"


def test_the_same_seed_gives_the_same_bytes_and_a_street_is_in_them(
    tmp_path: Path, poses: list[Pose]
) -> None:
    contents, street = [], Street(3, RURAL, 40.0)
    for name in ("one", "other"):
        seen = SeenStreet(street, [], SilentMonitor().check)
        write_images(
            tmp_path / name, poses[:1], seen.at, SilentMonitor(),
            seed=3, rig=SMALL[:1], frame=DeliveryFrame(ORIGIN, 0.0),
        )  # fmt: skip
        contents.append((tmp_path / name / "images" / "front_0000.jpg").read_bytes())
    assert contents[0] == contents[1]


def test_taking_photographs_can_be_stopped(tmp_path: Path, poses: list[Pose]) -> None:
    with pytest.raises(Cancelled):
        write_images(
            tmp_path, poses, lambda one: [], CancelledAfter(2),
            seed=3, rig=SMALL, frame=DeliveryFrame(ORIGIN, 0.0),
        )  # fmt: skip


def test_poses_are_ten_metres_apart_and_none_is_taken_at_rest(poses: list[Pose]) -> None:
    at = np.array([one.chainage_m for one in poses])
    np.testing.assert_allclose(np.diff(at), 10.0, atol=0.3)


def test_every_camera_of_a_rig_is_upright_and_its_lens_sees_each_place_once() -> None:
    pose = Pose(0.0, np.zeros(3), np.eye(3), np.zeros(3), 0.0)
    names = set()
    for seed in range(30):
        for camera in rig_of(seed):
            image = image_of(camera, pose, Path("x.jpg"))
            names.add(camera.name)
            assert Camera(image).rotation[1, 2] > 0.9
            corner = np.array([[0.0, 0.0], [image.width_px - 1.0, image.height_px - 1.0]])
            rays = Camera(image).rays_of(corner)
            back = Camera(image).pixels_of(np.array(image.xyz) + 5 * rays)
            np.testing.assert_allclose(back, corner, atol=0.1)
    assert names == {"front", "left", "right", "panorama"}
