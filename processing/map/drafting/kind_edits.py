"""Edits that change what a feature is: its kind, a line closed, an area opened."""

from __future__ import annotations

import dataclasses

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.map.catalogue import FeatureKind, Geometry
from processing.map.drafting.edited_features import check_line, gap_m, name_feature
from processing.map.drafting.polyline import SAME_POSITION_M
from processing.map.feature import Feature, Vertex

_LEAST_OF_RING = 3


def with_kind(feature: Feature, kind: FeatureKind) -> Feature:
    """The feature as another kind.

    Attributes that the new kind has too are kept. A line becomes an area when it has three places
    and more; an area becomes a line that returns to its first vertex.

    Raises
    ------
    Unsuitable
        The geometry can't become that of the kind.
    """
    attributes = {
        name: value
        for name, value in feature.attributes.items()
        if kind.attribute(name) is not None
    }
    vertices = _as_geometry(feature, kind)
    return dataclasses.replace(
        feature, kind=kind.id, geometry=kind.geometry, vertices=vertices, attributes=attributes
    )


def close_line(feature: Feature, kind: FeatureKind) -> Feature:
    """A line closed: an area where the kind is one, else a line that returns to its first vertex.

    Parameters
    ----------
    kind : FeatureKind
        The feature's own, or the one it becomes.

    Raises
    ------
    Unsuitable
        It is no line, or has fewer than three places.
    """
    check_line(feature)
    ring = _ring_of(feature)
    if kind.geometry is Geometry.AREA:
        return with_kind(feature, kind)
    return with_kind(feature, kind).with_vertices((*ring, ring[0]))


def open_area(feature: Feature, kind: FeatureKind, vertex: int = 0) -> Feature:
    """An area, or a line that returns to its first vertex, as a line without its closing side.

    Parameters
    ----------
    kind : FeatureKind
        The kind of line that it becomes.
    vertex : int
        Where the line begins; the side that leads to this vertex is left out.

    Raises
    ------
    Unsuitable
        The kind is no line, or the feature is not closed.
    """
    if feature.geometry is Geometry.AREA:
        ring = feature.vertices
    else:
        check_line(feature)
        ring = feature.vertices[:-1]
        if len(ring) < 2 or gap_m(feature.vertices[0], feature.vertices[-1]) > SAME_POSITION_M:
            raise Unsuitable(
                Text("This line is not closed.", "この線は閉じていません。"),
                name_feature(feature),
                Text("Choose an area or a closed line.", "面または閉じた線を選んでください。"),
            )
    if kind.geometry is not Geometry.LINE:
        raise _wrong_kind(feature, kind)
    start = vertex % len(ring)
    line = with_kind(feature, kind)
    return line.with_vertices((*ring[start:], *ring[:start]))


def _as_geometry(feature: Feature, kind: FeatureKind) -> tuple[Vertex, ...]:
    change = (feature.geometry, kind.geometry)
    if feature.geometry is kind.geometry:
        return feature.vertices
    if change == (Geometry.LINE, Geometry.AREA):
        return _ring_of(feature)
    if change == (Geometry.AREA, Geometry.LINE):
        return (*feature.vertices, feature.vertices[0])
    raise _wrong_kind(feature, kind)


def _ring_of(feature: Feature) -> tuple[Vertex, ...]:
    """The vertices of a line as those of a ring: its first not repeated."""
    vertices = feature.vertices
    if len(vertices) > 1 and gap_m(vertices[0], vertices[-1]) <= SAME_POSITION_M:
        vertices = vertices[:-1]
    if len({vertex.xyz for vertex in vertices}) < _LEAST_OF_RING:
        raise Unsuitable(
            Text(
                "A line of fewer than three places can't be closed.",
                "頂点が3点未満の線は閉じられません。",
            ),
            name_feature(feature),
            Text("Add vertices to the line first.", "先に頂点を追加してください。"),
        )
    return vertices


def _wrong_kind(feature: Feature, kind: FeatureKind) -> Unsuitable:
    names = {
        Geometry.POINT: Text("a point", "点"),
        Geometry.LINE: Text("a line", "線"),
        Geometry.AREA: Text("an area", "面"),
    }
    return Unsuitable(
        Text(
            "What is drawn as {old} can't become “{kind}”, which is {new}.",
            "{old}として描いた地物を、{new}の種別「{kind}」に変更することはできません。",
        ).filled(old=names[feature.geometry], new=names[kind.geometry], kind=kind.name),
        name_feature(feature),
        Text(
            "Choose a kind of the same geometry, or draw it anew.",
            "同じ図形種類の種別を選ぶか、描き直してください。",
        ),
    )
