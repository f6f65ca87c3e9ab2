"""Edges of the carriageway against a truth, on lines and copies with known faults."""

from __future__ import annotations

import pytest

from processing.core.errors import BadFile
from processing.scoring.features.edges import edge_score
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from tests.processing.scoring.small_maps import feature, map_of, moved, with_more


def line(north: float, **facts: object) -> MappedFeature:
    ends = [[10.0 * n, north, 0.0] for n in range(4)]
    return feature("line", ends, **{"kind": "road_edge", "type": "grass", **facts})


LINES = (line(0.0), line(5.0, kind="sidewalk", type="walk"))
TRUTH = map_of([*LINES])


def counts(score_of: MappedFile, truth: MappedFile = TRUTH) -> BinaryConfusionMatrix:
    return edge_score(score_of, truth).counts_of("lines")


def test_the_truth_itself_is_right_in_everything() -> None:
    score = edge_score(TRUTH, TRUTH)
    assert score.counts_of("lines") == BinaryConfusionMatrix(600, 0, 0, 0)
    assert score.share_of("type") == 1
    assert max(one.largest for one in score.errors) == pytest.approx(0, abs=1e-9)


def test_lines_farther_off_than_10_cm_are_false_and_their_truth_is_missed() -> None:
    assert counts(moved(TRUTH, north=0.09)) == BinaryConfusionMatrix(600, 0, 0, 0)
    assert counts(moved(TRUTH, north=0.11)) == BinaryConfusionMatrix(0, 600, 600, 0)


def test_what_lies_outside_is_told_apart_from_the_place() -> None:
    score = edge_score(map_of([line(0.0, type="soil"), LINES[1]]), TRUTH)
    assert score.counts_of("lines") == BinaryConfusionMatrix(600, 0, 0, 0)
    assert score.share_of("type") == pytest.approx(0.5)


def test_edges_in_front_of_curbs_are_neither_asked_for_nor_wrong() -> None:
    truth = with_more(TRUTH, line(9.0, type="other"))
    assert counts(TRUTH, truth) == BinaryConfusionMatrix(600, 0, 0, 0)
    assert counts(with_more(TRUTH, line(9.2)), truth) == BinaryConfusionMatrix(600, 0, 0, 0)
    assert counts(with_more(TRUTH, line(9.5)), truth) == BinaryConfusionMatrix(600, 300, 0, 0)


def test_what_the_points_do_not_show_is_not_asked_and_not_false() -> None:
    dark = line(12.0, piece_points=[500, 199, 200], piece_in_span=[True, True, False])
    truth = with_more(TRUTH, dark)
    assert counts(TRUTH, truth) == BinaryConfusionMatrix(600, 0, 100, 0)
    assert counts(with_more(TRUTH, line(12.0)), truth) == BinaryConfusionMatrix(700, 0, 0, 0)


def test_a_file_without_edges_is_refused() -> None:
    with pytest.raises(BadFile):
        edge_score(map_of([feature("line", [[0, 0, 0], [1, 0, 0]], kind="fence")]), TRUTH)
