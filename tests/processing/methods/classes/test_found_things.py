"""Which points belong to curbs, plates and shafts: exact truth, and none where nothing is."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.classes.found_things import (
    CURB,
    POLE_LIKE,
    ROAD,
    SIGN,
    FoundPlate,
    FoundShaft,
    FoundThings,
    NearThings,
)
from processing.methods.classes.points_on_curbs import CurbEdges

ORIGIN = np.array([-8_000.0, -33_000.0, 20.0])


def line(y: float, z: float, *, turned: bool = False) -> NDArray[np.float64]:
    points = np.array([[0.0, y, z], [4.0, y, z], [10.0, y, z]]) + ORIGIN
    return points[::-1] if turned else points


def told_of(things: FoundThings, *places: tuple[float, float, float]) -> list[tuple[int, float]]:
    told = NearThings(things).told(np.array(places) + ORIGIN)
    return list(zip(told.codes.tolist(), told.chances.tolist(), strict=True))


@pytest.mark.parametrize("turned", [False, True])
def test_points_on_the_face_and_top_of_a_curb_are_told_and_those_beside_it_are_not(
    turned: bool,
) -> None:
    # The road lies to the south; the face leans back by 2 cm.
    curb = CurbEdges(line(3.02, 0.15, turned=turned), line(3.0, 0.0), 0.9)
    told = told_of(
        FoundThings(curbs=(curb,)),
        (5.0, 3.01, 0.07),
        (5.0, 3.10, 0.151),
        (5.0, 3.30, 0.15),
        (5.0, 3.10, 0.3),
        (14.0, 3.10, 0.15),
    )
    assert told == [(CURB, 0.9), (CURB, 0.9), (0, 0), (0, 0), (0, 0)]


@pytest.mark.parametrize("turned", [False, True])
def test_the_carriageway_lies_before_a_curb_and_what_stands_there_is_none(turned: bool) -> None:
    curb = CurbEdges(line(3.02, 0.15, turned=turned), line(3.0, 0.0), 0.9)
    told = told_of(
        FoundThings(curbs=(curb,)),
        (5.0, 2.90, 0.01),
        (5.0, 1.70, 0.06),
        (5.0, 2.00, 0.3),
        (5.0, 1.00, 0.03),
        (5.0, 4.00, 0.0),
    )
    assert told == [(ROAD, 0.9), (ROAD, 0.9), (0, 0), (0, 0), (0, 0)]


@pytest.mark.parametrize("turned", [False, True])
def test_behind_a_curb_and_level_with_its_top_there_is_no_road(turned: bool) -> None:
    curb = CurbEdges(line(3.02, 0.15, turned=turned), line(3.0, 0.0), 0.9)
    places = np.array(
        [
            [5.0, 3.2, 0.15],  # the stone
            [5.0, 5.0, 0.2],  # a footway that falls towards the road
            [5.0, 5.0, 0.6],  # above it
            [5.0, 6.5, 0.15],  # too far off
            [5.0, 3.6, 0.0],  # another carriageway behind a narrow median
            [5.0, 2.0, 0.0],
        ]
    )
    off_road = NearThings(FoundThings(curbs=(curb,))).told(places + ORIGIN).off_road
    assert off_road.tolist() == [0.9, 0.9, 0, 0, 0, 0]


def test_behind_a_curb_of_no_height_there_may_be_road() -> None:
    flush = CurbEdges(line(3.0, 0.02), line(3.0, 0.0), 0.9)
    told = NearThings(FoundThings(curbs=(flush,))).told(np.array([[5.0, 3.5, 0.02]]) + ORIGIN)
    assert told.off_road.tolist() == [0]


def test_points_within_the_outline_of_a_plate_and_in_its_plane_are_told() -> None:
    corners = np.array([[0, 0, 2.0], [0.6, 0, 2.0], [0.6, 0, 2.6], [0, 0, 2.6]]) + ORIGIN
    told = told_of(
        FoundThings(plates=(FoundPlate(corners, 0.8),)),
        (0.3, 0.01, 2.3),
        (0.3, 0.1, 2.3),
        (0.7, 0.0, 2.3),
    )
    assert told == [(SIGN, 0.8), (0, 0), (0, 0)]


def test_points_on_a_leaning_shaft_are_told_up_to_its_top() -> None:
    pole = FoundShaft(ORIGIN, np.array([0.1, 0.0]), 0.15, 0.01, 8.0, 0.7)
    told = told_of(
        FoundThings(shafts=(pole,)),
        (0.5 + 0.1, 0.0, 5.0),
        (0.5 + 0.3, 0.0, 5.0),
        (0.9, 0.0, 9.0),
        (0.1, 0.0, 0.01),
    )
    assert told == [(POLE_LIKE, 0.7), (0, 0), (0, 0), (0, 0)]


def test_a_point_on_two_things_belongs_to_the_surer() -> None:
    corners = np.array([[-0.3, 0.1, 2], [0.3, 0.1, 2], [0.3, 0.1, 2.6], [-0.3, 0.1, 2.6]]) + ORIGIN
    pole = FoundShaft(ORIGIN, np.zeros(2), 0.1, 0.0, 4.0, 0.95)
    both = FoundThings(plates=(FoundPlate(corners, 0.8),), shafts=(pole,))
    assert told_of(both, (0.0, 0.1, 2.3)) == [(POLE_LIKE, 0.95)]


def test_without_things_no_point_is_told() -> None:
    assert told_of(FoundThings(), (0.0, 0.0, 0.0), (1.0, 2.0, 3.0)) == [(0, 0.0), (0, 0.0)]
