"""Normalised scanlines: true sections of a known street, whatever the scanner and the drive."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.image.scan_lines.scanlines import (
    Scanlines,
    ScanlineSettings,
    scanline_through,
    scanlines_of,
)
from processing.recording.drive import Drive, write_trajectory
from processing.recording.passes import passes_of
from processing.recording.revolutions.revolutions_file import write_revolutions
from tests.builders import START, SimulatedDrive, simulated_drive
from tests.processing.image.recordings import drive_of, true_revolutions
from tests.street_scene import CROSSFALL, CURB_AT_M, CURB_HEIGHT_M, StreetScene

SETTINGS = ScanlineSettings()
LENGTH_M = 16.0
FIELDS = ("across_m", "height_m", "is_break", "time_s", "intensity", "point")


def recorded(folder: Path, **changes: Any) -> tuple[Drive, SimulatedDrive]:
    """A drive with its trajectory; 16 m, without noise unless told otherwise."""
    values: dict[str, Any] = {"length_m": LENGTH_M, "range_noise_m": 0.0, "lost_share": 0.0}
    simulated = simulated_drive(1, **{**values, **changes})
    drive_of(simulated, folder / "drive")
    write_trajectory(folder / "drive", simulated.trajectory)
    times = simulated.fold_times[~np.isnan(simulated.fold_times)]
    write_revolutions(folder / "drive", replace(true_revolutions(simulated), reference_times=times))
    return Drive(folder / "drive"), simulated


def whole(drive: Drive, settings: ScanlineSettings = SETTINGS) -> Scanlines:
    (scanlines,) = scanlines_of(drive, settings, SilentMonitor())
    return scanlines


def numbers_about(scanlines: Scanlines, drive: Drive, within_m: float) -> list[int]:
    """The sections about the middle of what was recorded."""
    (vehicle_path,) = passes_of(drive)
    middle = vehicle_path.station_at(np.median(np.asarray(drive.columns["time"])))
    found: list[int] = np.flatnonzero(np.abs(scanlines.stations_m - middle) < within_m).tolist()
    return found


def on_street(scanlines: Scanlines, number: int, curve: float) -> tuple[Floats, Floats]:
    """How far to the left of the road's middle a section's vertices are, and their height."""
    vertices = np.arange(scanlines.starts[number], scanlines.starts[number + 1])
    positions = scanlines.xyz(vertices) - START
    return StreetScene(curve, LENGTH_M).along_across(positions)[1], positions[:, 2]


def curb_of(outward: Floats, height: Floats) -> tuple[float, float]:
    """Where a section crosses half the curb's height, and how high it rises within 20 cm."""
    low = -CROSSFALL * CURB_AT_M
    near = np.abs(outward - CURB_AT_M) < 0.2
    rising = near & (height > low + 0.04) & (height < low + 0.11)
    return float(np.median(outward[rising])), float(np.ptp(height[near]))


@pytest.mark.parametrize("mount", ["45", "90"])
@pytest.mark.parametrize(
    ("curve", "speed"), [(0.0, 8.0), (1 / 15, 8.0), (-1 / 60, 3.0), (0.0, 25.0)]
)
def test_every_section_shows_the_curbs_where_they_are(
    tmp_path: Path, mount: str, curve: float, speed: float
) -> None:
    changes = {"revolution_rate_hz": 50.0} if speed < 5 else {}
    drive, _ = recorded(
        tmp_path, mount=mount, curve=curve, speed_m_s=speed, pulses_per_revolution=1500.0, **changes
    )
    scanlines = whole(drive)
    np.testing.assert_allclose(np.diff(scanlines.stations_m), SETTINGS.spacing_m, atol=1e-9)
    numbers = numbers_about(scanlines, drive, 1.5)
    assert len(numbers) in (30, 31)
    for number in numbers:
        left, height = on_street(scanlines, number, curve)
        for side in (-1, 1):
            position, rise = curb_of(side * left, height)
            assert position == pytest.approx(CURB_AT_M, abs=0.02)
            assert rise == pytest.approx(CURB_HEIGHT_M, abs=0.015)


def test_heights_are_about_the_road_wherever_the_trajectory_was_carried(tmp_path: Path) -> None:
    drive, simulated = recorded(tmp_path, curve=0.02)
    scanlines = whole(drive)
    near = np.abs(scanlines.across_m) < 0.5
    assert np.abs(np.median(scanlines.height_m[near])) < 0.03
    some = np.arange(0, scanlines.point.size, 97)
    away = np.linalg.norm(scanlines.xyz(some) - drive.xyz(scanlines.point[some]), axis=1)
    assert away.max() < 0.3
    assert (scanlines.time_s[some] >= simulated.columns["time"][0]).all()


