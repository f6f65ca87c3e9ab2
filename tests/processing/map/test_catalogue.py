"""The bundled catalogue holds what a road ledger needs; an office's own is read word for word."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from processing.map.catalogue import LINE_TYPES, Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from resources import path_of

# Class codes of chapter 2 of the extended DM that were checked against the standard's own list.
_CODES = {
    "road_edge": "2101",
    "sidewalk": "2213",
    "curb_upper": "2213",
    "median": "2226",
    "gutter_open": "2231",
    "gutter_covered": "2232",
    "gutter_l": "2233",
    "street_tree": "2238",
    "sign_guide": "2242",
    "sign_warning": "2243",
    "sign_regulation": "2244",
    "mirror": "2253",
    "road_center": "2505",
    "building_solid": "3002",
    "manhole": "4101",
    "manhole_water": "4161",
    "power_pole": "4142",
    "tree_conifer": "4222",
    "street_light": "4237",
    "slope_top": "6101",
    "guard_rail": "6132",
    "hedge": "6136",
    "wall": "6140",
    "road_area": "6522",
    "spot_height": "7312",
}

# All road codes of the standard at level 500 with the shapes it draws them in: point, line, area.
# A circle (E3) is drawn as an area, a direction (E6) and a note (E7) as a point.
_SHAPES_OF_CODES = {
    "2101 2103 2213 2214 2227 2231 2232 2233 2234 2237 2219": "l",
    "2203 2226": "la",
    "2211 2212 2222 2235 2236": "a",
    "2221 2238 2239 2241 2242 2243 2244 2246 2247 2253 2255 2256 2262": "p",
    "2261 4101 4111 4121 4131 4141 4151 4161": "pa",
    "2505": "l",
    "3001 3002 3003 3004": "a",
    "4119 4132 4142 4211 4215 4216 4221 4222 4237 4238": "p",
    "6101 6110 6111 6112 6113 6131 6132 6133 6134 6136 6140 6141 6142 6201 6301 6522": "l",
    "1104 1106 1107 7101 7102": "l",
    "7304 7305 7306 7311 7312 8114 8115 8116 8121 8122 8125 8126 8173 8181": "p",
}
# What the ledgers of trees, signs and fixtures ask of each.
_LEDGERS = {
    "street_tree planting tree_broadleaf tree_conifer": (
        "number route species tree_class height_m crown_m girth_m survey_date note"
    ),
    "sign sign_guide sign_warning sign_regulation info_board": (
        "number route station bound side sign_class sign_number shape size_m plates height_m post"
        " facing_deg photo installed keeper"
    ),
    "street_light security_light": "type lamps height_m number route keeper",
    "guard_rail guard_pipe guard_cable": "start_station end_station length_m number route",
    "manhole manhole_area manhole_water manhole_water_area": "number route diameter_m keeper",
    "pole wired_pole phone_pole power_pole": "number type height_m wires_deg keeper",
    "road_center": "number route name",
    "width_line": "width_m side",
}
_NO_CODE = {
    "curb_lower",
    "sign",
    "pole",
    "gutter_grating",
    "marking_line",
    "crosswalk",
    "building_corner",
}

_SMALL = """
[attribute.height_m]
ja = "高さ"
en = "Height"
type = "number"
unit = "m"

[attribute.side]
ja = "左右"
en = "Side"
type = "choice"
choices = { left = { en = "Left", ja = "左" }, right = { en = "Right", ja = "右" } }

