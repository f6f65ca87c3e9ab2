"""A street from a tripod: what it sees, and that the program finds its sweeps."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scanning.noise_options import noise_options
from processing.laboratory.simulate.scanning.returns import Weather
from processing.laboratory.simulate.scanning.sensors import SENSORS
from processing.laboratory.simulate.street.styles import style_of
from processing.laboratory.simulate.street_scans import StreetScan, scan_street
from processing.methods.noise.beams.standing_scans import standing_scan_of
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive

_SEED = 3
_PHASE = replace(SENSORS["zf5016"], most_m=79.0)


def _scan(file: Path, often: float) -> None:
    street = Street(_SEED, style_of("urban"), 20.0)
    scan = StreetScan(0, _PHASE, 60_000, 1.0, noise_options(_SEED, _PHASE, often))
    scan_street(street, scan, Weather(0.0, 0.5), file, SilentMonitor())


@pytest.fixture(scope="module")
def scan_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("scan") / "scan.laz"
    _scan(file, 2.0)
    return file


def test_a_scan_sees_road_and_houses_and_has_noise_that_is_told(scan_file: Path) -> None:
    labels = np.load(scan_file.with_suffix(".labels.npy"))
    assert labels.size == laspy.read(scan_file).header.point_count > 10_000
    assert (labels == 11).mean() > 0.1
    assert 0.01 < np.isin(labels, (7, 18)).mean() < 0.4


def test_less_noise_can_be_asked_for(scan_file: Path, tmp_path: Path) -> None:
    _scan(tmp_path / "quiet.laz", 0.01)
    shares = [
        np.isin(np.load(one.with_suffix(".labels.npy")), (7, 18)).mean()
        for one in (scan_file, tmp_path / "quiet.laz")
    ]
    assert shares[1] < 0.5 * shares[0]


def test_the_program_finds_where_it_stood_and_its_sweeps(scan_file: Path, tmp_path: Path) -> None:
    asked = ImportRequest((scan_file,), crs="EPSG:6677")
    drive = Drive(import_drives(asked, tmp_path / "drives", SilentMonitor())[0])
    found = standing_scan_of(drive, tmp_path, SilentMonitor())
    assert found is not None
    near = drive.xyz(slice(0, drive.count)) - found.position
    assert 0.4 < np.linalg.norm(near, axis=1).min() < 2.0
    assert 100 < found.segments.size < 1000
