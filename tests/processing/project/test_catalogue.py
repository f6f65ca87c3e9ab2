"""The bundled catalogue holds what a road ledger needs; an office's own is read word for word."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from processing.project.catalogue import LINE_TYPES, Catalogue, Geometry, read_catalogue
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
_NO_CODE = {"curb_lower", "sign", "pole", "marking_line", "crosswalk", "building_corner"}

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
        "pole": {"height_m", "diameter_m", "type"},
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
