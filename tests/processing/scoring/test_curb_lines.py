"""Curbs against a truth, on a straight street of 40 m and copies with known faults."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.core.errors import BadFile
from processing.scoring.features.curb_lines import curb_score
from processing.scoring.features.mapped_features import MappedFeature
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from tests.processing.scoring.small_maps import (
    changed,
    curb_pair,
    feature,
    map_of,
    moved,
    point,
    street_curbs,
    with_facts,
    with_more,
    without_each_third,
)

TRUTH = street_curbs()


def test_the_truth_itself_is_right_in_everything() -> None:
    score = curb_score(TRUTH, TRUTH)
    assert score.counts_of("all") == BinaryConfusionMatrix(40, 0, 0, 0)
    assert score.counts_of("without_dropped") == BinaryConfusionMatrix(36, 0, 0, 0)
    assert (
        score.counts_of("upper") == score.counts_of("lower") == BinaryConfusionMatrix(20, 0, 0, 0)
    )
    assert score.share_of("type") == 1
    assert max(one.largest for one in score.errors) < 1e-9


def test_five_centimetres_off_are_found_and_measured() -> None:
    score = curb_score(moved(TRUTH, north=0.05, up=0.01), TRUTH)
    assert score.counts_of("all") == BinaryConfusionMatrix(40, 0, 0, 0)
    assert score.errors_of("upper_plan").rms == pytest.approx(0.05)
    assert score.errors_of("lower_plan").within_95 == pytest.approx(0.05)
    assert score.errors_of("lower_height").mean == pytest.approx(0.01)
    assert score.errors_of("upper_step").largest == 0


def test_thirty_centimetres_off_are_a_miss_and_a_false_alarm_each() -> None:
    score = curb_score(moved(TRUTH, north=0.3), TRUTH)
    assert score.counts_of("all") == BinaryConfusionMatrix(0, 40, 40, 0)
    assert score.errors_of("upper_plan").count == 0


def test_a_missing_line_is_missed_in_all_its_sections() -> None:
    score = curb_score(without_each_third(TRUTH), TRUTH)
    # The third and the sixth line: 4 m of an upper edge, 16 m of a lower one.
    assert score.counts_of("all") == BinaryConfusionMatrix(30, 0, 10, 0)


def test_dropped_curbs_count_neither_way_where_they_are_left_out() -> None:
    without = changed(TRUTH, lambda one: None if one.facts["type"] == "dropped" else one)
    assert curb_score(without, TRUTH).counts_of("without_dropped") == BinaryConfusionMatrix(
        36, 0, 0, 0
    )
    assert curb_score(without, TRUTH).counts_of("all") == BinaryConfusionMatrix(36, 0, 4, 0)
    # Found ones are no false alarms either.
    assert curb_score(TRUTH, TRUTH).counts_of("without_dropped").false_alarms == 0


def test_direction_and_splits_of_lines_do_not_matter() -> None:
    turned = changed(TRUTH, lambda one: replace(one, xyz=one.xyz[::-1].copy()))
    split: list[MappedFeature] = []
    for one in TRUTH.features:
        middle = len(one.xyz) // 3
        parts = (one.xyz[: middle + 1], one.xyz[middle:])
        split += [replace(one, xyz=part) for part in parts]
    for result in (turned, map_of(split), map_of(split[::-1])):
        score = curb_score(result, TRUTH)
        assert score.counts_of("all") == BinaryConfusionMatrix(40, 0, 0, 0)
        assert max(one.largest for one in score.errors) < 1e-9


def test_a_second_line_along_a_curb_and_a_line_elsewhere_are_false() -> None:
    again = moved(map_of(curb_pair(0, 20, 9)), north=0.03).features
    score = curb_score(with_more(TRUTH, *again), TRUTH)
    assert score.counts_of("all") == BinaryConfusionMatrix(40, 20, 0, 0)
    elsewhere = moved(map_of(curb_pair(0, 6, 9)), north=5.0).features
    score = curb_score(with_more(TRUTH, *elsewhere), TRUTH)
    assert score.counts_of("all") == BinaryConfusionMatrix(40, 6, 0, 0)


def test_types_and_edges_taken_for_each_other_are_told_apart() -> None:
    other = {"curb": "dropped", "dropped": "curb"}
    score = curb_score(with_facts(TRUTH, lambda one: {"type": other[str(one["type"])]}), TRUTH)
    assert score.counts_of("all") == BinaryConfusionMatrix(40, 0, 0, 0)
    assert score.share_of("type") == 0
    only_upper = with_facts(TRUTH, lambda one: {"edge": "upper"})
    score = curb_score(only_upper, TRUTH)
    assert score.counts_of("lower") == BinaryConfusionMatrix(0, 0, 20, 0)
    # The lower lines lie 2 cm beside the upper ones, which explain them only once.
    assert score.counts_of("upper") == BinaryConfusionMatrix(20, 20, 0, 0)


def test_what_the_points_do_not_show_counts_neither_way() -> None:
    sections = [
        {"u0": 0.0, "u1": 2.0, "covered": 0.9, "in_span": True},
        {"u0": 2.0, "u1": 4.0, "covered": 0.1, "in_span": True},
        {"u0": 4.0, "u1": 6.0, "covered": 1.0, "in_span": False},
    ]
    truth = with_facts(map_of(curb_pair(0, 6, 1)), lambda _: {"sections": sections})
    whole = curb_score(truth, truth)
    assert whole.counts_of("all") == BinaryConfusionMatrix(2, 0, 0, 0)
    assert whole.left_out == {"unseen_sections": 4}
    part = curb_score(map_of(curb_pair(0, 2, 1)), truth)
    assert part.counts_of("all") == BinaryConfusionMatrix(2, 0, 0, 0)
    assert curb_score(map_of([]), truth).counts_of("all") == BinaryConfusionMatrix(0, 0, 2, 0)


def test_rear_edges_are_not_asked_for_and_lines_on_them_not_held_against_a_result() -> None:
    back = moved(map_of(curb_pair(0, 20, 1)), north=0.3).features
    rear = [replace(one, facts={**one.facts, "type": "back"}) for one in back]
    truth = with_more(TRUTH, *rear)
    assert curb_score(TRUTH, truth).counts_of("all") == BinaryConfusionMatrix(40, 0, 0, 0)
    assert curb_score(TRUTH, truth).left_out == {"unseen_sections": 0}
    assert curb_score(with_more(TRUTH, *back), truth).counts_of("all") == BinaryConfusionMatrix(
        40, 0, 0, 0
    )
    assert curb_score(truth, TRUTH).counts_of("all") == BinaryConfusionMatrix(40, 0, 0, 0)


def test_kinds_of_the_map_say_the_edge_and_corners_may_be_anywhere() -> None:
    drawn = []
    for one in TRUTH.features:
        ends = one.xyz[[0, -1]]
        kind = f"curb_{one.facts['edge']}"
        drawn.append(replace(one, xyz=ends, facts={"kind": kind, "type": one.facts["type"]}))
    score = curb_score(map_of(drawn), TRUTH)
    assert score.counts_of("all") == BinaryConfusionMatrix(40, 0, 0, 0)
    # A map has no steps of curbs, so none is compared.
    assert score.errors_of("upper_step").count == 0
    # Lines that an operator drew are a truth too, seen everywhere.
    assert curb_score(TRUTH, map_of(drawn)).counts_of("all") == BinaryConfusionMatrix(40, 0, 0, 0)


def test_lines_that_do_not_say_their_edge_and_other_shapes_are_refused() -> None:
    nameless = map_of([feature("line", [[0, 0, 0], [5, 0, 0]], kind="curb")])
    with pytest.raises(BadFile, match="“edge” is missing"):
        curb_score(nameless, TRUTH)
    with pytest.raises(BadFile, match=r"a point, not a line.*feature 1"):
        curb_score(map_of([point(0, 0, kind="curb", edge="upper")]), TRUTH)
    with pytest.raises(BadFile, match="holds none of: curbs"):
        curb_score(map_of([point(0, 0, kind="tree")]), TRUTH)
    for wrong in ("all", [{"u0": 0}], [3]):
        truth = with_facts(TRUTH, lambda _, wrong=wrong: {"sections": wrong})
        with pytest.raises(BadFile, match="“sections”"):
            curb_score(TRUTH, truth)


def test_lines_without_length_are_no_curbs_and_harm_nothing() -> None:
    dot = feature("line", [[3, 9, 0], [3, 9, 0]], kind="curb", edge="upper")
    score = curb_score(with_more(TRUTH, dot), TRUTH)
    assert score.counts_of("all").hits == 40
    assert score.counts_of("all").misses == 0


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_scores_lie_between_0_and_1_and_do_not_depend_on_order_or_names(seed: int) -> None:
    random = np.random.default_rng(seed)
    shaken = changed(
        TRUTH,
        lambda one: (
            None if random.random() < 0.2 else replace(one, xyz=one.xyz + random.normal(0, 0.08, 3))
        ),
    )
    score = curb_score(shaken, TRUTH)
    order = random.permutation(len(shaken.features))
    again = map_of([shaken.features[position] for position in order])
    renamed = with_facts(again, lambda one: {"run": int(random.integers(1000))})
    other = curb_score(renamed, map_of(TRUTH.features[::-1]))
    assert other.counts == score.counts
    for one in score.counts:
        for share in (one.counts.precision, one.counts.recall, one.counts.f_measure):
            assert np.isnan(share) or 0 <= share <= 1
