"""Labels of many points: stored, undone and done again by jobs, whatever is done meanwhile."""

from __future__ import annotations

import shutil
import threading
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.document.document import Document
from app.jobs.jobs import JobLane, JobQueue
from processing.core.text import Text
from processing.labels.label_column import labels_of
from processing.map.change import Change
from processing.map.label_change import label_changes
from processing.project.importing.importing import ImportRequest
from processing.project.project import Project
from processing.recording.columns.columns import column_path
from processing.recording.drive import Drive
from processing.tools.noise import NoiseParameters
from tests.app.conftest import WAIT_MS
from tests.builders import write_laz, write_trajectory_csv
from tests.noisy_street import noisy_street
from tests.processing.project.labelled import labelled_project, project_of

ROAD, WALL, SIGN = 11, 6, 65


class LabelSession:
    """An open project, and a gate that holds the jobs of a lane back."""

    def __init__(self, folder: Path, bot: QtBot) -> None:
        self.bot, self.folder = bot, folder
        self.jobs = JobQueue()
        self.document = Document(self.jobs)
        self.reported: list[str] = []
        self.refused: list[str] = []
        self.document.reported.connect(lambda text: self.reported.append(text.en))
        self.document.refused.connect(lambda error: self.refused.append(error.what.en))
        assert self.document.open(folder)
        self.rest()

    @property
    def drive(self) -> Drive:
        return self.document.drives()[0]

    @property
    def labels(self) -> NDArray[np.uint8]:
        return labels_of(self.drive, np.arange(self.drive.count))

    @property
    def step_files(self) -> list[str]:
        steps = self.folder / "label_steps"
        return sorted(file.name for file in steps.rglob("*") if file.is_file())

    def rest(self) -> None:
        self.bot.waitUntil(lambda: not self.jobs.is_busy, timeout=WAIT_MS)

    def paint(self, points: object, code: int) -> None:
        rising = np.asarray(points, np.int64)
        labels = label_changes(self.drive.id, rising, labels_of(self.drive, rising), code)
        assert self.document.apply(Text.same(f"paint {code}"), Change(labels=labels))

    def hold(self, lane: JobLane) -> threading.Event:
        """Nothing of a lane begins until the event is set."""
        gate, is_held = threading.Event(), threading.Event()

        def wait(_monitor: object) -> None:
            is_held.set()
            gate.wait(20)

        self.jobs.start(Text.same("gate"), wait, lane=lane)
        assert is_held.wait(20)
        return gate

    def close(self) -> None:
        self.document.close()
        self.jobs.close()
        self.document.tiles.close()


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return labelled_project(tmp_path_factory.mktemp("street"))


@pytest.fixture
def desk(
    qapp: QApplication,
    street: Path,
    tmp_path: Path,
    qtbot: QtBot,
    monkeypatch: pytest.MonkeyPatch,
) -> Iterator[LabelSession]:
    monkeypatch.setattr("processing.project.store.label_filing.MANY_POINTS", 100)
    monkeypatch.setattr("processing.map.label_change.MOST_POINTS", 300)
    desk = LabelSession(Path(shutil.copytree(street, tmp_path / "街路.zuka")), qtbot)
    yield desk
    desk.close()


def test_many_labels_are_one_step_that_is_taken_back_and_survives_a_restart(
    desk: LabelSession,
) -> None:
    desk.paint(range(50), SIGN)
    painted = desk.labels
    desk.paint(range(20, 2000), ROAD)
    desk.rest()
    many = desk.labels
    assert (many[20:2000] == ROAD).all()
    assert (many[:20] == SIGN).all()
    assert desk.document.undo()
    desk.rest()
    np.testing.assert_array_equal(desk.labels, painted)
    assert desk.document.redo()
    desk.rest()
    np.testing.assert_array_equal(desk.labels, many)
    assert desk.step_files == ["parts.bin"]
    desk.document.close()
    assert desk.document.open(desk.folder)
    np.testing.assert_array_equal(desk.labels, many)
    assert desk.document.undo()
    desk.rest()
    assert desk.document.undo()
    assert not desk.labels.any()
    assert not desk.refused


