"""Edits of drawn lines and areas as values: a feature in, a feature out.

A vertex that stays where it is stays as it is, with the measured point it rests on; id, kind,
attributes, status and provenance stay too, but for what an edit is about.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.drafting.edited_features import check_line, gap_m
from processing.map.drafting.kind_edits import close_line, open_area, with_kind
from processing.map.drafting.line_joins import extend_to, join, trim_at
from processing.map.drafting.polyline import SAME_POSITION_M, name_position
from processing.map.drafting.simplification import kept_positions
from processing.map.feature import Feature, Position, Vertex, new_feature_id

__all__ = [
    "close_line",
    "extend_to",
    "join",
    "move_feature",
    "open_area",
    "reverse_line",
    "simplify_line",
    "split_line",
    "trim_at",
    "with_kind",
]


def split_line(feature: Feature, segment: int, position: Vertex) -> tuple[Feature, Feature]:
    """Cut an open line into two.

    Parameters
    ----------
    segment : int
        The side from vertex ``segment`` to the next.
    position : Vertex
        Where on it; the vertex itself is taken where one lies within a millimetre.

    Returns
    -------
    tuple of Feature
        The first keeps the id, the second gets a new one; both end at the place.

    Raises
    ------
    Unsuitable
        It is no open line, or the place is one of its ends.
    """
    check_line(feature)
    vertices = feature.vertices
    if not 0 <= segment < len(vertices) - 1:
        message = f"side {segment} of a line of {len(vertices)} vertices"
        raise IndexError(message)
    for corner in (segment, segment + 1):
        if gap_m(vertices[corner], position) <= SAME_POSITION_M:
            first, second = vertices[: corner + 1], vertices[corner:]
            break
    else:
        first = (*vertices[: segment + 1], position)
        second = (position, *vertices[segment + 1 :])
    if min(len(first), len(second)) < 2:
        raise Unsuitable(
            Text("A line can't be split at its end.", "線の端点では分割できません。"),
            name_position(position.xyz),
            Text("Choose a place inside the line.", "線の途中の位置を指定してください。"),
        )
    kept = feature.with_vertices(first)
    return kept, dataclasses.replace(feature, id=new_feature_id(), vertices=second)


def reverse_line(feature: Feature) -> Feature:
    """The same line or area drawn the other way round."""
    return feature.with_vertices(feature.vertices[::-1])


def simplify_line(feature: Feature, tolerance_m: float) -> Feature:
    """A line or area with as few of its vertices as a tolerance allows.

    See :func:`processing.map.drafting.simplification.kept_positions`; a point stays as it is.
    """
    kept = kept_positions(
        [vertex.xyz for vertex in feature.vertices],
        tolerance_m,
        is_closed=feature.geometry is Geometry.AREA,
    )
    return feature.with_vertices(tuple(feature.vertices[position] for position in kept))


def move_feature(feature: Feature, by: Position) -> Feature:
    """A feature in another place; its vertices no longer rest on measured points.

    Parameters
    ----------
    by : Position
        Easting, northing, height to add, m.
    """
    if not any(by):
        return feature
    return feature.with_vertices(tuple(_move_vertex(vertex, by) for vertex in feature.vertices))


def _move_vertex(vertex: Vertex, by: Position) -> Vertex:
    east, north, height = (float(value) for value in np.add(vertex.xyz, by))
    return dataclasses.replace(vertex, xyz=(east, north, height), measured=None)
