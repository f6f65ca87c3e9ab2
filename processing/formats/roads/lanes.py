"""Lanes of a route: what lies between its centre line, markings, curbs and edges."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from processing.core.text import Text
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Feature, Status
from processing.map.routes.road_sections import RoadSection
from processing.map.routes.road_widths import RoadWidths
from processing.map.routes.route import Route
from processing.section.profile import DrawnLine, crossings_of
from processing.section.stations import Stations

MARKING_KIND = "marking_line"

_ALONG = ("solid", "broken")
"""Types of markings between lanes; stop lines are none."""

_LEAST_LANE_M = 2.0
"""What is narrower is a shoulder, or belongs to the marking before it: vehicles are wider."""

_MIDDLE_M = 0.75
"""A marking so near to the centre line is the road's own."""

_LEAST_M = 0.05
_REACH_M = 50.0


@dataclass(frozen=True)
class RoadMarking:
    """A marking as the map has it: ``solid`` or ``broken``; ``white`` or ``yellow``."""

    type: str
    colour: str


@dataclass(frozen=True)
class DrawnLane:
    """A lane between two stations.

    Attributes
    ----------
    type : str
        As OpenDRIVE names it.
    widths : (float, float)
        At its first and its last station, m.
    marking : RoadMarking or None
        At its outer edge.
    has_curb : bool
        Whether the carriageway ends at its outer edge.
    """

    type: str
    widths: tuple[float, float]
    marking: RoadMarking | None = None
    has_curb: bool = False


@dataclass(frozen=True)
class LaneStretch:
    """Lanes of a route between two stations, from the centre line outwards.

    Attributes
    ----------
    start_m, end_m : float
        Stations of the route.
    centre : RoadMarking or None
        On the centre line.
    """

    start_m: float
    end_m: float
    left: tuple[DrawnLane, ...]
    right: tuple[DrawnLane, ...]
    centre: RoadMarking | None


@dataclass(frozen=True)
class _Edge:
    """Where a lane ends, m from the centre line."""

    type: str
    away_m: float
    marking: RoadMarking | None = None
    has_curb: bool = False


class Markings:
    """The accepted markings between lanes of a map."""

    def __init__(self, features: Sequence[Feature], catalogue: Catalogue) -> None:
        self._lines: list[tuple[RoadMarking, DrawnLine]] = []
        for one in features:
            type_ = str(one.attributes.get("type") or "solid")
            is_line = one.geometry is Geometry.LINE and len(one.vertices) > 1
            is_meant = one.kind == MARKING_KIND and one.kind in catalogue and type_ in _ALONG
            if is_line and is_meant and one.status is Status.ACCEPTED:
                marking = RoadMarking(type_, str(one.attributes.get("colour") or "white"))
                xyz = np.array([vertex.xyz for vertex in one.vertices])
                self._lines.append((marking, DrawnLine(Text.same(""), "", 7, xyz)))

    def across(self, stations: Stations, along_m: float) -> list[tuple[float, RoadMarking]]:
        """Offsets of markings, right positive, in their order."""
        cut = stations.cut_at(along_m, 1.0, _REACH_M)
        found = [
            (crossing.offset_m, marking)
            for marking, line in self._lines
            for crossing in crossings_of(cut, line)
        ]
        return sorted(found, key=lambda one: one[0])


def lanes_of(
    route: Route, stations: Stations, sections: Sequence[RoadSection], markings: Markings
) -> tuple[LaneStretch, ...]:
    """The lanes of a route, stretch by stretch; a side without a drawn edge has none there.

    At the route's ends, where lines often end too, widths are those of the stretch's other end.
    """
    ends = [sections[0].start_m, *(one.end_m for one in sections)]
    across = [markings.across(stations, one - route.start_m) for one in ends]
    if len(across) > 1:  # markings end where the route does
        across[0] = max(across[0], across[1], key=len)
        across[-1] = max(across[-1], across[-2], key=len)
    found = []
    sections = _with_ends(sections)
    for section, (before, after) in zip(sections, pairwise(across), strict=True):
        sides = [
            _lanes(
                _edges(section.start, side, before),
                _edges(section.end, side, after),
                (_edges(section.start, side, ()), _edges(section.end, side, ())),
            )
            for side in (0, 1)
        ]
        centre = next((one for away, one in before if abs(away) < _MIDDLE_M), None)
        if section.start.median > 0.0:
            centre = None
        found.append(LaneStretch(section.start_m, section.end_m, sides[0], sides[1], centre))
    return tuple(found)