def test_what_is_painted_while_many_labels_are_stored_stays(desk: LabelSession) -> None:
    gate = desk.hold(JobLane.STEPS)
    desk.paint(range(20, 2000), ROAD)
    desk.paint(range(500, 540), SIGN)
    desk.paint(range(5), WALL)
    assert desk.document.undo_stack.undo_label == Text.same(f"paint {WALL}")
    gate.set()
    desk.rest()
    wanted = np.zeros(desk.drive.count, np.uint8)
    wanted[20:2000], wanted[500:540], wanted[:5] = ROAD, SIGN, WALL
    np.testing.assert_array_equal(desk.labels, wanted)
    assert desk.document.undo()
    desk.rest()
    assert np.flatnonzero(desk.labels).tolist() == [*range(5), *range(500, 540)]
    assert desk.document.undo()
    assert desk.document.undo()
    assert not desk.labels.any()


def test_of_two_that_label_the_same_many_points_the_later_one_counts(desk: LabelSession) -> None:
    gate = desk.hold(JobLane.STEPS)
    desk.paint(range(2000), ROAD)
    desk.paint(range(1000, 3000), WALL)
    gate.set()
    desk.rest()
    assert (desk.labels[:1000] == ROAD).all()
    assert (desk.labels[1000:3000] == WALL).all()
    for _ in range(2):
        assert desk.document.undo()
        desk.rest()
    assert not desk.labels.any()


def test_undo_while_many_labels_are_stored_takes_these_back_and_leaves_nothing(
    desk: LabelSession,
) -> None:
    desk.paint(range(50), SIGN)
    gate = desk.hold(JobLane.STEPS)
    desk.paint(range(20, 2000), ROAD)
    assert desk.document.undo()
    label = desk.document.undo_stack.undo_label
    gate.set()
    desk.rest()
    assert desk.document.undo_stack.undo_label == label == Text.same(f"paint {SIGN}")
    assert (desk.labels > 0).sum() == 50
    assert desk.reported[-1] == f"Taken back: paint {ROAD}"
    assert desk.step_files == []
    assert desk.document.undo()
    assert not desk.labels.any()


def test_undo_after_the_job_has_ended_but_before_its_end_is_heard_takes_it_back_too(
    desk: LabelSession,
) -> None:
    desk.paint(range(20, 2000), ROAD)
    steps = desk.folder / "label_steps"
    until = time.monotonic() + 20
    # The window's thread hears nothing here, so the job's end waits for it.
    while not any(steps.rglob("after-*")) and time.monotonic() < until:
        pass
    assert desk.document.undo()
    desk.rest()
    assert not desk.labels.any()
    assert desk.step_files == []
    label = desk.document.undo_stack.undo_label
    assert label is not None
    assert label.en.startswith("Import")


def test_an_undo_is_given_up_where_something_is_painted_meanwhile(desk: LabelSession) -> None:
    desk.paint(range(20, 2000), ROAD)
    desk.rest()
    gate = desk.hold(JobLane.STEPS)
    assert desk.document.undo()
    assert not desk.document.undo()
    assert desk.reported[-1].startswith("Still at it")
    desk.paint(range(500, 540), SIGN)
    gate.set()
    desk.rest()
    assert desk.reported[-1].startswith("The map was changed meanwhile")
    assert (desk.labels[500:540] == SIGN).all()
    assert (desk.labels[540:2000] == ROAD).all()
    assert desk.step_files == ["parts.bin"]
    assert desk.document.undo()
    assert desk.document.undo()
    desk.rest()
    assert not desk.labels.any()


def test_to_close_the_project_keeps_what_was_painted_on_many_points(desk: LabelSession) -> None:
    gate = desk.hold(JobLane.STEPS)
    desk.paint(range(20, 2000), ROAD)
    desk.paint(range(500, 540), SIGN)
    desk.document.close()
    gate.set()
    desk.rest()
    assert desk.document.open(desk.folder)
    assert (desk.labels[500:540] == SIGN).all()
    assert (desk.labels[20:500] == ROAD).all()
    assert desk.step_files == []
    assert desk.document.undo()
    assert desk.document.undo()
    assert not desk.labels.any()


