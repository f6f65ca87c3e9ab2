"""Trunks and poles told from a few shaken points, on clouds made by construction."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.core.errors import Cancelled
from processing.core.monitor import SilentMonitor
from processing.laboratory.road_training.coarse_recordings import CoarseRecording
from processing.laboratory.road_training.coarse_training import label_columns
from processing.methods.road.coarse.coarse_uprights import (
    CoarseUpright,
    coarse_uprights,
)
from processing.methods.road.coarse.column_facts import facts_of
from processing.methods.road.coarse.column_sums import ON, sum_columns
from processing.methods.road.objects.columns import FoundColumns
from processing.methods.road.objects.survey import survey_columns
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.density import (
    are_sparse,
    points_a_place,
    points_about_a_point,
    points_at_trunks,
)
from processing.recording.drive import Drive
from processing.tools.poles import PoleParameters, find_poles
from processing.tools.trees import TreeParameters, find_trees

_ORIGIN = np.array([-12_345.0, 67_890.0, 42.0])
_POLE, _TREE, _WALL = (8.0, 5.0), (20.0, 5.0), (32.0, 5.0)
_SHAKE_M = 0.015


def _column(place: tuple[float, float], radius_m: float, top_m: float, lean: float = 0.0) -> Floats:
    """Three rows up the side of a cylinder that faces south, a point every 0.2 m, shaken."""
    random = np.random.default_rng(5)
    rows = []
    for turn in (-1.0, 0.0, 1.0):
        up = np.arange(0.1, top_m, 0.2)
        east = place[0] + radius_m * np.sin(turn) + lean * up
        north = np.full(up.size, place[1] - radius_m * np.cos(turn))
        rows.append(np.column_stack([east, north, up]) + random.normal(0.0, _SHAKE_M, 3))
    return np.concatenate(rows)


def _street(spacing_m: float) -> Floats:
    """Ground with a pole, a tree and a wall, at points about so far apart."""
    random = np.random.default_rng(3)
    east, north = np.meshgrid(np.arange(0, 40, spacing_m), np.arange(-4, 10, spacing_m))
    ground = np.column_stack([east.ravel(), north.ravel(), np.zeros(east.size)])
    along, up = np.meshgrid(np.arange(28, 36, spacing_m), np.arange(0, 2.4, spacing_m))
    wall = np.column_stack([along.ravel(), np.full(along.size, _WALL[1]), up.ravel()])
    crown = random.normal(0.0, 1.0, (700, 3))
    crown *= (random.uniform(1.2, 2.2, 700) / np.linalg.norm(crown, axis=1))[:, None]
    crown += (*_TREE, 4.8)
    cloud = np.concatenate(
        [ground, wall, _column(_POLE, 0.1, 8.0), _column(_TREE, 0.14, 3.2), crown]
    )
    return cloud + random.normal(0.0, 0.005, cloud.shape) + _ORIGIN


def _drive(xyz: Floats, folder: Path) -> Drive:
    header = laspy.LasHeader(point_format=0, version="1.2")
    header.scales, header.offsets = np.full(3, 0.001), np.floor(xyz.min(axis=0))
    las = laspy.LasData(header)
    las.x, las.y, las.z = xyz.T
    las.write(folder / "疎な点群.las")
    (made,) = import_drives(
        ImportRequest((folder / "疎な点群.las",)), folder / "drives", SilentMonitor()
    )
    return Drive(made)


@pytest.fixture(scope="module")
def sparse(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return _drive(_street(0.3), tmp_path_factory.mktemp("sparse"))


def _nearest(found: tuple[CoarseUpright, ...], place: tuple[float, float]) -> CoarseUpright:
    return min(found, key=lambda one: float(np.hypot(*(one.foot - _ORIGIN)[:2] - place)))


def test_a_pole_and_a_trunk_are_told_from_a_few_shaken_rows(sparse: Drive) -> None:
    assert are_sparse([sparse])
    found = coarse_uprights((sparse,), SilentMonitor())
    pole, tree = _nearest(found, _POLE), _nearest(found, _TREE)
    assert np.hypot(*((pole.foot - _ORIGIN)[:2] - _POLE)) < 0.3
    assert np.hypot(*((tree.foot - _ORIGIN)[:2] - _TREE)) < 0.3
    assert abs(pole.foot[2] - _ORIGIN[2]) < 0.1
    assert pole.pole > 0.5 > pole.tree
    assert tree.tree > 0.5 > tree.pole
    assert abs(pole.top_m - 8.0) < 0.5


def test_what_it_stands_on_are_measured_points_on_its_axis_from_below(sparse: Drive) -> None:
    pole = _nearest(coarse_uprights((sparse,), SilentMonitor()), _POLE)
    assert (pole.drives == 0).all()
    xyz = sparse.xyz(slice(0, sparse.count))[pole.points]
    assert len(xyz) >= 100  # of its 120 points those above 0.2 m
    assert np.hypot(*(xyz - _ORIGIN)[:, :2].T - np.array(_POLE)[:, None]).max() < 0.35
    assert (np.diff(xyz[:, 2]) >= 0).all()


def test_tools_say_what_sparse_things_lack(sparse: Drive) -> None:
    poles = find_poles((sparse,), PoleParameters(), SilentMonitor())
    trees = find_trees((sparse,), TreeParameters(), SilentMonitor())
    (pole,) = poles.candidates
    (tree,) = trees.candidates
    assert np.hypot(*((pole.xyz[0] - _ORIGIN)[:2] - _POLE)) < 0.3
    assert np.hypot(*((tree.xyz[0] - _ORIGIN)[:2] - _TREE)) < 0.3
    assert pole.attributes == {
        "type": "other",
        "height_m": 8.2,
        "lean_deg": pytest.approx(0, abs=2),
    }
    assert "dbh_m" not in tree.attributes
    assert tree.attributes["height_m"] == pytest.approx(7.0, abs=0.4)
    assert "too sparse" in trees.note.en
    assert "点密度" in trees.note.ja


def test_nothing_is_a_tree_and_a_pole_at_once(sparse: Drive) -> None:
    every = PoleParameters(lowest_m=0.3, least_confidence=0.0)
    poles = find_poles((sparse,), every, SilentMonitor()).candidates
    trees = find_trees((sparse,), TreeParameters(least_confidence=0.0), SilentMonitor()).candidates
    assert poles
    assert trees
    for pole in poles:
        assert all(np.hypot(*(pole.xyz - tree.xyz)[0, :2]) > 0.9 for tree in trees)


def test_a_cancel_is_felt_between_columns(sparse: Drive) -> None:
    class EndsEarly(SilentMonitor):
        asked = 0

        def check(self) -> None:
            self.asked += 1
            if self.asked > 5:
                raise Cancelled

    with pytest.raises(Cancelled):
        coarse_uprights((sparse,), EndsEarly())


def test_a_dense_recording_is_left_to_the_exact_way(tmp_path: Path) -> None:
    dense = _drive(_street(0.08), tmp_path)
    assert not are_sparse([dense])
    found = find_poles((dense,), PoleParameters(), SilentMonitor()).candidates
    assert found
    assert all("diameter_m" in one.attributes for one in found)


def test_noise_in_the_air_and_large_crowns_make_no_street_sparse(tmp_path: Path) -> None:
    # Of all cubes with points most hold one or two, as phase noise of a dense scanner fills them.
    dense = _street(0.08)
    air = np.random.default_rng(7).uniform((0, -4, 3), (40, 10, 30), (60_000, 3)) + _ORIGIN
    assert points_a_place(np.concatenate([dense, air])) <= 3
    assert not are_sparse([_drive(np.concatenate([dense, air]), tmp_path)])


def test_nor_does_noise_about_what_is_as_high_as_trunks(tmp_path: Path) -> None:
    dense = _street(0.04)
    air = np.random.default_rng(7).uniform((0, -30, 0.8), (40, 30, 2.4), (90_000, 3)) + _ORIGIN
    points = np.concatenate([dense, air])
    assert points_a_place(points) <= 6
    assert points_at_trunks(points) <= 6
    assert points_about_a_point(dense) > 60
    assert not are_sparse([_drive(points, tmp_path)])


def test_no_drives_and_no_points_are_not_sparse() -> None:
    assert not are_sparse([])
    assert np.isinf(points_a_place(np.empty((0, 3))))
    assert np.isinf(points_at_trunks(np.empty((0, 3))))
    assert np.isinf(points_about_a_point(np.empty((0, 3))))
    assert points_at_trunks(np.zeros((5, 3))) == 5


def test_a_sparse_recording_of_bare_ground_has_nothing_and_says_so(tmp_path: Path) -> None:
    ground = _street(0.3)
    bare = _drive(ground[ground[:, 2] < _ORIGIN[2] + 0.05], tmp_path)
    result = find_trees((bare,), TreeParameters(), SilentMonitor())
    assert result.candidates == ()
    assert "none of 0 upright things" in result.note.en


@pytest.mark.parametrize("lean", [-0.1, 0.0, 0.06])
def test_an_axis_is_followed_as_far_as_it_leans(lean: float, tmp_path: Path) -> None:
    ground = _street(0.3)
    ground = ground[ground[:, 2] < _ORIGIN[2] + 0.1]
    drive = _drive(np.concatenate([ground, _column(_POLE, 0.1, 8.0, lean) + _ORIGIN]), tmp_path)
    below, _ = survey_columns([drive], SilentMonitor())
    about = _ORIGIN - below.plan.origin
    one = FoundColumns(
        (np.array(_POLE) + about[:2] + 0.15)[None], about[2:].copy(), np.array([15], np.uint32)
    )
    sums = sum_columns([drive], below.plan, one, SilentMonitor())
    top = sums.axes.base[0] + 7.5 * sums.axes.lean[0] - about[:2]
    assert np.hypot(*(top - (_POLE[0] + 7.5 * lean, _POLE[1]))) < 0.2
    facts = facts_of(sums, 0)
    assert facts is not None
    assert facts.free_low == 1.0
    assert facts.top_m == pytest.approx(8.0, abs=0.4)
    assert sums.slabs[0, :, ON].sum() > 100


def test_columns_are_labelled_by_the_things_of_the_street() -> None:
    up = np.arange(0.0, 4.0, 0.1)
    trunk = np.column_stack([np.full(40, 5.0), np.zeros(40), up])
    pole = trunk + np.array([10.0, 0.0, 0.0])
    stub = trunk[:10] + np.array([20.0, 0.0, 0.0])
    xyz = np.concatenate([trunk, pole, stub])
    instance = np.repeat([1, 2, 3], [40, 40, 10]).astype(np.int32)
    kinds = {1: "tree", 2: "pole", 3: "pole"}
    recording = CoarseRecording("street", xyz, np.full(90, 66, np.uint8), instance, kinds)
    places = np.array([[5.1, 0.0], [5.6, 0.0], [15.0, 0.2], [25.0, 0.0], [30.0, 0.0]])
    codes = label_columns(places, [2.0, 1.0, 1.5, 1.0, 2.0], recording)
    assert codes.tolist() == [1, -1, 2, -1, 0]
