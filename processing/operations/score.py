"""Scoring a tool's result against a truth: a value that names both, and what compares them."""

from __future__ import annotations

import tempfile
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.formats.points.flight_scoring import (
    other_flight,
    read_flight_truth,
    read_found_echoes,
    read_found_waves,
    read_true_waves,
)
from processing.formats.points.point_codes import read_result, read_truth
from processing.formats.reports.number_file import read_numbers
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.project.evaluation.mapped_map import agreed_map, found_map
from processing.project.project import Project, is_project
from processing.scoring.features.file_scores import FeatureScorer, FileScore, VolumeScorer
from processing.scoring.features.mapped_features import MappedFile, check_same_system
from processing.scoring.features.volumes import MEASURES
from processing.scoring.points.coded_points import CodedFile, pairs_by_order
from processing.scoring.points.pairs_by_position import pairs_by_position
from processing.scoring.points.point_scores import PointScore, PointScorer
from processing.scoring.scorers import Scorer
from processing.scoring.waveforms.flight_scores import EchoScorer, WaveScorer, rows_at
from processing.tools.listed.registry import scorer_of

_ORDER, _POSITION = "order", "place"


@dataclass(frozen=True)
class ScoreOperation:
    """A result and its truth.

    Attributes
    ----------
    tool : str
        Whose result it is.
    result, truth : Path
        Files; or projects, of which the tool's last run, and what a person drew or accepted, count.
    """

    tool: str
    result: Path
    truth: Path

    def check(self) -> None:
        """Refuse a tool that can't be scored.

        Raises
        ------
        OutOfRange
        """
        scorer_of(self.tool)


@dataclass(frozen=True)
class ScoreOutcome:
    """How good a result is.

    Attributes
    ----------
    scorer : Scorer
    points : PointScore or None
        Of a tool that says something about points.
    file : FileScore or None
        Of others.
    paired_by : str
        ``order`` or ``place``: how the points were paired; empty where none were.
    """

    scorer: Scorer
    points: PointScore | None = None
    file: FileScore | None = None
    paired_by: str = ""


def score_result(operation: ScoreOperation, monitor: Monitor) -> ScoreOutcome:
    """Score a result against a truth.

    Raises
    ------
    UserError, Cancelled
        One of them can't be read, or they don't fit each other.
    """
    scorer = scorer_of(operation.tool)
    result, truth = operation.result, operation.truth
    if not isinstance(scorer, PointScorer):
        return ScoreOutcome(scorer, file=_scored_file(scorer, result, truth))
    true = read_truth(truth, if_false=scorer.if_false, if_true=scorer.if_true, flags=scorer.flags)
    points, paired_by = _paired_and_scored(scorer, true, read_result(result), monitor)
    return ScoreOutcome(scorer, points=points, paired_by=paired_by)


def _scored_file(
    scorer: FeatureScorer | VolumeScorer | EchoScorer | WaveScorer, result: Path, truth: Path
) -> FileScore:
    if isinstance(scorer, EchoScorer):
        return _scored_echoes(scorer, result, truth)
    if isinstance(scorer, WaveScorer):
        waves = read_true_waves(truth)
        return scorer.score(*read_found_waves(result, waves), waves)
    if isinstance(scorer, VolumeScorer):
        return scorer.score(
            read_numbers(result, tuple(MEASURES)), read_numbers(truth, tuple(MEASURES))
        )
    true = _read_truth(truth)
    found = _read_result(result, scorer.tool)
    check_same_system(found, true)
    return scorer.score(found, true)


def _scored_echoes(scorer: EchoScorer, result: Path, truth: Path) -> FileScore:
    flight, found = read_flight_truth(truth), read_found_echoes(result)
    if found.time_s.size and (rows_at(flight.time_s, found.time_s) < 0).all():
        raise other_flight(result)
    return scorer.score(found, flight)


def _read_truth(path: Path) -> MappedFile:
    """A map file; or of a project what a person drew or accepted."""
    if not is_project(path):
        return read_mapped(path)
    with closing(Project.open(path, writing=False)) as project:
        return agreed_map(project, path)


def _read_result(path: Path, tool: str) -> MappedFile:
    """A map file; or of a project what the tool's last run found."""
    if not is_project(path):
        return read_mapped(path)
    with closing(Project.open(path, writing=False)) as project:
        return found_map(project, path, tool)


def _paired_and_scored(
    scorer: PointScorer, truth: CodedFile, result: CodedFile, monitor: Monitor
) -> tuple[PointScore, str]:
    """The score, and by what the points were paired: their order, or else their places."""
    try:
        return scorer.score(pairs_by_order(truth, result, monitor)), _ORDER
    except Unsuitable:
        if not (truth.has_positions and result.has_positions):
            raise
    with tempfile.TemporaryDirectory(prefix="zuka-") as folder:
        return scorer.score(pairs_by_position(truth, result, Path(folder), monitor)), _POSITION
