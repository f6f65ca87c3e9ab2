"""Road markings against a truth: lines by length within 3 cm, bars of crossings one by one.

A broken line is one line with its gaps. What the points don't show, and arrows, letters and other
figures, are neither asked for nor held against the result.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.text import Text
from processing.scoring.features.asked_lines import (
    AskedPlaces,
    ScoredLineLimits,
    asked_places,
    is_seen,
    made_up_places,
)
from processing.scoring.features.file_scores import (
    DetectionCounts,
    FileScore,
    errors_of,
    named_share,
)
from processing.scoring.features.line_positions import PolylineIndex, length_m
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.one_to_one import pairs_within
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

MARKINGS: dict[str, dict[str, object]] = {
    "marking_line": {},
    "stop_line": {"type": "stop_line"},
    "crosswalk_bar": {"type": "crosswalk_bar"},
}
"""Kinds of features that are markings, and what they say of their type."""

BAR, OTHER = "crosswalk_bar", "other"

TOLERANCE_M = 0.03
"""In plan, from middle to middle: a tenth of a millimetre on a map of 1 : 250."""

BAR_TOLERANCE_M = 0.2
"""Between the middles of bars, whose ends are worn."""

STEP_M = 0.1
"""Between judged places; counts are in decimetres."""

LEAST_POINTS = 10
"""On a metre of paint, below which nothing could be said of it."""

_BESIDE_M = 0.3
"""A result so near to what isn't asked for isn't judged."""

_LINES = Text("lines, in decimetres", "線（延長、0.1 m単位）")
_BARS = Text("bars of crossings", "横断歩道の縞")
_NAME = Text("road markings", "路面標示")


_LIMITS = ScoredLineLimits(TOLERANCE_M, STEP_M, LEAST_POINTS, _BESIDE_M)


def marking_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score markings.

    Raises
    ------
    BadFile
        Features aren't lines of markings.
    """
    found = result.of_kinds(MARKINGS, "line", _NAME)
    true = truth.of_kinds(MARKINGS, "line", _NAME)
    found_bars, found_lines = _split(found)
    bars, lines = _split([one for one in true if one.facts.get("type") != OTHER])
    others = [one for one in true if one.facts.get("type") == OTHER]
    places = asked_places(lines, _LIMITS)
    index = PolylineIndex([one.xyz for one in found_lines])
    near = index.nearest(places.xyz, TOLERANCE_M)
    is_near = near.line >= 0
    hits = int((is_near & places.is_asked).sum())
    missed = int((~is_near & places.is_asked).sum())
    made_up = int(made_up_places(found_lines, (lines, places), others, _LIMITS).sum())
    of_kind = _same_type(found_lines, lines, near.line, places)
    bar_counts, unseen_bars = _bars(found_bars, bars)
    off = near.off_m[is_near & places.is_asked]
    return FileScore(
        "markings",
        (
            DetectionCounts("lines", _LINES, BinaryConfusionMatrix(hits, made_up, missed, 0)),
            DetectionCounts("bars", _BARS, bar_counts),
        ),
        shares=(named_share("type", ("type is right", "種類の正解"), *of_kind),),
        errors=(
            errors_of("off", ("distance to the middle", "中心線までの距離"), "m", off),
            errors_of("width", ("width", "幅"), "m", _widths(result, truth, near.line, places)),
        ),
        left_out={"unseen": int((~places.is_asked).sum()), "unseen_bars": unseen_bars},
        limits={"tolerance_m": TOLERANCE_M, "bar_tolerance_m": BAR_TOLERANCE_M},
    )


def _split(
    features: Sequence[MappedFeature],
) -> tuple[list[MappedFeature], list[MappedFeature]]:
    """Bars, and lines; a result's other figures are neither."""
    bars = [one for one in features if one.facts.get("type") == BAR]
    return bars, [one for one in features if one.facts.get("type") not in (BAR, OTHER)]


def _same_type(
    found: Sequence[MappedFeature],
    lines: Sequence[MappedFeature],
    partner: Integers,
    places: AskedPlaces,
) -> tuple[int, int]:
    """Found places whose line says the right type, and how many there are."""
    chosen = np.flatnonzero((partner >= 0) & places.is_asked)
    right = [
        found[partner[k]].facts.get("type") == lines[places.line[k]].facts.get("type")
        for k in chosen.tolist()
    ]
    return sum(right), len(right)


def _widths(
    result: MappedFile, truth: MappedFile, partner: Integers, places: AskedPlaces
) -> list[float]:
    """Found widths minus true ones, once for each pair of lines."""
    found = result.of_kinds(MARKINGS, "line", _NAME)
    true = truth.of_kinds(MARKINGS, "line", _NAME)
    found_lines = _split(found)[1]
    lines = _split([one for one in true if one.facts.get("type") != OTHER])[1]
    chosen = (partner >= 0) & places.is_asked
    pairs = set(zip(partner[chosen].tolist(), places.line[chosen].tolist(), strict=True))
    return [
        result.number(found_lines[a], "width_m") - truth.number(lines[b], "width_m")
        for a, b in sorted(pairs)
    ]


def _bars(
    found: Sequence[MappedFeature], bars: Sequence[MappedFeature]
) -> tuple[BinaryConfusionMatrix, int]:
    """Bars paired by their middles; those that the points don't show for the most part are left."""
    asked = np.array(
        [
            is_seen(one, max(1, round(length_m(one.xyz) / STEP_M)), LEAST_POINTS).mean() > 0.5
            for one in bars
        ],
        np.bool_,
    )
    of_result, of_truth = pairs_within(_middles(found), _middles(bars), BAR_TOLERANCE_M)
    hits = int(asked[of_truth].sum())
    paired = set(of_result.tolist())
    unseen = [one for one, is_asked in zip(bars, asked.tolist(), strict=True) if not is_asked]
    beside = PolylineIndex([one.xyz for one in unseen])
    alone = [one for k, one in enumerate(found) if k not in paired]
    made_up = [one for one in alone if (beside.nearest(_middles([one]), _BESIDE_M).line < 0).all()]
    return BinaryConfusionMatrix(hits, len(made_up), int(asked.sum()) - hits, 0), len(unseen)


def _middles(features: Sequence[MappedFeature]) -> Floats:
    """(n, 3) float64 with height 0: bars are paired in plan."""
    places = np.array([(one.xyz[0] + one.xyz[-1]) / 2 for one in features]).reshape(-1, 3)
    places[:, 2] = 0.0
    return places
