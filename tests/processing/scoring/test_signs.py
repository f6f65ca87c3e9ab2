"""Signs against a truth: posts with two plates each, and copies with known faults."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from processing.core.errors import BadFile
from processing.scoring.features.signs import SHAPES, sign_score
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from tests.processing.scoring.small_maps import (
    changed,
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
            20.0 * number,
            0.0,
            height,
            kind="sign",
            shape=SHAPES[number],
            size_m=0.6,
            facing_deg=5.0,
            height_m=height,
        )
        for number in range(6)
        for height in (2.0, 2.7)
    ]
)


def rates(*arguments: object) -> list[float]:
    score = sign_score(*arguments)  # type: ignore[arg-type]
    return [one.share.value for one in score.shares]


def test_the_truth_itself_is_right_in_everything() -> None:
    score = sign_score(TRUTH, TRUTH)
    assert score.counts_of("signs") == BinaryConfusionMatrix(12, 0, 0, 0)
    assert rates(TRUTH, TRUTH) == [1, 1, 1, 1, 1]
    assert max(one.largest for one in score.errors) == 0


def test_five_centimetres_off_are_in_place_and_thirty_are_not() -> None:
    assert rates(moved(TRUTH, east=0.05), TRUTH) == [1, 1, 1, 1, 1]
    far = sign_score(moved(TRUTH, east=0.3), TRUTH)
    assert far.counts_of("signs") == BinaryConfusionMatrix(12, 0, 0, 0)
    assert [one.share.value for one in far.shares] == [0, 0, 0, 1, 1]
    assert far.errors_of("place").mean == pytest.approx(0.3)
    assert sign_score(moved(TRUTH, north=1.2), TRUTH).counts_of("signs") == BinaryConfusionMatrix(
        0, 12, 12, 0
    )


def test_a_wrong_shape_and_a_wrong_size_fail_only_what_asks_for_them() -> None:
    round_ones = with_facts(TRUTH, lambda _: {"shape": "circle"})
    assert rates(round_ones, TRUTH) == pytest.approx([1, 1 / 6, 1 / 6, 1 / 6, 1 / 6])
    assert rates(with_facts(TRUTH, lambda _: {"size_m": 0.65}), TRUTH) == [1, 1, 1, 1, 1]
    large = sign_score(with_facts(TRUTH, lambda _: {"size_m": 0.9}), TRUTH)
    assert [one.share.value for one in large.shares] == [1, 1, 0, 1, 0]
    assert large.errors_of("size").mean == pytest.approx(0.3)


def test_facings_are_compared_round_the_north() -> None:
    turned = sign_score(with_facts(TRUTH, lambda _: {"facing_deg": 355.0}), TRUTH)
    assert turned.errors_of("facing_deg").mean == pytest.approx(-10.0)


def test_missing_and_added_plates_are_counted() -> None:
    assert sign_score(without_each_third(TRUTH), TRUTH).counts_of("signs") == BinaryConfusionMatrix(
        8, 0, 4, 0
    )
    more = with_more(TRUTH, point(0.0, 0.1, 2.0, kind="sign", shape="circle"))
    assert sign_score(more, TRUTH).counts_of("signs") == BinaryConfusionMatrix(12, 1, 0, 0)
    assert rates(without_each_third(TRUTH), TRUTH)[2] == pytest.approx(8 / 12)


def test_supplementary_plates_are_judged_apart() -> None:
    truth = changed(
        TRUTH,
        lambda one: replace(one, facts={**one.facts, "supplementary": one.number % 2 == 1}),
    )
    score = sign_score(TRUTH, truth)
    assert score.counts_of("signs") == BinaryConfusionMatrix(6, 0, 0, 0)
    assert score.counts_of("supplementary") == BinaryConfusionMatrix(6, 0, 0, 0)
    assert score.errors_of("place").count == 6
    nothing = sign_score(map_of([]), truth)
    assert (
        nothing.counts_of("signs")
        == nothing.counts_of("supplementary")
        == BinaryConfusionMatrix(0, 0, 6, 0)
    )


def test_plates_whose_face_no_points_show_count_neither_way() -> None:
    behind = point(0.0, 50.0, 2.0, kind="sign", shape="circle", points=900, front_points=2)
    truth = with_more(TRUTH, behind)
    for result in (TRUTH, truth):
        assert sign_score(result, truth).counts_of("signs") == BinaryConfusionMatrix(12, 0, 0, 0)
    few = with_facts(map_of([behind]), lambda _: {"front_points": None, "points": 4})
    assert sign_score(map_of([]), few).counts_of("signs") == BinaryConfusionMatrix(0, 0, 0, 0)


def test_the_middle_of_the_outline_is_a_centre_too() -> None:
    off = np.array([0.0, 0.0, 0.2])
    truth = changed(
        TRUTH, lambda one: replace(one, facts={**one.facts, "bbox_centre": [*(one.xyz[0] + off)]})
    )
    assert sign_score(moved(TRUTH, up=0.2), truth).errors_of("place").largest < 1e-9
    assert sign_score(TRUTH, truth).errors_of("place").largest == 0
    with pytest.raises(BadFile, match="“bbox_centre”"):
        sign_score(TRUTH, with_facts(TRUTH, lambda _: {"bbox_centre": [1, "b", 3]}))


def test_plates_without_heights_are_compared_in_plan() -> None:
    flat = changed(TRUTH, lambda one: replace(one, xyz=one.xyz * [[1, 1, np.nan]]))
    score = sign_score(flat, TRUTH)
    assert score.counts_of("signs") == BinaryConfusionMatrix(12, 0, 0, 0)
    assert score.share_of("place") == 1


def test_a_truth_with_an_unknown_shape_is_refused_and_a_result_with_one_is_wrong() -> None:
    octagons = with_facts(TRUTH, lambda _: {"shape": "octagon"})
    with pytest.raises(BadFile, match="“shape”"):
        sign_score(TRUTH, octagons)
    assert sign_score(octagons, TRUTH).share_of("place_shape") == 0
