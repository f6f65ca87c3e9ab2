"""Find all: each tool's result is its own, and what one can't do stops no other."""

from __future__ import annotations

import json
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.cli.terminal import run_in_terminal
from processing.core.errors import MissingInput, OutOfRange, Unsuitable
from processing.core.monitor import Monitor, SilentMonitor
from processing.map.feature import Status
from processing.operations.extraction import ExtractOperation, Extractor, extract
from processing.operations.import_files import ImportOperation, import_files
from processing.operations.inputs import OperationInputs
from processing.operations.operation_files import read_operation, write_operation
from processing.project.importing.import_request import ImportRequest
from processing.project.project import Project
from processing.recording.drive import Drive
from processing.tools.listed.registry import TOOLS, extractors
from processing.tools.normals import NormalsParameters
from processing.tools.tool import Candidate, CandidateResult, Finder, Needs
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.processing.project.candidates import FINDER


def find_one(drive: Drive, _parameters: NormalsParameters, monitor: Monitor) -> CandidateResult:
    """One sign on the first point."""
    monitor.check()
    first = np.array([0])
    return CandidateResult((Candidate("sign", "point", drive.xyz(first), first, 0.9),))


@pytest.fixture(autouse=True)
def two_tools(monkeypatch: pytest.MonkeyPatch) -> None:
    """A program with two extractors, the second of which needs images."""
    button = TOOLS["gutters"].button
    for tool in extractors():
        monkeypatch.delitem(TOOLS, tool)
    plain = replace(FINDER, id="plain", method=Finder(find_one), button=button, makes=("sign",))
    monkeypatch.setitem(TOOLS, "plain", plain)
    monkeypatch.setitem(TOOLS, "by-image", replace(plain, id="by-image", needs=Needs.IMAGES))


@pytest.fixture
def delivered(tmp_path: Path) -> ImportRequest:
    drive = simulated_drive(3)
    cloud = write_laz(drive, tmp_path / "left.laz")
    return ImportRequest((cloud,), (write_trajectory_csv(drive, tmp_path / "way.csv"),))


@pytest.fixture
def folder(delivered: ImportRequest, tmp_path: Path) -> Path:
    import_files(ImportOperation(tmp_path / "p.zuka", delivered), SilentMonitor())
    return tmp_path / "p.zuka"


def test_a_project_has_a_run_of_each_tool_that_could_run(folder: Path) -> None:
    operation = ExtractOperation(OperationInputs(folder), accept_above=0.8)
    outcome = extract(operation, SilentMonitor())
    assert list(outcome.done) == ["plain"]
    assert isinstance(outcome.refused["by-image"], Unsuitable)
    assert not outcome.has_failed
    with closing(Project.open(folder)) as project:
        (feature,) = project.features.all()
        assert feature.provenance.tool == "plain"
        assert feature.status is Status.ACCEPTED


def test_nothing_that_can_run_is_said_by_the_first_refusal(folder: Path) -> None:
    with pytest.raises(Unsuitable, match="images"):
        extract(
            ExtractOperation(OperationInputs(folder), (Extractor("by-image"),)), SilentMonitor()
        )


def test_files_get_a_file_of_each_tool(
    delivered: ImportRequest, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "結果" / "found"
    words = [str(delivered.inputs[0]), "--trajectory", str(delivered.trajectories[0])]
    assert run_in_terminal(["extract", *words, "--out", str(out)]) == 0
    assert [path.name for path in out.iterdir()] == ["plain.geojson"]
    assert len(json.loads((out / "plain.geojson").read_text("utf-8"))["features"]) == 1
    said = capsys.readouterr()
    assert said.out.strip().endswith("plain.geojson")
    assert said.err.count("camera images") == 1 or said.err.count("カメラ画像") == 1


def test_what_cannot_come_to_a_good_end_is_refused_first(folder: Path, tmp_path: Path) -> None:
    inputs = OperationInputs(folder)
    with pytest.raises(OutOfRange, match="finds no things"):
        ExtractOperation(inputs, (Extractor("noise"),)).check()
    with pytest.raises(OutOfRange, match="no such tool"):
        ExtractOperation(inputs, (Extractor("kerbs"),)).check()
    with pytest.raises(MissingInput):
        ExtractOperation(OperationInputs()).check()
    (tmp_path / "file").touch()
    with pytest.raises(OutOfRange, match="folder"):
        ExtractOperation(inputs, output=tmp_path / "file").check()
    assert run_in_terminal(["extract", str(folder), "--set", "kerbs.lowest_m=0.1"]) == 2


def test_it_can_be_written_down(folder: Path, tmp_path: Path) -> None:
    operation = ExtractOperation(
        OperationInputs(folder), (Extractor("plain"), Extractor("by-image")), accept_above=0.5
    )
    write_operation(tmp_path / "all.toml", operation)
    assert read_operation(tmp_path / "all.toml") == operation
