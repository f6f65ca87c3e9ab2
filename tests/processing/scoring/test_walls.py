"""Walls against a truth, on lines and copies with known faults."""

from __future__ import annotations

from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.walls import wall_score
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from tests.processing.scoring.small_maps import feature, map_of, moved, with_facts, with_more


def line(north: float, **facts: object) -> MappedFeature:
    ends = [[10.0 * n, north, 0.0] for n in range(4)]
    return feature("line", ends, **{"kind": "wall", "type": "wall", "height_m": 1.5, **facts})


def face(north: float, **facts: object) -> MappedFeature:
    return line(north, **{"kind": "building_face", "type": "building", **facts})


TRUTH = map_of([line(0.0), face(9.0)])


def counts(result: MappedFile, truth: MappedFile = TRUTH) -> list[BinaryConfusionMatrix]:
    score = wall_score(result, truth)
    return [score.counts_of("walls"), score.counts_of("faces")]


def test_the_truth_itself_is_right_in_everything() -> None:
    assert counts(TRUTH) == [BinaryConfusionMatrix(300, 0, 0, 0)] * 2
    score = wall_score(TRUTH, TRUTH)
    assert score.share_of("type") == 1
    assert score.errors_of("height").largest == 0


def test_lines_farther_off_than_5_cm_are_false_and_their_truth_is_missed() -> None:
    assert counts(moved(TRUTH, north=0.04)) == [BinaryConfusionMatrix(300, 0, 0, 0)] * 2
    assert counts(moved(TRUTH, north=0.06)) == [BinaryConfusionMatrix(0, 300, 300, 0)] * 2


def test_a_wall_that_is_called_a_building_is_found_but_of_the_wrong_type() -> None:
    called = with_facts(TRUTH, lambda _: {"kind": "building_face", "type": "building"})
    assert counts(called) == [BinaryConfusionMatrix(300, 0, 0, 0)] * 2
    assert wall_score(called, TRUTH).share_of("type") == 0.5


def test_what_points_dont_show_is_neither_missed_nor_made_up() -> None:
    hidden = {"piece_points": [500, 500, 3], "piece_in_span": [True, False, True]}
    truth = map_of([line(0.0, **hidden)])
    assert counts(truth, truth)[0] == BinaryConfusionMatrix(100, 0, 0, 0)
    beside = counts(map_of([line(0.2)]), truth)[0]
    assert (beside.hits, beside.misses) == (0, 100)
    assert 95 <= beside.false_alarms <= 100  # the ends lie near what is not asked for


def test_barriers_that_stand_like_walls_count_neither_way() -> None:
    truth = with_more(TRUTH, line(20.0, type="other"))
    assert counts(TRUTH, truth) == [BinaryConfusionMatrix(300, 0, 0, 0)] * 2
    assert counts(with_more(TRUTH, line(20.0)), truth)[0] == BinaryConfusionMatrix(300, 0, 0, 0)


def test_a_second_line_along_a_true_one_is_false() -> None:
    assert counts(with_more(TRUTH, line(0.02)))[0] == BinaryConfusionMatrix(300, 300, 0, 0)
