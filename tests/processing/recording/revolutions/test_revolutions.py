"""Rows and pulses are found in simulated recordings of all kinds of heads, as they were fired."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.errors import Cancelled, MissingInput
from processing.core.monitor import SilentMonitor
from processing.recording.columns.columns import Columns, ColumnWriter
from processing.recording.revolutions import row_finding
from processing.recording.revolutions.revolutions import (
    NoRevolutions,
    PointColumns,
    RecordedPoints,
    Revolutions,
    find_revolutions,
    trajectory_from_origins,
)
from tests.builders import SimulatedDrive, simulated_drive
from tests.monitors import CancelledAfter

NAMES = ("xyz", "time", "return_number", "number_of_returns")


def columns_of(drive: SimulatedDrive, **more) -> PointColumns:
    arrays = {name: drive.columns[name] for name in NAMES}
    return PointColumns(scale=drive.scale, offset=drive.offset, **arrays, **more)


def rows_of(revolutions: Revolutions, pulses: np.ndarray) -> np.ndarray:
    return np.searchsorted(revolutions.fold_pulses, pulses, side="right") - 1


def found_in(drive: SimulatedDrive, *, trajectory=True, **more) -> tuple[Revolutions, np.ndarray]:
    vehicle_path = drive.trajectory if trajectory else None
    found = find_revolutions(columns_of(drive, **more), vehicle_path, SilentMonitor())
    assert not isinstance(found, NoRevolutions), found.reason.en
    return found


def share_at_one_distance(found: np.ndarray, true: np.ndarray) -> float:
    counts = np.unique(found - true, return_counts=True)[1]
    return counts.max() / true.size


def fold_misses(revolutions: Revolutions, drive: SimulatedDrive) -> np.ndarray:
    """Reference times against the nearest true ones, as shares of a turn."""
    true = drive.fold_times[np.isfinite(drive.fold_times)]
    inner = revolutions.reference_times[1:-2]
    return np.abs(inner[:, None] - true).min(axis=1) * revolutions.revolution_rate_hz


HEADS = [
    {"mount": "45", "head": "left"},
    {"mount": "45", "head": "right", "revolution_rate_hz": 250.0},
    {"mount": "90", "revolution_rate_hz": 50.0, "pulses_per_revolution": 1000.3, "length_m": 6.0},
    {"mount": "90", "head": "right", "revolution_rate_hz": 200.0, "pulses_per_revolution": 507.9},
    {"curve": 0.03},
    {"curve": -0.04, "head": "right"},
    {"rate_drift": 0.002, "length_m": 30.0, "pulses_per_revolution": 300.37},
    {"multi_return_share": 0.1},
    {"lost_share": 0.4},
    {"start_time_s": 376_892_634.28, "pulses_per_revolution": 1500.0, "length_m": 3.0},
    {"time_quantum_s": 1e-6, "pulses_per_revolution": 3000.0, "length_m": 2.0},
]


@pytest.mark.parametrize("head", HEADS, ids=str)
def test_every_point_gets_the_pulse_that_was_fired_and_its_revolution(head):
    drive = simulated_drive(11, **head)
    revolutions, pulses = found_in(drive)
    assert revolutions.method == "trajectory"
    assert share_at_one_distance(pulses, drive.pulse) == 1.0
    rows = rows_of(revolutions, pulses)
    # A pulse or two beside the fold may be counted on its other side.
    assert share_at_one_distance(rows, drive.turn) > 1 - 3 / drive.pulses_per_revolution
    assert np.quantile(fold_misses(revolutions, drive), 0.9) < 0.003
    assert revolutions.revolution_rate_hz == pytest.approx(drive.revolution_rate_hz, rel=3e-3)
    assert revolutions.pulse_rate_hz == pytest.approx(drive.pulse_rate_hz, rel=1e-6)
    assert revolutions.coherence > 0.8


@pytest.mark.parametrize("head", HEADS, ids=str)
def test_rows_hold_all_points_and_fit_together(head):
    drive = simulated_drive(12, **head)
    revolutions, pulses = found_in(drive)
    count = revolutions.segments.size
    assert revolutions.reference_times.size == revolutions.fold_pulses.size == count + 1
    assert revolutions.row_ends.size == count
    assert pulses.dtype == np.int64
    assert (np.diff(pulses) >= 0).all()
    assert revolutions.fold_pulses[0] >= 0
    assert (np.diff(revolutions.fold_pulses) > 0).all()
    assert (np.diff(revolutions.reference_times) > 0).all()
    rows = rows_of(revolutions, pulses)
    assert rows.min() >= 0
    assert rows.max() < count
    assert (pulses < revolutions.row_ends[rows]).all()


@pytest.mark.parametrize("mount", ["45", "90"])
@pytest.mark.parametrize("vehicle_path", ["origin", "scan_angle_deg", None])
def test_without_trajectory_turns_come_from_what_there_is(mount, vehicle_path):
    drive = simulated_drive(5, mount=mount)
    more = {} if vehicle_path is None else {vehicle_path: getattr(drive, vehicle_path)}
    revolutions, pulses = found_in(drive, trajectory=False, **more)
    methods = {"origin": "origins", "scan_angle_deg": "scan-angle", None: "periodicity"}
    assert revolutions.method == methods[vehicle_path]
    assert share_at_one_distance(pulses, drive.pulse) == 1.0
    # The fold lies below the scanner instead of the trajectory, always equally far.
    misses = fold_misses(revolutions, drive)
    assert np.ptp(np.sort(misses)[2:-2]) < 0.01
    assert misses.max() < 0.12


def test_a_wrong_trajectory_gives_way_to_the_points_themselves():
    drive = simulated_drive(5)
    elsewhere = simulated_drive(6, curve=0.2, speed_m_s=3.0, length_m=6.0).trajectory
    found = find_revolutions(columns_of(drive), elsewhere, SilentMonitor())
    assert not isinstance(found, NoRevolutions)
    assert share_at_one_distance(found[1], drive.pulse) == 1.0


def test_a_stop_begins_a_new_segment_and_its_row_ends_with_its_own_revolution():
    drive = simulated_drive(3, stop_at=4.0, stop_s=3.0)
    revolutions, pulses = found_in(drive)
    assert revolutions.segments.tolist() == sorted(revolutions.segments.tolist())
    assert set(revolutions.segments.tolist()) == {0, 1}
    last = int(np.flatnonzero(revolutions.segments == 0)[-1])
    length = revolutions.row_ends[last] - revolutions.fold_pulses[last]
    assert length == pytest.approx(drive.pulses_per_revolution, abs=2)
    assert (
        revolutions.fold_pulses[last + 1] - revolutions.row_ends[last] > 2.9 * drive.pulse_rate_hz
    )
    after = drive.columns["time"] > drive.columns["time"][0] + 2.0
    rows = rows_of(revolutions, pulses)
    for part in (after, ~after):
        assert share_at_one_distance(rows[part], drive.turn[part]) > 0.99


@pytest.mark.parametrize("stop_s", [0.3, 0.9])
def test_a_second_without_returns_is_no_stop(stop_s):
    drive = simulated_drive(3, stop_at=4.0, stop_s=stop_s)
    revolutions, pulses = found_in(drive)
    assert revolutions.segments.max() == 0
    assert share_at_one_distance(pulses, drive.pulse) == 1.0
    assert share_at_one_distance(rows_of(revolutions, pulses), drive.turn) > 0.99


def test_a_standing_vehicle_with_the_laser_on_gets_a_row_for_every_revolution():
    drive = simulated_drive(3, stop_at=4.0, stop_s=2.0, fires_at_stop=True)
    revolutions, pulses = found_in(drive)
    assert share_at_one_distance(rows_of(revolutions, pulses), drive.turn) > 0.99


def test_all_returns_of_a_pulse_share_its_number():
    drive = simulated_drive(4, multi_return_share=0.2)
    _, pulses = found_in(drive)
    later = drive.columns["return_number"] > 1
    assert later.sum() > 1_000
    assert (np.diff(pulses, prepend=-1)[later] == 0).all()
    assert (np.diff(pulses, prepend=-1)[~later] > 0).all()


def test_times_so_coarse_that_pulses_share_them_keep_the_order_of_the_file():
    drive = simulated_drive(
        3,
        revolution_rate_hz=200.0,
        pulses_per_revolution=5080.0,
        time_quantum_s=2.0**-18,
        length_m=2.0,
    )
    assert np.mean(np.diff(drive.columns["time"]) == 0) > 0.6
    revolutions, pulses = found_in(drive)
    assert (np.diff(pulses) > 0).all()
    assert revolutions.pulse_rate_hz == pytest.approx(drive.pulse_rate_hz, rel=1e-5)
    misses = pulses - drive.pulse
    assert np.abs(misses - np.median(misses)).max() <= 4
    assert share_at_one_distance(pulses, drive.pulse) > 0.85


def test_points_read_in_small_stretches_give_what_they_give_at_once(tmp_path, monkeypatch):
    drive = simulated_drive(9, multi_return_share=0.05)
    with ColumnWriter(tmp_path) as writer:
        writer.append({name: drive.columns[name] for name in NAMES})
    at_once, pulses = found_in(drive)
    monkeypatch.setattr(row_finding, "READ_POINTS", 2_500)
    points = RecordedPoints(tmp_path, drive.count, drive.scale, drive.offset)
    found = find_revolutions(points, drive.trajectory, SilentMonitor())
    assert isinstance(found, Revolutions)
    assert (Columns(tmp_path, drive.count)["pulse"] == pulses).all()
    assert (found.fold_pulses == at_once.fold_pulses).all()
    assert found.reference_times == pytest.approx(at_once.reference_times, abs=1e-7)


def test_the_trajectory_of_origins_is_where_the_scanner_was():
    drive = simulated_drive(2, length_m=20.0, curve=0.02)
    vehicle_path = trajectory_from_origins(columns_of(drive, origin=drive.origin))
    times = drive.columns["time"]
    assert vehicle_path.covers(times).all()
    assert np.abs(vehicle_path.positions_at(times) - drive.origin).max() < 0.02


def test_an_origin_that_goes_round_with_the_mirror_is_brought_to_rest():
    drive = simulated_drive(2, length_m=20.0)
    phase = np.radians(drive.scan_angle_deg.astype(np.float64))
    circling = drive.origin + 0.2 * np.column_stack([np.cos(phase), np.sin(phase), 0 * phase])
    vehicle_path = trajectory_from_origins(columns_of(drive, origin=circling))
    assert np.abs(vehicle_path.positions_at(drive.columns["time"]) - drive.origin).max() < 0.03


def test_points_without_origins_have_no_trajectory_of_origins():
    with pytest.raises(MissingInput):
        trajectory_from_origins(columns_of(simulated_drive(2)))


def _thinned(drive: SimulatedDrive) -> PointColumns:
    kept = np.sort(np.random.default_rng(0).choice(drive.count, 1_000, replace=False))
    jitter = np.random.default_rng(1).uniform(0, 1e-3, kept.size)
    arrays = {name: drive.columns[name][kept] for name in NAMES}
    arrays["time"] = np.sort(arrays["time"] + jitter)
    return PointColumns(scale=drive.scale, offset=drive.offset, **arrays)


def _swinging(drive: SimulatedDrive) -> PointColumns:
    """An airborne mirror that swings: points on level ground, left and right."""
    arrays = {name: drive.columns[name].copy() for name in NAMES}
    time = np.arange(drive.count) / 40_000.0
    side = 400.0 * np.sin(2 * np.pi * 30.0 * time)
    ahead = 60.0 * time
    arrays["xyz"] = np.column_stack([side, ahead, 0 * side]) * 1000.0
    arrays["xyz"] = arrays["xyz"].astype(np.int32)
    arrays["time"] = time
    return PointColumns(scale=drive.scale, offset=drive.offset, **arrays)


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (_thinned, "pulse interval"),
        (_swinging, "mirror"),
        (lambda drive: columns_of(drive).chunk(0, 300), "few"),
    ],
)
def test_recordings_without_revolutions_say_why_in_one_sentence(made, words):
    found = find_revolutions(made(simulated_drive(1)), None, SilentMonitor())
    assert isinstance(found, NoRevolutions)
    assert words in found.reason.en
    assert found.reason.en.count(".") == 1
    assert found.reason.ja.endswith("。")


def test_points_out_of_time_order_have_no_revolutions():
    drive = simulated_drive(1)
    drive.columns["time"] = drive.columns["time"][::-1].copy()
    found = find_revolutions(columns_of(drive), None, SilentMonitor())
    assert isinstance(found, NoRevolutions)
    assert "order" in found.reason.en


@pytest.mark.parametrize("calls", [0, 2, 3])
def test_the_search_can_be_stopped(calls):
    drive = simulated_drive(1)
    with pytest.raises(Cancelled):
        find_revolutions(columns_of(drive), drive.trajectory, CancelledAfter(calls))
