"""Boundaries as offices draw them: polygons and closed polylines, and files that hold none."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import numpy as np
import pyogrio.raw
import pytest
import shapely

from processing.core.errors import BadFile, MissingInput, OutOfRange, Unsuitable
from processing.formats.drawings.dxf import write_dxf
from processing.formats.drawings.dxf_document import PlanVersion
from processing.formats.vectors.boundary_files import (
    Boundary,
    boundary_layers,
    file_and_layer,
    read_boundary,
)
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Vertex
from resources import path_of

EAST, NORTH = -12_000.5, -35_000.25
Ring = list[tuple[float, float]]


def box(low: float, high: float, shift: float = 0.0) -> Ring:
    corners = [(low, low), (high, low), (high, high), (low, high)]
    return [(EAST + shift + x, NORTH + y) for x, y in corners]


BOW_TIE: Ring = [(EAST, NORTH), (EAST + 4, NORTH + 4), (EAST + 4, NORTH), (EAST, NORTH + 4)]


def area_of(boundary: Boundary) -> float:
    """Even-odd: outlines add, holes, which run the other way, take away."""
    signed = 0.0
    for ring in boundary.rings:
        x, y = (ring - [EAST, NORTH]).T
        signed += float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2
    return signed


def as_geojson(path: Path, *polygons: list[Ring], crs: int | None = 6677) -> Path:
    features = [
        {
            "type": "Feature",
            "properties": {},
            "geometry": {
                "type": "Polygon",
                "coordinates": [[*ring, ring[0]] for ring in rings],
            },
        }
        for rings in polygons
    ]
    name = {"type": "name", "properties": {"name": f"urn:ogc:def:crs:EPSG::{crs}"}}
    whole = {"type": "FeatureCollection", "crs": crs and name, "features": features}
    path.write_text(json.dumps(whole), "utf-8")
    return path


def as_geopackage(
    path: Path, *polygons: list[Ring], layer: str = "境界", crs: str | None = "EPSG:6677"
) -> Path:
    shapes = [shapely.Polygon(rings[0], rings[1:]) for rings in polygons]
    wkb = np.array([shapely.to_wkb(one) for one in shapes], dtype=object)
    pyogrio.raw.write(
        str(path), wkb, [], [], layer=layer, driver="GPKG", geometry_type="Polygon", crs=crs
    )
    return path


def as_dxf(path: Path, *polygons: list[Ring]) -> Path:
    doc = ezdxf.filemanagement.new("R2000")
    for rings in polygons:
        for ring in rings:
            doc.modelspace().add_lwpolyline(ring, close=True, dxfattribs={"layer": "範囲"})
    doc.encoding = "cp932"
    doc.saveas(path)
    return path


WRITERS: dict[str, Callable[..., Path]] = {
    "a.geojson": as_geojson,
    "a.gpkg": as_geopackage,
    "a.dxf": as_dxf,
}


@pytest.mark.parametrize("name", WRITERS)
def test_the_polygon_of_each_format_comes_back(tmp_path: Path, name: str) -> None:
    path = WRITERS[name](tmp_path / name, [box(0, 20)])
    read = read_boundary(path, crs="EPSG:6677")
    (ring,) = read.rings
    assert sorted(map(tuple, ring.tolist())) == sorted(box(0, 20))
    assert area_of(read) == pytest.approx(400.0)
    assert read.polygons == 1
    assert read.crs == ("" if name == "a.dxf" else "EPSG:6677")


@pytest.mark.parametrize("name", WRITERS)
def test_a_hole_is_a_ring_that_runs_the_other_way(tmp_path: Path, name: str) -> None:
    read = read_boundary(WRITERS[name](tmp_path / name, [box(0, 20), box(5, 10)]))
    assert len(read.rings) == 2
    assert area_of(read) == pytest.approx(400.0 - 25.0)


@pytest.mark.parametrize("name", WRITERS)
def test_several_polygons_are_one_area_and_count_once_where_they_overlap(
    tmp_path: Path, name: str
) -> None:
    path = WRITERS[name](tmp_path / name, [box(0, 10)], [box(0, 10, 5.0)], [box(0, 10, 100.0)])
    read = read_boundary(path)
    assert read.polygons == 3
    assert len(read.rings) == 2
    assert area_of(read) == pytest.approx(150.0 + 100.0)


@pytest.mark.parametrize("name", WRITERS)
def test_an_outline_that_crosses_itself_is_told_with_the_place(tmp_path: Path, name: str) -> None:
    with pytest.raises(Unsuitable, match=r"crosses or touches itself.*E -11998\.500, N -34998\.2"):
        read_boundary(WRITERS[name](tmp_path / name, [BOW_TIE]))


@pytest.mark.parametrize("name", WRITERS)
def test_an_outline_without_area_is_refused(tmp_path: Path, name: str) -> None:
    line = [(EAST, NORTH), (EAST + 5, NORTH), (EAST + 9, NORTH)]
    with pytest.raises(Unsuitable, match="holds no area"):
        read_boundary(WRITERS[name](tmp_path / name, [line]))


@pytest.mark.parametrize("name", ["a.geojson", "a.gpkg"])
def test_holes_outside_are_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(Unsuitable, match="Holes of the boundary lie outside"):
        read_boundary(WRITERS[name](tmp_path / name, [box(0, 10), box(0, 5, 100.0)]))


@pytest.mark.parametrize("name", ["a.geojson", "a.gpkg"])
def test_another_reference_system_is_refused_and_named(tmp_path: Path, name: str) -> None:
    path = WRITERS[name](tmp_path / name, [box(0, 10)])
    with pytest.raises(Unsuitable, match=r"JGD2011 / Japan Plane.* IX\) than EPSG:6678"):
        read_boundary(path, crs="EPSG:6678")
    assert read_boundary(path, crs="EPSG:6677").polygons == 1
    assert read_boundary(path).polygons == 1


def test_degrees_are_another_reference_system(tmp_path: Path) -> None:
    ring = [[139.0, 35.0], [139.1, 35.0], [139.1, 35.1], [139.0, 35.0]]
    path = tmp_path / "a.geojson"
    path.write_text(json.dumps({"type": "Polygon", "coordinates": [ring]}))
    with pytest.raises(Unsuitable, match="another reference system"):
        read_boundary(path, crs="EPSG:6677")


def test_without_a_reference_system_the_numbers_are_believed(tmp_path: Path) -> None:
    path = as_geojson(tmp_path / "a.geojson", [box(0, 10)], crs=None)
    assert read_boundary(path, crs="EPSG:6677").crs == ""


@pytest.mark.parametrize("kind", ["Point", "LineString"])
def test_points_and_lines_alone_are_no_boundary(tmp_path: Path, kind: str) -> None:
    positions: Any = [list(position) for position in box(0, 10)]
    path = tmp_path / "a.geojson"
    path.write_text(
        json.dumps({"type": kind, "coordinates": positions[0] if kind == "Point" else positions})
    )
    with pytest.raises(Unsuitable, match="no closed polygon"):
        read_boundary(path)


def test_a_geopackage_of_points_or_of_nothing_is_no_boundary(tmp_path: Path) -> None:
    wkb = np.array([shapely.to_wkb(shapely.Point(EAST, NORTH)), None], dtype=object)
    pyogrio.raw.write(
        str(tmp_path / "a.gpkg"),
        wkb,
        [],
        [],
        layer="a",
        driver="GPKG",
        geometry_type="Point",
        crs="EPSG:6677",
    )
    with pytest.raises(Unsuitable, match="no closed polygon"):
        read_boundary(tmp_path / "a.gpkg")


def test_polylines_closed_by_their_last_place_arcs_and_heights_are_read(tmp_path: Path) -> None:
    doc = ezdxf.filemanagement.new("R2018")
    space = doc.modelspace()
    space.add_polyline3d([(x, y, 7.0) for x, y in (*box(0, 10), box(0, 10)[0])])
    space.add_lwpolyline([(EAST, NORTH), (EAST + 1, NORTH)])
    space.add_lwpolyline([(EAST + 50, NORTH, 1.0), (EAST + 52, NORTH, 1.0)], "xyb", close=True)
    space.add_point((EAST, NORTH))
    doc.saveas(tmp_path / "a.dxf")
    read = read_boundary(tmp_path / "a.dxf")
    assert read.polygons == 2
    # The arcs' chords lie up to a millimetre within the circle.
    assert area_of(read) == pytest.approx(100.0 + np.pi, abs=2 * np.pi * 1e-3)


def test_open_polylines_are_no_boundary(tmp_path: Path) -> None:
    doc = ezdxf.filemanagement.new("R2018")
    doc.modelspace().add_lwpolyline(box(0, 10))
    doc.saveas(tmp_path / "a.dxf")
    with pytest.raises(Unsuitable, match="no closed polygon"):
        read_boundary(tmp_path / "a.dxf")


def test_the_same_outline_drawn_twice_counts_once(tmp_path: Path) -> None:
    read = read_boundary(as_dxf(tmp_path / "a.dxf", [box(0, 10)], [box(0, 10)]))
    assert area_of(read) == pytest.approx(100.0)


def test_an_island_in_a_hole_belongs_to_the_area(tmp_path: Path) -> None:
    read = read_boundary(as_dxf(tmp_path / "a.dxf", [box(0, 20), box(5, 15), box(8, 10)]))
    assert area_of(read) == pytest.approx(400.0 - 100.0 + 4.0)


def with_layers(path: Path) -> Path:
    """Polygons of 100 m² on 境界 and of 400 m² on other."""
    if path.suffix == ".gpkg":
        as_geopackage(path, [box(0, 10)])
        as_geopackage(path, [box(0, 20)], layer="other")
    else:
        doc = ezdxf.filemanagement.new("R2018")
        for layer, ring in {"境界": box(0, 10), "other": box(0, 20)}.items():
            doc.modelspace().add_lwpolyline(ring, close=True, dxfattribs={"layer": layer})
        doc.saveas(path)
    return path


@pytest.mark.parametrize("name", ["a.gpkg", "a.dxf"])
def test_of_several_layers_one_must_be_named(tmp_path: Path, name: str) -> None:
    path = with_layers(tmp_path / name)
    with pytest.raises(Unsuitable, match=f"several layers: 境界, other.*{name}#境界"):
        read_boundary(path)
    assert area_of(read_boundary(path, layer="other")) == pytest.approx(400.0)
    with pytest.raises(OutOfRange, match=r"No layer of this name.*境界, other"):
        read_boundary(path, layer="third")


@pytest.mark.parametrize("name", ["a.gpkg", "A.DXF"])
def test_a_layer_is_named_behind_its_file(tmp_path: Path, name: str) -> None:
    path = with_layers(tmp_path / name)
    for layer, area in (("境界", 100.0), ("other", 400.0)):
        file, found = file_and_layer(f"{path}#{layer}")
        assert (file, found) == (path, layer)
        assert area_of(read_boundary(file, layer=found)) == pytest.approx(area)
    assert file_and_layer(str(path)) == (path, "")


def test_a_file_whose_own_name_has_the_mark_is_that_file(tmp_path: Path) -> None:
    path = as_dxf(tmp_path / "a.dxf#1.dxf", [box(0, 10)])
    assert file_and_layer(str(path)) == (path, "")
    assert file_and_layer("a#b.geojson") == (Path("a#b.geojson"), "")
    assert file_and_layer("a.dxf#b.dxf#c") == (Path("a.dxf#b.dxf"), "c")


@pytest.mark.parametrize("name", ["a.gpkg", "a.dxf"])
def test_the_layers_that_have_polygons_are_told(tmp_path: Path, name: str) -> None:
    assert boundary_layers(with_layers(tmp_path / name)) == ("境界", "other")


def test_a_file_without_layers_has_none_and_a_bad_one_is_told(tmp_path: Path) -> None:
    assert boundary_layers(as_geojson(tmp_path / "a.geojson", [box(0, 10)])) == ()
    with pytest.raises(OutOfRange, match="Areas are read from DXF, GeoPackage"):
        boundary_layers(tmp_path / "a.shp")
    for name in ("bad.dxf", "bad.gpkg"):
        (tmp_path / name).write_bytes(b"nothing")
        with pytest.raises(BadFile):
            boundary_layers(tmp_path / name)
        with pytest.raises(MissingInput):
            boundary_layers(tmp_path / f"no{name}")


@pytest.mark.parametrize("version", ["R2000", "R2018"])
def test_an_area_that_the_program_drew_is_a_boundary_with_its_reference_system(
    tmp_path: Path, version: PlanVersion
) -> None:
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    kind = next(one for one in catalogue if one.geometry is Geometry.AREA)
    site = Feature("a", kind.id, Geometry.AREA, tuple(Vertex((x, y, 1.0)) for x, y in box(0, 10)))
    write_dxf(tmp_path / "a.dxf", [site], catalogue, crs="EPSG:6677", version=version)
    read = read_boundary(tmp_path / "a.dxf", crs="EPSG:6677")
    assert (read.crs, area_of(read)) == ("EPSG:6677", pytest.approx(100.0))


@pytest.mark.parametrize("name", WRITERS)
def test_files_that_are_none_or_missing_say_so(tmp_path: Path, name: str) -> None:
    with pytest.raises(MissingInput, match="There is no such file"):
        read_boundary(tmp_path / name)
    (tmp_path / name).write_text("LandXML")
    with pytest.raises(BadFile, match=name):
        read_boundary(tmp_path / name)
    (tmp_path / name).write_bytes(b"")
    with pytest.raises(BadFile, match=name):
        read_boundary(tmp_path / name)


@pytest.mark.parametrize("name", WRITERS)
def test_a_file_that_ends_early_is_damaged(tmp_path: Path, name: str) -> None:
    path = WRITERS[name](tmp_path / name, [box(0, 10)])
    content = path.read_bytes()
    path.write_bytes(content[: len(content) * 2 // 3])
    with pytest.raises((BadFile, Unsuitable), match=name):
        read_boundary(path)


def test_other_endings_are_refused(tmp_path: Path) -> None:
    with pytest.raises(OutOfRange, match="Areas are read from DXF, GeoPackage"):
        read_boundary(tmp_path / "a.shp")


def test_a_coordinate_that_is_no_number_is_told_with_its_feature(tmp_path: Path) -> None:
    path = tmp_path / "a.geojson"
    path.write_text('{"type": "Polygon", "coordinates": [[[0, 0], ["1,5", 0], [1, 1], [0, 0]]]}')
    with pytest.raises(BadFile, match=r"is no place.*a\.geojson, feature 1"):
        read_boundary(path)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (" 10\r\n1e+20", " 10\r\n1e+p"),
        (" 10\r\n1e+20", " 10\r\n"),
        ("LWPOLYLINE", "LWPOLYLINE\r\n  0"),
    ],
)
def test_a_drawing_that_is_damaged_inside_says_so(tmp_path: Path, old: str, new: str) -> None:
    path = as_dxf(tmp_path / "a.dxf", [box(0, 10)])
    content = path.read_bytes().replace(b"\n", b"\r\n").replace(b"\r\r", b"\r")
    path.write_bytes(content.replace(old.encode(), new.encode(), 1))
    with pytest.raises((BadFile, Unsuitable), match=r"a\.dxf"):
        read_boundary(path)
