"""The score of classified points in words: a table on the terminal, an object in JSON."""

from __future__ import annotations

from app.cli.scores.aligned import align_lines
from app.cli.scores.score_cells import (
    COUNTS_HEAD,
    count_cells,
    counts_json,
    figure,
    or_null,
    percent,
    so_many_of,
)
from processing.core.text import Language, Text
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.scoring.points.point_scores import PointScore
from processing.scoring.points.reliability import ShareInterval

_HEAD = (Text("positive class", "正例とするクラス"), *COUNTS_HEAD)
_KINDS_HEAD = (Text("kind", "種類"), Text("points", "点数"), Text("right", "正解率"))

_MATRIX_HEAD = Text(
    "true class (rows), class given (columns)", "正解のクラス（行）・結果のクラス（列）"
)


def point_score_json(score: PointScore) -> dict[str, object]:
    """Every count and figure."""
    kinds: dict[str, dict[str, object]] = {}
    for one in score.kinds:
        kinds.setdefault(one.group, {})[str(one.kind)] = _share_json(one.right)
    figures: dict[str, object] = {
        "points": score.points,
        "classes": {one.id: counts_json(one.counts) for one in score.classes},
        "shares": {one.id: _share_json(one.share) for one in score.shares},
        "figures": {one.id: or_null(one.value) for one in score.figures},
        "kinds": kinds,
    }
    if score.matrix is not None:
        matrix = score.matrix
        figures["matrix"] = {"codes": list(matrix.codes), "counts": matrix.counts.tolist()}
    return figures


def point_score_lines(score: PointScore, tool: Text, language: Language) -> list[str]:
    """Lines for people."""
    points = Text("{name}: {points} points", "{name}：{points}点")
    lines = [points.filled(name=tool, points=f"{score.points:,}").in_language(language), ""]
    rows = [[word.in_language(language) for word in _HEAD]]
    rows += [[one.name.in_language(language), *count_cells(one.counts)] for one in score.classes]
    lines += [*align_lines(rows), ""]
    lines += align_lines(
        [
            *(
                [one.name.in_language(language), percent(one.share.value), so_many_of(one.share)]
                for one in score.shares
            ),
            *([one.name.in_language(language), figure(one.value), ""] for one in score.figures),
        ]
    )
    if score.kinds:
        kinds = [[word.in_language(language) for word in _KINDS_HEAD]]
        kinds += [
            [f"{one.group} {one.kind}", f"{int(one.right.of):,}", percent(one.right.value)]
            for one in score.kinds
        ]
        lines += ["", *align_lines(kinds)]
    if score.matrix is not None and score.matrix.codes:
        lines += ["", *_matrix_lines(score.matrix, language)]
    return lines


def _matrix_lines(matrix: ConfusionMatrix, language: Language) -> list[str]:
    """Points by true class, a row each, and by the class that they were given."""
    rows = [[_MATRIX_HEAD.in_language(language), *map(str, matrix.codes)]]
    rows += [
        [str(code), *(f"{count:,}" for count in counts)]
        for code, counts in zip(matrix.codes, matrix.counts.tolist(), strict=True)
    ]
    return align_lines(rows)


def _share_json(share: ShareInterval) -> dict[str, object]:
    return {"points": int(share.hits), "of": int(share.of), "share": or_null(share.value)}
