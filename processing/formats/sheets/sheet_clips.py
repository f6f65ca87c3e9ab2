"""Features and the parts of them that a sheet shows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
import shapely

from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Vertex


def shape_of(feature: Feature) -> shapely.Geometry:
    """A feature as a point, or as a line: of an area its outline; with heights."""
    positions = [vertex.xyz for vertex in feature.vertices]
    if feature.geometry is Geometry.POINT:
        return shapely.Point(positions[0])
    if feature.geometry is Geometry.AREA:
        positions.append(positions[0])
    if len({position[:2] for position in positions}) < 2:  # a line without length is a place
        return shapely.Point(positions[0])
    return shapely.LineString(positions)


class SheetClips:
    """Features that are cut at the windows of sheets.

    Parameters
    ----------
    features : sequence of Feature
    """

    def __init__(self, features: Sequence[Feature]) -> None:
        self.features = features
        self.shapes = [shape_of(feature) for feature in features]
        self._tree = shapely.STRtree(self.shapes)

    def within(self, window: shapely.Polygon) -> list[Feature]:
        """What a window shows, in the features' order.

        Features that are cut become a line for each part, an area's outline too; heights at the
        edge are interpolated.
        """
        shapely.prepare(window)
        found: list[Feature] = []
        for number in sorted(self._tree.query(window, predicate="intersects").tolist()):
            feature, shape = self.features[number], self.shapes[number]
            if shape.geom_type == "Point" or window.covers(shape):
                found.append(feature)
            else:
                found += _parts(feature, shape.intersection(window))
        return found


def _parts(feature: Feature, common: shapely.Geometry) -> Iterable[Feature]:
    lines = [one for one in shapely.get_parts(common) if one.geom_type == "LineString"]
    if not lines:
        return
    merged = shapely.line_merge(shapely.MultiLineString(lines))
    heights = [vertex.xyz for vertex in feature.vertices]
    for part in shapely.get_parts(merged):
        xyz = shapely.get_coordinates(part, include_z=True)
        if np.isnan(xyz[:, 2]).any():
            xyz[:, 2] = np.where(np.isnan(xyz[:, 2]), heights[0][2], xyz[:, 2])
        vertices = tuple(Vertex((x, y, z)) for x, y, z in xyz.tolist())
        yield replace(feature, geometry=Geometry.LINE, vertices=vertices)
