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
from processing.scoring.point_scores import PointScore
from processing.scoring.reliability import ShareInterval

_HEAD = (Text("positive class", "正例とするクラス"), *COUNTS_HEAD)
_KINDS_HEAD = (Text("kind", "種類"), Text("points", "点数"), Text("right", "正解率"))


def point_score_json(score: PointScore) -> dict[str, object]:
    """Every count and figure."""
    kinds: dict[str, dict[str, object]] = {}
    for one in score.kinds:
        kinds.setdefault(one.group, {})[str(one.kind)] = _share_json(one.right)
    return {
        "points": score.points,
        "classes": {one.id: counts_json(one.counts) for one in score.classes},
        "shares": {one.id: _share_json(one.share) for one in score.shares},
        "figures": {one.id: or_null(one.value) for one in score.figures},
        "kinds": kinds,
    }


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
    return lines


def _share_json(share: ShareInterval) -> dict[str, object]:
    return {"points": int(share.hits), "of": int(share.of), "share": or_null(share.value)}
