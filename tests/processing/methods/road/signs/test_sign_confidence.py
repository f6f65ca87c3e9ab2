"""What paint and the end of a recording say against a plate."""

from __future__ import annotations

import math

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.methods.road.signs.plates import Plate, PlateEvidence
from processing.methods.road.signs.sign_confidence import (
    best_chance_of,
    chance_of,
    facts_of,
    facts_with_post,
)
from processing.methods.road.signs.sign_shapes import RECTANGLE, SignShape, shape_of

BACK = PlateEvidence(
    0.0,
    0.1,
    0.95,
    16,
    0.3,
    20,
    300,
    0.002,
    0.0,
    0.0,
    front_seen=False,
    is_facing_sure=True,
    thick=0.0,
    both_seen=False,
    shine=-0.5,
    cut=0.0,
    over_board=False,
    faint=0.0,
)
"""Of a plate of which the metal back alone was seen, and of its rim a part."""


ALONG = np.array([0.0, 1.0])


def chance(evidence: PlateEvidence, way: Floats = ALONG) -> float:
    outline = np.array([[0.3, 0.0, 2.3], [-0.3, 0.0, 2.3], [0.0, 0.0, 2.9]])
    plate = Plate(
        shape_of("circle", 0.6),
        np.array([0.0, 0.0, 2.6]),
        outline,
        np.array([0.0, 1.0, 0.0]),
        evidence,
        -1,
        np.arange(10),
    )
    return chance_of(facts_of(plate, 0.0, way))


@pytest.mark.parametrize(
    "worse",
    [
        BACK._replace(shine=2.0),
        BACK._replace(both_seen=True),
        BACK._replace(over_board=True),
    ],
    ids=["as bright as paint", "neither side shines", "a bus stop"],
)
def test_a_dull_plate_that_is_no_back_of_a_sign_is_hardly_one(worse: PlateEvidence) -> None:
    assert chance(BACK) > 0.7
    assert chance(worse) < 0.5


def test_a_dull_plate_on_which_the_recording_ends_is_less_surely_a_sign() -> None:
    assert chance(BACK._replace(cut=1.0)) < chance(BACK) - 0.05


def test_a_dull_plate_that_looks_across_the_road_is_hardly_a_sign_and_a_bright_one_may_be() -> None:
    across = np.array([1.0, 0.0])
    assert chance(BACK, across) < 0.5
    face = BACK._replace(bright=1.0, shine=9.0, sectors=0.9)
    assert chance(face, across) > 0.5


def test_what_shines_far_less_than_faces_do_is_less_surely_one() -> None:
    patch = BACK._replace(bright=0.9, shine=6.0, explained=0.5, open_ends=8)
    assert chance(patch._replace(faint=0.7)) < 0.5 < chance(patch)


def test_where_nothing_of_a_recording_shines_paint_says_nothing() -> None:
    assert chance(BACK._replace(both_seen=True, shine=math.nan)) == chance(BACK)


def test_what_shines_is_no_paint_though_one_side_is_dull() -> None:
    face = BACK._replace(bright=1.0, shine=9.0)
    assert chance(face._replace(both_seen=True)) == chance(face) > 0.9


def test_a_large_board_high_up_is_a_sign_where_an_arm_holds_it() -> None:
    outline = np.array([[1.5, 0.0, 5.2], [-1.5, 0.0, 5.2], [-1.5, 0.0, 7.2], [1.5, 0.0, 7.2]])
    plate = Plate(
        SignShape(RECTANGLE, 3.0, 2.0), np.array([0.0, 0.0, 6.2]), outline,
        np.array([0.0, 1.0, 0.0]), BACK._replace(sectors=0.95), -1, np.arange(10),
    )  # fmt: skip
    facts = facts_of(plate, 0.0, ALONG)
    assert chance_of(facts_with_post(facts, None)) < 0.1 < best_chance_of(facts)
    assert chance_of(facts_with_post(facts, "cantilever")) > 0.5


def test_what_shines_far_above_any_road_is_no_sign() -> None:
    def chance_at(middle_m: float) -> float:
        outline = np.array([[1.5, 0.0, -1.0], [-1.5, 0.0, -1.0], [-1.5, 0.0, 1.0], [1.5, 0.0, 1.0]])
        plate = Plate(
            SignShape(RECTANGLE, 3.0, 2.0), np.array([0.0, 0.0, middle_m]),
            outline + np.array([0.0, 0.0, middle_m]), np.array([0.0, 1.0, 0.0]),
            BACK._replace(bright=1.0, shine=9.0, explained=0.7), -1, np.arange(10),
        )  # fmt: skip
        return chance_of(facts_with_post(facts_of(plate, 0.0, ALONG), None))

    assert chance_at(6.2) == chance_at(8.9) > 0.7
    assert chance_at(20.0) < 0.5
