"""Painted labels exported, imported, equal: over all points, whatever was delivered."""

from __future__ import annotations

import hashlib
from contextlib import closing
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import BadFile, InUse, MissingInput
from processing.operations.export import ExportRequest, export
from processing.project.importing.importing import ImportRequest
from processing.project.project import Project
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.processing.project.labelled import all_labels, paint, project_of


def delivered(folder: Path, heads: tuple[str, ...], *, old_format: bool = False) -> Path:
    """One file with the points of scanners in turns of their own, some of them classified."""
    clouds = []
    for number, head in enumerate(heads):
        street = simulated_drive(1, head=head, length_m=3.0)
        street.columns["classification"][::5] = 2 + number
        clouds.append(laspy.read(write_laz(street, folder / f"{head}.laz")))
        way = write_trajectory_csv(street, folder / "way.csv")
    header = laspy.LasHeader(
        point_format=1 if old_format else 6, version="1.2" if old_format else "1.4"
    )
    header.scales, header.offsets = clouds[0].header.scales, clouds[0].header.offsets
    cloud = laspy.LasData(header)
    names = ("X", "Y", "Z", "intensity", "gps_time", "point_source_id", "classification",
             "return_number", "number_of_returns")  # fmt: skip
    times = np.concatenate([np.asarray(one.gps_time) for one in clouds])
    order = np.argsort(times, kind="stable")
    for name in names:
        cloud[name] = np.concatenate([np.asarray(one[name]) for one in clouds])[order]
    path = folder / ("both.las" if old_format else "both.laz")
    cloud.write(path)
    assert way.is_file()
    return path


def exported(project: Project, folder: Path, formats: tuple[str, ...] = ("las",)) -> list[Path]:
    never = tuple(path for drive in project.drives for path in drive.delivered_files)
    request = ExportRequest(formats, folder, never=never)
    return list(export((), project.catalogue, project.crs, request, drives=project.drives))


