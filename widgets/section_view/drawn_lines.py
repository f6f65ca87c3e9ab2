"""What of the map crosses a section, as the profile takes it: plain lines with names."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from processing.core.text import Text
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Feature, Status
from processing.section.profile import DrawnLine

_UNKNOWN_LAYER, _UNKNOWN_ACI = "0", 7


def drawn_lines(features: Iterable[Feature], catalogue: Catalogue) -> tuple[DrawnLine, ...]:
    """The features that nobody rejected, by the layer and the colour of their kind."""
    return tuple(
        _line_of(feature, catalogue)
        for feature in features
        if feature.status is not Status.REJECTED
    )


def _line_of(feature: Feature, catalogue: Catalogue) -> DrawnLine:
    name, layer, aci = Text.same(feature.kind), _UNKNOWN_LAYER, _UNKNOWN_ACI
    if feature.kind in catalogue:
        kind = catalogue[feature.kind]
        name, layer, aci = kind.name, kind.layer, kind.aci
    positions = np.array([vertex.xyz for vertex in feature.vertices])
    return DrawnLine(name, layer, aci, positions, is_closed=feature.geometry is Geometry.AREA)
