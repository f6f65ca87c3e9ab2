"""Shapefiles are read back by GDAL, and their tables byte by byte: places, texts, names."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyogrio
import pytest
import shapely
from pyproj import CRS

from processing.core.text import Text
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Position, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of

_EDGE = ((-11394.608, -35139.915, 25.682), (-11390.001, -35138.512, 25.703))
_RING = (*_EDGE, (-11390.1, -35138.0, 25.7))


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _feature(kind: str, geometry: Geometry, *positions: Position, **own: Any) -> Feature:
    return Feature(f"id-{kind}", kind, geometry, tuple(map(Vertex, positions)), own)


def _written(
    folder: Path, catalogue: Catalogue, *features: Feature, crs: str = "EPSG:6677", **options: Any
) -> list[Text]:
    notes: list[Text] = []
    request = ExportRequest(("shp",), folder, options=options)
    paths = export(features, catalogue, crs, request, tell=notes.append)
    assert sorted(paths) == sorted(folder.iterdir())
    return notes


def test_a_file_for_each_kind_holds_the_places_to_the_last_bit(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    for kind, geometry, places in (
        ("road_edge", Geometry.LINE, _EDGE),
        ("street_tree", Geometry.POINT, _EDGE[:1]),
        ("building", Geometry.AREA, _RING),
    ):
        _written(tmp_path / kind, catalogue, _feature(kind, geometry, *places))
        path = tmp_path / kind / f"{kind}.shp"
        assert CRS(path.with_suffix(".prj").read_text()).to_epsg(min_confidence=20) == 6677
        assert pyogrio.read_info(path)["geometry_type"].endswith(" Z")
        _, _, shapes, _ = pyogrio.raw.read(path)
        read = shapely.get_coordinates(shapely.from_wkb(shapes), include_z=True).tolist()
        assert {tuple(one) for one in read} == set(places)


@pytest.mark.parametrize("encoding", ["utf-8", "cp932"])
def test_texts_are_in_the_encoding_that_the_file_names(
    tmp_path: Path, catalogue: Catalogue, encoding: str
) -> None:
    tree = _feature("street_tree", Geometry.POINT, _EDGE[0], species="欅〜", girth_m=0.62)
    _written(tmp_path, catalogue, tree, encoding=encoding)
    expected = "欅～" if encoding == "cp932" else "欅〜"
    assert expected.encode(encoding) in (tmp_path / "street_tree.dbf").read_bytes()
    named = (tmp_path / "street_tree.cpg").read_text().strip().lower()
    assert named == encoding
    meta, _, _, columns = pyogrio.raw.read(tmp_path / "street_tree.shp")
    values = dict(zip(meta["fields"].tolist(), columns, strict=True))
    assert (values["species"][0], values["girth_m"][0]) == (expected, 0.62)


def test_shortened_names_and_texts_are_told(tmp_path: Path, catalogue: Catalogue) -> None:
    own = {"lowest_branch_m": 2.0, "lowest_branch_n": 3.0, "note": "長" * 100}
    notes = _written(tmp_path, catalogue, _feature("street_tree", Geometry.POINT, _EDGE[0], **own))
    fields = pyogrio.read_info(tmp_path / "street_tree.shp")["fields"].tolist()
    assert {"lowest_bra", "lowest_b_2"} <= set(fields)
    assert all(len(name) <= 10 for name in fields)
    assert "lowest_branch_m → lowest_bra, lowest_branch_n → lowest_b_2" in notes[0].en
    assert notes[1].en == "Texts longer than the 254 bytes of a Shapefile were cut: 1."


@pytest.mark.filterwarnings("ignore:Measured")  # what GDAL takes Z without any feature for
def test_an_empty_map_and_an_unknown_system_are_files_too(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    _written(tmp_path, catalogue, crs="")
    assert pyogrio.read_info(tmp_path / "features.shp")["features"] == 0
    assert not (tmp_path / "features.prj").exists()
