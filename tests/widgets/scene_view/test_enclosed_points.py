"""All points of a drive that are seen inside an outline."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from processing.core.arrays import Floats
from processing.image.images_of_drives import image_of
from processing.image.search.enclosed_points import Sight, enclosed_kernel, points_enclosed
from processing.recording.drive import Drive
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.rendering.projection import NEAR_M, SceneProjection

LASSO = np.array([[300.0, 200.0], [520.0, 180.0], [400.0, 330.0], [560.0, 460.0], [280.0, 420.0]])
BOW = np.array([[250.0, 200.0], [550.0, 420.0], [550.0, 200.0], [250.0, 420.0]])


def projection_on(drive: Drive, away_m: float) -> tuple[SceneProjection, Floats]:
    xyz = drive.xyz(slice(None))
    origin = np.round(xyz.mean(axis=0))
    camera = SceneCamera((0.0, 0.0, 0.0), heading_deg=25.0, pitch_deg=-40.0)
    return SceneProjection(camera.centred_on(xyz.mean(axis=0) - origin, away_m), 800, 600), origin


@pytest.mark.parametrize("outline", [LASSO, BOW], ids=["lasso", "crossing itself"])
@pytest.mark.parametrize("away_m", [3.0, 40.0], ids=["from within", "from far"])
def test_exactly_the_points_seen_inside_are_found(
    left_drive: Drive, outline: Floats, away_m: float
) -> None:
    projection, origin = projection_on(left_drive, away_m)
    sight = Sight(projection.matrix, origin, NEAR_M)
    found = points_enclosed(
        left_drive, image_of(left_drive, left_drive.image_kinds[0]), sight, outline
    )
    pixels, depth = projection.to_screen(left_drive.xyz(slice(None)) - origin)
    area = shapely.make_valid(shapely.Polygon(outline))
    wanted = shapely.intersects_xy(area, pixels[:, 0], pixels[:, 1]) & (depth > NEAR_M)
    assert wanted.sum() > 100
    assert found.tolist() == np.flatnonzero(wanted).tolist()


def test_an_outline_of_two_corners_holds_nothing(left_drive: Drive) -> None:
    projection, origin = projection_on(left_drive, 40.0)
    sight = Sight(projection.matrix, origin, NEAR_M)
    image = image_of(left_drive, left_drive.image_kinds[0])
    assert points_enclosed(left_drive, image, sight, LASSO[:2]).size == 0


def test_the_plain_loop_gives_the_same() -> None:
    random = np.random.default_rng(5)
    integers = random.integers(0, 100, (500, 3)).astype(np.int32)
    matrix = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
    square = np.array([[20.0, 20, 60, 20], [60, 20, 60, 60], [60, 60, 20, 60], [20, 60, 20, 20]])
    starts = np.array([0, 4])
    limits = np.array([20.0, 20.0, 60.0, 60.0])
    fast, plain = np.empty(500, np.bool_), np.empty(500, np.bool_)
    enclosed_kernel(integers, matrix, 0.05, limits, square, starts, fast)
    enclosed_kernel.py_func(integers, matrix, 0.05, limits, square, starts, plain)  # type: ignore[attr-defined]
    assert fast.tolist() == plain.tolist()
    within = ((integers[:, :2] > 20) & (integers[:, :2] < 60)).all(axis=1)
    assert (fast & within).sum() == within.sum()
