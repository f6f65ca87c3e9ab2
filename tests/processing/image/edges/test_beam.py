"""The line of sight through a pixel, against the simulator's own origins."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.image.edges.beam import beam_at
from processing.image.images_of_drives import image_of
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.builders import SimulatedDrive, simulated_drive, write_laz, write_trajectory_csv


@pytest.fixture(scope="module")
def street() -> SimulatedDrive:
    return simulated_drive(3, curve=0.02)


def _imported(street: SimulatedDrive, folder: Path, *, with_trajectory: bool) -> Drive:
    folder.mkdir()
    points = write_laz(street, folder / "left.laz")
    trajectory = write_trajectory_csv(street, folder / "trajectory.csv")
    into = folder / "drives"
    into.mkdir()
    request = ImportRequest((points,), (trajectory,) if with_trajectory else ())
    (made,) = import_drives(request, into, SilentMonitor())
    return Drive(made)


@pytest.mark.parametrize("kind", [ImageKind.TRAJECTORY_CENTER, ImageKind.TRAJECTORY_REVERSIBLE])
def test_the_beam_starts_at_the_scanner_and_passes_the_measured_point(
    street: SimulatedDrive, tmp_path: Path, kind: ImageKind
) -> None:
    drive = _imported(street, tmp_path / "通り", with_trajectory=True)
    image = image_of(drive, kind)
    points = np.random.default_rng(1).integers(500, drive.count - 500, 60)
    rows, columns = image.pixel_of(points)
    for point, row, column in zip(points, rows, columns, strict=True):
        found = beam_at(drive, image, int(row), int(column))
        assert found is not None
        origin, direction = np.array(found[0]), np.array(found[1])
        assert np.linalg.norm(origin - street.origin[point]) < 0.02
        seen = drive.xyz(np.array([point]))[0] - origin
        off = np.degrees(np.arccos(seen @ direction / np.linalg.norm(seen)))
        assert off < 360 / street.pulses_per_revolution


def test_without_a_trajectory_the_row_itself_tells_where_the_scanner_was(
    street: SimulatedDrive, tmp_path: Path
) -> None:
    drive = _imported(street, tmp_path / "street", with_trajectory=False)
    image = image_of(drive, ImageKind.REVERSIBLE)
    row = image.rows // 2
    found = beam_at(drive, image, row, image.width // 2)
    assert found is not None
    away = np.linalg.norm(np.array(found[0]) - street.origin[int(image.row_starts[row])])
    assert away < 0.25  # the vehicle moves 8 cm a turn


def test_outside_the_image_there_is_no_beam(street: SimulatedDrive, tmp_path: Path) -> None:
    drive = _imported(street, tmp_path / "street", with_trajectory=True)
    image = image_of(drive, ImageKind.TRAJECTORY_CENTER)
    assert beam_at(drive, image, -1, 0) is None
    assert beam_at(drive, image, 0, image.width) is None
