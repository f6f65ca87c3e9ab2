"""Imports: scanners told apart, exact coordinates, order and clock restored, all or nothing."""

from __future__ import annotations

import hashlib
import shutil
from dataclasses import replace

import laspy
import numpy as np
import pytest

from processing.core.errors import BadFile, Cancelled, MissingInput, OutOfRange, UserError
from processing.core.monitor import SilentMonitor
from processing.image.images_of_drives import image_of
from processing.project.additions import lacks_trajectory
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from processing.recording.measured_day import measured_day
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.delivered_files import make_las


@pytest.fixture(scope="module")
def left():
    return simulated_drive(1, head="left")


@pytest.fixture(scope="module")
def right():
    return simulated_drive(1, head="right")


def _imported(tmp_path, inputs, trajectories=(), **more):
    request = ImportRequest(tuple(inputs), tuple(trajectories), **more)
    return [Drive(folder) for folder in import_drives(request, tmp_path / "in", SilentMonitor())]


def _shifted(cloud_path, output, change):
    with laspy.open(cloud_path) as reader:
        cloud = reader.read()
    change(cloud)
    cloud.write(output)
    return output


def test_coordinates_times_and_pulses_are_those_of_the_delivery(tmp_path, left):
    cloud = write_laz(left, tmp_path / "左.laz")
    before = hashlib.sha256(cloud.read_bytes()).hexdigest(), cloud.stat().st_mtime_ns
    (drive,) = _imported(tmp_path, [cloud], [write_trajectory_csv(left, tmp_path / "軌跡.csv")])
    assert (drive.columns["xyz"] == left.columns["xyz"]).all()
    assert (drive.columns["time"] == left.columns["time"]).all()
    assert np.unique(drive.columns["pulse"] - left.pulse).size == 1
    assert drive.info.rows_by == "trajectory"
    assert drive.info.crs == "EPSG:6677"
    assert (hashlib.sha256(cloud.read_bytes()).hexdigest(), cloud.stat().st_mtime_ns) == before
    assert drive.info.sources[0].sha256 == before[0]


@pytest.mark.parametrize("told_by", ["point_source_id", "user_data", "file"])
def test_two_scanners_are_two_drives_however_they_are_told_apart(tmp_path, left, right, told_by):
    way = write_trajectory_csv(left, tmp_path / "way.csv")
    first = write_laz(left, tmp_path / "first.laz")
    second = write_laz(right, tmp_path / "second.laz")

    def without_id(cloud):
        cloud.point_source_id[:] = 0

    files = [
        _shifted(first, tmp_path / "a.laz", without_id),
        _shifted(second, tmp_path / "b.laz", without_id),
    ]
    if told_by != "file":
        files = [_joined(first, second, tmp_path / "both.laz", told_by)]
    drives = _imported(tmp_path, files, [way])
    assert sorted(drive.count for drive in drives) == sorted([left.count, right.count])
    for drive in drives:
        assert drive.revolutions is not None
        assert abs(drive.revolutions.revolution_rate_hz - 100.0) < 0.5


def _joined(first, second, output, told_by):
    """Both recordings in one file, in the order of time."""
    one, other = (laspy.read(path) for path in (first, second))
    points = np.concatenate([one.points.array, other.points.array])
    marks = np.concatenate([np.full(len(one), 1), np.full(len(other), 2)])
    order = np.argsort(points["gps_time"], kind="stable")
    cloud = laspy.LasData(one.header)
    cloud.points = laspy.ScaleAwarePointRecord(
        points[order], one.header.point_format, one.header.scales, one.header.offsets
    )
    is_id = told_by == "point_source_id"
    cloud.point_source_id[:] = marks[order] if is_id else 7
    cloud.user_data[:] = 0 if is_id else marks[order]
    cloud.write(output)
    return output


def test_files_of_one_drive_in_the_wrong_order_become_one_recording(tmp_path, left):
    whole = write_laz(left, tmp_path / "whole.laz")
    parts = []
    for number, rows in enumerate(np.array_split(np.arange(left.count), 3)):
        with laspy.open(whole) as reader:
            cloud = reader.read()
        cloud.points = cloud.points[rows[0] : rows[-1] + 1]
        # Another offset of the same lattice: integers differ, coordinates don't.
        part = tmp_path / f"z{9 - number}.laz"
        cloud.change_scaling(offsets=np.array([-11_000.0, -35_000.0, 100.0]) + number)
        cloud.write(part)
        parts.append(part)
    way = write_trajectory_csv(left, tmp_path / "way.csv")
    (drive,) = _imported(tmp_path, parts, [way])
    assert np.abs(drive.xyz(slice(None)) - left.xyz).max() < 1e-9
    assert np.unique(drive.columns["pulse"] - left.pulse).size == 1
    files, indices = drive.sources(0, drive.count)
    assert (
        indices.tolist()
        == np.concatenate(
            [np.arange((files == file).sum()) for file in dict.fromkeys(files.tolist())]
        ).tolist()
    )


