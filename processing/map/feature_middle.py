"""The one place of a feature at which every view looks when the feature is judged."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import shapely

from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Vertex

_MIDDLE_SHARE = 0.25
"""A vertex counts as the middle of a line when it is at most this share of the length from it."""


def middle_of(feature: Feature) -> Vertex:
    """A place on the feature near its middle, a vertex where one is there.

    Returns
    -------
    Vertex
        Of a point, itself. Of a line, the measured vertex nearest to half its length, if it lies in
        the middle half of the line; else the place at half its length. Of an area, the
        middle of its ring, at the height of the plane through it; the vertex nearest to that where
        it is outside the ring.

    Raises
    ------
    ValueError
        The feature has no vertex.
    """
    if not feature.vertices:
        message = f"the feature {feature.id} has no vertex"
        raise ValueError(message)
    if feature.geometry is Geometry.POINT or len(feature.vertices) == 1:
        return feature.vertices[0]
    if feature.geometry is Geometry.LINE:
        return _middle_of_line(feature.vertices)
    return _middle_of_ring(feature.vertices)


def _middle_of_line(vertices: tuple[Vertex, ...]) -> Vertex:
    steps = [math.dist(one.xyz, other.xyz) for one, other in pairwise(vertices)]
    along = [0.0]
    for step in steps:
        along.append(along[-1] + step)
    half = along[-1] / 2
    within = 2 * half * _MIDDLE_SHARE
    near = [
        (abs(at - half), number)
        for number, (at, vertex) in enumerate(zip(along, vertices, strict=True))
        if vertex.measured is not None and abs(at - half) <= within
    ]
    if near:
        return vertices[min(near)[1]]
    for number, step in enumerate(steps):
        if along[number + 1] >= half and step > 0:
            share = (half - along[number]) / step
            start, end = vertices[number].xyz, vertices[number + 1].xyz
            x, y, z = (a + (b - a) * share for a, b in zip(start, end, strict=True))
            return Vertex((x, y, z))
    return vertices[0]


def _middle_of_ring(vertices: tuple[Vertex, ...]) -> Vertex:
    xyz = np.array([vertex.xyz for vertex in vertices])
    centre = xyz.mean(axis=0)
    local = xyz - centre
    ring = shapely.Polygon(local[:, :2]) if len(local) > 2 else shapely.LineString(local[:, :2])
    middle = np.array(ring.centroid.coords[0])
    if shapely.contains_xy(ring, *middle):
        design = np.column_stack([local[:, :2], np.ones(len(local))])
        slopes = np.linalg.lstsq(design, local[:, 2], rcond=None)[0]
        height = float(slopes @ np.array([*middle, 1.0]))
        x, y, z = (centre + np.array([*middle, height])).tolist()
        return Vertex((x, y, z))
    distances = np.hypot(*(local[:, :2] - middle).T)
    return vertices[int(distances.argmin())]
