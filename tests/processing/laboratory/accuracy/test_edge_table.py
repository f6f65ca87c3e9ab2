"""The table of edges of the carriageway, from scores that are known."""

from __future__ import annotations

from processing.laboratory.accuracy.road_map.edges import TABLE, section_of
from processing.laboratory.accuracy.road_map.line_tables import LinesOfStreet
from processing.scoring.features.edges import edge_score
from processing.scoring.features.mapped_features import MappedFeature
from tests.processing.scoring.small_maps import feature, map_of


def line(north: float, kind: str = "grass") -> MappedFeature:
    ends = [[10.0 * n, north, 0.0] for n in range(4)]
    return feature("line", ends, kind="road_edge", type=kind)


def test_metres_and_shares_of_all_streets_are_told() -> None:
    truth = map_of([line(0.0), line(6.0)])
    rows = [
        LinesOfStreet("one", edge_score(truth, truth)),
        LinesOfStreet("other", edge_score(map_of([line(0.0, "soil"), line(9.0)]), truth)),
    ]
    one, other, every = section_of(rows).strip().splitlines()[-3:]
    assert "60 m, 0 m, 0 m | 100.0 % | 100.0 % | 100.0 % | 100 %" in one
    assert "30 m, 30 m, 30 m | 50.0 % | 50.0 % | 50.0 % | 0 %" in other
    assert "90 m, 30 m, 30 m | 75.0 % | 75.0 % | 75.0 %" in every


def test_three_of_four_streets_have_sides_without_curbs() -> None:
    wanted = [TABLE.request_of(number, 1, 60.0) for number in range(8)]
    assert [one.flush for one in wanted] == [True, True, True, False] * 2
    assert {one.style for one in wanted} == {"urban", "rural", "highway"}
