"""What tools find becomes features and a run, in one step, on the map and in files."""

from __future__ import annotations

import csv
import json
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import ezdxf
import numpy as np
import pyogrio
import pytest

from processing.core.errors import InUse, OutOfRange
from processing.core.monitor import SilentMonitor
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.formats.vectors.feature_files import write_feature_file
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import PointReference, Status
from processing.map.own_points import own_points
from processing.project.project import Project
from processing.project.results.found_features import found_features
from processing.tools.normals import NormalsParameters
from processing.tools.tool import Candidate, CandidateResult
from resources import path_of
from tests.processing.project.candidates import FINDER, STARTED, found, found_lines
from tests.processing.project.drawn import new_project

SIGN = Candidate("sign", "point", np.array([[1.0, 2.0, 3.0]]), np.array([-1]), 1.7, {})
LID = Candidate(
    "gutter_lid",
    "area",
    np.array([[0.0, 0.0, 1.0], [0.5, 0.0, 1.0], [0.5, 0.4, 1.0], [0.0, 0.4, 1.0]]),
    np.array([4, 5, -1, 7]),
    0.5,
    {"type": "lid"},
)


def test_candidates_become_features_that_know_where_they_come_from() -> None:
    made = found(CandidateResult((SIGN, LID)), drive="right")
    sign, lid = made.change.added
    assert (sign.geometry, lid.geometry) == (Geometry.POINT, Geometry.AREA)
    assert sign.status is lid.status is Status.CANDIDATE
    assert sign.provenance.confidence == 1.0
    assert lid.provenance.tool == "finder"
    assert lid.provenance.version == 3
    assert lid.provenance.parameters == {"radius_m": 0.2}
    assert lid.provenance.run == made.run.id
    measured = [vertex.measured for vertex in lid.vertices]
    assert measured == [
        PointReference("right", 4),
        PointReference("right", 5),
        None,
        PointReference("right", 7),
    ]
    assert lid.attributes == {"type": "lid"}
    assert made.run.summary.en == "Curbs: 2 candidates"
    assert made.run.drives == ("right",)


def test_candidates_keep_their_own_points_by_drive() -> None:
    numbers, drives = np.array([8, 3, 4, 11]), np.array([1, 0, 0, 1])
    tree = replace(SIGN, own_points=numbers, own_drives=drives)
    made = found_features(
        CandidateResult((tree, SIGN)),
        FINDER,
        NormalsParameters(),
        ("left", "right"),
        started=STARTED,
        finished=STARTED,
    )
    with_points, without = made.change.added
    assert with_points.own_points == (own_points("left", [3, 4]), own_points("right", [8, 11]))
    assert without.own_points == ()


@pytest.mark.parametrize(
    ("count", "words"),
    [(0, "Curbs: nothing found"), (1, "Curbs: 1 candidate"), (1214, "Curbs: 1,214 candidates")],
)
def test_a_run_says_what_came_of_it(count: int, words: str) -> None:
    assert found_lines(count).run.summary.en == words


def test_a_place_that_is_no_number_is_a_defect_of_the_tool() -> None:
    nowhere = Candidate("sign", "point", np.full((1, 3), np.nan), np.array([-1]), 0.5)
    with pytest.raises(ValueError, match="without a place"):
        found(CandidateResult((nowhere,)))


def test_the_run_and_its_candidates_are_one_step_of_the_history(tmp_path: Path) -> None:
    made = found_lines(5)
    with closing(Project.open(new_project(tmp_path / "p.zuka"))) as project:
        project.features.apply(made.run.summary, made.change, run=made.run)
    with closing(Project.open(tmp_path / "p.zuka")) as project:
        assert project.runs.all() == (made.run,)
        assert len(project.features) == 5
        assert project.history.additions_of(made.run.id) == made.change.added
        assert project.history.additions_of("another") == ()
        project.features.undo()
        assert len(project.features) == 0


def written(path: Path) -> Path:
    features = found(CandidateResult((SIGN, LID))).change.added
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    write_feature_file(path, features, catalogue, "EPSG:6677", SilentMonitor())
    return path


def test_a_geojson_says_kind_confidence_and_status_of_every_candidate(tmp_path: Path) -> None:
    members = json.loads(written(tmp_path / "結果.geojson").read_text("utf-8"))["features"]
    assert [one["properties"]["kind"] for one in members] == ["sign", "gutter_lid"]
    assert [one["properties"]["confidence"] for one in members] == [1.0, 0.5]
    assert {one["properties"]["status"] for one in members} == {"candidate"}
    assert members[1]["properties"]["type"] == "lid"
    assert members[0]["geometry"]["coordinates"] == [1.0, 2.0, 3.0]


def test_a_csv_has_the_columns_that_programs_expect(tmp_path: Path) -> None:
    with written(tmp_path / "a.csv").open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["kind"] for row in rows] == ["sign", "gutter_lid"]
    assert [float(row["confidence"]) for row in rows] == [1.0, 0.5]
    assert {row["status"] for row in rows} == {"candidate"}


def test_a_geopackage_has_a_layer_for_each_kind(tmp_path: Path) -> None:
    path = written(tmp_path / "a.gpkg")
    assert {name for name, _ in pyogrio.list_layers(path)} == {"sign", "gutter_lid"}


def test_a_dxf_has_every_candidate(tmp_path: Path) -> None:
    drawing = ezdxf.readfile(written(tmp_path / "a.dxf"))
    types = {entity.dxftype() for entity in drawing.modelspace()}
    assert "POLYLINE" in types


def test_another_ending_is_refused_with_those_there_are() -> None:
    with pytest.raises(OutOfRange) as refusal:
        FORMATS.format_to_write(Path("curbs.las"), Content.FEATURES)
    assert ".geojson" in refusal.value.remedy.en


def test_a_delivered_file_is_never_overwritten(tmp_path: Path) -> None:
    delivered = tmp_path / "a.csv"
    delivered.write_text("x,y,z\n")
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    with pytest.raises(InUse):
        write_feature_file(delivered, (), catalogue, "", SilentMonitor(), never=(delivered,))
    assert delivered.read_text() == "x,y,z\n"
