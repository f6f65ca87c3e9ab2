"""The extended DM is read back by a reader of the test's own: every count, place, word."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import OutOfRange, Unsuitable
from processing.core.text import Text
from processing.formats.survey.dm_reading import read_dm_features
from processing.formats.survey.line_arcs import line_parts
from processing.formats.survey.map_sheets import MapSheet, sheet_at
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.drafting.constructions import arc_through
from processing.map.feature import Feature, Position, Status, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of
from tests.processing.formats.survey.dm_reader import ReadSheet, read_dm

_ZONE_9 = "EPSG:6677"
_ON_SHEET = "09LD2800"
_FOOT = (-7890.2, -36050.5, 12.345)


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _feature(kind: str, geometry: Geometry, *positions: Position, **own: Any) -> Feature:
    return Feature(f"id-{kind}", kind, geometry, tuple(map(Vertex, positions)), own)


def _written(
    folder: Path, catalogue: Catalogue, *features: Feature, crs: str = _ZONE_9, **options: Any
) -> tuple[dict[str, ReadSheet], list[Text]]:
    notes: list[Text] = []
    request = ExportRequest(("dm",), folder, options=options)
    paths = export(features, catalogue, crs, request, tell=notes.append)
    assert sorted(paths) == sorted(folder.iterdir())
    return {path.stem: read_dm(path) for path in paths}, notes


@pytest.mark.parametrize(
    ("identifier", "corner"),
    [("06OC5708", (-135_300, -48_800)), (_ON_SHEET, (-36_300, -8_000))],
)
def test_sheets_have_the_identifiers_that_cities_use(
    identifier: str, corner: tuple[int, int]
) -> None:
    x, y = (one * 1000 for one in corner)
    sheet = sheet_at(int(identifier[:2]), x, y)
    assert sheet.identifier == identifier
    assert sheet.south_west_mm == (x, y)
    assert sheet_at(sheet.zone, x + 299_999, y + 399_999) == sheet
    assert sheet.neighbours[1] == sheet_at(sheet.zone, x + 300_000, y)
    assert sheet.neighbours[5] == MapSheet(sheet.zone, sheet.row + 1, sheet.column)


def test_lines_are_read_at_the_millimetre_with_their_heights(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    places = [(-7890.2 + 1.5 * at, -36050.501, 12.345 + at / 1000) for at in range(9)]
    edge = _feature("road_edge", Geometry.LINE, *places, survey_date="2026-11-21")
    sheets, notes = _written(tmp_path, catalogue, edge)
    sheet = sheets[_ON_SHEET]
    assert (sheet.identifier, sheet.level, notes) == (_ON_SHEET, 500, [])
    assert sheet.corners == [-36300, -8000, -36000, -7600, -36000, -8000, -36300, -7600]
    assert sheet.headers == [("2100", 1, [0, 1, 0, 0, 0, 0, 0, 0])]
    (element,) = sheet.elements
    assert (element.type, element.code, element.kind, element.number) == ("E2", "2101", 3, 1)
    assert element.columns["accuracy"] == "34"
    assert element.columns["surveyed"] == "2611"
    assert element.places == [pytest.approx(place, abs=0.0005) for place in places]


def test_a_line_over_an_edge_is_cut_there_and_the_cut_is_on_both_sheets(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    west_to_east = ((-7610.0, -36060.0, 10.0), (-7590.0, -36050.0, 12.0))
    sheets, _ = _written(tmp_path, catalogue, _feature("road_edge", Geometry.LINE, *west_to_east))
    assert sheets.keys() == {_ON_SHEET, "09LD2801"}
    (here,), (there,) = (one.elements for one in sheets.values())
    assert here.places == [west_to_east[0], (-7600.0, -36055.0, 11.0)]
    assert there.places == [(-7600.0, -36055.0, 11.0), west_to_east[1]]


def test_an_area_over_an_edge_is_closed_on_both_sheets_and_keeps_its_size(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    ring = (
        (-7610.0, -36100.0, 10.0),
        (-7590.0, -36100.0, 12.0),
        (-7590.0, -36090.0, 12.0),
        (-7610.0, -36090.0, 10.0),
    )
    sheets, _ = _written(tmp_path, catalogue, _feature("building", Geometry.AREA, *ring))
    assert len(sheets) == 2
    for name, sheet in sheets.items():
        (element,) = sheet.elements
        assert (element.type, element.kind) == ("E1", 3)
        assert element.places[0] == element.places[-1]
        assert len(element.places) == 5
        east = {place[0] for place in element.places}
        assert east == ({-7610.0, -7600.0} if name == _ON_SHEET else {-7600.0, -7590.0})
        assert {place[2] for place in element.places} == {11.0, 10.0 if name == _ON_SHEET else 12.0}
        assert [one for one in sheet.neighbours if one] == [one for one in sheets if one != name]


def test_points_face_as_they_do_and_are_circles_or_points(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    x, y, z = _FOOT
    features = (
        _feature("sign_guide", Geometry.POINT, _FOOT, facing_deg=90.0),
        _feature("sign_warning", Geometry.POINT, _FOOT),
        _feature("power_pole", Geometry.POINT, _FOOT, wires_deg="0/180"),
        _feature("manhole_sewer", Geometry.POINT, _FOOT, diameter_m=0.6),
        _feature("street_tree", Geometry.POINT, _FOOT),
    )
    sheets, _ = _written(tmp_path, catalogue, *features)
    found = {one.code: one for one in sheets[_ON_SHEET].elements}
    assert [(one.type, one.kind) for one in found.values()] == [
        ("E6", 2), ("E5", 0), ("E5", 0), ("E6", 2), ("E3", 3)
    ]  # fmt: skip
    assert found["2242"].places == [(x, y), (x + 3, y)]
    assert found["4142"].places == [(x, y), (x, y + 3), (x, y), (x, y - 3)]
    assert found["4151"].places == [(x + 0.3, y, z), (x, y + 0.3, z), (x - 0.3, y, z)]
    assert found["2238"].places == found["2243"].places == [(x, y)]
    assert [code for code, _, _ in sheets[_ON_SHEET].headers] == ["2200", "4100"]


def test_heights_and_names_are_numbers_and_notes(tmp_path: Path, catalogue: Catalogue) -> None:
    long = "通り" * 20
    features = (
        _feature("spot_height", Geometry.POINT, _FOOT),
        _feature("road_name", Geometry.POINT, _FOOT, name="No.1通り〜𠮷野"),
        _feature("note", Geometry.POINT, _FOOT, name=long),
        _feature("building", Geometry.AREA, _FOOT, (-7880, -36050, 12.0), (-7880, -36040, 12.0)),
    )
    sheets, notes = _written(tmp_path, catalogue, *features)
    elements = sheets[_ON_SHEET].elements
    assert [(one.type, one.code) for one in elements] == [
        ("E1", "3001"), ("E5", "7312"), ("E7", "8173"), ("E7", "8121"), ("E7", "8181")
    ]  # fmt: skip
    assert elements[1].columns["value"] == "12345"
    assert [one.words for one in elements[2:]] == ["12.3", "Ｎｏ．１通り～〓野", long]
    assert [one.columns["note"] for one in elements[2:]] == ["2", "1", "1"]
    assert all(one.letters_mm == 2.0 for one in elements[2:])
    assert [note.en for note in notes] == [
        "Shift_JIS lacks characters, which were replaced: 𠮷 (U+20BB7) → 〓."
    ]


def test_a_corner_of_the_sheet_is_moved_by_a_millimetre_for_readers_that_skip_it(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    corner = (-8000.0, -36300.0, 1.0)
    sheets, _ = _written(tmp_path, catalogue, _feature("street_tree", Geometry.POINT, corner))
    assert sheets[_ON_SHEET].elements[0].places == [(-7999.999, -36300.0)]


def test_a_kind_without_a_code_is_left_out_and_told(tmp_path: Path, catalogue: Catalogue) -> None:
    tree = _feature("street_tree", Geometry.POINT, _FOOT)
    wire = _feature("wire", Geometry.LINE, _FOOT, (-7880, -36050, 12.0))
    sheets, notes = _written(
        tmp_path, catalogue, tree, wire, wire, dm_company="見本測量", dm_approval="平28九公第173号"
    )
    assert [one.code for one in sheets[_ON_SHEET].elements] == ["2238"]
    assert sheets[_ON_SHEET].company == "見本測量"
    assert notes == [
        Text(
            "Not in the extended DM, which has no code for them: Wire (2).",
            "分類コードのない種別は拡張DMに含まれていません: 架線（2）",
        )
    ]


def test_what_no_sheet_can_hold_is_refused_and_nothing_is_written(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    tree = _feature("street_tree", Geometry.POINT, _FOOT)
    far = _feature("street_tree", Geometry.POINT, (375_000.0, 3_945_000.0, 1.0))
    high = _feature("road_edge", Geometry.LINE, _FOOT, (-7880.0, -36050.0, 123_456.0))
    wire = _feature("wire", Geometry.LINE, _FOOT, (-7880, -36050, 12.0))
    for crs, features, refusal in (
        ("EPSG:32654", (tree,), Unsuitable),
        (_ZONE_9, (tree, far), OutOfRange),
        (_ZONE_9, (tree, high), OutOfRange),
        (_ZONE_9, (wire,), Unsuitable),
        (_ZONE_9, (), Unsuitable),
    ):
        with pytest.raises(refusal) as error:
            _written(tmp_path / "out", catalogue, *features, crs=crs)
        assert "\n" not in error.value.line("ja")
        assert not list((tmp_path / "out").glob("*"))


def test_a_map_without_codes_leaves_other_formats_their_files(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    wire = _feature("wire", Geometry.LINE, _FOOT, (-7880.0, -36050.0, 18.0))
    notes: list[Text] = []
    request = ExportRequest(("dm", "geojson"), tmp_path)
    paths = export((wire,), catalogue, _ZONE_9, request, tell=notes.append)
    assert [path.suffix for path in paths] == [".geojson"]
    assert [one.en for one in notes] == [
        "No sheet of the extended DM was written: no accepted feature has a code there.",
        "Not in the extended DM, which has no code for them: Wire (1).",
    ]


def test_candidates_are_in_no_format_that_can_not_mark_them(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    edge = _feature("road_edge", Geometry.LINE, _FOOT, (-7880.0, -36050.0, 12.0))
    doubted = replace(edge, id="doubted", status=Status.CANDIDATE)
    for format_ in ("dm", "sima", "sxf"):
        contents = []
        for number, features in enumerate(((edge,), (edge, doubted))):
            folder, notes = tmp_path / f"{format_}{number}", list[Text]()
            request = ExportRequest((format_,), folder, candidates=True)
            paths = export(features, catalogue, _ZONE_9, request, tell=notes.append)
            assert sum("candidates: 1 " in one.en for one in notes) == number
            contents.append([path.stat().st_size for path in paths])
        assert contents[0] == contents[1]


def test_a_centre_line_is_straight_and_on_arcs_and_comes_back(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    east, north = -7890.0, -36050.0
    turn = math.sqrt(0.5) * 40.0
    arc = arc_through(
        (east, north, 10.0),
        (east + turn, north + 40.0 - turn, 10.5),
        (east + 40.0, north + 40.0, 11.0),
    )
    assert len(arc) > 10
    line = ((east - 50.0, north, 9.0), *arc, (east + 40.0, north + 49.0, 12.0))
    centre = _feature("road_center", Geometry.LINE, *line)
    sheets, _ = _written(tmp_path, catalogue, centre)
    elements = sheets[_ON_SHEET].elements
    assert [(one.type, one.code) for one in elements] == [
        ("E2", "2505"), ("E4", "2505"), ("E2", "2505"),
    ]  # fmt: skip
    straight, bent, rest = elements
    assert (straight.places[-1], bent.places[-1]) == (bent.places[0], rest.places[0])
    assert len(bent.places) == 3
    assert math.dist(bent.places[1][:2], (east, north + 40.0)) == pytest.approx(40.0, abs=0.003)
    read = read_dm_features(tmp_path / f"{_ON_SHEET}.dm")
    drawn, back = shapely.LineString(line), [shapely.LineString(one.xyz) for one in read.features]
    assert drawn.hausdorff_distance(shapely.MultiLineString(back)) < 0.02
    assert back[1].length == pytest.approx(shapely.LineString(arc).length, abs=0.02)


def test_a_measured_line_that_bends_is_no_arc(tmp_path: Path, catalogue: Catalogue) -> None:
    """Twenty metres of road with heights of its own stay what was drawn."""
    around = [(40.0 * math.sin(a), 40.0 - 40.0 * math.cos(a)) for a in np.linspace(0, 0.5, 40)]
    places = [
        (-7890.0 + x, -36050.0 + y, 10.0 + 0.05 * (at % 2)) for at, (x, y) in enumerate(around)
    ]
    sheets, _ = _written(tmp_path, catalogue, _feature("road_center", Geometry.LINE, *places))
    (element,) = sheets[_ON_SHEET].elements
    assert (element.type, len(element.places)) == ("E2", 40)


@given(st.lists(st.tuples(st.integers(0, 300_000), st.integers(0, 400_000), st.integers(0, 9999)),
                min_size=2, max_size=12))  # fmt: skip
def test_parts_of_a_line_join_whatever_it_is(places: list[tuple[int, int, int]]) -> None:
    parts = list(line_parts(places))
    assert parts[0][1][0] == places[0]
    assert parts[-1][1][-1] == places[-1]
    assert all(one[1][-1] == other[1][0] for one, other in pairwise(parts))
