"""Gutters that are open at their joints only, and asphalt that is open all over."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.road.gutters.gutter_axis import GutterAxis
from processing.methods.road.gutters.gutter_confidence import chance_of, facts_of
from processing.methods.road.gutters.gutter_contrast import contrast_of
from processing.methods.road.gutters.gutter_depths import JointDepths
from processing.methods.road.gutters.gutter_holes import JointNotches, hole_fit
from processing.methods.road.gutters.gutter_joints import LID, JointRow, RowNotches
from processing.methods.road.gutters.gutter_lids import GutterCover
from processing.methods.road.gutters.gutter_runs import GutterRun
from processing.methods.road.gutters.notches.notches import OPENING, Notches

LID_M, COUNT = 0.6, 20
STARTS = 1.0 + LID_M * np.arange(COUNT)
HOLES_M = (-0.095, 0.095)
Floats = np.ndarray[tuple[int], np.dtype[np.float64]]


def notches_at(along: Floats, across: Floats, raised_m: float = 0.0) -> Notches:
    """Openings of 5 cm² each beside a way along x."""
    empty, count = np.zeros(along.size), along.size
    return Notches(
        np.column_stack([along, -across, empty + raised_m]),
        time_s=empty,
        depth_m=empty + 0.1,
        width_m=empty + 0.03,
        spacing_m=empty + 0.01,
        steepness=empty + 0.5,
        pattern=np.full(count, OPENING, np.uint8),
        strength=empty + 0.9,
        row=np.arange(count),
        point=np.arange(count),
        station_m=along,
        across_m=across,
        pass_number=np.zeros(count, np.int64),
        direction=np.zeros((count, 2)),
        area_m2=empty + 0.0005,
        raised_m=empty + raised_m,
    )


def holes(raised_m: float = 0.0) -> Notches:
    """Two rows through each hole of each joint."""
    joints = np.append(STARTS, STARTS[-1] + LID_M)
    along = np.repeat(joints, 4) + np.tile([-0.005, 0.005], 2 * joints.size)
    return notches_at(along, np.tile(np.repeat(HOLES_M, 2), joints.size), raised_m)


def rough(count: int = 3_000) -> Notches:
    """Dents all over."""
    random = np.random.default_rng(4)
    return notches_at(random.uniform(0.0, 15.0, count), random.uniform(-0.7, 0.7, count))


def gutter(height_m: float = 0.0, over_chance: float = 10.0) -> GutterRun:
    axis = GutterAxis.through(np.array([[0.0, 0.0, height_m], [15.0, 0.0, height_m]]))
    row = JointRow(
        STARTS,
        STARTS + LID_M,
        np.full(COUNT, LID, np.int64),
        np.full((COUNT, 2), 4, np.int64),
        np.zeros(COUNT, np.bool_),
        40.0,
    )
    across = np.tile(HOLES_M, 20)
    at_joints = JointNotches(across, np.full(across.size, 0.07), np.ones(across.size))
    none = np.empty(0)
    notches, depths = RowNotches.of(none, none, none), JointDepths(none, none, none)
    return GutterRun(axis, row, hole_fit(at_joints), LID_M, over_chance, notches, depths, ())


def covers() -> tuple[GutterCover, ...]:
    return tuple(
        GutterCover(
            np.zeros((4, 3)),
            is_grating=False,
            is_bridged=False,
            width_m=0.38,
            length_m=LID_M,
            on_top=100,
            below=3,
            along_m=float(start) + LID_M / 2,
            seen=(4, 4),
            rough_m=0.002,
        )
        for start in STARTS
    )


def sure_of(notches: Notches, height_m: float = 0.0, over_chance: float = 10.0) -> Floats:
    facts = facts_of(gutter(height_m, over_chance), covers(), [notches])
    return np.array([chance_of(one) for one in facts])


def test_lids_are_open_at_their_joints_only() -> None:
    contrast = contrast_of(gutter(), [holes()])

    assert (contrast.lids > 2.0).all()
    assert (contrast.beside > 2.0).all()
    assert contrast.raised_m == 0.0
    assert (sure_of(holes()) > 0.8).all()


def test_coarse_asphalt_is_open_all_over_and_no_gutter() -> None:
    contrast = contrast_of(gutter(), [rough()])

    assert np.abs(contrast.lids).max() < 0.7
    assert np.abs(contrast.beside).max() < 0.7
    assert (sure_of(rough(), over_chance=2.5) < 0.4).all()


def test_two_heads_say_the_same_as_one() -> None:
    one, two = (contrast_of(gutter(), [holes()] * count) for count in (1, 2))

    assert two.lids == pytest.approx(one.lids, abs=0.8)


def test_gaps_of_a_hedge_are_no_holes() -> None:
    assert (sure_of(holes(0.6), 0.6) < 0.5).all()


def test_without_any_notch_nothing_is_known() -> None:
    nothing = notches_at(np.empty(0), np.empty(0))

    assert (sure_of(nothing, over_chance=0.0) < 0.5).all()
