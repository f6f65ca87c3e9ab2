"""Edges of the carriageway without a step against a truth, by length within 10 cm in plan.

What lies outside of a found stretch is judged apart. Neither asked for nor held against the result
are pieces that the points don't show on both sides, and what is type ``other``: the asphalt's edge
in front of a gutter with a curb behind, feet of curbs that are lowered to the road, and corners of
side streets.
"""

from __future__ import annotations

from processing.core.text import Text
from processing.scoring.features.asked_lines import ScoredLineLimits
from processing.scoring.features.file_scores import FileScore, errors_of
from processing.scoring.features.mapped_features import MappedFile
from processing.scoring.features.typed_lines import typed_lines

EDGES: dict[str, dict[str, object]] = {"road_edge": {}, "sidewalk": {"type": "walk"}}
"""Kinds of features that are edges of the carriageway, and what they say of what lies outside."""

TOLERANCE_M = 0.1
"""In plan: a fifth of a millimetre on a map of 1 : 500."""

STEP_M = 0.1
"""Between judged places; counts are in decimetres."""

LEAST_POINTS = 20
"""On a metre of the 30 cm on either side of an edge, below which nothing could be said of it."""

_BESIDE_M = 0.3
"""A result so near to what isn't asked for isn't judged."""

LIMITS = ScoredLineLimits(TOLERANCE_M, STEP_M, LEAST_POINTS, _BESIDE_M)
_NAME = Text("edges of the carriageway", "車道の縁")


def edge_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score edges of the carriageway.

    Raises
    ------
    BadFile
        Features aren't edges of the carriageway.
    """
    judged = typed_lines(result, truth, EDGES, _NAME, LIMITS)
    near, places, is_hit = judged.near, judged.places, judged.is_hit
    return FileScore(
        "edges",
        (judged.counts,),
        shares=(judged.types,),
        errors=(
            errors_of("off", ("distance to the line", "線までの距離"), "m", near.off_m[is_hit]),
            errors_of(
                "height",
                ("height", "高さ"),
                "m",
                (near.xyz[is_hit] - places.xyz[is_hit])[:, 2],
            ),
        ),
        left_out={"unseen": judged.unseen},
        limits={"tolerance_m": TOLERANCE_M, "least_points_per_m": LEAST_POINTS},
    )
