"""What the window does and what the command line does is the same operation: equal results."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.document.document import Document
from app.jobs.jobs import JobQueue
from processing.core.monitor import SilentMonitor
from processing.map.feature import Feature, Status
from processing.operations.export import ExportRequest
from processing.operations.inputs import OperationInputs
from processing.operations.map_steps import UndoneStep, UndoOperation
from processing.operations.operation_files import perform, read_operation, write_operation
from processing.operations.project_volumes import (
    KeepVolumeOperation,
    StoredVolume,
    make_volume,
    store_volume,
)
from processing.operations.run import RunOperation, operation_on_drive
from processing.operations.volume import VolumeOperation
from processing.operations.volume_sides import VolumeSide
from processing.project.importing.dropped_files import request_of_files
from processing.project.project import Project
from processing.project.volumes.epochs import epochs_of
from processing.project.volumes.volume import KeptVolume, VolumeRequest
from processing.project.volumes.volume_store import VolumeStore
from processing.recording.drive import Drive
from processing.tools.listed.registry import TOOLS
from resources import path_of
from tests.journeys.earthwork_user import two_epochs

WAIT_MS = 60_000
ROOT = Path(__file__).parents[2]


def zuka(*arguments: object) -> list[str]:
    """Run the program as a script does; gives what it prints."""
    words = [sys.executable, "-m", "app", *map(str, arguments)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "ZUKA_LANGUAGE": "en"}
    done = subprocess.run(words, capture_output=True, check=False, env=environment)
    assert done.returncode == 0, done.stderr.decode()
    return done.stdout.decode().splitlines()


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sample street, imported by the command line."""
    folder, sample = tmp_path_factory.mktemp("street") / "street.zuka", path_of("sample_street")
    zuka(
        "import",
        folder,
        sample / "left.laz",
        sample / "right.laz",
        "--trajectory",
        sample / "trajectory.csv",
        "--images",
        sample / "images.csv",
    )
    return folder


@pytest.fixture
def copies(street: Path, tmp_path: Path) -> tuple[Path, Path]:
    """A project for each door."""
    found = tmp_path / "by_command.zuka", tmp_path / "by_window.zuka"
    for one in found:
        shutil.copytree(street, one)
    return found


@pytest.fixture
def window(qapp: QApplication) -> Iterator[Document]:
    jobs = JobQueue()
    document = Document(jobs)
    yield document
    jobs.close()
    document.close()
    document.tiles.close()


def columns_of(drive: Drive) -> dict[str, bytes]:
    """The bytes of a drive's columns by name."""
    return {path.name: path.read_bytes() for path in sorted(drive.folder.glob("*.bin"))}


def features_of(project: Project) -> list[Feature]:
    """All features, but for what is of one run alone: ids."""
    return [
        replace(one, id="", provenance=replace(one.provenance, run=""))
        for one in project.features.all()
    ]


def run_in_window(window: Document, tool: str, qtbot: QtBot) -> None:
    with qtbot.waitSignal(window.reported, timeout=WAIT_MS):
        window.start_run(tool, window.drives()[0].id, TOOLS[tool].parameters())


def opened(window: Document, folder: Path) -> Project:
    assert window.open(folder)
    assert window.project is not None
    return window.project


def test_an_import_gives_the_same_columns(
    street: Path, window: Document, tmp_path: Path, qtbot: QtBot
) -> None:
    request = request_of_files((path_of("sample_street"),), "")
    with qtbot.waitSignal(window.reported, timeout=WAIT_MS):
        window.import_into_new(tmp_path / "window.zuka", request)
    with closing(Project.open(street, writing=False)) as project:
        assert [one.info.name for one in project.drives] == [
            one.info.name for one in window.drives()
        ]
        for one, other in zip(project.drives, window.drives(), strict=True):
            columns = columns_of(one)
            assert columns
            theirs = columns_of(other)  # surfaces are found in the window's background
            assert columns == {name: theirs[name] for name in columns}


def test_what_a_tool_finds_is_stored_alike_and_exported_alike(
    copies: tuple[Path, Path], window: Document, tmp_path: Path, qtbot: QtBot
) -> None:
    by_command, by_window = copies
    (told,) = zuka("run", "curbs", by_command)
    project = opened(window, by_window)
    run_in_window(window, "curbs", qtbot)
    (run,) = project.runs.all()
    with closing(Project.open(by_command, writing=False)) as other:
        (same,) = other.runs.all()
        assert told == run.summary.en == same.summary.en
        assert (run.drives, run.parameters) == (same.drives, same.parameters)
        found = features_of(other)
    assert found
    assert {one.status for one in found} == {Status.CANDIDATE}
    assert features_of(project) == found

    request = ExportRequest(("geojson", "csv"), tmp_path / "window", "en", candidates=True)
    with qtbot.waitSignal(window.reported, timeout=WAIT_MS):
        window.export(request)
    out = tmp_path / "command"
    formats = ("--format", "geojson", "--format", "csv")
    zuka("export", by_window, *formats, "--candidates", "--out", out)
    written = {path.name: path.read_bytes() for path in out.iterdir()}
    assert written == {path.name: path.read_bytes() for path in request.folder.iterdir()}
    assert len(written) > 3


