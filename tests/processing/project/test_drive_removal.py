"""A drive is removed from its project as one step; its files go when undo can't want them."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.labels.label_column import labels_of
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, PointReference, Provenance, Status, Vertex
from processing.map.label_change import label_changes
from processing.project.drive_removal import removal_of
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.project import Project
from processing.project.store.runs import Run
from tests.builders import simulated_drive, write_laz

LABEL = Text.same("x")


@pytest.fixture(scope="module")
def streets(tmp_path_factory) -> ImportRequest:
    """Two drives of two days."""
    folder = tmp_path_factory.mktemp("delivery")
    days = [simulated_drive(length_m=3.0, start_time_s=at) for at in (105_000.0, 405_000.0)]
    files = [write_laz(day, folder / f"day{number}.laz") for number, day in enumerate(days)]
    return ImportRequest(tuple(files))


@pytest.fixture
def project(streets, tmp_path) -> Iterator[Project]:
    with closing(Project.create(tmp_path / "a.zuka", "EPSG:6677")) as project:
        folders = import_drives(streets, project.temporary_folder(), SilentMonitor())
        project.adopt_drives(folders)
        assert len(project.drives) == 2
        yield project


def _line(id_: str, *drives: str, status=Status.ACCEPTED, run="") -> Feature:
    rests = [PointReference(drive, 3) for drive in drives] or [None]
    positions = [Vertex((1.0 + at, 2.0, 3.0), rest) for at, rest in enumerate((*rests, None))]
    made_by = Provenance("curbs", 1, confidence=0.5, run=run)
    return Feature(id_, "curb", Geometry.LINE, tuple(positions), status=status, provenance=made_by)


def _remove(project: Project, number: int) -> None:
    project.features.apply(LABEL, removal_of(project, (project.drives[number],)))


def test_a_drive_goes_with_its_candidates_and_what_was_drawn_stays(project):
    first, second = (drive.id for drive in project.drives)
    waits = Status.CANDIDATE
    now = datetime.now(UTC)
    run = Run("r1", "wires", 1, {}, (first,), now, now, LABEL)
    drawn = (
        _line("by hand", first),
        _line("accepted", first, run="r1"),
        _line("waiting", first, status=waits, run="r1"),
        _line("on no point", status=waits, run="r1"),
        _line("of both", first, second, status=waits, run="r1"),
        _line("of the other", second, status=waits),
    )
    project.features.apply(LABEL, Change(added=drawn), run=run)
    _remove(project, 0)
    assert [drive.id for drive in project.drives] == [second]
    assert {one.id for one in project.features.all()} == {
        "by hand", "accepted", "of both", "of the other",
    }  # fmt: skip
    assert project.features.get("by hand") == drawn[0]
    assert project.features.undo() is not None
    assert [drive.id for drive in project.drives] == [first, second]
    assert {one.id for one in project.features.all()} == {one.id for one in drawn}
    assert project.features.redo() is not None
    assert [drive.id for drive in project.drives] == [second]


def test_after_undo_its_points_and_labels_are_as_they_were(project):
    drive = project.drives[0]
    labels = label_changes(drive.id, np.arange(50), np.zeros(50, np.uint8), 5)
    project.features.apply(LABEL, Change(labels=labels))
    _remove(project, 0)
    project.features.undo()
    again = project.drives[0]
    assert (labels_of(again, np.arange(50)) == 5).all()
    assert project.features.undo() is not None
    assert (labels_of(project.drives[0], np.arange(50)) == 0).all()


def test_closed_the_project_is_rid_of_its_files_and_undo_stops_there(project):
    folder, first = project.folder, project.drives[0].id
    project.features.apply(LABEL, Change(added=(_line("before", first),)))
    _remove(project, 0)
    project.features.apply(LABEL, Change(added=(_line("after", first),)))
    assert (folder / "drives" / first).is_dir()
    project.close()
    assert not (folder / "drives" / first).exists()
    with closing(Project.open(folder)) as again:
        assert len(again.drives) == 1
        assert again.features.undo() is not None
        assert again.features.get("after") is None
        assert not again.history.can_undo
        assert again.features.undo() is None
        assert again.features.get("before") is not None
        assert again.features.redo() is not None


def test_a_removal_that_was_undone_leaves_the_files_when_the_project_is_closed(project):
    folder, ids = project.folder, [drive.id for drive in project.drives]
    _remove(project, 0)
    project.features.undo()
    project.close()
    with closing(Project.open(folder)) as again:
        assert [drive.id for drive in again.drives] == ids
        assert again.features.redo() is not None
        assert [drive.id for drive in again.drives] == ids[1:]
        assert again.features.undo() is not None


@pytest.mark.parametrize("is_undone", [False, True])
def test_a_kill_leaves_the_drive_in_or_out(project, is_undone):
    folder, ids = project.folder, [drive.id for drive in project.drives]
    _remove(project, 0)
    if is_undone:
        project.features.undo()
    copy = folder.with_name("killed.zuka")
    shutil.copytree(folder, copy, ignore=shutil.ignore_patterns("lock*"))
    with closing(Project.open(copy, writing=False)) as reading:
        assert [drive.id for drive in reading.drives] == (ids if is_undone else ids[1:])
    with closing(Project.open(copy)) as again:
        assert [drive.id for drive in again.drives] == (ids if is_undone else ids[1:])
        assert sorted(one.name for one in (copy / "drives").iterdir()) == sorted(
            ids if is_undone else ids[1:]
        )


def test_a_removed_drive_can_be_imported_again_before_the_project_is_closed(project, streets):
    first, second = (one.id for one in project.drives)
    _remove(project, 0)
    asked = replace(streets, inputs=streets.inputs[:1])
    folders = import_drives(
        asked, project.temporary_folder(), SilentMonitor(), taken=project.taken_ids
    )
    (drive,) = project.adopt_drives(folders)
    assert drive.id != first
    assert project.features.undo() is not None
    assert len(project.drives) == 1
    assert project.features.undo() is not None
    assert len(project.drives) == 2
    assert project.features.redo() is not None
    assert project.features.redo() is not None
    assert [one.id for one in project.drives] == [second, drive.id]
    folder: Path = project.folder
    project.close()
    with closing(Project.open(folder)) as again:
        assert len(again.drives) == 2
