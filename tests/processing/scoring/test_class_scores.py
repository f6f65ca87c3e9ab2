"""Classes of points against a truth, with figures worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from processing.scoring.points.class_scores import class_score
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix, ConfusionMatrix

TRUTH = np.array([2, 2, 11, 11, 11, 11, 65, 65, 18, 0, 0], np.uint8)
RESULT = np.array([2, 11, 11, 11, 11, 2, 65, 1, 18, 65, 2], np.uint8)


def test_the_truth_itself_is_right_in_everything() -> None:
    score = class_score(ConfusionMatrix.of(TRUTH, TRUTH))
    assert {one.value for one in score.figures} == {1.0}
    assert score.shares[0].share.value == 1
    assert all(one.counts.f_measure == 1 for one in score.classes)


def test_classes_are_counted_each_against_all_others() -> None:
    score = class_score(ConfusionMatrix.of(TRUTH, RESULT))
    assert score.points == 9
    assert score.class_of("2") == BinaryConfusionMatrix(1, 1, 1, 6)
    assert score.class_of("11") == BinaryConfusionMatrix(3, 1, 1, 4)
    assert score.class_of("ground_and_road") == BinaryConfusionMatrix(6, 0, 0, 3)
    assert score.class_of("65") == BinaryConfusionMatrix(1, 0, 1, 7)
    right, not_known = (one.share for one in score.shares)
    assert (right.hits, right.of, not_known.hits, not_known.of) == (6, 9, 2, 11)
    mean_f, joined, as_thesis, balanced, kappa = (one.value for one in score.figures)
    # Noise is another tool's, and class 1 is none of the truth's.
    assert mean_f == pytest.approx((0.5 + 0.75 + 2 / 3) / 3)
    assert joined == pytest.approx((1 + 2 / 3) / 2)
    assert as_thesis == joined  # no point is truly “other”
    # As many points of each of the three: F of 1 / 1.75, 1.5 / 2.25 and 1 / 1.5.
    assert balanced == pytest.approx((1 / 1.75 + 2 / 3 + 2 / 3) / 3)
    by_chance = (2 * 2 + 4 * 4 + 2 * 1 + 1 * 1) / 81
    assert kappa == pytest.approx((6 / 9 - by_chance) / (1 - by_chance))


def test_true_points_of_other_count_as_false_or_not_at_all() -> None:
    others = np.concatenate([TRUTH, np.ones(2, np.uint8)])
    found = np.concatenate([RESULT, np.array([65, 1], np.uint8)])
    figures = {one.id: one.value for one in class_score(ConfusionMatrix.of(others, found)).figures}
    assert figures["mean_f_ground_joined"] == pytest.approx((1 + 2 / 4) / 2)
    assert figures["mean_f_as_thesis"] == pytest.approx((1 + 2 / 3) / 2)


def test_the_matrix_says_what_was_taken_for_what() -> None:
    matrix = class_score(ConfusionMatrix.of(TRUTH, RESULT)).matrix
    assert matrix is not None
    assert matrix.codes == (1, 2, 11, 18, 65)
    assert matrix.counts.tolist() == [
        [0, 0, 0, 0, 0],
        [0, 1, 1, 0, 0],
        [0, 1, 3, 0, 0],
        [0, 0, 0, 1, 0],
        [1, 0, 0, 0, 1],
    ]


def test_points_without_a_true_class_have_no_score() -> None:
    score = class_score(ConfusionMatrix.of(np.zeros(5, np.uint8), np.ones(5, np.uint8)))
    assert score.points == 0
    assert all(np.isnan(one.value) for one in score.figures)
