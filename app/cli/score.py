"""``zuka score``: a tool's result against a truth, with every class named that is positive."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_json, print_lines
from app.cli.scores.file_score_words import file_score_json, file_score_lines
from app.cli.scores.point_score_words import point_score_json, point_score_lines
from app.settings.language import system_language
from processing.core.text import Language
from processing.operations.score import ScoreOperation, ScoreOutcome, score_result


def command(arguments: argparse.Namespace) -> int:
    """Score a result against a truth and print the figures."""
    operation = ScoreOperation(arguments.tool, arguments.result, arguments.truth)
    outcome = score_result(operation, terminal_monitor())
    if arguments.json:
        files = {"result": str(arguments.result), "truth": str(arguments.truth)}
        print_json({"tool": outcome.scorer.tool, **files, **_figures(outcome)})
    else:
        print_lines(*_lines(outcome, system_language()))
    return 0


def _figures(outcome: ScoreOutcome) -> dict[str, object]:
    figures: dict[str, object] = {}
    if outcome.points is not None:
        figures |= {"paired_by": outcome.paired_by, **point_score_json(outcome.points)}
    if outcome.file is not None:
        figures |= file_score_json(outcome.file)
    return figures


def _lines(outcome: ScoreOutcome, language: Language) -> list[str]:
    name, lines = outcome.scorer.name, list[str]()
    if outcome.points is not None:
        lines += point_score_lines(outcome.points, name, language)
    if outcome.file is not None:
        lines += file_score_lines(outcome.file, name, language)
    return lines
