"""What a feature's geometry tells: length, area, height difference, number of vertices."""

from __future__ import annotations

import math
from itertools import pairwise

from PySide6.QtCore import QLocale

from processing.core.text import Language, Text
from processing.map.catalogue import Geometry
from processing.map.feature import Feature
from widgets.parts.number_field import coordinate

_LENGTH = Text("Length", "延長")
_PERIMETER = Text("Perimeter", "周長")
_AREA = Text("Area in plan", "水平面積")
_RISE = Text("Height difference", "比高")
_VERTICES = Text("Vertices", "頂点数")
_OWN_POINTS = Text("Own points", "構成点数")
_AXES = (Text.same("E"), Text.same("N"), Text.same("H"))


def facts_of(feature: Feature, language: Language = "en") -> tuple[tuple[Text, str], ...]:
    """Names and values with units, in the order in which they are shown."""
    locale = QLocale(language)
    if feature.geometry is Geometry.POINT:
        values = feature.vertices[0].xyz if feature.vertices else ()
        places = [(ax, f"{coordinate(value)} m") for ax, value in zip(_AXES, values, strict=False)]
        return (*places, *_own(feature, locale))
    is_area = feature.geometry is Geometry.AREA
    length = locale.toString(length_m(feature), "f", 3)
    facts = [(_PERIMETER if is_area else _LENGTH, f"{length} m")]
    if is_area:
        facts.append((_AREA, f"{locale.toString(area_m2(feature), 'f', 3)} m²"))
    heights = [vertex.xyz[2] for vertex in feature.vertices]
    rise_m = max(heights) - min(heights) if heights else 0.0
    facts.append((_RISE, f"{locale.toString(rise_m, 'f', 3)} m"))
    facts.append((_VERTICES, locale.toString(len(heights))))
    return (*facts, *_own(feature, locale))


def _own(feature: Feature, locale: QLocale) -> tuple[tuple[Text, str], ...]:
    """How many measured points it consists of, where that is known."""
    count = sum(one.count for one in feature.own_points)
    return ((_OWN_POINTS, locale.toString(count)),) if count else ()


def length_m(feature: Feature) -> float:
    """Length in space of a line, perimeter of an area; 0 for a point.

    In plain numbers, not arrays: a table asks for a hundred thousand short lines at a time.
    """
    positions = [vertex.xyz for vertex in feature.vertices]
    length = sum(map(math.dist, positions, positions[1:]))
    if feature.geometry is Geometry.AREA and positions:
        length += math.dist(positions[-1], positions[0])
    return length


def area_m2(feature: Feature) -> float:
    """Area in plan of the ring, never negative; 0 for less than three vertices.

    The shoelace formula about the first vertex, so that large coordinates don't cost digits.
    """
    if len(feature.vertices) < 3:
        return 0.0
    east, north, _ = feature.vertices[0].xyz
    ring = [(vertex.xyz[0] - east, vertex.xyz[1] - north) for vertex in feature.vertices]
    return abs(sum(x * next_y - next_x * y for (x, y), (next_x, next_y) in pairwise(ring))) / 2
