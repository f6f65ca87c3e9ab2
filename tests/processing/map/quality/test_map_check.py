"""What stands against handing in a map is found, with its place; a clean map gives nothing."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import count

import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, PointReference, Position, Provenance, Status, Vertex
from processing.map.quality.findings import Finding
from processing.map.quality.map_check import check_map
from processing.map.quality.repairs import repair
from resources import path_of

_EAST, _NORTH = -11_394.608, -35_139.915
_IDS = count()


_CATALOGUE = read_catalogue(path_of("catalogue/level500.toml"))


@pytest.fixture
def catalogue() -> Catalogue:
    return _CATALOGUE


def _places(*local: tuple[float, ...]) -> tuple[Vertex, ...]:
    """Vertices beside a place of zone 9; height 5 m where none is given."""
    return tuple(
        Vertex((_EAST + one[0], _NORTH + one[1], one[2] if len(one) > 2 else 5.0)) for one in local
    )


def _line(*local: tuple[float, ...], kind: str = "road_edge") -> Feature:
    return Feature(f"f{next(_IDS)}", kind, Geometry.LINE, _places(*local))


def _area(*local: tuple[float, ...], kind: str = "gutter_lid") -> Feature:
    return Feature(f"f{next(_IDS)}", kind, Geometry.AREA, _places(*local))


def _point(*local: tuple[float, ...], kind: str = "street_tree", **own: str) -> Feature:
    listed = {"number": "1", "route": "市道1号線", **own}
    return Feature(f"f{next(_IDS)}", kind, Geometry.POINT, _places(*local), listed)


def _local(position: Position) -> tuple[float, float]:
    return position[0] - _EAST, position[1] - _NORTH


def _only(features: list[Feature], catalogue: Catalogue) -> Finding:
    (finding,) = check_map(features, catalogue).findings
    return finding


def test_a_clean_map_has_no_findings(catalogue: Catalogue) -> None:
    features = [
        _line((0, 0), (10, 0)),
        _line((10, 0), (20, 1)),  # joined at the end
        _line((5, 0), (5, 4)),  # joined at the other's middle
        _line((0, 0.2), (10, 0.2), kind="curb_upper"),  # another kind
        _area((0, 2), (1, 2), (1, 3), (0, 3)),
        _area((1, 2), (2, 2), (2, 3), (1, 3)),  # a lid beside it shares its side
        _point((3, 3)),
    ]
    found = check_map(features, catalogue)
    assert found.findings == ()
    assert found.errors == 0
    assert found.decided_share == 1.0


def test_what_rests_on_a_drive_that_is_gone_is_told_once(catalogue: Catalogue) -> None:
    places = _places((0, 0), (5, 0), (10, 0))
    on = [replace(one, measured=PointReference("left", at)) for at, one in enumerate(places)]
    line = Feature("l", "road_edge", Geometry.LINE, (on[0], places[1], on[2]))
    free = _line((0, 9), (10, 9))
    assert check_map([line, free], catalogue).findings == ()
    assert check_map([line, free], catalogue, drives={"left"}).findings == ()
    (finding,) = check_map([line, free], catalogue, drives={"right"}).findings
    assert (finding.rule, finding.features, finding.position) == ("drive_gone", ("l",), on[0].xyz)


def test_lines_that_cross_on_one_level_are_found_at_the_crossing(catalogue: Catalogue) -> None:
    across = [_line((0, 0), (10, 10)), _line((0, 10), (10, 0))]
    finding = _only(across, catalogue)
    assert finding.rule == "crossing"
    assert finding.features == (across[0].id, across[1].id)
    assert _local(finding.position) == pytest.approx((5, 5))
    bridge = [across[0], _line((0, 10, 11.0), (10, 0, 11.0))]
    assert check_map(bridge, catalogue).findings == ()
    wires = [_line((0, 0), (10, 10), kind="wire"), _line((0, 10), (10, 0), kind="wire")]
    assert check_map(wires, catalogue).findings == ()


@pytest.mark.parametrize("end", [(10.2, 0.0), (10.1, 0.1)])
def test_an_end_short_of_another_end_is_a_gap(
    catalogue: Catalogue, end: tuple[float, float]
) -> None:
    finding = _only([_line((0, 0), (10, 0)), _line(end, (20, 0))], catalogue)
    assert finding.rule == "gap"
    assert finding.extent_m == pytest.approx(((end[0] - 10) ** 2 + end[1] ** 2) ** 0.5)


def test_an_end_short_of_a_lines_middle_is_a_gap_and_parallels_are_none(
    catalogue: Catalogue,
) -> None:
    finding = _only([_line((0, 0), (10, 0)), _line((5, 0.2), (5, 5))], catalogue)
    assert (finding.rule, finding.extent_m) == ("gap", pytest.approx(0.2))
    edges = [_line((0, 0), (10, 0)), _line((0, 0.2), (10, 0.2))]
    assert check_map(edges, catalogue).findings == ()


def test_what_is_drawn_twice_is_found_in_every_geometry(catalogue: Catalogue) -> None:
    doubles = [
        [_line((0, 0), (10, 0)), _line((10, 0), (0, 0))],
        [_area((0, 0), (1, 0), (1, 1), (0, 1)), _area((0, 0), (1, 0), (1, 1.02), (0, 1))],
        [_point((0, 0)), _point((0.03, 0))],
    ]
    for both in doubles:
        assert _only(both, catalogue).rule == "duplicate"
    part = [_line((0, 0), (10, 0)), _line((5, 0), (15, 0))]
    assert _only(part, catalogue).rule == "partly_double"


def test_areas_that_overlap_are_found_with_how_much(catalogue: Catalogue) -> None:
    finding = _only(
        [_area((0, 0), (1, 0), (1, 1), (0, 1)), _area((0.5, 0), (2, 0), (2, 1), (0.5, 1))],
        catalogue,
    )
    assert (finding.rule, finding.extent_m) == ("overlap", pytest.approx(0.5))


def test_shapes_that_are_none_are_found(catalogue: Catalogue) -> None:
    assert _only([_line((0, 0), (4, 4), (4, 0), (0, 4))], catalogue).rule == "self_crossing"
    assert _only([_line((0, 0), (0.001, 0))], catalogue).rule == "too_small"
    assert _only([_area((0, 0), (1, 0), (2, 0))], catalogue).rule == "too_small"


def test_signs_without_number_undecided_and_unmeasured_things_are_told(
    catalogue: Catalogue,
) -> None:
    assert _only([_point((0, 0), kind="sign")], catalogue).rule == "number_missing"
    assert (
        check_map([_point((0, 0), kind="sign_warning", sign_number="208")], catalogue).findings
        == ()
    )
    tool = Provenance("trees", 1, {}, 0.7, "r1")
    place = _places((0, 0))
    listed = {"number": "1", "route": "市道1号線"}
    found = check_map(
        [
            Feature("a", "street_tree", Geometry.POINT, place, {}, Status.CANDIDATE, tool),
            Feature("b", "street_tree", Geometry.POINT, place, listed, Status.ACCEPTED, tool),
            Feature("c", "street_tree", Geometry.POINT, place, {}, Status.REJECTED, tool),
            Feature("d", "curb_upper", Geometry.LINE,
                    tuple(Vertex(one.xyz, is_occluded=True) for one in _places((0, 9), (3, 9)))),
        ],
        catalogue,
    )  # fmt: skip
    assert [(one.rule, one.features) for one in found.findings] == [
        ("unmeasured", ("d",)),
        ("undecided", ("a",)),
    ]
    assert found.decided_share == pytest.approx(2 / 3)
    trees = next(one for one in found.kinds if one.kind == "street_tree")
    assert (trees.accepted, trees.candidates, trees.rejected, trees.by_tools) == (1, 1, 1, 1)


def test_what_was_accepted_for_its_confidence_alone_counts_as_looked_at_by_nobody(
    catalogue: Catalogue,
) -> None:
    alone = Provenance("trees", 1, {}, 0.95, "r1", unseen=True)
    trees = [
        replace(_point((3.0 * at, 0)), provenance=replace(alone, unseen=at < 3)) for at in range(5)
    ]
    trees[4] = trees[4].with_status(Status.REJECTED)
    found = check_map(trees, catalogue)
    assert [(one.rule, one.features) for one in found.findings] == [
        ("unseen", (one.id,)) for one in trees[:3]
    ]
    (counted,) = found.kinds
    assert (counted.by_tools, counted.unseen, counted.decided) == (4, 3, 2)
    assert counted.precision == 0.5
    assert found.decided_share == pytest.approx(2 / 5)
    (nobody,) = check_map(trees[:3], catalogue).kinds
    assert math.isnan(nobody.precision)
    assert math.isnan(nobody.recall)
    seen = [one.with_status(Status.ACCEPTED) for one in trees[:3]]
    assert check_map(seen, catalogue).decided_share == 1.0
    assert check_map(seen, catalogue).findings == ()


_METRES = st.floats(-50, 50).map(lambda value: round(value, 2))


@given(st.lists(st.lists(st.tuples(_METRES, _METRES), min_size=2, max_size=5), max_size=6))
def test_any_lines_are_looked_through_and_every_finding_names_what_is_there(
    drawn: list[list[tuple[float, float]]],
) -> None:
    lines = [_line(*one) for one in drawn]
    found = check_map(lines, _CATALOGUE)
    known = {one.id for one in lines}
    assert all(set(one.features) <= known for one in found.findings)
    assert check_map(lines, _CATALOGUE) == found


def test_lines_of_two_sheets_that_miss_each_other_are_found_and_joined(
    catalogue: Catalogue,
) -> None:
    edge = -11_200.0  # a multiple of 400 m
    west, east = ((-20.0, 0.0), (-0.2, 0.0)), ((0.3, 0.4), (20.0, 0.4))
    features = [
        Feature(
            id_,
            "road_edge",
            Geometry.LINE,
            tuple(Vertex((edge + x, -35_100.0 + y, 5.0)) for x, y in line),
        )
        for id_, line in (("a", west), ("b", east))
    ]
    (finding,) = check_map(features, catalogue, crs="EPSG:6677").findings
    assert finding.rule == "sheet_gap"
    assert finding.extent_m == pytest.approx(0.64, abs=0.01)
    assert not check_map(features, catalogue, crs="EPSG:32654").findings
    change = repair([finding], {one.id: one for one in features})
    (joined,) = change.replaced
    others = [one for one in features if one.id != joined.after.id]
    assert not check_map([joined.after, *others], catalogue, crs="EPSG:6677").findings


def test_ends_away_from_sheet_edges_are_no_gaps_between_sheets(catalogue: Catalogue) -> None:
    lines = [_line((0.0, 0.0), (10.0, 0.0)), _line((10.6, 0.0), (20.0, 0.0))]
    assert not check_map(lines, catalogue, crs="EPSG:6677").findings
