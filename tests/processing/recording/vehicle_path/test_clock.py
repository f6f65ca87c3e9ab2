"""Times of points are brought to the trajectory's clock, or the refusal says why not."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.errors import OutOfRange
from processing.recording.vehicle_path.clock import (
    ADJUSTMENT_S,
    DAY_S,
    WEEK_S,
    ClockKind,
    are_within_days,
    kind_of,
    match_clock,
)
from processing.recording.vehicle_path.trajectory import Trajectory

MONDAY_MORNING = 120_000.0
ABSOLUTE = 2_300 * WEEK_S


def _trajectory(first: float, last: float) -> Trajectory:
    time = np.arange(first, last, 0.5)
    return Trajectory.from_positions(time, np.column_stack([time - first] * 3))


def _points(first: float, last: float) -> np.ndarray:
    return np.linspace(first, last, 50)


@pytest.mark.parametrize(
    ("point_clock", "pose_clock"),
    [
        (MONDAY_MORNING, MONDAY_MORNING),
        (ABSOLUTE + MONDAY_MORNING, MONDAY_MORNING),
        (MONDAY_MORNING, ABSOLUTE + MONDAY_MORNING),
        (ABSOLUTE + MONDAY_MORNING - ADJUSTMENT_S, ABSOLUTE + MONDAY_MORNING),
        (ABSOLUTE + MONDAY_MORNING, ABSOLUTE + MONDAY_MORNING - ADJUSTMENT_S),
        (ABSOLUTE + MONDAY_MORNING - ADJUSTMENT_S, MONDAY_MORNING),
        (MONDAY_MORNING, ABSOLUTE + MONDAY_MORNING - ADJUSTMENT_S),
        (MONDAY_MORNING - DAY_S, MONDAY_MORNING),
        (MONDAY_MORNING - DAY_S, ABSOLUTE + MONDAY_MORNING - ADJUSTMENT_S),
        (WEEK_S + 20.0, 20.0),
        (DAY_S + 20.0, 20.0),
    ],
)
def test_points_and_trajectory_meet_whatever_their_clocks(point_clock, pose_clock):
    times = _points(point_clock + 5, point_clock + 95)
    trajectory = _trajectory(pose_clock, pose_clock + 100)
    shift = match_clock(times, trajectory, "left.laz")
    assert shift == pose_clock - point_clock


def test_a_drive_over_the_end_of_the_week_keeps_its_running_seconds():
    trajectory = _trajectory(WEEK_S - 50, WEEK_S + 50)
    assert match_clock(_points(WEEK_S - 40, WEEK_S + 40), trajectory, "left.laz") == 0.0


def test_lost_times_are_passed_over():
    times = _points(1_005.0, 1_095.0)
    times[::7] = np.nan
    assert match_clock(times, _trajectory(1_000.0, 1_100.0), "left.laz") == 0.0


def test_the_same_hour_of_another_day_does_not_fit():
    with pytest.raises(OutOfRange):
        match_clock(
            _points(MONDAY_MORNING + DAY_S, MONDAY_MORNING + DAY_S + 90),
            _trajectory(MONDAY_MORNING, MONDAY_MORNING + 100),
            "left.laz",
        )


def test_leap_seconds_are_named_but_never_applied():
    with pytest.raises(OutOfRange) as caught:
        match_clock(_points(1_118.0, 1_208.0), _trajectory(1_100.0, 1_190.0), "left.laz")
    assert "18 s" in caught.value.remedy.en
    assert "18秒" in caught.value.remedy.ja


def test_a_refusal_names_both_ranges_and_the_recording():
    with pytest.raises(OutOfRange) as caught:
        match_clock(_points(5_000.0, 5_090.0), _trajectory(1_000.0, 1_100.0), "left.laz")
    assert "5000.000 to 5090.000" in caught.value.what.en
    assert "1000.000 to 1099.500" in caught.value.what.en
    assert "5000.000～5090.000" in caught.value.what.ja
    assert caught.value.where.en == "left.laz"


def test_points_without_any_time_are_refused():
    with pytest.raises(OutOfRange):
        match_clock(np.full(5, np.nan), _trajectory(0.0, 10.0), "left.laz")


@pytest.mark.parametrize(
    ("first", "flag", "kind"),
    [
        (0.0, None, ClockKind.WEEK_SECONDS),
        (63_353.0, True, ClockKind.WEEK_SECONDS),
        (376_892_634.0, True, ClockKind.ADJUSTED_STANDARD),
        (1_376_892_634.0, None, ClockKind.STANDARD),
        (-5_000_000.0, None, ClockKind.ADJUSTED_STANDARD),
        (900_000_000.0, False, ClockKind.STANDARD),
        (1e12, None, ClockKind.UNKNOWN),
    ],
)
def test_a_clock_is_known_by_the_size_of_its_times(first, flag, kind):
    assert kind_of([first, first + 10.0], is_adjusted_standard=flag) is kind


def test_no_times_tell_no_clock():
    assert kind_of([np.nan]) is ClockKind.UNKNOWN


@pytest.mark.parametrize(
    ("one", "other", "within"),
    [
        (3.5e8, 3.5e8 + 0.9 * DAY_S, True),
        (3.5e8, 3.5e8 + 1.1 * DAY_S, False),
        (-3.5e8, -3.5e8 + 30 * DAY_S, False),
        (ABSOLUTE, ABSOLUTE + 30 * DAY_S, False),
        (3.5e8, 120_000.0, False),  # another clock
        (120_000.0, 120_300.0, True),  # of two weeks perhaps: nothing tells
        (120_000.0, 120_000.0 + 3 * DAY_S, False),  # of whichever weeks
        (WEEK_S - 500.0, 300.0, True),  # Saturday's midnight
        (WEEK_S - 500.0, WEEK_S + 300.0, True),  # the same, counted on
    ],
)
def test_times_tell_whether_more_than_a_day_lies_between(one, other, within):
    spans = (one, one + 100.0), (other, other + 100.0)
    assert are_within_days(*spans) is within
    assert are_within_days(*spans[::-1]) is within
