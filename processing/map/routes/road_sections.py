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

from processing.core.arrays import Floats, Integers
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.feature import Feature, Status
from processing.map.routes.numbering import REACH_M
from processing.map.routes.road_alignment import RoadAlignment, RouteShape
from processing.map.routes.route import PITCH_M, Route, routes_of

ROAD_EDGE_CODES = frozenset({"2101"})
CARRIAGEWAY_CODES = frozenset({"2213"})
MEDIAN_CODES = frozenset({"2226"})
GUTTER_CODES = frozenset({"2231", "2232", "2233", "2234", "2237"})
GUARD_CODES = frozenset({"6132"})
BRIDGE_CODES = frozenset({"2203"})
CURB_KINDS = frozenset({"curb_lower", "curb_upper"})
LID_KINDS = frozenset({"gutter_lid", "gutter_grating"})

COUNTED: Mapping[str, frozenset[str]] = {
    "trees": frozenset({"2238"}),
    "signs": frozenset({"sign", "2242", "2243", "2244"}),
    "lights": frozenset({"4237", "4238"}),
    "poles": frozenset({"pole", "4119", "4132", "4142"}),
    "inlets": frozenset({"2235"}),
}
"""What is counted, by class code; kinds that have none by their id."""

_PIECE_M = 0.1
"""Lines are shared out in pieces of this length, so that a section's end is met to half of it."""

_LEAST_SECTION_M = 0.005  # a rest below what stations are written in is none


@dataclass(frozen=True)
class RoadWidths:
    """Widths across a route at a station, m; NaN where the map has no line to measure to.

    Attributes
    ----------
    carriageway : (left, right)
        From the centre line to the curb, the footway's line or the road's edge, whichever comes
        first; without the median.
    footway : (left, right)
        From there to the road's edge; 0 where the carriageway reaches it.
    median : float
        0 where there is none.
    """

    carriageway: tuple[float, float]
    footway: tuple[float, float]
    median: float

    @property
    def carriageway_m(self) -> float:
        """Of both sides together."""
        return sum(self.carriageway)

    @property
    def road_m(self) -> float:
        """From edge to edge."""
        return sum(self.carriageway) + sum(self.footway) + self.median


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
    lines = [_Line.of(route, pitch_m) for route in routes_of(features, catalogue)]
    lines = [line for line in lines if len(line.stations) > 1]
    if not lines:
        return ()
    accepted = [
        (catalogue[one.kind], one)
        for one in features
        if one.status is Status.ACCEPTED and one.kind in catalogue
    ]
    across = _Across(accepted)
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


@dataclass(frozen=True)
class _Line:
    """A route with its stations, in the project's system."""

    route: Route
    shape: shapely.LineString
    stations: tuple[float, ...]

    @staticmethod
    def of(route: Route, pitch_m: float) -> _Line:
        shape = shapely.LineString(route.line.xyz[:, :2] + route.line.origin[:2])
        first, last = route.start_m, route.start_m + float(shape.length)
        numbers = range(math.floor(first / pitch_m) + 1, math.ceil(last / pitch_m))
        inner = [number * pitch_m for number in numbers]
        kept = [one for one in inner if min(one - first, last - one) > _LEAST_SECTION_M]
        stations = (first, *kept, last) if last - first > _LEAST_SECTION_M else ()
        return _Line(route, shape, stations)

    def located(self, places: Floats) -> tuple[Integers, Integers]:
        """Section and side (0 left, 1 right) of places (n, 2); -1 beyond the ends."""
        along = shapely.line_locate_point(self.shape, shapely.points(places))
        side = np.where(self._turns(along, places) >= 0, 0, 1)
        edges = np.asarray(self.stations) - self.route.start_m
        section = np.clip(np.searchsorted(edges, along, side="right") - 1, 0, len(edges) - 2)
        ahead = np.einsum("ij,ij->i", self._directions(along), places - self._feet(along))
        beyond = ((along <= 0) & (ahead < -_PIECE_M)) | (
            (along >= self.shape.length) & (ahead > _PIECE_M)
        )
        return np.where(beyond, -1, section).astype(np.int64), side.astype(np.int64)

    def ray(self, station_m: float, *, is_left: bool) -> Floats:
        """(2, 2): from the centre line across to the reach."""
        along = np.array([station_m - self.route.start_m])
        foot, direction = self._feet(along)[0], self._directions(along)[0]
        normal = np.array([-direction[1], direction[0]]) * (1.0 if is_left else -1.0)
        return np.stack([foot, foot + normal * REACH_M])

    def _feet(self, along: Floats) -> Floats:
        return _places_along(shapely.get_coordinates(self.shape), along)

    def _directions(self, along: Floats) -> Floats:
        length = self.shape.length
        before = self._feet(np.clip(along - _PIECE_M, 0.0, length))
        steps = self._feet(np.clip(along + _PIECE_M, 0.0, length)) - before
        lengths = np.linalg.norm(steps, axis=1, keepdims=True)
        unit: Floats = steps / np.where(lengths > 0, lengths, 1.0)
        return unit

    def _turns(self, along: Floats, places: Floats) -> Floats:
        direction, away = self._directions(along), places - self._feet(along)
        turns: Floats = direction[:, 0] * away[:, 1] - direction[:, 1] * away[:, 0]
        return turns


