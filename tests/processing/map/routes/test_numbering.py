"""Ledgers' numbers, stations and sides follow from the centre line, and stay when more is added."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Position, Status, Vertex
from processing.map.routes.numbering import number_along_routes
from processing.map.routes.route import PITCH_M, Route, station_words
from resources import path_of

_CATALOGUE = read_catalogue(path_of("catalogue/level500.toml"))
_EAST, _NORTH = -11_394.608, -35_139.915


def _at(east: float, north: float) -> Position:
    return (_EAST + east, _NORTH + north, 5.0)


def _centre(*local: tuple[float, float], **own: float | str) -> Feature:
    vertices = tuple(Vertex(_at(*one)) for one in local)
    return Feature("centre", "road_center", Geometry.LINE, vertices, own)


def _tree(id_: str, east: float, north: float, **own: str) -> Feature:
    return Feature(id_, "street_tree", Geometry.POINT, (Vertex(_at(east, north)),), own)


def _numbered(*features: Feature) -> dict[str, Feature]:
    change = number_along_routes(features, _CATALOGUE)
    return {one.id: one for one in features} | {
        pair.after.id: pair.after for pair in change.replaced
    }


# Eastwards for 100 m, then northwards.
_LINE = _centre((0.0, 0.0), (100.0, 0.0), (100.0, 50.0), route="市道1号線")


def test_trees_are_numbered_by_their_stations_with_route_and_side() -> None:
    now = _numbered(_tree("c", 97.0, 30.0), _tree("a", 10.5, 4.0), _tree("b", 43.25, -4.0), _LINE)
    told = {id_: now[id_].attributes for id_ in "abc"}
    assert [told[id_]["number"] for id_ in "abc"] == ["1", "2", "3"]
    assert {told[id_]["route"] for id_ in "abc"} == {"市道1号線"}
    lamp = Feature("l", "street_light", Geometry.POINT, (Vertex(_at(97.0, 30.0)),))
    lit = _numbered(lamp, _LINE)["l"].attributes
    assert (lit["station"], lit["side"]) == ("No.6+10.00", "left")


def test_a_number_stays_when_more_is_added_and_what_is_written_is_never_changed() -> None:
    first = _numbered(
        _tree("b", 40.0, 4.0), _tree("x", 60.0, 4.0, number="街-7", route="旧道"), _LINE
    )
    assert first["b"].attributes["number"] == "8"
    assert first["x"].attributes["number"] == "街-7"
    assert first["x"].attributes["route"] == "旧道"
    now = _numbered(*first.values(), _tree("a", 10.0, 4.0))
    assert now["b"] == first["b"]
    assert now["a"].attributes["number"] == "9"
    assert number_along_routes(tuple(now.values()), _CATALOGUE).is_empty


def test_a_guard_rail_says_where_it_begins_and_ends() -> None:
    rail = Feature(
        "rail", "guard_rail", Geometry.LINE, tuple(Vertex(_at(x, -3.0)) for x in (55.0, 30.0, 12.5))
    )
    told = _numbered(rail, replace(_LINE, attributes={"name": "県道", "start_m": 1000.0}))["rail"]
    assert told.attributes["start_station"] == "No.50+12.50"
    assert told.attributes["end_station"] == "No.52+15.00"
    assert (told.attributes["side"], told.attributes["route"]) == ("right", "県道")


def test_without_a_centre_line_far_from_it_or_undecided_nothing_is_said() -> None:
    assert number_along_routes((_tree("a", 0.0, 3.0),), _CATALOGUE).is_empty
    assert number_along_routes((_tree("a", 0.0, 300.0), _LINE), _CATALOGUE).is_empty
    doubted = replace(_tree("a", 0.0, 3.0), status=Status.CANDIDATE)
    assert number_along_routes((doubted, _LINE), _CATALOGUE).is_empty


@given(st.floats(-500, 5000))
def test_a_station_reads_back_to_the_centimetre(station_m: float) -> None:
    number, rest = station_words(station_m).removeprefix("No.").split("+")
    assert 0.0 <= float(rest) < PITCH_M
    assert int(number) * PITCH_M + float(rest) == pytest.approx(station_m, abs=0.0051)


@given(st.floats(0.1, 99.9), st.floats(-20, 20))
def test_the_foot_of_a_place_is_its_station_and_the_distance_its_offset(
    along: float, across: float
) -> None:
    found, distance = Route.of(_centre((0.0, 0.0), (100.0, 0.0))).position(_at(along, across))
    assert found.station_m == pytest.approx(along, abs=1e-6)
    assert found.offset_m == pytest.approx(across, abs=1e-6)
    assert distance == pytest.approx(abs(across), abs=1e-6)
