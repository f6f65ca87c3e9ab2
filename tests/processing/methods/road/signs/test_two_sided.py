"""The other side of a board: parallel, turned away, close behind it, and as dull."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from processing.methods.road.signs.plates import Plate
from processing.methods.road.signs.sign_confidence import facts_of, facts_with_other_side
from processing.methods.road.signs.sign_shapes import RECTANGLE, SignShape
from processing.methods.road.signs.two_sided import with_other_side
from tests.processing.methods.road.signs.test_distinct_plates import EVIDENCE, plate

BOARD = SignShape(RECTANGLE, 0.9, 0.9)
ALONG = np.array([0.0, 1.0])


def dull(centre: tuple[float, float, float], facing_deg: float = 0.0, shine: float = 0.3) -> Plate:
    one = plate(BOARD, centre, facing_deg)
    return replace(
        one,
        evidence=EVIDENCE._replace(bright=0.0, shine=shine, both_seen=False),
        pieces=np.arange(4),
    )


def test_sides_of_a_board_are_each_others_other_side() -> None:
    sides = [dull((0.0, 0.0, 2.0)), dull((0.2, -0.1, 2.1), 180.0), dull((5.0, 0.0, 2.0), 180.0)]
    assert with_other_side(sides) == [1, 0, None]
    assert with_other_side([]) == []


def test_plates_that_look_the_same_way_or_stand_apart_are_not_one_board() -> None:
    assert with_other_side([dull((0.0, 0.0, 2.0)), dull((0.0, -0.1, 2.0))]) == [None, None]
    assert with_other_side([dull((0.0, 0.0, 2.0)), dull((0.0, -0.5, 2.0), 180.0)]) == [None, None]
    assert with_other_side([dull((0.0, 0.0, 2.0)), dull((1.2, -0.1, 2.0), 180.0)]) == [None, None]


def test_signs_back_to_back_shine_and_are_two() -> None:
    shining = [dull((0.0, 0.0, 2.0), shine=9.0), dull((0.0, -0.1, 2.0), 180.0, shine=9.0)]
    assert with_other_side(shining) == [None, None]


def test_a_board_whose_sides_are_both_dull_is_surely_no_sign() -> None:
    board, other = dull((0.0, 0.0, 2.0)), dull((0.0, -0.1, 2.0), 180.0, shine=0.7)
    alone = facts_of(replace(board, outline=np.full((4, 3), 1.8)), 0.0, ALONG)
    assert alone.painted == 0.0
    assert facts_with_other_side(alone, board, other).painted == 1.0


def test_where_nothing_shines_a_second_side_tells_nothing() -> None:
    nothing = float("nan")
    board, other = dull((0.0, 0.0, 2.0), shine=nothing), dull((0.0, -0.1, 2.0), 180.0, nothing)
    alone = facts_of(replace(board, outline=np.full((4, 3), 1.8)), 0.0, ALONG)
    assert with_other_side([board, other]) == [1, 0]
    assert facts_with_other_side(alone, board, other).painted == 0.0
