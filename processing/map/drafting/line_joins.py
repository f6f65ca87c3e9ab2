"""Edits by which one line meets another: joined, extended, trimmed."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Literal

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.drafting.edited_features import check_line
from processing.map.drafting.plan_sides import crossing_fractions, meeting_pairs, nearest_fractions
from processing.map.drafting.polyline import SAME_POSITION_M, Polyline, end_direction, name_position
from processing.map.feature import Feature, Position, Vertex

LineEnd = Literal["start", "end"]


def join(features: Sequence[Feature], tolerance_m: float = 0.0) -> Feature:
    """Lines made one, end to end.

    1. Of all free ends of different lines, the two nearest are joined, then the next, until one
       line is left.
    2. It runs in the direction of the first given line.

    Parameters
    ----------
    features : sequence of Feature
        Lines of one kind; the first keeps its id, status and provenance. Attributes that it
        lacks are taken from the others.
    tolerance_m : float
        Ends nearer than this (never less than a millimetre) become one vertex: the one that
        rests on a measured point. Wider gaps become a straight side.

    Raises
    ------
    Unsuitable
        One of them is no line, or they are of different kinds.
    """
    for feature in features:
        check_line(feature)
    first = features[0]
    if any(feature.kind != first.kind for feature in features):
        raise Unsuitable(
            Text("Lines of different kinds can't be joined.", "種別の異なる線は連結できません。"),
            name_position(first.vertices[0].xyz),
            Text("Give them the same kind first.", "先に種別をそろえてください。"),
        )
    vertices: tuple[Vertex, ...] = ()
    for number, is_reversed in _order_of(features):
        own = features[number].vertices[:: -1 if is_reversed else 1]
        vertices = _append_vertices(vertices, own, max(tolerance_m, SAME_POSITION_M))
    attributes = dict(first.attributes)
    for feature in features[1:]:
        for name, value in feature.attributes.items():
            if attributes.get(name) is None:
                attributes[name] = value
    return dataclasses.replace(first, vertices=vertices, attributes=attributes)


def extend_to(line: Feature, target: Feature, end: LineEnd) -> Feature:
    """A line continued straight on to where it meets another line or area in plan.

    Parameters
    ----------
    target : Feature
        A line, an area, or the line itself.
    end : {"start", "end"}
        Which end goes on.

    Returns
    -------
    Feature
        With one vertex more; its height continues the slope of the line's last metre. The line
        itself where its end already lies on the target.

    Raises
    ------
    Unsuitable
        It is no line, or never meets the target.
    """
    check_line(line)
    if end == "start":
        turned = line.with_vertices(line.vertices[::-1])
        extended = extend_to(turned, turned if line.id == target.id else target, "end")
        return extended.with_vertices(extended.vertices[::-1])
    own = Polyline.of([vertex.xyz for vertex in line.vertices], origin=line.vertices[-1].xyz)
    sides = _polyline_of(target, line.vertices[-1].xyz).plan_sides
    if line.id == target.id:
        sides = sides[:-1]
    beyond = end_direction(own)
    if beyond is None or not len(sides):
        raise _never_meets(line.vertices[-1].xyz)
    if nearest_fractions(sides, np.zeros(2))[1].min() <= SAME_POSITION_M:
        return line
    direction, slope = beyond
    ray = np.broadcast_to(np.stack([np.zeros(2), direction]), sides.shape)
    ahead, across = crossing_fractions(ray, sides)
    meets = (ahead > 0) & (across >= 0) & (across <= 1)
    if not meets.any():
        raise _never_meets(line.vertices[-1].xyz)
    distance = float(ahead[meets].min())
    (position,) = own.positions(distance * np.append(direction, slope)[None])
    return line.with_vertices((*line.vertices, Vertex(position)))


def trim_at(line: Feature, target: Feature, keep_near: Position) -> Feature:
    """A line cut where it crosses another line or area in plan.

    Parameters
    ----------
    keep_near : Position
        The part nearest to this place stays: what lies between the crossings on both sides of it.

    Returns
    -------
    Feature
        Ends on the crossing; a vertex within a millimetre of it is used as it is.

    Raises
    ------
    Unsuitable
        It is no line, or the two don't cross inside it.
    """
    check_line(line)
    own = Polyline.of([vertex.xyz for vertex in line.vertices])
    cuts = _cuts(own, _polyline_of(target, line.vertices[0].xyz).plan_sides)
    fractions, distances = nearest_fractions(own.plan_sides, own.local(keep_near)[:2])
    side = int(distances.argmin())
    kept_at = side + float(fractions[side])
    start = max((cut for cut in cuts if cut <= kept_at), default=0.0)
    stop = min((cut for cut in cuts if cut > kept_at), default=float(len(line.vertices) - 1))
    if not cuts.size:
        raise Unsuitable(
            Text("The two lines don't cross.", "2本の線は交差していません。"),
            name_position(line.vertices[0].xyz),
            Text("Extend one of them first.", "先にどちらかの線を延長してください。"),
        )
    inner = line.vertices[int(start) + 1 : int(np.ceil(stop))]
    first, last = (_vertex_at(line, own, cut) for cut in (start, stop))
    return line.with_vertices((first, *inner, last))


def _order_of(features: Sequence[Feature]) -> list[tuple[int, bool]]:
    """The lines in the order in which they follow each other, and whether they are reversed."""
    ends = Polyline.of([feature.vertices[side].xyz for feature in features for side in (0, -1)]).xyz
    gaps = np.linalg.norm(ends[:, None] - ends[None], axis=2)
    partner: dict[int, int] = {}
    chain = list(range(len(features)))
    one, other = np.triu_indices(len(ends), 1)
    for pair in np.argsort(gaps[one, other], kind="stable"):
        a, b = int(one[pair]), int(other[pair])
        if a in partner or b in partner or chain[a // 2] == chain[b // 2]:
            continue
        partner[a], partner[b] = b, a
        merged, gone = chain[a // 2], chain[b // 2]
        chain = [merged if number == gone else number for number in chain]
    # Ends are numbered 2 line + 0 or 1; a walk enters a line at one and leaves at the other.
    entry = next(end for end in range(len(ends)) if end not in partner)
    order: list[tuple[int, bool]] = []
    while True:
        order.append((entry // 2, entry % 2 == 1))
        leaving = entry ^ 1
        if leaving not in partner:
            break
        entry = partner[leaving]
    runs_back = next(is_reversed for number, is_reversed in order if number == 0)
    return [(number, not flip) for number, flip in reversed(order)] if runs_back else order


def _append_vertices(
    vertices: tuple[Vertex, ...], more: tuple[Vertex, ...], tolerance_m: float
) -> tuple[Vertex, ...]:
    if not vertices:
        return more
    end, start = vertices[-1], more[0]
    if np.linalg.norm(np.subtract(end.xyz, start.xyz)) > tolerance_m:
        return (*vertices, *more)
    takes_start = end.measured is None and (start.measured is not None or end.is_occluded)
    return (*vertices[:-1], start if takes_start else end, *more[1:])


def _polyline_of(feature: Feature, origin: Position) -> Polyline:
    return Polyline.of(
        [vertex.xyz for vertex in feature.vertices],
        is_closed=feature.geometry is Geometry.AREA,
        origin=origin,
    )


def _cuts(line: Polyline, target: Floats) -> Floats:
    """Where a line is crossed inside: index of the side plus the fraction on it, rising.

    Crossings within a millimetre of a vertex are at the vertex.
    """
    if not len(target):
        return np.empty(0)
    sides = line.plan_sides
    own, other = meeting_pairs(sides, target)
    fractions, _ = crossing_fractions(sides[own], target[other])
    is_met = ~np.isnan(fractions)
    own, fractions = own[is_met], fractions[is_met].clip(0, 1)
    lengths = np.linalg.norm(sides[own, 1] - sides[own, 0], axis=1)
    fractions[fractions * lengths <= SAME_POSITION_M] = 0.0
    fractions[(1 - fractions) * lengths <= SAME_POSITION_M] = 1.0
    cuts: Floats = np.unique(own + fractions)
    return cuts[(cuts > 0) & (cuts < len(line.xyz) - 1)]


def _vertex_at(feature: Feature, line: Polyline, cut: float) -> Vertex:
    side = int(cut)
    if side == cut:
        return feature.vertices[side]
    (position,) = line.positions(line.between(np.array([side]), np.array([cut - side])))
    return Vertex(position)


def _never_meets(position: Position) -> Unsuitable:
    return Unsuitable(
        Text(
            "The line's continuation never meets the other line.",
            "延長しても相手の線と交わりません。",
        ),
        name_position(position),
        Text(
            "Choose the other end, or another line to extend to.",
            "反対側の端点か、別の線を指定してください。",
        ),
    )
