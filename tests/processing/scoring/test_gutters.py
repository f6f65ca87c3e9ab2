"""Covers of gutters against a truth, on a run of lids with a gap and copies with known faults."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.core.errors import BadFile
from processing.scoring.features.gutters import gutter_score
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from tests.processing.scoring.small_maps import (
    changed,
    feature,
    gutter,
    lid,
    map_of,
    moved,
    with_facts,
    with_more,
    without_each_third,
)

TRUTH = gutter()  # 30 places, two without a lid, three gratings


def test_the_truth_itself_is_right_in_everything() -> None:
    score = gutter_score(TRUTH, TRUTH)
    assert score.counts_of("slots") == BinaryConfusionMatrix(28, 0, 0, 2)
    assert score.counts_of("pieces") == BinaryConfusionMatrix(28, 0, 0, 0)
    assert score.counts_of("lids") == BinaryConfusionMatrix(25, 0, 0, 0)
    assert score.counts_of("gratings") == BinaryConfusionMatrix(3, 0, 0, 0)
    assert score.share_of("runs") == 1
    assert score.errors_of("corner_plan").count == 4 * 28
    assert max(one.largest for one in score.errors) == 0


def test_a_small_shift_is_measured_at_the_corners() -> None:
    score = gutter_score(moved(TRUTH, north=0.05, up=-0.02), TRUTH)
    assert score.counts_of("pieces") == BinaryConfusionMatrix(28, 0, 0, 0)
    assert score.errors_of("corner_plan").mean == pytest.approx(0.05)
    assert score.errors_of("corner_plan").within_95 == pytest.approx(0.05)
    assert score.errors_of("corner_height").mean == pytest.approx(-0.02)


def test_lids_shifted_by_half_of_their_length_are_wrong_but_their_slots_are_found() -> None:
    score = gutter_score(moved(TRUTH, east=0.25), TRUTH)
    assert score.counts_of("pieces") == BinaryConfusionMatrix(0, 28, 28, 0)
    # The lid before the gap ends 5 cm before the gap's first slot has its middle.
    assert score.counts_of("slots").hits == 28
    assert gutter_score(moved(TRUTH, north=2.0), TRUTH).counts_of("slots") == BinaryConfusionMatrix(
        0, 28, 28, 2
    )


def test_missing_lids_are_missed_one_by_one() -> None:
    score = gutter_score(without_each_third(TRUTH), TRUTH)
    assert score.counts_of("pieces") == BinaryConfusionMatrix(19, 0, 9, 0)
    assert score.counts_of("slots") == BinaryConfusionMatrix(19, 0, 9, 2)


def test_lids_in_the_gap_and_elsewhere_are_false() -> None:
    more = [lid(6.0), lid(6.6), lid(40.0)]
    score = gutter_score(with_more(TRUTH, *more), TRUTH)
    assert score.counts_of("pieces") == BinaryConfusionMatrix(28, 3, 0, 0)
    assert score.counts_of("slots") == BinaryConfusionMatrix(28, 3, 0, 0)
    long = feature(
        "area", [[40, 0, 0], [43, 0, 0], [43, 1, 0], [40, 1, 0]], kind="gutter", type="lid"
    )
    assert gutter_score(with_more(TRUTH, long), TRUTH).counts_of("slots").false_alarms == 5


def test_a_lid_found_twice_is_right_once() -> None:
    score = gutter_score(with_more(TRUTH, lid(0.02)), TRUTH)
    assert score.counts_of("pieces") == BinaryConfusionMatrix(28, 1, 0, 0)
    assert score.counts_of("slots") == BinaryConfusionMatrix(28, 0, 0, 2)


def test_a_grating_taken_for_a_lid_is_wrong_for_both() -> None:
    score = gutter_score(with_facts(TRUTH, lambda _: {"type": "lid"}), TRUTH)
    assert score.counts_of("pieces") == BinaryConfusionMatrix(28, 0, 0, 0)
    assert score.counts_of("lids") == BinaryConfusionMatrix(25, 3, 0, 0)
    assert score.counts_of("gratings") == BinaryConfusionMatrix(0, 0, 3, 0)


def test_corners_may_begin_anywhere_and_go_round_either_way() -> None:
    turned = changed(TRUTH, lambda one: replace(one, xyz=np.roll(one.xyz[::-1], 1, axis=0)))
    assert gutter_score(turned, TRUTH).errors_of("corner_plan").largest == 0
    three = changed(TRUTH, lambda one: replace(one, xyz=one.xyz[:3]))
    assert gutter_score(three, TRUTH).errors_of("corner_plan").count == 0


def test_runs_without_names_or_order_are_found_by_what_lies_beside_each_other() -> None:
    nameless = with_facts(TRUTH, lambda _: {"run": None})
    other_side = [lid(0.6 * n, run=7, y=8.0) for n in range(10)]
    truth = with_more(nameless, *other_side)
    score = gutter_score(truth, truth)
    # The gap of two lids divides the first side, so that nothing tells that it is one gutter.
    assert (score.counts_of("slots").hits, score.shares[0].share.of) == (38, 3)
    order = np.random.default_rng(5).permutation(len(truth.features))
    shuffled = map_of([truth.features[position] for position in order])
    assert gutter_score(truth, shuffled).counts == score.counts


def test_what_the_points_do_not_show_counts_neither_way() -> None:
    facts = {1: {"uncovered": 0.2}, 2: {"scanned": 0.1}, 3: {"in_span": False}}
    truth = changed(
        TRUTH, lambda one: replace(one, facts={**one.facts, **facts.get(one.number, {})})
    )
    seen = changed(TRUTH, lambda one: None if one.number in facts else one)
    for result in (truth, seen):
        score = gutter_score(result, truth)
        assert score.counts_of("pieces") == BinaryConfusionMatrix(25, 0, 0, 0)
        assert score.counts_of("slots") == BinaryConfusionMatrix(25, 0, 0, 2)
    assert gutter_score(truth, truth).left_out == {
        "unseen": 3,
        "unseen_found": 3,
        "unseen_slots": 3,
    }


def test_lids_guessed_over_hidden_ones_are_not_held_against_a_result() -> None:
    truth = changed(
        TRUTH, lambda one: replace(one, facts={**one.facts, "scanned": float(one.number > 5)})
    )
    # Half a lid off: no joint of the hidden ones is right.
    guessed = [lid(0.6 * number + 0.3) for number in range(4)]
    seen = changed(TRUTH, lambda one: one if one.number > 5 else None)
    score = gutter_score(with_more(seen, *guessed), truth)
    assert score.counts_of("pieces") == BinaryConfusionMatrix(23, 0, 0, 0)
    assert score.counts_of("slots") == BinaryConfusionMatrix(23, 0, 0, 2)


def test_a_street_without_gutters_makes_all_that_is_found_false() -> None:
    nothing = map_of([])
    assert gutter_score(TRUTH, nothing).counts_of("pieces") == BinaryConfusionMatrix(0, 28, 0, 0)
    assert gutter_score(TRUTH, nothing).counts_of("slots") == BinaryConfusionMatrix(0, 28, 0, 0)
    assert np.isnan(gutter_score(nothing, nothing).share_of("runs"))


def test_covers_without_a_type_and_shares_that_are_no_numbers_are_refused() -> None:
    with pytest.raises(BadFile, match=r"“type” is missing.*lid / grating"):
        gutter_score(with_facts(TRUTH, lambda _: {"type": None}), TRUTH)
    with pytest.raises(BadFile, match="“scanned”"):
        gutter_score(TRUTH, with_facts(TRUTH, lambda _: {"scanned": "all"}))


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_scores_lie_between_0_and_1_and_do_not_depend_on_order_or_names(seed: int) -> None:
    random = np.random.default_rng(seed)
    shaken = changed(
        TRUTH,
        lambda one: (
            None if random.random() < 0.2 else replace(one, xyz=one.xyz + random.normal(0, 0.15, 3))
        ),
    )
    score = gutter_score(shaken, TRUTH)
    order = random.permutation(len(shaken.features))
    again = with_facts(map_of([shaken.features[i] for i in order]), lambda _: {"run": 5})
    truth = with_facts(map_of(TRUTH.features[::-1]), lambda _: {"run": "gutter"})
    assert gutter_score(again, truth).counts == score.counts
    for one in score.counts:
        for share in (one.counts.precision, one.counts.recall, one.counts.f_measure):
            assert np.isnan(share) or 0 <= share <= 1
