"""Offsets of a camera turn, move and delay it, and are found again from pairs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import BadFile, Unsuitable
from processing.recording.camera_images.calibration import (
    CameraOffset,
    PixelPair,
    angles_of,
    apply_offset,
    apply_offsets,
    camera_of,
    estimate_offset,
    residuals_px,
)
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.image_list import CameraImage, ImageList
from processing.recording.camera_images.image_store import write_images
from processing.recording.camera_images.offset_store import read_offsets, write_offsets
from processing.recording.drive import Drive
from processing.recording.vehicle_path.trajectory import Trajectory
from tests.builders import START
from tests.camera_scene import looking
from tests.processing.image.recordings import small_drive

IMAGE = looking(Path("front_0001.jpg"), (0.0, 0.0, 2.0), (0.3, 1.0, -0.1), time_s=10.0)
AHEAD = np.array([IMAGE.xyz]) + 10 * Camera(IMAGE).rays_of([[IMAGE.cx_px, IMAGE.cy_px]])
MIDDLE = np.array([IMAGE.cx_px, IMAGE.cy_px])


@pytest.mark.parametrize(
    ("offset", "moved"),
    [
        (CameraOffset(yaw_deg=1.0), (-1.0, 0.0)),
        (CameraOffset(pitch_deg=1.0), (0.0, 1.0)),
        (CameraOffset(right_m=0.5), (-1.0, 0.0)),
        (CameraOffset(up_m=0.5), (0.0, 1.0)),
    ],
)
def test_what_the_camera_does_the_picture_does_the_other_way(
    offset: CameraOffset, moved: tuple[float, float]
) -> None:
    pixel = Camera(apply_offset(IMAGE, offset, None)).pixels_of(AHEAD)[0] - MIDDLE
    assert np.linalg.norm(pixel) > 4
    np.testing.assert_allclose(pixel / np.linalg.norm(pixel), moved, atol=1e-6)


def test_a_camera_whose_right_side_goes_down_turns_the_picture_anticlockwise() -> None:
    above = AHEAD + np.array([0.0, 0.0, 1.0])
    pixel = Camera(apply_offset(IMAGE, CameraOffset(roll_deg=5.0), None)).pixels_of(above)[0]
    assert pixel[0] < MIDDLE[0] - 1


def test_going_forward_makes_things_nearer() -> None:
    moved = apply_offset(IMAGE, CameraOffset(forward_m=4.0), None)
    assert Camera(moved).distances_to(AHEAD)[0] == pytest.approx(6.0)
    np.testing.assert_allclose(Camera(moved).pixels_of(AHEAD)[0], MIDDLE, atol=1e-6)


@pytest.mark.parametrize("ahead", [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.1, 0.2, -0.9)])
def test_angles_of_a_rotation_give_the_rotation_back(ahead: tuple[float, float, float]) -> None:
    rotation = Camera(looking(Path("a.jpg"), (0.0, 0.0, 0.0), ahead)).rotation
    omega, phi, kappa = angles_of(rotation).tolist()
    again = replace(IMAGE, omega_deg=omega, phi_deg=phi, kappa_deg=kappa)
    np.testing.assert_allclose(Camera(again).rotation, rotation, atol=1e-12)


def curve() -> Trajectory:
    time = np.linspace(0.0, 20.0, 401)
    angle = 0.05 * time
    xyz = START + np.column_stack([100 * (1 - np.cos(angle)), 100 * np.sin(angle), 0 * time])
    angles = np.column_stack([0 * time, 0 * time, np.degrees(angle)])
    return Trajectory(time, xyz, angles, has_attitude=True)


def test_time_moves_and_turns_the_camera_with_the_vehicle() -> None:
    road = curve()
    moved = apply_offset(IMAGE, CameraOffset(time_s=2.0), road)
    assert moved.time_s == 12.0
    times = np.array([10.0, 12.0])
    turns, positions = road.rotations_at(times), road.positions_at(times)
    before = turns[0].T @ (np.array(IMAGE.xyz) - positions[0])
    after = turns[1].T @ (np.array(moved.xyz) - positions[1])
    np.testing.assert_allclose(after, before, atol=1e-9)
    np.testing.assert_allclose(
        Camera(moved).rotation @ turns[1], Camera(IMAGE).rotation @ turns[0], atol=1e-9
    )


def test_time_has_no_effect_where_the_trajectory_has_ended() -> None:
    late = replace(IMAGE, time_s=19.5)
    found = apply_offset(late, CameraOffset(time_s=2.0), curve())
    assert (found.time_s, found.xyz) == (late.time_s, late.xyz)
    np.testing.assert_allclose(Camera(found).rotation, Camera(late).rotation, atol=1e-12)


def test_cameras_are_told_apart_by_their_names_without_numbers() -> None:
    named = {
        "images/front_0012.jpg": "front",
        "images/20260401_101500_cam2.jpg": "cam2",
        "panorama/000123.jpg": "panorama",
        "写真/前方カメラ-00012.jpg": "前方カメラ",
    }
    for path, camera in named.items():
        assert camera_of(replace(IMAGE, path=Path(path))) == camera


def test_an_offset_touches_its_own_camera_only() -> None:
    left = replace(IMAGE, path=Path("left_0001.jpg"))
    found = apply_offsets(ImageList((IMAGE, left)), {"left": CameraOffset(yaw_deg=1.0)}, None)
    assert found[0] is IMAGE
    assert found[1].kappa_deg != left.kappa_deg


def pairs(true: CameraOffset, count: int, noise_px: float = 0.0) -> list[PixelPair]:
    random = np.random.default_rng(4)
    image = apply_offset(IMAGE, true, None)
    pixels = random.uniform((20, 20), (380, 280), (count, 2))
    rays = Camera(image).rays_of(pixels)
    xyz = np.array(image.xyz) + random.uniform(4, 30, (count, 1)) * rays
    return [
        PixelPair(IMAGE, tuple(pixel), tuple(position))
        for pixel, position in zip(
            (pixels + random.normal(0, noise_px, pixels.shape)).tolist(), xyz.tolist(), strict=True
        )
    ]


def test_rotation_is_found_from_few_pairs() -> None:
    true = CameraOffset(roll_deg=0.8, pitch_deg=-1.5, yaw_deg=2.0)
    found = estimate_offset(pairs(true, 3))
    assert not found.has_shift
    assert found.rms_px < 1e-4
    assert found.offset.roll_deg == pytest.approx(0.8, abs=1e-4)
    assert found.offset.pitch_deg == pytest.approx(-1.5, abs=1e-4)
    assert found.offset.yaw_deg == pytest.approx(2.0, abs=1e-4)


def test_rotation_and_shift_are_found_from_more_and_residuals_are_the_noise() -> None:
    true = CameraOffset(0.8, -1.5, 2.0, right_m=0.12, up_m=-0.05, forward_m=0.3)
    noisy = pairs(true, 40, noise_px=0.5)
    found = estimate_offset(noisy)
    assert found.has_shift
    assert found.rms_px == pytest.approx(0.5 * np.sqrt(2), rel=0.25)
    assert found.offset.right_m == pytest.approx(0.12, abs=0.05)
    np.testing.assert_allclose(residuals_px(noisy, found.offset, None), found.residuals_px)


def test_one_pair_is_too_few_and_one_place_determines_nothing() -> None:
    (pair,) = pairs(CameraOffset(), 1)
    with pytest.raises(Unsuitable, match="too few"):
        estimate_offset([pair])
    with pytest.raises(Unsuitable, match="too close"):
        estimate_offset([pair] * 3)


def test_offsets_are_kept_beside_the_drive_and_count_everywhere(tmp_path: Path) -> None:
    drive = small_drive(tmp_path / "d")[0]
    image = replace(IMAGE, path=tmp_path / IMAGE.path)
    write_images(drive.folder, ImageList((image,)))
    drive = Drive(drive.folder)
    assert drive.images == ImageList((image,))
    drive.keep_camera_offsets({"front": CameraOffset(yaw_deg=1.0), "left": CameraOffset()})
    for opened in (drive, Drive(drive.folder)):
        assert opened.images is not None
        assert opened.images[0].kappa_deg != IMAGE.kappa_deg
        assert opened.delivered_images == ImageList((image,))
    assert set(Drive(drive.folder).camera_offsets) == {"front"}


def test_a_folder_without_offsets_has_none(tmp_path: Path) -> None:
    assert read_offsets(tmp_path) == {}
    write_offsets(tmp_path, {})
    assert read_offsets(tmp_path) == {}


@pytest.mark.parametrize(
    "text", ["{", "[]", '{"a": {"yaw": 1}}', '{"a": {"yaw_deg": "x"}}', "\xff"]
)
def test_damaged_offsets_say_what_to_do(tmp_path: Path, text: str) -> None:
    (tmp_path / "camera_offsets.json").write_bytes(text.encode("latin-1"))
    with pytest.raises(BadFile) as refusal:
        read_offsets(tmp_path)
    assert "Delete this file" in refusal.value.remedy.en


def test_an_image_is_a_plain_value(tmp_path: Path) -> None:
    assert isinstance(apply_offset(IMAGE, CameraOffset(roll_deg=1.0), None), CameraImage)
