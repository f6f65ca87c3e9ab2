"""How wide a road is across its centre line, at any station, on the map as drawn."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from processing.core.arrays import Floats, Integers
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.feature import Feature, Status
from processing.map.routes.numbering import REACH_M
from processing.map.routes.route import Route, routes_of

ROAD_EDGE_CODES = frozenset({"2101"})
CARRIAGEWAY_CODES = frozenset({"2213"})
MEDIAN_CODES = frozenset({"2226"})
CURB_KINDS = frozenset({"curb_lower", "curb_upper"})

PIECE_M = 0.1
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


@dataclass(frozen=True)
class StationedRoute:
    """A route with its stations, in the project's system."""

    route: Route
    shape: shapely.LineString
    stations: tuple[float, ...]

    @staticmethod
    def of(route: Route, pitch_m: float) -> StationedRoute:
        """A route with a station each pitch, and where it begins and ends."""
        shape = shapely.LineString(route.line.xyz[:, :2] + route.line.origin[:2])
        first, last = route.start_m, route.start_m + float(shape.length)
        numbers = range(math.floor(first / pitch_m) + 1, math.ceil(last / pitch_m))
        inner = [number * pitch_m for number in numbers]
        kept = [one for one in inner if min(one - first, last - one) > _LEAST_SECTION_M]
        stations = (first, *kept, last) if last - first > _LEAST_SECTION_M else ()
        return StationedRoute(route, shape, stations)

    def located(self, places: Floats) -> tuple[Integers, Integers]:
        """Section and side (0 left, 1 right) of places (n, 2); -1 beyond the ends."""
        along = shapely.line_locate_point(self.shape, shapely.points(places))
        side = np.where(self._turns(along, places) >= 0, 0, 1)
        edges = np.asarray(self.stations) - self.route.start_m
        section = np.clip(np.searchsorted(edges, along, side="right") - 1, 0, len(edges) - 2)
        ahead = np.einsum("ij,ij->i", self._directions(along), places - self._feet(along))
        beyond = ((along <= 0) & (ahead < -PIECE_M)) | (
            (along >= self.shape.length) & (ahead > PIECE_M)
        )
        return np.where(beyond, -1, section).astype(np.int64), side.astype(np.int64)

    def ray(self, station_m: float, *, is_left: bool) -> Floats:
        """(2, 2): from the centre line across to the reach."""
        along = np.array([station_m - self.route.start_m])
        foot, direction = self._feet(along)[0], self._directions(along)[0]
        normal = np.array([-direction[1], direction[0]]) * (1.0 if is_left else -1.0)
        return np.stack([foot, foot + normal * REACH_M])

    def height_at(self, station_m: float) -> float:
        """Of the centre line at a station, m."""
        xyz = self.route.line.xyz
        reached = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(xyz[:, :2], axis=0).T))])
        height = np.interp(station_m - self.route.start_m, reached, xyz[:, 2])
        return float(height + self.route.line.origin[2])

    def _feet(self, along: Floats) -> Floats:
        return places_along(shapely.get_coordinates(self.shape), along)

    def _directions(self, along: Floats) -> Floats:
        length = self.shape.length
        before = self._feet(np.clip(along - PIECE_M, 0.0, length))
        steps = self._feet(np.clip(along + PIECE_M, 0.0, length)) - before
        lengths = np.linalg.norm(steps, axis=1, keepdims=True)
        unit: Floats = steps / np.where(lengths > 0, lengths, 1.0)
        return unit

    def _turns(self, along: Floats, places: Floats) -> Floats:
        direction, away = self._directions(along), places - self._feet(along)
        turns: Floats = direction[:, 0] * away[:, 1] - direction[:, 1] * away[:, 0]
        return turns


def stationed_routes(
    features: Sequence[Feature], catalogue: Catalogue, pitch_m: float
) -> list[StationedRoute]:
    """The routes of a map that are long enough for a section, in their order."""
    lines = [StationedRoute.of(route, pitch_m) for route in routes_of(features, catalogue)]
    return [line for line in lines if len(line.stations) > 1]


def accepted_with_kinds(
    features: Sequence[Feature], catalogue: Catalogue
) -> list[tuple[FeatureKind, Feature]]:
    """The accepted features whose kind the catalogue knows, each with it."""
    return [
        (catalogue[one.kind], one)
        for one in features
        if one.status is Status.ACCEPTED and one.kind in catalogue
    ]


class WidthLines:
    """The lines to which widths are measured.

    Parameters
    ----------
    accepted : iterable of (FeatureKind, Feature)
        What is on the map.
    """

    def __init__(self, accepted: Iterable[tuple[FeatureKind, Feature]]) -> None:
        edges: list[shapely.Geometry] = []
        inner: list[shapely.Geometry] = []
        medians: list[shapely.Geometry] = []
        for kind, feature in accepted:
            shape = plan_shape(feature)
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

    def widths(self, line: StationedRoute, station_m: float) -> RoadWidths:
        """Across a route at a station."""
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

    def median_ends(self, line: StationedRoute, station_m: float) -> tuple[float, float]:
        """How far the median reaches from the centre line to the left and to the right."""
        left, right = (
            self._median_end(shapely.LineString(line.ray(station_m, is_left=is_left)))
            for is_left in (True, False)
        )
        return left, right

    def _median_end(self, ray: shapely.LineString) -> float:
        """How far the median reaches from the centre line, where it lies on it."""
        for number in self._medians.query(ray, predicate="intersects"):
            area = self._medians.geometries[number]
            if shapely.distance(area, shapely.Point(ray.coords[0])) <= PIECE_M:
                cut = shapely.intersection(area, ray)
                xy = shapely.get_coordinates(cut)
                return float(np.hypot(*(xy - ray.coords[0]).T).max()) if len(xy) else 0.0
        return 0.0


def _first_beyond(tree: shapely.STRtree, ray: shapely.LineString, beyond_m: float) -> float:
    """How far from a ray's start the first of some lines crosses it; NaN where none does."""
    found = tree.query(ray, predicate="intersects")
    xy = shapely.get_coordinates(shapely.intersection(tree.geometries[found], ray))
    away = np.hypot(*(xy - ray.coords[0]).T)
    far = away[away > beyond_m + PIECE_M]
    return float(far.min()) if far.size else math.nan


def places_along(xy: Floats, along: Floats) -> Floats:
    """Places on a line (k, 2) at lengths from its start: (n, 2)."""
    # A library's function would walk along the line anew for each of them.
    reached = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(xy, axis=0).T))])
    return np.stack([np.interp(along, reached, xy[:, axis]) for axis in (0, 1)], axis=1)


def plan_shape(feature: Feature) -> shapely.Geometry | None:
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
