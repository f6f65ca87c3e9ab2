"""LandXML of routes is valid, and says what was measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from lxml import etree

from processing.core.errors import Unsuitable
from processing.formats.surfaces.landxml import read_landxml
from processing.map.catalogue_file import read_catalogue
from processing.operations.export import ExportRequest, export
from processing.recording.drive import Drive
from processing.section.stations import Stations
from resources import path_of
from tests.processing.formats.sections.test_section_files import _map
from tests.street_scene import CROSSFALL

_SPACE = {"l": "http://www.landxml.org/schema/LandXML-1.2"}
_SCHEMA = Path(__file__).parents[1] / "surfaces" / "landxml_as_written.rng"


@pytest.mark.parametrize("form", ["J-LandXML", "LandXML"])
def test_alignment_sections_and_surface_come_back(
    tmp_path: Path, both_heads: tuple[Drive, Drive], form: str
) -> None:
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    options = {"section_pitch": 2.0, "landxml_form": form, "sheet_heights": "JGD2024"}
    request = ExportRequest(("landxml",), tmp_path, options=options)
    (path,) = export(_map(both_heads[0]), catalogue, "EPSG:6677", request, drives=both_heads)
    tree = etree.parse(path)
    etree.RelaxNG(etree.parse(_SCHEMA)).assertValid(tree)
    (alignment,) = tree.findall(".//l:Alignment", _SPACE)
    assert alignment.get("name") == "市道1号線"
    sections = alignment.findall(".//l:CrossSect", _SPACE)
    assert [one.get("sta") for one in sections][:3] == ["0.000", "2.000", "4.000"]
    lists = sections[2].findall(".//l:PntList2D", _SPACE)
    places = np.concatenate([np.array(one.text.split(), float).reshape(-1, 2) for one in lists])
    road = places[np.abs(places[:, 0]) < 3.0]
    assert np.abs(road[:, 1] - 125.0 + CROSSFALL * np.abs(road[:, 0] - 0.5)).max() < 0.03
    surface = read_landxml(path).only().surface
    stations = Stations([vertex.xyz for vertex in _map(both_heads[0])[0].vertices])
    places = []
    for station in (2.5, 3.3, 4.7):  # 3 m to the right of the centre line, between the sections
        (x, y, _), (east, north) = stations.position_at(station), stations.direction_at(station)
        places.append((x + 3.0 * north, y - 3.0 * east))
    heights = surface.heights_at(np.array(places))
    assert np.abs(heights - (125.0 - CROSSFALL * 2.5)).max() < 0.03
    breaks = tree.findall(".//l:Breakline", _SPACE)
    assert len(breaks) == (1 if form == "LandXML" else 0)


def test_a_system_without_name_is_refused(tmp_path: Path, both_heads: tuple[Drive, Drive]) -> None:
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    request = ExportRequest(("landxml",), tmp_path)
    with pytest.raises(Unsuitable, match="J-LandXML needs"):
        export(_map(both_heads[0]), catalogue, "EPSG:32654", request, drives=both_heads)
    assert list(tmp_path.iterdir()) == []
