"""The score of a map or of volumes in words: tables on the terminal, an object in JSON."""

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
from processing.scoring.features.file_scores import ErrorStatistics, FileScore

_COUNTS_HEAD = (Text("counted", "評価対象"), *COUNTS_HEAD)
_ERRORS_HEAD = (
    Text("error", "誤差"),
    Text("number", "個数"),
    Text("mean", "平均"),
    Text("mean size", "絶対値の平均"),
    Text.same("RMS"),
    Text.same("95 %"),
    Text("largest", "最大"),
)
_LEFT_OUT = {
    "unseen": Text("not shown by the points, not asked for", "点群に写っていないもの（対象外）"),
    "unseen_found": Text(
        "of these found all the same, not counted", "うち検出されたもの（対象外）"
    ),
    "unseen_sections": Text(
        "2 m sections not shown by the points, not asked for", "点群に写っていない2m区間（対象外）"
    ),
    "unseen_slots": Text(
        "0.6 m slots not shown by the points, not asked for", "点群に写っていない0.6m区間（対象外）"
    ),
    "unseen_bars": Text(
        "bars of crossings not shown by the points, not asked for",
        "点群に写っていない横断歩道の縞（対象外）",
    ),
    "trunk_arc_too_short": Text(
        "trunks found but seen too little to be measured", "検出したが直径の評価対象外とした幹"
    ),
    "unmeasured_area_m2": Text("area the result left out, m²", "結果の未計測面積（㎡）"),
    "unrecorded_echoes": Text(
        "echoes that no packet holds, not asked for", "波形に記録されていないエコー（対象外）"
    ),
    "points_of_no_pulse": Text(
        "points of no pulse, counted as false", "該当パルスのない点（誤検出に計上）"
    ),
    "unseen_area_m2": Text("area no points show, m²", "点群に写っていない面積（㎡）"),
}


def file_score_json(score: FileScore) -> dict[str, object]:
    """Every count, figure and limit."""
    return {
        "classes": {
            one.id: counts_json(one.counts, has_rejections=one.has_rejections)
            for one in score.counts
        },
        "shares": {
            one.id: {
                "count": int(one.share.hits),
                "of": int(one.share.of),
                "share": or_null(one.share.value),
            }
            for one in score.shares
        },
        "errors": {one.id: _errors_json(one) for one in score.errors},
        "figures": {one.id: or_null(one.value) for one in score.figures},
        "left_out": dict(score.left_out),
        "limits": dict(score.limits),
    }


def _errors_json(errors: ErrorStatistics) -> dict[str, object]:
    return {
        "unit": errors.unit,
        "count": errors.count,
        "mean": or_null(errors.mean),
        "mean_abs": or_null(errors.mean_size),
        "rms": or_null(errors.rms),
        "p95": or_null(errors.within_95),
        "max": or_null(errors.largest),
    }


def file_score_lines(score: FileScore, tool: Text, language: Language) -> list[str]:
    """Lines for people."""
    lines = [tool.in_language(language)]
    if score.counts:
        rows = [[word.in_language(language) for word in _COUNTS_HEAD]]
        rows += [
            [
                one.name.in_language(language),
                *count_cells(one.counts, has_rejections=one.has_rejections),
            ]
            for one in score.counts
        ]
        lines += ["", *align_lines(rows)]
    shares = [
        [one.name.in_language(language), percent(one.share.value), so_many_of(one.share)]
        for one in score.shares
    ]
    shares += [[one.name.in_language(language), percent(one.value), ""] for one in score.figures]
    if shares:
        lines += ["", *align_lines(shares)]
    if score.errors:
        rows = [[word.in_language(language) for word in _ERRORS_HEAD]]
        rows += [_error_cells(one, language) for one in score.errors]
        lines += ["", *align_lines(rows)]
    left_out = [
        [_LEFT_OUT[name].in_language(language), f"{count:,}"]
        for name, count in score.left_out.items()
    ]
    if left_out:
        lines += ["", *align_lines(left_out)]
    return lines


def _error_cells(errors: ErrorStatistics, language: Language) -> list[str]:
    values = (
        errors.mean,
        errors.mean_size,
        errors.rms,
        errors.within_95,
        errors.largest,
    )
    name = f"{errors.name.in_language(language)} [{errors.unit}]"
    return [name, f"{errors.count:,}", *map(figure, values)]
