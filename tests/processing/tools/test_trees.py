"""Street trees: a trunk with stakes, one of three stems, and posts that are none."""

from __future__ import annotations

import csv
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import Cancelled
from processing.core.monitor import SilentMonitor
from processing.formats.ledgers.ledger_columns import TableStyle
from processing.formats.ledgers.ledger_csv import write_ledger
from processing.image.scan_lines.scanlines import ScanlineSettings, scanline_through
from processing.laboratory.simulate.scene.mesh import TriangleShape, tube
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Position, Vertex
from processing.methods.road.objects.survey import survey_ground
from processing.methods.road.poles.trunks_among import tree_chances
from processing.methods.road.requested_position import RequestedPosition
from processing.methods.road.trees import crown_cells
from processing.recording.drive import Drive
from processing.tools.tool import Candidate
from processing.tools.trees import TreeParameters, diagnose_trees, find_trees
from resources import path_of
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    ORIGIN,
    WALLS,
    DrivenRecording,
    Floats,
    RunOutcome,
    delivered,
    facing_along,
    mirrored,
    recorded,
    road_along,
    straight,
    told_by,
    told_of,
)

LENGTH_M = 30.0
GROUND_M = 0.16
STAKED = np.array([6.0, 5.5, GROUND_M])
STAKED_DIAMETER_M = 0.18
STEMMED = np.array([14.0, 5.5, GROUND_M])
STEMS_M = (0.12, 0.10, 0.08)
LEANING = np.array([22.0, -5.5, GROUND_M])
LEANING_DIAMETER_M = 0.30
LEAN = 0.1
POST = np.array([10.0, 5.5, GROUND_M])
LAMP_POST = np.array([17.0, -5.5, GROUND_M])


def stem(foot: Floats, diameter_m: float, top_m: float, lean: float = 0.0) -> TriangleShape:
    """A trunk that loses a centimetre of diameter in a metre; as thick as said 1.2 m up."""
    up = np.linspace(-0.3, top_m, 12)
    path = foot + np.column_stack([lean * up, np.zeros(12), up])
    return tube(path, diameter_m / 2 - 0.005 * (up - 1.2), 48)


def moved(place: Floats, east: float, north: float, up: float) -> Floats:
    """A place so far from another."""
    return np.asarray(place + np.array([east, north, up]))


def crown(middle: Floats, half: Floats, leaves: int = 1_500) -> TriangleShape:
    """Leaves of 12 cm within an ellipsoid."""
    random = np.random.default_rng(3)
    places = random.normal(size=(leaves, 3))
    places /= np.linalg.norm(places, axis=1)[:, None]
    places *= random.uniform(0.2, 1.0, (leaves, 1)) ** (1 / 3)
    corners = middle + (places * half)[:, None] + random.normal(0.0, 0.05, (leaves, 3, 3))
    return corners.reshape(-1, 3), np.arange(3 * leaves, dtype=np.int64).reshape(-1, 3)


def street() -> tuple[TriangleShape, ...]:
    """A road with three trees and two posts."""
    stakes = [stem(moved(STAKED, dx, dy, 0.0), 0.06, 1.5) for dx, dy in ((0.25, 0.1), (-0.25, 0.1))]
    turns = (0.0, 2.1, 4.2)
    stems = [
        stem(moved(STEMMED, 0.2 * math.cos(turn), 0.2 * math.sin(turn), 0.0), diameter, 3.0)
        for turn, diameter in zip(turns, STEMS_M, strict=True)
    ]
    leaning = moved(LEANING, 0.3, 0.0, 4.5)
    lamp = LAMP_POST
    arm = np.array([moved(lamp, 0.0, dy, 7.0) for dy in (0.0, 1.0, 2.0)])
    return (
        road_along(LENGTH_M),
        stem(STAKED, STAKED_DIAMETER_M, 3.0),
        *stakes,
        crown(moved(STAKED, 0.0, 0.0, 4.0), np.array([1.5, 1.2, 1.5])),
        *stems,
        crown(moved(STEMMED, 0.0, 0.0, 4.2), np.array([1.6, 1.6, 1.6])),
        stem(LEANING, LEANING_DIAMETER_M, 3.5, LEAN),
        crown(leaning, np.array([2.0, 2.0, 1.8])),
        stem(POST, 0.09, 2.6),
        stem(lamp, 0.16, 7.0),
        tube(arm, np.full(3, 0.05), 12),
    )


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    way = straight(LENGTH_M)
    driven = DrivenRecording(way, facing_along(way), street(), head=HEAD_45, pulses=3_000)
    return recorded(tmp_path_factory.mktemp("drives"), driven)


