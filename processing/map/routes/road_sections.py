"""Sections of a road between its stations: widths, and what stands along each side.

Rows of the road's ledger (道路台帳調書). Everything is measured in plan on the map as drawn: the
edge of a road is where the map has it, which says nothing about the boundary of land.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely

from processing.core.arrays import Floats
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.feature import Feature
from processing.map.routes.numbering import REACH_M
from processing.map.routes.road_alignment import RoadAlignment, RouteShape
from processing.map.routes.road_widths import (
    CURB_KINDS,
    PIECE_M,
    ROAD_EDGE_CODES,
    RoadWidths,
    StationedRoute,
    WidthLines,
    accepted_with_kinds,
    places_along,
    plan_shape,
    stationed_routes,
)
from processing.map.routes.route import PITCH_M

GUTTER_CODES = frozenset({"2231", "2232", "2233", "2234", "2237"})
GUARD_CODES = frozenset({"6132"})
BRIDGE_CODES = frozenset({"2203"})
LID_KINDS = frozenset({"gutter_lid", "gutter_grating"})

COUNTED: Mapping[str, frozenset[str]] = {
    "trees": frozenset({"2238"}),
    "signs": frozenset({"sign", "2242", "2243", "2244"}),
    "lights": frozenset({"4237", "4238"}),
    "poles": frozenset({"pole", "4119", "4132", "4142"}),
    "inlets": frozenset({"2235"}),
}
"""What is counted, by class code; kinds that have none by their id."""


@dataclass
class SideContent:
    """What stands on one side of a section: plan lengths, m, numbers, and kinds of gutters."""

    curb_m: float = 0.0
    gutter_m: float = 0.0
    guard_m: float = 0.0
    gutters: list[str] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class RoadSection:
    """A stretch of a route from one station to the next.

    Attributes
    ----------
    start, end : RoadWidths
        Across its first and its last station.
    left, right : SideContent
    """

    route: str
    start_m: float
    end_m: float
    start: RoadWidths
    end: RoadWidths
    left: SideContent
    right: SideContent
    surfaces: tuple[str, ...] = ()
    bridges: tuple[str, ...] = ()
    alignment: RoadAlignment = field(default_factory=RoadAlignment)

    @property
    def length_m(self) -> float:
        """Along the centre line in plan."""
        return self.end_m - self.start_m

    @property
    def carriageway_area_m2(self) -> float:
        """By the mean of the widths at both ends; NaN where either isn't known."""
        return (self.start.carriageway_m + self.end.carriageway_m) / 2 * self.length_m

    @property
    def footway_area_m2(self) -> float:
        """Of both sides, by the mean of the widths at both ends; NaN where either isn't known."""
        return (sum(self.start.footway) + sum(self.end.footway)) / 2 * self.length_m

    @property
    def surfaced_area_m2(self) -> float:
        """Carriageway and footways, where the map says what they are surfaced with; else NaN."""
        return self.carriageway_area_m2 + self.footway_area_m2 if self.surfaces else math.nan

    @property
    def road_area_m2(self) -> float:
        """By the mean of the widths at both ends; NaN where either isn't known."""
        return (self.start.road_m + self.end.road_m) / 2 * self.length_m


def road_sections(
    features: Sequence[Feature], catalogue: Catalogue, pitch_m: float = PITCH_M
) -> tuple[RoadSection, ...]:
    """The sections of all routes of a map, in the order of routes and stations.

    Parameters
    ----------
    features : sequence of Feature
        The whole map; accepted ones count.
    pitch_m : float
        From station to station; the first and the last section end where the route does.

    Returns
    -------
    tuple of RoadSection
        Empty where the map has no centre line.
    """
    lines = stationed_routes(features, catalogue, pitch_m)
    if not lines:
        return ()
    accepted = accepted_with_kinds(features, catalogue)
    across = WidthLines(accepted)
    found: list[RoadSection] = []
    filled = _contents(lines, accepted)
    for line, cells in zip(lines, filled, strict=True):
        widths = [across.widths(line, station) for station in line.stations]
        first, bends = line.route.start_m, RouteShape(line.route.line.xyz)
        for number, cell in enumerate(cells):
            found.append(
                RoadSection(
                    line.route.name, line.stations[number], line.stations[number + 1],
                    widths[number], widths[number + 1], cell.sides[0], cell.sides[1],
                    tuple(sorted(cell.surfaces)), tuple(sorted(cell.bridges)),
                    bends.between(line.stations[number] - first, line.stations[number + 1] - first),
                )
            )  # fmt: skip
    return tuple(found)


