"""Pairs of places, on places whose partners are known."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.scoring.features.one_to_one import best_pairs, pairs_within


def test_equal_places_are_paired_with_themselves() -> None:
    positions = np.random.default_rng(1).uniform(0, 100, (50, 2))
    of_result, of_truth = pairs_within(positions, positions, 1.0)
    assert of_result.tolist() == of_truth.tolist() == list(range(50))


def test_nobody_loses_a_near_partner_so_that_two_far_ones_can_be_paired() -> None:
    # One result lies on the second truth; 1.9 m off on either side lie another of each.
    result, truth = np.array([[0.0], [1.9]]), np.array([[-1.9], [0.0]])
    of_result, of_truth = pairs_within(result, truth, 2.0)
    assert (of_result.tolist(), of_truth.tolist()) == ([0], [1])


def test_a_place_at_the_limit_counts_and_one_beyond_it_does_not() -> None:
    assert pairs_within(np.array([[2.0]]), np.array([[0.0]]), 2.0)[0].tolist() == [0]
    assert pairs_within(np.array([[2.001]]), np.array([[0.0]]), 2.0)[0].size == 0


def test_nothing_has_no_partners() -> None:
    assert pairs_within(np.empty((0, 2)), np.zeros((3, 2)), 1.0)[0].size == 0
    assert best_pairs(np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0))[0].size == 0


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_pairs_are_one_to_one_and_do_not_depend_on_the_order(seed: int) -> None:
    random = np.random.default_rng(seed)
    result, truth = (random.uniform(0, 6, (random.integers(1, 15), 2)) for _ in range(2))
    of_result, of_truth = pairs_within(result, truth, 1.5)
    assert len(set(of_result)) == len(set(of_truth)) == len(of_truth)
    assert (np.linalg.norm(result[of_result] - truth[of_truth], axis=1) <= 1.5).all()
    ours, theirs = random.permutation(len(result)), random.permutation(len(truth))
    again = pairs_within(result[ours], truth[theirs], 1.5)
    assert set(zip(ours[again[0]], theirs[again[1]], strict=True)) == set(
        zip(of_result, of_truth, strict=True)
    )
