"""Places below the clearance against a truth, on copies with known faults."""

from __future__ import annotations

import pytest

from processing.scoring.features.clearances import clearance_score
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from tests.processing.scoring.small_maps import EAST, NORTH, feature, map_of


def cell(east: float, over: float, points: int = 30) -> list[float]:
    return [EAST + east, NORTH, 133.0, over, points]


def thing(east: float, **facts: object) -> MappedFeature:
    """A crown 3 m long: its cells with heights over the road from 3 m on, 30 points each."""
    cells = [cell(east + 0.5 * k, 3.0 + 0.5 * k) for k in range(7)]
    said = {
        "kind": "clearance_place", "type": "tree", "lowest_m": 3.0, "depth_m": 1.0,
        "is_standing": False, "places": cells,
    }  # fmt: skip
    return feature("point", [[east, 0.0, 13.0]], **{**said, **facts})


def place(east: float, **facts: object) -> MappedFeature:
    said = {
        "kind": "clearance_place", "above": "carriageway", "lowest_m": 3.05, "limit_m": 4.5,
        "length_m": 1.5,
    }  # fmt: skip
    return feature("point", [[east, 0.2, 13.0]], **{**said, **facts})


TRUTH = map_of([thing(0.0), thing(40.0)])


def counts(*found: MappedFeature, truth: MappedFile = TRUTH) -> BinaryConfusionMatrix:
    return clearance_score(map_of([*found]), truth).counts_of("places")


def test_a_place_on_each_thing_is_right_and_its_height_is_compared() -> None:
    found = (place(0.3), place(40.3))
    assert counts(*found) == BinaryConfusionMatrix(2, 0, 0, 0)
    errors = clearance_score(map_of([*found]), TRUTH).errors_of("lowest")
    assert errors.count == 2
    assert errors.mean == pytest.approx(0.05)


def test_what_lies_on_nothing_is_false_and_what_nobody_found_is_missed() -> None:
    assert counts(place(0.3), place(20.0)) == BinaryConfusionMatrix(1, 1, 1, 0)


def test_a_long_place_finds_the_things_that_it_reaches() -> None:
    assert counts(place(0.3, length_m=45.0)) == BinaryConfusionMatrix(2, 0, 0, 0)


def test_places_over_walks_are_not_judged() -> None:
    assert counts(place(0.3), place(20.0, above="walk")) == BinaryConfusionMatrix(1, 0, 1, 0)


@pytest.mark.parametrize(
    "facts", [{"is_standing": True}, {"depth_m": 0.1}, {"places": [cell(40.0, 3.0, 5)]}]
)
def test_what_stands_or_shows_little_is_neither_missed_nor_false(facts: dict[str, object]) -> None:
    truth = map_of([thing(0.0), thing(40.0, **facts)])
    assert counts(place(0.3), truth=truth) == BinaryConfusionMatrix(1, 0, 0, 0)
    assert counts(place(0.3), place(40.3), truth=truth) == BinaryConfusionMatrix(1, 0, 0, 0)


def test_a_higher_limit_of_the_result_asks_for_more() -> None:
    truth = map_of([thing(0.0, places=[cell(0.0, 4.8)])])
    assert counts(truth=truth) == BinaryConfusionMatrix(0, 0, 0, 0)
    assert counts(place(0.3, limit_m=5.0), truth=truth) == BinaryConfusionMatrix(1, 0, 0, 0)
