"""A score and a simulation are the same from the window, the command line and a written file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtWidgets import QLineEdit, QPushButton
from pytestqt.qtbot import QtBot

from app.classes.evaluation import Evaluation
from app.classes.truth_evaluations import TruthEvaluations
from app.cli.scores.file_score_words import file_score_json
from app.cli.scores.point_score_words import point_score_json
from app.cli.terminal import DONE, run_in_terminal
from app.document.document import Document
from app.jobs.jobs import JobQueue
from app.window.window_parts import WindowParts
from processing.core.monitor import SilentMonitor
from processing.core.parameters import ParameterValue
from processing.core.text import Text
from processing.laboratory.every_operation import EVERY_OPERATION
from processing.laboratory.simulate.simulate_operation import SimulateOperation
from processing.map.catalogue import Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, Provenance, Status, Vertex, new_feature_id
from processing.operations.operation_files import perform, read_operation, write_operation
from processing.operations.score import ScoreOperation, ScoreOutcome
from processing.project.importing.import_request import ImportRequest
from processing.project.project import Project
from processing.project.store.runs import Run
from processing.scoring.features.file_scores import FileScore
from processing.tools.listed.registry import TOOLS
from tests.app.score_answers import scored
from tests.builders import write_laz, write_trajectory_csv
from tests.noisy_street import noisy_street
from tests.processing.scoring.small_maps import ORIGIN, curb_pair, map_of, moved
from widgets.dialogs.simulate import SimulateForm

WAIT_MS = 30_000
NOISE = {"method": "radius", "radius_m": 0.3, "neighbours": 12}
STREET: dict[str, ParameterValue] = {
    "seed": 4,
    "style": "highway",
    "length_m": 10.0,
    "pulses": 100,
    "turns_per_s": 20.0,
}


@pytest.fixture(scope="module")
def noisy(tmp_path_factory: pytest.TempPathFactory) -> ImportRequest:
    """A short street with noise, and what is noise beside it."""
    folder, street = tmp_path_factory.mktemp("noisy"), noisy_street(7, length_m=3.0)
    np.savez(folder / "truth.npz", code=street.noise)
    cloud = write_laz(street.drive, folder / "左.laz")
    return ImportRequest((cloud,), (write_trajectory_csv(street.drive, folder / "軌跡.csv"),))


@pytest.fixture
def delivery(noisy: ImportRequest) -> ImportRequest:
    return noisy


@pytest.fixture
def evaluations(street: Document, jobs: JobQueue) -> TruthEvaluations:
    return TruthEvaluations(street, jobs)


def written_and_done(path: Path, operation: object) -> object:
    """What an operation gives that was written to a file and read back."""
    write_operation(path, operation, EVERY_OPERATION)
    return perform(read_operation(path, EVERY_OPERATION), SilentMonitor(), EVERY_OPERATION)


def test_noise_has_the_same_counts_in_the_window_and_by_command(
    street: Document,
    evaluations: TruthEvaluations,
    noisy: ImportRequest,
    qtbot: QtBot,
    capsys: pytest.CaptureFixture[str],
) -> None:
    (cloud,), (trajectory,) = noisy.inputs, noisy.trajectories
    truth, result = (cloud.with_name(name) for name in ("truth.npz", "noise.laz"))
    with qtbot.waitSignal(evaluations.truth_made, timeout=WAIT_MS) as made:
        evaluations.load_truth(truth)
    with qtbot.waitSignal(street.reported, timeout=WAIT_MS):
        street.start_run("noise", street.drives()[0].id, TOOLS["noise"].parameters(**NOISE))
    with qtbot.waitSignal(evaluations.judged, timeout=WAIT_MS) as judged:
        evaluations.judge(made.args[0].id)
    by_window = judged.args[1][0].counts

    settings = [word for name, value in NOISE.items() for word in ("--set", f"{name}={value}")]
    asked = ["run", "noise", cloud, "--trajectory", trajectory, "--output", result, *settings]
    assert run_in_terminal([*map(str, asked)]) == DONE
    capsys.readouterr()
    by_command = scored(capsys, "noise", result, truth)
    of_noise = by_command["classes"]["noise"]
    assert of_noise["tp"] > 100
    assert [of_noise[name] for name in ("tp", "fp", "fn", "tn")] == [
        by_window.hits,
        by_window.false_alarms,
        by_window.misses,
        by_window.rejections,
    ]

    outcome = written_and_done(
        cloud.with_name("score.toml"), ScoreOperation("noise", result, truth)
    )
    assert isinstance(outcome, ScoreOutcome)
    assert outcome.points is not None
    figures = point_score_json(outcome.points)
    assert {name: by_command[name] for name in figures} == figures


def decide_curbs(project: Project) -> None:
    """A run found curbs on the drive; a person moved one, accepted one and turned one down."""
    (drive,) = project.drives
    middle = (np.array(drive.info.lowest) + np.array(drive.info.highest)) / 2
    edges = [
        one
        for north in (0.0, 1.0, 2.0)
        for one in moved(map_of(curb_pair(0, 2, 1)), north=north).features
    ]
    now = datetime.now(UTC)
    run = Run("run", "curbs", 1, {}, (drive.id,), now, now, Text("Curbs", "縁石"))
    found = [
        Feature(
            new_feature_id(),
            f"curb_{one.facts['edge']}",
            Geometry.LINE,
            tuple(Vertex((x, y, z)) for x, y, z in (one.xyz - ORIGIN + middle).tolist()),
            status=Status.CANDIDATE,
            provenance=Provenance("curbs", 1, {}, 0.8, run.id),
        )
        for one in edges
    ]
    project.features.apply(run.summary, Change(added=tuple(found)), run=run)
    first, second, third, *_ = found
    higher = tuple(Vertex((v.xyz[0], v.xyz[1], v.xyz[2] + 0.02)) for v in first.vertices)
    decided = (
        Replacement(first, replace(first, vertices=higher, status=Status.ACCEPTED)),
        Replacement(second, replace(second, status=Status.ACCEPTED)),
        Replacement(third, replace(third, status=Status.REJECTED)),
    )
    project.features.apply(Text("Decide", "判定"), Change(replaced=decided))


def test_a_map_has_the_same_scores_in_the_window_and_by_command(
    street: Document, tmp_path: Path, qtbot: QtBot, capsys: pytest.CaptureFixture[str]
) -> None:
    assert street.project is not None
    folder = street.project.folder
    decide_curbs(street.project)
    street.close()
    assert street.open(folder)
    evaluation, taken = Evaluation(street), list[Mapping[str, FileScore]]()
    assert evaluation.evaluations()
    evaluation.score_maps(taken.append)
    qtbot.waitUntil(lambda: bool(taken), timeout=WAIT_MS)
    by_window = file_score_json(taken[0]["run"])
    street.close()
    by_command = scored(capsys, "curbs", folder, folder)
    assert {name: by_command[name] for name in by_window} == by_window
    assert by_command["classes"]["all"]["tp"] > 0
    assert by_command["classes"]["all"]["fp"] > 0

    outcome = written_and_done(tmp_path / "score.json", ScoreOperation("curbs", folder, folder))
    assert isinstance(outcome, ScoreOutcome)
    assert outcome.file is not None
    assert file_score_json(outcome.file) == by_window


def files_of(folder: Path) -> dict[str, bytes]:
    """Every file below a folder by its name there."""
    found = (path for path in sorted(folder.rglob("*")) if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in found}


def test_a_street_has_the_same_bytes_from_the_form_the_command_and_a_written_file(
    parts: WindowParts, tmp_path: Path, qtbot: QtBot
) -> None:
    by_window, by_command, by_file = (tmp_path / name for name in ("窓", "command", "file"))
    parts.document.create(tmp_path / "open.zuka", "")  # so that what is made isn't imported
    parts.window.actions_by_id["simulate"].trigger()
    (form,) = parts.window.findChildren(SimulateForm)
    form.form("street").set_values({**STREET, "images": False})
    form.form("street").changed.emit()
    folder = next(one for one in form.findChildren(QLineEdit) if "street-" in one.text())
    folder.setText(str(by_window))
    folder.textEdited.emit(str(by_window))
    create = next(one for one in form.findChildren(QPushButton) if one.text() == "Create")
    qtbot.waitUntil(create.isEnabled, timeout=WAIT_MS)
    create.click()
    qtbot.waitUntil(lambda: "is ready" in parts.message_bar.text, timeout=WAIT_MS)

    settings = {**STREET, "images": "no"}
    words = [word for name, value in settings.items() for word in ("--set", f"{name}={value}")]
    assert run_in_terminal(["simulate", "street", "--out", str(by_command), *words]) == DONE
    asked = SimulateOperation("street", by_file, {**STREET, "images": False})
    written_and_done(tmp_path / "street.toml", asked)
    made = files_of(by_window)
    assert {"left.laz", "right.laz", "trajectory.csv"} < made.keys()
    assert any(name.startswith("truth") for name in made)
    assert files_of(by_command) == made
    assert files_of(by_file) == made
