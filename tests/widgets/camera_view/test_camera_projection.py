"""Features lie in the picture where the camera shows them, and end where it ends."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.recording.camera_images.camera import Camera
from tests.builders import START
from tests.camera_scene import looking
from widgets.camera_view.projection import CameraProjection

NORTH = (0.0, 1.0, 0.0)
BENT = (-0.25, 0.06, 0.001, -0.002, 0.0)
ENDS = np.array([[0, 1]])


def line(projection: CameraProjection, *positions: tuple[float, float, float]) -> np.ndarray:
    (found,) = projection.lines_on_plane(START + np.array(positions), ENDS)
    return found


def plain(**changes: object) -> CameraProjection:
    image = looking(Path("a.jpg"), (0.0, 0.0, 2.0), NORTH, **changes)  # type: ignore[arg-type]
    return CameraProjection(image, None)


def test_a_line_in_sight_is_one_straight_piece() -> None:
    projection = plain()
    found = line(projection, (-1.0, 10.0, 2.0), (1.0, 10.0, 3.0))
    np.testing.assert_allclose(
        found, projection.to_plane(START + np.array([[-1, 10, 2], [1, 10, 3]])), atol=1e-9
    )


def test_a_line_that_passes_the_camera_ends_at_the_edge_of_the_image() -> None:
    found = line(plain(), (1.5, 20.0, 0.0), (1.5, -20.0, 0.0))
    assert len(found) == 2
    assert np.isfinite(found).all()
    edges = np.array([-0.5, -0.5]), np.array([399.5, 299.5])
    assert ((found >= edges[0] - 1e-9) & (found <= edges[1] + 1e-9)).all()
    on_edge = np.isclose(found[1], edges[0]) | np.isclose(found[1], edges[1])
    assert on_edge.any()


@pytest.mark.parametrize(
    "positions",
    [
        ((0.0, -5.0, 2.0), (1.0, -9.0, 2.0)),
        ((90.0, 10.0, 2.0), (95.0, 20.0, 2.0)),
        ((0.0, 0.0, 2.0), (0.0, -3.0, 2.0)),
    ],
)
def test_what_is_behind_or_far_aside_is_not_drawn(
    positions: tuple[tuple[float, float, float], ...],
) -> None:
    assert len(line(plain(), *positions)) == 0
    assert len(line(plain(distortion=BENT), *positions)) == 0


def test_the_lens_bends_a_line_as_it_bends_its_places() -> None:
    projection = plain(distortion=BENT)
    start, end = np.array([-6.0, 10.0, 6.5]), np.array([6.0, 14.0, 6.5])
    found = line(projection, tuple(start), tuple(end))
    share = np.linspace(0, 1, 400)[:, None]
    true = Camera(projection.image).pixels_of(START + start + share * (end - start))
    inside = Camera(projection.image).shows(true)
    assert inside.sum() > 100
    for position in true[inside][::20]:
        ways = found[1:] - found[:-1]
        away = position - found[:-1]
        at = np.clip((away * ways).sum(axis=1) / (ways**2).sum(axis=1), 0, 1)
        assert np.hypot(*(away - at[:, None] * ways).T).min() < 0.1


def test_a_line_across_the_seam_of_a_panorama_is_broken_there() -> None:
    projection = plain(projection="equirectangular")
    found = line(projection, (-3.0, -10.0, 3.0), (3.0, -10.0, 3.0))
    is_break = np.isnan(found).any(axis=1)
    assert is_break.any()
    steps = np.abs(np.diff(found[:, 0]))
    assert np.nanmax(steps) < 20
    columns = found[~is_break, 0]
    assert columns.min() < 40
    assert columns.max() > 360


def test_places_outside_the_image_are_nowhere() -> None:
    projection = plain()
    positions = START + np.array([[0.0, 10.0, 2.0], [0.0, -10.0, 2.0], [40.0, 10.0, 2.0]])
    assert np.isfinite(projection.to_plane(positions)).all(axis=1).tolist() == [True, False, False]


def test_a_pixel_looks_where_its_place_is() -> None:
    projection = plain(distortion=BENT)
    position = START + np.array([2.0, 9.0, 3.0])
    column, row = projection.to_plane(position[None])[0].tolist()
    ray = projection.ray((column, row))
    assert ray is not None
    way = (position - ray.origin) / np.linalg.norm(position - ray.origin)
    np.testing.assert_allclose(ray.direction, way, atol=1e-7)


def test_a_pixel_measures_more_the_farther_away_it_is() -> None:
    projection = plain()
    near = projection.reach_m((200.0, 150.0), 10.0, tuple(START + np.array([0, 10.0, 2.0])))
    assert near == pytest.approx(10 / 250 * 10)
    assert projection.reach_m((200.0, 150.0), 10.0, None) > 0


def test_without_a_depth_picture_only_the_distance_counts() -> None:
    projection = plain()
    positions = START + np.array([[0.0, 10.0, 2.0], [0.0, 200.0, 2.0]])
    assert projection.is_near(positions).tolist() == [True, False]
    assert projection.lines_on_plane(positions, np.empty((0, 2), np.int64)) == []