def test_labels_that_another_program_changed_are_not_taken_back(desk: LabelSession) -> None:
    desk.paint(range(20, 2000), ROAD)
    desk.rest()
    path = column_path(desk.drive.folder, "label")
    with path.open("rb+") as file:
        file.seek(700)
        file.write(bytes([SIGN]))
    assert desk.document.undo()
    desk.rest()
    assert desk.refused == [
        "A file of the project is not what Zuka wrote: the disk, or a copy, changed it."
    ]
    labels = path.read_bytes()
    assert (labels[700], labels[20]) == (SIGN, ROAD)


@pytest.mark.parametrize("is_undone", [False, True])
def test_a_program_killed_before_the_column_took_its_place_lets_the_next_one_do_it(
    desk: LabelSession, is_undone: bool
) -> None:
    desk.paint(range(50), SIGN)
    before = desk.labels
    desk.paint(range(20, 2000), ROAD)
    desk.rest()
    after = desk.labels
    if is_undone:
        assert desk.document.undo()
        desk.rest()
        before, after = after, before
    desk.document.close()
    # As it was when the database had the step, and the drive had not.
    (step,) = (desk.folder / "label_steps").iterdir()
    (drive,) = (desk.folder / "drives").iterdir()
    staged = step / f"{'before' if is_undone else 'after'}-{drive.name}.bin"
    column_path(drive, "label").replace(staged)
    column_path(drive, "label").write_bytes(before.tobytes())
    (step / f"{'after' if is_undone else 'before'}-{drive.name}.bin").write_bytes(b"half")
    (desk.folder / "label_steps" / "left").mkdir()
    with closing(Project.open(desk.folder, writing=False)) as project:
        (seen,) = project.drives
        np.testing.assert_array_equal(labels_of(seen, np.arange(seen.count)), after)
    assert staged.is_file()
    assert desk.document.open(desk.folder)
    np.testing.assert_array_equal(desk.labels, after)
    assert desk.step_files == ["parts.bin"]
    assert len(list((desk.folder / "label_steps").iterdir())) == 1


def test_a_damaged_file_of_labels_is_told_and_nothing_is_taken_back(desk: LabelSession) -> None:
    desk.paint(range(20, 2000), ROAD)
    desk.rest()
    (parts,) = (desk.folder / "label_steps").rglob("parts.bin")
    parts.write_bytes(parts.read_bytes()[:-3])
    labels = desk.labels
    assert desk.document.undo()
    desk.rest()
    assert desk.refused == ["The labels of this step are damaged."]
    np.testing.assert_array_equal(desk.labels, labels)


def test_a_run_leaves_points_to_who_painted_them_while_it_was_stored(
    qapp: QApplication, tmp_path: Path, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("processing.project.store.label_filing.MANY_POINTS", 10)
    scene = noisy_street(7, length_m=5.0)
    cloud = write_laz(scene.drive, tmp_path / "左.laz")
    way = write_trajectory_csv(scene.drive, tmp_path / "軌跡.csv")
    desk = LabelSession(project_of(tmp_path / "p.zuka", ImportRequest((cloud,), (way,))), qtbot)
    with closing(desk):
        asked = desk.hold(JobLane.ASKED)
        desk.document.start_run("noise", desk.drive.id, NoiseParameters(method="radius"))
        asked.set()
        desk.rest()
        first = desk.labels
        assert (first > 0).sum() > 10
        gate = desk.hold(JobLane.STEPS)
        desk.document.start_run("noise", desk.drive.id, NoiseParameters())
        noise = np.flatnonzero(first > 0)[:5]
        desk.paint(noise, SIGN)
        gate.set()
        desk.rest()
        assert (desk.labels[noise] == SIGN).all()
        assert "points classified" in desk.reported[-1]
        # Whatever came first, both steps are taken back one by one.
        for _ in range(2):
            assert desk.document.undo()
            desk.rest()
        np.testing.assert_array_equal(desk.labels, first)
        assert [run.tool for run in desk.document.runs()] == ["noise", "noise"]
        assert not desk.refused
