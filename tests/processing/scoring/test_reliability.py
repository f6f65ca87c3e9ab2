"""Shares with their intervals and the reliability curve, against values known by construction."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.stats import binomtest

from processing.scoring.points.reliability import reliability_of, share_of


@pytest.mark.parametrize(("hits", "of"), [(0, 10), (1, 10), (5, 10), (10, 10), (37, 214), (1, 1)])
def test_a_share_has_the_interval_that_statisticians_compute(hits: int, of: int) -> None:
    share = share_of(hits, of)
    expected = binomtest(hits, of).proportion_ci(0.95, method="wilson")
    assert share.value == hits / of
    assert share.low == pytest.approx(expected.low, abs=1e-9)
    assert share.high == pytest.approx(expected.high, abs=1e-9)


def test_a_share_of_nothing_is_no_number() -> None:
    share = share_of(0, 0)
    assert math.isnan(share.value)
    assert math.isnan(share.low)
    assert math.isnan(share.high)


def test_a_tool_that_is_right_as_often_as_it_says_has_no_calibration_error() -> None:
    confidence = np.repeat([0.25, 0.75], 100)
    is_accepted = np.concatenate([np.arange(100) < 25, np.arange(100) < 75])
    found = reliability_of(confidence, is_accepted)
    assert found.calibration_error == pytest.approx(0.0)
    filled = [one for one in found.bins if one.accepted.of]
    assert [(one.mean_confidence, one.accepted.value) for one in filled] == [
        (pytest.approx(0.25), 0.25),
        (pytest.approx(0.75), 0.75),
    ]


def test_the_calibration_error_is_the_mean_distance_weighted_by_counts() -> None:
    confidence = np.array([0.9] * 30 + [0.5] * 10)
    is_accepted = np.array([True] * 15 + [False] * 15 + [True] * 10)
    found = reliability_of(confidence, is_accepted)
    assert found.calibration_error == pytest.approx((30 * 0.4 + 10 * 0.5) / 40)


def test_confidences_at_and_beyond_the_ends_count_in_the_outer_bins() -> None:
    found = reliability_of(np.array([-0.5, 0.0, 1.0, 1.5]), np.array([False, False, True, True]))
    assert found.bins[0].accepted.of == 2
    assert found.bins[-1].accepted.of == 2
    assert sum(one.accepted.of for one in found.bins) == 4


def test_without_decisions_there_is_no_curve_and_no_error() -> None:
    found = reliability_of(np.empty(0), np.empty(0, bool))
    assert math.isnan(found.calibration_error)
    assert all(one.accepted.of == 0 for one in found.bins)


def test_arrays_of_different_lengths_are_refused() -> None:
    with pytest.raises(ValueError, match="decisions"):
        reliability_of(np.zeros(3), np.zeros(2, bool))