def test_a_plane_stays_a_plane(tmp_path: Path) -> None:
    drive, _ = recorded(tmp_path, mount="45", pulses_per_revolution=1500.0)
    scanlines = whole(drive)
    (middle, *_) = numbers_about(scanlines, drive, 0.2)
    left, height = on_street(scanlines, middle, 0.0)
    for side in (-1, 1):
        road = (side * left > 0.1) & (side * left < CURB_AT_M - 0.1)
        assert np.count_nonzero(road) > 100
        # What is left are the delivered coordinates' millimetres.
        np.testing.assert_allclose(height[road], -CROSSFALL * side * left[road], atol=0.0015)


@pytest.mark.parametrize("mount", ["45", "90"])
def test_however_it_is_cut_into_blocks_the_scanlines_are_the_same_bits(
    tmp_path: Path, mount: str
) -> None:
    drive, _ = recorded(tmp_path, mount=mount, range_noise_m=0.004, lost_share=0.2, length_m=30.0)
    expected = whole(drive)
    for pulses in (900, 9_000):
        blocks = list(scanlines_of(drive, SETTINGS, SilentMonitor(), pulses_at_once=pulses))
        assert len(blocks) > 1
        for name in FIELDS:
            joined = np.concatenate([getattr(block, name) for block in blocks])
            np.testing.assert_array_equal(joined, getattr(expected, name))
        counts = np.concatenate([np.diff(block.starts) for block in blocks])
        np.testing.assert_array_equal(counts, np.diff(expected.starts))
        stations = np.concatenate([block.stations_m for block in blocks])
        np.testing.assert_array_equal(stations, expected.stations_m)


def test_one_scanline_is_the_one_of_the_whole_drive(tmp_path: Path) -> None:
    drive, _ = recorded(tmp_path, range_noise_m=0.004, lost_share=0.1)
    expected = whole(drive)
    (vehicle_path,) = passes_of(drive)
    one = scanline_through(drive, vehicle_path.xyz_at([10.04], [3.0])[0], SETTINGS)
    assert one is not None
    assert one.stations_m.tolist() == pytest.approx([10.0])
    number = int(np.argmin(np.abs(expected.stations_m - 10.0)))
    part = slice(int(expected.starts[number]), int(expected.starts[number + 1]))
    for name in FIELDS:
        np.testing.assert_array_equal(getattr(one, name), getattr(expected, name)[part])
    assert scanline_through(drive, vehicle_path.xyz_at([10.0], [90.0])[0], SETTINGS) is None


def test_where_nothing_came_back_the_line_breaks(tmp_path: Path) -> None:
    drive, _ = recorded(tmp_path, lost_share=0.4, range_noise_m=0.002)
    scanlines = whole(drive)
    steps = np.hypot(np.diff(scanlines.across_m), np.diff(scanlines.height_m))
    assert steps[~scanlines.is_break[1:]].max() <= SETTINGS.longest_edge_m
    assert scanlines.is_break.sum() > scanlines.stations_m.size


def test_a_vehicle_that_stands_with_its_laser_on_is_measured_once(tmp_path: Path) -> None:
    moving, _ = recorded(
        tmp_path / "moving", mount="90", range_noise_m=0.003, pulses_per_revolution=1000.0
    )
    stopped, _ = recorded(
        tmp_path / "stopped",
        mount="90",
        range_noise_m=0.003,
        stop_at=8.0,
        pulses_per_revolution=1000.0,
        stop_s=2.0,
        fires_at_stop=True,
    )
    assert stopped.count > 1.5 * moving.count
    counts = [np.diff(whole(drive).starts) for drive in (moving, stopped)]
    assert counts[1].max() <= 1.5 * counts[0].max()
    standing = whole(stopped)
    (vehicle_path,) = passes_of(stopped)
    stood = vehicle_path.station_at(stopped.columns["time"][stopped.count // 2])
    for number in np.flatnonzero(np.abs(standing.stations_m - stood) < 1.0).tolist():
        left, height = on_street(standing, number, 0.0)
        position, rise = curb_of(left, height)
        assert position == pytest.approx(CURB_AT_M, abs=0.03)
        assert rise == pytest.approx(CURB_HEIGHT_M, abs=0.03)
