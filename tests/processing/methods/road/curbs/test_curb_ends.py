"""Where a line goes on along other ground than its curb's."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.curbs.edges.curb_ends import own_part
from processing.methods.road.curbs.edges.curb_joins import join_edges
from processing.methods.road.curbs.edges.curb_lines import CurbLine, lines_of
from processing.methods.road.curbs.edges.edge_measures import (
    ERROR_ACROSS,
    FACE_POINTS,
    HIGH_OFF,
    LOW_OFF,
    LOWER_ABOVE,
    LOWER_ACROSS,
    UPPER_ABOVE,
    UPPER_ACROSS,
)
from tests.processing.methods.road.curbs.test_curb_lines import approximate_line_of, measures_of

COUNT, END = 120, 80
NOISE_M, SOIL_M = 0.002, 0.005


def curb() -> NDArray[np.float64]:
    """Measures along a curb of 30 m whose surfaces are even."""
    measures = measures_of(COUNT)
    measures[:, [LOW_OFF, HIGH_OFF]] = NOISE_M
    return measures


def lines(*measures: NDArray[np.float64]) -> list[CurbLine]:
    return list(lines_of(approximate_line_of(COUNT), join_edges(measures, 0.45), 8.0))


def test_a_curb_goes_on_where_its_face_is_not_seen() -> None:
    measures = curb()
    measures[END:, FACE_POINTS] = 0.0
    assert [line.is_seen.size for line in lines(measures)] == [COUNT]


@pytest.mark.parametrize("is_turned", [False, True])
def test_a_curb_ends_where_no_face_is_seen_above_rough_ground(is_turned: bool) -> None:
    measures = curb()
    measures[END:, FACE_POINTS], measures[END:, LOW_OFF] = 0.0, SOIL_M
    assert [line.is_seen.size for line in lines(measures[:: -1 if is_turned else 1])] == [END]


def test_leaves_before_a_face_that_is_seen_end_no_curb() -> None:
    measures = curb()
    measures[END:, LOW_OFF] = SOIL_M
    assert [line.is_seen.size for line in lines(measures)] == [COUNT]


def test_a_planting_strip_is_no_dropped_curb() -> None:
    measures = curb()
    measures[END:, HIGH_OFF] = SOIL_M
    measures[END:, UPPER_ABOVE] = measures[END:, LOWER_ABOVE] + 0.04
    assert [line.is_seen.size for line in lines(measures)] == [END]


@pytest.mark.parametrize("is_turned", [False, True])
def test_a_curb_ends_where_its_edge_lies_now_here_now_there(is_turned: bool) -> None:
    measures = curb()
    aside = np.random.default_rng(3).normal(0.0, 0.04, COUNT - END)
    measures[END:, [LOWER_ACROSS, UPPER_ACROSS]] += aside[:, None]
    (line,) = lines(measures[:: -1 if is_turned else 1])
    assert line.is_seen.size == pytest.approx(END, abs=2)


def test_a_curb_ends_where_its_place_is_no_longer_known() -> None:
    measures = curb()
    measures[END:, ERROR_ACROSS] = 0.08
    measures[40:50, ERROR_ACROSS] = 0.08
    assert [line.is_seen.size for line in lines(measures)] == [END]


def test_stones_that_have_settled_and_places_without_a_face_end_no_curb() -> None:
    measures = curb()
    random = np.random.default_rng(3)
    aside = np.repeat(random.normal(0.0, 0.008, 10), 4)
    measures[END:, [LOWER_ACROSS, UPPER_ACROSS]] += aside[:, None]
    hidden = slice(10, 30)
    measures[hidden, FACE_POINTS] = 0.0
    measures[hidden, LOWER_ACROSS] += random.normal(0.0, 0.04, 20)
    assert [line.is_seen.size for line in lines(measures)] == [COUNT]


def test_rough_places_inside_and_short_ends_are_kept() -> None:
    measures = curb()
    measures[40:60, HIGH_OFF] = SOIL_M
    measures[-6:, HIGH_OFF] = SOIL_M
    assert [line.is_seen.size for line in lines(measures)] == [COUNT]


def test_what_one_drive_sees_well_is_not_rough() -> None:
    far = curb()
    far[END:, [LOW_OFF, HIGH_OFF]] = SOIL_M
    assert [line.is_seen.size for line in lines(far, curb())] == [COUNT]


def test_a_line_whose_face_looks_away_is_left_as_it_is() -> None:
    measures = curb()
    measures[:, FACE_POINTS] = 0.0
    measures[END:, [LOW_OFF, HIGH_OFF]] = SOIL_M
    edges = join_edges([measures], 0.45)
    assert own_part(edges, np.isfinite(edges.across_error), (3, 100)) == (3, 100)
