"""Two lines of sight give a place with its error, or are refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.cameras.stereo import epipolar_line, stereo_position
from processing.core.errors import Unsuitable
from processing.recording.camera_images.camera import Camera
from tests.builders import START
from tests.camera_scene import looking

NORTH = (0.0, 1.0, 0.0)
BENT = (-0.2, 0.05, 0.001, -0.002, 0.0)
POSITION = START + np.array([1.0, 14.0, 3.0])


def cameras(base_m: float = 4.0) -> tuple[Camera, Camera]:
    one = looking(Path("one.jpg"), (0.0, 0.0, 2.0), NORTH, distortion=BENT)
    other = looking(Path("other.jpg"), (base_m, 0.0, 2.0), (-0.1, 1.0, 0.0), focal_px=400.0)
    return Camera(one), Camera(other)


def pixel(camera: Camera, position: np.ndarray = POSITION) -> np.ndarray:
    return camera.pixels_of(position[None])[0]


def test_exact_pixels_give_the_exact_place_at_national_coordinates() -> None:
    one, other = cameras()
    found = stereo_position((one, pixel(one)), (other, pixel(other)))
    np.testing.assert_allclose(found.xyz, POSITION, atol=1e-6)
    assert found.gap_m < 1e-6
    # The base of 4 m is seen from 14 m away, a little aside.
    assert found.angle_deg == pytest.approx(16.3, abs=0.5)


def test_the_foretold_error_is_the_one_that_noise_makes() -> None:
    one, other = cameras()
    random = np.random.default_rng(2)
    exact = pixel(one), pixel(other)
    off = []
    for _ in range(600):
        noisy = [p + random.normal(0, 0.7, 2) for p in exact]
        off.append(stereo_position((one, noisy[0]), (other, noisy[1])).xyz - POSITION)
    found = stereo_position((one, exact[0]), (other, exact[1]), pixel_error_px=0.7)
    spread = np.sqrt((np.array(off) ** 2).sum(axis=1).mean())
    assert found.error_m == pytest.approx(spread, rel=0.15)
    np.testing.assert_allclose(np.cov(np.array(off).T), found.covariance, atol=0.15 * spread**2)


def test_nearly_parallel_lines_are_refused() -> None:
    one, other = cameras(0.1)
    with pytest.raises(Unsuitable, match="parallel"):
        stereo_position((one, pixel(one)), (other, pixel(other)))


def test_lines_that_meet_behind_a_camera_are_refused() -> None:
    one, other = cameras()
    with pytest.raises(Unsuitable, match="don't meet"):
        stereo_position((one, [20.0, 150.0]), (other, [380.0, 150.0]))


def test_lines_that_pass_far_from_each_other_show_different_things() -> None:
    one, other = cameras()
    with pytest.raises(Unsuitable, match="different things"):
        stereo_position((one, pixel(one)), (other, pixel(other) + np.array([0.0, 60.0])))


def test_the_line_of_sight_runs_through_the_same_place_in_the_other_image() -> None:
    one, other = cameras()
    # Seen from the camera without distortion the line is bent in the other one.
    line = epipolar_line(other, pixel(other), one)
    steps = np.linspace(0, 1, 50)[:, None, None]
    dense = (line[:-1] * (1 - steps) + line[1:] * steps).reshape(-1, 2)
    dense = dense[np.isfinite(dense).all(axis=1)]
    assert np.hypot(*(dense - pixel(one)).T).min() < 0.3
