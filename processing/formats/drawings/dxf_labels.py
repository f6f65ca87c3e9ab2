"""Where a feature's name, number or height is written beside it, so that both can be read."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from processing.map.catalogue import FeatureKind, Geometry
from processing.map.feature import Feature, Position

LABEL_HEIGHT_M = 1.0
"""2 mm on paper at 1:500."""

_GAP_M = 1.0
_ABOVE_LINE_M = 0.4
_WORDS = ("name", "number")
_HEIGHT_SYMBOL = "spot_height"


@dataclass(frozen=True)
class Label:
    """Words, the place they are at, how they lie there.

    Attributes
    ----------
    align : str
        Name of an ezdxf ``TextEntityAlignment``: which part of the words is at ``position``.
    rotation_deg : float
        Counter-clockwise from east; words are never upside down.
    """

    words: str
    position: Position
    align: str
    rotation_deg: float = 0.0


def label_of(kind: FeatureKind, feature: Feature) -> Label | None:
    """The label of a feature: right of a point, above a line's middle, in the middle of an area."""
    words = _words(kind, feature)
    if not words:
        return None
    positions = [vertex.xyz for vertex in feature.vertices]
    match feature.geometry:
        case Geometry.POINT:
            x, y, z = positions[0]
            return Label(words, (x + _GAP_M, y, z), "MIDDLE_LEFT")
        case Geometry.LINE:
            position, rotation_deg = _above_middle(positions)
            return Label(words, position, "BOTTOM_CENTER", rotation_deg)
        case Geometry.AREA:
            count = len(positions)
            x, y, z = (math.fsum(one[axis] for one in positions) / count for axis in range(3))
            return Label(words, (x, y, z), "MIDDLE_CENTER")


def _words(kind: FeatureKind, feature: Feature) -> str:
    if kind.symbol == _HEIGHT_SYMBOL:
        return f"{feature.vertices[0].xyz[2]:.1f}"
    values = (feature.attributes.get(name) for name in _WORDS)
    return next((str(value) for value in values if value not in (None, "")), "")


def _above_middle(positions: Sequence[Position]) -> tuple[Position, float]:
    """The middle of the line's middle segment, moved to its upper side, and its direction."""
    at = (len(positions) - 1) // 2
    (x1, y1, z1), (x2, y2, z2) = positions[at], positions[at + 1]
    direction = math.atan2(y2 - y1, x2 - x1)
    if not -math.pi / 2 < direction <= math.pi / 2:
        direction += math.pi
    x = (x1 + x2) / 2 - _ABOVE_LINE_M * math.sin(direction)
    y = (y1 + y2) / 2 + _ABOVE_LINE_M * math.cos(direction)
    return (x, y, (z1 + z2) / 2), math.degrees(direction) % 360.0
