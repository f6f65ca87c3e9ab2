"""Width lines lie square across the road, from edge to edge, where the widths are."""

from __future__ import annotations

import math
from itertools import count

import pytest

from processing.formats.drawings.dxf_labels import label_of
from processing.map.catalogue import Catalogue
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Vertex
from processing.map.routes.width_lines import width_lines
from resources import path_of

_CATALOGUE = read_catalogue(path_of("catalogue/level500.toml"))
_IDS = count()
_EAST, _NORTH = -8000.0, -36200.0


def _drawn(kind: str, *places: tuple[float, float], turned_deg: float = 0.0) -> Feature:
    cos, sin = math.cos(math.radians(turned_deg)), math.sin(math.radians(turned_deg))
    vertices = tuple(
        Vertex((_EAST + x * cos - y * sin, _NORTH + x * sin + y * cos, 10.0 + x / 100))
        for x, y in places
    )
    return Feature(f"f{next(_IDS)}", kind, _CATALOGUE[kind].geometry, vertices)


def _length(line: Feature) -> float:
    first, last = line.vertices
    return math.dist(first.xyz[:2], last.xyz[:2])


@pytest.mark.parametrize("turned_deg", [0.0, 33.0, 180.0])
def test_carriageway_and_footways_have_lines_of_their_own(turned_deg: float) -> None:
    features = [
        _drawn("road_center", (0, 0), (50, 0), turned_deg=turned_deg),
        _drawn("curb_upper", (-1, 3), (51, 3), turned_deg=turned_deg),
        _drawn("road_edge", (-1, 5), (51, 5), turned_deg=turned_deg),
        _drawn("road_edge", (-1, -3.5), (51, -3.5), turned_deg=turned_deg),
    ]
    lines = width_lines(features, _CATALOGUE, 20.0).added
    told = [(one.attributes["side"], one.attributes["name"]) for one in lines]
    assert told == [("middle", "6.5"), ("left", "2.0")] * 4  # 0, 20, 40 and 50 m
    assert all(_length(one) == pytest.approx(one.attributes["width_m"]) for one in lines)
    assert [one.attributes["note"] for one in lines[::2]] == [
        "No.0+0.00", "No.1+0.00", "No.2+0.00", "No.2+10.00",
    ]  # fmt: skip
    assert lines[2].vertices[0].xyz[2] == pytest.approx(10.2)
    label = label_of(_CATALOGUE["width_line"], lines[0])
    assert label is not None
    assert label.words == "6.5"


def test_a_width_that_changes_between_stations_has_a_line_too() -> None:
    features = [_drawn("road_center", (0, 0), (40, 0)), _drawn("road_edge", (0, -3), (40, -3))]
    features += [_drawn("road_edge", (0, 3), (29.5, 3)), _drawn("road_edge", (29.5, 4), (40, 4))]
    lines = width_lines(features, _CATALOGUE, 20.0).added
    assert [(one.attributes["note"], one.attributes["name"]) for one in lines] == [
        ("No.0+0.00", "6.0"), ("No.1+0.00", "6.0"), ("No.1+10.00", "7.0"), ("No.2+0.00", "7.0"),
    ]  # fmt: skip


def test_a_median_parts_the_carriageway() -> None:
    features = [
        _drawn("road_center", (0, 0), (20, 0)),
        _drawn("median", (-1, -0.5), (21, -0.5), (21, 1.0), (-1, 1.0)),
        _drawn("road_edge", (0, 6), (20, 6)),
        _drawn("road_edge", (0, -6), (20, -6)),
    ]
    lines = width_lines(features, _CATALOGUE, 20.0).added
    assert [(one.attributes["side"], one.attributes["width_m"]) for one in lines] == [
        ("left", 5.0), ("right", 5.5),
    ] * 2  # fmt: skip


def test_drawn_again_they_replace_their_own_and_leave_a_persons() -> None:
    by_hand = _drawn("width_line", (7, 0), (7, 3))
    road = [
        _drawn("road_center", (0, 0), (40, 0)),
        _drawn("road_edge", (0, 3), (40, 3)),
        _drawn("road_edge", (0, -3), (40, -3)),
    ]
    first = width_lines([*road, by_hand], _CATALOGUE, 20.0)
    assert len(first.added) == 3
    again = width_lines([*road, by_hand, *first.added], _CATALOGUE, 10.0)
    assert {one.id for one in again.removed} == {one.id for one in first.added}
    assert len(again.added) == 5


def test_without_route_or_edge_or_kind_nothing_is_drawn() -> None:
    centre, edge = _drawn("road_center", (0, 0), (40, 0)), _drawn("road_edge", (0, 3), (40, 3))
    assert width_lines([edge], _CATALOGUE, 20.0).is_empty
    assert width_lines([centre, edge], _CATALOGUE, 20.0).is_empty  # an edge on one side alone
    few = Catalogue((_CATALOGUE["road_center"],))
    assert width_lines([centre], few, 20.0).is_empty
