"""Counts of two classifications, against figures worked out by hand and printed in papers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from processing.scoring.points.confusion_matrix import (
    BinaryConfusionMatrix,
    ConfusionMatrix,
    is_one_of,
)

NOISE = (7, 18)


def test_counts_of_ten_points_worked_out_by_hand() -> None:
    truth = np.array([0, 0, 0, 0, 0, 0, 7, 7, 18, 18], np.uint8)
    result = np.array([0, 0, 0, 0, 1, 7, 7, 18, 18, 0], np.uint8)
    found = ConfusionMatrix.of(truth, result).against_rest(NOISE)
    assert found == BinaryConfusionMatrix(hits=3, false_alarms=1, misses=1, rejections=5)
    assert (found.precision, found.recall, found.f_measure) == (0.75, 0.75, 0.75)
    assert found.total_error == 0.2
    kept = found.turned()
    assert (kept.precision, kept.recall) == (5 / 6, 5 / 6)
    assert found.kappa == pytest.approx((0.8 - 0.52) / 0.48)
    assert kept.kappa == pytest.approx(found.kappa)


def test_the_noise_study_s_table_follows_from_counts() -> None:
    """Table 1: P 98.928 %, R 99.978 % and 99.996 %, F 99.450 and 99.459."""
    good = 1_000_000
    for lost, printed in ((220, 99.450), (40, 99.459)):
        kept = good - lost
        left = round(kept * (1 / 0.98928 - 1))
        found = BinaryConfusionMatrix(kept, left, lost, 0)
        assert 100 * found.precision == pytest.approx(98.928, abs=5e-4)
        assert 100 * found.f_measure == pytest.approx(printed, abs=1e-3)


def test_a_noise_share_of_1_07_percent_gives_the_study_s_figures_to_doing_nothing() -> None:
    found = BinaryConfusionMatrix(900, 0, 172, 98_928).if_nothing_was_positive()
    kept = found.turned()
    assert 100 * kept.precision == pytest.approx(98.928)
    assert kept.recall == 1.0
    assert 100 * kept.f_measure == pytest.approx(99.461, abs=1e-3)
    assert found.recall == 0.0
    assert found.f_measure == 0.0
    assert math.isnan(found.precision)


# Sakurai et al., table 2: hits, false alarms, misses; then P, R, F as the paper prints them.
_TABLE_2 = [
    (4446, 785, 847, 0.85, 0.84, 0.84),
    (4393, 434, 900, 0.91, 0.83, 0.87),
    (4552, 2673, 741, 0.63, 0.86, 0.73),
    (4658, 6432, 635, 0.42, 0.88, 0.56),
    (5028, 10209, 265, 0.33, 0.95, 0.49),
    (5187, 14025, 106, 0.27, 0.98, 0.42),
]
_GROUND = [
    (0.943, 0.947, 0.945),
    (0.941, 0.970, 0.955),
    (0.942, 0.818, 0.875),
    (0.928, 0.562, 0.700),
    (0.944, 0.304, 0.460),
    (0.861, 0.045, 0.085),
]


@pytest.mark.parametrize(("row", "ground"), list(zip(_TABLE_2, _GROUND, strict=True)))
def test_the_ground_study_s_table_and_what_it_means_for_the_ground(
    row: tuple[int, int, int, float, float, float], ground: tuple[float, float, float]
) -> None:
    hits, false_alarms, misses, *printed = row
    found = BinaryConfusionMatrix(hits, false_alarms, misses, 19_971 - hits - false_alarms - misses)
    assert hits + misses == 5293
    measured = (found.precision, found.recall, found.f_measure)
    # The paper's own F were computed from unrounded figures: up to 0.01 off.
    assert measured == pytest.approx(printed, abs=0.01)
    turned = found.turned()
    told = (turned.precision, turned.recall, turned.f_measure)
    assert told == pytest.approx(ground, abs=1e-3)


def test_calling_every_point_a_machine_scores_what_the_specification_says() -> None:
    found = BinaryConfusionMatrix(5293, 14_678, 0, 0)
    assert found.precision == pytest.approx(0.265, abs=5e-4)
    assert found.f_measure == pytest.approx(0.419, abs=5e-4)


codes = arrays(np.uint8, st.shared(st.integers(0, 60), key="count"))


@given(codes, codes)
def test_blocks_of_any_size_add_up_to_the_whole(
    truth: np.ndarray[tuple[int], np.dtype[np.uint8]],
    result: np.ndarray[tuple[int], np.dtype[np.uint8]],
) -> None:
    whole = ConfusionMatrix.of(truth, result)
    parts = ConfusionMatrix()
    for start in range(0, len(truth), 7):
        parts += ConfusionMatrix.of(truth[start : start + 7], result[start : start + 7])
    assert whole.codes == parts.codes == tuple(np.union1d(truth, result).tolist())
    assert np.array_equal(whole.counts, parts.counts)
    assert whole.count == len(truth)


@given(codes, codes)
def test_the_order_of_the_points_and_the_side_that_is_positive_change_no_count(
    truth: np.ndarray[tuple[int], np.dtype[np.uint8]],
    result: np.ndarray[tuple[int], np.dtype[np.uint8]],
) -> None:
    found = ConfusionMatrix.of(truth, result).against_rest(NOISE)
    order = np.random.default_rng(1).permutation(len(truth))
    assert ConfusionMatrix.of(truth[order], result[order]).against_rest(NOISE) == found
    others = [code for code in range(256) if code not in NOISE]
    assert ConfusionMatrix.of(truth, result).against_rest(others) == found.turned()
    assert found.turned().turned() == found
    is_noise, called = is_one_of(truth, NOISE), is_one_of(result, NOISE)
    assert found.hits == int((is_noise & called).sum())
    assert found.count == len(truth)


@given(codes)
def test_a_perfect_result_scores_one_and_its_opposite_nothing(
    truth: np.ndarray[tuple[int], np.dtype[np.uint8]],
) -> None:
    perfect = ConfusionMatrix.of(truth, truth).against_rest(NOISE)
    opposite = np.where(is_one_of(truth, NOISE), np.uint8(0), np.uint8(7))
    wrong = ConfusionMatrix.of(truth, opposite).against_rest(NOISE)
    if 0 < perfect.hits < len(truth):
        assert (perfect.precision, perfect.recall, perfect.f_measure) == (1.0, 1.0, 1.0)
        assert perfect.kappa == pytest.approx(1.0)
        assert wrong.f_measure == wrong.turned().f_measure == 0.0
        assert wrong.kappa <= 0.0
        assert wrong.total_error == 1.0
    elif len(truth):
        assert math.isnan(perfect.kappa)


def test_of_nothing_there_is_no_score() -> None:
    found = ConfusionMatrix().against_rest(NOISE)
    for value in (found.precision, found.recall, found.f_measure, found.kappa, found.total_error):
        assert math.isnan(value)


def test_codes_of_different_lengths_are_refused() -> None:
    with pytest.raises(ValueError, match="true codes"):
        ConfusionMatrix.of(np.zeros(3, np.uint8), np.zeros(2, np.uint8))


def test_three_classes_worked_out_by_hand() -> None:
    truth = np.repeat(np.array([2, 5, 65], np.uint8), [6, 3, 1])
    result = np.array([2, 2, 2, 2, 5, 5, 5, 5, 2, 5], np.uint8)
    found = ConfusionMatrix.of(truth, result)
    assert found.codes == (2, 5, 65)
    assert found.counts.tolist() == [[4, 2, 0], [1, 2, 0], [0, 1, 0]]
    assert found.counts.dtype == np.int64
    np.testing.assert_array_equal(found.precision, [4 / 5, 2 / 5, np.nan])
    np.testing.assert_array_equal(found.recall, [4 / 6, 2 / 3, 0.0])
    np.testing.assert_array_equal(found.f_measure, [8 / 11, 4 / 8, 0.0])
    assert found.mean_f == pytest.approx((8 / 11 + 1 / 2) / 3)
    assert found.mean_f_of((5, 65, 7)) == 0.25
    assert found.overall_accuracy == 0.6
    by_chance = (6 * 5 + 3 * 5) / 100
    assert found.kappa == pytest.approx((0.6 - by_chance) / (1 - by_chance))


def test_a_published_matrix_gives_the_accuracies_that_are_printed_beside_it() -> None:
    """Congalton 1991, table 1: producer's accuracy is recall, user's accuracy precision."""
    by_result = [[65, 4, 22, 24], [6, 81, 5, 8], [0, 11, 85, 19], [4, 7, 3, 90]]
    found = ConfusionMatrix((1, 2, 3, 4), np.array(by_result).T)
    assert found.overall_accuracy == pytest.approx(0.74, abs=0.005)
    assert found.recall == pytest.approx([0.87, 0.79, 0.74, 0.64], abs=0.005)
    assert found.precision == pytest.approx([0.57, 0.81, 0.74, 0.87], abs=0.005)


def test_blocks_with_other_classes_are_added_by_class() -> None:
    first = ConfusionMatrix((2, 65), np.array([[5, 1], [0, 3]]))
    second = ConfusionMatrix((5, 65), np.array([[2, 0], [4, 1]]))
    both = first + second
    assert both.codes == (2, 5, 65)
    assert both.counts.tolist() == [[5, 0, 1], [0, 2, 0], [0, 4, 4]]
    assert first.counts.tolist() == [[5, 1], [0, 3]]


@given(codes, codes)
def test_each_class_of_many_scores_as_it_does_against_all_others(
    truth: np.ndarray[tuple[int], np.dtype[np.uint8]],
    result: np.ndarray[tuple[int], np.dtype[np.uint8]],
) -> None:
    found = ConfusionMatrix.of(truth, result)
    alone = [found.against_rest((code,)) for code in found.codes]
    np.testing.assert_array_equal(found.precision, [one.precision for one in alone])
    np.testing.assert_array_equal(found.recall, [one.recall for one in alone])
    np.testing.assert_array_equal(found.f_measure, [one.f_measure for one in alone])


def test_of_two_classes_many_and_two_say_the_same() -> None:
    found = ConfusionMatrix((0, 7), np.array([[90, 4], [1, 5]]))
    two = found.against_rest((7,))
    assert two == BinaryConfusionMatrix(hits=5, false_alarms=4, misses=1, rejections=90)
    assert found.kappa == pytest.approx(two.kappa)
    assert found.overall_accuracy == pytest.approx(1 - two.total_error)
    assert found.mean_f == (two.f_measure + two.turned().f_measure) / 2


def test_points_of_a_true_class_are_left_out_with_the_classes_that_only_they_had() -> None:
    found = ConfusionMatrix((0, 2, 5), np.array([[3, 1, 4], [0, 6, 0], [0, 0, 0]])).without_true(
        (0,)
    )
    assert found.codes == (2,)
    assert found.counts.tolist() == [[6]]
    assert math.isnan(found.kappa)


def test_of_no_points_many_classes_have_no_score_either() -> None:
    found = ConfusionMatrix()
    assert found.count == 0
    assert found.precision.size == 0
    for value in (found.mean_f, found.overall_accuracy, found.kappa):
        assert math.isnan(value)


def test_counts_of_other_classes_than_are_named_are_refused() -> None:
    with pytest.raises(ValueError, match="2 classes"):
        ConfusionMatrix((1, 2), np.zeros((3, 3), np.int64))
