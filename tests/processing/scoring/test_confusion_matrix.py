"""Counts of two classifications, against figures worked out by hand and printed in papers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from processing.scoring.confusion_matrix import ClassCounts, ConfusionMatrix, is_one_of

NOISE = (7, 18)


def test_counts_of_ten_points_worked_out_by_hand() -> None:
    truth = np.array([0, 0, 0, 0, 0, 0, 7, 7, 18, 18], np.uint8)
    result = np.array([0, 0, 0, 0, 1, 7, 7, 18, 18, 0], np.uint8)
    found = ClassCounts.of(truth, result).confusion_matrix(NOISE)
    assert found == ConfusionMatrix(hits=3, false_alarms=1, misses=1, rejections=5)
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
        found = ConfusionMatrix(kept, left, lost, 0)
        assert 100 * found.precision == pytest.approx(98.928, abs=5e-4)
        assert 100 * found.f_measure == pytest.approx(printed, abs=1e-3)


def test_a_noise_share_of_1_07_percent_gives_the_study_s_figures_to_doing_nothing() -> None:
    found = ConfusionMatrix(900, 0, 172, 98_928).if_nothing_was_positive()
    kept = found.turned()
    assert 100 * kept.precision == pytest.approx(98.928)
    assert kept.recall == 1.0
    assert 100 * kept.f_measure == pytest.approx(99.461, abs=1e-3)
    assert found.recall == 0.0
    assert found.f_measure == 0.0
    assert math.isnan(found.precision)


# Specification B4: hits, false alarms, misses; then P, R, F as the paper prints them.
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
    found = ConfusionMatrix(hits, false_alarms, misses, 19_971 - hits - false_alarms - misses)
    assert hits + misses == 5293
    measured = (found.precision, found.recall, found.f_measure)
    # The paper's own F were computed from unrounded figures: up to 0.01 off.
    assert measured == pytest.approx(printed, abs=0.01)
    turned = found.turned()
    told = (turned.precision, turned.recall, turned.f_measure)
    assert told == pytest.approx(ground, abs=1e-3)


def test_calling_every_point_a_machine_scores_what_the_specification_says() -> None:
    found = ConfusionMatrix(5293, 14_678, 0, 0)
    assert found.precision == pytest.approx(0.265, abs=5e-4)
    assert found.f_measure == pytest.approx(0.419, abs=5e-4)


codes = arrays(np.uint8, st.shared(st.integers(0, 60), key="count"))


@given(codes, codes)
def test_blocks_of_any_size_add_up_to_the_whole(
    truth: np.ndarray[tuple[int], np.dtype[np.uint8]],
    result: np.ndarray[tuple[int], np.dtype[np.uint8]],
) -> None:
    whole = ClassCounts.of(truth, result)
    parts = ClassCounts()
    for start in range(0, len(truth), 7):
        parts += ClassCounts.of(truth[start : start + 7], result[start : start + 7])
    assert np.array_equal(whole.table, parts.table)
    assert whole.count == len(truth)


@given(codes, codes)
def test_the_order_of_the_points_and_the_side_that_is_positive_change_no_count(
    truth: np.ndarray[tuple[int], np.dtype[np.uint8]],
    result: np.ndarray[tuple[int], np.dtype[np.uint8]],
) -> None:
    found = ClassCounts.of(truth, result).confusion_matrix(NOISE)
    order = np.random.default_rng(1).permutation(len(truth))
    assert ClassCounts.of(truth[order], result[order]).confusion_matrix(NOISE) == found
    others = [code for code in range(256) if code not in NOISE]
    assert ClassCounts.of(truth, result).confusion_matrix(others) == found.turned()
    assert found.turned().turned() == found
    is_noise, called = is_one_of(truth, NOISE), is_one_of(result, NOISE)
    assert found.hits == int((is_noise & called).sum())
    assert found.count == len(truth)


@given(codes)
def test_a_perfect_result_scores_one_and_its_opposite_nothing(
    truth: np.ndarray[tuple[int], np.dtype[np.uint8]],
) -> None:
    perfect = ClassCounts.of(truth, truth).confusion_matrix(NOISE)
    opposite = np.where(is_one_of(truth, NOISE), np.uint8(0), np.uint8(7))
    wrong = ClassCounts.of(truth, opposite).confusion_matrix(NOISE)
    if 0 < perfect.hits < len(truth):
        assert (perfect.precision, perfect.recall, perfect.f_measure) == (1.0, 1.0, 1.0)
        assert perfect.kappa == pytest.approx(1.0)
        assert wrong.f_measure == wrong.turned().f_measure == 0.0
        assert wrong.kappa <= 0.0
        assert wrong.total_error == 1.0
    elif len(truth):
        assert math.isnan(perfect.kappa)


def test_of_nothing_there_is_no_score() -> None:
    found = ClassCounts().confusion_matrix(NOISE)
    for value in (found.precision, found.recall, found.f_measure, found.kappa, found.total_error):
        assert math.isnan(value)


def test_codes_of_different_lengths_are_refused() -> None:
    with pytest.raises(ValueError, match="true codes"):
        ClassCounts.of(np.zeros(3, np.uint8), np.zeros(2, np.uint8))
