"""Lids over a channel against blocks laid at the same spacing, by how deep their joints are."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.gutters.gutter_depths import JointDepths, are_deep
from processing.methods.road.gutters.gutter_holes import LID_TYPES, HoleFit
from processing.methods.road.gutters.gutter_joints import GRATING, LID, JointRow

LID_M = 0.6
ANYWHERE = HoleFit(LID_TYPES[0], 0.0, 0.6, 100, 0.0)
"""What grooves gain, that are open all across."""


def row_of(count: int, grating: int = -1) -> JointRow:
    starts = np.arange(count, dtype=np.float64) * LID_M
    what = np.where(np.arange(count) == grating, GRATING, LID)
    seen = np.ones((count, 2), np.int64)
    return JointRow(starts, starts + LID_M - 0.005, what, seen, np.zeros(count, np.bool_), 50.0)


def steep(along: NDArray[np.float64], depth: NDArray[np.float64]) -> JointDepths:
    """Seen by rows square to the gutter, by beams that come down as far as they go aside."""
    square = np.ones(along.size)
    return JointDepths.of(along, depth, square, square)


def depths(count: int, share_deep: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Two notches at each joint, some of them in holes, the others in the groove beside."""
    random = np.random.default_rng(3)
    along = np.repeat(np.arange(1, count) * LID_M, 2)
    is_deep = random.random(along.size) < share_deep
    depth = np.where(is_deep, 0.06, random.uniform(0.009, 0.014, along.size))
    return along + random.normal(0, 0.008, along.size), depth


def test_lids_are_kept_though_soil_fills_most_of_their_holes() -> None:
    assert are_deep(row_of(40), steep(*depths(40, 0.3)), ANYWHERE).all()


def test_blocks_that_go_on_where_lids_end_are_told_apart() -> None:
    along, depth = depths(80, 0.4)
    depth[along > 40 * LID_M + 0.1] = 0.012
    found = are_deep(row_of(80), steep(along, depth), ANYWHERE)
    assert found[:38].all()
    assert not found[44:].any()


def test_a_grating_between_blocks_makes_them_no_lids() -> None:
    along, depth = depths(60, 0.0)
    bars = 30 * LID_M + np.linspace(0.0, LID_M, 20)
    along, depth = np.append(along, bars), np.append(depth, np.full(20, 0.2))
    assert not are_deep(row_of(60, grating=30), steep(along, depth), ANYWHERE).any()


def test_without_joints_nothing_is_said() -> None:
    assert are_deep(row_of(1), steep(np.empty(0), np.empty(0)), ANYWHERE).all()


def test_far_lids_are_told_by_the_places_of_their_holes() -> None:
    along, depth = depths(40, 0.0)
    at_holes = HoleFit(LID_TYPES[0], 0.0, 1.5, 60, 40.0)
    assert not are_deep(row_of(40), steep(along, depth), ANYWHERE).any()
    assert are_deep(row_of(40), steep(along, depth), at_holes).all()
    few = HoleFit(LID_TYPES[0], 0.0, 1.5, 4, 2.0)
    assert not are_deep(row_of(40), steep(along, depth), few).any()


def test_shallow_notches_say_nothing_where_beams_come_in_too_flat_for_deep_ones() -> None:
    along, depth = depths(40, 0.0)
    flat = JointDepths.of(along, depth, np.full(along.size, 0.3), np.full(along.size, 0.4))
    assert are_deep(row_of(40), flat, HoleFit(LID_TYPES[0], 0.0, 1.0, 60, 25.0)).all()
