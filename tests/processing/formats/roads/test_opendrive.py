"""OpenDRIVE is read back by a reader of its own: lanes end where the map's lines are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from lxml import etree

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of

_EAST, _NORTH, _RADIUS = -8000.0, -36200.0, 200.0
_LANE_TYPES = {"none", "driving", "shoulder", "sidewalk", "median"}  # e_laneType, those used
_MARKS = {"none", "solid", "broken", "curb"}  # e_roadMarkType, those used


@dataclass(frozen=True)
class _Place:
    """The reference line at a distance: where, and its heading."""

    x: float
    y: float
    heading: float

    def beside(self, t: float) -> tuple[float, float]:
        """A place to its left."""
        return self.x - t * math.sin(self.heading), self.y + t * math.cos(self.heading)


class _Road:
    """A road as a simulator reads it."""

    def __init__(self, element: Any) -> None:
        self.length = float(element.get("length"))
        self.pieces = [
            tuple(float(one.get(name)) for name in ("s", "x", "y", "hdg", "length"))
            for one in element.findall("planView/geometry")
        ]
        self.sections = element.findall("lanes/laneSection")

    def at(self, s: float) -> _Place:
        start, x, y, heading, _ = [one for one in self.pieces if one[0] <= s + 1e-9][-1]
        away = s - start
        return _Place(x + away * math.cos(heading), y + away * math.sin(heading), heading)

    def edges(self, s: float) -> dict[int, float]:
        """By lane how far its outer edge is, left positive."""
        section = [one for one in self.sections if float(one.get("s")) <= s + 1e-9][-1]
        found = {}
        for side, sign in (("left", 1), ("right", -1)):
            at = 0.0
            lanes = section.findall(f"{side}/lane")
            for lane in sorted(lanes, key=lambda one: abs(int(one.get("id")))):
                (width,) = lane.findall("width")
                ds = s - float(section.get("s"))
                at += sum(float(width.get(n)) * ds**k for k, n in enumerate("abcd"))
                found[int(lane.get("id"))] = sign * at
        return found


def _arc(offset: float, height: float = 10.0) -> tuple[Vertex, ...]:
    """80 m of a left curve, beside its middle to the left."""
    angles = np.linspace(0.0, 80.0 / _RADIUS, 161)
    radius = _RADIUS - offset
    xs, ys = radius * np.sin(angles), _RADIUS - radius * np.cos(angles)
    return tuple(Vertex((_EAST + x, _NORTH + y, height + 0.1 * a)) for x, y, a in
                 zip(xs.tolist(), ys.tolist(), angles.tolist(), strict=True))  # fmt: skip


def _line(id_: str, kind: str, offset: float, **own: Any) -> Feature:
    return Feature(id_, kind, Geometry.LINE, _arc(offset), own)


_STREET = (
    _line("centre", "road_center", 0.0, name="市道1号線", start_m=100.0),
    _line("middle", "marking_line", 0.0, type="solid", colour="yellow"),
    _line("between", "marking_line", 3.2, type="broken"),
    _line("curb-left", "curb_upper", 6.5),
    _line("edge-left", "road_edge", 9.0),
    _line("edge-right", "road_edge", -3.5),
)


def _written(folder: Path, *features: Feature, **options: Any) -> tuple[Any, list[Text]]:
    notes: list[Text] = []
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    request = ExportRequest(("opendrive",), folder, options=options)
    (path,) = export(features, catalogue, "EPSG:6677", request, tell=notes.append)
    assert path.suffix == ".xodr"
    return etree.parse(path).getroot(), notes


def test_lanes_end_where_the_lines_of_the_map_are(tmp_path: Path) -> None:
    root, _ = _written(tmp_path, *_STREET)
    (element,) = root.findall("road")
    assert (element.get("name"), element.get("rule")) == ("市道1号線", "LHT")
    road = _Road(element)
    drawn = {1: "between", 2: "curb-left", 3: "edge-left", -1: "edge-right"}
    lines = {one.id: shapely.LineString([v.xyz[:2] for v in one.vertices]) for one in _STREET}
    for s in np.linspace(1.0, road.length - 1.0, 50).tolist():
        place, edges = road.at(s), road.edges(s)
        assert edges.keys() == drawn.keys()
        for id_, away in edges.items():
            assert lines[drawn[id_]].distance(shapely.Point(place.beside(away))) < 0.02
    (first, *_) = road.sections
    types = {one.get("id"): one.get("type") for one in first.iter("lane")}
    assert types == {"3": "sidewalk", "2": "driving", "1": "driving", "0": "none", "-1": "driving"}
    marks = {one.get("id"): one.find("roadMark").get("type") for one in first.iter("lane")}
    assert marks == {"3": "none", "2": "curb", "1": "broken", "0": "solid", "-1": "none"}


def test_the_file_keeps_the_standards_rules(tmp_path: Path) -> None:
    root, _ = _written(tmp_path, *_STREET)
    header = root.find("header")
    assert (header.get("revMajor"), header.get("revMinor")) == ("1", "6")
    assert "+proj=tmerc" in header.findtext("geoReference")
    assert [one.tag for one in root] == ["header", "road"]
    (element,) = root.findall("road")
    assert [one.tag for one in element] == ["type", "planView", "elevationProfile", "lanes"]
    road = _Road(element)
    reached, end = 0.0, None
    for s, x, y, heading, length in road.pieces:
        assert s == pytest.approx(reached, abs=1e-5)
        assert length > 0
        if end is not None:
            assert (x, y) == pytest.approx(end, abs=1e-5)
        reached, end = s + length, (x + length * math.cos(heading), y + length * math.sin(heading))
    assert reached == pytest.approx(road.length, abs=1e-4)
    starts = [float(one.get("s")) for one in road.sections]
    assert starts[0] == 0.0
    assert all(before < after < road.length for before, after in zip(starts, starts[1:]))  # noqa: B905, RUF007 (the last has none after it)
    for section in road.sections:
        assert [one.tag for one in section] == ["left", "center", "right"]
        ids = [int(one.get("id")) for one in section.iter("lane")]
        assert ids == sorted(ids, reverse=True)
        for lane in section.iter("lane"):
            assert lane.get("type") in _LANE_TYPES
            order = ["link", "width", "roadMark"]
            assert [order.index(one.tag) for one in lane] == sorted(
                order.index(one.tag) for one in lane
            )
            assert lane.find("roadMark").get("type") in _MARKS
    elevations = element.findall("elevationProfile/elevation")
    assert float(elevations[0].get("a")) == pytest.approx(10.0, abs=1e-6)


def test_a_side_without_edge_has_no_lanes_and_a_route_without_any_is_refused(
    tmp_path: Path,
) -> None:
    root, _ = _written(tmp_path, _STREET[0], _STREET[-1])
    section = root.find("road/lanes/laneSection")
    assert section.find("left") is None
    assert section.find("right/lane").get("id") == "-1"
    for features in ((_STREET[0],), _STREET[1:]):
        with pytest.raises(Unsuitable, match="No route has an edge"):
            _written(tmp_path / "none", *features)


def test_a_footway_that_ends_narrows_to_nothing(tmp_path: Path) -> None:
    curb = _STREET[3]
    half = Feature(curb.id, curb.kind, curb.geometry, curb.vertices[:80], curb.attributes)
    root, _ = _written(tmp_path, _STREET[0], half, *_STREET[4:])
    road = _Road(root.find("road"))
    assert road.edges(10.0)[2] == pytest.approx(9.0, abs=0.02)
    last = road.edges(road.length - 1.0)
    assert last[max(last)] == pytest.approx(9.0, abs=0.02)
