"""Gutters from notches: made of joints that are known exactly, with noise, drop-outs and others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.curbs.edges.curb_points import PointsAbout
from processing.methods.road.gutters.gutter_axis import STEP_M, GutterAxis
from processing.methods.road.gutters.gutter_joints import (
    GRATING,
    RowKnown,
    RowNotches,
    joint_row,
    lengths_of,
)
from processing.methods.road.gutters.gutter_lids import covers_of
from processing.methods.road.gutters.gutter_outline import edge_lines
from processing.methods.road.gutters.gutter_runs import GutterRun, gutter_runs
from processing.methods.road.gutters.notches.notches import OPENING, Notches
from processing.recording.passes import Pass, passes_of_trajectory
from processing.recording.vehicle_path.trajectory import Trajectory

LID_M, JOINT_M, WIDTH_M = 0.6, 0.006, 0.38
HOLES_M = 0.095
ASIDE_M = 3.4
COUNT = 60
BEGIN_M = 10.0
LIDS = (lengths_of((LID_M,), (0.5, 1.0)),)

Floats = NDArray[np.float64]


def vehicle_path(radius_m: float) -> Pass:
    """Sixty metres, straight or to the left."""
    driven = np.arange(0.0, 60.0, 0.5)
    turned = driven / radius_m
    xyz = np.column_stack(
        [radius_m * np.sin(turned), radius_m * (1 - np.cos(turned)), 2.0 + 0.02 * driven]
    )
    (found,) = passes_of_trajectory(Trajectory.from_positions(driven / 8.0, xyz + 1_000.0))
    return found


def joints(count: int = COUNT) -> Floats:
    return np.arange(count + 1, dtype=np.float64) * (LID_M + JOINT_M)


def notches_at(one: Pass, along_m: Floats, across_m: Floats, strength: float = 0.9) -> Notches:
    """Notches whose places along the gutter are given in its own metres."""
    station = np.arange(0.0, 58.0, 0.05)
    line = one.xyz_at(station, np.full(station.size, ASIDE_M))
    arcs = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T))])
    at = np.interp(along_m + BEGIN_M, arcs, station)
    xyz = one.xyz_at(at, ASIDE_M + across_m)
    xyz[:, 2] -= 2.5
    empty = np.zeros(at.size)
    return Notches(
        xyz,
        one.time_at(at),
        empty + 0.2,
        empty + 0.03,
        empty + 0.01,
        empty + 2.0,
        np.full(at.size, OPENING, np.uint8),
        empty + strength,
        np.arange(at.size),
        np.arange(at.size),
        at,
        ASIDE_M + across_m,
        np.zeros(at.size, np.int64),
        np.zeros((at.size, 2)),
        empty,
        empty,
    )


def alone_at(along_m: Floats) -> RowNotches:
    """Openings of full strength, with nothing open beside them."""
    return RowNotches.of(along_m, np.zeros(along_m.size), np.ones(along_m.size))


def holes_seen(random: np.random.Generator, share: float) -> tuple[Floats, Floats]:
    """Along and across of the holes that rows fell into, each joint with two."""
    along = np.repeat(joints(), 2)
    across = np.tile([-HOLES_M, HOLES_M], COUNT + 1)
    is_seen = random.random(along.size) < share
    along = along[is_seen] + random.normal(0, 0.008, int(is_seen.sum()))
    return along, across[is_seen] + random.uniform(-0.05, 0.05, along.size)


@pytest.mark.parametrize("radius_m", [1e6, 40.0])
def test_lids_are_found_by_half_of_their_holes_also_in_a_bend(radius_m: float) -> None:
    one, random = vehicle_path(radius_m), np.random.default_rng(5)
    (run,) = gutter_runs([one], [notches_at(one, *holes_seen(random, 0.5))], 5)
    assert run.length_m == LID_M
    assert run.holes.type.width_m == WIDTH_M
    assert COUNT - 2 <= run.row.starts_m.size <= COUNT + 1
    np.testing.assert_allclose(run.row.ends_m - run.row.starts_m, LID_M, atol=0.002)
    np.testing.assert_allclose(np.diff(run.row.starts_m), LID_M + JOINT_M, atol=0.008)


def test_two_heads_together_find_what_neither_finds_alone() -> None:
    one, random = vehicle_path(1e6), np.random.default_rng(3)
    heads = [notches_at(one, *holes_seen(random, 0.35)) for _ in range(2)]
    (run,) = gutter_runs([one, one], heads, 5)
    assert run.row.starts_m.size >= COUNT - 2


def test_notches_by_chance_are_no_gutter() -> None:
    one, random = vehicle_path(1e6), np.random.default_rng(7)
    along, across = random.uniform(0, 40, 300), random.uniform(-1.5, 1.5, 300)
    found = gutter_runs([one], [notches_at(one, along, across)], 5)
    assert sum(run.row.starts_m.size for run in found if run.holes.gain > 0.3) < 10


def test_a_long_step_is_no_gutter() -> None:
    one, random = vehicle_path(1e6), np.random.default_rng(9)
    along = np.arange(0.0, 40.0, 0.07) + random.normal(0, 0.01, 572)
    found = gutter_runs([one], [notches_at(one, along, np.zeros(along.size))], 5)
    assert sum(run.row.starts_m.size for run in found if run.row.value > 18) == 0


def test_a_far_gutter_is_found_by_few_of_its_joints() -> None:
    one, random = vehicle_path(1e6), np.random.default_rng(4)
    along = joints(75)[random.random(76) < 0.5]
    along = along + random.normal(0, 0.008, along.size)
    beside = random.uniform(0, 45, 60), random.uniform(-1.5, 1.5, 60)
    across = random.choice([-HOLES_M, HOLES_M], along.size)
    positions = np.concatenate([along, beside[0]]), np.concatenate([across, beside[1]])
    (run,) = gutter_runs([one], [notches_at(one, *positions)], 8)
    assert run.length_m == LID_M
    assert run.row.starts_m.size > 30


def test_lids_of_two_lengths_may_be_mixed() -> None:
    one, random = vehicle_path(1e6), np.random.default_rng(6)
    lids = random.choice([0.5, 0.6], 60)
    along = np.repeat(np.concatenate([[0.0], np.cumsum(lids + JOINT_M)]), 4)
    across = np.tile([-HOLES_M, HOLES_M], along.size // 2)
    (run,) = gutter_runs([one], [notches_at(one, along, across)], 5)
    assert run.row.starts_m.size >= 58
    short = np.isclose(run.row.ends_m - run.row.starts_m, 0.5, atol=0.02).sum()
    assert abs(int(short) - int((lids == 0.5).sum())) <= 2


def test_joints_at_a_spacing_that_no_lids_have_are_no_gutter() -> None:
    one = vehicle_path(1e6)
    along = np.repeat(np.arange(40) * 0.68, 2)
    across = np.tile([-HOLES_M, HOLES_M], 40)
    assert gutter_runs([one], [notches_at(one, along, across)], 5) == ()


def test_grooves_between_blocks_are_no_gutter() -> None:
    one, random = vehicle_path(1e6), np.random.default_rng(8)
    along = np.repeat(joints(60), 3)
    grooves = notches_at(one, along, random.uniform(-0.25, 0.25, along.size))
    shallow = replace(grooves, depth_m=np.full(grooves.count, 0.012))
    assert gutter_runs([one], [shallow], 5) == ()


def test_a_walk_with_joints_of_its_own_lifts_no_gutter() -> None:
    one, random = vehicle_path(1e6), np.random.default_rng(10)
    gutter = notches_at(one, *holes_seen(random, 0.4))
    along, across = random.uniform(0, 37, 900), random.uniform(0.2, 1.2, 900)
    walk = notches_at(one, along, across, 0.15)
    raised = replace(walk, xyz=walk.xyz + np.array([0.0, 0.0, 0.2]))
    run, *_ = gutter_runs([one], [gutter, raised], 5)
    _, _, above = run.axis.coordinates_of(gutter.xyz, 0.5)
    np.testing.assert_allclose(above, 0.0, atol=0.05)
    assert run.row.starts_m.size >= COUNT - 2


@pytest.mark.parametrize("gap_m", [3.2, JOINT_M])
def test_lids_of_another_type_are_a_gutter_of_their_own(gap_m: float) -> None:
    one, random = vehicle_path(1e6), np.random.default_rng(11)
    along = np.repeat(joints(30), 4)
    twin = random.choice([-HOLES_M, HOLES_M], along.size)
    far_m = along.max() + gap_m
    behind = notches_at(one, along + far_m, random.uniform(-0.07, 0.07, along.size))
    before = notches_at(one, along, twin + random.uniform(-0.04, 0.04, along.size))
    found = gutter_runs([one], [before, behind], 5)
    assert sorted((run.holes.type.holes, run.row.starts_m.size) for run in found) == [
        (1, pytest.approx(30, abs=1)),
        (2, pytest.approx(30, abs=1)),
    ]


def test_nothing_is_found_where_there_are_no_notches() -> None:
    one = vehicle_path(1e6)
    assert gutter_runs([one], [], 5) == ()
    assert gutter_runs([one], [notches_at(one, np.empty(0), np.empty(0))], 5) == ()


def test_a_joint_that_nobody_saw_is_laid_by_its_neighbours() -> None:
    known = np.repeat(joints(20), 3)
    hidden = joints(20)[9:11]
    is_seen = ~np.isin(known, hidden)
    row = joint_row(alone_at(known[is_seen]), LIDS, 12.5, RowKnown(5))
    assert row is not None
    assert row.starts_m.size == 20
    ends = row.ends_m[8:10] + JOINT_M / 2
    np.testing.assert_allclose(ends, hidden, atol=0.01)
    assert row.is_bridged.sum() == 1


def test_more_lids_than_allowed_without_a_hole_are_a_gap() -> None:
    known = np.repeat(joints(30), 3)
    is_seen = (known < joints(30)[10] + 0.01) | (known > joints(30)[20] - 0.01)
    row = joint_row(alone_at(known[is_seen]), LIDS, 18.5, RowKnown(3))
    assert row is not None
    assert np.diff(row.starts_m).max() > 3.0


def test_a_grating_between_lids_is_one() -> None:
    before, behind = joints(10), joints(10)[-1] + 0.506 + joints(10)
    bars = np.arange(before[-1] + 0.01, behind[0] - 0.01, 0.03)
    along = np.concatenate([np.repeat(before, 3), bars, np.repeat(behind, 3)])
    row = joint_row(alone_at(along), LIDS, float(behind[-1]) + 0.2, RowKnown(5))
    assert row is not None
    (grating,) = np.flatnonzero(row.what == GRATING)
    assert row.starts_m[grating] == pytest.approx(before[-1], abs=0.02)
    assert row.ends_m[grating] - row.starts_m[grating] == pytest.approx(0.5)


def points_on(run: GutterRun, random: np.random.Generator, sunken: int) -> PointsAbout:
    along = random.uniform(0, run.axis.length_m, 30_000)
    across = random.uniform(-0.4, 0.4, along.size)
    above = 0.02 * across + random.normal(0, 0.002, along.size)
    is_sunken = (along > run.row.starts_m[sunken]) & (along < run.row.ends_m[sunken])
    above[is_sunken] -= 0.025
    above[::10] += 0.05
    return PointsAbout(
        np.array([0, along.size]), along / STEP_M, across, above, np.arange(along.size)
    )


def test_lids_lie_on_their_own_tops_at_their_true_size() -> None:
    one, random = vehicle_path(1e6), np.random.default_rng(2)
    (run,) = gutter_runs([one], [notches_at(one, *holes_seen(random, 0.9))], 5)
    covers = covers_of(run, 0, [points_on(run, random, 10)])
    cover = covers[20]
    sides = np.linalg.norm(np.diff(cover.corners[:, :2], axis=0), axis=1)
    np.testing.assert_allclose(sides, [LID_M, WIDTH_M, LID_M], atol=0.003)
    _, across, above = run.axis.coordinates_of(cover.corners, 0.5)
    np.testing.assert_allclose(above, 0.02 * across, atol=0.004)
    _, across, above = run.axis.coordinates_of(covers[10].corners, 0.5)
    np.testing.assert_allclose(above, 0.02 * across - 0.025, atol=0.004)
    assert not cover.is_grating
    (ahead_x, ahead_y), (left_x, left_y) = np.diff(cover.corners[:3, :2], axis=0)
    assert ahead_x * left_y - ahead_y * left_x > 0


def test_the_outline_is_both_long_edges() -> None:
    one, random = vehicle_path(1e6), np.random.default_rng(2)
    (run,) = gutter_runs([one], [notches_at(one, *holes_seen(random, 0.9))], 5)
    covers = covers_of(run, 0, [points_on(run, random, 10)])
    left, right = edge_lines(covers, 6.0)
    long_m = run.row.ends_m[-1] - run.row.starts_m[0]
    for edge in (left, right):
        assert np.hypot(*np.diff(edge[[0, -1], :2], axis=0)[0]) == pytest.approx(long_m, abs=0.01)
    assert np.hypot(*(left[0] - right[0])[:2]) == pytest.approx(0.38, abs=0.005)


def test_an_axis_tells_places_as_it_gives_them() -> None:
    turn = np.linspace(0, 1, 60)
    axis = GutterAxis.through(np.column_stack([30 * np.sin(turn), 30 * np.cos(turn), turn]))
    along, across = np.linspace(1, 25, 40), np.linspace(-0.4, 0.4, 40)
    told = axis.coordinates_of(axis.positions(along, across), 0.5)
    np.testing.assert_allclose(told[0], along, atol=0.01)
    np.testing.assert_allclose(told[1], across, atol=0.003)
    np.testing.assert_allclose(told[2], 0.0, atol=0.003)
