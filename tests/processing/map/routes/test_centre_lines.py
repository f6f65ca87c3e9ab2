"""Centre lines between edges that are known: midway, whatever the way was, and their shoulders."""

from __future__ import annotations

import math

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.drafting.polyline import Polyline
from processing.map.feature import Feature, Status, Vertex
from processing.map.routes.centre_lines import centre_lines
from processing.map.routes.road_widths import StationedRoute, accepted_with_kinds
from processing.map.routes.route import Route
from processing.map.routes.shoulders import ShoulderLines
from resources import path_of

LEFT_M, RIGHT_M, HIGH_M = 4.2, -3.6, 12.0


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def edge(id_: str, north: float, kind: str = "curb_lower", east: float = 60.0) -> Feature:
    places = np.arange(0.0, east + 1, 5.0)
    vertices = tuple(Vertex((float(x), north, HIGH_M)) for x in places)
    return Feature(id_, kind, Geometry.LINE, vertices, {})


EDGES = (edge("l", LEFT_M), edge("r", RIGHT_M))


def wavy(length_m: float = 60.0) -> Floats:
    east = np.arange(0.0, length_m, 0.5)
    return np.column_stack([east, -1.0 + 0.3 * np.sin(east / 9.0)])


def test_it_lies_midway_and_as_high_as_the_edges(catalogue: Catalogue) -> None:
    change = centre_lines(EDGES, catalogue, [wavy(), wavy() + 0.5])
    (line,) = change.added
    assert line.kind == "road_center"
    xyz = np.array([vertex.xyz for vertex in line.vertices])
    np.testing.assert_allclose(xyz[:, 1], (LEFT_M + RIGHT_M) / 2, atol=0.05)
    np.testing.assert_allclose(xyz[:, 2], HIGH_M, atol=1e-9)
    assert np.ptp(xyz[:, 0]) > 55.0


def test_drawn_again_it_replaces_its_own_line_alone(catalogue: Catalogue) -> None:
    (first,) = centre_lines(EDGES, catalogue, [wavy()]).added
    by_hand = edge("c", 0.0, "road_center")
    again = centre_lines((*EDGES, by_hand, first), catalogue, [wavy()])
    assert again.removed == (first,)
    assert len(again.added) == 1


@pytest.mark.parametrize(
    "features",
    [
        (),
        (EDGES[0],),
        tuple(one.with_status(Status.CANDIDATE) for one in EDGES),
        (edge("l", 30.0), edge("r", -30.0)),
    ],
    ids=["nothing", "one side", "candidates", "too far"],
)
def test_without_edges_on_both_sides_there_is_none(
    catalogue: Catalogue, features: tuple[Feature, ...]
) -> None:
    assert centre_lines(features, catalogue, [wavy()]).is_empty
    assert centre_lines(EDGES, catalogue, []).is_empty


def test_a_gap_of_an_edge_does_not_break_it(catalogue: Catalogue) -> None:
    short = edge("r", RIGHT_M, east=20.0)
    ends = (Vertex((40.0, RIGHT_M, HIGH_M)), Vertex((60.0, RIGHT_M, HIGH_M)))
    later = Feature("s", "curb_lower", Geometry.LINE, ends, {})
    (line,) = centre_lines((EDGES[0], short, later), catalogue, [wavy()]).added
    north = [vertex.xyz[1] for vertex in line.vertices]
    # Along the gap the line goes on as the way does.
    np.testing.assert_allclose(north, (LEFT_M + RIGHT_M) / 2, atol=0.25)


def test_a_shoulder_reaches_from_the_outermost_marking_to_the_edge(catalogue: Catalogue) -> None:
    painted = (edge("m", 3.0, "marking_line"), edge("n", 0.1, "marking_line"))
    lines = ShoulderLines(accepted_with_kinds(painted, catalogue))
    route = StationedRoute.of(
        Route("", 0.0, Polyline.of([(0.0, 0.0, 0.0), (60.0, 0.0, 0.0)])), 20.0
    )
    assert lines.width(route, 20.0, 4.2, is_left=True) == pytest.approx(1.2)
    assert math.isnan(lines.width(route, 20.0, 3.6, is_left=False))
    assert math.isnan(lines.width(route, 20.0, math.nan, is_left=True))
