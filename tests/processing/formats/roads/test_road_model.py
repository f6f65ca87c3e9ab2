"""The road model of a road that is known exactly, written in every form."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import openpyxl
import pytest
from lxml import etree

from processing.core.errors import UserError
from processing.core.text import Language, Text
from processing.formats.pictures.paper_svg import paper_svg
from processing.formats.roads.diagrams import Axis, known_parts
from processing.formats.sheets.paper_shapes import PaperLine, PaperWords, Pen
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Vertex
from processing.operations.export import ExportRequest, export
from processing.recording.drive import Drive
from resources import path_of
from tests.processing.methods.road.bad_recordings import (
    HEAD_90,
    ORIGIN,
    DrivenRecording,
    RoadCrossSection,
    delivered,
    drawn_along,
    facing_along,
    imported,
    road_along,
    straight,
)

LENGTH_M, FALL = 44.0, 0.02
CROWNED: RoadCrossSection = (
    (-7.0, 0.09), (-4.02, 0.07), (-4.0, -0.08), (0.0, 0.0), (4.0, -0.08), (4.02, 0.07), (7.0, 0.09),
)  # fmt: skip
CATALOGUE = read_catalogue(path_of("catalogue/level500.toml"))


def line(id_: str, kind: str, north: float, east: float = LENGTH_M) -> Feature:
    ends = [ORIGIN + np.array([x, north, 0.0]) for x in np.arange(0.0, east + 0.5, 4.0)]
    vertices = tuple(Vertex((float(x), float(y), float(z))) for x, y, z in ends)
    return Feature(id_, kind, Geometry.LINE, vertices, {})


CURBS = (line("l", "curb_lower", 4.0), line("r", "curb_lower", -4.0))


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    folder = tmp_path_factory.mktemp("road")
    way = straight(LENGTH_M, 10.0)
    beam = drawn_along(((1.0, 3.6), (3.0, 3.6)), np.array([[20.0, 0.0], [23.0, 0.0]]))
    scene = (road_along(LENGTH_M, CROWNED), beam)
    recording = DrivenRecording(way, facing_along(way), scene, head=HEAD_90, pulses=900)
    return imported(folder, delivered(recording, folder))


def written(
    folder: Path,
    features: tuple[Feature, ...],
    drives: tuple[Drive, ...],
    language: Language = "en",
    told: list[Text] | None = None,
) -> Path:
    request = ExportRequest(("road",), folder, language, {"road_pitch": 10.0})
    tell = (told if told is not None else []).append
    export(features, CATALOGUE, "EPSG:6677", request, drives=drives, tell=tell)
    return folder


def rows_of(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(path.read_text("utf-8-sig"))))


def test_a_road_without_a_drawn_line_is_measured_between_its_curbs(
    drives: tuple[Drive, ...], tmp_path: Path
) -> None:
    told: list[Text] = []
    folder = written(tmp_path / "out", CURBS, drives, told=told)
    assert {one.name for one in folder.iterdir()} == {
        "road.csv", "road_clearance.csv", "road.xlsx", "road.pdf", "road.svg", "road.png",
    }  # fmt: skip
    assert any("made midway" in one.en for one in told)
    for row in rows_of(folder / "road.csv")[1:-1]:
        assert float(row["Carriageway [m]"]) == pytest.approx(8.0, abs=0.01)
        for side in ("left", "right"):
            assert float(row[f"Crossfall, {side} [%]"]) == pytest.approx(100 * FALL, abs=0.1)
        assert float(row["Longitudinal slope [%]"]) == pytest.approx(0.0, abs=0.05)
        assert float(row["Height [m]"]) == pytest.approx(ORIGIN[2], abs=0.02)
        assert row["Walk, left [m]"] == row["Shoulder, left [m]"] == ""
    (place,) = rows_of(folder / "road_clearance.csv")
    assert float(place["Lowest [m]"]) == pytest.approx(3.6 + 0.02, abs=0.03)
    assert place["What"] == "Structure"
    assert 19.0 < float(place["From [m]"]) < float(place["To [m]"]) < 24.0


def test_a_drawn_line_with_its_walks_and_markings(
    drives: tuple[Drive, ...], tmp_path: Path
) -> None:
    centre = replace(line("c", "road_center", 0.0), attributes={"route": "市道1号線"})
    beside = (line("m", "marking_line", 3.2), line("e", "road_edge", 6.5))
    folder = written(tmp_path / "out", (*CURBS, centre, *beside), drives, "ja")
    row = rows_of(folder / "road.csv")[1]
    assert row["路線名"] == "市道1号線"
    assert float(row["歩道幅員（左）[m]"]) == pytest.approx(2.5)
    assert float(row["路肩幅員（左）[m]"]) == pytest.approx(0.8)
    book = openpyxl.load_workbook(folder / "road.xlsx")
    assert book.sheetnames == ["道路モデル", "建築限界"]
    svg = (folder / "road.svg").read_text("utf-8")
    assert "横断勾配" in svg
    assert etree.fromstring(svg.encode()).tag.endswith("svg")
    picture = cv2.imread(str(folder / "road.png"))
    assert picture is not None
    assert picture.min() < 100 < picture.mean()


def test_one_side_alone_leaves_widths_empty_and_says_so(
    drives: tuple[Drive, ...], tmp_path: Path
) -> None:
    told: list[Text] = []
    features = (CURBS[0], line("c", "road_center", 0.0))
    row = rows_of(written(tmp_path / "out", features, drives, told=told) / "road.csv")[1]
    assert row["Carriageway [m]"] == row["Crossfall, right [%]"] == ""
    assert float(row["Carriageway, left [m]"]) == pytest.approx(4.0)
    assert any("no edge on one side" in one.en for one in told)


def test_a_line_without_points_has_widths_and_no_heights(tmp_path: Path) -> None:
    told: list[Text] = []
    features = (*CURBS, line("c", "road_center", 0.0))
    row = rows_of(written(tmp_path / "out", features, (), told=told) / "road.csv")[1]
    assert float(row["Carriageway [m]"]) == pytest.approx(8.0)
    assert row["Height [m]"] == row["Longitudinal slope [%]"] == ""
    assert any("no surface was measured" in one.en for one in told)


@pytest.mark.parametrize("features", [(), (CURBS[0],)])
def test_without_a_line_that_can_be_made_nothing_is_written(
    drives: tuple[Drive, ...], tmp_path: Path, features: tuple[Feature, ...]
) -> None:
    with pytest.raises(UserError) as refused:
        written(tmp_path / "out", features, drives)
    assert "centre line" in refused.value.what.en
    assert not list(tmp_path.rglob("road*"))


def test_axes_have_round_ticks_and_curves_know_their_gaps() -> None:
    assert Axis(0.0, 5.5).ticks().tolist() == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    assert len(Axis.around(np.array([np.nan]), 2.0).ticks()) >= 3
    parts = known_parts(np.array([np.nan, 1.0, 2.0, np.nan, 3.0]))
    assert [(one.start, one.stop) for one in parts] == [(1, 3), (4, 5)]


def test_words_of_a_paper_are_escaped_in_svg() -> None:
    shapes = (
        PaperWords(Pen("A"), "幅員 < 4 m & more", (10.0, 10.0), 3.0),
        PaperLine(Pen("A", dash_mm=(2.0, 1.0)), ((0.0, 0.0), (5.0, 5.0))),
    )
    root = etree.fromstring(paper_svg(shapes, (100.0, 50.0)).encode())
    (words,) = root.iter("{http://www.w3.org/2000/svg}text")
    assert words.text == "幅員 < 4 m & more"
    (drawn,) = root.iter("{http://www.w3.org/2000/svg}polyline")
    assert drawn.get("stroke-dasharray") == "2,1"
    assert drawn.get("points") == "0.000,50.000 5.000,45.000"