@pytest.fixture(scope="module")
def told(drives: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> RunOutcome:
    return told_by("trees", drives, tmp_path_factory.mktemp("trees"))


def tree_at(told: RunOutcome, foot: Floats) -> Candidate:
    """The tree whose foot is near a place."""
    near = [one for one in told.candidates if math.dist(one.xyz[0, :2], (foot + ORIGIN)[:2]) < 0.5]
    assert len(near) == 1
    return near[0]


def measure(tree: Candidate, name: str) -> float:
    value = tree.attributes[name]
    assert isinstance(value, float | int)
    return float(value)


def test_trees_are_found_and_posts_are_not(told: RunOutcome) -> None:
    assert len(told.candidates) == 3
    assert all(one.kind == "street_tree" for one in told.candidates)
    assert all(one.confidence >= 0.5 for one in told.candidates)


@pytest.mark.parametrize(
    ("foot", "diameter_m"), [(STAKED, STAKED_DIAMETER_M), (LEANING, LEANING_DIAMETER_M)]
)
def test_a_trunk_is_as_thick_as_a_tape_measures_it(
    told: RunOutcome, foot: Floats, diameter_m: float
) -> None:
    tree = tree_at(told, foot)
    off = abs(measure(tree, "dbh_m") - diameter_m)
    assert off < 0.012
    assert off <= measure(tree, "dbh_within_m")
    assert measure(tree, "stems") == 1
    assert measure(tree, "girth_m") == pytest.approx(math.pi * measure(tree, "dbh_m"), abs=1e-3)


def test_several_stems_count_seven_tenths_of_their_sum(told: RunOutcome) -> None:
    tree = tree_at(told, STEMMED)
    assert measure(tree, "stems") == 3
    assert measure(tree, "dbh_m") == pytest.approx(0.7 * sum(STEMS_M), abs=0.02)


def test_the_foot_lies_on_the_ground(told: RunOutcome) -> None:
    for foot in (STAKED, LEANING):
        assert tree_at(told, foot).xyz[0] == pytest.approx(foot + ORIGIN, abs=0.04)


def test_own_points_of_a_tree_lie_on_its_trunk(told: RunOutcome, drives: tuple[Drive, ...]) -> None:
    points = tree_at(told, STAKED).own_points
    assert points is not None
    away = drives[0].xyz(points) - ORIGIN - STAKED
    assert len(points) > 300
    radius_m = STAKED_DIAMETER_M / 2 - 0.005 * (away[:, 2] - 1.2)
    off_m = np.abs(np.hypot(away[:, 0], away[:, 1]) - radius_m)
    assert (off_m < 0.03).mean() > 0.95
    assert away[:, 2].min() > 0.0
    assert away[:, 2].max() < 4.5


def test_height_crown_and_lean_are_those_of_the_tree(told: RunOutcome) -> None:
    staked, leaning = tree_at(told, STAKED), tree_at(told, LEANING)
    assert measure(staked, "height_m") == pytest.approx(5.5, abs=0.3)
    assert measure(staked, "crown_m") == pytest.approx(2.7, abs=0.5)
    assert measure(staked, "lowest_branch_m") == pytest.approx(2.6, abs=0.4)
    assert measure(leaning, "lean_deg") == pytest.approx(math.degrees(math.atan(LEAN)), abs=0.7)


def test_a_crown_over_the_walk_tells_how_high_it_hangs_there(told: RunOutcome) -> None:
    assert measure(tree_at(told, STAKED), "walk_clearance_m") == pytest.approx(2.6, abs=0.4)


def test_the_ledger_of_trees_says_what_is_true(told: RunOutcome, tmp_path: Path) -> None:
    trees = [
        Feature(f"{number}", one.kind, Geometry.POINT, (Vertex(_place_of(one)),), one.attributes)
        for number, one in enumerate(told.candidates)
    ]
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    path = tmp_path / "ledger_street_tree.csv"
    write_ledger(path, trees, catalogue["street_tree"], TableStyle(crs="EPSG:6677"))
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file, strict=True))
    true = {
        tuple(STAKED): (math.pi * STAKED_DIAMETER_M, 5.5, 1),
        tuple(STEMMED): (math.pi * 0.7 * sum(STEMS_M), 5.8, 3),
        tuple(LEANING): (math.pi * LEANING_DIAMETER_M, 6.3, 1),
    }
    assert len(rows) == len(true)
    for foot, (girth_m, height_m, stems) in true.items():
        place = np.array(foot) + ORIGIN
        row = min(rows, key=lambda one: math.dist(_plan_of(one), place[:2]))
        assert math.dist(_plan_of(row), place[:2]) < 0.1
        assert float(row["標高(H) [m]"]) == pytest.approx(place[2], abs=0.05)
        assert float(row["幹周 [m]"]) == pytest.approx(girth_m, abs=0.06)
        assert float(row["樹高 [m]"]) == pytest.approx(height_m, abs=0.4)
        assert int(row["幹の数"]) == stems
        assert float(row["枝下高 [m]"]) > 1.4
        assert float(row["胸高直径の誤差範囲（95 %） [m]"]) < 0.1


