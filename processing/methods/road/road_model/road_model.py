"""A road at its stations: centre line, widths, falls, slope and clearance, each with its error.

Widths are those of the map as drawn; heights are those that were measured between the edges.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import Monitor, PartMonitor
from processing.map.catalogue import Catalogue, FeatureKind
from processing.map.drafting.polyline import Polyline
from processing.map.feature import Feature
from processing.map.routes.centre_lines import made_centre_lines
from processing.map.routes.road_alignment import RouteShape
from processing.map.routes.road_widths import (
    StationedRoute,
    WidthLines,
    accepted_with_kinds,
)
from processing.map.routes.route import PITCH_M, Route, routes_of
from processing.map.routes.shoulders import ShoulderLines
from processing.methods.road.clearance.street_clearance import (
    ClearanceLimits,
    ClearancePlace,
    clearance_over,
    driven_cells,
)
from processing.methods.road.road_model.surface_slopes import (
    UNKNOWN,
    StraightFit,
    fall_across,
    row_medians,
    slope_along,
)
from processing.methods.road.surface.carriageway import (
    RoadEdges,
    RoadProfiles,
    edges_of,
    profiles_of,
)
from processing.methods.road.surface.road_cells import road_cells
from processing.methods.road.surface.road_frame import RoadFrame, driven_lines
from processing.methods.road.surface.road_raster import RoadRaster, road_raster
from processing.recording.drive import Drive

_WIDTH_M = 5.0
"""To either side of a station: edges over which the error of a width is told."""

_BEND_M, _SECTION_M = 10.0, 1.0
_SPIKE_CELLS, _SPIKE_M = 5, 0.3
"""What stands out of the cells beside by more than a curb is no surface: posts, trunks, wheels."""
_SCALE = 1.4826
_LEAST_CONFIDENCE = 0.5
_FEWEST = 5


class Sides(NamedTuple):
    """A measure to the left and to the right of the centre line; NaN where it isn't known."""

    left: float
    right: float

    @property
    def total(self) -> float:
        """Of both."""
        return self.left + self.right


@dataclass(frozen=True)
class RoadStation:
    """A road across one of its stations; NaN where map or points don't tell.

    Attributes
    ----------
    station_m : float
    easting_m, northing_m, height_m : float
        Of the centre line; the height is that of the measured surface.
    carriageway, walk, shoulder : Sides
        Widths in plan, m; the shoulder is part of the carriageway.
    median_m : float
    within : Sides
        How far each half of the carriageway may be off, m: how its edge runs about a straight
        line, one standard deviation.
    fall : (StraightFit, StraightFit)
        Left and right, outwards: a share, 0.02 is 2 %.
    slope : StraightFit
        Along the centre line.
    radius_m : float
        The smallest within 10 m; NaN where it is straight.
    section : (k, 2) float64
        Offsets to the right of the centre line, rising, and heights of the surface, m.
    """

    station_m: float
    easting_m: float
    northing_m: float
    height_m: float
    carriageway: Sides
    walk: Sides
    shoulder: Sides
    median_m: float
    within: Sides
    fall: tuple[StraightFit, StraightFit]
    slope: StraightFit
    radius_m: float
    section: Floats


@dataclass(frozen=True)
class RoadModel:
    """A road.

    Attributes
    ----------
    name : str
        Of its route; empty where no line says it.
    is_drawn : bool
        Whether the map has its centre line; else it was made between the edges.
    line : (n, 3) float64
        The centre line, m, project CRS.
    stations : tuple of RoadStation
    places : tuple of (float, ClearancePlace)
        What hangs too low over it, with its station, in their order.
    unknown_m : float
        Of a line that was made, the length without edges on both sides.
    """

    name: str
    is_drawn: bool
    line: Floats
    stations: tuple[RoadStation, ...]
    places: tuple[tuple[float, ClearancePlace], ...]
    unknown_m: float = 0.0


@dataclass(frozen=True)
class RoadModelSettings:
    """From station to station, and how high the room over carriageway and walks is, m."""

    pitch_m: float = PITCH_M
    limits: ClearanceLimits = field(default_factory=lambda: ClearanceLimits(4.5, 2.5))


class _Line(NamedTuple):
    """A route, whether it is drawn, and the length of a made one without edges."""

    route: Route
    is_drawn: bool
    unknown_m: float