class _Across:
    """The lines to which widths are measured."""

    def __init__(self, accepted: Iterable[tuple[FeatureKind, Feature]]) -> None:
        edges: list[shapely.Geometry] = []
        inner: list[shapely.Geometry] = []
        medians: list[shapely.Geometry] = []
        for kind, feature in accepted:
            shape = _shape(feature)
            if shape is None:
                continue
            if kind.dm_code in ROAD_EDGE_CODES:
                edges.append(shape)
            elif kind.id in CURB_KINDS or kind.dm_code in CARRIAGEWAY_CODES:
                inner.append(shape)
            elif kind.dm_code in MEDIAN_CODES and feature.geometry is Geometry.AREA:
                medians.append(shape)
        self._edges, self._inner = shapely.STRtree(edges), shapely.STRtree(inner)
        self._medians = shapely.STRtree(medians)

    def widths(self, line: _Line, station_m: float) -> RoadWidths:
        carriageway, footway, median = [], [], 0.0
        for is_left in (True, False):
            ray = shapely.LineString(line.ray(station_m, is_left=is_left))
            # Curbs of the median stand before the carriageway, not behind it.
            end = self._median_end(ray)
            edge = _first_beyond(self._edges, ray, end)
            curb = _first_beyond(self._inner, ray, end)
            near = min(one for one in (edge, curb, math.inf) if not math.isnan(one))
            reached = near if math.isfinite(near) else math.nan
            carriageway.append(reached - end)
            footway.append(edge - reached)
            median += end
        return RoadWidths((carriageway[0], carriageway[1]), (footway[0], footway[1]), median)

    def _median_end(self, ray: shapely.LineString) -> float:
        """How far the median reaches from the centre line, where it lies on it."""
        for number in self._medians.query(ray, predicate="intersects"):
            area = self._medians.geometries[number]
            if shapely.distance(area, shapely.Point(ray.coords[0])) <= _PIECE_M:
                cut = shapely.intersection(area, ray)
                xy = shapely.get_coordinates(cut)
                return float(np.hypot(*(xy - ray.coords[0]).T).max()) if len(xy) else 0.0
        return 0.0


def _first_beyond(tree: shapely.STRtree, ray: shapely.LineString, beyond_m: float) -> float:
    """How far from a ray's start the first of some lines crosses it; NaN where none does."""
    found = tree.query(ray, predicate="intersects")
    xy = shapely.get_coordinates(shapely.intersection(tree.geometries[found], ray))
    away = np.hypot(*(xy - ray.coords[0]).T)
    far = away[away > beyond_m + _PIECE_M]
    return float(far.min()) if far.size else math.nan


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
    lines: Sequence[_Line], accepted: Iterable[tuple[FeatureKind, Feature]]
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
    shape = _shape(feature)
    if shape is None:
        return np.empty((0, 2)), 0.0
    if feature.geometry is not Geometry.LINE:
        middle: Floats = shapely.get_coordinates(shapely.centroid(shape))
        return middle, 0.0
    count = max(1, math.ceil(shape.length / _PIECE_M))
    along = (np.arange(count) + 0.5) * (shape.length / count)
    return _places_along(shapely.get_coordinates(shape), along), shape.length / count


def _places_along(xy: Floats, along: Floats) -> Floats:
    """Places on a line (k, 2) at lengths from its start: (n, 2)."""
    # A library's function would walk along the line anew for each of them.
    reached = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(xy, axis=0).T))])
    return np.stack([np.interp(along, reached, xy[:, axis]) for axis in (0, 1)], axis=1)


def _shape(feature: Feature) -> shapely.Geometry | None:
    """A feature in plan; None where it has too few places."""
    xy = np.array([vertex.xyz[:2] for vertex in feature.vertices], dtype=np.float64)
    if not np.isfinite(xy).all():
        return None
    match feature.geometry:
        case Geometry.POINT if len(xy):
            return shapely.Point(xy[0])
        case Geometry.LINE if len(xy) > 1:
            return shapely.LineString(xy)
        case Geometry.AREA if len(xy) > 2:
            return shapely.make_valid(shapely.Polygon(xy))
    return None
