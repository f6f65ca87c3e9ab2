"""A KMZ is read back as the XML that KML is: places in WGS 84, names, colours."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree as ET
from zipfile import ZipFile

import pytest
from pyproj import Transformer

from processing.core.errors import MissingInput
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of

_RING = ((-7880.0, -36050.0, 1.0), (-7870.0, -36050.0, 1.0), (-7870.0, -36045.0, 1.5))
_KML = {"k": "http://www.opengis.net/kml/2.2"}


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _written(folder: Path, catalogue: Catalogue, *features: Feature, crs: str) -> ET.Element:
    (path,) = export(features, catalogue, crs, ExportRequest(("kmz",), folder))
    with ZipFile(path) as archive:
        return ET.fromstring(archive.read("doc.kml"))  # noqa: S314 (the test's own file)


def test_places_are_read_back_to_the_millimetre(tmp_path: Path, catalogue: Catalogue) -> None:
    vertices = tuple(map(Vertex, _RING))
    features = (
        Feature("a", "building", Geometry.AREA, vertices, {"name": "庁舎 <1>\x07"}),
        Feature("l", "road_edge", Geometry.LINE, vertices),
        Feature("p", "street_tree", Geometry.POINT, vertices[:1], {"height_m": 5.5}),
    )
    root = _written(tmp_path, catalogue, *features, crs="EPSG:6677")
    back = Transformer.from_crs("EPSG:4326", "EPSG:6677", always_xy=True)
    for element, expected in zip(
        root.iterfind(".//k:coordinates", _KML),
        ((*_RING, _RING[0]), _RING, _RING[:1]),
        strict=True,
    ):
        read = [tuple(map(float, one.split(","))) for one in (element.text or "").split()]
        places = [(*back.transform(east, north), height) for east, north, height in read]
        assert places == [pytest.approx(place, abs=0.001) for place in expected]
    names = [one.text for one in root.iterfind(".//k:Placemark/k:name", _KML)]
    assert names[0] == "庁舎 <1> "
    assert root.find(".//k:Data[@name='樹高']/k:value", _KML) is not None
    colour = root.find(".//k:Style[@id='road_edge']/k:LineStyle/k:color", _KML)
    assert colour is not None
    own = catalogue["road_edge"].colour
    assert colour.text == f"ff{own[5:7]}{own[3:5]}{own[1:3]}"


def test_without_a_reference_system_it_is_refused(tmp_path: Path, catalogue: Catalogue) -> None:
    with pytest.raises(MissingInput):
        _written(tmp_path, catalogue, crs="")
    assert _written(tmp_path, catalogue, crs="EPSG:6677").find(".//k:Folder", _KML) is None
