"""``zuka score``: a tool's result against a truth, with every class named that is positive."""

from __future__ import annotations

import argparse
import math
import tempfile
from pathlib import Path

from app.cli.aligned import aligned
from app.cli.opened import terminal_monitor
from app.cli.output import print_json, print_lines
from app.language import system_language
from processing.errors import Unsuitable
from processing.formats.point_codes import read_result, read_truth
from processing.monitor import Monitor
from processing.score.coded_points import CodedFile, pairs_by_order
from processing.score.pairs_by_place import pairs_by_place
from processing.score.point_classes import TwoByTwo
from processing.score.point_scores import PointScore, PointScorer
from processing.score.reliability import Share
from processing.score.scorers import scorer_of
from processing.text import Language, Text

_ORDER, _PLACE = "order", "place"
_HEAD = (
    Text("positive class", "正例とするクラス"),
    Text("precision", "適合率"),
    Text("recall", "再現率"),
    Text("F", "F値"),
    Text.same("TP"),
    Text.same("FP"),
    Text.same("FN"),
    Text.same("TN"),
)
_KINDS_HEAD = (Text("kind", "種類"), Text("points", "点数"), Text("right", "正解率"))


def command(arguments: argparse.Namespace) -> int:
    """Score a result against a truth and print the figures."""
    scorer = scorer_of(arguments.tool)
    truth = read_truth(
        arguments.truth, if_false=scorer.if_false, if_true=scorer.if_true, flags=scorer.flags
    )
    result = read_result(arguments.result)
    score, paired_by = _scored(scorer, truth, result, terminal_monitor())
    if arguments.json:
        files = {"result": str(arguments.result), "truth": str(arguments.truth)}
        print_json({"tool": score.tool, **files, "paired_by": paired_by, **_as_json(score)})
    else:
        print_lines(*_lines(score, scorer, system_language()))
    return 0


def _scored(
    scorer: PointScorer, truth: CodedFile, result: CodedFile, monitor: Monitor
) -> tuple[PointScore, str]:
    """The score, and by what the points were paired: their order, or else their places."""
    try:
        return scorer.score(pairs_by_order(truth, result, monitor)), _ORDER
    except Unsuitable:
        if not (truth.has_places and result.has_places):
            raise
    with tempfile.TemporaryDirectory(prefix="zuka-") as folder:
        return scorer.score(pairs_by_place(truth, result, Path(folder), monitor)), _PLACE


def _as_json(score: PointScore) -> dict[str, object]:
    kinds: dict[str, dict[str, object]] = {}
    for one in score.kinds:
        kinds.setdefault(one.group, {})[str(one.kind)] = _share_json(one.right)
    return {
        "points": score.points,
        "classes": {one.id: _counts_json(one.counts) for one in score.classes},
        "shares": {one.id: _share_json(one.share) for one in score.shares},
        "figures": {one.id: _or_null(one.value) for one in score.figures},
        "kinds": kinds,
    }


def _counts_json(counts: TwoByTwo) -> dict[str, object]:
    return {
        "precision": _or_null(counts.precision),
        "recall": _or_null(counts.recall),
        "f": _or_null(counts.f_measure),
        "tp": counts.hits,
        "fp": counts.false_alarms,
        "fn": counts.misses,
        "tn": counts.rejections,
    }


def _share_json(share: Share) -> dict[str, object]:
    return {"points": int(share.hits), "of": int(share.of), "share": _or_null(share.value)}


def _or_null(value: float) -> float | None:
    return None if math.isnan(value) else value


def _lines(score: PointScore, scorer: PointScorer, language: Language) -> list[str]:
    points = Text("{name}: {points} points", "{name}：{points}点")
    lines = [points.filled(name=scorer.name, points=f"{score.points:,}").spoken(language), ""]
    rows = [[word.spoken(language) for word in _HEAD]]
    for one in score.classes:
        found = one.counts
        shares = (found.precision, found.recall, found.f_measure)
        counts = (found.hits, found.false_alarms, found.misses, found.rejections)
        rows.append(
            [
                one.name.spoken(language),
                *(_percent(share) for share in shares),
                *(f"{count:,}" for count in counts),
            ]
        )
    lines += [*aligned(rows), ""]
    lines += aligned(
        [
            *(
                [one.name.spoken(language), _percent(one.share.value), _of(one.share)]
                for one in score.shares
            ),
            *([one.name.spoken(language), _figure(one.value), ""] for one in score.figures),
        ]
    )
    if score.kinds:
        kinds = [[word.spoken(language) for word in _KINDS_HEAD]]
        kinds += [
            [f"{one.group} {one.kind}", f"{int(one.right.of):,}", _percent(one.right.value)]
            for one in score.kinds
        ]
        lines += ["", *aligned(kinds)]
    return lines


def _percent(share: float) -> str:
    return "–" if math.isnan(share) else f"{100 * share:.3f} %"


def _figure(value: float) -> str:
    return "–" if math.isnan(value) else f"{value:.4f}"


def _of(share: Share) -> str:
    return f"{int(share.hits):,} / {int(share.of):,}"
