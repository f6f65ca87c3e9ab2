"""Trees against a truth, on a row of trees and copies with known faults."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.core.errors import BadFile
from processing.scoring.features.trees import tree_score
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from tests.processing.scoring.small_maps import (
    map_of,
    moved,
    point,
    with_facts,
    with_more,
    without_each_third,
)

TRUTH = map_of(
    [
        point(
            6.0 * number,
            0.0,
            kind="tree",
            dbh_m=0.10 + 0.01 * number,
            height_m=5.0,
            crown_m=3.0,
            stakes=3 if number % 4 == 0 else 0,
        )
        for number in range(12)
    ]
)


def test_the_truth_itself_is_right_in_everything() -> None:
    score = tree_score(TRUTH, TRUTH)
    assert score.counts_of("trees") == BinaryConfusionMatrix(12, 0, 0, 0)
    assert {one.id: one.count for one in score.errors} == {
        "dbh": 9,
        "dbh_with_stakes": 3,
        "place": 12,
        "foot_height": 12,
        "height": 12,
        "crown": 12,
    }
    assert max(one.largest for one in score.errors) == 0


def test_trunks_a_tenth_too_thick_are_measured_apart_from_those_with_stakes() -> None:
    thick = with_facts(TRUTH, lambda one: {"dbh_m": 1.1 * float(str(one["dbh_m"]))})
    score = tree_score(thick, TRUTH)
    free = np.array([0.010 + 0.001 * number for number in range(12) if number % 4])
    dbh = score.errors_of("dbh")
    assert dbh.mean_size == pytest.approx(free.mean())
    assert dbh.rms == pytest.approx(math.sqrt((free**2).mean()))
    assert dbh.largest == pytest.approx(0.021)
    assert score.errors_of("dbh_with_stakes").largest == pytest.approx(0.018)


def test_a_girth_stands_for_a_diameter() -> None:
    girths = with_facts(
        TRUTH, lambda one: {"dbh_m": None, "girth_m": math.pi * float(str(one["dbh_m"]))}
    )
    assert tree_score(girths, TRUTH).errors_of("dbh").largest < 1e-12
    neither = with_facts(TRUTH, lambda _: {"dbh_m": None})
    assert tree_score(neither, TRUTH).errors_of("dbh").count == 0


def test_trees_within_two_metres_are_found_and_farther_ones_are_not() -> None:
    score = tree_score(moved(TRUTH, north=1.5, up=0.1), TRUTH)
    assert score.counts_of("trees") == BinaryConfusionMatrix(12, 0, 0, 0)
    assert score.errors_of("place").mean == pytest.approx(1.5)
    assert score.errors_of("foot_height").mean == pytest.approx(0.1)
    assert tree_score(moved(TRUTH, north=2.5), TRUTH).counts_of("trees") == BinaryConfusionMatrix(
        0, 12, 12, 0
    )


def test_missing_and_added_trees_are_counted() -> None:
    assert tree_score(without_each_third(TRUTH), TRUTH).counts_of("trees") == BinaryConfusionMatrix(
        8, 0, 4, 0
    )
    twice = with_more(TRUTH, point(0.5, 0.0, kind="street_tree"), point(0.0, 30.0))
    assert tree_score(twice, TRUTH).counts_of("trees") == BinaryConfusionMatrix(12, 2, 0, 0)


def test_trees_a_person_rejected_are_not_part_of_a_result() -> None:
    rejected = with_facts(TRUTH, lambda _: {"status": "rejected"})
    assert tree_score(rejected, TRUTH).counts_of("trees") == BinaryConfusionMatrix(0, 0, 12, 0)


def test_trunks_that_no_points_show_count_neither_way_and_short_arcs_are_not_measured() -> None:
    hidden = point(100.0, 0.0, kind="tree", trunk_points=3, arc_deg=10.0, dbh_m=0.2)
    passed = point(120.0, 0.0, kind="tree", in_span=False, dbh_m=0.2)
    askew = point(140.0, 0.0, kind="tree", trunk_points=90, arc_deg=40.0, dbh_m=0.2)
    truth = with_more(TRUTH, hidden, passed, askew)
    score = tree_score(truth, truth)
    assert score.counts_of("trees") == BinaryConfusionMatrix(13, 0, 0, 0)
    assert score.left_out == {"unseen": 2, "unseen_found": 2, "trunk_arc_too_short": 1}
    assert score.errors_of("dbh").count == 9
    assert tree_score(TRUTH, truth).counts_of("trees") == BinaryConfusionMatrix(12, 0, 1, 0)


def test_a_measure_that_is_no_number_is_refused_with_its_feature() -> None:
    wrong = map_of([point(50.0, 9.0, kind="tree"), point(0.1, 0.0, kind="tree", dbh_m="thick")])
    with pytest.raises(BadFile, match=r"“dbh_m”.*number.*feature 2"):
        tree_score(wrong, TRUTH)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_scores_lie_between_0_and_1_and_do_not_depend_on_order(seed: int) -> None:
    random = np.random.default_rng(seed)
    positions = random.uniform(0, 40, (int(random.integers(0, 30)), 2))
    result = map_of([point(x, y, kind="tree", dbh_m=0.2) for x, y in positions])
    score = tree_score(result, TRUTH)
    order = random.permutation(len(positions))
    again = map_of([result.features[position] for position in order])
    other = tree_score(again, map_of(TRUTH.features[::-1]))
    assert other.counts == score.counts
    found = score.counts_of("trees")
    assert found.hits + found.misses == 12
    assert found.hits + found.false_alarms == len(positions)
