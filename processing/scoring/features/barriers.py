"""Barriers against a truth: foot lines by length within 10 cm, their types apart.

What the points don't show, and barriers on walls, are neither asked for nor held against the
result.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.core.text import Text
from processing.scoring.features.asked_lines import AskedPlaces, ScoredLineLimits
from processing.scoring.features.file_scores import FileScore, errors_of
from processing.scoring.features.line_positions import NearestPositions
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.typed_lines import typed_lines

BARRIERS: dict[str, dict[str, object]] = {
    "guard_rail": {"type": "guard_rail"},
    "guard_pipe": {"type": "guard_pipe"},
    "guard_cable": {"type": "guard_cable"},
    "fence": {"type": "fence"},
    "guard_wall": {"type": "parapet"},
    "noise_barrier": {"type": "noise_barrier"},
}
"""Kinds of features that are barriers, and what they say of their type."""

TOLERANCE_M = 0.1
"""In plan, from foot to foot: a fifth of a millimetre on a map of 1 : 500."""

STEP_M = 0.1
"""Between judged places; counts are in decimetres."""

LEAST_POINTS = 10
"""On a metre, below which nothing could be said of it."""

_BESIDE_M = 0.5
"""A result so near to what isn't asked for isn't judged: a beam's depth and its error."""

_LIMITS = ScoredLineLimits(TOLERANCE_M, STEP_M, LEAST_POINTS, _BESIDE_M)
_NAME = Text("barriers", "防護柵・柵")


def barrier_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score barriers.

    Raises
    ------
    BadFile
        Features aren't lines of barriers.
    """
    judged = typed_lines(result, truth, BARRIERS, _NAME, _LIMITS)
    near, places = judged.near, judged.places
    apart = _differences((result, judged.found), (truth, judged.lines), near, places)
    off = near.off_m[judged.is_hit]
    return FileScore(
        "barriers",
        (judged.counts,),
        shares=(judged.types,),
        errors=(
            errors_of("off", ("distance to the foot", "下端線までの距離"), "m", off),
            errors_of("height", ("height", "高さ"), "m", apart["height_m"]),
            errors_of("posts", ("spacing of posts", "支柱間隔"), "m", apart["posts_m"]),
        ),
        left_out={"unseen": judged.unseen},
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
