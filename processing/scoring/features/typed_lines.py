"""Lines that have types: which places of a truth a result shows, and whether as what they are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from processing.core.arrays import Flags
from processing.core.text import Text
from processing.scoring.features.asked_lines import (
    AskedPlaces,
    ScoredLineLimits,
    asked_places,
    made_up_places,
)
from processing.scoring.features.file_scores import DetectionCounts, named_share
from processing.scoring.features.line_positions import NearestPositions, PolylineIndex
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.scoring.points.point_scores import NamedShare

OTHER = "other"
"""Type of true lines that are neither asked for nor held against a result."""

_LINES = Text("lines, in decimetres", "線（延長、0.1 m単位）")


@dataclass(frozen=True)
class TypedLines:
    """What is known of the lines of a result.

    Attributes
    ----------
    found, lines : sequence of MappedFeature
        The result's, and the true ones that are asked for.
    places : AskedPlaces
        Along the true ones.
    near : NearestPositions
        What of the result is near to each place.
    is_hit : (n,) bool
        Which of the places that are asked for the result has.
    counts : DetectionCounts
        In steps along the lines.
    types : NamedShare
        How many of the places hit are of the right type.
    """

    found: Sequence[MappedFeature]
    lines: Sequence[MappedFeature]
    places: AskedPlaces
    near: NearestPositions
    is_hit: Flags
    counts: DetectionCounts
    types: NamedShare

    @property
    def unseen(self) -> int:
        """Places that the points don't show."""
        return int((~self.places.is_asked).sum())


def typed_lines(
    result: MappedFile,
    truth: MappedFile,
    kinds: Mapping[str, Mapping[str, object]],
    name: Text,
    limits: ScoredLineLimits,
) -> TypedLines:
    """Hold lines of some kinds against true ones, place by place.

    Raises
    ------
    BadFile
        Features aren't lines of these kinds.
    """
    found, true = (one.of_kinds(kinds, "line", name) for one in (result, truth))
    lines = [one for one in true if one.facts.get("type") != OTHER]
    others = [one for one in true if one.facts.get("type") == OTHER]
    places = asked_places(lines, limits)
    near = PolylineIndex([one.xyz for one in found]).nearest(places.xyz, limits.tolerance_m)
    is_hit: Flags = (near.line >= 0) & places.is_asked
    missed = int(((near.line < 0) & places.is_asked).sum())
    made_up = int(made_up_places(found, (lines, places), others, limits).sum())
    same = [
        found[a].facts.get("type") == lines[b].facts.get("type")
        for a, b in zip(near.line[is_hit].tolist(), places.line[is_hit].tolist(), strict=True)
    ]
    return TypedLines(
        found,
        lines,
        places,
        near,
        is_hit,
        DetectionCounts(
            "lines", _LINES, BinaryConfusionMatrix(int(is_hit.sum()), made_up, missed, 0)
        ),
        named_share("type", ("type is right", "種類の正解"), sum(same), len(same)),
    )
