"""Picking among places whose pixels are known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from widgets.scene_view.camera import Camera
from widgets.scene_view.points.picking import Pickable, TilePoints, entry_depths, pick
from widgets.scene_view.projection import Projection

# Looks to the north; one metre is 500 / depth pixels wide.
CAMERA = Camera((0.0, 0.0, 0.0), heading_deg=0.0, pitch_deg=0.0, angle_deg=90.0)
VIEW = Projection(CAMERA, 1000, 1000)


def pickable(*tiles: list[list[float]]) -> tuple[Pickable, list[int]]:
    """Tiles of these places, and the list of those that were asked for their points."""
    clouds = [np.array(tile, dtype=np.float32) for tile in tiles]
    asked: list[int] = []

    def points_of(number: int) -> TilePoints:
        asked.append(number)
        numbers = np.arange(len(clouds[number]), dtype=np.int64) + 100 * number
        return TilePoints(f"drive {number}", numbers, clouds[number])

    low = np.array([cloud.min(axis=0) for cloud in clouds], dtype=np.float64)
    high = np.array([cloud.max(axis=0) for cloud in clouds], dtype=np.float64)
    return Pickable(low, high, points_of), asked


def place(x: float, y: float, depth: float) -> list[float]:
    return VIEW.place_at(x, y, depth).tolist()


def test_the_point_under_the_pixel_is_picked() -> None:
    tiles, _ = pickable([place(300, 400, 20), place(500, 500, 20), place(700, 600, 20)])
    picked = pick(tiles, VIEW, 500.4, 499.8)
    assert picked is not None
    assert (picked.drive_id, picked.point) == ("drive 0", 1)
    assert picked.depth_m == pytest.approx(20, abs=1e-5)
    assert picked.offset_px == pytest.approx(np.hypot(0.4, 0.2), abs=1e-3)


def test_nothing_is_picked_beyond_six_pixels() -> None:
    tiles, _ = pickable([place(500, 500, 20)])
    assert pick(tiles, VIEW, 505.5, 500) is not None
    assert pick(tiles, VIEW, 506.5, 500) is None


def test_the_point_in_front_hides_the_one_behind() -> None:
    tiles, _ = pickable([place(500, 500, 40)], [place(501, 500, 10)])
    picked = pick(tiles, VIEW, 500, 500)
    assert picked is not None
    assert picked.drive_id == "drive 1"


def test_a_point_a_few_pixels_off_does_not_hide_the_one_under_the_mouse() -> None:
    tiles, _ = pickable([place(500, 500, 40)], [place(505, 500, 10)])
    picked = pick(tiles, VIEW, 500, 500)
    assert picked is not None
    assert picked.drive_id == "drive 0"


def test_on_one_surface_the_point_nearest_to_the_pixel_is_picked() -> None:
    tiles, _ = pickable([place(501.5, 500, 20.0), place(500.1, 500, 20.05)])
    picked = pick(tiles, VIEW, 500, 500)
    assert picked is not None
    assert picked.point == 1


def test_points_behind_the_camera_are_never_picked() -> None:
    tiles, _ = pickable([[0.0, -10.0, 0.0]])
    assert pick(tiles, VIEW, 500, 500) is None


def test_tiles_behind_what_was_hit_are_not_searched() -> None:
    near, far = [place(500, 500, 10), place(510, 500, 10)], [place(500, 500, 50)]
    tiles, asked = pickable(far, near)
    assert pick(tiles, VIEW, 500, 500) is not None
    assert asked == [1]


def test_tiles_beside_the_ray_are_not_searched() -> None:
    tiles, asked = pickable([place(100, 100, 10)], [place(500, 500, 10)])
    assert pick(tiles, VIEW, 500, 500) is not None
    assert asked == [1]


def test_no_tiles_give_no_point() -> None:
    none = np.empty((0, 3))
    assert pick(Pickable(none, none, lambda _: pytest.fail("asked")), VIEW, 5, 5) is None


@given(st.floats(0, 1000), st.floats(0, 1000), st.floats(1, 100), st.floats(-5.9, 5.9))
def test_no_box_around_a_point_within_reach_is_missed(
    x: float, y: float, depth: float, off_px: float
) -> None:
    spot = np.array([place(x, y, depth)])
    low, high = spot - np.array([0.1, 0.2, 0.3]), spot + np.array([0.3, 0.1, 0.2])
    (entry,) = entry_depths(low, high, VIEW, x + off_px, y)
    assert entry <= depth + 1e-6
