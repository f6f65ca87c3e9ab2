"""What is cut at the stations of a route, and along it: the drives' ground and the map's lines."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import shapely

from processing.core.arrays import Floats
from processing.core.errors import OutOfRange
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.sheets.sheet_clips import SheetClips
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.feature import Feature
from processing.map.routes.route import CENTRE_LINE_CODE, PITCH_M, Route
from processing.recording.drive import Drive
from processing.section.cut import Cut
from processing.section.profile import DrawnLine, crossings_of, profile_of
from processing.section.stations import Stations

_LINE_M = 0.01
"""What the drawn ground line may leave the measured one by: a tenth of a millimetre at 1:100."""

_STRAIGHT_M = 0.1
"""The centre line may leave the chords by this, along which its ground is cut."""

_NARROW_M, _STANDS_OUT_M = 1.0, 0.3
"""What stands out by so much and is narrower is a trunk, a post or a fence, not ground."""

_CHORD_M = 20.0
_BEYOND_M = 0.1
"""Ground is looked for so far beyond the ends of a chord, so that it goes through them."""

_LEAST_M = 0.01
_STATION = re.compile(r"(?:No\.?\s*(?P<number>-?\d+)\s*\+?)?\s*(?P<rest>-?\d+(?:\.\d*)?)?", re.I)


@dataclass(frozen=True)
class CrossedFeature:
    """Where a section meets a feature.

    Attributes
    ----------
    along_m : float
        In a cross section the offset from the centre line, right positive; in a longitudinal one
        the route's station.
    """

    feature: Feature
    kind: FeatureKind
    along_m: float
    height_m: float


@dataclass(frozen=True)
class RouteSection:
    """A cross section (``station_m`` is given), or the longitudinal one of a route.

    Attributes
    ----------
    stations : Stations
        Of the centre line; begin at 0.
    ground : tuple of (k, 2) float64
        Offsets or stations, and heights, m; a part for each stretch without gap.
    crossed : tuple of CrossedFeature
        In the order in which they are met.
    """

    route: Route
    stations: Stations
    ground: tuple[Floats, ...]
    crossed: tuple[CrossedFeature, ...]
    station_m: float | None = None

    def ground_at(self, along_m: float) -> float | None:
        """Height of the ground line; None in its gaps and beyond its ends."""
        for part in self.ground:
            if part[0, 0] <= along_m <= part[-1, 0]:
                return float(np.interp(along_m, part[:, 0], part[:, 1]))
        return None

    def place_of(self, along_m: float) -> tuple[float, float]:
        """Easting and northing of a place in it."""
        if self.station_m is None:
            easting, northing, _ = self.stations.position_at(along_m - self.route.start_m)
            return easting, northing
        at = self.station_m - self.route.start_m
        easting, northing, _ = self.stations.position_at(at)
        east, north = self.stations.direction_at(at)
        return easting + along_m * north, northing - along_m * east

    def between(self, first_m: float, last_m: float) -> RouteSection:
        """A part of it, with ends on the ground line where that goes through them."""
        parts = []
        for part in self.ground:
            inside = part[(part[:, 0] > first_m) & (part[:, 0] < last_m)]
            ends = [
                np.array([[end, np.interp(end, part[:, 0], part[:, 1])]])
                if part[0, 0] <= end <= part[-1, 0]
                else np.empty((0, 2))
                for end in (first_m, last_m)
            ]
            parts.append(np.concatenate([ends[0], inside, ends[1]]))
        crossed = tuple(one for one in self.crossed if first_m <= one.along_m <= last_m)
        ground = tuple(part for part in parts if len(part) > 1)
        return replace(self, ground=ground, crossed=crossed)


@dataclass(frozen=True)
class SectionSource:
    """What sections are cut through.

    Attributes
    ----------
    clips : SheetClips
        Of the features.
    depth_m : float
        Points so near together are seen as one line.
    """

    drives: Sequence[Drive]
    clips: SheetClips
    catalogue: Catalogue
    depth_m: float

    def cross_section(self, route: Route, station_m: float, reach_m: float) -> RouteSection:
        """The section across a route at a station, as one sees it who looks along the route."""
        stations = _stations_of(route)
        cut = stations.cut_at(station_m - route.start_m, self.depth_m, reach_m)
        ground = _cleared(profile_of(cut, self.drives).ground)
        section = RouteSection(route, stations, ground, (), station_m)
        crossed = (
            replace(one, height_m=_height_of(one, section.ground_at(one.along_m)))
            for one in self._crossed(cut)
        )
        return replace(section, crossed=tuple(sorted(crossed, key=lambda one: one.along_m)))

    def longitudinal_section(self, route: Route, monitor: Monitor) -> RouteSection:
        """The section along a route's centre line."""
        stations = _stations_of(route)
        parts: list[Floats] = []
        found: list[CrossedFeature] = []
        for first, last in _chords(stations):
            monitor.check()
            start, end = (np.array(stations.position_at(one)) for one in (first, last))
            length = float(np.hypot(*(end - start)[:2]))
            east, north = ((end - start)[:2] / length).tolist()
            x, y, z = ((start + end) / 2).tolist()
            cut = Cut((x, y, z), (east, north), self.depth_m, length / 2 + _BEYOND_M)

            def station(along: float, first: float = first, last: float = last,
                        length: float = length) -> float:  # fmt: skip
                share = (along + length / 2) / length
                return route.start_m + first + share * (last - first)

            for part in profile_of(cut, self.drives).ground:
                scale = (last - first) / length
                middle = route.start_m + (first + last) / 2
                parts.append(part * [scale, 1.0] + [middle, 0.0])
            found += [
                replace(one, along_m=station(one.along_m))
                for one in self._crossed(cut)
                if abs(one.along_m) <= length / 2
            ]
        ground = _cleared(_joined(parts))
        section = RouteSection(route, stations, ground, ())
        crossed = {
            (one.feature.id, round(one.along_m, 2)): replace(
                one, height_m=_height_of(one, section.ground_at(one.along_m))
            )
            for one in found
        }
        in_order = tuple(sorted(crossed.values(), key=lambda one: one.along_m))
        end_m = route.start_m + stations.length_m
        return replace(section, crossed=in_order).between(route.start_m, end_m)

    def _crossed(self, cut: Cut) -> Iterable[CrossedFeature]:
        for feature in self.clips.within(shapely.Polygon(cut.outline)):
            kind = self.catalogue[feature.kind]
            if kind.dm_code == CENTRE_LINE_CODE:
                continue
            xyz = np.array([vertex.xyz for vertex in feature.vertices])
            is_closed = feature.geometry is Geometry.AREA
            line = DrawnLine(kind.name, kind.layer, kind.aci, xyz, is_closed)
            for crossing in crossings_of(cut, line):
                yield CrossedFeature(feature, kind, crossing.offset_m, crossing.height_m)