def _place_of(tree: Candidate) -> Position:
    east, north, up = tree.xyz[0].tolist()
    return east, north, up


def _plan_of(row: dict[str, str]) -> tuple[float, float]:
    return float(row["東距(Y) [m]"]), float(row["北距(X) [m]"])


@pytest.mark.parametrize("what", ["walls", "standing"])
def test_what_shows_no_tree_leaves_a_sentence(tmp_path: Path, what: str) -> None:
    way = straight(8.0) if what == "walls" else np.tile([[4.0, 0.0]], (300, 1))
    facing = facing_along(way) if what == "walls" else np.zeros(300)
    walls = tuple(road_along(8.0, profile) for profile in (WALLS, mirrored(WALLS)))
    scene = walls if what == "walls" else (road_along(8.0),)
    told = told_by("trees", recorded(tmp_path, DrivenRecording(way, facing, scene)), tmp_path)
    assert told.candidates == ()
    assert told.sentence.endswith(".")


def test_the_search_for_poles_hears_which_shafts_are_trunks(drives: tuple[Drive, ...]) -> None:
    plan = survey_ground(drives, SilentMonitor()).plan
    trunks, posts = (STAKED, LEANING), (POST, LAMP_POST)
    feet = np.array([(foot + ORIGIN - plan.origin)[:2] for foot in (*trunks, *posts)])
    chances = tree_chances(drives, plan, feet, SilentMonitor())
    assert (chances[:2] > 0.5).all()
    assert (chances[2:] < 0.1).all()
    assert tree_chances(drives, plan, feet[:0], SilentMonitor()).size == 0


def test_a_cancel_leaves_nothing(avenue_drives: tuple[Drive, ...]) -> None:
    class Stopped(SilentMonitor):
        def check(self) -> None:
            raise Cancelled

    with pytest.raises(Cancelled):
        find_trees(avenue_drives, TreeParameters(), Stopped())


