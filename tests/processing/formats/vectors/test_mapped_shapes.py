"""Maps read back for scores: the shapes and facts that were written, and files that are none."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from processing.core.errors import BadFile, MissingInput, OutOfRange, UserError
from processing.formats.vectors.geojson import write_geojson
from processing.formats.vectors.geopackage import write_geopackage
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Feature, Vertex
from processing.scoring.features.mapped_features import IN_DEGREES

POSITIONS = (
    (-11_000.25, -35_000.5, 120.125),
    (-10_999.0, -35_000.0, 121.0),
    (-11_000.0, -34_999.0, 122.0),
)
LINE = Feature(
    "a", "curb", Geometry.LINE, tuple(map(Vertex, POSITIONS)), {"edge": "upper", "height_m": 0.15}
)
AREA = Feature("b", "gutter", Geometry.AREA, tuple(map(Vertex, POSITIONS)), {"type": "lid"})
POINT = Feature("c", "tree", Geometry.POINT, (Vertex(POSITIONS[0]),), {"stems": 2, "dbh_m": None})


def write_json(path: Path, value: object) -> Path:
    path.write_text(json.dumps(value), "utf-8")
    return path


def collection(*features: dict[str, Any], **more: object) -> dict[str, Any]:
    return {"type": "FeatureCollection", "features": list(features), **more}


def member(kind: str, coordinates: object, /, **facts: object) -> dict[str, Any]:
    geometry = {"type": kind, "coordinates": coordinates}
    return {"type": "Feature", "geometry": geometry, "properties": facts}


@pytest.mark.parametrize("name", ["地図.geojson", "map.gpkg"])
def test_what_the_program_writes_is_read_back(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    if path.suffix == ".gpkg":
        write_geopackage(path, [LINE, AREA, POINT], Catalogue(()), crs="EPSG:6677")
    else:
        write_geojson(path, [LINE, AREA, POINT], crs="EPSG:6677")
    read = read_mapped(path)
    assert read.crs == "EPSG:6677"
    line, area, point = read.features
    assert (line.shape, area.shape, point.shape) == ("line", "area", "point")
    for one in (line, area):
        # A ring's sense of rotation is the format's own matter.
        assert sorted(map(tuple, one.xyz.tolist())) == sorted(POSITIONS)
    assert point.xyz.tolist() == [list(POSITIONS[0])]
    assert (line.facts["kind"], line.facts["edge"], line.facts["height_m"]) == (
        "curb",
        "upper",
        0.15,
    )
    assert (area.facts["type"], area.facts["status"]) == ("lid", "accepted")
    assert (point.facts["stems"], point.facts.get("dbh_m")) == (2, None)


def test_an_empty_map_has_no_features(tmp_path: Path) -> None:
    write_geojson(tmp_path / "a.geojson", [], crs="EPSG:6677")
    assert read_mapped(tmp_path / "a.geojson").features == ()
    write_geopackage(tmp_path / "a.gpkg", [], Catalogue(()), crs="EPSG:6677")
    assert read_mapped(tmp_path / "a.gpkg").features == ()


def test_parts_share_their_facts_holes_are_left_out_and_heights_may_lack(tmp_path: Path) -> None:
    ring = [[500, 0], [600, 0], [600, 100], [500, 0]]
    hole = [[580, 10], [590, 10], [590, 20], [580, 10]]
    features = (
        member("MultiPoint", [[500, 1, 2], [501, 1, 2]], kind="tree"),
        member("Polygon", [ring, hole]),
        {"type": "Feature", "geometry": None, "properties": None},
    )
    read = read_mapped(write_json(tmp_path / "a.geojson", collection(*features, crs=None)))
    assert read.crs == ""
    assert [(one.number, one.shape) for one in read.features] == [
        (1, "point"),
        (1, "point"),
        (2, "area"),
    ]
    assert read.features[1].facts == {"kind": "tree"}
    assert np.isnan(read.features[2].xyz[:, 2]).all()


def test_places_in_degrees_are_known_for_what_they_are(tmp_path: Path) -> None:
    path = write_json(tmp_path / "a.geojson", collection(member("Point", [139.7, 35.6])))
    assert read_mapped(path).crs == IN_DEGREES


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no GeoJSON"),
        ("x,y\n1,2\n", "no GeoJSON"),
        ('{"type": "FeatureCollection", "features": [', "damaged"),
        ('{"cut_m3": 3}', "not GeoJSON"),
        (json.dumps(collection(member("Point", ["a", 2]))), "feature 1"),
        (json.dumps(collection(member("LineString", [[600, 2]]))), "1 of at least 2 vertices"),
        (json.dumps(collection(crs={"type": "name", "properties": {"name": "Mars"}})), "Mars"),
    ],
)
def test_what_is_no_map_is_refused_in_one_line_that_names_the_file(
    tmp_path: Path, text: str, says: str
) -> None:
    path = tmp_path / "wrong.geojson"
    path.write_text(text, "utf-8")
    with pytest.raises(BadFile) as caught:
        read_mapped(path)
    line = caught.value.line("en")
    assert says in line
    assert "wrong.geojson" in line
    assert "clipboard" not in line
    assert "クリップボード" not in caught.value.line("ja")


def test_files_of_other_kinds_are_refused(tmp_path: Path) -> None:
    (tmp_path / "a.gpkg").write_bytes(b"SQLite? No.")
    expected: list[tuple[str, type[UserError]]] = [
        ("a.gpkg", BadFile),
        ("none.gpkg", MissingInput),
        ("none.geojson", MissingInput),
        ("a.dxf", MissingInput),
        ("a.dm", MissingInput),
        ("a.csv", OutOfRange),
    ]
    for name, error in expected:
        with pytest.raises(error):
            read_mapped(tmp_path / name)
