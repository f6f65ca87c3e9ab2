"""Rough runs joined, drives pooled, holes bridged: curbs whose truth is a formula."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.curbs.edges.approximate_lines import (
    ApproximateLine,
    approximate_lines_of,
)
from processing.methods.road.curbs.edges.curb_joins import join_edges
from processing.methods.road.curbs.edges.curb_lines import lines_of
from processing.methods.road.curbs.edges.curb_smoothing import Smoothness, smooth_values
from processing.methods.road.curbs.edges.edge_measures import (
    ERROR_ACROSS,
    ERROR_HIGH,
    ERROR_LOW,
    FACE_POINTS,
    LEAN,
    LOWER_ABOVE,
    LOWER_ACROSS,
    MEASURES,
    STEP_M,
    UPPER_ABOVE,
    UPPER_ACROSS,
)
from processing.methods.road.curbs.steps.curb_confidence import confidence_of
from processing.methods.road.curbs.steps.curb_runs import StepRun

Floats = NDArray[np.float64]


def run_of(from_m: float, to_m: float, *, drive: int = 0, is_back: bool = False) -> StepRun:
    """A run of a curb along y = 5 m, on the left of a drive to the east, 3 cm off."""
    x = np.arange(from_m, to_m, 0.1)
    random = np.random.default_rng(int(10 * from_m) + drive)
    lower = np.column_stack([x, 5 + random.normal(0, 0.03, x.size), np.zeros(x.size)])
    upper = lower + np.array([0.0, 0.015, 0.15])
    one = np.ones(x.size)
    run = StepRun(
        drive=drive,
        side=-1,
        rises=1,
        stations_m=x,
        times_s=x / 10,
        lower=lower,
        upper=upper,
        is_seen=one > 0,
        face_m=one * 0.015,
        top_m=one * 0.3,
        foot_m=one * 0.3,
        spread_m=one * 0.03,
        significance=one * 20,
        foot_roughness_m=one * 0.003,
        foot_cover_m=one * 0.003,
        above_path_m=one * -0.05,
        risen_m=one * 0,
        verge_m=one * 0,
    )
    if not is_back:
        return run
    back = {name: getattr(run, name)[::-1] for name in ("lower", "upper")}
    return replace(run, side=1, **back)


def approximate_line_of(count: int) -> ApproximateLine:
    """A straight guide along x."""
    xyz = np.column_stack([np.arange(count) * STEP_M, np.full(count, 5.0), np.zeros(count)])
    return ApproximateLine(
        xyz,
        np.tile([0.0, 1.0], (count, 1)),
        np.ones(count, np.bool_),
        np.full(count, 0.15),
        np.full(count, 0.015),
        np.zeros(count, np.bool_),
        np.zeros(count, np.bool_),
        True,
        np.zeros(count, np.int64),
        0,
    )


def measures_of(count: int, *, across_m: float = 0.0, step_m: float = 0.15) -> Floats:
    """Measures of a curb as it is, with errors of 2 mm."""
    random = np.random.default_rng(count)
    measures = np.zeros((count, MEASURES))
    measures[:, [LOWER_ACROSS, UPPER_ACROSS]] = across_m + random.normal(0, 0.002, (count, 1))
    measures[:, UPPER_ACROSS] += 0.015
    measures[:, UPPER_ABOVE] = step_m + random.normal(0, 0.002, count)
    measures[:, LOWER_ABOVE] = random.normal(0, 0.002, count)
    measures[:, LEAN] = 0.1
    measures[:, FACE_POINTS] = 30.0
    measures[:, [ERROR_ACROSS, ERROR_LOW, ERROR_HIGH]] = 0.003
    return measures


def test_curbs_that_meet_at_a_corner_are_one_approximate_line() -> None:
    along = run_of(0.0, 10.0)
    ahead = along.lower[:, 0]
    # From the corner at (10, 5) into the side street, the higher ground on the left.
    into = [
        np.column_stack([np.full(ahead.size, 10.2 - aside), 5.4 + ahead, up * np.ones(ahead.size)])
        for aside, up in ((0.0, 0.0), (0.015, 0.15))
    ]
    across = replace(along, lower=into[0], upper=into[1])
    (approximate_line,) = approximate_lines_of([along, across], 8.0)
    assert np.hypot(*(approximate_line.xyz[0, :2] - [0.0, 5.0])) < 0.2
    assert np.hypot(*(approximate_line.xyz[-1, :2] - [10.2, 15.3])) < 0.3


def test_runs_there_and_back_are_one_approximate_line_along_the_first_drive() -> None:
    approximate_lines = approximate_lines_of(
        [run_of(0, 30), run_of(10, 50, drive=1, is_back=True)], 8.0
    )
    assert len(approximate_lines) == 1
    assert approximate_lines[0].is_along
    assert approximate_lines[0].xyz[0, 0] == pytest.approx(0.0, abs=0.3)
    assert approximate_lines[0].xyz[-1, 0] == pytest.approx(50.0, abs=0.3)
    assert np.abs(approximate_lines[0].xyz[:, 1] - 5.0).max() < 0.05


def test_a_parked_car_is_bridged_and_a_street_is_not() -> None:
    assert len(approximate_lines_of([run_of(0, 20), run_of(26, 40)], 8.0)) == 1
    assert len(approximate_lines_of([run_of(0, 20), run_of(32, 40)], 8.0)) == 2


def test_a_bridge_is_no_place_that_was_seen() -> None:
    approximate_line = approximate_lines_of([run_of(0, 20), run_of(26, 40)], 8.0)[0]
    inside = (approximate_line.xyz[:, 0] > 20.5) & (approximate_line.xyz[:, 0] < 25.5)
    assert inside.any()
    assert not approximate_line.is_seen[inside].any()
    assert (approximate_line.runs[inside] == -1).all()


def test_runs_on_both_sides_of_a_street_are_never_joined() -> None:
    other = run_of(0, 30)
    other = replace(other, side=1, lower=other.lower - [0, 8, 0], upper=other.lower - [0, 8.015, 0])
    assert len(approximate_lines_of([run_of(0, 30), other], 8.0)) == 2


def test_the_offset_between_two_drives_leaves_no_step_where_one_ends() -> None:
    one, other = measures_of(100), measures_of(100, across_m=0.04)
    one[60:] = np.nan
    edges = join_edges([one, other], 0.45)
    before, after = edges.lower_across[:55].mean(), edges.lower_across[65:].mean()
    assert before == pytest.approx(after, abs=0.003)


def test_what_is_higher_than_a_curb_is_left_out() -> None:
    edges = join_edges([measures_of(10, step_m=0.6)], 0.45)
    assert np.isnan(edges.lower_across).all()
    assert np.isinf(edges.across_error).all()


def test_a_hidden_stretch_is_bridged_and_marked() -> None:
    measures = measures_of(100)
    measures[40:60] = np.nan
    lines = list(lines_of(approximate_line_of(100), join_edges([measures], 0.45), 8.0))
    assert len(lines) == 1
    assert not lines[0].is_seen[40:60].any()
    np.testing.assert_allclose(lines[0].upper[:, 1], 5.015, atol=0.012)
    np.testing.assert_allclose(lines[0].steps_m, 0.15, atol=0.01)


def test_a_street_mouth_parts_a_curb() -> None:
    measures = measures_of(100)
    measures[40:60, UPPER_ABOVE] = measures[40:60, LOWER_ABOVE]
    lines = list(lines_of(approximate_line_of(100), join_edges([measures], 0.45), 8.0))
    assert [line.is_seen.size for line in lines] == [40, 40]


def test_a_curb_lowered_to_the_road_goes_on() -> None:
    step = np.interp(np.arange(100), [36, 40, 60, 64], [0.15, 0.0, 0.0, 0.15])
    measures = measures_of(100)
    measures[:, UPPER_ABOVE] = measures[:, LOWER_ABOVE] + step
    lines = list(lines_of(approximate_line_of(100), join_edges([measures], 0.45), 8.0))
    assert len(lines) == 1


def test_a_parked_car_in_the_middle_of_a_curb_does_not_lift_it() -> None:
    measures = measures_of(100)
    measures[40:50, UPPER_ABOVE] = 0.4
    line = next(iter(lines_of(approximate_line_of(100), join_edges([measures], 0.45), 8.0)))
    assert line.steps_m.max() < 0.17


def test_smoothing_keeps_a_corner_and_takes_noise_away() -> None:
    at = np.arange(200)
    true = np.where(at < 100, 0.0, (at - 100) * 0.02)
    noisy = true + np.random.default_rng(3).normal(0, 0.005, at.size)
    found = smooth_values(noisy, np.ones(at.size), Smoothness(12.0, 0.004))
    assert math.sqrt(float(((found - true) ** 2).mean())) < 0.003
    assert abs(found[100]) < 0.015


def test_smoothing_bridges_what_is_not_known() -> None:
    values = np.where((np.arange(50) > 20) & (np.arange(50) < 30), np.nan, np.arange(50) * 0.1)
    found = smooth_values(values, np.isfinite(values).astype(float), Smoothness(12.0, 0.01))
    np.testing.assert_allclose(found, np.arange(50) * 0.1, atol=1e-6)


def test_what_comes_down_as_far_as_it_rose_is_likely_the_far_side_of_an_island() -> None:
    far = replace(run_of(0.0, 6.0), rises=-1, significance=np.full(60, 9.0), top_m=np.zeros(60))
    island = replace(far, risen_m=np.full(60, 0.15))
    assert confidence_of(island) > confidence_of(far) + 0.1
    assert confidence_of(replace(far, risen_m=np.full(60, 0.4))) == confidence_of(far)
    levee = replace(island, above_path_m=np.full(60, -0.3))
    assert confidence_of(levee) == confidence_of(far)
