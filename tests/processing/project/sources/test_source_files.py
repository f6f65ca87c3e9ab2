"""Delivered files and camera images are found again wherever project and delivery went."""

from __future__ import annotations

import os
import shutil
from contextlib import closing
from pathlib import Path

import pytest

from processing.core.errors import BadFile, MissingInput
from processing.core.monitor import SilentMonitor
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.project import Project
from processing.project.sources.source_check import FileState, require_delivered
from tests.builders import simulated_drive, write_laz, write_trajectory_csv

_IMAGES = (
    "path,time_s,easting_m,northing_m,height_m,omega_deg,phi_deg,kappa_deg,"
    "focal_px,cx_px,cy_px,width_px,height_px\n"
    "images/1.jpg,205001,-11030,-35020,127,90,0,0,500,320,240,640,480\n"
    "images/2.jpg,205001.1,-11029,-35020,127,90,0,0,500,320,240,640,480\n"
)


@pytest.fixture(scope="module")
def job(tmp_path_factory) -> Path:
    """A folder with a project and the delivery it was made of."""
    job = tmp_path_factory.mktemp("jobs") / "7"
    delivery = job / "納品"
    (delivery / "images").mkdir(parents=True)
    for name in ("1.jpg", "2.jpg"):
        (delivery / "images" / name).write_bytes(b"never opened here")
    (delivery / "images.csv").write_text(_IMAGES)
    street = simulated_drive(length_m=2.0)
    request = ImportRequest(
        (write_laz(street, delivery / "left.laz"),),
        (write_trajectory_csv(street, delivery / "trajectory.csv"),),
        (delivery / "images.csv",),
    )
    with closing(Project.create(job / "street.zuka", "EPSG:6677")) as project:
        into = project.temporary_folder()
        project.adopt_drives(import_drives(request, into, SilentMonitor()))
    return job


@pytest.fixture
def elsewhere(tmp_path: Path, job: Path) -> Path:
    """The whole job on another disk, where the first one is gone."""
    copy = tmp_path / "moved"
    shutil.copytree(job, copy / "7")
    hidden = job.with_name("hidden")
    job.rename(hidden)
    yield copy / "7"
    hidden.rename(job)


def _found(project: Project, chosen: Path | None = None) -> list[tuple[str, FileState]]:
    survey = project.sources.survey(project.drives, chosen)
    project.sources.take(survey.look(lambda: None), project.drives)
    return [(trouble.path.name, trouble.state) for trouble in project.sources.troubles]


def test_a_job_that_was_moved_whole_finds_its_files_beside_the_project(elsewhere):
    with closing(Project.open(elsewhere / "street.zuka")) as project:
        assert _found(project) == []
        (drive,) = project.drives
        (source,) = drive.info.sources
        assert drive.source_path(source) == elsewhere / "納品" / "left.laz"
        assert Path(source.path) in drive.delivered_files
        assert elsewhere / "納品" / "left.laz" in drive.delivered_files
        for images in (drive.images, drive.delivered_images):
            assert [image.path.parent for image in images] == [elsewhere / "納品" / "images"] * 2


def test_what_was_found_is_known_at_the_next_opening_without_looking(elsewhere):
    with closing(Project.open(elsewhere / "street.zuka")) as project:
        _found(project)
    with closing(Project.open(elsewhere / "street.zuka")) as project:
        (drive,) = project.drives
        assert drive.source_path(drive.info.sources[0]).is_file()


def test_a_project_that_went_alone_is_told_once_where_all_its_files_are(elsewhere, tmp_path):
    shutil.move(elsewhere / "street.zuka", tmp_path / "desk" / "street.zuka")
    archive = tmp_path / "archive" / "2026"
    shutil.move(elsewhere / "納品", archive / "納品")
    with closing(Project.open(tmp_path / "desk" / "street.zuka")) as project:
        missing = {("left.laz", FileState.MISSING), ("1.jpg", FileState.MISSING)}
        assert missing < set(_found(project))
        assert _found(project, tmp_path / "archive" / "2026") == []
        assert project.drives[0].images[1].path == archive / "納品" / "images" / "2.jpg"
    shutil.move(tmp_path / "archive", tmp_path / "away" / "archive")
    shutil.move(tmp_path / "desk", tmp_path / "away" / "desk")
    with closing(Project.open(tmp_path / "away" / "desk" / "street.zuka")) as project:
        assert _found(project) == []


def test_files_on_an_unplugged_disk_are_found_again_where_they_were_told_to_be(elsewhere, tmp_path):
    shutil.move(elsewhere / "納品", tmp_path / "usb" / "納品")
    folder = elsewhere / "street.zuka"
    with closing(Project.open(folder)) as project:
        assert _found(project, tmp_path / "usb") == []
    (tmp_path / "usb").rename(tmp_path / "unplugged")
    with closing(Project.open(folder)) as project:
        assert len(_found(project)) == 3
    (tmp_path / "unplugged").rename(tmp_path / "usb")
    with closing(Project.open(folder)) as project:
        assert _found(project) == []


def test_another_date_is_no_change_and_another_content_is_one(tmp_path, job):
    shutil.copytree(job, tmp_path / "7")
    delivered = job / "納品" / "left.laz"
    with closing(Project.open(tmp_path / "7" / "street.zuka")) as project:
        (drive,) = project.drives
        (source,) = drive.info.sources
        before = delivered.read_bytes()
        status = delivered.stat()
        try:
            os.utime(delivered, ns=(status.st_atime_ns, status.st_mtime_ns + 1_000_000_000))
            assert _found(project) == []
            require_delivered(source, delivered, lambda: None)
            delivered.write_bytes(before[:-1] + bytes([before[-1] ^ 1]))
            with pytest.raises(BadFile, match="changed"):
                require_delivered(source, delivered, lambda: None)
        finally:
            delivered.write_bytes(before)
            os.utime(delivered, ns=(status.st_atime_ns, status.st_mtime_ns))
        with pytest.raises(MissingInput, match="Find delivered files"):
            require_delivered(source, tmp_path / "gone.laz", lambda: None)


def test_a_file_of_the_same_name_that_is_another_one_is_said_to_be_changed(elsewhere):
    points = elsewhere / "納品" / "left.laz"
    points.write_bytes(points.read_bytes() + b"more")
    with closing(Project.open(elsewhere / "street.zuka")) as project:
        assert _found(project) == [("left.laz", FileState.CHANGED)]


def test_reading_a_moved_project_finds_its_files_and_writes_no_byte(elsewhere):
    folder = elsewhere / "street.zuka"
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    with closing(Project.open(folder, writing=False)) as project:
        project.find_sources()
        assert project.drives[0].source_path(project.drives[0].info.sources[0]).is_file()
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before
