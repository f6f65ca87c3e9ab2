"""Feet of walls and faces of buildings against a truth, by length within 5 cm in plan.

A true line is found by any result along it, whatever that says it is; what is made up counts as
what it says. Pieces that the points don't show are neither asked for nor held against the result,
nor are barriers and posts that stand as walls do (type ``other``).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.core.arrays import Flags, Integers
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
from processing.scoring.features.line_positions import PolylineIndex, middle_positions
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

WALLS: dict[str, dict[str, object]] = {
    "wall": {"type": "wall"},
    "wall_solid": {"type": "wall"},
    "revetment_concrete": {"type": "retaining"},
    "building_face": {"type": "building"},
}
"""Kinds of features that are walls or faces, and what they say of their type."""

BUILDING, OTHER = "building", "other"

TOLERANCE_M = 0.05
"""In plan: a tenth of a millimetre on a map of 1 : 500."""

LEAST_POINTS = 30
"""On a metre of a face up to 3 m above its foot, below which nothing could be said of it: some two
scan lines a metre apart."""

_LIMITS = ScoredLineLimits(TOLERANCE_M, 0.1, LEAST_POINTS, 0.3)
"""Counts are in decimetres."""

_WALLS = Text("feet of walls, in decimetres", "塀・擁壁の下端（延長、0.1 m単位）")
_FACES = Text("faces of buildings, in decimetres", "建物の壁面（延長、0.1 m単位）")
_NAME = Text("walls", "塀・擁壁・建物の壁面")


def wall_score(result: MappedFile, truth: MappedFile) -> FileScore:
    """Score walls.

    Raises
    ------
    BadFile
        Features aren't lines of walls.
    """
    found = result.of_kinds(WALLS, "line", _NAME)
    every = truth.of_kinds(WALLS, "line", _NAME)
    true = [one for one in every if one.facts.get("type") != OTHER]
    others = [one for one in every if one.facts.get("type") == OTHER]
    places = asked_places(true, _LIMITS)
    near = PolylineIndex([one.xyz for one in found]).nearest(places.xyz, TOLERANCE_M)
    is_near = near.line >= 0
    is_face = _is_building(true, places.line)
    is_false = made_up_places(found, (true, places), others, _LIMITS)
    of_false = _made_up_faces(found, is_false)
    counts = [
        _counts(is_near[chosen], places.is_asked[chosen], false)
        for chosen, false in zip((~is_face, is_face), of_false, strict=True)
    ]
    chosen = is_near & places.is_asked
    return FileScore(
        "walls",
        (
            DetectionCounts("walls", _WALLS, counts[0]),
            DetectionCounts("faces", _FACES, counts[1]),
        ),
        shares=(
            named_share(
                "type", ("type is right", "種類の正解"), *_same_type(found, true, near.line, places)
            ),
        ),
        errors=(
            errors_of("off", ("distance to the line", "線までの距離"), "m", near.off_m[chosen]),
            errors_of("height", ("height", "高さ"), "m", _heights(found, true, near.line, places)),
        ),
        left_out={"unseen": int((~places.is_asked).sum())},
        limits={"tolerance_m": TOLERANCE_M},
    )


def _is_building(lines: Sequence[MappedFeature], owner: Integers) -> Flags:
    flags = np.array([one.facts.get("type") == BUILDING for one in lines], np.bool_)
    return flags[owner] if len(flags) else np.empty(0, np.bool_)


def _counts(is_near: Flags, is_asked: Flags, false: int) -> BinaryConfusionMatrix:
    hits, missed = int((is_near & is_asked).sum()), int((~is_near & is_asked).sum())
    return BinaryConfusionMatrix(hits, false, missed, 0)


def _made_up_faces(found: Sequence[MappedFeature], is_false: Flags) -> tuple[int, int]:
    """Decimetres made up as walls and as faces of buildings."""
    sizes = [len(middle_positions(one.xyz, _LIMITS.step_m)) for one in found]
    owner = np.repeat(np.arange(len(found)), sizes).astype(np.int64)
    is_face = _is_building(found, owner)
    return int((is_false & ~is_face).sum()), int((is_false & is_face).sum())


def _same_type(
    found: Sequence[MappedFeature],
    true: Sequence[MappedFeature],
    partner: Integers,
    places: AskedPlaces,
) -> tuple[int, int]:
    """Found places whose line says the right type, and how many there are."""
    chosen = np.flatnonzero((partner >= 0) & places.is_asked)
    right = [
        found[partner[k]].facts.get("type") == true[places.line[k]].facts.get("type")
        for k in chosen.tolist()
    ]
    return sum(right), len(right)


def _heights(
    found: Sequence[MappedFeature],
    true: Sequence[MappedFeature],
    partner: Integers,
    places: AskedPlaces,
) -> list[float]:
    """Found heights of walls minus true ones, once for each pair of lines."""
    chosen = (partner >= 0) & places.is_asked
    pairs = set(zip(partner[chosen].tolist(), places.line[chosen].tolist(), strict=True))
    off = []
    for a, b in sorted(pairs):
        one, other = found[a].facts.get("height_m"), true[b].facts.get("height_m")
        is_wall = BUILDING not in (found[a].facts.get("type"), true[b].facts.get("type"))
        if is_wall and isinstance(one, int | float) and isinstance(other, int | float):
            off.append(float(one) - float(other))
    return off
