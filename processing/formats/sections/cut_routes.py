"""Sections of the routes that were asked for, cut through what is handed in."""

from __future__ import annotations

from collections.abc import Sequence

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.map_delivery import LandXmlOptions, MapDelivery, SectionOptions
from processing.formats.sections.route_sections import (
    RouteSection,
    SectionSource,
    stations_in_words,
    stations_to_cut,
)
from processing.formats.sheets.sheet_clips import SheetClips
from processing.map.routes.route import routes_of, station_words


def cut_routes(
    delivery: MapDelivery, options: SectionOptions | LandXmlOptions, monitor: Monitor
) -> tuple[list[RouteSection], list[RouteSection]]:
    """The longitudinal sections, and the cross sections that have ground.

    Raises
    ------
    Unsuitable
        The map has no such route, or no ground was measured along it.
    OutOfRange
        A station that can't be read.
    """
    routes = [
        route
        for route in routes_of(delivery.features, delivery.catalogue)
        if options.sheet_route in ("", route.name)
    ]
    if not routes:
        raise _no_route()
    further = stations_in_words(options.section_stations)
    source = SectionSource(
        delivery.drives, SheetClips(delivery.features), delivery.catalogue, options.section_depth
    )
    along: list[RouteSection] = []
    across: list[RouteSection] = []
    empty: list[str] = []
    for number, route in enumerate(routes):
        section = source.longitudinal_section(route, monitor)
        if section.ground:
            along.append(section)
        stations = stations_to_cut(route, options.section_pitch, further)
        for at, station in enumerate(stations):
            monitor.check()
            monitor.report((number + at / len(stations)) / len(routes) * 0.8)
            one = source.cross_section(route, station, options.section_reach)
            if one.ground:
                across.append(one)
            else:
                empty.append(f"{route.name} {station_words(station)}".strip())
    if not across:
        raise Unsuitable(
            Text(
                "No ground was measured along the route.",
                "路線に沿って計測された地盤がありません。",
            ),
            Text.same(", ".join(route.name for route in routes) or "-"),
            Text(
                "Import the drives that measured it, or correct the centre line; nothing was"
                " written.",
                "計測した点群を取り込むか、中心線を修正してください。何も書き込まれていません。",
            ),
        )
    _tell_empty(delivery, empty)
    return along, across


def _tell_empty(delivery: MapDelivery, empty: Sequence[str]) -> None:
    if empty:
        first = ", ".join(empty[:3])
        delivery.tell(
            Text(
                f"{len(empty)} stations have no measured ground and no cross section,"
                f" among them {first}.",
                f"{len(empty)}か所の測点には計測された地盤がなく、"
                f"横断図がありません（例: {first}）。",
            )
        )


def _no_route() -> Unsuitable:
    return Unsuitable(
        Text("The map has no such route.", "該当する路線がありません。"),
        Text("sections along a route", "路線の縦断・横断図"),
        Text(
            "Draw the road's centre line and accept it; nothing was written.",
            "中心線を作図して確定してください。何も書き込まれていません。",
        ),
    )
