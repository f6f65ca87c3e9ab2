"""The pulse clock is found from times, followed as it drifts, and anchored anew after a stop."""

from __future__ import annotations

import numpy as np
import pytest

from processing.recording.columns.point_source import PointColumns
from processing.recording.revolutions import pulse_clock_kernels, reference_times, vehicle_frame
from processing.recording.revolutions.pulse_clock import PulseNumbering, estimate_clock


def points_at(time: np.ndarray, returns: np.ndarray | None = None) -> PointColumns:
    ones = np.ones(time.size, dtype=np.uint8)
    xyz = np.arange(3 * time.size, dtype=np.int32).reshape(-1, 3)
    number = ones if returns is None else returns
    of = ones if returns is None else np.where(returns > 0, 2, 1).astype(np.uint8)
    return PointColumns(xyz, (0.001,) * 3, (0.0,) * 3, time, number, of)


def numbers_of(points: PointColumns) -> np.ndarray:
    clock = estimate_clock([points])
    assert clock is not None
    return PulseNumbering(clock, float(points.time[0]), 0).number(points, is_last=True)


def test_a_clock_that_drifts_is_followed_through_sky_gaps():
    pulse = np.arange(2_000_000)
    pulse = pulse[(pulse % 3_000) < 1_600]
    interval = 1 / 300_000
    # 20 ppm off over 6.7 s and back: 27 pulses away from a steady clock.
    time = pulse * interval + 27 * interval * np.sin(pulse / 2_000_000 * np.pi)
    assert (numbers_of(points_at(time)) == pulse).all()


def test_numbers_go_on_after_a_stop_by_the_time_that_passed():
    pulse = np.concatenate([np.arange(5_000), np.arange(900_000, 905_000)])
    time = pulse / 100_000.0
    time[5_000:] += 0.3e-5
    numbers = numbers_of(points_at(time))
    assert (np.diff(numbers)[:4_999] == 1).all()
    assert (np.diff(numbers)[5_000:] == 1).all()
    assert numbers[5_000] == pytest.approx(900_000, abs=2)


def test_equal_times_with_rising_returns_are_one_pulse():
    pulse = np.repeat(np.arange(2_000), 2)
    returns = np.tile([1, 2], 2_000).astype(np.uint8)
    assert (numbers_of(points_at(pulse / 50_000.0, returns)) == pulse).all()


def test_the_same_point_delivered_twice_is_one_pulse():
    time = np.arange(3_000) / 50_000.0
    points = points_at(time)
    twice = np.repeat(np.arange(3_000), 2)
    ones = np.ones(6_000, dtype=np.uint8)
    doubled = PointColumns(points.xyz[twice], points.scale, points.offset, time[twice], ones, ones)
    assert (numbers_of(doubled) == twice).all()


@pytest.mark.parametrize("quantum", [1e-7, 1e-6])
def test_times_rounded_to_decimals_have_the_interval_of_the_pulses(quantum):
    pulse = np.flatnonzero(np.random.default_rng(0).uniform(size=60_000) < 0.8)
    time = np.round(pulse / 291_971.6 / quantum) * quantum
    clock = estimate_clock([points_at(time)])
    assert clock is not None
    assert 1 / clock.interval_s == pytest.approx(291_971.6, rel=1e-6)
    assert (np.diff(numbers_of(points_at(time))) == np.diff(pulse)).all()


@pytest.mark.parametrize(
    "time",
    [
        np.sort(np.random.default_rng(0).uniform(0, 1, 5_000)),
        np.zeros(5_000),
        np.arange(40) / 1e5,
    ],
    ids=["random", "one time", "too few"],
)
def test_times_without_a_rhythm_have_no_clock(time):
    assert estimate_clock([points_at(time)]) is None


def test_a_thinned_recording_whose_steps_avoid_their_middle_has_no_clock():
    steps = np.resize([1e-5, 16e-5], 4001)
    assert estimate_clock([points_at(np.cumsum(steps))]) is None


def test_the_exact_kernel_does_compiled_what_it_does_plain():
    time = np.sort(np.random.default_rng(1).choice(np.arange(3_000), 900, replace=False)) / 1e5
    time[500:] += 2.0
    found = []
    kernel = pulse_clock_kernels._number_exact_kernel
    for function in (kernel, kernel.py_func):
        pulses = np.empty(time.size, dtype=np.int64)
        function(time, 1.0, pulse_clock_kernels.new_state(0.0, 1e-5), pulses)
        found.append(pulses)
    assert (found[0] == found[1]).all()


def test_the_kernel_of_shared_times_does_compiled_what_it_does_plain():
    quantum = 3.9e-6
    kept = np.sort(np.random.default_rng(1).choice(np.arange(4_000), 2_500, replace=False))
    time = np.floor(kept * 1e-6 / quantum) * quantum
    time[2_000:] += 2.0
    repeats = np.zeros(time.size, dtype=bool)
    found = []
    kernel = pulse_clock_kernels._number_rounded_kernel
    for function in (kernel, kernel.py_func):
        pulses = np.empty(time.size, dtype=np.int64)
        state = pulse_clock_kernels.new_state(0.0, 1e-6)
        function(time, repeats, pulse_clock_kernels.TimeLimits(quantum, 1.0), state, pulses)
        found.append(pulses)
    assert (found[0] == found[1]).all()
    assert (np.diff(found[0]) > 0).all()


def test_all_kernels_warm_up():
    for module in (pulse_clock_kernels, reference_times, vehicle_frame):
        module.warm_up()