def road_models(
    features: Sequence[Feature],
    catalogue: Catalogue,
    drives: Sequence[Drive],
    settings: RoadModelSettings,
    monitor: Monitor,
) -> tuple[RoadModel, ...]:
    """The roads of a map: along its centre lines, or along the ways that were driven.

    Parameters
    ----------
    features : sequence of Feature
        The whole map; accepted ones count.

    Returns
    -------
    tuple of RoadModel
        Empty where no centre line is drawn and none can be made.

    Raises
    ------
    OutOfRange
        The drives lie too far apart.
    """
    accepted = accepted_with_kinds(features, catalogue)
    across = WidthLines(accepted)
    lines = _lines(accepted, routes_of(features, catalogue), drives)
    monitor.check()
    drives = [one for one in drives if one.count]
    stationed = [(one, StationedRoute.of(one.route, settings.pitch_m)) for one in lines]
    stationed = [(one, line) for one, line in stationed if line.stations]
    if not stationed:
        return ()
    raster = _raster(drives, [line for _, line in stationed], PartMonitor(monitor, 0.1, 0.5))
    shoulders = ShoulderLines(accepted)
    found = []
    for number, (one, line) in enumerate(stationed):
        low, high = (0.5 + 0.5 * (number + k) / len(stationed) for k in (0, 1))
        maker = _ModelMaker(one, line, across, shoulders, raster, monitor.check)
        found.append(maker.model(drives, settings, PartMonitor(monitor, low, high)))
    return tuple(found)


def _raster(
    drives: Sequence[Drive], lines: Sequence[StationedRoute], monitor: Monitor
) -> RoadRaster | None:
    """None without points."""
    if not drives:
        return None
    return road_raster(drives, [_places_of(line) for line in lines], monitor)


def _places_of(line: StationedRoute) -> Floats:
    """Places along a line a metre apart."""
    at = np.arange(0.0, line.shape.length, 1.0)
    return np.array([line.shape.interpolate(one).coords[0] for one in at.tolist()]).reshape(-1, 2)


def _lines(
    accepted: Sequence[tuple[FeatureKind, Feature]],
    routes: Sequence[Route],
    drives: Sequence[Drive],
) -> list[_Line]:
    """The routes, or where there is none lines between the edges of the ways that were driven."""
    if routes:
        return [_Line(one, is_drawn=True, unknown_m=0.0) for one in routes]
    return [
        _Line(
            Route("", 0.0, Polyline.of([(x, y, z) for x, y, z in one.xyz.tolist()])),
            is_drawn=False,
            unknown_m=one.unknown_m,
        )
        for one in made_centre_lines(accepted, driven_lines(drives))
    ]


