"""The lids that holes and joints tell of: standard ones, seen by rows along and across."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.road.gutters.gutter_holes import LID_TYPES, JointNotches, LidType, hole_fit


def seen_by_oblique_rows(one: LidType, count: int, groove: float) -> JointNotches:
    """Small openings anywhere in the holes and, a share of them, in the joint beside them."""
    random = np.random.default_rng(1)
    holes = random.uniform(-one.hole_wide_m / 2, one.hole_wide_m / 2, count)
    if one.holes == 2:
        holes += random.choice([-1, 1], count) * one.width_m / 4
    joint = random.uniform(-one.width_m / 2, one.width_m / 2, count)
    is_groove = random.random(count) < groove
    across = np.where(is_groove, joint, holes) + 0.05
    return JointNotches(across, np.full(count, 0.03), np.ones(count))


@pytest.mark.parametrize("one", [LID_TYPES[k] for k in (0, 1, 3, 4, 5)])
@pytest.mark.parametrize("groove", [0.0, 0.5])
def test_the_lid_is_told_though_joints_are_open_beside_its_holes(
    one: LidType, groove: float
) -> None:
    fit = hole_fit(seen_by_oblique_rows(one, 400, groove))
    assert fit.type.width_m == pytest.approx(one.width_m, abs=0.011)
    assert fit.middle_m == pytest.approx(0.05, abs=0.011)
    assert fit.gain > 0.2


def test_rows_square_to_the_gutter_see_how_wide_holes_are() -> None:
    random = np.random.default_rng(2)
    across = np.tile([-0.095, 0.095], 10) + random.normal(0, 0.015, 20)
    fit = hole_fit(JointNotches(across, np.full(20, 0.10), np.ones(20)))
    assert fit.type.width_m == 0.38
    across = random.normal(0, 0.015, 20)
    one = hole_fit(JointNotches(across, np.full(20, 0.18), np.ones(20)))
    assert (one.type.holes, one.type.hole_wide_m) == (1, 0.18)


def test_notches_anywhere_gain_nothing() -> None:
    across = np.linspace(-0.44, 0.44, 200)
    notches = JointNotches(across, np.full(200, 0.03), np.ones(200))
    assert hole_fit(notches).gain < 0.05


def test_a_groove_along_the_road_is_taken_off_what_is_seen_at_joints() -> None:
    lids = seen_by_oblique_rows(LID_TYPES[0], 60, 0.0)
    random = np.random.default_rng(3)
    beside = random.normal(0.27, 0.01, 60 + 400)
    across = np.concatenate([lids.across_m, beside])
    narrow = np.full(across.size, 0.03)
    at_joints = JointNotches(across[:120], narrow[:120], np.ones(120))
    worth = np.concatenate([np.ones(120), np.full(400, -60 / 400)])
    alone = hole_fit(lids)
    taken_off = hole_fit(JointNotches(across, narrow, worth))
    assert taken_off.type == alone.type
    assert taken_off.count == 60
    assert taken_off.gain > 0.9 * alone.gain > hole_fit(at_joints).gain + 0.3
