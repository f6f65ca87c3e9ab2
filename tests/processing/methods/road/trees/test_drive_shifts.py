"""Passes that lie centimetres apart, on trunks that both saw; and mirrored points below."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.methods.road.objects.foot import ground_seen
from processing.methods.road.trees.drive_shifts import (
    JoinedPoints,
    agreed_shifts,
    laid_by,
    without_shifts,
)
from processing.methods.road.trees.stems import stems_of
from processing.methods.road.trees.trunks import trunk_of

MOST_M = 1.2


def seen(diameter_m: float, shift: tuple[float, float], from_deg: float, seed: int) -> Floats:
    """Two fifths of a trunk from one side, 5 cm between scan lines, with 3 mm of noise."""
    random = np.random.default_rng(seed)
    up = np.repeat(np.arange(0.2, 2.7, 0.05), 24)
    turn = np.tile(np.radians(from_deg + np.linspace(-72, 72, 24)), up.size // 24)
    radius = diameter_m / 2 + random.normal(0.0, 0.003, up.size)
    beside = np.column_stack([radius * np.cos(turn), radius * np.sin(turn)])
    return np.column_stack([beside + shift, up])


def diameter_of(points: Floats) -> float:
    trunk = trunk_of(stems_of(points, MOST_M))
    assert trunk is not None
    return trunk.diameter_m


@pytest.mark.parametrize("shift", [(0.04, 0.0), (0.0, -0.04), (-0.03, 0.03)])
def test_two_passes_are_laid_onto_each_other(shift: tuple[float, float]) -> None:
    points = np.vstack([seen(0.3, (0.0, 0.0), 0.0, 1), seen(0.3, shift, 60.0, 2)])
    drives = np.repeat([0, 1], len(points) // 2)
    moved = without_shifts(points, drives, stems_of(points[drives == 0], MOST_M)[0]).points
    assert moved is not None
    first, second = (moved[drives == one, :2] - points[drives == one, :2] for one in (0, 1))
    assert (first - second).mean(axis=0) == pytest.approx(shift, abs=0.008)
    assert diameter_of(moved) == pytest.approx(0.3, abs=0.01)


def test_heads_that_lie_on_each_other_stay_where_they_are() -> None:
    points = np.vstack([seen(0.3, (0.0, 0.0), 0.0, 1), seen(0.3, (0.0, 0.0), 90.0, 2)])
    drives = np.repeat([0, 1], len(points) // 2)
    told = without_shifts(points, drives, stems_of(points, MOST_M)[0])
    assert told.is_told
    assert told.points is None


def test_one_drive_tells_nothing() -> None:
    points = seen(0.3, (0.0, 0.0), 0.0, 1)
    told = without_shifts(points, np.zeros(len(points), np.int64), stems_of(points, MOST_M)[0])
    assert not told.is_told


def told(*shifts: tuple[float, float]) -> list[JoinedPoints]:
    """What stems tell of the second of two drives."""
    return [JoinedPoints({0: np.zeros(2), 1: np.array(one)}, None) for one in shifts]


def test_a_centimetre_between_heads_counts_where_trunks_agree_on_it() -> None:
    near = told((0.013, 0.005), (0.011, 0.006), (0.014, 0.008), (0.012, 0.005))
    agreed = agreed_shifts(near[0], near)
    assert agreed[1] == pytest.approx([0.0125, 0.0055])
    points = np.vstack([seen(0.12, (0.0, 0.0), -55.0, 5), seen(0.12, (0.0125, 0.0055), 55.0, 6)])
    drives = np.repeat([0, 1], len(points) // 2)
    apart = abs(diameter_of(points) - 0.12)
    together = abs(diameter_of(laid_by(points, drives, agreed)) - 0.12)
    assert together < 0.002 < apart


def test_bark_that_is_not_round_is_no_shift_between_heads() -> None:
    near = told((0.006, -0.003), (-0.004, 0.005), (0.002, 0.004), (-0.005, -0.004))
    assert not agreed_shifts(near[0], near)
    assert not agreed_shifts(near[0], near[:2])


def test_stems_that_agree_on_no_shift_overrule_what_one_tells() -> None:
    near = told((0.03, 0.02), (0.001, 0.0), (0.0, 0.001), (0.001, 0.001), (0.0, 0.0))
    assert agreed_shifts(near[0], near)[1] == pytest.approx([0.0, 0.0])


def test_passes_that_lie_a_hand_s_breadth_apart_are_laid_onto_each_other() -> None:
    shift = (0.075, -0.03)
    points = np.vstack([seen(0.12, (0.0, 0.0), -30.0, 5), seen(0.12, shift, 30.0, 6)])
    drives = np.repeat([0, 1], len(points) // 2)
    trunk = trunk_of(stems_of(points, MOST_M))
    assert trunk is not None
    joined = without_shifts(points, drives, trunk.stems[0])
    assert joined.points is not None
    apart = joined.shifts[1] - joined.shifts[0]
    assert apart == pytest.approx(shift, abs=0.006)
    assert diameter_of(joined.points) == pytest.approx(0.12, abs=0.005)


def test_how_drives_lie_apart_is_told_from_whichever_has_the_most_points() -> None:
    other = JoinedPoints({1: np.zeros(2), 0: np.array([-0.012, -0.006])}, None)
    near = [other, *told((0.012, 0.006), (0.013, 0.006), (0.012, 0.007))]
    assert agreed_shifts(other, near)[0] == pytest.approx([-0.012, -0.006], abs=0.001)


def about(heights: Floats, within_m: float) -> Floats:
    """Points of some heights, evenly about a column."""
    random = np.random.default_rng(4)
    plan = random.uniform(-within_m, within_m, (len(heights), 2))
    return np.column_stack([plan, heights])


def test_a_few_mirrored_points_below_the_road_are_no_ground() -> None:
    random = np.random.default_rng(3)
    ground, trunk = random.normal(1.2, 0.01, 900), random.uniform(1.2, 3.8, 400)
    mirrored = about(random.uniform(-0.1, 0.4, 20), 0.9)
    street = np.vstack([about(ground, 0.9), about(trunk, 0.15)])
    assert ground_seen(np.vstack([street, mirrored]), 0.0) == pytest.approx(1.2, abs=0.1)
    hedge = random.uniform(0.1, 0.9, 2_000)
    behind = np.concatenate([random.normal(0.0, 0.01, 200), hedge, trunk])
    assert ground_seen(about(behind, 0.9), 0.0) == 0.0


def test_what_a_wet_road_mirrors_far_below_it_is_no_ground_though_it_is_a_tenth_of_it() -> None:
    random = np.random.default_rng(6)
    ground, trunk = random.normal(0.62, 0.005, 600), random.uniform(0.6, 3.5, 2_000)
    mirrored = about(random.uniform(0.0, 0.1, 60), 0.9)
    street = np.vstack([about(ground, 0.9), about(trunk, 0.15)])
    assert ground_seen(np.vstack([street, mirrored]), 0.0) == pytest.approx(0.62, abs=0.06)
    shrub = about(random.uniform(0.1, 0.6, 900), 0.9)
    assert ground_seen(np.vstack([street, mirrored, shrub]), 0.0) == 0.0


def test_a_trunk_whose_foot_a_wall_hides_does_not_end_where_it_is_seen_first() -> None:
    trunk = about(np.random.default_rng(3).uniform(1.1, 3.8, 400), 0.2)
    assert ground_seen(trunk, 0.0) == 0.0


def test_what_hides_the_ground_from_most_sides_is_not_the_ground() -> None:
    random = np.random.default_rng(8)
    ground, trunk = random.normal(0.0, 0.01, 60), random.uniform(0.3, 3.5, 400)
    both = np.vstack([about(ground, 0.9), about(trunk, 0.15)])
    assert ground_seen(both, 0.55) == pytest.approx(0.0, abs=0.08)
