"""The measured points of a feature are kept as runs and follow them to another order."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.map.feature import PointReference, Vertex, with_points_at
from processing.map.own_points import OwnPoints, own_points
from tests.processing.project.drawn import with_own_points


@given(st.sets(st.integers(0, 10**12), min_size=1, max_size=60))
def test_points_come_back_from_their_runs(numbers: set[int]) -> None:
    packed = own_points("left", sorted(numbers, reverse=True))
    assert packed.numbers(10**12 + 1).tolist() == sorted(numbers)
    assert packed.count == len(numbers)


def test_neighbours_of_scan_lines_are_one_run_each() -> None:
    rows = np.array([[100, 101, 102], [1100, 1101, 1102]])
    assert own_points("left", rows.ravel()).runs == "100:3 997:3"


def test_points_that_a_drive_does_not_have_are_left_out() -> None:
    assert OwnPoints("left", "2:3 4:999999999999999").numbers(11).tolist() == [2, 3, 4, 9, 10]
    assert OwnPoints("left", "5:1").numbers(3).size == 0


@pytest.mark.parametrize("damaged", ["", "5", "5:", "-1:2", "1:2,3:4", "a:b", "1:2 "])
def test_a_damaged_text_is_refused(damaged: str) -> None:
    with pytest.raises(ValueError, match="no runs of points"):
        OwnPoints("left", damaged)


def test_points_follow_a_drive_into_another_order() -> None:
    feature = with_own_points("tree", ("left", [1, 2]), ("right", [0]))
    moved = with_points_at(feature, {"left": np.array([7, 5, 3, 1])})
    left, right = moved.own_points
    assert left.numbers(8).tolist() == [3, 5]
    assert right.numbers(8).tolist() == [0]
    assert with_points_at(feature, {"other": np.array([0])}) is feature


def test_who_moves_a_feature_moves_it_away_from_its_points() -> None:
    feature = with_own_points("tree", ("left", [1, 2]))
    elsewhere = (Vertex((9.0, 9.0, 9.0), PointReference("left", 0)),)
    assert feature.with_vertices(elsewhere).own_points == ()