def test_a_file_that_lost_its_time_order_gets_it_back_and_knows_where_points_were(tmp_path, left):
    order = np.random.default_rng(2).permutation(left.count)

    def shuffle(cloud):
        cloud.points = cloud.points[order]

    cloud = _shifted(write_laz(left, tmp_path / "a.laz"), tmp_path / "shuffled.laz", shuffle)
    (drive,) = _imported(tmp_path, [cloud], [write_trajectory_csv(left, tmp_path / "way.csv")])
    assert (np.diff(drive.columns["time"]) >= 0).all()
    _, indices = drive.sources(0, drive.count)
    delivered = laspy.read(cloud)
    assert (np.asarray(delivered.X)[indices] == drive.columns["xyz"][:, 0]).all()
    assert drive.info.rows_by == "trajectory"


@pytest.mark.parametrize("offset_s", [0.0, 1e9, 604_800.0 * 2_100 - 1e9])
def test_points_on_another_gps_clock_are_brought_to_the_trajectorys(tmp_path, left, offset_s):
    way = write_trajectory_csv(left, tmp_path / "way.csv")

    def on_another_clock(cloud):
        cloud.gps_time = np.asarray(cloud.gps_time) + offset_s

    cloud = _shifted(write_laz(left, tmp_path / "a.laz"), tmp_path / "b.laz", on_another_clock)
    (drive,) = _imported(tmp_path, [cloud], [way])
    assert drive.info.clock_offset_s == -offset_s
    assert np.abs(drive.columns["time"] - left.columns["time"]).max() < 1e-6


def test_a_trajectory_of_another_time_is_refused_and_nothing_is_left(tmp_path, left):
    moved = replace(left, trajectory=replace(left.trajectory, time=left.trajectory.time + 1_234.5))
    way = write_trajectory_csv(moved, tmp_path / "別の日.csv")
    with pytest.raises(OutOfRange) as refusal:
        _imported(tmp_path, [write_laz(left, tmp_path / "a.laz")], [way])
    assert "別の日.csv" in refusal.value.line("ja")
    assert not (tmp_path / "in").exists()


def test_without_a_trajectory_rows_come_from_the_rhythm_of_the_points(tmp_path, left):
    (drive,) = _imported(tmp_path, [write_laz(left, tmp_path / "a.laz")])
    assert drive.info.rows_by == "periodicity"
    assert np.unique(drive.columns["pulse"] - left.pulse).size == 1


@pytest.mark.parametrize("filler_s", [np.nan, 0.0])
def test_without_any_time_rows_come_from_the_order_of_the_points(tmp_path, left, filler_s):
    def spoil(cloud):
        cloud.gps_time[:] = filler_s

    cloud = _shifted(write_laz(left, tmp_path / "a.laz"), tmp_path / "b.laz", spoil)
    (drive,) = _imported(tmp_path, [cloud])
    assert drive.info.rows_by == "order"
    assert not drive.info.has_measured_times
    assert "order of the points" in drive.info.rows_reason.en
    assert "並び順" in drive.info.rows_reason.ja
    assert ImageKind.REVERSIBLE in drive.image_kinds
    assert (drive.columns["xyz"] == left.columns["xyz"]).all()
    assert drive.trajectory is not None
    assert drive.trajectory.covers(drive.columns["time"]).all()
    assert measured_day([drive]) is None
    assert not lacks_trajectory(drive)


def test_points_sorted_by_object_are_brought_into_rows_and_know_where_they_were(tmp_path, left):
    height = left.columns["xyz"][:, 2]
    order = np.argsort(height > np.median(height) + 300, kind="stable")

    def sort(cloud):
        cloud.points = cloud.points[order]
        cloud.gps_time[:] = 0.0

    cloud = _shifted(write_laz(left, tmp_path / "a.laz"), tmp_path / "b.laz", sort)
    (drive,) = _imported(tmp_path, [cloud])
    assert drive.info.rows_by == "order"
    assert (np.diff(drive.columns["pulse"]) >= 0).all()
    assert (np.diff(drive.columns["time"]) >= 0).all()
    _, indices = drive.sources(0, drive.count)
    delivered = laspy.read(cloud)
    assert (np.asarray(delivered.X)[indices] == drive.columns["xyz"][:, 0]).all()


