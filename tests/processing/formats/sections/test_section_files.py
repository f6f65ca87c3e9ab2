"""Sections of routes are read back: heights and offsets of the street that was recorded."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import numpy as np
import pypdfium2
import pytest

from processing.core.errors import OutOfRange, Unsuitable
from processing.core.text import Text
from processing.formats.sections.route_sections import stations_in_words
from processing.formats.sections.section_drawing import spread_apart
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Vertex
from processing.operations.export import ExportRequest, export
from processing.recording.drive import Drive
from processing.section.stations import Stations
from resources import path_of
from tests.street_scene import CROSSFALL, CURB_AT_M, CURB_HEIGHT_M

_LANE_M = 0.5  # the vehicle drives so far left of the middle
_CURB_M = CURB_AT_M + _LANE_M  # from the vehicle to the right


def _line(id_: str, kind: str, places: Any, **own: Any) -> Feature:
    vertices = tuple(Vertex((x, y, z)) for x, y, z in places)
    return Feature(id_, kind, Geometry.LINE, vertices, own)


def _map(street: Drive) -> tuple[Feature, ...]:
    """The vehicle's path as centre line, the right curb's upper edge, and a line across."""
    assert street.trajectory is not None
    stations = Stations.of_trajectory(street.trajectory)
    at = np.linspace(0.5, stations.length_m - 0.5, 8)
    middle = [stations.position_at(one) for one in at]
    ways = [stations.direction_at(one) for one in at]
    curb = [
        (x + _CURB_M * north, y - _CURB_M * east, 125.07)
        for (x, y, _), (east, north) in zip(middle, ways, strict=True)
    ]
    (x, y, _), (east, north) = middle[4], ways[4]
    across = [(x + off * north, y - off * east, 124.5) for off in (-2.0, 2.0)]
    return (
        _line("centre", "road_center", middle, name="市道1号線"),
        _line("curb", "curb_upper", curb),
        _line("stop", "marking_line", across),
    )


def _written(
    folder: Path, drives: tuple[Drive, ...], **options: Any
) -> tuple[tuple[Path, ...], list[Text]]:
    notes: list[Text] = []
    request = ExportRequest(("sections",), folder, options={"section_pitch": 2.0, **options})
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    features = _map(drives[0]) if drives else ()
    written = export(features, catalogue, "EPSG:6677", request, drives=drives, tell=notes.append)
    return written, notes


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def test_the_cross_section_is_that_of_the_street(
    tmp_path: Path, both_heads: tuple[Drive, Drive]
) -> None:
    _written(tmp_path, both_heads)
    rows = [one for one in _rows(tmp_path / "cross_sections.csv") if one["station_m"] == "4.000"]
    ground = np.array(
        [(float(one["offset_m"]), float(one["height_m"])) for one in rows
         if one["point"] != "feature"]
    )  # fmt: skip
    assert (np.diff(ground[:, 0]) >= 0).all()
    road = ground[(ground[:, 0] > -3.0) & (ground[:, 0] < _CURB_M - 0.2)]
    expected = 125.0 - CROSSFALL * np.abs(road[:, 0] - _LANE_M)
    assert np.abs(road[:, 1] - expected).max() < 0.03
    low = np.interp(_CURB_M - 0.15, *ground.T)
    high = np.interp(_CURB_M + 0.15, *ground.T)
    assert high - low == pytest.approx(CURB_HEIGHT_M, abs=0.02)
    (curb,) = [one for one in rows if one["point"] == "feature"]
    assert (curb["feature"], curb["code"]) == ("curb", "2213")
    assert float(curb["offset_m"]) == pytest.approx(_CURB_M, abs=0.005)
    assert float(curb["height_m"]) == pytest.approx(125.07, abs=0.001)
    places = [vertex.xyz for vertex in _map(both_heads[0])[0].vertices]
    centre = Stations(np.array(places)).position_at(4.0)
    x, y = float(curb["easting_m"]), float(curb["northing_m"])
    from_centre = np.hypot(x - centre[0], y - centre[1])
    assert from_centre == pytest.approx(_CURB_M, abs=0.005)


def test_the_longitudinal_section_meets_what_lies_across(
    tmp_path: Path, both_heads: tuple[Drive, Drive]
) -> None:
    _written(tmp_path, both_heads)
    rows = _rows(tmp_path / "long_sections.csv")
    (stop,) = [one for one in rows if one["point"] == "feature"]
    assert stop["feature"] == "stop"
    ground = [one for one in rows if one["point"] == "ground"]
    heights = [float(one["height_m"]) for one in ground]
    assert max(abs(one - (125.0 - CROSSFALL * _LANE_M)) for one in heights) < 0.03
    stations = [float(one["station_m"]) for one in ground]
    assert stations == sorted(stations)
    assert stations[0] >= 0.0


def test_drawings_are_clean_and_true_to_scale(
    tmp_path: Path, both_heads: tuple[Drive, Drive]
) -> None:
    paths, _ = _written(tmp_path, both_heads, sheet_paper="A3", section_reach=6.0)
    drawings = [path for path in paths if path.suffix == ".dxf"]
    for path in drawings:
        audit = ezdxf.filemanagement.readfile(path).audit()
        assert [one.message for one in (*audit.errors, *audit.fixes)] == []
    pdf = pypdfium2.PdfDocument(tmp_path / "sections.pdf")
    assert len(pdf) == len(drawings) - 1
    assert np.array(pdf[0].get_size()) * 25.4 / 72 == pytest.approx([420.0, 297.0], abs=0.01)
    words = "".join(page.get_textpage().get_text_bounded() for page in pdf)
    for expected in ("縦断図", "横断図", "DL=", "No.0+4.00", "地盤高", "縁石上端", "第9系"):
        assert expected in words
    # In the flat drawing a metre across is a metre: the curb is as far from the axis.
    flat = ezdxf.filemanagement.readfile(
        next(one for one in drawings if one.stem.endswith("_002"))
    ).modelspace()
    marks = [one.dxf.center for one in flat.query("CIRCLE")]
    axes = [one for one in flat.query("POLYLINE") if one.dxf.layer == "S-BMK"]
    middles = {round(one.vertices[0].dxf.location.x, 6) for one in axes
               if one.dxf.linetype == "DASH_DOT"}  # fmt: skip
    away = [min(abs(mark.x - middle) for middle in middles) for mark in marks[:-2]]
    assert away[0] == pytest.approx(_CURB_M, abs=0.005)


def test_stations_without_ground_are_told_and_a_map_without_ground_is_refused(
    tmp_path: Path, street: Drive
) -> None:
    with pytest.raises(Unsuitable, match="No ground was measured"):
        export(
            _map(street), read_catalogue(path_of("catalogue/level500.toml")), "EPSG:6677",
            ExportRequest(("sections",), tmp_path),
        )  # fmt: skip
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(Unsuitable, match="larger than the sheet"):
        _written(tmp_path, (street,), section_scale="50", sheet_paper="A3", section_reach=50.0)
    assert list(tmp_path.iterdir()) == []


def test_stations_are_read_as_they_are_written() -> None:
    assert stations_in_words("35.2, No.1+15.20、No.2，3") == [35.2, 35.2, 40.0, 3.0]
    assert stations_in_words(" ") == []
    with pytest.raises(OutOfRange, match="A station can't be read"):
        stations_in_words("here")


def test_values_keep_their_distance_and_order() -> None:
    wanted = [0.0, 0.1, 0.2, 10.0, 19.9, 20.0]
    placed = spread_apart(wanted, 2.0, 0.0, 20.0)
    assert np.diff(placed).min() == pytest.approx(2.0)
    assert placed[0] == pytest.approx(0.0)
    assert placed[3] == pytest.approx(10.0)
    assert placed[-1] <= 20.0 + 1e-9
