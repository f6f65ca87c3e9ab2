"""GeoJSON keeps every coordinate and every attribute, and says which system they are in."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import Cancelled, InUse
from processing.formats.vectors.geojson import write_geojson
from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Position, Provenance, Status, Vertex
from tests.monitors import CancelledAfter

_METRES = st.floats(-1e7, 1e7, allow_nan=False)
_POSITIONS = st.tuples(_METRES, _METRES, _METRES)


def _feature(geometry: Geometry, *positions: Position, **attributes: object) -> Feature:
    return Feature(
        "f1",
        "street_tree",
        geometry,
        tuple(Vertex(position) for position in positions),
        attributes,  # type: ignore[arg-type]  # tests give what they like
        Status.CANDIDATE,
        Provenance("trees", 1, {}, 0.75),
    )


def _written(path: Path, *features: Feature, crs: str = "EPSG:6677") -> Any:
    write_geojson(path, features, crs=crs)
    return json.loads(path.read_text(encoding="utf-8"))


def test_a_feature_has_the_properties_of_the_contract(tmp_path: Path) -> None:
    tree = _feature(Geometry.POINT, (1.0, 2.0, 3.0), girth_m=0.62, stems=2, species="欅")
    whole = _written(tmp_path / "木.geojson", tree)
    assert whole["crs"]["properties"]["name"] == "urn:ogc:def:crs:EPSG::6677"
    (one,) = whole["features"]
    assert one["geometry"] == {"type": "Point", "coordinates": [1.0, 2.0, 3.0]}
    assert one["properties"] == {
        "kind": "street_tree",
        "confidence": 0.75,
        "status": "candidate",
        "tool": "trees",
        "girth_m": 0.62,
        "stems": 2,
        "species": "欅",
    }


def test_an_unknown_reference_system_is_said_and_not_guessed(tmp_path: Path) -> None:
    whole = _written(tmp_path / "a.geojson", _feature(Geometry.POINT, (1, 2, 3)), crs="")
    assert whole["crs"] is None


def test_the_system_is_understood_by_a_gis_library(tmp_path: Path) -> None:
    import pyogrio

    path = tmp_path / "a.geojson"
    write_geojson(path, [_feature(Geometry.LINE, (1, 2, 3), (4, 5, 6))], crs="EPSG:6669")
    told = pyogrio.read_info(path)
    assert told["crs"] == "EPSG:6669"
    assert told["geometry_type"] == "LineString Z"


@given(positions=st.lists(_POSITIONS, min_size=3, max_size=6))
def test_any_coordinate_is_kept_to_the_last_bit(
    tmp_path_factory: pytest.TempPathFactory, positions: list[Position]
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.geojson"
    line = _feature(Geometry.LINE, *positions)
    area = _feature(Geometry.AREA, *positions)
    read = [one["geometry"]["coordinates"] for one in _written(path, line, area)["features"]]
    assert [tuple(one) for one in read[0]] == positions
    assert [tuple(one) for one in read[1][0]] == [*positions, positions[0]]


@given(name=st.text(), value=st.one_of(st.text(), st.integers(), st.booleans(), st.none()))
def test_any_attribute_is_kept(
    tmp_path_factory: pytest.TempPathFactory, name: str, value: str | int | bool | None
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.geojson"
    feature = _feature(Geometry.POINT, (1.0, 2.0, 3.0), **{name: value})
    read = _written(path, feature)["features"][0]["properties"]
    assert read["kind"] == "street_tree"
    own = name if name not in {"kind", "status", "confidence", "tool"} else f"attribute_{name}"
    assert read.get(own, read.get(f"attribute_{name}")) == value


def test_what_is_no_number_becomes_null(tmp_path: Path) -> None:
    feature = _feature(Geometry.POINT, (1, 2, 3), height_m=float("nan"), girth_m=float("inf"))
    read = _written(tmp_path / "a.geojson", feature)["features"][0]["properties"]
    assert read["height_m"] is None
    assert read["girth_m"] is None


def test_an_attribute_cannot_hide_what_the_contract_promises(tmp_path: Path) -> None:
    feature = _feature(Geometry.POINT, (1, 2, 3), kind="fake", status="fake")
    read = _written(tmp_path / "a.geojson", feature)["features"][0]["properties"]
    assert (read["kind"], read["status"]) == ("street_tree", "candidate")
    assert (read["attribute_kind"], read["attribute_status"]) == ("fake", "fake")


def test_a_map_without_features_is_a_valid_collection(tmp_path: Path) -> None:
    assert _written(tmp_path / "a.geojson")["features"] == []


def test_a_cancelled_writing_leaves_nothing(tmp_path: Path) -> None:
    path = tmp_path / "a.geojson"
    with pytest.raises(Cancelled):
        write_geojson(path, [_feature(Geometry.POINT, (1, 2, 3))], crs="", monitor=CancelledAfter())
    assert list(tmp_path.iterdir()) == []


def test_a_delivered_file_is_not_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "delivered.geojson"
    path.write_text("mine")
    with pytest.raises(InUse):
        write_geojson(path, [], crs="", never=[path])
    assert path.read_text() == "mine"
