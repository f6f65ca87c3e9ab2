"""A GeoPackage has a layer for each kind, which a GIS library reads back bit for bit."""

from __future__ import annotations

import resource
from pathlib import Path
from typing import Any

import numpy as np
import pyogrio
import pytest
import shapely
from hypothesis import example, given, settings
from hypothesis import strategies as st

from processing.core.errors import NoSpace, UserError
from processing.formats.vectors.geopackage import write_geopackage
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Position, Vertex
from resources import path_of

_SHAPE = ((0.1, 0.2, 10.123), (8.7, 0.3, 10.5), (8.6, 5.1, 11.25))


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _feature(id_: str, kind: str, geometry: Geometry, **attributes: object) -> Feature:
    positions = _SHAPE[:1] if geometry is Geometry.POINT else _SHAPE
    return _placed(id_, kind, geometry, positions, **attributes)


def _placed(
    id_: str,
    kind: str,
    geometry: Geometry,
    positions: tuple[Position, ...],
    /,
    **attributes: object,
) -> Feature:
    vertices = tuple(Vertex(position) for position in positions)
    return Feature(id_, kind, geometry, vertices, attributes)  # type: ignore[arg-type]


def _layer(path: Path, name: str) -> tuple[Any, dict[str, list[Any]]]:
    told, _, shapes, values = pyogrio.raw.read(path, layer=name)
    columns = {key: column.tolist() for key, column in zip(told["fields"], values, strict=True)}
    return shapely.from_wkb(shapes), columns


def test_each_kind_is_a_layer_with_its_shape_and_system(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    path = tmp_path / "地図.gpkg"
    features = [
        _feature("a", "road_edge", Geometry.LINE),
        _feature("b", "street_tree", Geometry.POINT),
        _feature("c", "gutter_lid", Geometry.AREA),
        _feature("d", "road_edge", Geometry.AREA),
    ]
    write_geopackage(path, features, catalogue, crs="EPSG:6677")
    assert dict(pyogrio.list_layers(path).tolist()) == {
        "road_edge": "LineString Z",
        "street_tree": "Point Z",
        "gutter_lid": "Polygon Z",
        "road_edge_area": "Polygon Z",
    }
    for name in ("road_edge", "gutter_lid"):
        assert pyogrio.read_info(path, layer=name)["crs"] == "EPSG:6677"
    (line,), columns = _layer(path, "road_edge")
    assert shapely.get_coordinates(line, include_z=True).tolist() == [list(one) for one in _SHAPE]
    assert columns["id"] == ["a"]
    (ring,), _ = _layer(path, "gutter_lid")
    assert shapely.get_coordinates(ring, include_z=True).tolist() == [
        list(one) for one in (*_SHAPE, _SHAPE[0])
    ]


def test_attributes_keep_their_types_and_what_is_missing_is_null(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    path = tmp_path / "a.gpkg"
    features = [
        _feature("a", "street_tree", Geometry.POINT, girth_m=0.62, stems=2, species="欅🌳"),
        _feature("b", "street_tree", Geometry.POINT, height_m=7, extra="x", Extra="y", status="z"),
    ]
    write_geopackage(path, features, catalogue, crs="EPSG:6677")
    types = dict(
        zip(*(pyogrio.read_info(path)[key].tolist() for key in ("fields", "dtypes")), strict=True)
    )
    assert types["girth_m"] == types["height_m"] == types["crown_m"] == "float64"
    assert types["stems"] == "int64"
    assert types["species"] == "object"
    _, columns = _layer(path, "street_tree")
    assert columns["girth_m"][0] == 0.62
    assert np.isnan(columns["girth_m"][1])
    assert columns["species"] == ["欅🌳", None]
    assert columns["status"] == ["accepted", "accepted"]
    assert columns["attribute_status"] == [None, "z"]
    assert columns["extra"] == [None, "x"]
    assert columns["attribute_Extra"] == [None, "y"]


def test_an_unknown_reference_system_stays_unknown(tmp_path: Path, catalogue: Catalogue) -> None:
    path = tmp_path / "a.gpkg"
    write_geopackage(path, [_feature("a", "road_edge", Geometry.LINE)], catalogue, crs="")
    assert pyogrio.read_info(path)["crs"] is None


def test_a_map_without_features_is_a_valid_file(tmp_path: Path, catalogue: Catalogue) -> None:
    path = tmp_path / "a.gpkg"
    write_geopackage(path, [], catalogue, crs="EPSG:6677")
    assert pyogrio.read_info(path)["features"] == 0


def test_a_kind_that_no_catalogue_knows_is_kept(tmp_path: Path, catalogue: Catalogue) -> None:
    path = tmp_path / "a.gpkg"
    write_geopackage(path, [_feature("a", "未知", Geometry.POINT)], catalogue, crs="EPSG:6677")
    assert pyogrio.list_layers(path)[:, 0].tolist() == ["未知"]


def test_what_cannot_be_written_is_a_sentence_and_leaves_nothing(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    path = tmp_path / "a.gpkg"
    path.mkdir()
    features = [_feature("a", "road_edge", Geometry.LINE)]
    with pytest.raises(UserError):
        write_geopackage(path, features, catalogue, crs="EPSG:6677")
    with pytest.raises(UserError):
        write_geopackage(tmp_path / "b.gpkg", features, catalogue, crs="EPSG:0")
    assert list(tmp_path.iterdir()) == [path]


_METRES = st.floats(-1e7, 1e7)
_TEXTS = st.characters(exclude_categories=["Cs"])


@settings(max_examples=25)
@example(position=(0.0, 0.0, 0.0), name="kind", value="")
@given(
    position=st.tuples(_METRES, _METRES, _METRES),
    name=st.text(_TEXTS, max_size=8),
    value=st.one_of(
        st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0")),
        st.integers(-(1 << 63), (1 << 63) - 1),
        st.floats(allow_nan=False, allow_infinity=False),
    ),
)
def test_any_place_and_any_value_is_kept(
    tmp_path_factory: pytest.TempPathFactory, position: Position, name: str, value: str | float
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.gpkg"
    feature = _placed("a", "post", Geometry.POINT, (position,), **{name: value})
    write_geopackage(path, [feature], Catalogue(()), crs="EPSG:6677")
    (point,), columns = _layer(path, "post")
    assert [tuple(one) for one in shapely.get_coordinates(point, include_z=True)] == [position]
    assert list(columns.values())[5] == [value]


def test_a_full_disk_is_told_in_one_sentence_and_leaves_nothing_half_written(tmp_path, catalogue):
    features = [_feature("a", "road_edge", Geometry.LINE)]
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (8_192, hard))
    try:
        with pytest.raises(NoSpace) as refused:
            write_geopackage(tmp_path / "map.gpkg", features, catalogue, crs="EPSG:6677")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert "CREATE TABLE" not in refused.value.line("en")
    assert len(refused.value.what.en) < 200
    assert list(tmp_path.iterdir()) == []
