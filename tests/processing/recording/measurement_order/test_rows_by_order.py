"""Rows are found in recordings without any time, or refused with the reason."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import Cancelled
from processing.core.monitor import SilentMonitor
from processing.recording.columns.columns import ColumnWriter
from processing.recording.columns.point_source import RecordedPoints
from processing.recording.measurement_order.rows_by_order import (
    NoOrder,
    OrderedRows,
    find_rows_by_order,
)
from resources import path_of
from tests.builders import SimulatedDrive, simulated_drive
from tests.monitors import CancelledAfter

SCALE = (0.001, 0.001, 0.001)


def recorded(folder: Path, xyz: NDArray[np.int32]) -> RecordedPoints:
    with ColumnWriter(folder) as writer:
        writer.append({"xyz": xyz})
    return RecordedPoints(folder, len(xyz), SCALE, (0.0, 0.0, 0.0))


def found_in(folder: Path, xyz: NDArray[np.int32]) -> OrderedRows | NoOrder:
    return find_rows_by_order(recorded(folder, xyz), SilentMonitor())


def rows_in(folder: Path, xyz: NDArray[np.int32]) -> OrderedRows:
    found = found_in(folder, xyz)
    assert isinstance(found, OrderedRows), found.reason.en
    return found


def share_of_true_rows(
    found: OrderedRows, drive: SimulatedDrive, order: NDArray[np.int64] | slice = slice(None)
) -> float:
    """Share of points in the row of their turn, each turn from where rows begin."""
    true = drive.pulse[order] / drive.pulses_per_revolution
    turns = found.pulses / found.revolutions.pulses_per_revolution
    rows = np.floor(turns) - np.floor(true + np.median(turns - true))
    return float(np.mean(rows == 0))


HEADS = [
    {"mount": "45", "head": "left"},
    {"mount": "45", "head": "right", "revolution_rate_hz": 250.0},
    {"mount": "90", "revolution_rate_hz": 50.0, "pulses_per_revolution": 1000.3},
    {"mount": "90", "head": "right", "revolution_rate_hz": 200.0, "pulses_per_revolution": 507.9},
    {"curve": 0.03},
    {"multi_return_share": 0.1},
    {"lost_share": 0.4},
]


@pytest.mark.parametrize("head", HEADS, ids=str)
def test_rows_are_the_turns_of_the_mirror_though_no_time_tells_them(tmp_path, head):
    drive = simulated_drive(11, **head)
    found = rows_in(tmp_path, drive.columns["xyz"])
    assert share_of_true_rows(found, drive) >= 0.99
    per_turn = found.revolutions.pulses_per_revolution
    assert per_turn == pytest.approx(drive.pulses_per_revolution, rel=0.01)
    assert found.confirmed > 0.95
    assert (np.diff(found.pulses) >= 0).all()


def test_the_way_of_the_beams_is_beside_that_of_the_vehicle(tmp_path):
    drive = simulated_drive(11)
    found = rows_in(tmp_path, drive.columns["xyz"])
    times = found.times_of(found.pulses)
    assert found.trajectory.covers(times).all()
    aside = found.trajectory.positions_at(times) - drive.trajectory.positions_at(
        drive.columns["time"]
    )
    # The head's lever arm is the same all along the straight way.
    assert np.abs(aside - np.median(aside, axis=0)).max() < 0.2


def sorted_by_object(drive: SimulatedDrive) -> NDArray[np.int64]:
    """Ground and what stands on it, each in order of measurement."""
    height = drive.columns["xyz"][:, 2]
    return np.argsort(height > np.median(height) + 300, kind="stable")


def test_things_that_were_sorted_apart_come_back_into_their_profiles(tmp_path):
    drive = simulated_drive(11, length_m=12.0)
    order = sorted_by_object(drive)
    found = rows_in(tmp_path, drive.columns["xyz"][order])
    assert share_of_true_rows(found, drive, order) > 0.9
    assert 0.5 < found.confirmed <= 1.0
    assert "object after object" in found.reported.en


def test_an_order_that_is_not_that_of_measurement_is_refused_with_the_reason(tmp_path):
    drive = simulated_drive(11)
    xyz = drive.columns["xyz"]
    cells = np.floor(xyz[:, :2] / 500)
    orders = {
        "neighbours in a sweep": np.random.default_rng(3).permutation(len(xyz)),
        "order tells no rows": np.lexsort((xyz[:, 0], cells[:, 0], cells[:, 1])),
        "tells no rows": np.argsort(xyz[:, 0], kind="stable"),
    }
    for number, (words, order) in enumerate(orders.items()):
        folder = tmp_path / str(number)
        folder.mkdir()
        found = found_in(folder, xyz[order])
        assert isinstance(found, NoOrder), words
        assert words in found.reason.en
        assert "上面画像" in found.reason.ja


def test_lines_of_a_raster_are_no_profiles(tmp_path):
    y, x = np.mgrid[0:120, 0:400]
    xyz = np.column_stack([x.ravel() * 200, y.ravel() * 200, x.ravel() % 7]).astype(np.int32)
    assert isinstance(found_in(tmp_path, xyz), NoOrder)


def test_sweeps_of_a_scanner_that_stood_are_no_way(tmp_path):
    turn, pulse = np.divmod(np.arange(60_000), 600)
    bearing, angle = np.radians(turn * 1.5), np.radians(pulse * 0.4 + 62)
    down = np.where(np.cos(angle) < 0, -2.0 / np.minimum(np.cos(angle), -1e-3), np.inf)
    length = np.minimum(np.abs(down), 12.0 + turn % 5)
    aside = length * np.sin(angle)
    place = [aside * np.cos(bearing), aside * np.sin(bearing), length * np.cos(angle)]
    found = found_in(tmp_path, np.round(np.column_stack(place) * 1000).astype(np.int32))
    assert isinstance(found, NoOrder)
    assert "stood still" in found.reason.en


@pytest.mark.parametrize("count", [1, 2, 1999, 5000])
def test_points_that_tell_nothing_are_refused(tmp_path, count):
    same = np.full((count, 3), 1_000, np.int32)
    assert isinstance(found_in(tmp_path, same), NoOrder)


def test_looking_for_rows_can_be_cancelled(tmp_path):
    points = recorded(tmp_path, simulated_drive(11).columns["xyz"])
    with pytest.raises(Cancelled):
        find_rows_by_order(points, CancelledAfter(3))


@pytest.mark.parametrize("head", ["left", "right"])
def test_the_sample_street_without_its_times_has_the_rows_that_the_times_tell(tmp_path, head):
    cloud = laspy.read(path_of(f"sample_street/{head}.laz"))[:60_000]
    integers = np.column_stack([cloud.X, cloud.Y, cloud.Z]).astype(np.int32)
    found = rows_in(tmp_path, integers)
    # 100 turns a second, as the simulator was set; the path of the head is its own.
    true = (np.asarray(cloud.gps_time) - cloud.gps_time[0]) * 100.0
    turns = found.pulses / found.revolutions.pulses_per_revolution
    # Where rows begin moves against the mirror as the vehicle turns and sways, but slowly.
    parts = np.arange(len(turns)) // 5_000
    begins = np.array([np.median((turns - true)[parts == part]) for part in np.unique(parts)])
    rows = np.floor(turns) - np.floor(true + begins[parts])
    assert float(np.mean(rows == 0)) >= 0.99
    assert found.revolutions.pulses_per_revolution == pytest.approx(1000, abs=2)
    assert found.confirmed > 0.99
