"""Ledgers open in a spreadsheet: right digits, right text, nothing taken for a formula."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import OutOfRange
from processing.formats.ledgers.ledger_columns import TableStyle, guard_text
from processing.formats.ledgers.ledger_csv import write_features, write_ledger, write_vertices
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, PointReference, Position, Vertex
from resources import path_of

_IDS = TableStyle(language=None)
_FOOT = (-11394.608, -35139.915, 25.682)


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _feature(
    id_: str, kind: str, geometry: Geometry, *positions: Position, **attributes: object
) -> Feature:
    vertices = tuple(Vertex(position) for position in positions)
    return Feature(id_, kind, geometry, vertices, attributes)  # type: ignore[arg-type]


def _tree(**attributes: object) -> Feature:
    return _feature("t1", "street_tree", Geometry.POINT, _FOOT, **attributes)


def _rows(path: Path, encoding: str = "utf-8-sig") -> list[dict[str, str]]:
    with path.open(encoding=encoding, newline="") as file:
        return list(csv.DictReader(file, strict=True))


def test_a_tree_ledger_has_its_attributes_and_its_place_in_japanese(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    path = tmp_path / "街路樹.csv"
    tree = _tree(species="欅", girth_m=0.62, stems=2, tree_class="tall", number="001")
    write_ledger(path, [tree], catalogue["street_tree"], TableStyle(crs="EPSG:6677"))
    (row,) = _rows(path)
    assert row["樹種"] == "欅"
    assert row["整理番号"] == "001"
    assert row["幹周 [m]"] == "0.620"
    assert row["幹の数"] == "2"
    assert row["区分"] == "高木"
    assert row["樹高 [m]"] == ""
    assert row["東距(Y) [m]"] == "-11394.608"
    assert row["北距(X) [m]"] == "-35139.915"
    assert row["標高(H) [m]"] == "25.682"
    assert row["座標参照系"] == "EPSG:6677"
    assert row["状態"] == "採用"


def test_latitude_and_longitude_are_those_of_the_projection(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    path = tmp_path / "a.csv"
    origin = _feature("o", "street_tree", Geometry.POINT, (0.0, 0.0, 1.0))  # 36° N, 139°50' E
    write_ledger(path, [origin], catalogue["street_tree"], TableStyle("en", crs="EPSG:6677"))
    (row,) = _rows(path)
    assert row["Latitude [°]"] == "36.00000000"
    assert row["Longitude [°]"] == "139.83333333"


def test_an_unknown_reference_system_is_said_and_gives_no_latitude(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    path = tmp_path / "a.csv"
    write_ledger(path, [_tree()], catalogue["street_tree"], TableStyle("ja"))
    (row,) = _rows(path)
    assert row["座標参照系"] == "不明"
    assert "緯度 [°]" not in row


def test_lines_and_areas_state_their_measures(tmp_path: Path, catalogue: Catalogue) -> None:
    x, y = 1_000_000.0, -3_000_000.0  # far from the origin, where products lose digits
    line = _feature("l", "guard_rail", Geometry.LINE, (x, y, 0.0), (x + 3, y + 4, 12.0))
    ring = ((x, y, 1.0), (x + 0.5, y, 1.0), (x + 0.5, y + 0.4, 1.0), (x, y + 0.4, 1.0))
    area = _feature("a", "gutter_lid", Geometry.AREA, *ring)
    path = tmp_path / "a.csv"
    write_features(path, [line, area, _tree()], catalogue, _IDS)
    rows = _rows(path)
    assert [row["plan_length_m"] for row in rows] == ["5.000", "", ""]
    assert [row["slope_length_m"] for row in rows] == ["13.000", "", ""]
    assert [row["plan_area_m2"] for row in rows] == ["", "0.200", ""]
    assert [row["vertices"] for row in rows] == ["2", "4", "1"]
    assert [row["end_easting_m"] for row in rows] == ["1000003.000", "", ""]
    assert [row["easting_m"] for row in rows] == ["1000000.000", "1000000.000", "-11394.608"]
    assert [row["dm_code"] for row in rows] == ["6132", "", "2238"]


def test_the_vertex_table_keeps_the_order_and_the_measured_points(tmp_path: Path) -> None:
    vertices = (
        Vertex((1.0005, 2.0, -0.0001), PointReference("left", 12345)),
        Vertex((1.5, 2.5, 3.5)),
    )
    path = tmp_path / "v.csv"
    write_vertices(path, [Feature("f", "road_edge", Geometry.LINE, vertices)], _IDS)
    rows = _rows(path)
    assert [row["number"] for row in rows] == ["1", "2"]
    assert [row["point"] for row in rows] == ["12345", ""]
    assert rows[0]["drive"] == "left"
    assert rows[0]["elevation_m"] == "0.000"
    assert rows[1]["easting_m"] == "1.500"


def test_lines_end_as_spreadsheets_expect_and_utf8_has_its_mark(tmp_path: Path) -> None:
    path = tmp_path / "v.csv"
    write_vertices(path, [_tree()], TableStyle())
    data = path.read_bytes()
    assert data.startswith(b"\xef\xbb\xbf")
    assert data.count(b"\r\n") == data.count(b"\n") == 2


def test_cp932_is_written_and_a_character_it_lacks_is_named(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    path = tmp_path / "a.csv"
    style = TableStyle(encoding="cp932", crs="EPSG:6677")
    kind = catalogue["street_tree"]
    write_ledger(path, [_tree(species="①髙﨑〜−")], kind, style)
    assert _rows(path, "cp932")[0]["樹種"] == "①髙﨑～－"
    before = path.read_bytes()
    with pytest.raises(OutOfRange) as refusal:
        write_ledger(path, [_tree(species="𠮷")], kind, style)
    assert "𠮷" in refusal.value.what.ja
    assert "U+20BB7" in refusal.value.what.en
    assert refusal.value.where.ja == "地物 t1、樹種"
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("language", ["ja", "en", None])
@pytest.mark.parametrize("encoding", ["utf-8", "cp932"])
def test_every_header_of_the_catalogue_can_be_written(
    tmp_path: Path, catalogue: Catalogue, language: str | None, encoding: str
) -> None:
    style = TableStyle(language, encoding, crs="EPSG:6677")  # type: ignore[arg-type]
    shapes = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}
    for kind in catalogue:
        positions = [_FOOT] * shapes[kind.geometry]
        path = tmp_path / f"{kind.id}.csv"
        write_ledger(path, [_feature("f", kind.id, kind.geometry, *positions)], kind, style)
        assert len(_rows(path, "cp932" if encoding == "cp932" else "utf-8-sig")) == 1


@pytest.mark.parametrize("text", ["=1+1", "+81 3", "-", "@SUM(A1)", "\tx", "＝1", "'", "'=1"])
def test_text_that_a_spreadsheet_would_compute_is_quoted(
    tmp_path: Path, catalogue: Catalogue, text: str
) -> None:
    path = tmp_path / "a.csv"
    write_features(path, [_tree(note=text)], catalogue, _IDS)
    assert _rows(path)[0]["note"] == f"'{text}"


def test_numbers_stay_numbers(tmp_path: Path, catalogue: Catalogue) -> None:
    path = tmp_path / "a.csv"
    write_features(path, [_tree(height_m=-1.5, count=-3, flag=True, big=1e300)], catalogue, _IDS)
    (row,) = _rows(path)
    assert row["height_m"] == "-1.500"
    assert (row["count"], row["flag"], row["big"]) == ("-3", "true", "1e+300")


@given(text=st.text())
def test_any_text_comes_back_from_utf8(
    tmp_path_factory: pytest.TempPathFactory, catalogue: Catalogue, text: str
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.csv"
    write_features(path, [_tree(note=text)], catalogue, _IDS)
    assert _plain(_rows(path)[0]["note"]) == text


@given(text=st.text(st.characters(codec="cp932", exclude_characters="¢£¬‖−〜")))
def test_any_text_of_shift_jis_comes_back_from_it(
    tmp_path_factory: pytest.TempPathFactory, catalogue: Catalogue, text: str
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.csv"
    style = TableStyle(None, "cp932")
    write_features(path, [_tree(note=text)], catalogue, style)
    assert _plain(_rows(path, "cp932")[0]["note"]) == text


@given(name=st.text(), other=st.text())
def test_any_attribute_names_are_columns_of_their_own(
    tmp_path_factory: pytest.TempPathFactory, catalogue: Catalogue, name: str, other: str
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.csv"
    write_features(path, [_tree(**{name: "1a", other: "2b"})], catalogue, _IDS)
    values = list(_rows(path)[0].values())
    assert [one for one in values if one in ("1a", "2b")] == (
        ["2b"] if name == other else ["1a", "2b"]
    )


@given(x=st.floats(-1e7, 1e7), digits=st.integers(0, 9))
def test_any_coordinate_is_written_to_its_last_digit(x: float, digits: int) -> None:
    words = TableStyle(digits=digits).number(x)
    assert abs(float(words) - x) <= 0.5000001 * 10.0**-digits
    assert not (words.startswith("-") and float(words) == 0)


@given(n=st.integers(-(10**10), 10**10))
def test_a_delivered_millimetre_comes_back_as_the_same_number(n: int) -> None:
    x = n * 0.001
    assert round(float(TableStyle().number(x)) * 1000) == n


def test_a_guard_is_taken_off_by_removing_one_apostrophe() -> None:
    assert guard_text("plain") == "plain"
    for text in ("\n=1+1", " =1", "\u200b=1", "\ufeff@x", "\u3000+1", "\t-1", "\x00=1", "\x1b=1"):
        assert guard_text(text) == "'" + text
    assert guard_text("=x")[1:] == "=x"


def _plain(cell: str) -> str:
    return cell[1:] if cell.startswith("'") else cell