@pytest.mark.parametrize("without", ["times", "pulses"])
def test_where_there_are_no_rows_the_top_view_is_made_and_says_why(tmp_path, left, without):
    def spoil(cloud):
        if without == "times":
            cloud.gps_time[:] = np.nan
            cloud.points = cloud.points[np.random.default_rng(5).permutation(left.count)]
        else:
            cloud.points = cloud.points[np.arange(0, left.count, 97)]

    cloud = _shifted(write_laz(left, tmp_path / "a.laz"), tmp_path / "b.laz", spoil)
    (drive,) = _imported(tmp_path, [cloud])
    assert drive.info.rows_by == "top-view"
    assert drive.info.rows_reason.en
    assert drive.info.rows_reason.ja
    image = image_of(drive, drive.image_kinds[0])
    assert (image.raster(range(image.rows), range(image.width)) >= 0).sum() > drive.count / 3


def test_rows_that_would_be_nearly_empty_are_not_made_of_a_cut_out(tmp_path):
    street = simulated_drive(length_m=20.0)
    kept = (street.pulse // 1000) % 60 == 0  # one turn in sixty

    def cut(cloud):
        cloud.points = cloud.points[kept]

    cloud = _shifted(write_laz(street, tmp_path / "a.laz"), tmp_path / "b.laz", cut)
    (drive,) = _imported(tmp_path, [cloud])
    assert drive.info.rows_by == "top-view"
    assert "one pixel in fifty" in drive.info.rows_reason.en


@pytest.mark.parametrize("epsg", [4269, 2903])  # degrees; feet
def test_points_in_degrees_or_feet_are_to_be_transformed_first(tmp_path, epsg):
    make_las(tmp_path / "a.las", epsg=epsg)
    with pytest.raises(OutOfRange) as refusal:
        _imported(tmp_path, [tmp_path / "a.las"])
    assert "a.las" in refusal.value.where.en
    assert "Transform the points" in refusal.value.remedy.en


def test_of_a_file_without_points_that_is_told_whatever_its_reference_system(tmp_path):
    make_las(tmp_path / "a.las", epsg=4269, count=0)
    with pytest.raises(BadFile, match="There are no points in it"):
        _imported(tmp_path, [tmp_path / "a.las"])


def test_files_of_different_reference_systems_are_refused(tmp_path, left):
    files = [
        write_laz(left, tmp_path / "a.laz", crs="EPSG:6677"),
        write_laz(left, tmp_path / "b.laz", crs="EPSG:6676"),
    ]
    with pytest.raises(OutOfRange, match=r"EPSG:667[67]"):
        _imported(tmp_path, files)
    assert {d.info.crs for d in _imported(tmp_path, files, crs="EPSG:6677")} == {"EPSG:6677"}


def test_nothing_to_import_is_said(tmp_path, left):
    with pytest.raises(MissingInput):
        _imported(tmp_path, [])

    def empty(cloud):
        cloud.points = cloud.points[:0]

    cloud = _shifted(write_laz(left, tmp_path / "a.laz"), tmp_path / "空.laz", empty)
    with pytest.raises(BadFile) as refusal:
        _imported(tmp_path, [cloud])
    assert "空.laz" in refusal.value.line("ja")


class _StopsAt:
    """Asks to stop once the work has come this far."""

    def __init__(self, fraction):
        self._fraction = fraction
        self._is_there = False

    def report(self, fraction, text=None):
        self._is_there |= fraction >= self._fraction

    def check(self):
        if self._is_there:
            raise Cancelled


@pytest.mark.parametrize("fraction", [0.1, 0.7, 0.75])
def test_a_cancelled_import_leaves_nothing(tmp_path, left, fraction):
    cloud = write_laz(left, tmp_path / "a.laz")
    way = write_trajectory_csv(left, tmp_path / "way.csv")
    with pytest.raises(Cancelled):
        import_drives(ImportRequest((cloud,), (way,)), tmp_path / "in", _StopsAt(fraction))
    assert not (tmp_path / "in").exists()


def test_a_file_cut_off_while_it_was_copied_is_refused_and_nothing_is_left(tmp_path, left):
    cloud = write_laz(left, tmp_path / "a.laz")
    data = cloud.read_bytes()
    for share in (0.2, 0.6, 0.95):
        cut = tmp_path / "cut.laz"
        cut.write_bytes(data[: int(share * len(data))])
        with pytest.raises(UserError) as refusal:
            _imported(tmp_path, [cut])
        assert "cut.laz" in refusal.value.line("en")
        assert not (tmp_path / "in").exists()
    shutil.rmtree(tmp_path / "in", ignore_errors=True)


def test_files_of_another_system_than_the_project_s_are_refused_before_they_are_read(
    tmp_path, left
):
    into = tmp_path / "into"
    request = ImportRequest((write_laz(left, tmp_path / "a.laz"),), crs="EPSG:6675")
    with pytest.raises(OutOfRange, match="EPSG:6675"):
        import_drives(request, into, SilentMonitor(), system="EPSG:6677")
    assert not into.exists()