def test_candidates_accepted_at_once_are_on_the_exported_map(
    copies: tuple[Path, Path], tmp_path: Path
) -> None:
    project, _ = copies
    _, accepted = zuka("run", "curbs", project, "--accept-above", "0.5")
    zuka("export", project, "--format", "geojson", "--out", tmp_path / "out")
    text = (tmp_path / "out" / f"{project.stem}.geojson").read_text("utf-8")
    count = int(accepted.split()[0])
    assert count > 0
    assert text.count('"accepted"') == count


def test_classes_that_a_tool_gives_are_stored_alike_and_taken_back_alike(
    copies: tuple[Path, Path], window: Document, tmp_path: Path, qtbot: QtBot
) -> None:
    by_command, by_window = copies
    asked = RunOperation("ground", OperationInputs(project=by_command))
    write_operation(tmp_path / "ground.toml", asked)
    perform(read_operation(tmp_path / "ground.toml"), SilentMonitor())
    project = opened(window, by_window)
    run_in_window(window, "ground", qtbot)
    with closing(Project.open(by_command, writing=False)) as other:
        labels = [columns_of(one)["label.bin"] for one in other.drives]
        assert any(any(one[-100_000:]) for one in labels)
        assert labels == [columns_of(one)["label.bin"] for one in project.drives]
        assert other.history.undo_label == project.history.undo_label
    undone = perform(UndoOperation(by_command), SilentMonitor())
    assert isinstance(undone, UndoneStep)
    assert undone.label == project.history.undo_label
    with qtbot.waitSignal(window.shared.map_changes.labels_changed, timeout=WAIT_MS):
        window.undo()
    with closing(Project.open(by_command, writing=False)) as other:
        labels = [columns_of(one)["label.bin"] for one in other.drives]
        assert not any(any(one[-100_000:]) for one in labels)
        assert labels == [columns_of(one)["label.bin"] for one in project.drives]


def test_columns_that_a_tool_makes_are_stored_alike(
    copies: tuple[Path, Path], window: Document, qtbot: QtBot
) -> None:
    by_command, by_window = copies
    zuka("run", "segments", by_command, "--set", "distance_m=0.1")
    project = opened(window, by_window)
    asked = TOOLS["segments"].parameters(distance_m=0.1)
    for drive in project.drives:
        with qtbot.waitSignal(
            window.shared.map_changes.drive_columns_changed,
            timeout=WAIT_MS,
            check_params_cb=lambda id_, drive=drive: id_ == drive.id,
        ):
            window.start_run("segments", drive.id, asked)
    with closing(Project.open(by_command, writing=False)) as other:
        for one, mine in zip(other.drives, project.drives, strict=True):
            assert columns_of(one)["segment.bin"] == columns_of(mine)["segment.bin"]


def test_a_run_into_a_file_is_the_same_from_a_written_operation(
    copies: tuple[Path, Path], tmp_path: Path
) -> None:
    project, _ = copies
    zuka("run", "curbs", project, "--output", tmp_path / "command.geojson")
    asked = operation_on_drive("curbs", TOOLS["curbs"].parameters(), project, "")
    inputs = OperationInputs(project=project)
    asked = replace(asked, inputs=inputs, output=tmp_path / "written.geojson")
    write_operation(tmp_path / "curbs.json", asked)
    perform(read_operation(tmp_path / "curbs.json"), SilentMonitor())
    first, second = (
        re.sub(r'"id": *"[^"]+"', "", (tmp_path / f"{name}.geojson").read_text("utf-8"))
        for name in ("command", "written")
    )
    assert first == second
    assert "curb_upper" in first


def test_a_volume_between_two_epochs_has_the_same_figures(window: Document, tmp_path: Path) -> None:
    folder = tmp_path / "site.zuka"
    zuka("import", folder, *two_epochs(tmp_path))
    assert len(zuka("run", "ground", folder)) == 2
    project = opened(window, folder)
    before, after = epochs_of(project.drives)
    parameters = {"grid_m": 0.25}
    request = VolumeRequest(before.side, after.side, parameters)
    made = make_volume(
        request, project.drives, project.crs, project.temporary_folder(), SilentMonitor()
    )
    store_volume(project, made)
    kept = made.kept
    window.close()
    again = _kept_from_a_file(KeepVolumeOperation(folder, request), tmp_path / "keep.toml")
    assert again.request == kept.request
    assert (again.volumes, again.notes) == (kept.volumes, kept.notes)
    output = tmp_path / "volume.json"
    earlier, later = (VolumeSide(folder, drives=one.side.drives) for one in (before, after))
    write_operation(tmp_path / "volume.toml", VolumeOperation(earlier, later, output, parameters))
    perform(read_operation(tmp_path / "volume.toml"), SilentMonitor())
    told = json.loads(output.read_text("utf-8"))
    assert kept.volumes.cut_m3 > 1
    for name in ("cut_m3", "fill_m3", "net_m3", "area_m2", "uncertainty_m3"):
        assert told[name] == getattr(kept.volumes, name), name
    assert told["grid_m"] == kept.grid_m


def _kept_from_a_file(operation: KeepVolumeOperation, path: Path) -> KeptVolume:
    """The volume that a project keeps after an operation was written, read and done."""
    write_operation(path, operation)
    stored = perform(read_operation(path), SilentMonitor())
    assert isinstance(stored, StoredVolume)
    assert stored.kept in VolumeStore(operation.project).all()
    return stored.kept