def _with_ends(sections: Sequence[RoadSection]) -> list[RoadSection]:
    """Sections of which the first and the last have widths at both ends."""
    filled = list(sections)
    filled[0] = replace(filled[0], start=_filled_up(filled[0].start, filled[0].end))
    filled[-1] = replace(filled[-1], end=_filled_up(filled[-1].end, filled[-1].start))
    return filled


def _filled_up(widths: RoadWidths, others: RoadWidths) -> RoadWidths:
    """Widths with those of another place where there is no edge."""

    def chosen(side: int) -> tuple[float, float]:
        if not math.isfinite(widths.carriageway[side]):
            return others.carriageway[side], others.footway[side]
        footway = widths.footway[side]
        known = footway if math.isfinite(footway) else others.footway[side]
        return widths.carriageway[side], known

    (left, left_walk), (right, right_walk) = chosen(0), chosen(1)
    return RoadWidths((left, right), (left_walk, right_walk), widths.median)


def _edges(
    widths: RoadWidths, side: int, across: Sequence[tuple[float, RoadMarking]]
) -> list[_Edge]:
    """Where lanes end on one side (0 left, 1 right) at a station; empty without a drawn edge."""
    carriageway, footway = widths.carriageway[side], widths.footway[side]
    if not math.isfinite(carriageway):
        return []
    edges: list[_Edge] = []
    at = widths.median / 2
    if at > _LEAST_M:
        edges.append(_Edge("median", at))
    end = at + carriageway
    sign = 1.0 if side else -1.0
    beside = sorted((sign * away, one) for away, one in ((a, m) for a, m in across)
                    if sign * away > 0.0) if across else []  # fmt: skip
    for away, marking in beside:
        if away - at >= _LEAST_LANE_M and end - away > _LEAST_M:
            edges.append(_Edge("driving", away, marking))
            at = away
    is_rest = end - at < _LEAST_LANE_M and any(one.type == "driving" for one in edges)
    edges.append(_Edge("shoulder" if is_rest else "driving", end, None, has_curb=footway > 0))
    if math.isfinite(footway) and footway > _LEAST_M:
        edges.append(_Edge("sidewalk", end + footway))
    return edges


def _lanes(
    start: list[_Edge], end: list[_Edge], plain: tuple[list[_Edge], list[_Edge]]
) -> tuple[DrawnLane, ...]:
    """Lanes that both ends have; where these differ the markings do not count."""
    if not start or not end:
        return ()
    if [one.type for one in start] != [one.type for one in end]:
        start, end = (_padded(one, plain) for one in plain)
    lanes = []
    inner = (0.0, 0.0)
    for first, last in zip(start, end, strict=True):
        outer = (first.away_m, last.away_m)
        widths = (max(0.0, outer[0] - inner[0]), max(0.0, outer[1] - inner[1]))
        lanes.append(DrawnLane(first.type, widths, first.marking, first.has_curb or last.has_curb))
        inner = outer
    return tuple(lanes)


def _padded(edges: list[_Edge], both: tuple[list[_Edge], list[_Edge]]) -> list[_Edge]:
    """Edges with lanes of no width where the other end has some."""
    types = [type_ for type_ in ("median", "driving", "sidewalk")
             if any(one.type == type_ for those in both for one in those)]  # fmt: skip
    own = {one.type: one for one in edges}
    padded: list[_Edge] = []
    for type_ in types:
        away = padded[-1].away_m if padded else 0.0
        padded.append(own.get(type_) or _Edge(type_, away))
    return padded
