"""Flight lines of a tile are one cloud; the heads of a vehicle are drives of their own."""

import laspy
import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive


def _tile(path, source_ids, starts_s):
    """Strips of points, delivered line by line, thinned as tiles often are."""
    random = np.random.default_rng(5)
    las = laspy.LasData(laspy.LasHeader(point_format=6, version="1.4"))
    las.header.scales = [0.001] * 3
    each = 800
    count = each * len(source_ids)
    las.x, las.y, las.z = random.uniform([0, 0, 0], [100.0, 100.0, 5.0], (count, 3)).T
    las.point_source_id = np.repeat(source_ids, each)
    times = [np.sort(start + random.uniform(0, 5.0, each)) for start in starts_s]
    las.gps_time = np.concatenate(times)
    las.write(path)
    return path


@pytest.mark.parametrize(
    ("source_ids", "starts_s", "drives"),
    [
        ([66, 67, 68], [9_000.0, 9_500.0, 9_900.0], 1),
        ([68, 67, 66], [9_900.0, 9_000.0, 9_500.0], 1),
        ([1, 2], [9_000.0, 9_500.0], 2),  # small numbers are heads of a vehicle
        ([66, 67], [9_000.0, 9_000.0], 2),  # so are those that went along
    ],
)
def test_source_ids_that_follow_one_another_in_time_are_one_cloud(
    tmp_path, source_ids, starts_s, drives
):
    path = _tile(tmp_path / "tile.las", source_ids, starts_s)
    folders = import_drives(ImportRequest((path,)), tmp_path / "made", SilentMonitor())
    made = [Drive(folder) for folder in folders]
    assert len(made) == drives
    assert sum(drive.count for drive in made) == 800 * len(source_ids)
    assert made[0].info.name == ("tile" if drives == 1 else f"tile ({source_ids[0]})")
