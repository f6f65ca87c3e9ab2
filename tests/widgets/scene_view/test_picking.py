"""Picking among places whose pixels are known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.image.search.ray_hits import RayHit, RayHits
from widgets.scene_view.points.picking import entry_depths, pick, ray_at, sight_at
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.rendering.projection import SceneProjection

# Looks to the north; one metre is 500 / depth pixels wide.
CAMERA = SceneCamera((0.0, 0.0, 0.0), heading_deg=0.0, pitch_deg=0.0, angle_deg=90.0)
VIEW = SceneProjection(CAMERA, 1000, 1000)
ORIGIN = np.zeros(3)


class Clouds:
    """Tiles of these places, and which of them were searched."""

    def __init__(self, *tiles: list[list[float]]) -> None:
        self._clouds = [np.array(tile, dtype=np.float32).reshape(-1, 3) for tile in tiles]
        self.searched: list[int] = []

    def picked(self, x: float, y: float) -> RayHit | None:
        """What is picked at a pixel."""
        low = np.array([cloud.min(axis=0) for cloud in self._clouds], np.float64).reshape(-1, 3)
        high = np.array([cloud.max(axis=0) for cloud in self._clouds], np.float64).reshape(-1, 3)
        entries = entry_depths(low, high, ray_at(VIEW, ORIGIN, x, y))
        return pick(entries, self._search, sight_at(VIEW, ORIGIN, x, y))

    def _search(self, number: int, hits: RayHits) -> None:
        self.searched.append(number)
        cloud = self._clouds[number]
        hits.search_cloud(f"drive {number}", np.arange(len(cloud)) + 100 * number, cloud)


def position(x: float, y: float, depth: float) -> list[float]:
    at: list[float] = VIEW.position_at(x, y, depth).tolist()
    return at


def test_the_point_under_the_pixel_is_picked() -> None:
    tiles = Clouds([position(300, 400, 20), position(500, 500, 20), position(700, 600, 20)])
    picked = tiles.picked(500.4, 499.8)
    assert picked is not None
    assert (picked.drive_id, picked.point) == ("drive 0", 1)
    assert picked.depth_m == pytest.approx(20, abs=1e-5)
    assert picked.offset_px == pytest.approx(np.hypot(0.4, 0.2), abs=1e-3)


def test_nothing_is_picked_beyond_six_pixels() -> None:
    tiles = Clouds([position(500, 500, 20)])
    assert tiles.picked(505.5, 500) is not None
    assert tiles.picked(506.5, 500) is None


def test_the_point_in_front_hides_the_one_behind() -> None:
    tiles = Clouds([position(500, 500, 40)], [position(501, 500, 10)])
    picked = tiles.picked(500, 500)
    assert picked is not None
    assert picked.drive_id == "drive 1"


def test_a_point_a_few_pixels_off_does_not_hide_the_one_under_the_mouse() -> None:
    tiles = Clouds([position(500, 500, 40)], [position(505, 500, 10)])
    picked = tiles.picked(500, 500)
    assert picked is not None
    assert picked.drive_id == "drive 0"


def test_on_one_surface_the_point_nearest_to_the_pixel_is_picked() -> None:
    tiles = Clouds([position(501.5, 500, 20.0), position(500.1, 500, 20.05)])
    picked = tiles.picked(500, 500)
    assert picked is not None
    assert picked.point == 1


def test_points_behind_the_camera_are_never_picked() -> None:
    tiles = Clouds([[0.0, -10.0, 0.0]])
    assert tiles.picked(500, 500) is None


def test_tiles_behind_what_was_hit_are_not_searched() -> None:
    near, far = [position(500, 500, 10), position(510, 500, 10)], [position(500, 500, 50)]
    tiles = Clouds(far, near)
    assert tiles.picked(500, 500) is not None
    assert tiles.searched == [1]


def test_tiles_beside_the_ray_are_not_searched() -> None:
    tiles = Clouds([position(100, 100, 10)], [position(500, 500, 10)])
    assert tiles.picked(500, 500) is not None
    assert tiles.searched == [1]


def test_no_tiles_give_no_point() -> None:
    assert Clouds().picked(5, 5) is None


@given(st.floats(0, 1000), st.floats(0, 1000), st.floats(1, 100), st.floats(-5.9, 5.9))
def test_no_box_around_a_point_within_reach_is_missed(
    x: float, y: float, depth: float, off_px: float
) -> None:
    spot = np.array([position(x, y, depth)])
    low, high = spot - np.array([0.1, 0.2, 0.3]), spot + np.array([0.3, 0.1, 0.2])
    (entry,) = entry_depths(low, high, ray_at(VIEW, ORIGIN, x + off_px, y))
    assert entry <= depth + 1e-6
