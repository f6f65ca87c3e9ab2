"""A map is handed in as whole files: all of them, or the folder is as it was."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import pyogrio
import pytest
import shapely

from processing.core.errors import Cancelled, InUse, OutOfRange, Unsuitable, UserError
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.formats.registry import FORMATS
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, PointReference, Position, Provenance, Status, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of

_ALL = ("dxf", "csv", "gpkg", "geojson")
_EDGE = ((-11394.608, -35139.915, 25.682), (-11390.001, -35138.512, 25.703))
_LID = (*_EDGE, (-11390.1, -35138.0, 25.7))


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


@pytest.fixture
def street() -> tuple[Feature, ...]:
    return (
        _feature("edge", "road_edge", Geometry.LINE, *_EDGE),
        _feature("tree", "street_tree", Geometry.POINT, _EDGE[0], species="欅", girth_m=0.62),
        _feature("lid", "gutter_lid", Geometry.AREA, *_LID, status=Status.CANDIDATE),
        _feature("no", "sign", Geometry.POINT, _EDGE[1], status=Status.REJECTED),
    )


def _feature(
    id_: str,
    kind: str,
    geometry: Geometry,
    *positions: Position,
    status: Status = Status.ACCEPTED,
    **attributes: str | float,
) -> Feature:
    vertices = tuple(
        Vertex(position, PointReference("left", 10 + number))
        for number, position in enumerate(positions)
    )
    return Feature(id_, kind, geometry, vertices, attributes, status, Provenance())


def _request(folder: Path, *formats: str) -> ExportRequest:
    return ExportRequest(formats=formats or _ALL, folder=folder)


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def test_every_format_holds_the_same_measured_coordinates(
    tmp_path: Path, catalogue: Catalogue, street: tuple[Feature, ...]
) -> None:
    folder = tmp_path / "納品"
    paths = export(street, catalogue, "EPSG:6677", _request(folder))
    assert sorted(path.name for path in paths) == sorted(one.name for one in folder.iterdir())
    assert [path.name for path in paths] == [
        "features.dxf",
        "features.csv",
        "vertices.csv",
        "ledger_road_edge.csv",
        "ledger_street_tree.csv",
        "features.gpkg",
        "features.geojson",
    ]
    drawn = ezdxf.filemanagement.readfile(folder / "features.dxf")
    line: Any = drawn.modelspace().query("POLYLINE")[0]
    assert [tuple(vertex.dxf.location) for vertex in line.vertices] == list(_EDGE)
    rows = [row for row in _rows(folder / "vertices.csv") if row["地物ID"] == "edge"]
    axes = ("東距(Y) [m]", "北距(X) [m]", "標高(H) [m]")
    assert [tuple(float(row[axis]) for axis in axes) for row in rows] == list(_EDGE)
    assert [(row["走行データ"], row["点番号"]) for row in rows] == [("left", "10"), ("left", "11")]
    _, _, shapes, _ = pyogrio.raw.read(folder / "features.gpkg", layer="road_edge")
    stored = shapely.get_coordinates(shapely.from_wkb(shapes), include_z=True)
    assert [tuple(one) for one in stored.tolist()] == list(_EDGE)
    told = json.loads((folder / "features.geojson").read_text(encoding="utf-8"))
    assert [one["id"] for one in told["features"]] == ["edge", "tree"]
    assert [tuple(one) for one in told["features"][0]["geometry"]["coordinates"]] == list(_EDGE)


def test_candidates_are_handed_in_only_when_asked_for_and_rejected_ones_never(
    tmp_path: Path, catalogue: Catalogue, street: tuple[Feature, ...]
) -> None:
    request = _request(tmp_path, "csv")
    export(street, catalogue, "EPSG:6677", request)
    assert [row["地物ID"] for row in _rows(tmp_path / "features.csv")] == ["edge", "tree"]
    export(street, catalogue, "EPSG:6677", replace(request, candidates=True))
    rows = _rows(tmp_path / "features.csv")
    assert [(row["地物ID"], row["状態"]) for row in rows] == [
        ("edge", "採用"),
        ("tree", "採用"),
        ("lid", "候補"),
    ]


def test_the_language_the_digits_and_the_encoding_are_those_asked_for(
    tmp_path: Path, catalogue: Catalogue, street: tuple[Feature, ...]
) -> None:
    request = replace(
        _request(tmp_path, "csv"), language="en", options={"digits": 4, "encoding": "cp932"}
    )
    export(street, catalogue, "EPSG:6677", request)
    text = (tmp_path / "ledger_street_tree.csv").read_bytes().decode("cp932")
    assert text.startswith("Number,Route,Species")
    assert "欅" in text
    assert "-11394.6080" in text


def test_an_unknown_reference_system_is_said_while_working_and_in_the_files(
    tmp_path: Path, catalogue: Catalogue, street: tuple[Feature, ...]
) -> None:
    class Heard(SilentMonitor):
        def __init__(self) -> None:
            self.words: list[str] = []

        def report(self, fraction: float, text: Text | None = None) -> None:
            assert 0 <= fraction <= 1
            if text is not None:
                self.words.append(text.en)

    monitor = Heard()
    export(street, catalogue, "", _request(tmp_path), monitor)
    assert all("reference system is not known" in words for words in monitor.words)
    assert len(monitor.words) == len(_ALL)
    assert json.loads((tmp_path / "features.geojson").read_text(encoding="utf-8"))["crs"] is None
    assert _rows(tmp_path / "features.csv")[0]["座標参照系"] == "不明"
    assert pyogrio.read_info(tmp_path / "features.gpkg", layer="road_edge")["crs"] is None
    drawn = ezdxf.filemanagement.readfile(tmp_path / "features.dxf")
    assert drawn.header.custom_vars.properties == [("CRS", "unknown")]


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"formats": ("pdf",)}, "pdf"),
        ({"formats": ()}, "–"),
        ({"options": {"encoding": "latin-1"}}, "encoding=latin-1"),
        ({"options": {"dxf_version": "R14"}}, "dxf_version=R14"),
        ({"options": {"digits": 12}}, "digits=12"),
        ({"options": {"scale": 500}}, "scale"),
    ],
)
def test_a_request_that_cannot_be_met_is_refused_before_anything_is_written(
    tmp_path: Path,
    catalogue: Catalogue,
    street: tuple[Feature, ...],
    changes: dict[str, object],
    named: str,
) -> None:
    folder = tmp_path / "out"
    request = replace(_request(folder), **changes)  # type: ignore[arg-type]
    with pytest.raises(OutOfRange) as refusal:
        export(street, catalogue, "EPSG:6677", request)
    assert refusal.value.where.en == named
    assert not folder.exists()


def test_a_reference_system_that_there_is_not_is_refused(
    tmp_path: Path, catalogue: Catalogue, street: tuple[Feature, ...]
) -> None:
    with pytest.raises(OutOfRange) as refusal:
        export(street, catalogue, "EPSG:999999", _request(tmp_path / "out"))
    assert refusal.value.where.en == "EPSG:999999"


@pytest.mark.parametrize(
    "wrong",
    [
        _feature("x", "road_edge", Geometry.LINE, _EDGE[0]),
        _feature("x", "gutter_lid", Geometry.AREA, *_EDGE),
        _feature("x", "street_tree", Geometry.POINT),
        _feature("x", "street_tree", Geometry.POINT, (1.0, float("nan"), 2.0)),
        _feature("x", "unheard_of", Geometry.POINT, (1.0, 2.0, 3.0)),
    ],
)
def test_a_feature_that_is_none_is_named_and_nothing_is_written(
    tmp_path: Path, catalogue: Catalogue, street: tuple[Feature, ...], wrong: Feature
) -> None:
    with pytest.raises((Unsuitable, OutOfRange)) as refusal:
        export((*street, wrong), catalogue, "EPSG:6677", _request(tmp_path / "out"))
    assert "feature x" in refusal.value.where.en
    assert not (tmp_path / "out").exists()


def test_an_empty_map_gives_whole_files_without_features(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    paths = export((), catalogue, "EPSG:6677", _request(tmp_path))
    assert {path.suffix for path in paths} == {".dxf", ".csv", ".gpkg", ".geojson"}
    assert not len(ezdxf.filemanagement.readfile(tmp_path / "features.dxf").modelspace())
    assert json.loads((tmp_path / "features.geojson").read_text("utf-8"))["features"] == []
    assert len((tmp_path / "features.csv").read_text("utf-8-sig").splitlines()) == 1


def test_a_late_failure_leaves_the_files_of_the_last_export_as_they_were(
    tmp_path: Path, catalogue: Catalogue, street: tuple[Feature, ...]
) -> None:
    request = replace(_request(tmp_path), options={"encoding": "cp932"})
    export(street, catalogue, "EPSG:6677", request)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    changed = (*street, _feature("new", "street_tree", Geometry.POINT, _EDGE[0], species="𠮷"))
    with pytest.raises(OutOfRange):  # the ledger, after the drawing was written
        export(changed, catalogue, "EPSG:6677", request)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_cancelled_export_leaves_nothing(
    tmp_path: Path, catalogue: Catalogue, street: tuple[Feature, ...]
) -> None:
    class StopLate(SilentMonitor):
        def __init__(self) -> None:
            self.asked = 0

        def check(self) -> None:
            self.asked += 1
            if self.asked == 8:
                raise Cancelled

    monitor = StopLate()
    with pytest.raises(Cancelled):
        export(street, catalogue, "EPSG:6677", _request(tmp_path), monitor)
    assert monitor.asked == 8
    assert list(tmp_path.iterdir()) == []


def test_a_delivered_file_of_the_same_name_is_not_overwritten(
    tmp_path: Path, catalogue: Catalogue, street: tuple[Feature, ...]
) -> None:
    delivered = tmp_path / "vertices.csv"
    delivered.write_text("1,2,3")
    with pytest.raises(InUse):
        export(street, catalogue, "EPSG:6677", replace(_request(tmp_path), never=(delivered,)))
    assert [path.name for path in tmp_path.iterdir()] == ["vertices.csv"]
    assert delivered.read_text() == "1,2,3"


def test_a_file_in_the_place_of_the_folder_is_told(
    tmp_path: Path, catalogue: Catalogue, street: tuple[Feature, ...]
) -> None:
    position = tmp_path / "out"
    position.write_text("a file")
    with pytest.raises(UserError):
        export(street, catalogue, "EPSG:6677", _request(position))
    assert position.read_text() == "a file"


_FULL_DISK = """
import resource, signal, sys
from pathlib import Path
from processing.core.errors import UserError
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.operations.export import ExportRequest, export
from processing.map.feature import Feature, Vertex
from resources import path_of