[[kind]]
id = "post"
ja = "柱〜①"
en = "Post"
geometry = "point"
layer = "9999_柱"
colour = "#D55E00"
aci = 30
attributes = ["height_m", "side"]
key = "4"
"""


@pytest.fixture
def bundled() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


@pytest.mark.parametrize(("kind", "code"), _CODES.items())
def test_a_kind_of_the_standard_has_its_code_in_its_layer(
    bundled: Catalogue, kind: str, code: str
) -> None:
    assert bundled[kind].dm_code == code
    assert bundled[kind].layer.startswith(f"{code}_")


@pytest.mark.parametrize(("codes", "shapes"), _SHAPES_OF_CODES.items())
def test_every_road_code_of_the_standard_can_be_drawn_in_each_of_its_shapes(
    bundled: Catalogue, codes: str, shapes: str
) -> None:
    names = {"p": Geometry.POINT, "l": Geometry.LINE, "a": Geometry.AREA}
    drawn = {(kind.dm_code, kind.geometry) for kind in bundled}
    assert not {(code, names[one]) for code in codes.split() for one in shapes} - drawn


@pytest.mark.parametrize(("kinds", "attributes"), _LEDGERS.items())
def test_a_kind_of_a_ledger_has_what_its_table_asks(
    bundled: Catalogue, kinds: str, attributes: str
) -> None:
    for kind in kinds.split():
        said = {one.id for one in bundled[kind].attributes}
        assert set(attributes.split()) <= said


def test_every_point_kind_has_a_symbol_of_lines_and_circles_within_its_frame(
    bundled: Catalogue,
) -> None:
    for kind in bundled:
        if kind.geometry is not Geometry.POINT:
            continue
        # The file comes with the program.
        root = ET.parse(path_of(f"symbols/{kind.symbol}.svg")).getroot()  # noqa: S314
        assert root.get("viewBox") == "-1 -1 2 2"
        tags = {shape.tag.rpartition("}")[2] for shape in root}
        assert tags <= {"title", "circle", "line", "polyline", "polygon"}
        assert len(tags) > 1


def test_kinds_of_one_layer_share_their_code(bundled: Catalogue) -> None:
    for kind in bundled:
        assert {one.dm_code for one in bundled.of_layer(kind.layer)} == {kind.dm_code}


def test_a_kind_that_the_standard_lacks_has_no_invented_code(bundled: Catalogue) -> None:
    assert {kind.id for kind in bundled if not kind.dm_code} >= _NO_CODE
    assert not any(re.match("[0-9]", kind.layer) for kind in bundled if not kind.dm_code)


def test_ten_number_keys_choose_the_kinds_drawn_most(bundled: Catalogue) -> None:
    keys = {key: kind.id for key in "1234567890" if (kind := bundled.of_key(key))}
    assert keys == {
        "1": "curb_lower",
        "2": "curb_upper",
        "3": "road_edge",
        "4": "gutter_covered",
        "5": "street_tree",
        "6": "sign",
        "7": "pole",
        "8": "street_light",
        "9": "manhole",
        "0": "marking_line",
    }
    assert bundled.of_key("") is None


def test_every_kind_is_complete(bundled: Catalogue) -> None:
    for kind in bundled.kinds:
        assert kind.name.ja
        assert kind.name.en
        assert re.fullmatch("#[0-9a-f]{6}", kind.colour)
        assert kind.line_type in LINE_TYPES
        assert (kind.geometry is Geometry.POINT) or not kind.symbol
        if kind.symbol:
            assert path_of(f"symbols/{kind.symbol}.svg").is_file()


def test_every_colour_stands_out_from_dark_points(bundled: Catalogue) -> None:
    for kind in bundled:
        red, green, blue = (int(kind.colour[at : at + 2], 16) for at in (1, 3, 5))
        assert 0.2126 * red + 0.7152 * green + 0.0722 * blue > 85, kind.id


def test_attributes_with_a_unit_say_it_in_their_name_too(bundled: Catalogue) -> None:
    endings = {"m": "_m", "°": "_deg"}
    for kind in bundled:
        for attribute in kind.attributes:
            assert attribute.id.endswith(endings.get(attribute.unit, ""))


def test_the_kinds_of_the_extraction_tools_have_the_attributes_of_the_contract(
    bundled: Catalogue,
) -> None:
    named = {
        "curb_lower": {"edge", "run", "type", "height_m"},
        "gutter_lid": {"type", "width_m", "length_m", "run"},
        "street_tree": {"girth_m", "dbh_m", "height_m", "crown_m", "stems"},
        "sign": {"shape", "size_m", "facing_deg", "height_m"},
        "pole": {"height_m", "diameter_m", "type", "lean_deg"},
        "wire": {"sag_m", "clearance_m"},
    }
    for kind, attributes in named.items():
        assert attributes <= {one.id for one in bundled[kind].attributes}


def test_a_kind_is_found_by_id_and_by_layer(bundled: Catalogue) -> None:
    assert "road_edge" in bundled
    assert "nothing" not in bundled
    assert len(bundled) == len(tuple(bundled))
    assert [kind.id for kind in bundled.of_layer("6101_人工斜面")] == ["slope_top", "slope_foot"]
    with pytest.raises(KeyError):
        bundled["nothing"]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp932", "utf-16"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_an_offices_catalogue_is_read_in_the_encodings_of_offices(
    tmp_path: Path, encoding: str, end: str
) -> None:
    path = tmp_path / "種別.toml"
    path.write_bytes(_SMALL.replace("〜", "～").replace("\n", end).encode(encoding))
    kind = read_catalogue(path)["post"]
    assert (kind.name.ja, kind.layer, kind.aci, kind.key) == ("柱～①", "9999_柱", 30, "4")
    assert kind.colour == "#d55e00"
    assert kind.line_type == "continuous"
    side = kind.attribute("side")
    assert side is not None
    assert side.choices == ("left", "right")
    assert side.name_of_choice("left").ja == "左"
    assert side.name_of_choice("其他").en == "其他"
    assert kind.attribute("none") is None


def test_the_example_of_the_manual_is_a_catalogue(tmp_path: Path) -> None:
    manual = Path(__file__).parents[3] / "docs" / "catalogue.md"
    example = manual.read_text(encoding="utf-8").split("```toml\n")[1].split("```")[0]
    path = tmp_path / "example.toml"
    path.write_text(example, encoding="utf-8")
    (kind,) = read_catalogue(path)
    assert [one.id for one in kind.attributes] == ["height_m", "side"]
