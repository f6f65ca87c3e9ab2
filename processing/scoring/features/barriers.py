"""Barriers against a truth: foot lines by length within 10 cm, their types apart.

What the points don't show, and barriers on walls, are neither asked for nor held against the
result.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.core.text import Text
from processing.scoring.features.asked_lines import (
    AskedPlaces,
    ScoredLineLimits,
    asked_places,
    made_up_places,
)
from processing.scoring.features.file_scores import (
    DetectionCounts,
    FileScore,
    errors_of,
    named_share,
)
from processing.scoring.features.line_positions import NearestPositions, PolylineIndex
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

BARRIERS: dict[str, dict[str, object]] = {
    "guard_rail": {"type": "guard_rail"},
    "guard_pipe": {"type": "guard_pipe"},
    "guard_cable": {"type": "guard_cable"},
    "fence": {"type": "fence"},
    "guard_wall": {"type": "parapet"},
    "noise_barrier": {"type": "noise_barrier"},
}
"""Kinds of features that are barriers, and what they say of their type."""

OTHER = "other"

TOLERANCE_M = 0.1
"""In plan, from foot to foot: a fifth of a millimetre on a map of 1 : 500."""

STEP_M = 0.1
"""Between judged places; counts are in decimetres."""

LEAST_POINTS = 10
"""On a metre, below which nothing could be said of it."""

_BESIDE_M = 0.5
"""A result so near to what isn't asked for isn't judged: a beam's depth and its error."""

_LIMITS = ScoredLineLimits(TOLERANCE_M, STEP_M, LEAST_POINTS, _BESIDE_M)
_LINES = Text("lines, in decimetres", "線（延長、0.1 m単位）")
_NAME = Text("barriers", "防護柵・柵")


def barrier_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score barriers.

    Raises
    ------
    BadFile
        Features aren't lines of barriers.
    """
    found = result.of_kinds(BARRIERS, "line", _NAME)
    true = truth.of_kinds(BARRIERS, "line", _NAME)
    lines = [one for one in true if one.facts.get("type") != OTHER]
    others = [one for one in true if one.facts.get("type") == OTHER]
    places = asked_places(lines, _LIMITS)
    near = PolylineIndex([one.xyz for one in found]).nearest(places.xyz, TOLERANCE_M)
    is_hit = (near.line >= 0) & places.is_asked
    hits, missed = int(is_hit.sum()), int(((near.line < 0) & places.is_asked).sum())
    made_up = int(made_up_places(found, (lines, places), others, _LIMITS).sum())
    same = [
        found[a].facts.get("type") == lines[b].facts.get("type")
        for a, b in zip(near.line[is_hit].tolist(), places.line[is_hit].tolist(), strict=True)
    ]
    apart = _differences((result, found), (truth, lines), near, places)
    return FileScore(
        "barriers",
        (DetectionCounts("lines", _LINES, BinaryConfusionMatrix(hits, made_up, missed, 0)),),
        shares=(named_share("type", ("type is right", "種類の正解"), sum(same), len(same)),),
        errors=(
            errors_of("off", ("distance to the foot", "下端線までの距離"), "m", near.off_m[is_hit]),
            errors_of("height", ("height", "高さ"), "m", apart["height_m"]),
            errors_of("posts", ("spacing of posts", "支柱間隔"), "m", apart["posts_m"]),
        ),
        left_out={"unseen": int((~places.is_asked).sum())},
        limits={"tolerance_m": TOLERANCE_M, "least_points_per_m": LEAST_POINTS},
    )


def _differences(
    result: tuple[MappedFile, Sequence[MappedFeature]],
    truth: tuple[MappedFile, Sequence[MappedFeature]],
    near: NearestPositions,
    places: AskedPlaces,
) -> dict[str, list[float]]:
    """Found measures minus true ones, once for each pair of lines that both tell them."""
    chosen = (near.line >= 0) & places.is_asked
    pairs = set(zip(near.line[chosen].tolist(), places.line[chosen].tolist(), strict=True))
    apart: dict[str, list[float]] = {"height_m": [], "posts_m": []}
    for a, b in sorted(pairs):
        for name, values in apart.items():
            off = result[0].number(result[1][a], name) - truth[0].number(truth[1][b], name)
            values += [off] if np.isfinite(off) else []
    return apart