def painted_at_random(project: Project) -> None:
    random = np.random.default_rng(4)
    for number, drive in enumerate(project.drives):
        for code in (0, 2, 11, 64, 67, 200):
            paint(project, random.choice(drive.count, drive.count // 4), code, number)


@pytest.mark.parametrize("old_format", [False, True])
def test_painted_labels_exported_and_imported_are_equal_over_all_points(tmp_path, old_format):
    source = delivered(tmp_path, ("left", "right"), old_format=old_format)
    digest = hashlib.sha256(source.read_bytes()).hexdigest()
    way = tmp_path / "way.csv"
    folder = project_of(tmp_path / "a.zuka", ImportRequest((source,), (way,), crs="EPSG:6677"))
    with closing(Project.open(folder)) as project:
        assert len(project.drives) == 2
        painted_at_random(project)
        (written,) = exported(project, tmp_path / "out")
        wanted = {drive.info.scanner: all_labels(drive) for drive in project.drives}
        classes = {d.info.scanner: np.array(d.columns["classification"]) for d in project.drives}
    assert written.name == source.name
    assert hashlib.sha256(source.read_bytes()).hexdigest() == digest
    before, after = laspy.read(source), laspy.read(written)
    for name in ("X", "Y", "Z", "intensity", "gps_time", "point_source_id", "return_number"):
        np.testing.assert_array_equal(after[name], before[name])
    for scanner, labels in wanted.items():
        own = np.asarray(after.point_source_id) == scanner
        np.testing.assert_array_equal(np.asarray(after["label"])[own], labels)
        np.testing.assert_array_equal(
            np.asarray(after.classification)[own], np.where(labels, labels, classes[scanner])
        )
    again = project_of(tmp_path / "b.zuka", ImportRequest((written,), (way,), crs="EPSG:6677"))
    with closing(Project.open(again)) as project:
        assert {drive.info.scanner for drive in project.drives} == set(wanted)
        for drive in project.drives:
            np.testing.assert_array_equal(all_labels(drive), wanted[drive.info.scanner])
        # What was imported is where the history starts.
        paint(project, [0, 1, 2], 5)
        project.features.undo()
        np.testing.assert_array_equal(
            all_labels(project.drives[0]), wanted[project.drives[0].info.scanner]
        )
        painted_at_random(project)
        wanted = {drive.info.scanner: all_labels(drive) for drive in project.drives}
        (third,) = exported(project, tmp_path / "out" / "again")
    cloud = laspy.read(third)
    assert list(cloud.point_format.extra_dimension_names) == ["label"]
    for scanner, labels in wanted.items():
        own = np.asarray(cloud.point_source_id) == scanner
        np.testing.assert_array_equal(np.asarray(cloud["label"])[own], labels)


def test_classes_become_labels_when_that_is_wanted(tmp_path):
    source = delivered(tmp_path, ("left",))
    request = ImportRequest((source,), (tmp_path / "way.csv",), labels="classification")
    with closing(Project.open(project_of(tmp_path / "a.zuka", request))) as project:
        (drive,) = project.drives
        np.testing.assert_array_equal(all_labels(drive), drive.columns["classification"])
        assert all_labels(drive).any()


def test_of_two_files_one_may_have_labels_and_both_are_one_drive(tmp_path):
    source = delivered(tmp_path, ("left",))
    cloud = laspy.read(source)
    half = len(cloud.points) // 2
    first, second = tmp_path / "first.las", tmp_path / "second.las"
    laspy.LasData(cloud.header, cloud.points[:half]).write(first)
    cloud.add_extra_dim(laspy.ExtraBytesParams("label", "u1"))
    cloud["label"] = np.arange(len(cloud.points)) % 7
    laspy.LasData(cloud.header, cloud.points[half:]).write(second)
    request = ImportRequest((first, second), (tmp_path / "way.csv",))
    with closing(Project.open(project_of(tmp_path / "a.zuka", request))) as project:
        (drive,) = project.drives
        labels = all_labels(drive)
        assert not labels[:half].any()
        np.testing.assert_array_equal(labels[half:], np.arange(half, drive.count) % 7)


def test_a_dimension_of_that_name_but_another_type_is_not_taken_for_labels(tmp_path):
    source = delivered(tmp_path, ("left",))
    cloud = laspy.read(source)
    cloud.add_extra_dim(laspy.ExtraBytesParams("label", "f4"))
    cloud["label"] = np.linspace(0, 900, len(cloud.points))
    cloud.write(tmp_path / "other.laz")
    request = ImportRequest((tmp_path / "other.laz",), (tmp_path / "way.csv",))
    with closing(Project.open(project_of(tmp_path / "a.zuka", request))) as project:
        assert not all_labels(project.drives[0]).any()


def test_a_delivered_file_is_never_written_and_must_be_there_and_the_same(tmp_path):
    source = delivered(tmp_path, ("left",))
    folder = project_of(tmp_path / "a.zuka", ImportRequest((source,), (tmp_path / "way.csv",)))
    with closing(Project.open(folder)) as project:
        paint(project, range(100), 11)
        before = source.read_bytes()
        with pytest.raises(InUse):
            exported(project, source.parent)
        assert source.read_bytes() == before
        source.write_bytes(before + b" ")
        with pytest.raises(BadFile):
            exported(project, tmp_path / "out")
        source.unlink()
        with pytest.raises(MissingInput) as refusal:
            exported(project, tmp_path / "out", ("geojson", "las"))
        assert refusal.value.where.en == str(source)
        assert list((tmp_path / "out").iterdir()) == []


def test_files_of_the_same_name_from_two_folders_get_names_of_their_own(tmp_path):
    sources = []
    for head in ("left", "right"):
        (tmp_path / head).mkdir()
        street = simulated_drive(1, head=head, length_m=2.0)
        sources.append(write_laz(street, tmp_path / head / "street.laz"))
        way = write_trajectory_csv(street, tmp_path / "way.csv")
    folder = project_of(tmp_path / "a.zuka", ImportRequest(tuple(sources), (way,)))
    with closing(Project.open(folder)) as project:
        paint(project, range(40), 11, 0)
        paint(project, range(70), 6, 1)
        written = exported(project, tmp_path / "out")
    assert [path.name for path in written] == ["street.laz", "street-2.laz"]
    counts = [np.count_nonzero(laspy.read(path)["label"]) for path in written]
    assert sorted(counts) == [40, 70]


def test_a_project_without_drives_gives_no_point_files(tmp_path):
    with closing(Project.create(tmp_path / "a.zuka", "EPSG:6677")) as project:
        assert exported(project, tmp_path / "out") == []
