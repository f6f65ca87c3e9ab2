"""Signs of given positions: what is looked for where shapes and sizes are given, too."""

from __future__ import annotations

import math

import numpy as np

from processing.methods.road.signs.asked_signs import doubtful_numbers, sought_about
from processing.methods.road.signs.initial_positions import InitialPosition
from processing.methods.road.signs.sign_shapes import looked_for

PLACE = np.array([10.0, 20.0, 3.0])


def given(shape: str = "", size_m: float = math.nan, away_m: float = 1.0) -> InitialPosition:
    return InitialPosition(2, PLACE[0] + away_m, PLACE[1], 3.0, shape, size_m)


def test_only_the_given_shape_is_looked_for_in_all_its_sizes() -> None:
    sought = sought_about(PLACE, [given("diamond")], [0])
    assert sought is not None
    assert {one.shape for one in sought.shapes} == {"diamond"}
    assert len(sought.shapes) > 1
    assert not sought.with_rectangles


def test_only_the_given_size_is_looked_for_even_one_that_no_standard_has() -> None:
    for size_m in (0.6, 0.72):
        sought = sought_about(PLACE, [given("circle", size_m)], [0])
        assert sought is not None
        assert [one.size_m for one in sought.shapes] == [size_m]


def test_rectangles_have_no_template() -> None:
    sought = sought_about(PLACE, [given("rectangle", 0.9)], [0])
    assert sought == ((), True)


def test_neighbours_of_other_shapes_are_looked_for_too() -> None:
    sought = sought_about(PLACE, [given("circle", 0.6), given("triangle", 0.8)], [0])
    assert sought is not None
    assert {(one.shape, one.size_m) for one in sought.shapes} == {
        ("circle", 0.6),
        ("triangle", 0.8),
    }


def test_a_neighbour_of_unknown_shape_may_have_any() -> None:
    sought = sought_about(PLACE, [given("circle", 0.6), given()], [0])
    assert sought is not None
    assert sought.shapes == looked_for()


def test_nothing_is_looked_for_anew_far_from_doubtful_positions() -> None:
    assert sought_about(PLACE, [given("circle"), given("circle", away_m=40.0)], [1]) is None


def test_positions_without_a_plate_are_doubtful_where_a_shape_was_given() -> None:
    assert doubtful_numbers({}, [given(), given("circle")]) == (1,)
