"""Rows begin where the scan line crosses the trajectory; what is doubtful is predicted."""

from __future__ import annotations

import numpy as np
import pytest

from processing.recording.revolutions import reference_times, vehicle_frame
from processing.recording.revolutions.reference_times import find_crossings, repair_reference_times
from processing.recording.revolutions.revolutions import PointColumns
from processing.recording.revolutions.vehicle_frame import Poses
from processing.recording.vehicle_path.trajectory import Trajectory
from tests.builders import simulated_drive

PERIOD_S = 0.01


def test_good_crossings_are_kept_as_they_are():
    predicted = np.arange(100) * PERIOD_S
    crossed = predicted + 0.002 * PERIOD_S * np.sin(predicted * 20) + 0.1 * PERIOD_S
    times = repair_reference_times(predicted, crossed, np.ones(100, dtype=np.int64), PERIOD_S)
    assert times == pytest.approx(crossed, abs=1e-12)


def test_a_missing_crossing_is_predicted_from_its_neighbours():
    predicted = np.arange(100) * PERIOD_S
    crossed = predicted + 0.1 * PERIOD_S
    hidden = crossed.copy()
    hidden[40:60] = np.nan
    times = repair_reference_times(predicted, hidden, np.ones(100, dtype=np.int64), PERIOD_S)
    assert times == pytest.approx(crossed, abs=1e-12)


@pytest.mark.parametrize(("miss", "pulses"), [(0.015, 40), (0.1, 1), (-0.3, 1)])
def test_a_crossing_far_from_its_neighbours_is_replaced(miss, pulses):
    predicted = np.arange(100) * PERIOD_S
    crossed = predicted + 0.1 * PERIOD_S
    chord = np.ones(100, dtype=np.int64)
    disturbed = crossed.copy()
    disturbed[50] += miss * PERIOD_S
    chord[50] = pulses
    times = repair_reference_times(predicted, disturbed, chord, PERIOD_S)
    assert times == pytest.approx(crossed, abs=1e-12)


def test_without_crossings_the_prediction_stands():
    predicted = np.arange(10) * PERIOD_S
    nothing = np.full(10, np.nan)
    times = repair_reference_times(predicted, nothing, np.zeros(10, dtype=np.int64), PERIOD_S)
    assert (times == predicted).all()


def test_a_crossing_divides_the_time_as_it_divides_the_offsets():
    time = np.array([0.0, 1e-5, 2e-5, 3e-5])
    left = np.array([200, 100, -300, -500])
    xyz = np.column_stack([-left, [0] * 4, [-2000] * 4]).astype(np.int32)
    ones = np.ones(4, dtype=np.uint8)
    points = PointColumns(xyz, (0.001,) * 3, (0.0,) * 3, time, ones, ones)
    vehicle_path = Trajectory(
        np.array([-1.0, 1.0]), np.zeros((2, 3)), np.zeros((2, 3)), has_attitude=True
    )
    pulses = np.array([5, 6, 9, 10])
    crossed, chord = find_crossings(
        points, pulses, Poses.of(vehicle_path), np.array([1.5e-5]), period_s=1e-4, below_m=-0.5
    )
    assert crossed[0] == pytest.approx(1.25e-5)
    assert chord[0] == 3
    above, _ = find_crossings(
        points, pulses, Poses.of(vehicle_path), np.array([1.5e-5]), period_s=1e-4, below_m=-3.0
    )
    assert np.isnan(above[0])


def test_beams_are_what_the_trajectory_says_the_vehicle_sees():
    drive = simulated_drive(8, curve=0.05)
    names = ("xyz", "time", "return_number", "number_of_returns")
    points = PointColumns(
        scale=drive.scale, offset=drive.offset, **{name: drive.columns[name] for name in names}
    )
    time, beam = Poses.of(drive.trajectory).beams(points, 7)
    assert (time == points.time[::7]).all()
    assert beam == pytest.approx(drive.trajectory.to_vehicle(drive.xyz[::7], time), abs=1e-4)


def test_kernels_do_compiled_what_they_do_plain(monkeypatch):
    drive = simulated_drive(8, length_m=1.0)
    names = ("xyz", "time", "return_number", "number_of_returns")
    points = PointColumns(
        scale=drive.scale, offset=drive.offset, **{name: drive.columns[name] for name in names}
    )
    poses = Poses.of(drive.trajectory)
    predicted = drive.fold_times[1:6] + 1e-4

    def both():
        found = find_crossings(
            points, drive.pulse, poses, predicted, period_s=PERIOD_S, below_m=0.0
        )
        return *found, poses.beams(points, 50)[1]

    compiled = both()
    for module, name in (
        (reference_times, "_crossings_kernel"),
        (vehicle_frame, "_beams_kernel"),
    ):
        monkeypatch.setattr(module, name, getattr(module, name).py_func)
    for first, second in zip(compiled, both(), strict=True):
        assert first == pytest.approx(second, nan_ok=True)
