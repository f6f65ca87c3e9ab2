"""How wide the shoulder is: from the outermost line painted along the road to its edge."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import shapely

from processing.map.catalogue import FeatureKind, Geometry
from processing.map.feature import Feature
from processing.map.routes.road_widths import StationedRoute, plan_shape

_LINE_KINDS = frozenset({"marking_line"})

_WIDEST_M = 3.0
"""A shoulder is no wider (道路構造令 第8条: 0.5 to 2.5 m); farther in, paint parts lanes."""

_LEAST_M = 0.1
_NEAR_M = 1.5
"""From the centre line: nearer is its own marking."""


class ShoulderLines:
    """The lines painted along roads.

    Parameters
    ----------
    accepted : iterable of (FeatureKind, Feature)
        What is on the map.
    """

    def __init__(self, accepted: Iterable[tuple[FeatureKind, Feature]]) -> None:
        shapes = [
            shape
            for kind, feature in accepted
            if kind.id in _LINE_KINDS
            and feature.geometry is Geometry.LINE
            and (shape := plan_shape(feature)) is not None
        ]
        self._lines = shapely.STRtree(shapes)

    def width(
        self, line: StationedRoute, station_m: float, edge_m: float, *, is_left: bool
    ) -> float:
        """Of one side at a station whose edge lies so far from the centre line; NaN: none is."""
        if math.isnan(edge_m):
            return math.nan
        ray = shapely.LineString(line.ray(station_m, is_left=is_left))
        found = self._lines.query(ray, predicate="intersects")
        crossings = shapely.intersection(self._lines.geometries[found], ray)
        away = np.hypot(*(shapely.get_coordinates(crossings) - ray.coords[0]).T)
        inside = away[(away > _NEAR_M) & (away < edge_m - _LEAST_M) & (away > edge_m - _WIDEST_M)]
        return edge_m - float(inside.max()) if inside.size else math.nan
