"""Features of one kind as shapes seen from above, and which of them meet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Position

SAME_LEVEL_M = 0.5
"""Things whose heights differ more lie above each other: a bridge and the road below it."""


@dataclass(frozen=True)
class PlanShapes:
    """Features of one kind and geometry.

    Attributes
    ----------
    features : tuple of Feature
    shapes : (n,) object
        Shapely lines or polygons about ``origin``, with heights.
    origin : (2,) float64
        Easting and northing, m, project CRS.
    """

    features: tuple[Feature, ...]
    shapes: NDArray[np.object_]
    origin: Floats

    @staticmethod
    def of(features: Sequence[Feature]) -> PlanShapes:
        """Make the shapes; features with too few vertices for their geometry are left out."""
        least = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}
        whole = tuple(one for one in features if len(one.vertices) >= least[one.geometry])
        corners = [np.array([vertex.xyz for vertex in one.vertices]) for one in whole]
        origin = corners[0][0, :2].copy() if corners else np.zeros(2)
        shapes = np.empty(len(whole), dtype=object)
        for number, (one, positions) in enumerate(zip(whole, corners, strict=True)):
            near = positions - (*origin, 0.0)
            shapes[number] = _SHAPES[one.geometry](near)
        return PlanShapes(whole, shapes, origin)

    def meeting(self) -> tuple[Integers, Integers]:
        """Pairs that have a place in common in plan, each once."""
        tree = shapely.STRtree(self.shapes)
        one, other = tree.query(self.shapes, predicate="intersects")
        is_once = one < other
        return one[is_once], other[is_once]

    def position(self, x: float, y: float, height_m: float) -> Position:
        """A place of the shapes in the project's CRS."""
        return float(x + self.origin[0]), float(y + self.origin[1]), float(height_m)


def _area(corners: Floats) -> shapely.Polygon:
    return shapely.Polygon(corners)


_SHAPES = {
    Geometry.POINT: lambda corners: shapely.Point(corners[0]),
    Geometry.LINE: shapely.LineString,
    Geometry.AREA: _area,
}


def height_on(line: shapely.LineString, place: shapely.Point) -> float:
    """The height of a line at the place on it that is nearest in plan, m."""
    along = shapely.line_locate_point(shapely.force_2d(line), place)
    return float(shapely.get_z(shapely.line_interpolate_point(line, along)))