def test_cells_of_a_long_street_lie_in_files_and_tell_the_same(
    drives: tuple[Drive, ...],
    told: RunOutcome,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(crown_cells, "_FIRST_SLOTS", 1 << 9)
    monkeypatch.setattr(crown_cells, "_MOST_IN_MEMORY", 1 << 9)
    before = sorted(drives[0].folder.iterdir())
    filed = told_by("trees", drives, tmp_path)
    assert sorted(drives[0].folder.iterdir()) == before
    assert [one.attributes for one in filed.candidates] == [
        one.attributes for one in told.candidates
    ]


def test_a_street_without_trees_is_told(tmp_path: Path) -> None:
    way = straight(12.0)
    bare = DrivenRecording(way, facing_along(way), (road_along(12.0),))
    told = told_by("trees", recorded(tmp_path, bare), tmp_path)
    assert told.candidates == ()
    assert told.sentence.endswith(".")


AVENUE_M = 32.0
FIRST, SECOND = np.array([12.0, 5.5, GROUND_M]), np.array([18.0, 5.5, GROUND_M])
OLD_DIAMETER_M = 0.5
LAMP, SIGN = np.array([15.0, 5.2, GROUND_M]), np.array([13.6, 5.0, GROUND_M])


def avenue() -> tuple[TriangleShape, ...]:
    """Two old trees whose crowns touch, a lamp that rises through them, a sign below."""
    half = np.array([3.1, 2.6, 2.2])
    boughs = [
        tube(
            np.array([moved(foot, 0.0, 0.0, 2.6), moved(foot, 1.8 * way[0], 1.8 * way[1], 4.2)]),
            np.array([0.09, 0.03]),
            8,
        )
        for foot in (FIRST, SECOND)
        for way in np.column_stack([np.cos(TURNS), np.sin(TURNS)])
    ]
    return (
        road_along(AVENUE_M),
        old_trunk(FIRST),
        old_trunk(SECOND),
        *boughs,
        crown(moved(FIRST, 0.0, 0.0, 5.0), half, 2_500),
        crown(moved(SECOND, 0.0, 0.0, 5.0), half, 2_500),
        post(LAMP, 0.14, 8.5),
        post(SIGN, 0.06, 3.0),
    )


TURNS = np.arange(7) * 0.9


def old_trunk(foot: Floats) -> TriangleShape:
    """It thins to its end within the crown."""
    up = np.array([-0.3, 1.2, 3.0, 5.5])
    path = foot + np.column_stack([0 * up, 0 * up, up])
    radius = np.interp(up, [1.2, 3.0, 5.5], [OLD_DIAMETER_M / 2, 0.2, 0.06])
    radius[0] = OLD_DIAMETER_M / 2 + 0.04
    return tube(path, radius, 48)


def post(foot: Floats, diameter_m: float, high_m: float) -> TriangleShape:
    """A steel pipe."""
    up = np.linspace(-0.3, high_m, 3)
    return tube(foot + np.column_stack([0 * up, 0 * up, up]), np.full(3, diameter_m / 2), 24)


@pytest.fixture(scope="module")
def avenue_drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    way = straight(AVENUE_M)
    driven = DrivenRecording(way, facing_along(way), avenue(), head=HEAD_45, pulses=1_500)
    return recorded(tmp_path_factory.mktemp("avenue"), driven)


def test_posts_under_the_crowns_of_others_are_no_trees(
    avenue_drives: tuple[Drive, ...], tmp_path: Path
) -> None:
    told = told_by("trees", avenue_drives, tmp_path)
    assert len(told.candidates) == 2
    for foot in (FIRST, SECOND):
        tree = tree_at(told, foot)
        assert measure(tree, "dbh_m") == pytest.approx(OLD_DIAMETER_M, abs=0.012)
        assert measure(tree, "crown_m") == pytest.approx(5.7, abs=0.8)
        assert measure(tree, "height_m") == pytest.approx(7.2, abs=0.4)


def test_the_circles_of_a_trunk_are_told_where_they_are(
    avenue_drives: tuple[Drive, ...],
) -> None:
    place = FIRST + ORIGIN
    scanlines = scanline_through(avenue_drives[0], place, ScanlineSettings())
    assert scanlines is not None
    asked = RequestedPosition(avenue_drives[0], place, scanlines)
    told = diagnose_trees(asked, TreeParameters())
    taken = [one for one in told if one.is_taken]
    assert len(taken) >= 10
    for one in taken:
        assert one.outcomes[0].value == pytest.approx(OLD_DIAMETER_M, abs=0.1)
        assert math.dist(one.xyz[:2], place[:2]) < 0.03
        assert 0.2 < one.xyz[2] - place[2] < 2.8
        assert one.points is not None
        beside = np.hypot(*(one.points - place)[:, :2].T)
        assert len(beside) >= 3
        assert beside == pytest.approx(OLD_DIAMETER_M / 2, abs=0.06)
        assert np.abs(one.points[:, 2] - one.xyz[2]).max() <= 0.051
        assert one.outline is not None
        assert np.ptp(one.outline, axis=0)[:2] == pytest.approx(
            [one.outcomes[0].value] * 2, rel=0.02
        )


def test_without_a_trajectory_trees_are_found_all_the_same(tmp_path: Path) -> None:
    way = straight(AVENUE_M)
    driven = DrivenRecording(way, facing_along(way), avenue(), head=HEAD_45, pulses=1_000)
    request = replace(delivered(driven, tmp_path), trajectories=())
    assert len(told_of("trees", request, tmp_path).candidates) == 2
