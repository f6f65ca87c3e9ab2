"""Runs of the open project judged by its history, and written to files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.classes.evaluation import Evaluation
from app.classes.evaluation_files import write_evaluation_file
from app.document.document import Document
from app.jobs.jobs import JobQueue
from app.review.review import Review
from processing.core.errors import Unsuitable, UserError
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, Vertex, new_feature_id
from processing.project.importing.importing import ImportRequest
from processing.project.review.review_state import ReviewOrder
from processing.scoring.features.file_scores import FileScore
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.scoring.points.reliability import reliability_of
from processing.tools.tool import Candidate, CandidateResult
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.processing.project.candidates import found, found_lines
from widgets.panels.reliability_plot import PlotWords, ReliabilityPlot

WAIT_MS = 30_000
LABEL = Text("Move", "移動")
WORDS = PlotWords("縁石", "信頼度", "採用の割合", "{count}件", "誤差{error}", "なし")


@pytest.fixture
def document(qapp: QApplication, tmp_path: Path) -> Iterator[Document]:
    jobs = JobQueue()
    document = Document(jobs)
    document.create(tmp_path / "p.zuka", "EPSG:6677")
    yield document
    jobs.close()
    document.close()
    document.tiles.close()


def test_corrections_are_measured_against_what_the_run_gave_also_after_a_restart(
    document: Document, tmp_path: Path
) -> None:
    found = found_lines(6)
    document.store_run(found)
    review = Review(document)
    review.open((found.run.id,), ReviewOrder.CONFIDENCE)
    feature = review.current
    assert feature is not None
    higher = tuple(replace(v, xyz=(*v.xyz[:2], v.xyz[2] + 0.25)) for v in feature.vertices)
    moved = feature.with_vertices(higher)
    document.apply(LABEL, Change(replaced=(Replacement(feature, moved),)))
    review.accept()
    review.accept()
    review.reject()
    evaluation = Evaluation(document)
    (one,) = evaluation.evaluations()
    assert (one.accepted, one.rejected, one.undecided, one.corrected) == (2, 1, 3, 1)
    assert one.shift_m == pytest.approx(0.25)
    document.close()
    assert evaluation.evaluations() == ()
    document.open(tmp_path / "p.zuka")
    assert evaluation.evaluations() == (one,)


@pytest.fixture
def plot() -> ReliabilityPlot:
    confidence = np.linspace(0, 1, 200)
    return ReliabilityPlot(reliability_of(confidence, confidence > 0.5), WORDS)


def test_a_curve_becomes_a_picture_with_its_resolution(
    qapp: QApplication, tmp_path: Path, plot: ReliabilityPlot
) -> None:
    path = tmp_path / "信頼度.png"
    write_evaluation_file(path, (), plot)
    picture = QImage(str(path))
    assert (picture.width(), picture.height()) == (1800, 1800)
    assert picture.pixelColor(3, 3).lightness() == 255
    assert [one.name for one in tmp_path.iterdir()] == [path.name]


def test_a_curve_becomes_a_page(qapp: QApplication, tmp_path: Path, plot: ReliabilityPlot) -> None:
    path = tmp_path / "curve.pdf"
    write_evaluation_file(path, (), plot)
    assert path.read_bytes().startswith(b"%PDF")


def test_without_a_curve_no_picture_is_written(tmp_path: Path) -> None:
    with pytest.raises(Unsuitable):
        write_evaluation_file(tmp_path / "a.png", (), None)
    assert not list(tmp_path.iterdir())


def test_a_picture_that_cannot_be_written_is_refused_and_leaves_nothing(
    qapp: QApplication, tmp_path: Path, plot: ReliabilityPlot
) -> None:
    (tmp_path / "file").write_text("x")
    for ending in ("png", "pdf", "csv"):
        with pytest.raises(UserError):
            write_evaluation_file(tmp_path / "file" / f"a.{ending}", (), plot)
    assert [one.name for one in tmp_path.iterdir()] == ["file"]


def test_what_a_run_found_is_scored_against_what_was_drawn_and_accepted(
    document: Document, tmp_path: Path, qtbot: QtBot
) -> None:
    cloud, trajectory = simulated_drive(3), tmp_path / "軌跡.csv"
    files = (write_laz(cloud, tmp_path / "左.laz"),), (write_trajectory_csv(cloud, trajectory),)
    with qtbot.waitSignal(document.shared.map_changes.drives_changed, timeout=WAIT_MS):
        document.import_files(ImportRequest(*files))
    (drive,) = document.drives()
    low = np.array(drive.info.lowest)
    lines = [np.array([[n, 0.5, 0.0], [n + 2.0, 0.5, 0.0]]) + low for n in (0, 3, 6)]
    candidates = tuple(
        Candidate("curb_lower", "line", one, np.full(2, -1), 0.8, {"edge": "lower"})
        for one in lines
    )
    made = found(CandidateResult(candidates), drive=drive.id)
    document.store_run(replace(made, run=replace(made.run, tool="curbs")))
    by_hand = [Vertex((x, y, z)) for x, y, z in (lines[0] + [0.0, 0.02, 0.0]).tolist()]
    drawn = Feature(new_feature_id(), "curb_lower", Geometry.LINE, tuple(by_hand))
    document.apply(LABEL, Change(added=(drawn,)))
    evaluation = Evaluation(document)
    evaluation.evaluations()
    scores: list[Mapping[str, FileScore]] = []
    evaluation.score_maps(scores.append)
    qtbot.waitUntil(lambda: bool(scores), timeout=WAIT_MS)
    assert scores[0][made.run.id].counts_of("all") == BinaryConfusionMatrix(1, 2, 0, 0)
