"""One of each plate: found twice it is one, back to back they are two, its parts are none."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from processing.methods.road.signs.distinct_plates import distinct_plates
from processing.methods.road.signs.plates import Plate, PlateEvidence
from processing.methods.road.signs.sign_shapes import RECTANGLE, SignShape, shape_of

EVIDENCE = PlateEvidence(
    1.0,
    0.0,
    1.0,
    8,
    1.0,
    8,
    100,
    0.002,
    0.0,
    0.0,
    front_seen=True,
    is_facing_sure=True,
    thick=0.0,
    both_seen=True,
    shine=9.0,
    cut=0.0,
    over_board=False,
    faint=0.0,
)
LIKELY = 0.1


def plate(
    shape: SignShape, centre: tuple[float, float, float], facing_deg: float = 0.0, points: int = 100
) -> Plate:
    turn = math.radians(facing_deg)
    normal = np.array([math.sin(turn), math.cos(turn), 0.0])
    evidence = EVIDENCE._replace(points=points)
    none = np.empty(0, np.int64)
    return Plate(shape, np.array(centre), np.zeros((4, 3)), normal, evidence, -1, none)


def test_of_a_plate_that_was_found_twice_the_surer_one_is_left() -> None:
    circle, square = shape_of("circle", 0.6), shape_of("square", 0.6)
    twice = [plate(square, (0.0, 0.03, 2.0)), plate(circle, (0.0, 0.0, 2.0))]
    assert distinct_plates(twice, np.array([0.6, 0.9]), LIKELY) == [1]


def test_of_two_that_are_as_sure_the_one_with_more_points_is_left() -> None:
    square, piece = shape_of("square", 0.9), shape_of("square", 0.6)
    whole = plate(square, (0.0, 0.0, 2.0))
    part = plate(piece, (0.0, 0.0, 2.17))
    part = replace(part, evidence=part.evidence._replace(points=whole.evidence.points - 1))
    assert distinct_plates([part, whole], np.array([0.996, 0.97]), LIKELY) == [1]


def test_plates_on_two_sides_of_a_post_are_two() -> None:
    circle = shape_of("circle", 0.6)
    both = [plate(circle, (0.0, 0.06, 2.0)), plate(circle, (0.0, -0.06, 2.1), 180.0)]
    assert distinct_plates(both, np.array([0.9, 0.8]), LIKELY) == [0, 1]


def test_pieces_of_a_large_plate_are_no_plates_and_what_hangs_below_it_is_one() -> None:
    guide, small = SignShape(RECTANGLE, 3.0, 2.0), shape_of("square", 0.45)
    found = [
        plate(small, (1.0, 0.0, 6.5), points=30),
        plate(guide, (0.0, 0.0, 6.0), points=2_000),
        plate(small, (0.0, 0.0, 4.7), points=80),
    ]
    assert distinct_plates(found, np.array([0.95, 0.9, 0.8]), LIKELY) == [1, 2]
