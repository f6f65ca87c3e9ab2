"""The table of covers, of scores of small maps."""

from __future__ import annotations

from processing.laboratory.accuracy.road_map.covers import TABLE, section_of
from processing.laboratory.accuracy.road_map.line_tables import LinesOfStreet
from processing.scoring.features.covers import cover_score
from tests.processing.scoring.small_maps import map_of, moved, point


def test_covers_of_streets_are_told_in_the_table_and_added_up() -> None:
    truth = map_of([point(4.0 * k, 0.0, kind="manhole", diameter_m=0.6) for k in range(5)])
    few = map_of([*truth.features[:3], point(30.0, 0.0, kind="manhole", diameter_m=0.3)])
    rows = [
        LinesOfStreet("one", cover_score(moved(truth, north=0.03), truth)),
        LinesOfStreet("other", cover_score(few, truth)),
        LinesOfStreet("empty", cover_score(map_of([]), map_of([]))),
    ]
    text = section_of(rows)
    assert (
        "| one | 5, 0, 0 | 100.0 % | 100.0 % | 100.0 % | 5 of 5 | 5 of 5 | 5 of 5 | 3.0 cm" in text
    )
    assert "| other | 3, 1, 2 | 75.0 % | 60.0 % | 66.7 %" in text
    assert "| empty | 0, 0, 0 | – | – | – | – | – | – | –" in text
    assert "| all | 8, 1, 2 | 88.9 % | 80.0 % | 84.2 % | 8 of 8" in text


def test_the_streets_of_the_table_are_towns_and_country_roads() -> None:
    styles = [TABLE.request_of(number, 9561 + number, 60.0).style for number in range(3)]
    assert styles == ["urban", "urban", "rural"]
