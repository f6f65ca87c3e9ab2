"""Where a head is on its vehicle, against the simulator's own lever arms."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.methods.road.gutters.notches.head_position import head_position
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from tests.builders import simulated_drive, write_laz, write_trajectory_csv

LEVERS_M = {"left": (-0.5, 0.35, 0.5), "right": (-0.5, -0.35, 0.5)}


@pytest.mark.parametrize("head", ["left", "right"])
def test_the_head_is_found_where_it_is_mounted(
    head: Literal["left", "right"], tmp_path: Path
) -> None:
    street = simulated_drive(4, head=head, curve=0.01)
    points = write_laz(street, tmp_path / "points.laz")
    trajectory = write_trajectory_csv(street, tmp_path / "trajectory.csv")
    request = ImportRequest((points,), (trajectory,))
    (made,) = import_drives(request, tmp_path / "drives", SilentMonitor())

    found = head_position(Drive(made))

    np.testing.assert_allclose(found, LEVERS_M[head], atol=0.05)
