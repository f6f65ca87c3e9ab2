"""The coarse ground under things: what is measured below an opaque road is not its height."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.methods.road.objects.ground_heights import height_of
from processing.methods.road.objects.opaque_ground import (
    LAYERS,
    sure_kernel,
    votes_kernel,
)
from processing.methods.road.objects.survey import SurveyGround, survey_ground
from processing.project.importing.importing import ImportRequest
from tests.processing.methods.road.bad_recordings import Floats, imported, write_points

SIDE_M, STEP_M = 24.0, 0.1
EAST_M, NORTH_M = -12_000.0, -35_000.0


def level(
    random: np.random.Generator, low: tuple[float, float], high: tuple[float, float]
) -> Floats:
    """A level surface between two corners in plan, measured every decimetre to 5 mm."""
    east, north = np.meshgrid(
        np.arange(low[0], high[0], STEP_M), np.arange(low[1], high[1], STEP_M), indexing="ij"
    )
    plan = np.column_stack([east.ravel(), north.ravel()]) + random.uniform(0, 0.05, (east.size, 2))
    return np.column_stack([plan, random.normal(0.0, 0.005, len(plan))])


def ground_of(xyz: Floats, folder: Path) -> SurveyGround:
    """What the search finds in points of one head."""
    moved = xyz + np.array([EAST_M, NORTH_M, 50.0])
    times = np.asarray(np.arange(len(xyz)) * 1e-5, np.float64)
    path = write_points(folder / "left.las", moved, times)
    drives = imported(folder, ImportRequest((path,), (), crs="EPSG:6677"))
    return survey_ground(drives, SilentMonitor())


def heights_at(ground: SurveyGround, plan: Floats) -> Floats:
    """The ground about the level of the surface."""
    away = np.column_stack([plan, np.zeros(len(plan))]) + np.array([EAST_M, NORTH_M, 0.0])
    places = away - ground.plan.origin
    found = [height_of(ground.heights, ground.plan, east, north) for east, north, _ in places]
    return np.array(found, np.float64) + float(ground.plan.origin[2]) - 50.0


def test_a_puddle_and_rings_of_phase_do_not_lower_the_road(tmp_path: Path) -> None:
    random = np.random.default_rng(4)
    road = level(random, (0.0, 0.0), (SIDE_M, SIDE_M))
    is_wet = (np.abs(road[:, :2] - 9.0) < 4.0).all(axis=1) & (random.random(len(road)) < 0.4)
    mirrored = road[is_wet] - [0, 0, 1] * random.uniform(1.0, 9.0, (is_wet.sum(), 1))
    turns = np.linspace(0.0, np.pi, 400)
    ring = np.column_stack(
        [14.0 + 9.0 * np.cos(turns), np.full(turns.size, 18.0), -9.0 * np.sin(turns)]
    )
    ring[:, :2] += random.uniform(-0.1, 0.1, (len(ring), 2))
    ground = ground_of(np.concatenate([road, mirrored, ring]), tmp_path)
    off = heights_at(ground, random.uniform(1.0, SIDE_M - 1.0, (500, 2)))
    assert np.abs(off).max() < 0.1


def test_a_wooded_valley_beside_a_bridge_keeps_its_ground(tmp_path: Path) -> None:
    random = np.random.default_rng(5)
    deck = level(random, (0.0, 0.0), (8.0, SIDE_M)) + np.array([0.0, 0.0, 8.0])
    # Crowns hide four fifths of the ground, and rise over the deck.
    valley = level(random, (8.0, 0.0), (SIDE_M, SIDE_M))
    leaves = valley + [0, 0, 1] * random.uniform(2.0, 12.0, (len(valley), 1))
    is_seen = random.random(len(valley)) < 0.2
    ground = ground_of(np.concatenate([deck, valley[is_seen], leaves]), tmp_path)
    below = random.uniform([9.0, 1.0], [SIDE_M - 1.0, SIDE_M - 1.0], (300, 2))
    assert np.abs(heights_at(ground, below)).max() < 0.1


def test_a_cell_is_below_the_ground_if_a_layer_over_it_outweighs_what_lies_below() -> None:
    counts = np.zeros((1, 3, LAYERS), np.uint16)
    counts[0, :, 0], counts[0, :, 10] = (30, 30, 80), (70, 10, 20)
    heights = np.array([[0.1, 0.1, 0.1]], np.float32)
    around = np.full((5, 7), 4.1, np.float32)
    around[2, 2:5] = np.inf  # the three cells themselves: of the last, most points lie low
    around[2, 4] = 0.1
    for kernel in (votes_kernel, votes_kernel.py_func):  # type: ignore[attr-defined]
        level, found = heights.copy(), np.zeros((1, 3), np.bool_)
        told = level, found, np.zeros((1, 3), np.float32)
        points = np.zeros((5, 7), np.float32)
        kernel((around, points), counts, np.array([0.35, 0.56]), told)
        assert found.tolist() == [[True, False, False]]
        assert level[0].tolist() == pytest.approx([4.1, 0.1, 0.1])


def test_a_cell_is_sure_of_its_height_by_the_layers_that_hold_most_of_its_points() -> None:
    counts = np.zeros((3, LAYERS), np.uint16)
    counts[:, 0], counts[:, 1], counts[:, 5] = 60, 40, (90, 110, 70)
    counts[2, 9:20:3] = 60  # a crown: more than the ground, but looser
    for kernel in (sure_kernel, sure_kernel.py_func):  # type: ignore[attr-defined]
        sure, points = np.full((2, 3), np.inf, np.float32)
        kernel(np.full(3, 0.1, np.float32), counts, sure, points)
        assert np.isfinite(sure).tolist() == [True, False, True]
        assert points[0] == points[2] == 100


@pytest.mark.parametrize(
    ("below", "at_ground", "is_below"),
    [
        ((12, 4), 0, True),  # stray points in the shadow of a trunk
        ((60, 80), 0, False),  # ground that was seen down there
        ((3, 0), 800, True),  # the ground itself, and mixed points under it
    ],
)
def test_stray_points_below_are_no_ground(
    below: tuple[int, int], at_ground: int, is_below: bool
) -> None:
    counts = np.zeros((1, 1, LAYERS), np.uint16)
    counts[0, 0, :2], counts[0, 0, 10], counts[0, 0, 20] = below, at_ground, 2_000
    around, points = np.full((5, 5), 4.1, np.float32), np.full((5, 5), 1_000, np.float32)
    around[2, 2] = np.inf
    for kernel in (votes_kernel, votes_kernel.py_func):  # type: ignore[attr-defined]
        told = np.full((1, 1), 0.1, np.float32), np.zeros((1, 1), np.bool_), np.zeros((1, 1))
        kernel((around, points), counts, np.array([0.35, 0.56]), told)
        assert told[1].tolist() == [[is_below]]
