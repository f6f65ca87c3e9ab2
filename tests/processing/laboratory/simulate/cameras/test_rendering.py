"""Pictures of simulated things: where they are in them, and what light they stand in."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.laboratory.simulate.cameras.daylight import Daylight, daylight_of
from processing.laboratory.simulate.cameras.grain_kernels import _grain_kernel, grain
from processing.laboratory.simulate.cameras.rendering import directions_of, render_image
from processing.laboratory.simulate.cameras.rigs import Pose, RigCamera, image_of
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, MeshBuilder, box, plate
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.image_list import CameraImage

BARREL = (-0.32, 0.09, 0.004, -0.003, 0.0)
FRONT = RigCamera("front", (0.8, 0.1, 0.2), 14.0, -6.0, 3.0, 240.0, 161.3, 118.2, 320, 240)
LENSES = {
    "plain": FRONT,
    "barrel": replace(FRONT, distortion=BARREL),
    "panorama": RigCamera(
        "panorama", (0, 0, 0.4), 3.0, -2.0, 1.0, 800 / 2 / np.pi, 399.5, 199.5, 800, 400,
        projection="equirectangular",
    ),
}  # fmt: skip
CLEAR = Daylight(np.array([0.0, -0.6, 0.8]), 1.2, 0.0)


def pose_at(position: tuple[float, float, float]) -> Pose:
    """The vehicle level at a place, looking north-east."""
    c = np.sqrt(0.5)
    turn = np.array([[c, -c, 0.0], [c, c, 0.0], [0.0, 0.0, 1.0]])
    return Pose(3.0, np.array(position), turn, np.zeros(3), 0.0)


def disc(middle: Floats, towards: Floats, radius: float) -> tuple[Floats, Floats]:
    normal = towards / np.linalg.norm(towards)
    across = np.cross(normal, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    upward = np.cross(across, normal)
    return middle + radius * (np.cos(angles)[:, None] * across + np.sin(angles)[:, None] * upward)


@pytest.mark.parametrize("lens", LENSES)
def test_a_plate_is_seen_where_the_camera_model_says(lens: str) -> None:
    image = image_of(LENSES[lens], pose_at((4.0, -2.0, 11.0)), Path("one.jpg"))
    centre = np.array(image.xyz)
    for share in ((0.5, 0.5), (0.12, 0.15), (0.8, 0.8)):
        pixel = np.array([[share[0] * image.width_px, share[1] * image.height_px]])
        direction = Camera(image).rays_of(pixel)[0]
        middle = centre + 9.0 * direction
        builder = MeshBuilder()
        builder.add(plate(disc(middle, -direction, 0.25)), Material.RUBBER, 65, 1)
        scene = RaycastScene(builder.mesh(), centre)
        picture, empty = (
            render_image(image, scenes, CLEAR, np.random.default_rng(0)).astype(float).sum(2)
            for scenes in ([scene], [])
        )
        changed = np.abs(picture - empty)
        rows, columns = np.nonzero(changed > 0.2 * changed.max())
        weight = changed[rows, columns]
        seen = np.array([columns @ weight, rows @ weight]) / weight.sum()
        assert np.abs(seen - Camera(image).pixels_of(middle[None])[0]).max() < 0.35


def test_pixels_look_where_the_camera_model_says() -> None:
    image = image_of(LENSES["barrel"], pose_at((1.0, 2.0, 3.0)), Path("one.jpg"))
    positions = np.array(image.xyz) + 20.0 * directions_of(image)[::37]
    numbers = np.arange(image.width_px * image.height_px)[::37]
    wanted = np.column_stack([numbers % image.width_px, numbers // image.width_px])
    assert np.abs(Camera(image).pixels_of(positions) - wanted).max() < 0.05


def test_ground_behind_a_wall_lies_in_its_shadow() -> None:
    builder = MeshBuilder()
    builder.add(
        plate(np.array([[-50, -50, 0], [50, -50, 0], [50, 50, 0], [-50, 50, 0.0]])),
        Material.CONCRETE, 2, 0,
    )  # fmt: skip
    builder.add(box((-20, -0.2, 0), (20, 0.2, 3)), Material.CONCRETE, 1, 1)
    camera = replace(FRONT, yaw_deg=0.0, pitch_deg=-89.0, focal_px=120.0)
    image = image_of(camera, pose_at((0.0, 0.0, 20.0)), Path("one.jpg"))
    scene = RaycastScene(builder.mesh(), np.zeros(3))
    picture = render_image(image, [scene], CLEAR, np.random.default_rng(0)).astype(float).mean(2)
    pixels = Camera(image).pixels_of(np.array([[0.0, 1.2, 0.0], [0.0, 6.0, 0.0]])).round()
    dark, bright = (picture[int(row), int(column)] for column, row in pixels)
    assert dark < 0.8 * bright


def test_a_speed_limit_has_a_red_ring_and_a_white_middle() -> None:
    image = image_of(FRONT, pose_at((0.0, 0.0, 5.0)), Path("one.jpg"))
    direction = -Camera(image).rotation[2]
    middle = np.array(image.xyz) + 2.0 * direction
    for instance in range(1, 40):
        builder = MeshBuilder()
        builder.add(plate(disc(middle, -direction, 0.3)), Material.SIGN_FACE, 65, instance, piece=1)
        scene = RaycastScene(builder.mesh(), middle)
        picture = render_image(image, [scene], CLEAR, np.random.default_rng(0)).astype(int)
        column, row = Camera(image).pixels_of(middle[None])[0].round().astype(int)
        if picture[row, column].min() > 120:
            break
    ring = picture[row - round(0.86 * 0.3 / 2 * 240), column]
    assert ring[0] > ring[1] + 60
    assert ring[0] > ring[2] + 60


def test_grain_is_the_same_as_in_plain_python_and_changes_smoothly() -> None:
    positions = np.random.default_rng(1).uniform(-50, 50, (40, 3))
    plain = np.empty(40, np.float32)
    _grain_kernel.py_func(positions, 1 / 0.3, plain)
    noise = grain(positions, 0.3)
    np.testing.assert_allclose(noise, plain, atol=1e-6)
    assert np.abs(grain(positions + 1e-4, 0.3) - noise).max() < 0.01
    assert np.abs(noise).max() <= 1.0


def test_a_seed_has_one_daylight() -> None:
    one, other = daylight_of(5), daylight_of(5)
    np.testing.assert_array_equal(one.sun, other.sun)
    assert one.strength == other.strength
    assert one.sun[2] > 0.3
    assert isinstance(image_of(FRONT, pose_at((0, 0, 0)), Path("x.jpg")), CameraImage)
