"""A run of a project is stored whole or not at all, step by step, and can be taken back."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import Cancelled, InUse, MissingInput, OutOfRange
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Language, Text
from processing.map.feature import Status
from processing.operations.import_files import ImportOperation, import_files
from processing.operations.inputs import OperationInputs, inputs_of_paths
from processing.operations.map_steps import UndoOperation, undo_step
from processing.operations.run import RunOperation, run_operation
from processing.project.importing.import_request import ImportRequest
from processing.project.project import Project
from processing.recording.drive import Drive
from processing.tools.listed.registry import TOOLS
from processing.tools.normals import NormalsParameters
from processing.tools.running.run_shares import run_shares
from processing.tools.tool import Candidate, CandidateResult, Finder
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.monitors import CancelledAfter
from tests.processing.project.candidates import FINDER

CONFIDENCES = (0.2, 0.5, 0.9)


def find_three(drive: Drive, _parameters: NormalsParameters, monitor: Monitor) -> CandidateResult:
    """Three points of a drive, each surer than the last."""
    monitor.check()
    points = np.array([0, 500, 1000])
    return CandidateResult(
        tuple(
            Candidate("sign", "point", drive.xyz(points[n : n + 1]), points[n : n + 1], sure)
            for n, sure in enumerate(CONFIDENCES)
        )
    )


def refuse_the_right(
    drive: Drive, parameters: NormalsParameters, monitor: Monitor
) -> CandidateResult:
    """A tool that lacks something on one of two drives."""
    if drive.info.name == "right":
        raise MissingInput(Text("No.", "いいえ。"), Text.same("here"), Text("Go.", "どうぞ。"))
    return find_three(drive, parameters, monitor)


@pytest.fixture(autouse=True)
def finder(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the program know a tool that finds, and one that stops half-way."""
    monkeypatch.setitem(TOOLS, "finder", replace(FINDER, method=Finder(find_three)))
    monkeypatch.setitem(TOOLS, "half", replace(FINDER, id="half", method=Finder(refuse_the_right)))


@pytest.fixture
def delivered(tmp_path: Path) -> ImportRequest:
    """Two heads of one vehicle."""
    heads = {name: simulated_drive(seed, head=name) for seed, name in ((3, "left"), (4, "right"))}
    clouds = tuple(write_laz(one, tmp_path / f"{name}.laz") for name, one in heads.items())
    return ImportRequest(clouds, (write_trajectory_csv(heads["left"], tmp_path / "way.csv"),))


@pytest.fixture
def folder(delivered: ImportRequest, tmp_path: Path) -> Path:
    """A project with both drives."""
    outcome = import_files(ImportOperation(tmp_path / "p.zuka", delivered), SilentMonitor())
    assert [drive.info.name for drive in outcome.drives] == ["left", "right"]
    return tmp_path / "p.zuka"


@pytest.fixture
def project(folder: Path) -> Iterator[Project]:
    """The project, open for reading."""
    with closing(Project.open(folder, writing=False)) as opened:
        yield opened


def statuses(folder: Path) -> list[Status]:
    with closing(Project.open(folder, writing=False)) as opened:
        return [one.status for one in opened.features.all()]


def test_each_drive_has_a_run_and_each_run_a_step_of_its_own(folder: Path) -> None:
    outcome = run_operation(RunOperation("finder", OperationInputs(folder)), SilentMonitor())
    assert [one.summary.en for one in outcome.stored] == ["Curbs: 3 candidates"] * 2
    assert statuses(folder) == [Status.CANDIDATE] * 6
    for left in (3, 0):
        assert undo_step(UndoOperation(folder), SilentMonitor()).label is not None
        assert len(statuses(folder)) == left
    imported = undo_step(UndoOperation(folder), SilentMonitor())
    assert [one.en for one in imported.words] == ["Undone: Import left, right"]
    assert undo_step(UndoOperation(folder), SilentMonitor()).label is None
    with closing(Project.open(folder, writing=False)) as opened:
        assert len(opened.runs.all()) == 2  # the tool did run


