from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import MissingInput
from processing.core.monitor import SilentMonitor
from processing.methods.earthwork.surfaces.epoch_ground import ground_of_drives
from processing.methods.noise.beams.scanner_positions import scanner_position_of
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive

POSITION = np.array([-12_380.0, -36_680.0, 7.5])


def tripod_scan(path: Path, *, revolutions_s: float = 0.02, code: int = 2) -> None:
    """Level ground as a scanner on a tripod measures it: upright sweeps, slowly turning."""
    sweeps, pulses = 360, 300
    turn = np.repeat(np.linspace(0, 2 * np.pi, sweeps, endpoint=False), pulses)
    fall = np.tile(np.linspace(-1.2, -0.06, pulses), sweeps)
    turn = turn + np.tile(np.arange(pulses), sweeps) / pulses * (2 * np.pi / sweeps)
    away = 2.5 / np.tan(-fall)
    chance = np.random.default_rng(1)
    xyz = np.column_stack([away * np.cos(turn), away * np.sin(turn), np.full(turn.size, -2.5)])
    xyz += 0.002 * chance.normal(size=xyz.shape) + POSITION
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), np.floor(POSITION)
    header.global_encoding.gps_time_type = laspy.header.GpsTimeType.STANDARD
    cloud = laspy.LasData(header)
    cloud.xyz = xyz
    cloud.gps_time = 350_000_000.0 + np.arange(turn.size) * revolutions_s / pulses
    cloud.classification = np.full(turn.size, code, np.uint8)
    cloud.write(path)


def drives_of(path: Path, folder: Path) -> tuple[Drive, ...]:
    return tuple(map(Drive, import_drives(ImportRequest(inputs=(path,)), folder, SilentMonitor())))


def test_where_a_tripod_stood_follows_from_the_order_of_its_points(tmp_path: Path) -> None:
    tripod_scan(tmp_path / "scan.laz", revolutions_s=0.5)
    (drive,) = drives_of(tmp_path / "scan.laz", tmp_path / "drives")
    position = scanner_position_of(drive)

    assert position is not None
    assert position == pytest.approx(POSITION, abs=0.05)


def test_points_in_no_order_tell_no_place(tmp_path: Path) -> None:
    tripod_scan(tmp_path / "scan.laz", revolutions_s=0.5)
    cloud = laspy.read(tmp_path / "scan.laz")
    times = np.asarray(cloud.gps_time)
    cloud.gps_time = np.random.default_rng(2).permutation(times)
    cloud.write(tmp_path / "mixed.laz")
    (drive,) = drives_of(tmp_path / "mixed.laz", tmp_path / "drives")

    assert scanner_position_of(drive) is None


def test_an_epoch_knows_its_ground_its_day_and_its_stands(tmp_path: Path) -> None:
    tripod_scan(tmp_path / "scan.laz", revolutions_s=0.5)
    epoch = ground_of_drives(drives_of(tmp_path / "scan.laz", tmp_path / "d"), SilentMonitor())
    points: list[NDArray[np.float64]] = [block.xyz for block in epoch.blocks()]

    assert sum(map(len, points)) == 360 * 300
    assert epoch.stands == pytest.approx(POSITION[None], abs=0.05)
    assert epoch.measured_on is not None
    assert epoch.measured_on.isoformat() == "2022-10-17"


def test_an_epoch_without_ground_says_what_to_do(tmp_path: Path) -> None:
    tripod_scan(tmp_path / "scan.laz", code=1)
    with pytest.raises(MissingInput, match="Ground"):
        ground_of_drives(drives_of(tmp_path / "scan.laz", tmp_path / "drives"), SilentMonitor())
