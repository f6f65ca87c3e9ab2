"""The drawing that comes with the sample street."""

from __future__ import annotations

import json
from dataclasses import dataclass

from processing.map.feature import Position
from resources import path_of

_DRAWING = "sample_street/drawing.json"


@dataclass(frozen=True)
class SampleFeature:
    """One feature: its kind, the name of its drive, where its vertices should be."""

    kind: str
    drive: str
    positions: tuple[Position, ...]


def read_sample_drawing() -> tuple[SampleFeature, ...]:
    """All features of the drawing."""
    stored = json.loads(path_of(_DRAWING).read_text(encoding="utf-8"))
    return tuple(
        SampleFeature(one["kind"], one["drive"], tuple((x, y, z) for x, y, z in one["places"]))
        for one in stored["features"]
    )
