"""Ledgers as a workbook are read back by openpyxl: numbers, texts, frozen headers, sheets."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import openpyxl
import pytest

from processing.core.text import Text
from processing.formats.ledgers.ledger_xlsx import NAME
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import AttributeValue, Feature, Status, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of

_CATALOGUE = read_catalogue(path_of("catalogue/level500.toml"))
_EAST, _NORTH = -11_394.608, -35_139.915


def _feature(id_: str, kind: str, *local: tuple[float, float], **own: AttributeValue) -> Feature:
    vertices = tuple(Vertex((_EAST + x, _NORTH + y, 5.0)) for x, y in local)
    return Feature(id_, kind, _CATALOGUE[kind].geometry, vertices, own)


def _along(id_: str, kind: str, y: float, **own: AttributeValue) -> Feature:
    return _feature(id_, kind, (0.0, y), (50.0, y), **own)


_ROAD = (
    _along("centre", "road_center", 0.0, route="市道1号線"),
    _along("l", "road_edge", 5.0, surface="アスファルト"),
    _along("r", "road_edge", -3.5),
    _along("lower", "curb_lower", 3.0),
    _along("upper", "curb_upper", 3.15),
    _feature("g", "gutter_covered", (10.0, 2.8), (30.0, 2.8)),
    _feature("fence", "guard_rail", (0.0, -3.3), (20.0, -3.3)),
    _feature("t1", "street_tree", (4.0, 4.0), girth_m=0.62, stems=2, number="001"),
    _feature("t2", "street_tree", (45.0, 4.0), species="=1+1"),
    _feature("s", "sign", (25.0, -3.2)),
    Feature(
        "doubted", "sign", Geometry.POINT, (Vertex((_EAST, _NORTH, 0.0)),),
        status=Status.CANDIDATE,
    ),
)  # fmt: skip


def _written(folder: Path, *features: Feature, notes: list[Text] | None = None) -> Any:
    request = ExportRequest(("xlsx",), folder)
    tell = [].append if notes is None else notes.append
    (path,) = export(features, _CATALOGUE, "EPSG:6677", request, tell=tell)
    assert path.name == NAME
    return openpyxl.load_workbook(path)


def _row(page: Any, number: int) -> dict[str, Any]:
    return {head.value: cell for head, cell in zip(page[1], page[number], strict=True)}


def test_numbers_are_numbers_with_the_decimals_of_csv_and_texts_are_texts(tmp_path: Path) -> None:
    page = _written(tmp_path, *_ROAD)["街路樹（並木）"]
    first, second = _row(page, 2), _row(page, 3)
    assert (first["幹周 [m]"].value, first["幹周 [m]"].number_format) == (0.62, "0.000")
    assert (first["幹の数"].value, first["幹の数"].number_format) == (2, "0")
    assert (first["東距(Y) [m]"].value, first["東距(Y) [m]"].number_format) == (-11390.608, "0.000")
    assert first["緯度 [°]"].number_format == "0.00000000"
    assert first["整理番号"].value == "001"
    assert (second["樹種"].value, second["樹種"].data_type) == ("=1+1", "s")
    assert second["樹高 [m]"].value is None
    assert page.freeze_panes == "A2"
    assert page.print_title_rows == "$1:$1"
    assert page.auto_filter.ref.startswith("A1:")
    assert page.page_setup.fitToWidth == 1
    assert page.print_options.gridLines
    assert page.sheet_properties.pageSetUpPr.fitToPage


def test_long_headers_have_the_lines_that_they_are_broken_into(tmp_path: Path) -> None:
    page = _written(tmp_path, *_ROAD)["街路樹（並木）"]
    height = page.row_dimensions[1].height
    for cell in page[1]:
        room = page.column_dimensions[cell.column_letter].width - 1.0
        letters = sum(2 if ord(one) > 0x2FFF else 1 for one in cell.value)
        assert math.ceil(letters / room) * 15.0 <= height
        if letters <= 8:
            assert letters <= room


def test_the_road_ledger_sheet_has_a_row_for_each_section_of_the_route(tmp_path: Path) -> None:
    book = _written(tmp_path, *_ROAD)
    assert book.sheetnames[0] == "道路台帳調書"
    page = book.worksheets[0]
    rows = [_row(page, number) for number in (2, 3, 4)]
    assert page.max_row == 4
    assert [one["測点（自）"].value for one in rows] == ["No.0+0.00", "No.1+0.00", "No.2+0.00"]
    assert [one["延長 [m]"].value for one in rows] == [20.0, 20.0, 10.0]
    first, second = rows[:2]
    told = {name: cell.value for name, cell in first.items()}
    assert (told["路線名"], told["路面種別"]) == ("市道1号線", "アスファルト")
    assert (told["車道（左） [m]"], told["車道（右） [m]"]) == (3.0, 3.5)
    assert (told["歩道（左） [m]"], told["歩道（右） [m]"]) == (2.0, 0.0)
    assert (told["道路部幅員 [m]"], told["道路部面積 [㎡]"]) == (8.5, 170.0)
    assert (told["縁石延長（左） [m]"], told["縁石延長（右） [m]"]) == (20.0, 0.0)
    assert [one["側溝延長（左） [m]"].value for one in rows] == [10.0, 10.0, 0.0]
    assert told["側溝種別（左）"] == "側溝（U字溝有蓋）"
    assert (told["防護柵延長（右） [m]"], told["街路樹（左）"]) == (20.0, 1)
    assert (second["標識（右）"].value, second["街路樹（左）"].value) == (1, 0)
    assert second["延長 [m]"].number_format == "0.00"


def test_candidates_have_no_row_and_an_empty_map_gives_an_empty_sheet(tmp_path: Path) -> None:
    assert _written(tmp_path / "a", *_ROAD)["標識"].max_row == 2
    assert _written(tmp_path / "b").sheetnames == ["台帳"]


def test_control_characters_are_replaced_and_told(tmp_path: Path) -> None:
    notes: list[Text] = []
    tree = _feature("t", "street_tree", (1.0, 1.0), species="a\x07b")
    book = _written(tmp_path, tree, notes=notes)
    assert _row(book.worksheets[0], 2)["樹種"].value == "a\ufffdb"
    assert len(notes) == 1


def test_without_lines_to_measure_to_widths_stay_empty(tmp_path: Path) -> None:
    page = _written(tmp_path, _ROAD[0]).worksheets[0]
    told = _row(page, 2)
    assert told["車道（左） [m]"].value is None
    assert told["道路部面積 [㎡]"].value is None
    assert told["延長 [m]"].value == pytest.approx(20.0)
