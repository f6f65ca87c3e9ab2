"""Tools that find candidates: run in the background, or by the command line."""

from __future__ import annotations

import json
from argparse import Namespace
from collections.abc import Iterator
from dataclasses import replace
from io import StringIO
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.cli.run import command
from app.document.document import Document
from app.jobs.jobs import JobQueue
from processing.core.errors import MissingInput, OutOfRange
from processing.core.monitor import Monitor, TerminalMonitor
from processing.core.text import Text
from processing.map.feature import PointReference, Status
from processing.project.importing.importing import ImportRequest
from processing.project.project import Project
from processing.recording.drive import Drive
from processing.tools.listed.registry import TOOLS
from processing.tools.normals import NormalsParameters
from processing.tools.tool import Candidate, CandidateResult, Finder, SurveyFinder
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.processing.project.candidates import FINDER

WAIT_MS = 30_000


def find_every_thousandth(
    drive: Drive, parameters: NormalsParameters, monitor: Monitor
) -> CandidateResult:
    """Every thousandth point, more certain along the drive."""
    monitor.check()
    points = np.arange(0, drive.count, 1000)
    return CandidateResult(
        tuple(
            Candidate(
                "sign",
                "point",
                drive.xyz(points[n : n + 1]),
                points[n : n + 1],
                n / len(points),
                {"size_m": parameters.radius_m},
            )
            for n in range(len(points))
        )
    )


def refuse(_drive: Drive, _parameters: object, _monitor: Monitor) -> CandidateResult:
    """A tool that lacks something."""
    raise MissingInput(Text("No.", "いいえ。"), Text.same("here"), Text("Go.", "どうぞ。"))


def find_in_all(
    drives: tuple[Drive, ...], _parameters: object, _monitor: Monitor
) -> CandidateResult:
    """One line from the first drive to the last, and what is drawn from it."""
    xyz = np.concatenate([drive.xyz(slice(0, 1)) for drive in drives] * 2)
    xyz[-1] += 1.0
    numbers = np.tile(np.arange(len(drives)), 2)
    line = Candidate("curb_upper", "line", xyz, np.zeros(len(xyz), np.int64), 0.9, drives=numbers)
    return CandidateResult(
        (line, replace(line, kind="gutter_covered", is_drawing=True)),
        Text("Only one line was seen.", "1本の線しか計測されていません。"),
    )


