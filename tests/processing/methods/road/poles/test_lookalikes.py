"""What looks like a pole: square posts, images in panes, trunks that end in their crown."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.scene.mesh import TriangleShape, box, tube
from processing.methods.road.objects.column_points import points_about
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.objects.survey import survey_columns
from processing.methods.road.poles import street_poles
from processing.methods.road.poles.mirror_images import mirror_images
from processing.methods.road.poles.reflectors import ReflectorSearch
from processing.methods.road.poles.shaft_sides import seen_sides, towards_vehicle
from processing.methods.road.poles.shafts import Shaft, find_shafts
from processing.methods.road.poles.street_poles import REACH_M
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
WALL_M, PANE = 8.0, ((12.5, 0.9), (19.5, 2.4))
POLE, IMAGE = np.array([16.0, 5.5]), np.array([16.0, 2 * WALL_M - 5.5])
SQUARE, TRUNK = np.array([24.0, -5.0]), np.array([8.0, -5.0])
TRUNK_HIGH_M = 2.5


@dataclass(frozen=True)
class Shafts:
    """All of a street."""

    drives: tuple[Drive, ...]
    plan: SparsePlan
    found: list[Shaft]

    def at(self, place: Floats) -> int:
        """The number of the one at a place, m east and north along the street."""
        feet = np.array([one.foot for one in self.found]) + self.plan.origin - ORIGIN
        away = np.hypot(*(feet[:, :2] - place).T)
        assert away.min() < 0.1
        return int(away.argmin())


def pole(place: Floats, high_m: float, radius_m: float = 0.06) -> TriangleShape:
    ends = np.array([[*place, -0.2], [*place, high_m]])
    return tube(ends, np.full(2, radius_m), 32)


def wall_with_pane() -> list[TriangleShape]:
    """A front along the road, open where its pane is: what was mirrored seems to stand behind."""
    (left, low), (right, high) = PANE
    parts = [(6.0, left, 0.0, 5.0), (right, 26.0, 0.0, 5.0)]
    parts += [(left, right, 0.0, low), (left, right, high, 5.0)]
    return [
        box((west, WALL_M - 0.01, bottom), (east, WALL_M + 0.01, top))
        for west, east, bottom, top in parts
    ]


def leaves() -> TriangleShape:
    random = np.random.default_rng(5)
    places = random.normal(size=(1_500, 3))
    places *= (random.uniform(0.1, 1.0, 1_500) / np.linalg.norm(places, axis=1))[:, None]
    middle = np.array([*TRUNK, TRUNK_HIGH_M + 1.4])
    corners = middle + (places * 1.5)[:, None] + random.normal(0, 0.05, (1_500, 3, 3))
    return corners.reshape(-1, 3), np.arange(4_500, dtype=np.int64).reshape(-1, 3)


@pytest.fixture(scope="module")
def shafts(tmp_path_factory: pytest.TempPathFactory) -> Shafts:
    half = 0.06
    scene = (
        road_along(LENGTH_M, PROFILE),
        *wall_with_pane(),
        pole(POLE, 6.0),
        pole(IMAGE, 6.0),
        pole(TRUNK, TRUNK_HIGH_M),
        leaves(),
        box((*(SQUARE - half), -0.2), (*(SQUARE + half), 2.6)),
    )
    way = straight(LENGTH_M)
    folder: Path = tmp_path_factory.mktemp("lookalikes")
    driven = DrivenRecording(way, facing_along(way), scene, head=HEAD_45, pulses=3_000)
    drives = recorded(folder, driven)
    below, columns = survey_columns(drives, SilentMonitor())
    return Shafts(
        drives, below.plan, find_shafts(drives, below.plan, columns.posts, SilentMonitor())
    )


def test_a_square_post_is_told_from_a_round_one(shafts: Shafts) -> None:
    post, round_one = (shafts.found[shafts.at(place)] for place in (SQUARE, POLE))
    origin = shafts.plan.origin
    assert seen_sides(shafts.drives, post, origin).square > 0.4
    assert seen_sides(shafts.drives, round_one, origin).square < 0.15


def test_a_pole_shows_the_side_that_faces_the_vehicle(shafts: Shafts) -> None:
    shaft, origin = shafts.found[shafts.at(POLE)], shafts.plan.origin
    assert seen_sides(shafts.drives, shaft, origin).behind < 0.05
    turned = Shaft(**{**vars(shaft), "local": shaft.local * (-1.0, -1.0, 1.0)})
    assert seen_sides(shafts.drives, turned, origin).behind > 0.7
    assert (towards_vehicle(shafts.drives, shaft, origin)[:, 1] < -4.0).all()


def test_what_a_pane_mirrors_is_told_from_what_it_shows(shafts: Shafts) -> None:
    asked = range(len(shafts.found))
    images = mirror_images(shafts.drives, shafts.plan, shafts.found, asked, SilentMonitor())
    assert shafts.at(IMAGE) in images
    assert not images & {shafts.at(place) for place in (POLE, SQUARE, TRUNK)}


def test_a_trunk_ends_where_only_leaves_lie_on_it(shafts: Shafts) -> None:
    top = shafts.found[shafts.at(TRUNK)].top_m + FLOOR_M
    assert top == pytest.approx(TRUNK_HIGH_M, abs=0.4)
    assert shafts.found[shafts.at(POLE)].top_m == pytest.approx(6.0 - FLOOR_M, abs=0.15)


def test_where_all_is_as_bright_nobody_knows_what_shines(shafts: Shafts) -> None:
    feet = np.array([one.foot[:2] for one in shafts.found])
    around = points_about(shafts.drives, shafts.plan, feet, REACH_M, SilentMonitor())
    number = shafts.at(POLE)
    told = ReflectorSearch(shafts.drives, shafts.found, around, shafts.plan.origin)
    assert told.shines(number, shafts.found[number]) == 0.5


def test_shafts_of_which_none_may_be_a_pole_are_no_poles(
    shafts: Shafts, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(street_poles, "shafts_about_all", lambda *_: {})
    assert street_poles.street_poles(shafts.drives, SilentMonitor()) == ()


@pytest.mark.parametrize(("is_face", "expected"), [(True, 1.0), (False, 0.0)])
def test_a_face_shines_in_one_piece_and_leaves_now_and_then(
    shafts: Shafts, monkeypatch: pytest.MonkeyPatch, *, is_face: bool, expected: float
) -> None:
    feet = np.array([one.foot[:2] for one in shafts.found])
    around = points_about(shafts.drives, shafts.plan, feet, REACH_M, SilentMonitor())
    number = shafts.at(POLE)
    shaft = shafts.found[number]
    heights = around.local[:, 2] - shaft.foot[2]
    faces = (heights > 3.2) & (heights < 3.8)
    shining = faces if is_face else np.arange(len(heights)) % 12 == 0
    told = ReflectorSearch(shafts.drives, shafts.found, around, shafts.plan.origin)
    bounds = [np.full_like(one, 100.0) for one in told._bounds]
    monkeypatch.setattr(told, "_bounds", bounds)
    monkeypatch.setattr(told, "_intensity", lambda _, lines: np.where(shining[lines], 200, 10))
    assert told.shines(number, shaft) == expected
