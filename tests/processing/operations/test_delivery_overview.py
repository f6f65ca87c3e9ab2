"""What files chosen for an import hold is said before anything of them is read in."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from processing.core.monitor import SilentMonitor
from processing.formats.format import Content
from processing.operations.delivery_overview import TrajectoryState, look_at_delivery


def test_a_whole_delivery_is_told_file_by_file(sample_street: Path) -> None:
    overview = look_at_delivery([sample_street], "", SilentMonitor())
    files = {one.path.name: one for one in overview.files}
    assert overview.trouble is None
    assert overview.crs == "EPSG:6677"
    left, right = files["left.laz"], files["right.laz"]
    assert (left.count, right.count) == (290429, 290680)
    assert (left.scanners, right.scanners) == ((1,), (2,))
    assert left.recording == right.recording == 0
    assert left.trajectory is TrajectoryState.FOUND
    assert str(left.day) == "2023-08-24"
    assert files["trajectory.csv"].content is Content.TRAJECTORY
    assert files["images.csv"].count == 6
    assert not overview.lacks_trajectory


def test_points_alone_lack_their_trajectory(sample_street: Path) -> None:
    overview = look_at_delivery([sample_street / "left.laz"], "", SilentMonitor())
    assert [one.trajectory for one in overview.files] == [TrajectoryState.MISSING]
    assert overview.lacks_trajectory


def test_a_trajectory_of_another_hour_does_not_cover_the_points(
    sample_street: Path, tmp_path: Path
) -> None:
    lines = (sample_street / "trajectory.csv").read_text(encoding="utf-8").splitlines()
    moved = [lines[0]]
    for line in lines[1:]:
        time, rest = line.split(",", 1)
        moved.append(f"{float(time) + 5000.0:.6f},{rest}")
    other = tmp_path / "trajectory.csv"
    other.write_text("\n".join(moved), encoding="utf-8")
    overview = look_at_delivery([sample_street / "left.laz", other], "", SilentMonitor())
    assert overview.files[0].trajectory is TrajectoryState.NOT_COVERING


@pytest.mark.parametrize("bytes_left", [0, 3000])
def test_a_damaged_file_is_named_and_the_others_are_told(
    sample_street: Path, tmp_path: Path, bytes_left: int
) -> None:
    whole = Path(shutil.copy(sample_street / "left.laz", tmp_path))
    damaged = tmp_path / "right.laz"
    damaged.write_bytes((sample_street / "right.laz").read_bytes()[:bytes_left])
    overview = look_at_delivery([whole, damaged], "", SilentMonitor())
    good, bad = overview.files
    assert good.count == 290429
    assert good.trouble is None
    assert bad.trouble is not None
    assert overview.trouble is not None