catalogue = read_catalogue(path_of("catalogue/level500.toml"))
tree = Feature("t", "street_tree", Geometry.POINT, (Vertex((1.0, 2.0, 3.0)),), {"note": "n" * 9000})
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000))
try:
    export([tree], catalogue, "EPSG:6677", ExportRequest((sys.argv[1],), Path(sys.argv[2])))
except UserError as error:
    print(error.line("en"))
"""


@pytest.mark.parametrize("format_", _ALL)
def test_a_disk_that_takes_no_more_is_told_and_nothing_is_half_written(
    tmp_path: Path, format_: str
) -> None:
    folder = tmp_path / "out"
    done = subprocess.run(
        [sys.executable, "-c", _FULL_DISK, format_, str(folder)],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.count("|") >= 2, done.stderr
    assert list(folder.iterdir()) == []


def test_every_format_has_a_title_in_both_languages() -> None:
    assert tuple(one.id for one in FORMATS.maps()) == (
        *_ALL,
        "xlsx",
        "shp",
        "kmz",
        "dm",
        "sima",
        "sxf",
        "delivery",
        "sheets",
        "sections",
        "road",
        "las",
        "landxml",
        "opendrive",
        "qa",
    )
    for one in FORMATS.maps():
        assert one.map_title is not None
        assert one.map_title.en != one.map_title.ja
