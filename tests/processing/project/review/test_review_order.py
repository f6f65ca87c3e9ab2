"""Where a feature is looked at, and in which order candidates are judged."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.map.catalogue import Geometry
from processing.map.feature import Feature, PointReference, Position, Provenance, Status, Vertex
from processing.map.feature_middle import middle_of
from processing.project.review.review_order import along_street, worst_first
from tests.processing.image.recordings import small_drive


def feature(id: str, *positions: Position, geometry: Geometry = Geometry.LINE) -> Feature:
    return Feature(id, "curb_lower", geometry, tuple(map(Vertex, positions)))


def on_point(id: str, drive: str, point: int, confidence: float = 0.5) -> Feature:
    vertex = Vertex((0.0, 0.0, 0.0), PointReference(drive, point))
    made = Provenance("finder", 1, {}, confidence, "run")
    return Feature(id, "sign", Geometry.POINT, (vertex,), {}, Status.CANDIDATE, made)


def test_a_point_is_looked_at_where_it_is() -> None:
    vertex = Vertex((1.0, 2.0, 3.0), PointReference("left", 5))
    assert middle_of(Feature("p", "sign", Geometry.POINT, (vertex,))) is vertex


def test_a_line_is_looked_at_half_way_along_it() -> None:
    middle = middle_of(feature("l", (0, 0, 0), (1, 0, 0), (10, 0, 5)))
    length = 1 + np.hypot(9, 5)
    share = (length / 2 - 1) / np.hypot(9, 5)
    assert middle.xyz == pytest.approx((1 + 9 * share, 0, 5 * share))
    assert middle.measured is None


def test_a_measured_vertex_near_the_middle_of_a_line_is_looked_at_itself() -> None:
    positions = [(float(x), 0.0, 0.0) for x in (0, 4, 9, 10)]
    vertices = tuple(Vertex(xyz, PointReference("left", n)) for n, xyz in enumerate(positions))
    assert middle_of(Feature("l", "curb_lower", Geometry.LINE, vertices)) is vertices[1]


def test_the_ends_of_a_line_are_not_its_middle() -> None:
    ends = tuple(Vertex((x, 0.0, 0.0), PointReference("left", 1)) for x in (0.0, 10.0))
    middle = middle_of(Feature("l", "curb_lower", Geometry.LINE, ends))
    assert middle.xyz == (5.0, 0.0, 0.0)


def test_a_line_without_length_is_looked_at_where_it_is() -> None:
    assert middle_of(feature("l", (3, 3, 3), (3, 3, 3))).xyz == (3, 3, 3)


def test_an_area_is_looked_at_in_its_middle_on_its_own_slope() -> None:
    ring = [(0, 0, 10), (4, 0, 12), (4, 2, 12), (0, 2, 10)]
    middle = middle_of(feature("a", *ring, geometry=Geometry.AREA))
    assert middle.xyz == pytest.approx((2, 1, 11))


def test_an_area_whose_middle_is_outside_is_looked_at_at_a_vertex_of_it() -> None:
    ring = [(0, 0, 0), (9, 0, 0), (9, 9, 0), (8, 9, 0), (8, 1, 0), (1, 1, 0), (1, 9, 0), (0, 9, 0)]
    area = feature("a", *ring, geometry=Geometry.AREA)
    assert middle_of(area) in area.vertices


def test_an_area_without_area_is_looked_at_at_a_vertex_of_it() -> None:
    area = feature("a", (0, 0, 0), (1, 0, 0), (2, 0, 0), geometry=Geometry.AREA)
    assert middle_of(area) in area.vertices


def test_the_least_certain_come_first_and_equals_stay_as_they_were_found() -> None:
    features = [
        on_point(name, "left", 0, one)
        for name, one in zip("abcd", (0.9, 0.1, 0.5, 0.1), strict=True)
    ]
    assert worst_first(features) == ["b", "d", "c", "a"]


def test_along_the_street_goes_by_the_order_of_measuring_drive_by_drive(tmp_path: Path) -> None:
    drive, _ = small_drive(tmp_path / "left")
    features = [
        on_point("of a drive that is gone", "removed", 0),
        on_point("late", drive.id, 90),
        on_point("early", drive.id, 3),
    ]
    assert along_street(features, [drive]) == ["early", "late", "of a drive that is gone"]


def test_without_drives_the_order_is_that_of_finding() -> None:
    features = [
        feature(name, (x, 0, 0), (x, 1, 0)) for name, x in zip("abc", (5.0, 1.0, 3.0), strict=True)
    ]
    assert along_street(features, []) == ["a", "b", "c"]
