"""The camera and its projection: what stays in place, stays to the pixel."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPointF

from widgets.scene_view.camera_controller import CameraController
from widgets.scene_view.rendering import overviews
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.rendering.projection import SceneProjection

CAMERA = SceneCamera((3.0, -20.0, 8.0), heading_deg=15.0, pitch_deg=-25.0, distance_m=25.0)
POSITION = np.array([6.0, 2.0, 1.0])


def pixel(camera: SceneCamera, position: np.ndarray) -> np.ndarray:
    return SceneProjection(camera, 800, 600).to_screen(position[None])[0][0]


def test_what_it_looks_at_is_in_the_middle() -> None:
    assert pixel(CAMERA, CAMERA.focal_point) == pytest.approx([400, 300])


def test_a_camera_to_the_north_has_the_east_on_its_right() -> None:
    camera = SceneCamera((0.0, 0.0, 0.0), heading_deg=0.0, pitch_deg=0.0)
    x, y = pixel(camera, np.array([1.0, 10.0, 2.0]))
    assert x > 400
    assert y < 300


@given(st.floats(-170, 170), st.floats(-60, 60))
def test_orbiting_keeps_the_pivot_at_its_pixel(right_deg: float, up_deg: float) -> None:
    turned = CAMERA.orbited(POSITION, right_deg, up_deg)
    assert pixel(turned, POSITION) == pytest.approx(pixel(CAMERA, POSITION), abs=1e-6)


@given(st.floats(0.2, 5.0))
def test_zooming_keeps_the_pivot_at_its_pixel(factor: float) -> None:
    zoomed = CAMERA.zoomed(POSITION, factor)
    assert pixel(zoomed, POSITION) == pytest.approx(pixel(CAMERA, POSITION), abs=1e-6)


def test_zooming_in_never_passes_the_pivot() -> None:
    camera = CAMERA
    for _ in range(100):
        camera = camera.zoomed(POSITION, 1.5)
    assert SceneProjection(camera, 800, 600).in_view(POSITION[None])[0, 2] > 0


def test_orbiting_stops_at_straight_down() -> None:
    assert CAMERA.orbited(POSITION, 0.0, -300.0).pitch_deg == -90.0


def test_a_place_put_in_the_middle_is_seen_from_the_same_side() -> None:
    moved = CAMERA.centred_on(POSITION, 12.0)
    assert pixel(moved, POSITION) == pytest.approx([400, 300])
    assert (moved.heading_deg, moved.pitch_deg) == (CAMERA.heading_deg, CAMERA.pitch_deg)
    assert np.linalg.norm(np.array(moved.position) - POSITION) == pytest.approx(12.0)


def test_a_pixel_and_a_depth_lead_back_to_the_place() -> None:
    projection = SceneProjection(CAMERA, 800, 600)
    pixels, depth = projection.to_screen(POSITION[None])
    x, y = pixels[0].tolist()
    assert projection.position_at(x, y, float(depth[0])) == pytest.approx(POSITION)


def test_a_place_behind_the_camera_has_no_pixel() -> None:
    behind = np.array(CAMERA.position) - CAMERA.axes[2]
    assert np.isnan(pixel(CAMERA, behind)).all()


def test_a_segment_that_leads_behind_the_camera_is_cut_off_in_front_of_it() -> None:
    projection = SceneProjection(CAMERA, 800, 600)
    forward, right = CAMERA.axes[2], CAMERA.axes[0]
    start = np.array(CAMERA.position) + 10 * forward
    end = np.array(CAMERA.position) - 10 * forward + 4 * right
    (line,) = projection.segments_on_screen(np.stack([start, end]), np.array([[0, 1]]))
    assert line[0] == pytest.approx([400, 300])
    assert np.isfinite(line[1]).all()
    assert line[1, 0] > 400


def test_a_segment_behind_the_camera_is_not_seen() -> None:
    projection = SceneProjection(CAMERA, 800, 600)
    behind = np.array(CAMERA.position) - np.array([[1.0], [5.0]]) * CAMERA.axes[2]
    (line,) = projection.segments_on_screen(behind, np.array([[0, 1]]))
    assert np.isnan(line).all()


@given(st.floats(-400, 400), st.floats(-400, 400))
def test_a_drag_about_a_place_on_the_ground_leads_no_eye_below_it(
    right_px: float, down_px: float
) -> None:
    controller = CameraController()
    controller.begin(QPointF(400.0, 300.0), POSITION, turns=True)
    projection = SceneProjection(CAMERA, 800, 600)
    turned = controller.dragged(projection, QPointF(400.0 + right_px, 300.0 + down_px))
    assert turned.position[2] >= POSITION[2]
    assert pixel(turned, POSITION) == pytest.approx(pixel(CAMERA, POSITION), abs=1e-6)


def test_who_stands_lower_than_a_place_may_turn_about_it_as_before() -> None:
    roof = np.array([6.0, 2.0, 30.0])
    controller = CameraController()
    controller.begin(QPointF(400.0, 300.0), roof, turns=True)
    turned = controller.dragged(SceneProjection(CAMERA, 800, 600), QPointF(400.0, 340.0))
    assert turned.pitch_deg != CAMERA.pitch_deg


@given(st.floats(-30, 30), st.floats(-30, 80), st.floats(-10, 20))
def test_no_eye_beside_the_path_is_led_below_the_road(
    east_m: float, north_m: float, up_m: float
) -> None:
    way = np.column_stack([np.zeros(50), np.arange(50.0), np.linspace(2.0, 3.0, 50)])
    camera = replace(CAMERA, position=(east_m, north_m, up_m))
    lifted = overviews.above_ground(camera, way)
    assert lifted.position[:2] == (east_m, north_m)
    near = np.hypot(*(way[:, :2] - [east_m, north_m]).T)
    if near.min() <= 20.0:
        assert lifted.position[2] > way[near.argmin(), 2] - 2.0
    else:
        assert lifted == camera
    if up_m >= 2.0:
        assert lifted == camera


def test_at_first_the_eye_is_above_the_street_and_looks_along_it() -> None:
    way = np.column_stack([np.zeros(100), np.arange(100.0), np.full(100, 2.0)])
    camera = overviews.along_path(way)
    assert camera.position == pytest.approx((0.0, 8.0, 6.0))
    assert camera.heading_deg == pytest.approx(0.0)
    assert camera.focal_point == pytest.approx([0.0, 30.0, 0.0])
