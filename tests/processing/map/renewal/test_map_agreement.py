"""Precision and recall by a map drawn separately: counts of things, metres of lines."""

from __future__ import annotations

import math

import pytest

from processing.core.monitor import SilentMonitor
from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Vertex, new_feature_id
from processing.map.renewal.map_agreement import KindAgreement, agreement


def _feature(kind: str, geometry: Geometry, *xy: tuple[float, float]) -> Feature:
    return Feature(new_feature_id(), kind, geometry, tuple(Vertex((x, y, 5.0)) for x, y in xy))


def _tree(x: float) -> Feature:
    return _feature("street_tree", Geometry.POINT, (x, 0.0))


def _edge(start: float, end: float) -> Feature:
    return _feature("road_edge", Geometry.LINE, (start, 5.0), (end, 5.0))


def _judged(truth: list[Feature], found: list[Feature]) -> dict[str, KindAgreement]:
    return {one.kind: one for one in agreement(truth, found, 0.5, SilentMonitor())}


def test_things_are_counted_within_the_outline_of_the_truth() -> None:
    truth = [*map(_tree, (0.0, 10.0, 20.0, 30.0)), _edge(0.0, 30.0)]
    # One is missed, one is 2 m off, one is wrong, one is outside of what was checked.
    found = [*map(_tree, (0.1, 12.0, 20.2, 25.0, 300.0)), _edge(0.0, 15.0)]
    trees = _judged(truth, found)["street_tree"]
    assert (trees.truth, trees.found) == (4, 4)
    assert trees.precision == pytest.approx(2 / 4)
    assert trees.recall == pytest.approx(2 / 4)


def test_lines_are_measured() -> None:
    edge = _judged([_edge(0.0, 40.0)], [_edge(0.0, 30.0)])["road_edge"]
    assert edge.is_line
    assert edge.precision == 1.0
    assert edge.recall == pytest.approx(0.75 + 0.5 / 40, abs=0.01)


def test_a_kind_that_nobody_found_has_no_precision() -> None:
    trees = _judged([_tree(0.0), _tree(5.0), _edge(0.0, 9.0)], [_edge(0.0, 9.0)])["street_tree"]
    assert trees.recall == 0.0
    assert math.isnan(trees.precision)
    assert agreement([], [_tree(0.0)], 0.5, SilentMonitor()) == ()
