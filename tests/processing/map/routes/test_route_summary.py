"""A route as a whole: lengths, widths, areas and things are those that were drawn."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.formats.ledgers.ledger_columns import TableStyle
from processing.formats.ledgers.route_tables import route_tables
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Status, Vertex
from processing.map.routes.route_summary import CHANGE_M, RouteSummary, route_summaries
from processing.operations.export import ExportRequest, export
from resources import path_of

_CATALOGUE = read_catalogue(path_of("catalogue/level500.toml"))
_IDS = count()
_EAST, _NORTH = -8000.0, -36200.0


def _drawn(kind: str, *places: tuple[float, float], **own: str) -> Feature:
    vertices = tuple(Vertex((_EAST + x, _NORTH + y, 10.0)) for x, y in places)
    return Feature(f"f{next(_IDS)}", kind, _CATALOGUE[kind].geometry, vertices, own)


def _street(*steps: tuple[float, float]) -> list[Feature]:
    """A centre line to the east with edges at half widths from places on."""
    end = steps[-1][0]
    features = [_drawn("road_center", (0, 0), (end, 0), name="市道1号線")]
    begin = 0.0
    for until, half in steps:
        features += [_drawn("road_edge", (begin, y), (until, y)) for y in (half, -half)]
        begin = until
    return features


def _only(features: Sequence[Feature]) -> RouteSummary:
    (summary,) = route_summaries(features, _CATALOGUE)
    return summary


def test_a_route_is_divided_where_its_width_changes_by_half_a_metre() -> None:
    summary = _only(_street((60.5, 3.0), (100.5, 3.4), (130.0, 3.5)))
    assert [(one.start_m, one.end_m) for one in summary.stretches] == [(0, 61), (61, 130)]
    first, second = summary.stretches
    assert (first.first_m, first.least_m, first.greatest_m) == pytest.approx((6.0, 6.0, 6.0))
    assert (second.first_m, second.least_m, second.greatest_m) == pytest.approx((6.8, 6.8, 7.0))
    assert first.area_m2 == pytest.approx(61 * 6.0)
    assert summary.least_width_m == pytest.approx(6.0)
    assert summary.unknown_m == 0.0
    assert summary.end_m - summary.start_m == pytest.approx(130.0)


def test_what_has_no_edge_is_told_as_length_without_width() -> None:
    features = [*_street((50.5, 3.0)), _drawn("road_center", (0, 500), (40, 500), name="2号線")]
    features[0] = _drawn("road_center", (0, 0), (80, 0), name="1号線")
    first, second = route_summaries(features, _CATALOGUE)
    assert first.unknown_m == pytest.approx(29.0)
    assert second.unknown_m == pytest.approx(40.0)
    assert second.stretches == ()


def test_structures_have_stations_and_occupants_are_counted_on_the_nearest_route() -> None:
    bridge = _drawn("road_bridge_area", (20, -4), (45, -4), (45, 4), (20, 4), name="見本橋")
    same = _drawn("road_bridge", (20, 4), (45, 4), name="見本橋")
    poles = [_drawn("power_pole", (x, 4.5)) for x in (10, 40, 70)]
    refused = _drawn("power_pole", (60, 4.5)).with_status(Status.REJECTED)
    manhole = _drawn("manhole_sewer", (30, 0))
    other = _drawn("road_center", (0, 60), (100, 60), name="2号線")
    features = [*_street((100.0, 3.0)), bridge, same, *poles, refused, manhole, other]
    summary, beside = route_summaries(features, _CATALOGUE)
    assert [(one.kind, one.start_m, one.end_m) for one in summary.structures] == [
        ("road_bridge", 20.0, 45.0), ("road_bridge_area", 20.0, 45.0),
    ]  # fmt: skip
    assert summary.occupants == {"power_pole": 3, "manhole_sewer": 1}
    assert beside.occupants == {}
    routes, widths = route_tables([summary, beside], _CATALOGUE, TableStyle("en"))
    row = dict(zip(routes.headers, (words for words, _ in routes.rows[0]), strict=True))
    assert row["of it bridges [m]"] == "25.00"  # drawn as outline and as rail, it is one bridge
    assert row["Main occupations"] == "Manhole, sewer 1, Power pole 3"
    assert row["Kind of road"] == ""
    form = routes.for_paper()  # an item a line, a column a route
    assert form.headers == ("Route", "市道1号線", "2号線")
    assert len(form.rows) == len(routes.headers) - 1
    assert [words for words, _ in form.rows[6]] == ["Length [m]", "100.00", "100.00"]
    assert widths.for_paper() == widths
    assert [words for words, _ in widths.rows[0]][:6] == [
        "市道1号線", "No.0+0.00", "No.5+0.00", "100.00", "6.0～6.5", "6.00",
    ]  # fmt: skip


def test_a_map_without_centre_line_has_no_routes(tmp_path: Path) -> None:
    features = [_drawn("road_edge", (0, 3), (9, 3))]
    assert route_summaries(features, _CATALOGUE) == ()
    names = {
        one.name for one in export(features, _CATALOGUE, "", ExportRequest(("csv",), tmp_path))
    }
    assert "ledger_routes.csv" not in names


def test_routes_and_widths_are_files_of_their_own(tmp_path: Path) -> None:
    request = ExportRequest(("csv",), tmp_path, "ja", {"encoding": "cp932"})
    names = {one.name for one in export(_street((60.0, 3.0)), _CATALOGUE, "EPSG:6677", request)}
    assert {"ledger_routes.csv", "ledger_widths.csv", "ledger_road_sections.csv"} <= names
    lines = (tmp_path / "ledger_routes.csv").read_text(encoding="cp932").splitlines()
    assert lines[0].startswith("路線名,道路の種類,路線指定・認定年月日,起点（測点）")
    assert lines[1].startswith("市道1号線,,,No.0+0.00,No.3+0.00,,,60.00,")


@given(st.lists(st.tuples(st.floats(2, 40), st.floats(1, 6)), min_size=1, max_size=5))
def test_stretches_never_overlap_and_stay_within_half_a_metre(
    drawn: list[tuple[float, float]],
) -> None:
    steps, end = [], 0.0
    for length, half in drawn:
        end += round(length, 1)
        steps.append((end, round(half, 2)))
    summary = _only(_street(*steps))
    known = 0.0
    for one in summary.stretches:
        assert one.start_m >= known
        known = one.end_m
        assert one.first_m - CHANGE_M < one.least_m <= one.greatest_m < one.first_m + CHANGE_M
    total = sum(one.length_m for one in summary.stretches)
    assert total + summary.unknown_m == pytest.approx(end)
