"""The map divided along routes: strips turned with the road, which overlap at match lines."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.formats.sheets.drawing_sheet import DrawingSheet, MatchLine
from processing.formats.sheets.grid_division import check_sheet_count
from processing.map.routes.route import Route, station_words
from processing.section.stations import Stations

_BESIDE_SHARE = 0.25
"""Of a window's height, kept free on either side of the route."""
_SHORTENED = 0.9
_STEP_M = 1.0


def route_strips(
    routes: Sequence[Route], scale: int, window_mm: tuple[float, float], overlap_m: float
) -> list[DrawingSheet]:
    """Sheets along routes, one route behind the other.

    Each is turned by the chord of its stretch, and as long as the route stays in the middle half
    of the window's height.

    Raises
    ------
    Unsuitable
        No route; an overlap that leaves less than half of a sheet for new ground; too many sheets.
    """
    if not routes:
        raise Unsuitable(
            Text("The map has no such route.", "該当する路線がありません。"),
            Text("division along the route", "路線に沿った分割"),
            Text(
                "Draw the road's centre line and accept it, or choose another division; nothing"
                " was written.",
                "中心線を作図して確定するか、別の分割を選んでください。何も書き込まれていません。",
            ),
        )
    size = (window_mm[0] * scale / 1000, window_mm[1] * scale / 1000)
    if overlap_m > size[0] / 2:
        raise Unsuitable(
            Text("The overlap is longer than half a sheet.", "重複が図面の半分を超えています。"),
            Text.same(f"{overlap_m:g} m > {size[0] / 2:g} m"),
            Text("Give a smaller overlap.", "重複を小さくしてください。"),
        )
    sheets: list[DrawingSheet] = []
    for route in routes:
        sheets += _of_route(route, scale, size, overlap_m, first=len(sheets) + 1)
    return sheets


def _of_route(
    route: Route, scale: int, size: tuple[float, float], overlap_m: float, *, first: int
) -> list[DrawingSheet]:
    stations = Stations(route.line.xyz + route.line.origin)
    stretches = [(0.0, _end(stations, 0.0, size))]
    while stretches[-1][1] < stations.length_m:
        last = stretches[-1]
        start = max(last[1] - overlap_m, (last[0] + last[1]) / 2)
        stretches.append((start, _end(stations, start, size)))
        check_sheet_count(first + len(stretches))
    sheets = []
    for start, end in stretches:
        centre, turned = _window(stations, start, end)
        name = f"{station_words(route.start_m + start)}～{station_words(route.start_m + end)}"
        sheets.append(DrawingSheet(f"{route.name} {name}".strip(), centre, size, scale, turned))
    for at in range(len(sheets) - 1):
        station = (stretches[at][1] + stretches[at + 1][0]) / 2
        words = station_words(route.start_m + station)
        x, y, _ = stations.position_at(station)
        east, north = stations.direction_at(station)
        reach = math.hypot(*size)
        ends = ((x - north * reach, y + east * reach), (x + north * reach, y - east * reach))
        for one, other in ((at, at + 1), (at + 1, at)):
            match = MatchLine(ends[0], ends[1], words, first + other)
            sheets[one] = replace(sheets[one], matches=(*sheets[one].matches, match))
    return sheets


def _end(stations: Stations, start: float, size: tuple[float, float]) -> float:
    """How far a stretch goes that has room in a window."""
    reach = size[0]
    while reach > 4 * _STEP_M:
        end = min(stations.length_m, start + reach)
        turned = _turned_places(stations, start, end)[0]
        width, height = np.ptp(turned, axis=0)
        if width <= size[0] and height <= size[1] * (1 - 2 * _BESIDE_SHARE):
            return end
        reach *= _SHORTENED
    return min(stations.length_m, start + reach)


def _window(stations: Stations, start: float, end: float) -> tuple[tuple[float, float], float]:
    """Middle of the window, m, and its direction in degrees."""
    turned, origin, angle = _turned_places(stations, start, end)
    middle = (turned.min(axis=0) + turned.max(axis=0)) / 2
    cos, sin = math.cos(angle), math.sin(angle)
    east, north = middle[0] * cos - middle[1] * sin, middle[0] * sin + middle[1] * cos
    return (float(origin[0] + east), float(origin[1] + north)), math.degrees(angle)


def _turned_places(stations: Stations, start: float, end: float) -> tuple[Floats, Floats, float]:
    """The stretch along and across its chord, from its start; the start; the chord's angle."""
    count = max(2, math.ceil((end - start) / _STEP_M) + 1)
    places = np.array([stations.position_at(one)[:2] for one in np.linspace(start, end, count)])
    local = places - places[0]
    chord = local[-1]
    if np.hypot(*chord) < _STEP_M / 2:
        chord = np.array(stations.direction_at(start))
    angle = math.atan2(chord[1], chord[0])
    cos, sin = math.cos(angle), math.sin(angle)
    turned: Floats = local @ np.array([[cos, -sin], [sin, cos]])
    return turned, places[0], angle