@dataclass(frozen=True)
class _ModelMaker:
    """What a model is made from."""

    one: _Line
    line: StationedRoute
    across: WidthLines
    shoulders: ShoulderLines
    raster: RoadRaster | None
    check: Callable[[], None]

    def model(
        self, drives: Sequence[Drive], settings: RoadModelSettings, monitor: Monitor
    ) -> RoadModel:
        every = self._edges_each_metre()
        profiles, frame = self._profiles()
        line: Floats = self.line.route.line.xyz + self.line.route.line.origin
        bends = RouteShape(np.column_stack([line[:, :2] - line[0, :2], line[:, 2]]))
        stations = []
        for station in self.line.stations:
            self.check()
            stations.append(self._station(station, profiles, every, bends))
        places: tuple[tuple[float, ClearancePlace], ...] = ()
        if profiles is not None and frame is not None:
            places = self._places(drives, (frame, profiles), every, settings, monitor)
        return RoadModel(
            self.one.route.name, self.one.is_drawn, line, tuple(stations), places,
            self.one.unknown_m,
        )  # fmt: skip

    def _profiles(self) -> tuple[RoadProfiles | None, RoadFrame | None]:
        if self.raster is None:
            return None, None
        xy = self.line.route.line.xyz[:, :2] + self.line.route.line.origin[:2]
        frame = RoadFrame.along(xy - self.raster.plan.origin[:2], self.line.route.start_m)
        if frame is None:
            return None, None
        return profiles_of(self.raster, frame), frame

    def _edges_each_metre(self) -> Floats:
        """(k, 4): station, left and right end of the carriageway, right and left of the median."""
        first = self.line.route.start_m
        at = np.arange(first, first + float(self.line.shape.length), 1.0)
        rows = []
        for station in at.tolist():
            self.check()
            widths = self.across.widths(self.line, station)
            median = self.across.median_ends(self.line, station)
            ends = [m + w for m, w in zip(median, widths.carriageway, strict=True)]
            rows.append((station, *ends))
        return np.array(rows).reshape(-1, 3)

    def _station(
        self, station: float, profiles: RoadProfiles | None, every: Floats, bends: RouteShape
    ) -> RoadStation:
        widths = self.across.widths(self.line, station)
        median = self.across.median_ends(self.line, station)
        ends = [m + w for m, w in zip(median, widths.carriageway, strict=True)]
        slope, falls, height = UNKNOWN, (UNKNOWN, UNKNOWN), math.nan
        if profiles is not None and self.raster is not None:
            slope = slope_along(profiles, station)
            height = slope.height + float(self.raster.plan.origin[2])
            left, right = (
                fall_across(profiles, station, end, slope, is_left=is_left)
                for end, is_left in zip(ends, (True, False), strict=True)
            )
            falls = (left, right)
        along = station - self.line.route.start_m
        near = (max(0.0, along - _BEND_M), min(float(self.line.shape.length), along + _BEND_M))
        x, y = self.line.ray(station, is_left=True)[0].tolist()
        shoulders = [
            self.shoulders.width(self.line, station, end, is_left=is_left)
            for end, is_left in zip(ends, (True, False), strict=True)
        ]
        return RoadStation(
            station, x, y, height,
            Sides(*widths.carriageway), Sides(*widths.footway), Sides(*shoulders), widths.median,
            Sides(_off_line(every[:, [0, 1]], station), _off_line(every[:, [0, 2]], station)),
            falls, slope, bends.between(*near).least_radius_m, self._section(profiles, station),
        )  # fmt: skip

    def _section(self, profiles: RoadProfiles | None, station: float) -> Floats:
        """The surface across a station, right positive."""
        if profiles is None or self.raster is None:
            return np.empty((0, 2))
        rows = np.abs(profiles.stations - station) <= _SECTION_M
        heights = row_medians(profiles.heights[rows].T)
        around = np.pad(heights, _SPIKE_CELLS, constant_values=np.nan)
        windows = np.lib.stride_tricks.sliding_window_view(around, 2 * _SPIKE_CELLS + 1)
        with np.errstate(invalid="ignore"):
            heights[heights > row_medians(windows) + _SPIKE_M] = np.nan
        known = np.flatnonzero(np.isfinite(heights))[::-1]
        level = float(self.raster.plan.origin[2])
        return np.column_stack([-profiles.offsets[known], heights[known] + level])

    def _places(
        self,
        drives: Sequence[Drive],
        road: tuple[RoadFrame, RoadProfiles],
        every: Floats,
        settings: RoadModelSettings,
        monitor: Monitor,
    ) -> tuple[tuple[float, ClearancePlace], ...]:
        if self.raster is None:
            return ()
        frame, profiles = road
        edges = _drawn_edges(edges_of(profiles), profiles, every)
        cells = road_cells(self.raster, [(frame, profiles, edges)])
        driven = driven_cells(self.raster, drives, monitor)
        found = clearance_over(
            drives, (self.raster, cells), settings.limits, monitor, driven=driven
        )
        placed = [
            (self.one.route.position(_position(one))[0].station_m, one)
            for one in found.places
            if one.confidence >= _LEAST_CONFIDENCE
        ]
        return tuple(sorted(placed, key=lambda one: (one[0], one[1].lowest_m)))


def _position(place: ClearancePlace) -> tuple[float, float, float]:
    x, y, z = place.xyz.tolist()
    return x, y, z


def _drawn_edges(told: RoadEdges, profiles: RoadProfiles, every: Floats) -> RoadEdges:
    """The edges as drawn; where there is none, as the surface tells."""
    edge, seen = told.edge.copy(), told.is_seen.copy()
    if len(every):
        row = np.clip(np.rint(profiles.stations - every[0, 0]), 0, len(every) - 1).astype(np.int64)
        drawn = every[row][:, 1:].T
        known = np.isfinite(drawn)
        edge[known], seen[known] = drawn[known], True
    return RoadEdges(edge, seen, told.walk)


def _off_line(edges: Floats, station_m: float) -> float:
    """How an edge runs about a straight line near a station; NaN of too few places."""
    near = edges[np.abs(edges[:, 0] - station_m) <= _WIDTH_M]
    near = near[np.isfinite(near[:, 1])]
    if len(near) < _FEWEST:
        return math.nan
    line = np.polyfit(near[:, 0] - station_m, near[:, 1], 1)
    off = near[:, 1] - np.polyval(line, near[:, 0] - station_m)
    return _SCALE * float(np.median(np.abs(off)))
