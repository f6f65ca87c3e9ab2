"""Volumes against a truth, with figures worked out by hand."""

from __future__ import annotations

import math

import pytest

from processing.scoring.features.volumes import volume_score

TRUTH = {"cut_m3": 200.0, "fill_m3": 500.0, "net_m3": 300.0, "area_m2": 1000.0}


def figures(result: dict[str, float], truth: dict[str, float]) -> dict[str, float]:
    return {one.id: one.value for one in volume_score(result, truth).figures}


def test_the_truth_itself_has_no_errors() -> None:
    assert set(figures(TRUTH, TRUTH).values()) == {0.0}


def test_errors_are_shares_of_the_true_values_with_their_sign() -> None:
    result = {"cut_m3": 190.0, "fill_m3": 510.0, "net_m3": 320.0, "area_m2": 1000.0}
    assert figures(result, TRUTH) == pytest.approx(
        {"cut_off": -0.05, "fill_off": 0.02, "net_off": 1 / 15, "area_off": 0.0}
    )
    hole = {**TRUTH, "net_m3": -300.0}
    assert figures({**hole, "net_m3": -330.0}, hole)["net_off"] == pytest.approx(-0.1)


def test_the_stated_uncertainty_holds_or_does_not() -> None:
    result = {**TRUTH, "cut_m3": 190.0, "fill_m3": 510.0, "net_m3": 320.0, "uncertainty_m3": 12.0}
    assert volume_score(result, TRUTH).share_of("within_uncertainty") == pytest.approx(2 / 3)
    assert volume_score(result, TRUTH).limits == {"uncertainty_m3": 12.0}
    assert math.isnan(volume_score(TRUTH, TRUTH).share_of("within_uncertainty"))


def test_what_is_seen_is_compared_where_the_truth_knows_it() -> None:
    truth = {**TRUTH, "cut_where_seen_m3": 190.0, "unseen_area_m2": 40.0}
    score = volume_score({**TRUTH, "cut_m3": 190.0, "unmeasured_area_m2": 38.0}, truth)
    assert {one.id: one.value for one in score.figures}["cut_where_seen_off"] == 0
    assert score.left_out == {"unmeasured_area_m2": 38, "unseen_area_m2": 40}


def test_nothing_to_dig_has_no_share() -> None:
    level = {**TRUTH, "cut_m3": 0.0}
    assert math.isnan(figures(TRUTH, level)["cut_off"])
    assert figures(level, level)["cut_off"] == 0