@dataclass
class _Cell:
    """What one section holds."""

    sides: tuple[SideContent, SideContent] = field(
        default_factory=lambda: (SideContent(), SideContent())
    )
    surfaces: set[str] = field(default_factory=set)
    bridges: set[str] = field(default_factory=set)
    lengths: dict[tuple[int, str], float] = field(default_factory=dict)

    def finish(self) -> None:
        """Curbs have two edges, and gutters are lines or lids: the longer counts."""
        for number, side in enumerate(self.sides):
            side.curb_m = max(self._length(number, one) for one in sorted(CURB_KINDS))
            side.gutter_m = max(self._length(number, one) for one in ("gutter", "lids"))
            side.guard_m = self._length(number, "guard")

    def _length(self, side: int, what: str) -> float:
        return self.lengths.get((side, what), 0.0)


def _contents(
    lines: Sequence[StationedRoute], accepted: Iterable[tuple[FeatureKind, Feature]]
) -> list[list[_Cell]]:
    """The sections of each route with what stands in them."""
    cells = [[_Cell() for _ in line.stations[1:]] for line in lines]
    for kind, feature in accepted:
        places, length = _pieces(feature)
        if not len(places):
            continue
        points = shapely.points(places)
        away = np.stack([shapely.distance(points, line.shape) for line in lines])
        nearest = away.argmin(axis=0)
        for number in np.unique(nearest):
            mine = (nearest == number) & (away[number] <= REACH_M)
            section, side = lines[number].located(places[mine])
            inside = section >= 0
            pairs, how_many = np.unique(
                np.stack([section[inside], side[inside]], axis=1), axis=0, return_counts=True
            )
            for (at, on), count in zip(pairs.tolist(), how_many.tolist(), strict=True):
                _fill(cells[number][at], on, kind, feature, length * count)
    for row in cells:
        for cell in row:
            cell.finish()
    return cells


def _fill(cell: _Cell, side: int, kind: FeatureKind, feature: Feature, length_m: float) -> None:
    """Add to a section what of a feature lies on one side of it."""
    content, key = cell.sides[side], kind.dm_code or kind.id
    if feature.geometry is Geometry.LINE:
        if kind.id in CURB_KINDS:
            _add(cell, side, kind.id, length_m)
        elif key in GUTTER_CODES:
            _add(cell, side, "gutter", length_m)
            _name_gutter(content, kind)
        elif key in GUARD_CODES:
            _add(cell, side, "guard", length_m)
        elif key in ROAD_EDGE_CODES:
            surface = feature.attributes.get("surface")
            cell.surfaces.update([str(surface)] if surface else [])
    elif kind.id in LID_KINDS:
        along = feature.attributes.get("length_m")
        _add(cell, side, "lids", float(along) if isinstance(along, (int, float)) else 0.0)
        _name_gutter(content, kind)
    if key in BRIDGE_CODES:
        name = feature.attributes.get("name")
        cell.bridges.update([str(name)] if name else [])
    for what, keys in COUNTED.items():
        if key in keys:
            content.counts[what] = content.counts.get(what, 0) + 1


def _add(cell: _Cell, side: int, what: str, length_m: float) -> None:
    cell.lengths[side, what] = cell.lengths.get((side, what), 0.0) + length_m


def _name_gutter(content: SideContent, kind: FeatureKind) -> None:
    if kind.id not in content.gutters:
        content.gutters.append(kind.id)


def _pieces(feature: Feature) -> tuple[Floats, float]:
    """Where a feature is, (n, 2), and the length that each place stands for, m."""
    shape = plan_shape(feature)
    if shape is None:
        return np.empty((0, 2)), 0.0
    if feature.geometry is not Geometry.LINE:
        middle: Floats = shapely.get_coordinates(shapely.centroid(shape))
        return middle, 0.0
    count = max(1, math.ceil(shape.length / PIECE_M))
    along = (np.arange(count) + 0.5) * (shape.length / count)
    return places_along(shapely.get_coordinates(shape), along), shape.length / count
