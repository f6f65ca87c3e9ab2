"""Recordings become part of a project whole, or not at all."""

from __future__ import annotations

import dataclasses
import shutil
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import BadFile, MissingInput, NoSpace, OutOfRange
from processing.core.monitor import SilentMonitor
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.project import Project
from processing.project.store.reading_connection import connect
from processing.recording.drive import Drive
from processing.recording.drive_info import read_drive_info, write_drive_info
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.processing.project.drawn import new_project, tree_of


@pytest.fixture(scope="module")
def imported(tmp_path_factory) -> Path:
    """A drive folder as an import leaves it, and the delivered files it came from."""
    folder = tmp_path_factory.mktemp("delivery")
    simulated = simulated_drive(length_m=3.0)
    request = ImportRequest(
        (write_laz(simulated, folder / "left.laz"),),
        (write_trajectory_csv(simulated, folder / "trajectory.csv"),),
    )
    (drive,) = import_drives(request, folder / "into", SilentMonitor())
    return drive


def finished_import(project: Project, imported: Path, id_: str = "left-1", crs: str = "EPSG:6677"):
    """A copy of the imported drive in a temporary folder of the project."""
    folder = project.temporary_folder() / id_
    shutil.copytree(imported, folder)
    info = dataclasses.replace(read_drive_info(folder), id=id_, crs=crs)
    write_drive_info(folder, info)
    return folder


def test_an_adopted_drive_is_there_after_a_restart_with_its_system_and_origin(tmp_path, imported):
    with closing(Project.create(tmp_path / "a.zuka", "")) as project:
        assert project.crs == ""
        assert project.origin.tolist() == [0.0, 0.0, 0.0]
        drive = project.adopt_drive(finished_import(project, imported))
        assert drive.folder == project.folder / "drives" / "left-1"
        assert project.crs == "EPSG:6677"
        origin = project.origin
    middle = drive.xyz(slice(None)).mean(axis=0)
    assert np.all(np.abs(origin - middle) < 100.0)
    assert np.all(origin % 100.0 == 0.0)
    assert not any((tmp_path / "a.zuka" / "tmp").iterdir())
    with closing(Project.open(tmp_path / "a.zuka")) as project:
        assert [one.id for one in project.drives] == ["left-1"]
        assert project.drive("left-1").count == drive.count
        assert project.crs == "EPSG:6677"
        assert project.origin.tolist() == origin.tolist()
        second = project.adopt_drive(finished_import(project, imported, "right-2", ""))
        assert [one.id for one in project.drives] == ["left-1", second.id]
        assert project.origin.tolist() == origin.tolist()


def test_of_two_drives_in_two_systems_none_is_adopted(tmp_path, imported):
    with closing(Project.create(tmp_path / "a.zuka", "")) as project:
        folders = (
            finished_import(project, imported, "left-1", "EPSG:6677"),
            finished_import(project, imported, "right-2", "EPSG:6676"),
        )
        before = tree_of(project.folder)
        with pytest.raises(OutOfRange, match="EPSG:6676"):
            project.adopt_drives(folders)
        assert tree_of(project.folder) == before
        assert project.drives == ()
        assert project.crs == ""
        assert project.adopt_drives(()) == ()


def test_when_the_second_drive_cannot_be_moved_the_first_goes_back(tmp_path, imported):
    with closing(Project.create(tmp_path / "a.zuka", "")) as project:
        folders = (
            finished_import(project, imported, "left-1"),
            finished_import(project, imported, "right-2"),
        )
        # Where the drives go there is a file of somebody's.
        (project.folder / "drives").write_text("a note")
        with pytest.raises((BadFile, NoSpace)):
            project.adopt_drives(folders)
        assert project.drives == ()
        (project.folder / "drives").unlink()
        assert [one.id for one in project.adopt_drives(folders)] == ["left-1", "right-2"]


def test_a_drive_in_another_system_than_the_project_is_refused(tmp_path, imported):
    with closing(Project.create(tmp_path / "a.zuka", "EPSG:6676")) as project:
        folder = finished_import(project, imported)
        with pytest.raises(OutOfRange):
            project.adopt_drive(folder)
        assert Drive(folder).count > 0


