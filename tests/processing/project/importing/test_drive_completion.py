"""A drive that is in the project gets its trajectory later; what was drawn and labelled stays."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest

from processing.core.errors import OutOfRange
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.labels.label_column import labels_of
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, PointReference, Vertex
from processing.map.label_change import label_changes
from processing.project.importing.drive_completion import carry_results_again, complete_drive
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.importing.trajectory_choice import read_trajectories
from processing.project.project import Project
from processing.project.results.run_findings import finding_path, read_finding
from processing.recording.drive import Drive
from processing.recording.drive_info import read_drive_info
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.processing.project.cells import order_by_cells

LABEL = Text.same("x")


@pytest.fixture(scope="module")
def delivery(tmp_path_factory) -> ImportRequest:
    folder = tmp_path_factory.mktemp("delivery")
    simulated = simulated_drive(length_m=4.0)
    return ImportRequest(
        (write_laz(simulated, folder / "通り.laz"),),
        (write_trajectory_csv(simulated, folder / "trajectory.csv"),),
        crs="EPSG:6677",
    )


@pytest.fixture(scope="module")
def with_trajectory(delivery, tmp_path_factory) -> Drive:
    """What an import with the trajectory gives."""
    (folder,) = import_drives(delivery, tmp_path_factory.mktemp("with"), SilentMonitor())
    return Drive(folder)


@pytest.fixture(params=["rows", "top view"])
def project(request, delivery, tmp_path) -> Iterator[Project]:
    """A project with the drive, imported without its trajectory: with rows of its own or none."""
    inputs = delivery.inputs
    with closing(Project.create(tmp_path / "a.zuka", "")) as project:
        asked = replace(delivery, inputs=inputs, trajectories=())
        folders = import_drives(asked, project.temporary_folder(), SilentMonitor())
        if request.param == "top view":
            order_by_cells(folders[0])
        project.adopt_drives(folders)
        yield project


def _completed(project: Project, delivery: ImportRequest):
    drive = project.drives[0]
    ways = read_trajectories(delivery.trajectories, "EPSG:6677")
    return complete_drive(drive, ways, project.temporary_folder(), SilentMonitor())


def _line_on(drive: Drive, points: list[int]) -> Feature:
    vertices = tuple(
        Vertex(tuple(drive.xyz(np.array([point]))[0].tolist()), PointReference(drive.id, point))
        for point in points
    )
    return Feature("line", "curb", Geometry.LINE, vertices)


def test_rows_and_pulses_are_those_of_an_import_with_the_trajectory(
    project, delivery, with_trajectory
):
    before = project.drives[0]
    (drive,) = project.take_in((), [_completed(project, delivery)])
    assert drive.id == before.id
    assert drive.info.name == "通り"
    assert drive.info.rows_by == "trajectory"
    for name in ("xyz", "time", "pulse", "intensity", "classification"):
        assert (drive.columns[name] == with_trajectory.columns[name]).all(), name
    assert drive.revolutions is not None
    assert with_trajectory.revolutions is not None
    assert (drive.revolutions.fold_pulses == with_trajectory.revolutions.fold_pulses).all()
    assert (drive.trajectory.xyz == with_trajectory.trajectory.xyz).all()
    ours, theirs = drive.sources(0, drive.count), with_trajectory.sources(0, drive.count)
    assert (ours[0] == theirs[0]).all()
    assert (ours[1] == theirs[1]).all()
    assert drive.info.sources == with_trajectory.info.sources


def test_what_was_drawn_and_labelled_stays_on_its_points(project, delivery):
    drive = project.drives[0]
    line = _line_on(drive, [7, 4000, drive.count - 3])
    points = np.arange(100, 900)
    labels = label_changes(drive.id, points, np.zeros(800, np.uint8), 5)
    project.features.apply(LABEL, Change(added=(line,), labels=labels))
    labelled = {tuple(one) for one in drive.columns["xyz"][points].tolist()}
    said = np.arange(drive.count) % 3 == 0
    path = finding_path(drive, "noise", "r1")
    path.parent.mkdir(parents=True)
    path.write_bytes(np.packbits(said).tobytes())
    noted = {tuple(one) for one in drive.columns["xyz"][said].tolist()}
    truth = drive.folder / "truths" / "t" / "truth.bin"
    truth.parent.mkdir(parents=True)
    (drive.columns["intensity"] % 7).astype("u1").tofile(truth)

    (completed,) = project.take_in((), [_completed(project, delivery)])
    feature = project.features.get("line")
    assert feature is not None
    for vertex in feature.vertices:
        assert vertex.measured is not None
        there = completed.xyz(np.array([vertex.measured.point]))[0]
        assert there.tolist() == list(vertex.xyz)
    codes = labels_of(completed, np.arange(completed.count))
    assert (codes > 0).sum() == 800
    assert {tuple(one) for one in completed.columns["xyz"][codes == 5].tolist()} == labelled
    found = read_finding(completed, "noise", "r1", 0, completed.count)
    assert {tuple(one) for one in completed.columns["xyz"][found].tolist()} == noted
    truths = np.fromfile(completed.folder / "truths" / "t" / "truth.bin", "u1")
    assert (truths == completed.columns["intensity"] % 7).all()

    folder = project.folder
    project.close()
    with closing(Project.open(folder)) as again:
        assert again.features.get("line") == feature
        assert (labels_of(again.drives[0], np.arange(completed.count)) == codes).all()
        assert len(list((folder / "drives").iterdir())) == 1


def test_a_completion_is_taken_back_and_done_again_among_other_steps(project, delivery):
    before = project.drives[0]
    was, line = before.info, _line_on(before, [7, 4000])
    project.features.apply(LABEL, Change(added=(line,)))
    labels = label_changes(before.id, np.arange(50), np.zeros(50, np.uint8), 5)
    project.features.apply(LABEL, Change(labels=labels))
    (drive,) = project.take_in((), [_completed(project, delivery)])
    moved = project.features.get("line")
    project.features.apply(LABEL, Change(added=(replace(_line_on(drive, [9, 10]), id="later"),)))
    for _ in range(2):
        assert project.features.undo() is not None
        assert project.history.undo_label == Text("Add to 通り", "通り への追加")
        assert project.features.undo() is not None
        (drive,) = project.drives
        assert drive.info == was
        assert project.features.get("line") == line
        assert (labels_of(drive, np.arange(50)) == 5).all()
        # What was done on the points as they were is taken back and done again.
        assert project.features.undo() is not None
        assert not labels_of(drive, np.arange(50)).any()
        for _ in range(3):
            assert project.features.redo() is not None
        (drive,) = project.drives
        assert drive.info.rows_by == "trajectory"
        assert project.features.get("line") == moved
        assert project.features.get("later") is not None
        assert (labels_of(drive, np.arange(drive.count)) == 5).sum() == 50


@pytest.mark.parametrize("is_undone", [False, True])
@pytest.mark.parametrize("is_killed", [False, True])
def test_a_completion_outlives_the_closed_project(project, delivery, is_undone, is_killed):
    folder = project.folder
    project.features.apply(LABEL, Change(added=(_line_on(project.drives[0], [7, 4000]),)))
    was, line = project.drives[0].info, project.features.get("line")
    (drive,) = project.take_in((), [_completed(project, delivery)])
    info, moved = drive.info, project.features.get("line")
    if is_undone:
        project.features.undo()
    if is_killed:
        copy = folder.with_name("killed.zuka")
        shutil.copytree(folder, copy, ignore=shutil.ignore_patterns("lock*"))
        folder = copy
    else:
        project.close()
    with closing(Project.open(folder)) as again:
        assert again.drives[0].info == (was if is_undone else info)
        assert again.features.get("line") == (line if is_undone else moved)
        if not is_undone:
            # The folder that the drive had is gone, and with it what was done on its points.
            assert not again.history.can_undo
            assert [one.name for one in (folder / "drives").iterdir()] == [f"{drive.id}.2"]
            return
        assert again.features.redo() is not None
        assert again.drives[0].info == info
        assert again.features.get("line") == moved


def test_labels_that_were_set_meanwhile_are_not_lost(project, delivery):
    drive = project.drives[0]
    completed = _completed(project, delivery)
    labels = label_changes(drive.id, np.arange(50), np.zeros(50, np.uint8), 5)
    project.features.apply(LABEL, Change(labels=labels))
    with pytest.raises(OutOfRange, match="changed"):
        project.take_in((), [completed])
    again = carry_results_again(completed, drive, SilentMonitor())
    (drive,) = project.take_in((), [again])
    assert (labels_of(drive, np.arange(drive.count)) == 5).sum() == 50


def test_a_trajectory_of_another_day_is_refused_and_nothing_changes(project, delivery, tmp_path):
    other = simulated_drive(length_m=4.0, start_time_s=405_000.0)
    path = write_trajectory_csv(other, tmp_path / "other.csv")
    into = project.temporary_folder()
    with pytest.raises(OutOfRange, match="outside"):
        complete_drive(
            project.drives[0], read_trajectories((path,), "EPSG:6677"), into, SilentMonitor()
        )
    assert not into.exists()


@pytest.mark.parametrize("project", ["top view"], indirect=True)
def test_a_kill_before_the_drive_is_taken_over_leaves_it_as_it_was(project, delivery):
    folder, drive = project.folder, project.drives[0]
    completed = _completed(project, delivery)
    copy = folder.with_name("killed.zuka")
    moving = project._folders.moving_in({}, {drive.id: completed.folder})
    moving.__enter__()
    # As a kill leaves it: the folder is moved in, and the database knows nothing of it.
    shutil.copytree(folder, copy, ignore=shutil.ignore_patterns("lock*"))
    assert moving.__exit__(RuntimeError, RuntimeError(), None) is False
    with closing(Project.open(copy)) as again:
        assert again.drives[0].info == drive.info
        assert [one.name for one in (copy / "drives").iterdir()] == [drive.id]
    assert read_drive_info(completed.folder).rows_by == "trajectory"
