"""OpenDRIVE: routes as roads with the lanes that the map's edges and markings make.

ASAM OpenDRIVE 1.6: the reference line is the centre line, in straight pieces; lanes have widths
that change linearly from station to station; traffic keeps left.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.formats.map_delivery import MapDelivery, OpenDriveOptions
from processing.formats.roads.lanes import (
    DrawnLane,
    LaneStretch,
    Markings,
    RoadMarking,
    lanes_of,
)
from processing.map.routes.road_sections import RoadSection, road_sections
from processing.map.routes.route import Route, routes_of
from processing.section.stations import Stations

_DIGITS = 6
_MARK_M = 0.15
"""Width of a marking whose width the map doesn't say (道路標識、区画線及び道路標示に関する命令)."""


def write_opendrive_features(
    path: Path, delivery: MapDelivery, monitor: Monitor, *, never: Iterable[Path] = ()
) -> None:
    """Write each route with a drawn edge as a road.

    Parameters
    ----------
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    Unsuitable
        The map has no such route, or none with an edge of the road or a curb beside it.
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.
    """
    options = delivery.options_of(OpenDriveOptions)
    roads = _roads(delivery, options, monitor)
    with (
        write_safely(path, never=never) as temporary,
        temporary.open("w", encoding="utf-8", newline="\n") as file,
    ):
        for words in _head(delivery, [stations for _, stations, _ in roads]):
            file.write(words + "\n")
        for number, (route, stations, lanes) in enumerate(roads, 1):
            for words in _road(number, route, stations, lanes):
                monitor.check()
                file.write(words + "\n")
        file.write("</OpenDRIVE>\n")


_Road = tuple[Route, Stations, tuple[LaneStretch, ...]]


def _roads(delivery: MapDelivery, options: OpenDriveOptions, monitor: Monitor) -> list[_Road]:
    routes = routes_of(delivery.features, delivery.catalogue)
    sections = road_sections(delivery.features, delivery.catalogue, options.lane_pitch)
    markings = Markings(delivery.features, delivery.catalogue)
    roads: list[_Road] = []
    bare: list[str] = []
    for route, own in _of_routes(routes, sections):
        monitor.check()
        if options.sheet_route not in ("", route.name):
            continue
        stations = Stations(route.line.xyz + route.line.origin)
        lanes = lanes_of(route, stations, own, markings)
        if any(one.left or one.right for one in lanes):
            roads.append((route, stations, lanes))
        else:
            bare.append(route.name or "-")
    if not roads:
        raise Unsuitable(
            Text("No route has an edge of the road beside it.", "道路縁のある路線がありません。"),
            Text.same("OpenDRIVE"),
            Text(
                "Draw and accept the centre line, and road edges or curbs; nothing was written.",
                "中心線と、道路縁または縁石を作図して確定してください。何も書き込まれていません。",
            ),
        )
    if bare:
        names = ", ".join(bare[:3])
        delivery.tell(
            Text(
                f"{len(bare)} routes have no drawn edge and are left out ({names}).",
                f"{len(bare)}路線には道路縁がないため、書き出していません（{names}）。",
            )
        )
    return roads


def _of_routes(
    routes: Sequence[Route], sections: Sequence[RoadSection]
) -> Iterator[tuple[Route, list[RoadSection]]]:
    """Each route with its sections, which come in the same order; short ones have none."""
    at = 0
    for route in routes:
        own: list[RoadSection] = []
        expected = route.start_m
        while at < len(sections):
            one = sections[at]
            if one.route != route.name or abs(one.start_m - expected) > 1e-6:
                break
            own.append(one)
            expected = one.end_m
            at += 1
        if own:
            yield route, own


def _head(delivery: MapDelivery, roads: Sequence[Stations]) -> Iterator[str]:
    bounds = np.array([one.bounds for one in roads])
    west, south = bounds[:, :2].min(axis=0).tolist()
    east, north = bounds[:, 2:].max(axis=0).tolist()
    written = datetime.now(UTC).astimezone()
    yield '<?xml version="1.0" encoding="UTF-8"?>'
    yield "<OpenDRIVE>"
    yield (
        f'<header revMajor="1" revMinor="6" name={quoteattr(delivery.name)} version="1.00"'
        f' date="{written:%Y-%m-%dT%H:%M:%S}" north="{_number(north)}" south="{_number(south)}"'
        f' east="{_number(east)}" west="{_number(west)}" vendor="Zuka">'
    )
    projection = _projection(delivery.crs)
    if projection:
        yield f"<geoReference><![CDATA[{projection}]]></geoReference>"
    yield "</header>"


