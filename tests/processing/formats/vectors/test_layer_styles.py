"""QGIS finds a style for each layer of a map that is handed in; other readers see the same map."""

from __future__ import annotations

import base64
import sqlite3
from contextlib import closing
from pathlib import Path

import pyogrio
import pytest
from lxml import etree

from processing.formats.vectors.boundary_files import areas_of_geopackage
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.map.catalogue import LINE_TYPES, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Status, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of

_CATALOGUE = read_catalogue(path_of("catalogue/level500.toml"))
_XY = ((0.0, 0.0), (4.0, 0.0), (4.0, 3.0))


def _feature(kind: str, **own: float | str) -> Feature:
    shape = _CATALOGUE[kind].geometry
    count = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}[shape]
    vertices = tuple(Vertex((x, y, 1.0)) for x, y in _XY[:count])
    return Feature(f"a {kind}", kind, shape, vertices, own)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    features = (
        _feature("gutter_l"), _feature("rain_inlet"), _feature("sign_guide", facing_deg=90.0)
    )  # fmt: skip
    (path,) = export(features, _CATALOGUE, "EPSG:6677", ExportRequest(("gpkg",), tmp_path))
    return path


def _styles(path: Path) -> dict[str, tuple[str, etree._Element]]:
    query = "SELECT f_table_name, styleName, styleQML, useAsDefault, f_geometry_column"
    with closing(sqlite3.connect(path)) as database:
        rows = database.execute(f"{query} FROM layer_styles").fetchall()
        shapes = dict(
            database.execute("SELECT table_name, column_name FROM gpkg_geometry_columns").fetchall()
        )
    assert all(default == 1 and column == shapes[table] for table, _, _, default, column in rows)
    return {table: (name, etree.fromstring(qml)) for table, name, qml, _, _ in rows}


def _options(style: etree._Element, symbol: str = "0") -> dict[str, str]:
    layer = style.find(f"renderer-v2/symbols/symbol[@name='{symbol}']/layer")
    assert layer is not None
    return {one.attrib["k"]: one.attrib["v"] for one in layer.findall("prop")}


def test_each_layer_has_the_look_of_its_kind(path: Path) -> None:
    styles = _styles(path)
    assert {name for name, _ in pyogrio.list_layers(path)} == {*styles, "layer_styles"}
    name, line = styles["gutter_l"]
    assert name == "側溝（L字溝）"
    dashes = [float(one) / 2 for one in _options(line)["customdash"].split(";")]
    assert dashes == pytest.approx([abs(one) for one in LINE_TYPES["gutter_dashed"]])
    colour = _CATALOGUE["gutter_l"].colour
    rgb = ",".join(str(int(colour[at : at + 2], 16)) for at in (1, 3, 5))
    assert _options(line)["line_color"] == f"{rgb},255"
    _, area = styles["rain_inlet"]
    assert _options(area)["outline_width"] == "0.15"
    _, sign = styles["sign_guide"]
    svg = base64.b64decode(_options(sign)["name"].removeprefix("base64:")).decode()
    assert _CATALOGUE["sign_guide"].colour in svg
    etree.fromstring(svg)
    expression = sign.find(".//Option[@name='expression']")
    assert expression is not None
    assert expression.attrib["value"] == 'coalesce("facing_deg",0)'
    names = {one.attrib["field"]: one.attrib["name"] for one in sign.iter("alias")}
    assert names["height_m"].endswith(" [m]")
    assert names["status"] == "状態"


def test_candidates_are_paler_than_what_was_accepted(path: Path) -> None:
    _, style = _styles(path)["gutter_l"]
    categories = {
        one.attrib["value"]: one.attrib["symbol"]
        for one in style.iterfind("renderer-v2/categories/category")
    }
    assert set(categories) == {Status.ACCEPTED.value, Status.CANDIDATE.value}
    alphas = {
        one.attrib["name"]: float(one.attrib["alpha"])
        for one in style.iterfind("renderer-v2/symbols/symbol")
    }
    assert alphas[categories["candidate"]] < alphas[categories["accepted"]] == 1.0


def test_the_map_reads_back_as_before(path: Path) -> None:
    mapped = read_mapped(path)
    assert len(mapped.features) == 3
    assert mapped.crs == "EPSG:6677"
    areas, crs = areas_of_geopackage(path, "")
    assert (len(areas), crs) == (1, "EPSG:6677")


def test_a_map_without_features_has_no_style(tmp_path: Path) -> None:
    (path,) = export((), _CATALOGUE, "EPSG:6677", ExportRequest(("gpkg",), tmp_path))
    assert _styles(path) == {}