@pytest.fixture(autouse=True)
def finder(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the program know a tool that finds, and one that refuses."""
    monkeypatch.setitem(TOOLS, "finder", replace(FINDER, method=Finder(find_every_thousandth)))
    together = replace(FINDER, id="together", method=SurveyFinder(find_in_all))
    monkeypatch.setitem(TOOLS, "together", together)
    monkeypatch.setitem(TOOLS, "refuser", replace(FINDER, id="refuser", method=Finder(refuse)))


@pytest.fixture
def delivery(tmp_path: Path) -> ImportRequest:
    drive = simulated_drive(3)
    cloud = write_laz(drive, tmp_path / "左.laz")
    return ImportRequest((cloud,), (write_trajectory_csv(drive, tmp_path / "軌跡.csv"),))


@pytest.fixture
def document(qapp: QApplication) -> Iterator[Document]:
    jobs = JobQueue()
    document = Document(jobs)
    yield document
    jobs.close()
    document.close()
    document.tiles.close()


@pytest.fixture
def street(document: Document, delivery: ImportRequest, tmp_path: Path, qtbot: QtBot) -> Document:
    with qtbot.waitSignal(document.shared.map_changes.drives_changed, timeout=WAIT_MS):
        document.create(tmp_path / "p.zuka", "EPSG:6677")
    with qtbot.waitSignal(document.shared.map_changes.drives_changed, timeout=WAIT_MS):
        document.import_files(delivery)
    return document


def test_a_run_in_the_background_puts_its_candidates_on_the_map_in_one_step(
    street: Document, qtbot: QtBot
) -> None:
    (drive,) = street.drives()
    reported: list[Text] = []
    street.reported.connect(reported.append)
    with qtbot.waitSignal(street.shared.map_changes.features_changed, timeout=WAIT_MS):
        street.start_run("finder", drive.id, NormalsParameters(radius_m=0.4))
    features = list(street.features())
    count = -(-drive.count // 1000)
    assert len(features) == count
    assert {one.status for one in features} == {Status.CANDIDATE}
    assert features[3].vertices[0].measured == PointReference(drive.id, 3000)
    assert features[3].vertices[0].xyz == tuple(drive.xyz(np.array([3000]))[0].tolist())
    (run,) = street.runs()
    assert run.parameters == {"radius_m": 0.4}
    assert run.started <= run.finished
    assert street.undo_stack.undo_label == Text(
        f"Curbs: {count} candidates", f"縁石: 候補{count}件"
    )
    assert reported[-1] == street.undo_stack.undo_label
    street.undo()
    assert not list(street.features())


def test_a_run_that_fails_leaves_the_map_as_it_was(street: Document, qtbot: QtBot) -> None:
    with qtbot.waitSignal(street.refused, timeout=WAIT_MS) as refused:
        street.start_run("refuser", street.drives()[0].id, NormalsParameters())
    assert isinstance(refused.args[0], MissingInput)
    assert not street.runs()
    assert not list(street.features())


def test_what_a_run_found_for_a_project_that_was_closed_is_dropped(
    street: Document, qtbot: QtBot
) -> None:
    project = street.project
    assert project is not None
    folder = project.folder
    street.start_run("finder", street.drives()[0].id, NormalsParameters())
    street.close()
    assert street.open(folder)
    assert not street.runs()
    assert not list(street.features())


def arguments(tmp_path: Path, inputs: list[Path], output: str, **others: object) -> Namespace:
    given = {
        "tool": "finder",
        "inputs": inputs,
        "trajectory": [],
        "images": [],
        "crs": "EPSG:6677",
        "set": [],
        "output": tmp_path / output,
    }
    return Namespace(**{"columns": "", **given, **others})


def test_the_command_line_writes_candidates_of_delivered_files(
    delivery: ImportRequest, tmp_path: Path
) -> None:
    given = arguments(
        tmp_path,
        list(delivery.inputs),
        "結果.geojson",
        trajectory=list(delivery.trajectories),
        set=["radius_m=0.4"],
    )
    assert command(given) == 0
    reported = json.loads((tmp_path / "結果.geojson").read_text("utf-8"))
    assert reported["crs"]["properties"]["name"].endswith("6677")
    properties = [one["properties"] for one in reported["features"]]
    assert {one["status"] for one in properties} == {"candidate"}
    assert {one["kind"] for one in properties} == {"sign"}
    assert {one["size_m"] for one in properties} == {0.4}
    confidences = [one["confidence"] for one in properties]
    assert confidences == sorted(confidences)


def test_the_command_line_reads_a_project_and_leaves_it_as_it_was(
    street: Document, tmp_path: Path
) -> None:
    project = street.project
    assert project is not None
    folder = project.folder
    street.close()
    assert command(arguments(tmp_path, [folder], "a.gpkg")) == 0
    assert (tmp_path / "a.gpkg").stat().st_size > 0
    reopened = Project.open(folder, writing=False)
    assert len(reopened.features) == 0
    reopened.close()


def test_a_tool_that_finds_is_not_written_as_points(
    delivery: ImportRequest, tmp_path: Path
) -> None:
    with pytest.raises(OutOfRange):
        command(arguments(tmp_path, list(delivery.inputs), "a.las"))
    with pytest.raises(OutOfRange):
        command(arguments(tmp_path, list(delivery.inputs), "a.geojson", tool="normals"))


@pytest.fixture
def two_heads(tmp_path: Path) -> ImportRequest:
    heads = [simulated_drive(3), simulated_drive(4, head="right")]
    clouds = [
        write_laz(heads[0], tmp_path / "left.laz"),
        write_laz(heads[1], tmp_path / "right.laz"),
    ]
    return ImportRequest(
        tuple(clouds), (write_trajectory_csv(heads[0], tmp_path / "trajectory.csv"),)
    )


def test_a_run_on_all_heads_gives_one_result_whose_vertices_know_their_drive(
    document: Document, two_heads: ImportRequest, tmp_path: Path, qtbot: QtBot
) -> None:
    with qtbot.waitSignal(document.shared.map_changes.drives_changed, timeout=WAIT_MS):
        document.create(tmp_path / "p.zuka", "EPSG:6677")
    with qtbot.waitSignal(document.shared.map_changes.drives_changed, timeout=WAIT_MS):
        document.import_files(two_heads)
    other, shown = document.drives()
    with qtbot.waitSignal(document.shared.map_changes.features_changed, timeout=WAIT_MS):
        document.start_run("together", shown.id, NormalsParameters())
    line, drawn = document.features()
    (run,) = document.runs()
    assert run.drives == (shown.id, other.id)
    assert run.summary.en == "Curbs: 2 candidates. Only one line was seen."
    for vertex, drive in zip(line.vertices, (shown, other, shown), strict=False):
        assert vertex.measured == PointReference(drive.id, 0)
    assert drawn.kind == "gutter_covered"


def test_the_command_line_joins_all_heads_and_draws_what_follows_only_in_drawings(
    two_heads: ImportRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told_lines = StringIO()
    monkeypatch.setattr("app.cli.run.terminal_monitor", lambda: TerminalMonitor(told_lines))
    given = {"trajectory": list(two_heads.trajectories), "tool": "together"}
    for output in ("a.geojson", "a.dxf"):
        assert command(arguments(tmp_path, list(two_heads.inputs), output, **given)) == 0
    assert "Only one line was seen." in told_lines.getvalue()
    reported = json.loads((tmp_path / "a.geojson").read_text("utf-8"))
    assert [one["properties"]["kind"] for one in reported["features"]] == ["curb_upper"]
    drawing = ezdxf.readfile(tmp_path / "a.dxf").modelspace()
    assert len(drawing.query("POLYLINE LWPOLYLINE")) == 2
