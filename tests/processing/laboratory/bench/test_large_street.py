"""Large recordings are made of the sample as one long drive would have been recorded."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np

from processing.core.monitor import SilentMonitor
from processing.formats.trajectories.trajectory_files import read_trajectory
from processing.laboratory.bench.large_street import write_long_delivery
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from resources import path_of


def sample_points() -> int:
    with laspy.open(path_of("sample_street") / "left.laz") as reader:
        return int(reader.header.point_count)


def test_times_go_on_from_file_to_file_and_the_trajectory_covers_them(tmp_path: Path) -> None:
    delivery = write_long_delivery(tmp_path, 2 * 3 * sample_points(), files=3)
    assert len(delivery.clouds) == 6
    trajectory = read_trajectory(delivery.trajectory, "")
    last = -np.inf
    for cloud in delivery.clouds[:3]:
        times = laspy.read(cloud).gps_time
        assert times[0] > last
        assert trajectory.covers(times).all()
        last = times[-1]


def test_files_of_two_scanners_become_two_drives_with_unbroken_revolutions(tmp_path: Path) -> None:
    points = 2 * 2 * sample_points()
    delivery = write_long_delivery(tmp_path, points, files=2)
    request = ImportRequest(delivery.clouds, (delivery.trajectory,))
    drives = [Drive(folder) for folder in import_drives(request, tmp_path / "d", SilentMonitor())]
    assert [drive.info.scanner for drive in drives] == [1, 2]
    assert sum(drive.count for drive in drives) == points
    for drive in drives:
        assert drive.revolutions is not None
        assert round(drive.revolutions.revolution_rate_hz) == 100
