"""Symbols of points as shapes that any drawing can hold: closed and open lines, circles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from xml.etree import ElementTree as ET

from processing.map.feature import Feature
from resources import path_of

_SVG = "{http://www.w3.org/2000/svg}"
_DIRECTIONS = ("direction_deg", "facing_deg")


@dataclass(frozen=True)
class SymbolShape:
    """A line, or a circle around its only point where it has a radius.

    Attributes
    ----------
    points : tuple of (float, float)
        East and north of the symbol's place in metres on the ground at 1:500; what has a
        direction looks north.
    radius : float
        m; 0 for lines.
    """

    points: tuple[tuple[float, float], ...]
    is_closed: bool = False
    radius: float = 0.0


@cache
def symbol_shapes(symbol: str) -> tuple[SymbolShape, ...]:
    """The lines, polylines, polygons and circles of ``resources/symbols/<symbol>.svg``."""
    # The file comes with the program.
    root = ET.parse(path_of(f"symbols/{symbol}.svg")).getroot()  # noqa: S314
    return tuple(shape for element in root.iter() for shape in _shapes_of(element))


def _shapes_of(element: ET.Element) -> Iterator[SymbolShape]:
    """A shape of the SVG, whose y axis looks south."""
    match element.tag.removeprefix(_SVG):
        case "circle":
            x, y, radius = (float(element.attrib[key]) for key in ("cx", "cy", "r"))
            yield SymbolShape(((x, -y),), radius=radius)
        case "line":
            x1, y1, x2, y2 = (float(element.attrib[key]) for key in ("x1", "y1", "x2", "y2"))
            yield SymbolShape(((x1, -y1), (x2, -y2)))
        case "polyline" | "polygon" as tag:
            pairs = [pair.split(",") for pair in element.attrib["points"].split()]
            points = tuple((float(x), -float(y)) for x, y in pairs)
            yield SymbolShape(points, is_closed=tag == "polygon")


def symbol_rotation_deg(feature: Feature) -> float:
    """Counter-clockwise from the symbol's own direction, north."""
    for name in _DIRECTIONS:
        direction = feature.attributes.get(name)
        if isinstance(direction, (int, float)) and math.isfinite(direction):
            return -float(direction) % 360.0
    return 0.0
