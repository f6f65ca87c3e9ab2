"""What edits ask of the features they are given."""

from __future__ import annotations

import numpy as np

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.drafting.polyline import name_position
from processing.map.feature import Feature, Vertex


def check_line(feature: Feature) -> None:
    """Raise `Unsuitable` for what is no line with at least one side."""
    if feature.geometry is not Geometry.LINE or len(feature.vertices) < 2:
        raise Unsuitable(
            Text("Only lines can be edited like this.", "この編集は線にのみ行えます。"),
            name_feature(feature),
            Text("Choose a line.", "線を選んでください。"),
        )


def gap_m(one: Vertex, other: Vertex) -> float:
    """Distance of two vertices in space, m."""
    return float(np.linalg.norm(np.subtract(one.xyz, other.xyz)))


def name_feature(feature: Feature) -> Text:
    """Where a message about a feature is."""
    return name_position(feature.vertices[0].xyz)