def _projection(crs: str) -> str:
    """The reference system as the standard wants it: a PROJ string."""
    if not crs:
        return ""
    from pyproj import CRS

    with warnings.catch_warnings():  # that a datum's name may be lost: the ellipsoid is there
        warnings.simplefilter("ignore")
        return CRS.from_user_input(crs).to_proj4()


def _road(
    number: int, route: Route, stations: Stations, lanes: Sequence[LaneStretch]
) -> Iterator[str]:
    along, xyz = stations.measured_positions()
    yield (
        f'<road name={quoteattr(route.name)} length="{_number(stations.length_m)}"'
        f' id="{number}" junction="-1" rule="LHT">'
    )
    yield '<type s="0.0" type="unknown"/>'
    yield from _plan(along, xyz)
    yield from _heights(along, xyz)
    yield "<lanes>"
    for at, stretch in enumerate(lanes):
        before = lanes[at - 1] if at else None
        after = lanes[at + 1] if at + 1 < len(lanes) else None
        yield from _stretch(stretch, stretch.start_m - route.start_m, (before, after))
    yield "</lanes>"
    yield "</road>"


def _plan(along: Floats, xyz: Floats) -> Iterator[str]:
    yield "<planView>"
    steps = np.diff(xyz[:, :2], axis=0)
    rows = zip(along.tolist(), xyz.tolist(), steps.tolist(), strict=False)
    for s, (x, y, _), (east, north) in rows:
        yield (
            f'<geometry s="{_number(s)}" x="{_number(x)}" y="{_number(y)}"'
            f' hdg="{math.atan2(north, east):.12f}" length="{_number(math.hypot(east, north))}">'
            "<line/></geometry>"
        )
    yield "</planView>"


def _heights(along: Floats, xyz: Floats) -> Iterator[str]:
    yield "<elevationProfile>"
    slopes = np.diff(xyz[:, 2]) / np.diff(along)
    for s, height, slope in zip(along.tolist(), xyz[:, 2].tolist(), slopes.tolist(), strict=False):
        yield f'<elevation s="{_number(s)}" a="{_number(height)}" b="{slope:.9f}" c="0" d="0"/>'
    yield "</elevationProfile>"


def _stretch(
    stretch: LaneStretch, s: float, beside: tuple[LaneStretch | None, LaneStretch | None]
) -> Iterator[str]:
    yield f'<laneSection s="{_number(s)}">'
    length = stretch.end_m - stretch.start_m
    if stretch.left:
        yield "<left>"
        for id_ in range(len(stretch.left), 0, -1):
            yield from _lane(id_, stretch.left[id_ - 1], length, _links(id_, beside))
        yield "</left>"
    yield f'<center><lane id="0" type="none" level="false">{_mark(stretch.centre)}</lane></center>'
    if stretch.right:
        yield "<right>"
        for id_, lane in enumerate(stretch.right, 1):
            yield from _lane(-id_, lane, length, _links(-id_, beside))
        yield "</right>"
    yield "</laneSection>"


def _links(id_: int, beside: tuple[LaneStretch | None, LaneStretch | None]) -> str:
    """The lanes before and after; those of one id where both stretches have it."""
    words = []
    for tag, other in zip(("predecessor", "successor"), beside, strict=True):
        if other is not None and len(other.left if id_ > 0 else other.right) >= abs(id_):
            words.append(f'<{tag} id="{id_}"/>')
    return f"<link>{''.join(words)}</link>" if words else ""


def _lane(id_: int, lane: DrawnLane, length: float, links: str) -> Iterator[str]:
    first, last = lane.widths
    slope = (last - first) / length
    yield f'<lane id="{id_}" type="{lane.type}" level="false">{links}'
    yield f'<width sOffset="0.0" a="{_number(first)}" b="{slope:.9f}" c="0" d="0"/>'
    yield _mark(lane.marking, has_curb=lane.has_curb)
    yield "</lane>"


def _mark(marking: RoadMarking | None, *, has_curb: bool = False) -> str:
    if marking is None:
        type_, colour, width = ("curb" if has_curb else "none"), "standard", 0.0
    else:
        type_, width = marking.type, _MARK_M
        colour = marking.colour if marking.colour in ("white", "yellow") else "standard"
    change = "both" if type_ == "broken" else "none"
    return (
        f'<roadMark sOffset="0.0" type="{type_}" weight="standard" color="{colour}"'
        f' width="{width:g}" laneChange="{change}"/>'
    )


def _number(value: float) -> str:
    return f"{round(value, _DIGITS) + 0.0:.{_DIGITS}f}"