def stations_to_cut(route: Route, pitch_m: float, further: Sequence[float]) -> list[float]:
    """The route's ends, its multiples of the pitch, and further stations on it; rising."""
    first, last = route.start_m, route.start_m + _stations_of(route).length_m
    numbers = range(math.ceil(first / pitch_m), math.floor(last / pitch_m) + 1)
    wanted = sorted(
        [first, last, *(number * pitch_m for number in numbers),
         *(one for one in further if first <= one <= last)]
    )  # fmt: skip
    kept = wanted[:1]
    kept += [after for before, after in pairwise(wanted) if after - before >= _LEAST_M]
    return kept


def stations_in_words(words: str) -> list[float]:
    """Stations as they are written, with commas between: ``35.2, No.1+15.20``.

    Raises
    ------
    OutOfRange
        Something else stands there.
    """
    found = []
    for part in re.split("[,、，]", words):
        if not part.strip():
            continue
        match = _STATION.fullmatch(part.strip())
        if match is None or not any(match.groups()):
            raise OutOfRange(
                Text("A station can't be read.", "測点を読み取れません。"),
                Text.same(part.strip()),
                Text(
                    "Write stations as 35.2 or No.1+15.20, with commas between.",
                    "測点は35.2またはNo.1+15.20のように、カンマ区切りで指定してください。",
                ),
            )
        number, rest = match["number"], match["rest"]
        found.append(PITCH_M * float(number or 0) + float(rest or 0))
    return found


def _stations_of(route: Route) -> Stations:
    return Stations(route.line.xyz + route.line.origin)


def _chords(stations: Stations) -> Iterable[tuple[float, float]]:
    """Stretches that are nearly straight."""
    measured, xyz = stations.measured_positions()
    line = shapely.LineString(xyz[:, :2] - xyz[0, :2])
    corners = shapely.get_coordinates(shapely.simplify(line, _STRAIGHT_M)) + xyz[0, :2]
    at = 0
    ends = []
    for corner in corners:
        at += int(np.hypot(*(xyz[at:, :2] - corner).T).argmin())
        ends.append(float(measured[at]))
    for first, last in pairwise(ends):
        if last - first > _LEAST_M:
            count = math.ceil((last - first) / _CHORD_M)
            yield from pairwise(np.linspace(first, last, count + 1).tolist())


def _joined(parts: Sequence[Floats]) -> list[Floats]:
    """Parts whose ends meet as one."""
    joined: list[Floats] = []
    for part in sorted(parts, key=lambda one: float(one[0, 0])):
        if joined and part[0, 0] - joined[-1][-1, 0] <= 0.5:  # as of a ground line's gaps
            after = part[part[:, 0] > joined[-1][-1, 0]]
            joined[-1] = np.concatenate([joined[-1], after])
        else:
            joined.append(part)
    return joined


def _cleared(parts: Sequence[Floats]) -> tuple[Floats, ...]:
    """Ground lines without what is too narrow for ground, and without vertices they don't need."""
    if not parts:
        return ()
    every = np.concatenate(parts)
    low = _over_window(every[:, 0], every[:, 1], np.min)
    opened = _over_window(every[:, 0], low, np.max)
    is_ground = every[:, 1] <= opened + _STANDS_OUT_M
    ends = np.cumsum([len(part) for part in parts])[:-1]
    kept = (
        part[those]
        for part, those in zip(parts, np.split(is_ground, ends), strict=True)
        if those.sum() > 1
    )
    return tuple(
        shapely.get_coordinates(shapely.simplify(shapely.LineString(part), _LINE_M))
        for part in kept
    )


def _over_window(along: Floats, values: Floats, of: Callable[[Floats], float]) -> Floats:
    """Least or greatest of the values around each place."""
    starts = np.searchsorted(along, along - _NARROW_M / 2, "left").tolist()
    ends = np.searchsorted(along, along + _NARROW_M / 2, "right").tolist()
    return np.array([of(values[start:end]) for start, end in zip(starts, ends, strict=True)])


def _height_of(crossed: CrossedFeature, ground_m: float | None) -> float:
    """A feature's own height; the ground's where a flat map says 0 throughout."""
    is_flat = all(vertex.xyz[2] == 0.0 for vertex in crossed.feature.vertices)
    return ground_m if is_flat and ground_m is not None else crossed.height_m
