"""A SIMA file is read back by its description: comma text, Shift_JIS, X north."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from processing.core.text import Text
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Position, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of

_KP1 = (-7890.2, -36050.5, 12.345)
_RING = (_KP1, (-7880.0, -36050.5, 12.0), (-7880.0, -36040.0004, 12.0))

Point = tuple[str, float, float, float]


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _feature(kind: str, geometry: Geometry, *positions: Position, **own: Any) -> Feature:
    return Feature(f"id-{kind}", kind, geometry, tuple(map(Vertex, positions)), own)


def _written(
    folder: Path, catalogue: Catalogue, *features: Feature
) -> tuple[bytes, dict[str, Point], dict[str, list[str]], list[Text]]:
    notes: list[Text] = []
    (path,) = export(
        features, catalogue, "EPSG:6677", ExportRequest(("sima",), folder), tell=notes.append
    )
    assert path.suffix == ".sim"
    data = path.read_bytes()
    return data, *_read(data), notes


def _read(data: bytes) -> tuple[dict[str, Point], dict[str, list[str]]]:
    """Points by number (name, easting, northing, height), and parcels by name."""
    assert data.endswith(b",\r\n")
    lines = data.decode("cp932").split("\r\n")[:-1]
    assert all(line.endswith(",") and "\n" not in line for line in lines)
    records = [line.split(",")[:-1] for line in lines]
    assert [one[:2] for one in records[:3]] == [["G00", "01"], ["Z00", "座標ﾃﾞｰﾀ"], ["A00"]]
    points: dict[str, Point] = {}
    parcels: dict[str, list[str]] = {}
    corners: list[str] | None = None
    for code, *fields in records[3:]:
        match code:
            case "A01":
                number, name, x, y, z = fields
                assert len(x.partition(".")[2]) == 3
                points[number] = (name, float(y), float(x), float(z))
            case "D00":
                assert corners is None
                assert fields[2] == "1"
                corners = parcels.setdefault(fields[1], [])
            case "B01":
                assert corners is not None
                assert points[fields[0]][0] == fields[1]
                corners.append(fields[0])
            case "D99":
                corners = None
            case _:
                assert code in ("A99", "Z00")
    assert len({one[0] for one in points.values()}) == len(points)
    assert all(len(one[0].encode("cp932")) <= 16 for one in points.values())
    return points, parcels


def test_points_and_closed_parcels_are_read_with_x_north(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    stake = _feature("boundary_stake", Geometry.POINT, _KP1, number="KP1")
    parcel = _feature("building", Geometry.AREA, *_RING, number="848-1")
    data, points, parcels, notes = _written(tmp_path, catalogue, stake, parcel)
    assert "A01,1,KP1,-36050.500,-7890.200,12.345,\r\n".encode("cp932") in data
    assert points["1"] == ("KP1", *_KP1)
    assert parcels == {"848-1": ["1", "2", "3"]}
    assert [points[one][1:] for one in ("2", "3")] == [_RING[1], (-7880.0, -36040.0, 12.0)]
    assert notes == []


def test_names_are_short_different_and_without_commas(tmp_path: Path, catalogue: Catalogue) -> None:
    names = ("電柱,1", "電柱,1", "とても長い名前の電柱です", "", "")
    poles = [_feature("power_pole", Geometry.POINT, _KP1, number=name) for name in names]
    _, points, _, notes = _written(tmp_path, catalogue, *poles)
    assert [one[0] for one in points.values()] == [
        "電柱 1", "電柱 1-1", "とても長い名前の", "電力柱-1", "電力柱-2"
    ]  # fmt: skip
    assert [note.en for note in notes] == [
        "Texts are longer than the format holds and were cut:"
        " “とても長い名前の電柱です” → “とても長い名前の”."
    ]


def test_lines_and_many_corners_are_told(tmp_path: Path, catalogue: Catalogue) -> None:
    edge = _feature("road_edge", Geometry.LINE, *_RING)
    many = [(float(at), float(at * at), 1.0) for at in range(99)]
    _, points, parcels, notes = _written(
        tmp_path, catalogue, edge, _feature("building", Geometry.AREA, *many, number="A")
    )
    assert len(points) == len(parcels["A"]) == 99
    assert [note.en for note in notes] == [
        "Not in the SIMA file, which has no open lines: 1 of Road edge; hand those in as DXF.",
        "Some programs divide parcels of more than 98 corners: A.",
    ]


def test_a_map_without_features_is_a_file_without_points(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    data, points, parcels, _ = _written(tmp_path, catalogue)
    assert (points, parcels) == ({}, {})
    assert data.splitlines()[-1] == b"A99,"
