"""Posts amid other things: a cane with its cloth, a post aside, a sign below a crown."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.scene.mesh import TriangleShape, box, tube
from processing.methods.road.objects.column_points import points_about
from processing.methods.road.objects.columns import FoundColumns
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.objects.survey import survey_columns
from processing.methods.road.poles.carried import carried_of
from processing.methods.road.poles.shafts import feet_of, find_shafts, with_whole_sides
from processing.methods.road.poles.street_poles import REACH_M, own_points
from processing.recording.drive import Drive
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    ORIGIN,
    DrivenRecording,
    Floats,
    facing_along,
    recorded,
    road_along,
    straight,
)

LENGTH_M = 32.0
FLOOR_M = 0.15
PROFILE = ((-14.0, FLOOR_M), (-4.0, FLOOR_M), (4.0, FLOOR_M), (14.0, FLOOR_M))
CANE, POST, SIGN = np.array([8.0, 3.5]), np.array([16.0, 5.0]), np.array([24.0, 5.0])
CANE_RADIUS_M, POST_RADIUS_M = 0.011, 0.0302


class Street:
    """Its shafts and what stands about them."""

    def __init__(self, drives: Sequence[Drive], plan: SparsePlan, columns: FoundColumns) -> None:
        self.shafts = find_shafts(drives, plan, columns, SilentMonitor())
        feet = np.array([one.foot[:2] for one in self.shafts])
        self.around = points_about(drives, plan, feet, REACH_M, SilentMonitor())
        self.columns, self._drives, self._plan = columns, drives, plan

    def with_columns(self, columns: FoundColumns) -> Street:
        """The same street, its columns found elsewhere."""
        return Street(self._drives, self._plan, columns)

    def at(self, place: Floats, within_m: float = 0.05) -> int:
        """The number of the one at a place, m east and north along the street."""
        feet = np.array([one.foot for one in self.shafts]) + self._plan.origin - ORIGIN
        away = np.hypot(*(feet[:, :2] - place).T)
        assert away.min() < within_m
        return int(away.argmin())


def _post(place: Floats, high_m: float, radius_m: float) -> TriangleShape:
    ends = np.array([[*place, -0.2], [*place, high_m]])
    return tube(ends, np.full(2, radius_m), 32)


def _twigs(low: Floats, high: Floats, count: int) -> TriangleShape:
    random = np.random.default_rng(5)
    middles = random.uniform(low, high, (count, 3))
    corners = middles[:, None] + random.normal(0, 0.04, (count, 3, 3))
    return corners.reshape(-1, 3), np.arange(3 * count, dtype=np.int64).reshape(-1, 3)


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Street:
    scene = (
        road_along(LENGTH_M, PROFILE),
        _post(CANE, 2.6, CANE_RADIUS_M),
        box((CANE[0] + 0.012, CANE[1], 0.9), (CANE[0] + 0.45, CANE[1] + 0.004, 2.0)),
        _post(POST, 2.9, POST_RADIUS_M),
        _post(SIGN, 3.0, POST_RADIUS_M),
        box((SIGN[0] - 0.3, SIGN[1] - 0.05, 2.1), (SIGN[0] + 0.3, SIGN[1] - 0.045, 2.7)),
        _twigs(np.array([22.0, 3.0, 3.3]), np.array([26.0, 7.0, 5.0]), 4_000),
    )
    way = straight(LENGTH_M)
    folder: Path = tmp_path_factory.mktemp("hemmed")
    driven = DrivenRecording(way, facing_along(way), scene, head=HEAD_45, pulses=6_000)
    drives = recorded(folder, driven)
    below, columns = survey_columns(drives, SilentMonitor())
    return Street(drives, below.plan, columns.posts)


def test_a_cane_is_found_beside_its_cloth(street: Street) -> None:
    cane = street.shafts[street.at(CANE)]
    assert cane.top_m == pytest.approx(2.6 - FLOOR_M, abs=0.15)
    assert cane.radius_at(1.2) < 0.03


def test_a_post_far_from_its_column_keeps_its_diameter(street: Street) -> None:
    """A hedge beside it draws the column to itself."""
    foot = street.shafts[street.at(POST)].foot
    aside = FoundColumns(foot[None, :2] + [0.4, 0.55], foot[2:], np.zeros(1, np.uint32))
    cut = street.with_columns(aside)
    number = cut.at(POST, 0.2)
    assert cut.shafts[number].radius_at(1.2) != pytest.approx(POST_RADIUS_M, abs=0.002)
    post = with_whole_sides(cut.shafts, cut.around, SilentMonitor())[number]
    assert post.radius_at(1.2) == pytest.approx(POST_RADIUS_M, abs=0.001)


def test_a_plate_is_told_below_a_crown(street: Street) -> None:
    number = street.at(SIGN)
    shaft = street.shafts[number]
    own = own_points(street.around, number, street.shafts, cKDTree(feet_of(street.shafts)))
    assert carried_of(own, shaft).smooth > 0.6
