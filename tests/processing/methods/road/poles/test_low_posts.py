"""Low posts beside gutters, below leaves and in guard rails."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.scene.mesh import TriangleShape, box, tube
from processing.methods.road.objects.column_points import points_about
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.objects.survey import survey_columns
from processing.methods.road.poles.alike_shafts import alike_of
from processing.methods.road.poles.shafts import Shaft, find_shafts
from processing.methods.road.poles.street_poles import REACH_M
from processing.methods.road.poles.surroundings import surroundings_of
from processing.recording.drive import Drive
from tests.processing.methods.road.bad_recordings import (
    ORIGIN,
    DrivenRecording,
    Floats,
    facing_along,
    recorded,
    road_along,
    straight,
)

LENGTH_M, FLOOR_M, DEEP_M = 40.0, 0.15, -0.4
PROFILE = (
    (-14.0, FLOOR_M),
    (3.0, FLOOR_M),
    (3.01, DEEP_M),
    (3.4, DEEP_M),
    (3.41, FLOOR_M),
    (14.0, FLOOR_M),
)
"""An open gutter to the left of the way, on the far side of which posts stand."""
BESIDE_GUTTER, BELOW_LEAVES = np.array([9.0, 3.85]), np.array([16.0, 6.0])
RAIL = [np.array([east, 5.0]) for east in (24.0, 28.0, 32.0)]
HIGH_M, RADIUS_M = 0.65, 0.04


class Street:
    """Its shafts and what stands about them."""

    def __init__(self, drives: tuple[Drive, ...], plan: SparsePlan, found: list[Shaft]) -> None:
        feet = np.array([one.foot[:2] for one in found])
        self.found, self.origin = found, plan.origin
        self.around = points_about(drives, plan, feet, REACH_M, SilentMonitor())

    def at(self, place: Floats) -> int:
        """The number of the one at a place, m east and north along the street."""
        feet = np.array([one.foot for one in self.found]) + self.origin - ORIGIN
        away = np.hypot(*(feet[:, :2] - place).T)
        assert away.min() < 0.05
        return int(away.argmin())

    def beam_at(self, place: Floats) -> float:
        """How far something leads on to both sides of the post at a place."""
        number = self.at(place)
        shaft = self.found[number]
        local = self.around.local[self.around.of(number)] - shaft.foot
        return surroundings_of(local, shaft, 0.003, np.empty((0, 2))).beam


def _post(place: Floats) -> TriangleShape:
    ends = np.array([[*place, -0.5], [*place, FLOOR_M + HIGH_M]])
    return tube(ends, np.full(2, RADIUS_M), 32)


def _leaves() -> TriangleShape:
    random = np.random.default_rng(5)
    middles = random.uniform([15.8, 5.8, 1.4], [16.2, 6.2, 3.0], (300, 3))
    corners = middles[:, None] + random.normal(0, 0.04, (300, 3, 3))
    return corners.reshape(-1, 3), np.arange(900, dtype=np.int64).reshape(-1, 3)


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Street:
    beam = box((22.0, 4.94, FLOOR_M + 0.35), (34.0, 4.96, FLOOR_M + 0.6))
    posts = [_post(place) for place in (BESIDE_GUTTER, BELOW_LEAVES, *RAIL)]
    scene = (road_along(LENGTH_M, PROFILE), *posts, _leaves(), beam)
    way = straight(LENGTH_M)
    folder: Path = tmp_path_factory.mktemp("low_posts")
    driven = DrivenRecording(way, facing_along(way), scene, pulses=6_000)
    drives = recorded(folder, driven)
    below, columns = survey_columns(drives, SilentMonitor())
    found = find_shafts(drives, below.plan, columns.posts, SilentMonitor())
    return Street(drives, below.plan, found)


@pytest.mark.parametrize("place", [BESIDE_GUTTER, BELOW_LEAVES])
def test_a_low_post_has_its_height_beside_a_gutter_and_below_leaves(
    street: Street, place: Floats
) -> None:
    shaft = street.found[street.at(place)]
    assert shaft.top_m == pytest.approx(HIGH_M, abs=0.08)
    assert shaft.radius_at(0.3) == pytest.approx(RADIUS_M, abs=0.004)


def test_posts_of_a_rail_are_alike_and_a_lone_post_of_another_height_is_not(street: Street) -> None:
    alike = alike_of(street.found)
    assert alike[street.at(RAIL[1])] >= np.log2(3)
    shorter = [replace(street.found[street.at(BESIDE_GUTTER)], top_m=0.4)]
    assert alike_of(shorter) == [0.0]
    assert alike_of([*shorter, *street.found])[0] == 0.0
    assert len(alike_of([])) == 0


def test_the_beam_of_a_guard_rail_leads_on_from_its_posts_alone(street: Street) -> None:
    assert street.beam_at(RAIL[1]) > 0.8
    assert street.beam_at(BESIDE_GUTTER) < 0.3
    assert street.beam_at(BELOW_LEAVES) < 0.3
