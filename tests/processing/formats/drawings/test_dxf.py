"""A DXF is read back by another program: same places, same texts, no error in its audit."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import pytest
from ezdxf.math import Vec3
from ezdxf.tools.text import caret_decode
from hypothesis import example, given, settings
from hypothesis import strategies as st

from processing.core.errors import Cancelled, OutOfRange, Unsuitable
from processing.formats.drawings.dxf import write_dxf
from processing.formats.drawings.dxf_document import APP_ID, DxfVersion
from processing.map.catalogue import LINE_TYPES, Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue, symbol_names
from processing.map.feature import Feature, Position, Status, Vertex
from resources import path_of
from tests.monitors import CancelledAfter
from tests.processing.formats.audited_dxf import audited_dxf

_VERSIONS: tuple[DxfVersion, ...] = ("R12", "R2000", "R2007", "R2018")
_FOOT = (-11394.608, -35139.915, 25.682)
_LINE = ((-11394.608, -35139.915, 25.682), (-11390.001, -35138.5, 25.7), (-11385.25, -35139.0, 26))


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _feature(
    kind: str,
    geometry: Geometry,
    *positions: Position,
    status: Status = Status.ACCEPTED,
    **own: Any,
) -> Feature:
    return Feature(f"id-{kind}", kind, geometry, tuple(map(Vertex, positions)), own, status)


def _tree(**own: Any) -> Feature:
    return _feature("street_tree", Geometry.POINT, _FOOT, **own)


def _only(doc: Any, query: str) -> Any:
    (entity,) = doc.modelspace().query(query)
    return entity


def _decoded(text: str) -> str:
    """What CAD programs make of escapes: carets first, then UTF-16 units."""
    units = re.sub(r"\\U\+([0-9A-F]{4})", lambda found: chr(int(found[1], 16)), caret_decode(text))
    return units.encode("utf-16", "surrogatepass").decode("utf-16", "surrogatepass")


def _attributes(entity: Any) -> dict[str, Any]:
    read: dict[str, Any] = {}
    inside: list[Any] = []
    for tag in list(entity.get_xdata(APP_ID))[4:]:
        if tag.value == "{" and tag.code == 1002:
            inside = []
        elif tag.value == "}" and tag.code == 1002:
            name, first, *rest = inside
            whole = _decoded(first + "".join(rest)) if isinstance(first, str) else first
            read[_decoded(name)] = whole
        else:
            inside.append(tag.value)
    return read


@pytest.mark.parametrize("version", _VERSIONS)
def test_a_line_is_a_3d_polyline_on_the_layer_of_its_code(
    tmp_path: Path, catalogue: Catalogue, version: DxfVersion
) -> None:
    line = _feature("road_edge", Geometry.LINE, *_LINE)
    doc = audited_dxf(tmp_path / "図.dxf", catalogue, line, version=version)
    entity = _only(doc, "POLYLINE")
    assert entity.is_3d_polyline
    assert not entity.is_closed
    assert [tuple(one.dxf.location) for one in entity.vertices] == list(_LINE)
    assert entity.dxf.layer == "2101_道路縁"
    assert doc.layers.get("2101_道路縁").color == catalogue["road_edge"].aci
    data = [tag.value for tag in entity.get_xdata(APP_ID)]
    assert data == ["id-road_edge", "road_edge", "accepted", 1.0, "hand"]


@pytest.mark.parametrize("version", _VERSIONS)
def test_a_drawing_in_plan_has_no_heights(
    tmp_path: Path, catalogue: Catalogue, version: DxfVersion
) -> None:
    features = [
        _feature("gutter_l", Geometry.LINE, *_LINE),
        _feature("gutter_lid", Geometry.AREA, *_LINE, thickness_m=0.1),
        _tree(number="7"),
    ]
    path = tmp_path / "plan.dxf"
    write_dxf(path, features, catalogue, version=version, is_flat=True)
    drawing = ezdxf.filemanagement.readfile(path)
    assert not drawing.audit().errors
    space = drawing.modelspace()
    assert not space.query("3DFACE")
    line, area = space.query("POLYLINE LWPOLYLINE")
    assert line.dxftype() == ("POLYLINE" if version == "R12" else "LWPOLYLINE")
    assert (line.is_closed, area.is_closed) == (False, True)
    is_light = line.dxftype() == "LWPOLYLINE"
    places = line.get_points("xy") if is_light else [one.dxf.location for one in line.vertices]
    assert [(one[0], one[1]) for one in places] == [one[:2] for one in _LINE]
    assert line.dxf.linetype == "BYLAYER"
    assert all(one.dxf.insert.z == 0.0 for one in space.query("INSERT TEXT"))


@pytest.mark.parametrize("version", _VERSIONS)
def test_an_area_is_closed_and_does_not_repeat_its_first_vertex(
    tmp_path: Path, catalogue: Catalogue, version: DxfVersion
) -> None:
    area = _feature("gutter_lid", Geometry.AREA, *_LINE)
    entity = _only(audited_dxf(tmp_path / "a.dxf", catalogue, area, version=version), "POLYLINE")
    assert entity.is_closed
    assert entity.is_3d_polyline
    assert len(entity.vertices) == 3


def test_a_symbol_stands_on_its_point_and_looks_where_its_sign_looks(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    sign = _feature("sign_regulation", Geometry.POINT, _FOOT, facing_deg=90.0)
    doc = audited_dxf(tmp_path / "a.dxf", catalogue, sign)
    # One thing is one entity: whoever counts symbols counts signs.
    (insert,) = doc.modelspace()
    assert tuple(insert.dxf.insert) == _FOOT
    # The plate is ahead of the foot: east of it when the sign faces east.
    circles = [one for one in insert.virtual_entities() if one.dxftype() == "CIRCLE"]
    plate = max(circles, key=lambda circle: circle.dxf.radius)
    ahead = plate.dxf.center - Vec3(_FOOT)
    assert ahead.x > 0.5
    assert abs(ahead.y) < 1e-9


@pytest.mark.parametrize("version", _VERSIONS)
def test_a_symbol_carries_what_is_known_about_its_feature(
    tmp_path: Path, catalogue: Catalogue, version: DxfVersion
) -> None:
    sign = _feature("sign", Geometry.POINT, _FOOT, number="12", shape="circle", size_m=0.6)
    path = tmp_path / "a.dxf"
    write_dxf(path, [sign], catalogue, version=version, language="ja")
    doc = ezdxf.filemanagement.readfile(path)
    insert = _only(doc, "INSERT")
    carried = {one.dxf.tag: one.dxf.text for one in insert.attribs}
    assert carried == {"NUMBER": "12", "SHAPE": "円形", "SIZE_M": "0.600"}
    assert all(one.is_invisible for one in insert.attribs)
    defined = {one.dxf.tag for one in doc.blocks.get(insert.dxf.name).query("ATTDEF")}
    assert set(carried) < defined
    assert doc.audit().errors == []


def test_a_direction_goes_before_a_facing_and_nonsense_turns_nothing(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    path = tmp_path / "a.dxf"
    both = _feature("sign", Geometry.POINT, _FOOT, direction_deg=30.0, facing_deg=90.0)
    assert _only(audited_dxf(path, catalogue, both), "INSERT").dxf.rotation == 330.0
    for nonsense in ("north", math.nan, None):
        lost = _feature("sign", Geometry.POINT, _FOOT, direction_deg=nonsense)
        assert _only(audited_dxf(path, catalogue, lost), "INSERT").dxf.rotation == 0.0


@pytest.mark.parametrize("version", _VERSIONS)
def test_every_kind_of_the_catalogue_is_drawn_without_an_error(
    tmp_path: Path, catalogue: Catalogue, version: DxfVersion
) -> None:
    shapes = {Geometry.POINT: _LINE[:1], Geometry.LINE: _LINE[:2], Geometry.AREA: _LINE}
    features = [
        _feature(kind.id, kind.geometry, *shapes[kind.geometry], number="1") for kind in catalogue
    ]
    doc = audited_dxf(tmp_path / "a.dxf", catalogue, *features, version=version)
    versions = {"R12": "AC1009", "R2000": "AC1015", "R2007": "AC1021", "R2018": "AC1032"}
    assert doc.dxfversion == versions[version]
    assert doc.header["$DWGCODEPAGE"] == "ANSI_932"
    assert version == "R12" or doc.header["$INSUNITS"] == 6  # R12 carries no units
    for kind in catalogue:
        layer = doc.layers.get(kind.layer)
        first = catalogue.of_layer(kind.layer)[0]
        assert layer.color == first.aci
        assert layer.dxf.linetype.lower() == first.line_type
        if version == "R2018":
            assert layer.rgb == tuple(int(first.colour[at : at + 2], 16) for at in (1, 3, 5))
    assert doc.styles.get("JAPANESE").dxf.font == "msgothic.ttc"


def test_kinds_that_share_a_layer_keep_their_own_line_types(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    features = [_feature(kind, Geometry.LINE, *_LINE) for kind in ("slope_foot", "slope_top")]
    foot, top = audited_dxf(tmp_path / "a.dxf", catalogue, *features).modelspace().query("POLYLINE")
    assert foot.dxf.layer == top.dxf.layer == "6101_人工斜面"
    assert (foot.dxf.linetype, top.dxf.linetype) == ("SHORT_DASHED", "BYLAYER")


def test_line_types_are_metres_on_the_ground(tmp_path: Path, catalogue: Catalogue) -> None:
    doc = audited_dxf(tmp_path / "a.dxf", catalogue, _tree())
    for name, pattern in LINE_TYPES.items():
        if pattern:
            tags = doc.linetypes.get(name.upper()).pattern_tags.tags
            assert [tag.value for tag in tags if tag.code == 49] == list(pattern)
    assert doc.header["$LTSCALE"] == 1.0


@pytest.mark.parametrize("symbol", symbol_names())
def test_every_symbol_is_drawn_about_its_point_in_a_readable_size(
    tmp_path: Path, catalogue: Catalogue, symbol: str
) -> None:
    from ezdxf import bbox

    kind = next(kind for kind in catalogue if kind.symbol == symbol)
    feature = _feature(kind.id, Geometry.POINT, (0.0, 0.0, 0.0))
    insert = _only(audited_dxf(tmp_path / "a.dxf", catalogue, feature), "INSERT")
    extent = bbox.extents(insert.virtual_entities())
    assert 0.15 < max(extent.size.x, extent.size.y) <= 2.0
    assert extent.extmin.magnitude < 1.5


def test_the_drawing_says_its_extent_and_its_reference_system(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    doc = audited_dxf(tmp_path / "a.dxf", catalogue, _feature("road_edge", Geometry.LINE, *_LINE))
    assert tuple(doc.header["$EXTMIN"]) == (-11394.608, -35139.915, 25.682)
    assert tuple(doc.header["$EXTMAX"]) == (-11385.25, -35138.5, 26.0)
    assert doc.header.custom_vars.properties == [("CRS", "EPSG:6677")]
    write_dxf(tmp_path / "b.dxf", [_tree()], catalogue)
    unknown = ezdxf.filemanagement.readfile(tmp_path / "b.dxf")
    for one, named in ((doc, "EPSG:6677"), (unknown, "unknown")):
        assert [tag.value for tag in one.layers.get("0").get_xdata(APP_ID)] == ["CRS", named]
    assert unknown.header.custom_vars.properties == [("CRS", "unknown")]


def test_candidates_have_layers_of_their_own_and_rejected_ones_are_left_out(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    features = [
        _feature("road_edge", Geometry.LINE, *_LINE, status=status, number=status.value)
        for status in Status
    ]
    doc = audited_dxf(tmp_path / "a.dxf", catalogue, *features)
    layers = {entity.dxf.layer for entity in doc.modelspace()}
    assert layers == {
        "2101_道路縁",
        "2101_道路縁_文字",
        "2101_道路縁_候補",
        "2101_道路縁_候補_文字",
    }


def test_names_and_heights_are_written_beside_their_feature(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    height = _feature("spot_height", Geometry.POINT, (1.0, 2.0, 25.678))
    doc = audited_dxf(tmp_path / "a.dxf", catalogue, _tree(name="欅\n並木", number="7"), height)
    texts = {text.dxf.text: text for text in doc.modelspace().query("TEXT")}
    assert set(texts) == {"欅 並木", "25.7"}
    assert all(text.dxf.style == "JAPANESE" for text in texts.values())
    assert texts["欅 並木"].dxf.layer == "2238_並木_文字"
    assert texts["欅 並木"].dxf.align_point.x > _FOOT[0]


def test_a_lines_name_lies_above_its_middle_and_is_never_upside_down(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    west = _feature("road_center", Geometry.LINE, (20.0, 0.0, 5.0), (0.0, 0.0, 5.0), name="市道")
    text = _only(audited_dxf(tmp_path / "a.dxf", catalogue, west), "TEXT")
    assert text.dxf.rotation == pytest.approx(0.0)
    assert text.dxf.align_point.isclose((10.0, 0.4, 5.0))


def test_an_areas_name_is_in_its_middle(tmp_path: Path, catalogue: Catalogue) -> None:
    corners = ((0.0, 0.0, 1.0), (9.0, 0.0, 1.0), (9.0, 6.0, 1.0), (0.0, 6.0, 1.0))
    house = _feature("building", Geometry.AREA, *corners, name="市役所")
    text = _only(audited_dxf(tmp_path / "a.dxf", catalogue, house), "TEXT")
    assert text.dxf.align_point.isclose((4.5, 3.0, 1.0))


def test_a_label_never_becomes_a_control_code(tmp_path: Path, catalogue: Catalogue) -> None:
    path = tmp_path / "a.dxf"
    assert _only(audited_dxf(path, catalogue, _tree(name="5%%d %%u")), "TEXT").plain_text() == (
        "5％％d ％％u"
    )


def test_signs_whose_twin_shift_jis_has_are_drawn_as_the_twin(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    for version, drawn in (("R2000", "3～5－￠"), ("R2018", "3〜5−¢")):
        doc = audited_dxf(tmp_path / "a.dxf", catalogue, _tree(name="3〜5−¢"), version=version)
        assert _only(doc, "TEXT").plain_text() == drawn
        assert _attributes(_only(doc, "INSERT"))["name"] == "3〜5−¢"


def test_r2000_is_bytes_of_shift_jis_and_what_it_lacks_is_escaped(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    path = tmp_path / "a.dxf"
    write_dxf(path, [_tree(name="表①é𠮷")], catalogue, version="R2000", encoding="utf-8")
    data = path.read_bytes()
    assert "表①".encode("cp932") + rb"\U+00E9\U+D842\U+DFB7" in data
    data.decode("cp932")


def test_the_same_map_has_the_same_extended_data_in_both_versions(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    tree = _tree(species="欅", girth_m=0.1 + 0.2, stems=3, alive=True, big=1 << 40, nothing=None)
    for version in _VERSIONS:
        insert = _only(audited_dxf(tmp_path / "a.dxf", catalogue, tree, version=version), "INSERT")
        assert _attributes(insert) == {
            "species": "欅",
            "girth_m": 0.1 + 0.2,
            "stems": 3,
            "alive": 1,
            "big": str(1 << 40),
        }


def test_an_unknown_kind_is_refused_and_named(tmp_path: Path, catalogue: Catalogue) -> None:
    with pytest.raises(Unsuitable) as refusal:
        write_dxf(tmp_path / "a.dxf", [_feature("未知", Geometry.POINT, _FOOT)], catalogue)
    assert "id-未知" in refusal.value.where.ja
    assert list(tmp_path.iterdir()) == []


def test_attributes_too_long_for_an_entity_are_refused(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    with pytest.raises(Unsuitable):
        write_dxf(tmp_path / "a.dxf", [_tree(note="長" * 6000)], catalogue)
    assert list(tmp_path.iterdir()) == []


def test_a_version_that_there_is_not_is_refused(tmp_path: Path, catalogue: Catalogue) -> None:
    with pytest.raises(OutOfRange):
        write_dxf(tmp_path / "a.dxf", [], catalogue, version="R1999")  # type: ignore[arg-type]


def test_a_drawing_can_be_stopped_while_it_is_written(tmp_path: Path, catalogue: Catalogue) -> None:
    line = _feature("road_edge", Geometry.LINE, *(_LINE * 600))
    with pytest.raises(Cancelled):
        write_dxf(tmp_path / "a.dxf", [line], catalogue, monitor=CancelledAfter(2))
    assert list(tmp_path.iterdir()) == []


def test_lines_end_as_on_windows(tmp_path: Path, catalogue: Catalogue) -> None:
    write_dxf(tmp_path / "a.dxf", [_tree()], catalogue)
    data = (tmp_path / "a.dxf").read_bytes()
    assert data.count(b"\r\n") == data.count(b"\n") == data.count(b"\r")


def test_an_empty_map_is_a_valid_drawing(tmp_path: Path, catalogue: Catalogue) -> None:
    assert len(audited_dxf(tmp_path / "a.dxf", catalogue).modelspace()) == 0


def test_a_layer_that_shift_jis_lacks_is_refused_for_r2000_only(tmp_path: Path) -> None:
    path = tmp_path / "office.toml"
    path.write_text(
        '[[kind]]\nid = "post"\nja = "柱"\nen = "Post"\ngeometry = "point"\n'
        'layer = "기둥"\ncolour = "#d55e00"\naci = 30\n',
        encoding="utf-8",
    )
    office = read_catalogue(path)
    post = _feature("post", Geometry.POINT, _FOOT)
    assert _only(audited_dxf(tmp_path / "a.dxf", office, post), "POINT").dxf.layer == "기둥"
    with pytest.raises(Unsuitable):
        write_dxf(tmp_path / "b.dxf", [post], office, version="R2000")


_METRES = st.floats(-1e7, 1e7)


@settings(max_examples=30)
@given(
    positions=st.lists(st.tuples(_METRES, _METRES, _METRES), min_size=2, max_size=5),
    version=st.sampled_from(_VERSIONS),
)
def test_any_coordinate_is_kept_to_the_last_bit(
    tmp_path_factory: pytest.TempPathFactory,
    catalogue: Catalogue,
    positions: list[Position],
    version: DxfVersion,
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.dxf"
    line = _feature("road_edge", Geometry.LINE, *positions)
    entity = _only(audited_dxf(path, catalogue, line, version=version), "POLYLINE")
    assert [tuple(one.dxf.location) for one in entity.vertices] == positions


@settings(max_examples=60)
@example(text="3〜5 −¢", version="R2000")  # cp932 has bytes for them that read as other signs
@given(
    text=st.one_of(st.text(), st.text("\\U+M0041^%{} \n\r表é𠮷", max_size=30)),
    version=st.sampled_from(_VERSIONS),
)
def test_any_text_comes_back(
    tmp_path_factory: pytest.TempPathFactory,
    catalogue: Catalogue,
    text: str,
    version: DxfVersion,
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.dxf"
    tree = _tree(note=text, name=text)
    doc = audited_dxf(path, catalogue, tree, version=version)
    assert _attributes(_only(doc, "INSERT"))["note"] == text


def test_a_long_text_is_cut_between_characters_and_comes_back(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    text = "長い説明𠮷" * 200
    for version in _VERSIONS:
        point = _only(
            audited_dxf(tmp_path / "a.dxf", catalogue, _tree(note=text), version=version), "INSERT"
        )
        assert _attributes(point)["note"] == text
        for tag in point.get_xdata(APP_ID):
            assert len(str(tag.value).encode("utf-8")) <= 400
