"""``zuka score``: a tool's result against a truth, with every class named that is positive."""

from __future__ import annotations

import argparse
import tempfile
from contextlib import closing
from pathlib import Path

from app.cli.opened import terminal_monitor
from app.cli.output import print_json, print_lines
from app.cli.scores.file_score_words import file_score_json, file_score_lines
from app.cli.scores.point_score_words import point_score_json, point_score_lines
from app.settings.language import system_language
from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.formats.points.point_codes import read_result, read_truth
from processing.formats.reports.number_file import read_numbers
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.project.evaluation.mapped_map import agreed_map, found_map
from processing.project.project import Project, is_project
from processing.scoring.coded_points import CodedFile, pairs_by_order
from processing.scoring.file_scores import FeatureScorer, FileScore, VolumeScorer
from processing.scoring.mapped_features import MappedFile, check_same_system
from processing.scoring.pairs_by_position import pairs_by_position
from processing.scoring.point_scores import PointScore, PointScorer
from processing.scoring.volumes import MEASURES
from processing.tools.registry import scorer_of

_ORDER, _POSITION = "order", "place"


def command(arguments: argparse.Namespace) -> int:
    """Score a result against a truth and print the figures."""
    scorer = scorer_of(arguments.tool)
    language = system_language()
    if isinstance(scorer, PointScorer):
        points, paired_by = _scored_points(scorer, arguments.result, arguments.truth)
        figures = {"paired_by": paired_by, **point_score_json(points)}
        lines = point_score_lines(points, scorer.name, language)
    else:
        score = _scored_file(scorer, arguments.result, arguments.truth)
        figures = file_score_json(score)
        lines = file_score_lines(score, scorer.name, language)
    if arguments.json:
        files = {"result": str(arguments.result), "truth": str(arguments.truth)}
        print_json({"tool": scorer.tool, **files, **figures})
    else:
        print_lines(*lines)
    return 0


def _scored_file(scorer: FeatureScorer | VolumeScorer, result: Path, truth: Path) -> FileScore:
    if isinstance(scorer, VolumeScorer):
        return scorer.score(
            read_numbers(result, tuple(MEASURES)), read_numbers(truth, tuple(MEASURES))
        )
    true = _read_truth(truth)
    found = _read_result(result, scorer.tool)
    check_same_system(found, true)
    return scorer.score(found, true)


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


def _scored_points(scorer: PointScorer, result: Path, truth: Path) -> tuple[PointScore, str]:
    true = read_truth(truth, if_false=scorer.if_false, if_true=scorer.if_true, flags=scorer.flags)
    return _paired_and_scored(scorer, true, read_result(result), terminal_monitor())


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
