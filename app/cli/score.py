"""``zuka score``: a tool's result against a truth, with every class named that is positive."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.cli.opened import terminal_monitor
from app.cli.output import print_json, print_lines
from app.cli.scores.file_score_words import file_score_json, file_score_lines
from app.cli.scores.point_score_words import point_score_json, point_score_lines
from app.settings.language import system_language
from processing.core.errors import OutOfRange, Unsuitable
from processing.core.safe_write import refuse_inputs, write_safely
from processing.core.text import Language, Text
from processing.formats.pictures.confusion_svg import confusion_svg
from processing.operations.score import ScoreOperation, ScoreOutcome, score_result


def command(arguments: argparse.Namespace) -> int:
    """Score a result against a truth and print the figures."""
    operation = ScoreOperation(arguments.tool, arguments.result, arguments.truth)
    if arguments.picture is not None:
        _check_picture(arguments)
    outcome = score_result(operation, terminal_monitor())
    if arguments.picture is not None:
        _write_picture(outcome, arguments.picture)
    if arguments.json:
        files = {"result": str(arguments.result), "truth": str(arguments.truth)}
        print_json({"tool": outcome.scorer.tool, **files, **_figures(outcome)})
    else:
        print_lines(*_lines(outcome, system_language()))
    return 0


def _check_picture(arguments: argparse.Namespace) -> None:
    """Refuse a picture that can't be written before any work is spent on it."""
    if arguments.picture.suffix.lower() != ".svg":
        raise OutOfRange(_NO_SUCH_PICTURE, Text.same(str(arguments.picture)), _END_IN_SVG)
    refuse_inputs(arguments.picture, [arguments.result, arguments.truth])


def _write_picture(outcome: ScoreOutcome, path: Path) -> None:
    matrix = None if outcome.points is None else outcome.points.matrix
    if matrix is None:
        raise Unsuitable(_NO_MATRIX, Text.same(outcome.scorer.tool), _SCORE_CLASSES)
    with write_safely(path) as temporary:
        temporary.write_text(confusion_svg(matrix, system_language()), encoding="utf-8")


_NO_SUCH_PICTURE = Text(
    "The picture of a confusion matrix is an SVG file.", "混同行列の図はSVGファイルです。"
)
_END_IN_SVG = Text("Let its name end in .svg.", "拡張子を .svg にしてください。")
_NO_MATRIX = Text(
    "Results of this tool have no confusion matrix.", "このツールの結果には混同行列がありません。"
)
_SCORE_CLASSES = Text(
    "Leave --picture out, or score classes.", "--picture を外すか、点群の分類を評価してください。"
)


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
