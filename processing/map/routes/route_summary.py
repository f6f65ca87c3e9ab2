"""A route as a whole: what the head of its ledger (道路台帳調書) says.

Lengths and areas are those of the map as drawn, as of :mod:`processing.map.routes.road_sections`.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely

from processing.map.catalogue import Catalogue, FeatureKind
from processing.map.feature import Feature
from processing.map.routes.numbering import REACH_M
from processing.map.routes.road_sections import RoadSection, road_sections
from processing.map.routes.road_widths import (
    StationedRoute,
    WidthLines,
    accepted_with_kinds,
    plan_shape,
    stationed_routes,
)

CHANGE_M = 0.5
"""A width that differs by it or more stands in the ledger (道路法施行規則 第4条の2)."""

STRUCTURE_KINDS = (
    "road_bridge",
    "road_bridge_area",
    "footbridge",
    "underpass",
    "road_tunnel",
    "crosswalk",
)
"""What crosses a road or carries it."""

OCCUPANT_CODES = frozenset(
    {
        "4111", "4119", "4121", "4131", "4132", "4141", "4142", "4151", "4161", "4215", "4216",
        "2221", "2261", "2262",
    }
)  # fmt: skip
"""What others may keep in a road (占用): their poles, their manholes and hydrants, bus stops,
telephone boxes, post boxes."""

_STEP_M = 1.0
_ROUNDING_M = 1e-6


@dataclass(frozen=True)
class WidthStretch:
    """A stretch of a route on which the carriageway is as wide as where it begins.

    Attributes
    ----------
    first_m, least_m, greatest_m : float
        Width where it begins, and the extremes; less than `CHANGE_M` off the first.
    road_m : float
        From edge to edge where it begins; NaN where it isn't known.
    area_m2 : float
        Of the carriageway.
    """

    route: str
    start_m: float
    end_m: float
    first_m: float
    least_m: float
    greatest_m: float
    road_m: float
    area_m2: float

    @property
    def length_m(self) -> float:
        """Along the centre line in plan."""
        return self.end_m - self.start_m


@dataclass(frozen=True)
class RoadStructure:
    """A bridge, a tunnel or a crossing, from station to station."""

    kind: str
    name: str
    start_m: float
    end_m: float


@dataclass(frozen=True)
class RouteSummary:
    """A route.

    Attributes
    ----------
    sections : tuple of RoadSection
        As of its ledger sheet.
    stretches : tuple of WidthStretch
        Where its width is known.
    structures : tuple of RoadStructure
        By station.
    occupants : mapping of str to int
        How many of each kind that others may keep in a road.
    """

    route: str
    sections: tuple[RoadSection, ...]
    stretches: tuple[WidthStretch, ...]
    structures: tuple[RoadStructure, ...]
    occupants: Mapping[str, int]

    @property
    def start_m(self) -> float:
        """Its first station."""
        return self.sections[0].start_m

    @property
    def end_m(self) -> float:
        """Its last station."""
        return self.sections[-1].end_m

    @property
    def unknown_m(self) -> float:
        """How much of it has no width on the map."""
        known = sum(one.length_m for one in self.stretches)
        return max(0.0, self.end_m - self.start_m - known)

    @property
    def least_width_m(self) -> float:
        """Of the carriageway; NaN where none is known."""
        return min((one.least_m for one in self.stretches), default=math.nan)

    def total(self, area: str) -> float:
        """An area of :class:`RoadSection`, summed where it is known; NaN where it is nowhere."""
        values = [getattr(one, area) for one in self.sections]
        known = [value for value in values if not math.isnan(value)]
        return math.fsum(known) if known else math.nan


def route_summaries(features: Sequence[Feature], catalogue: Catalogue) -> tuple[RouteSummary, ...]:
    """The routes of a map, in their order; accepted features count.

    Each thing belongs to the nearest route.
    """
    lines = stationed_routes(features, catalogue, _STEP_M)
    if not lines:
        return ()
    accepted = accepted_with_kinds(features, catalogue)
    across = WidthLines(accepted)
    sections = _by_line(road_sections(features, catalogue), lines)
    things = _things(accepted, lines)
    return tuple(
        RouteSummary(
            line.route.name, mine, tuple(stretches_of(line, across)), tuple(structures), occupants
        )
        for line, mine, (structures, occupants) in zip(lines, sections, things, strict=True)
    )


def _by_line(
    sections: Iterable[RoadSection], lines: Sequence[StationedRoute]
) -> list[tuple[RoadSection, ...]]:
    """Sections come in the order of routes, and end where these do."""
    left = list(sections)
    shared = []
    for line in lines:
        last = line.stations[-1]
        count = next(at for at, one in enumerate(left, 1) if abs(one.end_m - last) < _ROUNDING_M)
        shared.append(tuple(left[:count]))
        left = left[count:]
    return shared


def stretches_of(line: StationedRoute, across: WidthLines) -> Iterable[WidthStretch]:
    """Widths from station to station, gathered until they differ from the first."""
    widths = [across.widths(line, station) for station in line.stations]
    of_road = [one.carriageway_m for one in widths]
    begin = 0
    for at in range(1, len(of_road) + 1):
        goes_on = at < len(of_road) and abs(of_road[at] - of_road[begin]) < CHANGE_M - _ROUNDING_M
        if goes_on:
            continue
        if not math.isnan(of_road[begin]):
            end = min(at, len(of_road) - 1)
            mine = of_road[begin:at]
            stations = line.stations[begin : end + 1]
            # Up to the next station it is as wide as at the last of its own.
            area = math.fsum(
                width * (b - a) for width, (a, b) in zip(mine, pairwise(stations), strict=False)
            )
            if stations[-1] > stations[0]:
                yield WidthStretch(
                    line.route.name, stations[0], stations[-1],
                    mine[0], min(mine), max(mine), widths[begin].road_m, area,
                )  # fmt: skip
        begin = at


def _things(
    accepted: Iterable[tuple[FeatureKind, Feature]], lines: Sequence[StationedRoute]
) -> list[tuple[list[RoadStructure], Counter[str]]]:
    """Structures and occupants of each route."""
    found: list[tuple[list[RoadStructure], Counter[str]]] = [([], Counter()) for _ in lines]
    for kind, feature in accepted:
        is_structure = kind.id in STRUCTURE_KINDS
        shape = plan_shape(feature) if is_structure or kind.dm_code in OCCUPANT_CODES else None
        if shape is None:
            continue
        away = [shapely.distance(shape, line.shape) for line in lines]
        nearest = int(np.argmin(away))
        if away[nearest] > REACH_M:
            continue
        if is_structure:
            found[nearest][0].append(_structure(kind, feature, shape, lines[nearest]))
        else:
            found[nearest][1][kind.id] += 1
    for structures, _ in found:
        structures.sort(key=lambda one: (one.start_m, one.kind))
    return found


def _structure(
    kind: FeatureKind, feature: Feature, shape: shapely.Geometry, line: StationedRoute
) -> RoadStructure:
    """From the first to the last of its places as seen from the centre line."""
    places = shapely.points(shapely.get_coordinates(shape))
    along = shapely.line_locate_point(line.shape, places) + line.route.start_m
    name = str(feature.attributes.get("name") or "")
    return RoadStructure(kind.id, name, float(along.min()), float(along.max()))
