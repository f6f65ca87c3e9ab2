"""Routes as LandXML: alignments with the ground along and across them, and the surface between."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import cast

import numpy as np
import shapely

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.formats.map_delivery import LandXmlOptions, MapDelivery, Position
from processing.formats.sections.cut_routes import cut_routes
from processing.formats.sections.route_sections import RouteSection
from processing.formats.surfaces.landxml_writing import (
    LandXmlFacts,
    LandXmlForm,
    WrittenSurface,
    write_landxml,
)
from processing.map.catalogue import Geometry
from processing.map.routes.road_widths import CARRIAGEWAY_CODES, CURB_KINDS, ROAD_EDGE_CODES
from processing.map.routes.route import station_words
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.geometry.triangulation import triangulate_ground
from processing.methods.earthwork.sections.drawing_parts import DrawnSection, SectionedLine

_LONGEST_SHARE = 1.5
"""No edge of the surface is longer than this many steps from section to section."""


def write_landxml_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write the routes' alignments, the ground along and across them, and a surface of each.

    A surface is made of the ground of the cross sections: it is as fine as their distance. Plain
    LandXML has the lines of curbs and road edges besides, as break lines.

    Raises
    ------
    Unsuitable
        The map has no such route, no ground was measured along it, or the form has no name for
        the reference system.
    OutOfRange
        A station that can't be read.
    """
    options = delivery.options_of(LandXmlOptions)
    along, across = cut_routes(delivery, options, monitor)
    form = cast("LandXmlForm", options.landxml_form)
    lines, surfaces = [], []
    for route in {id(one.route): one.route for one in across}.values():
        own = [one for one in across if one.route is route]
        ground = tuple(part for one in along if one.route is route for part in one.ground)
        _, xyz = own[0].stations.measured_positions()
        sections = tuple(_section(one) for one in own)
        lines.append(SectionedLine(route.name, xyz[:, :2], route.start_m, sections, ground))
        surface = _surface(own, options, monitor)
        if surface is not None:
            near = shapely.LineString(xyz[:, :2]).buffer(options.section_reach)
            breaks = tuple(_break_lines(delivery, near)) if form == "LandXML" else ()
            surfaces.append(WrittenSurface(surface, breaklines=breaks))
    facts = LandXmlFacts(delivery.name, delivery.crs, options.sheet_heights)
    path = position(f"{delivery.name}.xml")
    write_landxml(path, surfaces, facts, lines=lines, form=form, monitor=monitor)


def _section(section: RouteSection) -> DrawnSection:
    """A cross section with no numbers in the gaps of its ground."""
    places: list[Floats] = []
    for part in section.ground:
        if places:
            between = (places[-1][-1, 0] + part[0, 0]) / 2
            places.append(np.array([[between, np.nan]]))
        places.append(part)
    ground = np.concatenate(places)
    station = section.station_m or 0.0
    none = np.full(len(ground), np.nan)
    name = station_words(station)
    return DrawnSection(station, name, ground[:, 0], ground[:, 1], none, 0.0, 0.0)


def _surface(
    sections: Sequence[RouteSection], options: LandXmlOptions, monitor: Monitor
) -> TriangleSurface | None:
    """The ground between cross sections; None where there is too little of it.

    Stretches of ground are cut into short ones, so that long edges are those across gaps.
    """
    places = [
        (*section.place_of(offset), height)
        for section in sections
        for part in section.ground
        for offset, height in shapely.get_coordinates(
            shapely.segmentize(shapely.LineString(part), options.section_pitch / 2)
        ).tolist()
    ]
    longest = _LONGEST_SHARE * options.section_pitch
    try:
        surface = triangulate_ground(np.array(places), (), monitor, longest_m=longest)
    except Unsuitable:  # a single section is no surface
        return None
    return TriangleSurface(surface.xyz, surface.corners, sections[0].route.name)


def _break_lines(delivery: MapDelivery, near: shapely.Geometry) -> Iterable[Floats]:
    for feature in delivery.features:
        kind = delivery.catalogue[feature.kind]
        is_edge = kind.id in CURB_KINDS or kind.dm_code in ROAD_EDGE_CODES | CARRIAGEWAY_CODES
        if not is_edge or feature.geometry is not Geometry.LINE:
            continue
        xyz = np.array([vertex.xyz for vertex in feature.vertices])
        if near.intersects(shapely.LineString(xyz[:, :2])):
            yield xyz
