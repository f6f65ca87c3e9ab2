"""Ground points fall on the pixels that the photogrammetric formulas say, and back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.image_list import CameraImage, ImageList, ProjectionName

_IMAGE = CameraImage(
    path=Path("a.jpg"),
    time_s=0.0,
    xyz=(100.0, 200.0, 50.0),
    omega_deg=0.0,
    phi_deg=0.0,
    kappa_deg=0.0,
    focal_px=500.0,
    cx_px=400.0,
    cy_px=300.0,
    width_px=800,
    height_px=600,
)
_DISTORTED = replace(_IMAGE, distortion=(-0.2, 0.05, 0.001, -0.002, 0.0))


def test_a_camera_without_rotation_looks_down_with_north_at_the_top() -> None:
    pixels = Camera(_IMAGE).pixels_of(
        [[100, 200, 40], [101, 200, 40], [100, 201, 40], [100, 200, 60]]
    )
    np.testing.assert_allclose(pixels[:3], [[400, 300], [450, 300], [400, 250]])
    assert np.isnan(pixels[3]).all()


@pytest.mark.parametrize(
    ("angles", "ahead"),
    [((90, 0, 0), (0, 1, 0)), ((90, -90, 0), (1, 0, 0)), ((0, -90, -90), (1, 0, 0))],
)
def test_the_middle_of_the_image_looks_where_the_angles_say(
    angles: tuple[float, float, float], ahead: tuple[float, float, float]
) -> None:
    image = replace(_IMAGE, omega_deg=angles[0], phi_deg=angles[1], kappa_deg=angles[2])
    camera = Camera(image)
    np.testing.assert_allclose(camera.rays_of([[400, 300]])[0], ahead, atol=1e-12)
    above = np.array(image.xyz) + 10 * np.array(ahead) + [0, 0, 1]
    column, row = camera.pixels_of([above])[0]
    np.testing.assert_allclose(camera.pixels_of([above - [0, 0, 1]])[0], [400, 300], atol=1e-9)
    assert np.hypot(column - 400, row - 300) == pytest.approx(50.0)


def test_kappa_turns_the_ground_clockwise_in_the_image() -> None:
    camera = Camera(replace(_IMAGE, kappa_deg=90.0))
    np.testing.assert_allclose(camera.pixels_of([[101, 200, 40]]), [[400, 350]], atol=1e-9)


def test_a_panorama_shows_all_directions() -> None:
    image = replace(
        _IMAGE, projection="equirectangular", width_px=3600, height_px=1800, cx_px=1800, cy_px=900
    )
    camera = Camera(replace(image, omega_deg=90.0))
    away = np.array([[0, 5, 0], [5, 0, 0], [-5, 0, 0], [0, 5, 5], [0, 0, -5]])
    ground = away + image.xyz
    pixels = camera.pixels_of(ground)
    wanted = [[1800, 900], [2700, 900], [900, 900], [1800, 450]]
    np.testing.assert_allclose(pixels[:4], wanted, atol=1e-9)
    assert pixels[4, 1] == pytest.approx(1800)


@pytest.mark.parametrize("image", [_IMAGE, _DISTORTED])
@pytest.mark.parametrize("projection", ["perspective", "equirectangular"])
def test_rays_lead_back_to_the_ground_points(
    image: CameraImage, projection: ProjectionName
) -> None:
    turned = replace(image, omega_deg=80.0, phi_deg=30.0, kappa_deg=-170.0, projection=projection)
    camera = Camera(turned)
    columns, rows = np.meshgrid(np.linspace(20, 780, 20), np.linspace(20, 580, 20))
    pixels = np.column_stack([columns.ravel(), rows.ravel()])
    ground = np.array(image.xyz) + 30 * camera.rays_of(pixels)
    np.testing.assert_allclose(camera.pixels_of(ground), pixels, atol=1e-6)
    np.testing.assert_allclose(camera.distances_to(ground), 30.0)


def test_distortion_is_that_of_opencv() -> None:
    import cv2

    camera = Camera(_DISTORTED)
    ground = np.array(_IMAGE.xyz) + np.random.default_rng(0).uniform(-4, 4, (50, 3)) - [0, 0, 10]
    # OpenCV's camera has y down and looks along +z.
    seen = (ground - np.array(_IMAGE.xyz)) * [1, -1, -1]
    matrix = np.array([[500.0, 0, 400], [0, 500, 300], [0, 0, 1]])
    k1, k2, p1, p2, k3 = _DISTORTED.distortion
    wanted, _ = cv2.projectPoints(
        seen, np.zeros(3), np.zeros(3), matrix, np.array([k1, k2, p1, p2, k3])
    )
    np.testing.assert_allclose(camera.pixels_of(ground), wanted[:, 0], atol=1e-9)


def test_points_far_aside_are_not_folded_back_by_the_distortion() -> None:
    camera = Camera(replace(_IMAGE, distortion=(-0.3, 0.0, 0.0, 0.0, 0.0)))
    aside = np.array([[100.0 + 10 * s, 200.0, 40.0] for s in (0.5, 1.2, 1.8, 5.0)])
    pixels = camera.pixels_of(aside)
    assert np.isnan(pixels[:, 0]).tolist() == [False, True, True, True]
    assert camera.shows(pixels).tolist() == [True, False, False, False]


def test_a_list_of_images_is_a_sequence() -> None:
    images = ImageList((_IMAGE, _DISTORTED))
    assert (len(images), list(images), images[1]) == (2, [_IMAGE, _DISTORTED], _DISTORTED)
