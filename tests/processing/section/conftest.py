"""A street of ten metres whose cross-section is known: recorded once, read only."""

from __future__ import annotations

from typing import Literal

import pytest

from processing.core.monitor import SilentMonitor
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from tests.builders import simulated_drive, write_laz, write_trajectory_csv


@pytest.fixture(scope="session")
def street(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return recorded(tmp_path_factory, "left")


@pytest.fixture(scope="session")
def both_heads(street: Drive, tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, Drive]:
    return street, recorded(tmp_path_factory, "right")


def recorded(tmp_path_factory: pytest.TempPathFactory, head: Literal["left", "right"]) -> Drive:
    folder = tmp_path_factory.mktemp("section")
    delivered = simulated_drive(3, pulses_per_revolution=800.0, head=head)
    points = write_laz(delivered, folder / "street.laz")
    trajectory = write_trajectory_csv(delivered, folder / "trajectory.csv")
    (folder / "drives").mkdir()
    request = ImportRequest((points,), (trajectory,))
    (made,) = import_drives(request, folder / "drives", SilentMonitor())
    return Drive(made)
