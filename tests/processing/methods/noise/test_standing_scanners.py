"""A standing scanner whose file says where it stood: its beams are known, too."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.image.images_of_drives import image_of
from processing.methods.noise.beams.beam_origins import beam_origins
from processing.methods.noise.beams.beams_of_drives import beams_of
from processing.methods.noise.drive_noise import NoiseSearch
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from tests.structured_scans import SphereScan, ptx_text, sphere_scan

_HALVES_M = np.array([6.0, 4.0, 1.6])


def room_scan(random: np.random.Generator) -> tuple[SphereScan, np.ndarray]:
    """A room of flat walls, and some points that float in it."""
    scan = sphere_scan(300, 200)
    directions = scan.xyz - scan.position
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    ranges = (_HALVES_M / np.maximum(np.abs(directions), 1e-9)).min(axis=1)
    ranges += random.normal(0, 0.002, ranges.size)
    floats = np.zeros(ranges.size, np.bool_)
    floats[random.choice(ranges.size, 120, replace=False)] = True
    ranges[floats] *= random.uniform(0.3, 0.8, 120)
    return replace(scan, xyz=scan.position + directions * ranges[:, None]), floats


def test_points_that_float_in_a_scanned_room_are_noise(tmp_path: Path) -> None:
    scan, floats = room_scan(np.random.default_rng(3))
    path = tmp_path / "room.ptx"
    path.write_text(ptx_text(scan))
    (folder,) = import_drives(ImportRequest((path,)), tmp_path / "made", SilentMonitor())
    drive = Drive(folder)
    origins = beam_origins(drive)
    assert origins is not None
    np.testing.assert_allclose(origins.of(np.arange(3)), np.tile(scan.position, (3, 1)))
    image = image_of(drive, drive.pixel_kind)
    beams, _ = beams_of(drive, image, range(image.rows), origins)
    step = np.radians(120.0 / 199)
    assert abs(beams.step_rad - step) < 0.1 * step
    (tmp_path / "scratch").mkdir()
    codes = np.zeros(drive.count, np.uint8)
    NoiseSearch(drive, codes, tmp_path / "scratch", drive.count).combined(0.5, SilentMonitor())
    assert (codes[floats] > 0).mean() >= 0.9
    assert (codes[~floats] == 0).mean() >= 0.995
