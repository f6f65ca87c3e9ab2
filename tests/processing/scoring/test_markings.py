"""Road markings against a truth, on lines and bars and copies with known faults."""

from __future__ import annotations

import pytest

from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.markings import marking_score
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from tests.processing.scoring.small_maps import feature, map_of, moved, with_facts, with_more


def line(north: float, **facts: object) -> MappedFeature:
    ends = [[10.0 * n, north, 0.0] for n in range(4)]
    return feature("line", ends, **{"kind": "marking_line", "type": "solid", **facts})


def bar(east: float, **facts: object) -> MappedFeature:
    ends = [[east, -9.0, 0.0], [east, -5.0, 0.0]]
    return feature("line", ends, kind="crosswalk_bar", width_m=0.45, **facts)


LINES = (line(0.0, width_m=0.15), line(3.0, width_m=0.15, type="broken"))
TRUTH = map_of([*LINES, *(bar(0.9 * n) for n in range(5))])


def counts(score_of: MappedFile, truth: MappedFile = TRUTH) -> BinaryConfusionMatrix:
    return marking_score(score_of, truth).counts_of("lines")


def test_the_truth_itself_is_right_in_everything() -> None:
    score = marking_score(TRUTH, TRUTH)
    assert score.counts_of("lines") == BinaryConfusionMatrix(600, 0, 0, 0)
    assert score.counts_of("bars") == BinaryConfusionMatrix(5, 0, 0, 0)
    assert score.share_of("type") == 1
    assert max(one.largest for one in score.errors) == pytest.approx(0, abs=1e-9)


def test_lines_farther_off_than_3_cm_are_false_and_their_truth_is_missed() -> None:
    assert counts(moved(TRUTH, north=0.02)) == BinaryConfusionMatrix(600, 0, 0, 0)
    assert counts(moved(TRUTH, north=0.05)) == BinaryConfusionMatrix(0, 600, 600, 0)
    assert marking_score(moved(TRUTH, north=0.02), TRUTH).errors_of("off").rms == pytest.approx(
        0.02
    )


def test_a_second_line_along_a_true_one_is_false() -> None:
    doubled = with_more(TRUTH, line(0.02, width_m=0.15))
    assert counts(doubled) == BinaryConfusionMatrix(600, 300, 0, 0)


def test_what_the_points_do_not_show_is_not_asked_and_not_false() -> None:
    truth = map_of([line(0.0, piece_points=[500, 500, 3]), line(3.0, type="other")])
    assert counts(map_of([line(0.0), line(3.1)]), truth) == BinaryConfusionMatrix(200, 0, 0, 0)
    assert counts(map_of([line(8.0)]), truth) == BinaryConfusionMatrix(0, 300, 200, 0)


def test_types_and_widths_are_compared() -> None:
    other = with_facts(TRUTH, lambda _: {"width_m": 0.2})
    assert marking_score(other, TRUTH).errors_of("width").mean == pytest.approx(0.05)
    solid = map_of([line(0.0), line(3.0), *TRUTH.features[2:]])
    assert marking_score(solid, TRUTH).share_of("type") == pytest.approx(0.5)


def test_bars_are_paired_one_to_one() -> None:
    fewer = map_of([*LINES, bar(0.0), bar(0.05), bar(0.9), bar(1.8)])
    found = marking_score(fewer, TRUTH).counts_of("bars")
    assert found == BinaryConfusionMatrix(3, 1, 2, 0)
    unseen = map_of([*LINES, bar(0.0), bar(0.9, piece_points=[4])])
    assert marking_score(map_of([*LINES, bar(0.9)]), unseen).counts_of(
        "bars"
    ) == BinaryConfusionMatrix(0, 0, 1, 0)
