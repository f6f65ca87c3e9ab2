"""Results of tools are written beside the delivered points, in the delivered order."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import BadFile, Cancelled, InUse, MissingInput
from processing.core.monitor import SilentMonitor
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.results.point_results import check_point_output, write_point_results
from processing.recording.columns.columns import ColumnWriter
from processing.recording.drive import Drive
from processing.tools.tool import FinishedColumns
from tests.builders import simulated_drive, write_laz, write_trajectory_csv


class CancelAfterFirstFile(SilentMonitor):
    """Cancels once the first file is written."""

    def __init__(self) -> None:
        self._reported = 0.0

    def report(self, fraction: float, text: object = None) -> None:
        self._reported = fraction

    def check(self) -> None:
        if self._reported > 0.5:
            raise Cancelled


@pytest.fixture
def delivered(tmp_path: Path) -> tuple[Path, ...]:
    """One street in two files of one name, the second half of each turned round in time."""
    street = simulated_drive(2, length_m=3.0)
    cloud = laspy.read(write_laz(street, tmp_path / "street.laz"))
    write_trajectory_csv(street, tmp_path / "way.csv")
    half = len(cloud.points) // 2
    paths = []
    for number, part in enumerate((slice(None, half), slice(half, None))):
        path = tmp_path / str(number) / "street.laz"
        path.parent.mkdir()
        points = cloud.points[part]
        order = np.arange(len(points))
        order[len(points) // 2 :] = order[len(points) // 2 :][::-1]
        laspy.LasData(cloud.header, points[order]).write(path)
        paths.append(path)
    return tuple(paths)


@pytest.fixture
def drive(tmp_path: Path, delivered: tuple[Path, ...]) -> Drive:
    request = ImportRequest(delivered, (tmp_path / "way.csv",))
    (folder,) = import_drives(request, tmp_path / "drives", SilentMonitor())
    return Drive(folder)


def found_on(drive: Drive, folder: Path) -> FinishedColumns:
    """A segment for each point that is told by its place, so that each is known again."""
    folder.mkdir()
    with ColumnWriter(folder) as writer:
        writer.append({"segment": drive.columns["xyz"][:, 0]})
    return FinishedColumns(folder, ("segment",), drive.count)


def test_points_of_any_order_get_their_own_results(
    tmp_path: Path, drive: Drive, delivered: tuple[Path, ...]
) -> None:
    result = found_on(drive, tmp_path / "found")
    paths = write_point_results([(drive, result)], tmp_path / "out" / "o.las", SilentMonitor())
    # Files of one name in two folders don't overwrite each other.
    assert [path.name for path in paths] == ["o-street.las", "o-street-2.las"]
    for source, path in zip(delivered, paths, strict=True):
        before, after = laspy.read(source), laspy.read(path)
        np.testing.assert_array_equal(after.X, before.X)
        np.testing.assert_array_equal(after.gps_time, before.gps_time)
        shift = round((before.header.offsets[0] - drive.info.offset[0]) / drive.info.scale[0])
        np.testing.assert_array_equal(np.asarray(after["segment"]), before.X + shift)


def test_all_outputs_are_written_or_none(tmp_path: Path, drive: Drive) -> None:
    result = found_on(drive, tmp_path / "found")
    with pytest.raises(Cancelled):
        write_point_results([(drive, result)], tmp_path / "out" / "o.las", CancelAfterFirstFile())
    assert list((tmp_path / "out").iterdir()) == []


def test_what_an_output_needs_is_looked_at_before(
    tmp_path: Path, drive: Drive, delivered: tuple[Path, ...]
) -> None:
    files = check_point_output([drive], tmp_path / "o.laz", SilentMonitor())
    assert [source for source, _ in files] == sorted(delivered)
    first, second = delivered
    # Outputs have the files' own names added: this one would be the second delivered file.
    second.rename(second.with_name("o-street.laz"))
    again = ImportRequest((first, second.with_name("o-street.laz")), (tmp_path / "way.csv",))
    (folder,) = import_drives(again, tmp_path / "again", SilentMonitor())
    second = second.with_name("o-street.laz")
    drive = Drive(folder)
    with pytest.raises(InUse):
        check_point_output([drive], second.with_name("o.laz"), SilentMonitor())
    content = second.read_bytes()
    second.write_bytes(content + b" ")
    with pytest.raises(BadFile, match="changed"):
        check_point_output([drive], tmp_path / "o.laz", SilentMonitor())
    second.unlink()
    with pytest.raises(MissingInput, match="no longer"):
        check_point_output([drive], tmp_path / "o.laz", SilentMonitor())