def test_sure_candidates_are_accepted_in_one_step_that_undo_takes_back(folder: Path) -> None:
    asked = RunOperation("finder", OperationInputs(folder), accept_above=0.5)
    outcome = run_operation(asked, SilentMonitor())
    assert outcome.accepted == 4
    assert outcome.words[-1].en == "4 of them accepted"
    assert statuses(folder).count(Status.ACCEPTED) == 4
    with closing(Project.open(folder, writing=False)) as opened:
        unseen = [one.provenance.unseen for one in opened.features.all()]
    assert unseen.count(True) == 4  # what nobody looked at is known after the project is reopened
    undo_step(UndoOperation(folder), SilentMonitor())
    assert statuses(folder) == [Status.CANDIDATE] * 6


@pytest.mark.parametrize(
    ("language", "header"),
    [(None, "id,kind,"), ("en", "Feature ID,Kind,"), ("ja", "地物ID,種別ID,")],
)
def test_a_table_has_headers_in_the_language_that_is_asked_for(
    folder: Path, tmp_path: Path, language: Language | None, header: str
) -> None:
    output = tmp_path / "found.csv"
    asked = RunOperation("finder", OperationInputs(folder), output=output, language=language)
    assert run_operation(asked, SilentMonitor()).paths == (output,)
    assert output.read_text(encoding="utf-8-sig").startswith(header)


def test_a_second_run_replaces_what_nobody_decided_on(folder: Path) -> None:
    asked = RunOperation("finder", OperationInputs(folder), accept_above=0.9)
    run_operation(asked, SilentMonitor())
    again = run_operation(replace(asked, accept_above=None), SilentMonitor())
    assert "2 earlier undecided ones were replaced" in again.stored[0].summary.en
    assert statuses(folder).count(Status.ACCEPTED) == 2
    assert len(statuses(folder)) == 6


def test_a_run_on_one_drive_leaves_the_others_alone(folder: Path, project: Project) -> None:
    right = project.drives[1]
    project.close()
    outcome = run_operation(
        RunOperation("finder", OperationInputs(folder, (right.id,))), SilentMonitor()
    )
    (stored,) = outcome.stored
    assert stored.run is not None
    assert stored.run.drives == (right.id,)


@pytest.mark.parametrize(
    ("tool", "monitor", "error"),
    [("half", SilentMonitor(), MissingInput), ("finder", CancelledAfter(), Cancelled)],
)
def test_a_run_that_fails_on_the_way_leaves_the_project_as_it_was(
    folder: Path, tool: str, monitor: Monitor, error: type[Exception]
) -> None:
    before = {path: path.stat().st_size for path in folder.rglob("*") if path.is_file()}
    with pytest.raises(error):
        run_operation(RunOperation(tool, OperationInputs(folder)), monitor)
    assert statuses(folder) == []
    after = {path: path.stat().st_size for path in folder.rglob("*") if path.is_file()}
    assert set(after) <= set(before)


def test_a_project_that_a_window_has_open_is_not_written(folder: Path) -> None:
    with closing(Project.open(folder)), pytest.raises(InUse):
        run_operation(RunOperation("finder", OperationInputs(folder)), SilentMonitor())


def test_a_drive_that_the_project_lacks_is_refused(folder: Path) -> None:
    with pytest.raises(OutOfRange, match="nobody"):
        run_operation(
            RunOperation("finder", OperationInputs(folder, ("nobody",))), CancelledAfter()
        )


def test_a_project_among_files_is_refused(folder: Path, delivered: ImportRequest) -> None:
    with pytest.raises(MissingInput):
        inputs_of_paths([folder, *delivered.inputs])
    assert inputs_of_paths([folder]).project == folder
    assert inputs_of_paths(delivered.inputs).points == delivered.inputs


@pytest.mark.parametrize("tool", ["ground", "finder", "curbs"])
def test_shares_are_about_every_drive_just_once(project: Project, tool: str) -> None:
    drives, parameters = project.drives, TOOLS[tool].parameters()
    shares = list(run_shares(tool, drives, parameters, SilentMonitor()))
    about = [drive.id for share in shares for drive in share.drives]
    assert sorted(about) == sorted(drive.id for drive in drives)
    assert len(shares) == (2 if tool == "finder" else 1)
    alone = list(run_shares(tool, drives[1:], parameters, SilentMonitor(), beside=drives[:1]))
    assert len(alone) == 1
    assert alone[0].request.drive is drives[1]
