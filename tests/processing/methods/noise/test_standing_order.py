"""A tripod's scan that tells neither where the scanner stood nor its grid: the order tells both."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.methods.noise.beams.measured_order import delivered_order, measured_order
from processing.methods.noise.beams.scanner_positions import position_in_order
from processing.methods.noise.beams.standing_scans import standing_scan_of
from processing.methods.noise.drive_noise import NoiseSearch
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive

POSITION = np.array([-12_380.0, -36_680.0, 7.5])
SWEEPS, PULSES = 400, 240
_HALVES_M = np.array([9.0, 6.0, 1.7])
_PULSE_S = 1e-4


def yard(
    *, is_full_turn: bool = False, fall: float = 0.0
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """A walled yard without a roof, sweep by sweep, and which points float in it.

    The mirror sends beams from straight down to 55° above the horizon, or all around, while the
    head turns by a full or by half a circle. From the stand on the ground may fall to the east.
    """
    random = np.random.default_rng(7)
    turn = np.pi if is_full_turn else 2 * np.pi
    highest = 2 * np.pi - 0.4 if is_full_turn else np.radians(145)
    angles = np.tile(np.linspace(0.4, highest, PULSES), SWEEPS)
    azimuths = np.arange(SWEEPS * PULSES) * (turn / (SWEEPS * PULSES))
    across = np.sin(angles)
    directions = np.column_stack(
        [across * np.cos(azimuths), across * np.sin(azimuths), -np.cos(angles)]
    )
    sides = _HALVES_M / np.maximum(np.abs(directions), 1e-9)
    down = -directions[:, 2] - fall * np.maximum(directions[:, 0], 0.0)
    sides[:, 2] = np.where(down > 0, _HALVES_M[2] / np.maximum(down, 1e-9), np.inf)
    ranges = sides.min(axis=1)
    is_sky = directions[:, 2] * ranges > 3.0
    ranges += random.normal(0, 0.003, ranges.size)
    floats = random.random(ranges.size) < 0.002
    ranges[floats] *= random.uniform(0.3, 0.8, int(floats.sum()))
    kept = (~is_sky | floats) & (random.random(ranges.size) < 0.98)
    xyz = POSITION + directions * ranges[:, None]
    xyz[~kept] = np.nan
    return xyz, floats & kept


def delivered(
    path: Path, xyz: NDArray[np.float64], *, has_time: bool, order: NDArray[np.int64] | None = None
) -> Drive:
    """A drive of the points that came back, in an order."""
    pulses = np.flatnonzero(np.isfinite(xyz[:, 0]))
    pulses = pulses if order is None else pulses[order]
    header = laspy.LasHeader(point_format=6 if has_time else 2, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), np.floor(POSITION)
    cloud = laspy.LasData(header)
    cloud.xyz = xyz[pulses]
    if has_time:
        cloud.gps_time = 360_000_000.0 + pulses * _PULSE_S
    cloud.write(path)
    (folder,) = import_drives(ImportRequest((path,)), path.with_suffix(""), SilentMonitor())
    return Drive(folder)


@pytest.mark.parametrize("has_time", [True, False])
def test_points_that_float_in_a_scan_without_place_are_noise(
    tmp_path: Path, has_time: bool
) -> None:
    xyz, floats = yard()
    drive = delivered(tmp_path / "scan.laz", xyz, has_time=has_time)
    (tmp_path / "scratch").mkdir()
    codes = np.zeros(drive.count, np.uint8)
    NoiseSearch(drive, codes, tmp_path / "scratch", drive.count).combined(0.5, SilentMonitor())
    is_noise = codes[delivered_order(drive)] > 0
    is_float = floats[np.isfinite(xyz[:, 0])]
    assert is_noise[is_float].mean() >= 0.7  # of so few, company decides alone
    assert is_noise[~is_float].mean() <= 0.002


@pytest.mark.parametrize("is_full_turn", [False, True])
def test_sweeps_and_steps_follow_from_the_order(tmp_path: Path, is_full_turn: bool) -> None:
    xyz, _ = yard(is_full_turn=is_full_turn)
    drive = delivered(tmp_path / "scan.laz", xyz, has_time=True)
    scan = standing_scan_of(drive, tmp_path, SilentMonitor())
    assert scan is not None
    assert scan.position == pytest.approx(POSITION, abs=0.03)
    assert scan.row_starts.size - 1 == SWEEPS
    wide = 2 * np.pi - 0.8 if is_full_turn else np.radians(145) - 0.4
    assert scan.step_rad == pytest.approx(wide / (PULSES - 1), rel=0.02)
    beams, points = scan.beams_of(range(10, 20))
    assert beams.row_starts[-1] == points.size
    assert (
        np.diff(beams.columns)[
            np.diff(np.searchsorted(beams.row_starts, np.arange(points.size), "right")) == 0
        ]
        >= 0
    ).all()


def test_points_in_no_order_show_no_sweeps(tmp_path: Path) -> None:
    xyz, _ = yard()
    count = int(np.isfinite(xyz[:, 0]).sum())
    mixed = np.random.default_rng(1).permutation(count)
    drive = delivered(tmp_path / "mixed.laz", xyz, has_time=False, order=mixed)
    assert standing_scan_of(drive, tmp_path, SilentMonitor()) is None


def test_a_stand_on_a_steep_bank_is_as_high_as_it_was(tmp_path: Path) -> None:
    """Half of the ground within six metres lies up to six metres below the scanner."""
    xyz, _ = yard(fall=1.0)
    drive = delivered(tmp_path / "scan.laz", xyz, has_time=True)
    position = position_in_order(drive, measured_order(drive))
    assert position == pytest.approx(POSITION, abs=0.03)
