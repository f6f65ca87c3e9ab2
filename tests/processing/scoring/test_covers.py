"""Covers against a truth, on covers and copies with known faults."""

from __future__ import annotations

import pytest

from processing.core.errors import BadFile
from processing.scoring.features.covers import cover_score
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from tests.processing.scoring.small_maps import feature, map_of, moved, point, with_more


def square(x: float, y: float, long: float, wide: float, **facts: object) -> MappedFeature:
    ring = [[x, y, 0.0], [x + long, y, 0.0], [x + long, y + wide, 0.0], [x, y + wide, 0.0]]
    known = {"kind": "manhole_area", "length_m": long, "width_m": wide}
    return feature("area", ring, **{**known, **facts})


MANHOLE = point(0.0, 0.0, kind="manhole", diameter_m=0.6)
TRUTH = map_of([MANHOLE, square(5.0, 0.0, 0.9, 0.6), square(9.0, 1.0, 0.5, 0.4, kind="rain_inlet")])


def counts(score_of: MappedFile, truth: MappedFile = TRUTH) -> BinaryConfusionMatrix:
    return cover_score(score_of, truth).counts_of("covers")


def test_the_truth_itself_is_right_in_everything() -> None:
    score = cover_score(TRUTH, TRUTH)
    assert score.counts_of("covers") == BinaryConfusionMatrix(3, 0, 0, 0)
    assert [one.share.value for one in score.shares] == [1.0, 1.0, 1.0]
    assert [one.count for one in score.errors] == [3, 1, 4]
    assert max(one.largest for one in score.errors) == pytest.approx(0, abs=1e-9)


def test_places_count_up_to_20_cm_and_are_exact_up_to_5_cm() -> None:
    assert counts(moved(TRUTH, north=0.19)) == BinaryConfusionMatrix(3, 0, 0, 0)
    assert counts(moved(TRUTH, north=0.21)) == BinaryConfusionMatrix(0, 3, 3, 0)
    assert cover_score(moved(TRUTH, north=0.06), TRUTH).share_of("near") == 0.0
    assert cover_score(moved(TRUTH, north=0.04), TRUTH).share_of("near") == 1.0


def test_shape_and_size_are_told_apart_from_the_place() -> None:
    found = map_of([square(-0.3, -0.3, 0.6, 0.6), square(5.0, 0.0, 0.9, 0.67)])
    score = cover_score(found, TRUTH)
    assert score.counts_of("covers") == BinaryConfusionMatrix(2, 0, 1, 0)
    assert score.share_of("shape") == pytest.approx(0.5)
    assert score.share_of("sized") == 0.0
    assert score.errors_of("sides").largest == pytest.approx(0.07)


def test_what_the_points_do_not_show_is_not_asked_and_not_false() -> None:
    unseen = [
        square(20.0, 0.0, 0.6, 0.6, points=140),
        square(22.0, 0.0, 0.6, 0.6, points=900, covered=0.6),
        square(24.0, 0.0, 0.6, 0.6, points=900, covered=1.0, in_span=False),
        square(26.0, 0.0, 0.6, 0.6, points=900, covered=1.0, is_asked=False),
    ]
    truth = with_more(TRUTH, *unseen)
    assert counts(TRUTH, truth) == BinaryConfusionMatrix(3, 0, 0, 0)
    assert counts(truth, truth) == BinaryConfusionMatrix(3, 0, 0, 0)
    assert counts(with_more(TRUTH, square(30.0, 0.0, 0.6, 0.6)), truth).false_alarms == 1


def test_maps_of_points_alone_and_of_areas_alone_are_scored() -> None:
    assert counts(map_of([MANHOLE])) == BinaryConfusionMatrix(1, 0, 2, 0)
    assert counts(map_of([*TRUTH.features[1:]])) == BinaryConfusionMatrix(2, 0, 1, 0)


def test_other_features_of_a_map_are_left_out_but_not_a_map_of_others() -> None:
    pole = point(3.0, 3.0, kind="pole")
    line = feature("line", [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], kind="manhole")
    assert counts(with_more(TRUTH, pole)) == BinaryConfusionMatrix(3, 0, 0, 0)
    with pytest.raises(BadFile):
        cover_score(map_of([pole]), TRUTH)
    with pytest.raises(BadFile):
        cover_score(map_of([line]), TRUTH)
