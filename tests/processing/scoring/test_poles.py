"""Poles against a truth, on a row of poles and copies with known faults."""

from __future__ import annotations

import pytest

from processing.scoring.features.poles import pole_score
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
        point(30.0 * n, 0.0, kind="pole", type="utility_pole", height_m=10.0, diameter_m=0.3)
        for n in range(9)
    ]
)


def test_the_truth_itself_is_right_in_everything() -> None:
    score = pole_score(TRUTH, TRUTH)
    assert score.counts_of("poles") == BinaryConfusionMatrix(9, 0, 0, 0)
    assert score.share_of("type") == 1
    assert max(one.largest for one in score.errors) == 0


def test_places_types_and_measures_fall_one_by_one() -> None:
    score = pole_score(moved(TRUTH, north=0.3), TRUTH)
    assert score.counts_of("poles") == BinaryConfusionMatrix(9, 0, 0, 0)
    assert score.errors_of("place").rms == pytest.approx(0.3)
    assert pole_score(moved(TRUTH, north=0.6), TRUTH).counts_of("poles") == BinaryConfusionMatrix(
        0, 9, 9, 0
    )
    other = with_facts(TRUTH, lambda _: {"type": "street_light", "height_m": 9.0})
    assert pole_score(other, TRUTH).share_of("type") == 0
    assert pole_score(other, TRUTH).errors_of("height").mean == pytest.approx(-1.0)
    thin = with_facts(TRUTH, lambda _: {"diameter_m": 0.28})
    assert pole_score(thin, TRUTH).errors_of("diameter").mean == pytest.approx(-0.02)


@pytest.mark.parametrize(
    ("kind", "implied"), [("street_light", "street_light"), ("mirror", "mirror_pole")]
)
def test_a_kind_can_say_the_type(kind: str, implied: str) -> None:
    truth = with_facts(TRUTH, lambda _: {"type": implied})
    kinds = map_of([point(30.0 * n, 0.0, kind=kind) for n in range(9)])
    score = pole_score(kinds, truth)
    assert score.counts_of("poles") == BinaryConfusionMatrix(9, 0, 0, 0)
    assert score.share_of("type") == 1


def test_missing_added_and_unseen_poles_are_counted() -> None:
    assert pole_score(without_each_third(TRUTH), TRUTH).counts_of("poles") == BinaryConfusionMatrix(
        6, 0, 3, 0
    )
    truth = with_more(TRUTH, point(0.0, 9.0, kind="pole", points=4))
    for result in (TRUTH, truth):
        assert pole_score(result, truth).counts_of("poles") == BinaryConfusionMatrix(9, 0, 0, 0)
    more = with_more(TRUTH, point(0.0, 9.0, kind="pole"))
    assert pole_score(more, TRUTH).counts_of("poles") == BinaryConfusionMatrix(9, 1, 0, 0)


def test_what_the_contract_has_no_name_for_is_another_pole() -> None:
    banners = with_facts(TRUTH, lambda _: {"type": "banner"})
    others = with_facts(TRUTH, lambda _: {"type": "other"})
    assert pole_score(others, banners).share_of("type") == 1
    assert pole_score(TRUTH, banners).share_of("type") == 0
