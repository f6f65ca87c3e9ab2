"""Where lids lie across a gutter: grooves beside lids whose middle and width are known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.gutters.gutter_axis import GutterAxis
from processing.methods.road.gutters.gutter_holes import LID_TYPES, JointNotches, LidType
from processing.methods.road.gutters.gutter_sides import SideNotches, lids_across

Floats = NDArray[np.float64]

LENGTH_M = 40.0
NONE = JointNotches(np.empty(0), np.empty(0), np.empty(0))


def straight_axis() -> GutterAxis:
    return GutterAxis.through(np.array([[0.0, 0.0, 0.0], [LENGTH_M, 0.0, 0.0]]))


def middles(axis: GutterAxis, moved: GutterAxis) -> Floats:
    """How far a moved axis lies to the right of the old one."""
    return axis.coordinates_of(moved.xyz, 0.5)[1]


def notches_in_grooves(one: LidType, middle: Floats, seed: int, dirt: int) -> SideNotches:
    """Some on either side of lids, with dirt anywhere."""
    random = np.random.default_rng(seed)
    along = random.uniform(0.0, LENGTH_M, 300)
    side = random.choice([-0.5, 0.5], along.size) * one.width_m
    across = np.interp(along, np.linspace(0.0, LENGTH_M, middle.size), middle) + side
    across += random.normal(0.0, 0.006, along.size)
    more = random.uniform(0.0, LENGTH_M, dirt), random.uniform(-0.45, 0.45, dirt)
    return SideNotches(np.concatenate([along, more[0]]), np.concatenate([across, more[1]]))


@pytest.mark.parametrize("one", LID_TYPES[:4], ids=lambda one: f"{one.width_m:.2f}")
def test_grooves_tell_the_type_and_the_middle_of_lids_among_dirt(one: LidType) -> None:
    axis = straight_axis()
    sides = notches_in_grooves(one, np.array([0.06, 0.06]), 1, 200)
    found = lids_across(axis, (np.empty(0), NONE), sides)
    assert found.type.width_m == one.width_m
    assert np.abs(middles(axis, found.axis) - 0.06).max() < 0.01


def test_the_middle_follows_a_gutter_that_bends_beside_its_axis() -> None:
    axis = straight_axis()
    at = np.linspace(-1.0, 1.0, 81)
    bend = 0.1 - 0.2 * at**2  # a radius of a kilometre
    found = lids_across(axis, (np.empty(0), NONE), notches_in_grooves(LID_TYPES[0], bend, 2, 50))
    off = middles(axis, found.axis) - np.interp(np.linspace(-1, 1, len(axis.xyz)), at, bend)
    assert np.abs(off).max() < 0.015


def test_holes_tell_which_of_two_lines_is_no_groove() -> None:
    """A bed's edge is a line too; two holes at the quarter points say where the lids are."""
    axis, random = straight_axis(), np.random.default_rng(3)
    groove, edge = -0.19 + random.normal(0, 0.005, 150), 0.30 + random.normal(0, 0.005, 150)
    sides = SideNotches(random.uniform(0, LENGTH_M, 300), np.concatenate([groove, edge]))
    along = np.repeat(np.arange(0.0, LENGTH_M, 0.6), 2)
    across = np.tile([-0.095, 0.095], along.size // 2) + random.normal(0, 0.02, along.size)
    holes = JointNotches(across, np.full(along.size, 0.03), np.ones(along.size))
    found = lids_across(axis, (along, holes), sides)
    assert found.type.width_m == LID_TYPES[0].width_m
    assert np.abs(middles(axis, found.axis)).max() < 0.02


def test_without_any_notch_the_axis_stays() -> None:
    axis = straight_axis()
    found = lids_across(axis, (np.empty(0), NONE), SideNotches(np.empty(0), np.empty(0)))
    assert np.abs(middles(axis, found.axis)).max() < 1e-6