def test_a_drive_is_adopted_once(tmp_path, imported):
    with closing(Project.create(tmp_path / "a.zuka", "")) as project:
        project.adopt_drive(finished_import(project, imported))
        with pytest.raises(ValueError, match="left-1"):
            project.adopt_drive(finished_import(project, imported))


@pytest.mark.parametrize("moved", [0, 1, 2])
def test_what_a_killed_adoption_left_is_removed_and_nothing_else(tmp_path, imported, moved):
    folder = new_project(tmp_path / "a.zuka")
    with closing(Project.open(folder)) as project:
        project.adopt_drive(finished_import(project, imported, "first-0"))
        ids = ["left-1", "right-2"]
        arrived = [finished_import(project, imported, id_) for id_ in ids]
    # What the disk holds when the program is killed after so many moves.
    with closing(connect(folder / "project.gpkg", "rw")) as connection:
        connection.execute(
            "INSERT OR REPLACE INTO zuka_settings VALUES ('arriving_drives', ?)",
            ('["left-1","right-2","../../other"]',),
        )
    for path, id_ in list(zip(arrived, ids, strict=True))[:moved]:
        path.rename(folder / "drives" / id_)
    (tmp_path / "other").mkdir()
    somebodys = folder / "drives" / "backup of mine"
    somebodys.mkdir()
    before = tree_of(folder)
    with closing(Project.open(folder, writing=False)) as project:
        assert [one.id for one in project.drives] == ["first-0"]
    assert tree_of(folder) == before
    with closing(Project.open(folder)) as project:
        assert [one.id for one in project.drives] == ["first-0"]
        project.adopt_drive(finished_import(project, imported, "left-1"))
    left = sorted(one.name for one in (folder / "drives").iterdir())
    assert left == ["backup of mine", "first-0", "left-1"]
    assert (tmp_path / "other").is_dir()


def test_an_emptied_database_is_refused_and_the_drives_stay(tmp_path, imported):
    folder = new_project(tmp_path / "a.zuka")
    with closing(Project.open(folder)) as project:
        project.adopt_drive(finished_import(project, imported))
    (folder / "project.gpkg").write_bytes(b"")
    before = tree_of(folder)
    with pytest.raises(BadFile):
        Project.open(folder)
    assert tree_of(folder) == before


@pytest.mark.parametrize("damage", ["missing", "no description", "cut description", "no points"])
def test_a_damaged_drive_is_named_and_left_as_it_was(tmp_path, imported, damage):
    folder = new_project(tmp_path / "a.zuka")
    with closing(Project.open(folder)) as project:
        drive = project.adopt_drive(finished_import(project, imported)).folder
    match damage:
        case "missing":
            shutil.rmtree(drive)
        case "no description":
            (drive / "drive.json").unlink()
        case "cut description":
            (drive / "drive.json").write_text((drive / "drive.json").read_text()[:99])
        case "no points":
            (drive / "xyz.bin").unlink()
    before = tree_of(folder)
    for writing in (True, False):
        with closing(Project.open(folder, writing=writing)) as project:
            (error,) = project.damaged_drives.values()
            assert isinstance(error, BadFile | MissingInput)
            assert "left-1" in error.where.en
    assert tree_of(folder) == before


def test_missing_delivered_files_are_only_noted(tmp_path, imported):
    with closing(Project.create(tmp_path / "a.zuka", "")) as project:
        drive = project.adopt_drive(finished_import(project, imported))
        source = drive.info.sources[0]
        moved = dataclasses.replace(source, path=str(tmp_path / "gone.laz"))
        write_drive_info(drive.folder, dataclasses.replace(drive.info, sources=(moved,)))
    with closing(Project.open(tmp_path / "a.zuka")) as project:
        (trouble,) = project.sources.survey(project.drives).look(lambda: None).troubles
        assert trouble.path.name == "gone.laz"
        assert trouble.drives == (drive.id,)


def test_a_system_that_the_drives_are_not_in_is_refused(tmp_path, imported):
    with closing(Project.create(tmp_path / "a.zuka", "")) as project:
        project.set_crs("6677")
        project.adopt_drive(finished_import(project, imported))
        project.set_crs("epsg:6677")
        with pytest.raises(OutOfRange):
            project.set_crs("EPSG:6678")
        with pytest.raises(OutOfRange, match="metres"):
            project.set_crs("EPSG:4326")
        assert project.crs == "EPSG:6677"
