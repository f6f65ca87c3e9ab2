"""Features in memory and in the database are the same, whatever happens."""

from __future__ import annotations

import dataclasses
import math
import sqlite3
from contextlib import closing
from datetime import UTC, datetime

import pyogrio
import pytest

from processing.core.errors import BadFile
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, PointReference, Vertex
from processing.project.project import Project
from processing.project.store.geometry_blob import positions_of
from processing.project.store.runs import Run, new_run_id
from tests.processing.project.drawn import (
    LABEL,
    curb,
    features_of,
    new_project,
    sign,
    tree_of,
    with_own_points,
)


@pytest.fixture
def folder(tmp_path):
    return new_project(tmp_path / "a.zuka", curb("c"))


def extent(folder):
    info = pyogrio.read_info(folder / "project.gpkg", layer="features")
    return info["total_bounds"]


def test_the_extent_follows_what_is_drawn_moved_and_removed(tmp_path):
    folder = new_project(tmp_path / "a.zuka")
    with closing(Project.open(folder)) as project:
        near, far = sign("near", 10.0, 20.0), sign("far", 900.0, 5.0)
        project.features.apply(LABEL, Change(added=(near, far)))
        assert extent(folder) == (10.0, 5.0, 900.0, 20.0)
        moved = sign("far", 30.0, 40.0)
        project.features.apply(LABEL, Change(replaced=(Replacement(far, moved),)))
        assert extent(folder) == (10.0, 20.0, 30.0, 40.0)
        project.features.apply(LABEL, Change(removed=(moved,)))
        assert extent(folder) == (10.0, 20.0, 10.0, 20.0)
        project.features.undo()
        project.features.undo()
        assert extent(folder) == (10.0, 5.0, 900.0, 20.0)
    with closing(Project.open(folder)) as project:
        project.features.undo()
        assert extent(folder) is None
        assert len(project.features) == 0


def test_layers_of_the_catalogue_stand_in_the_table(folder):
    fields = pyogrio.raw.read(folder / "project.gpkg", layer="features", columns=["layer"])[3]
    with closing(Project.open(folder, writing=False)) as project:
        assert fields[0].tolist() == [project.catalogue["curb_lower"].layer]


@pytest.mark.parametrize(
    "broken",
    [
        sign("b", math.nan),
        sign("b", math.inf),
        dataclasses.replace(sign("b"), vertices=()),
        dataclasses.replace(sign("b"), vertices=sign("b").vertices * 2),
        dataclasses.replace(curb("b"), vertices=curb("b").vertices[:1]),
        dataclasses.replace(curb("b"), geometry=Geometry.AREA),
        dataclasses.replace(sign("b"), attributes={"height_m": math.nan}),
    ],
)
def test_what_cannot_be_stored_is_a_defect_and_changes_nothing(folder, broken):
    with closing(Project.open(folder)) as project:
        before = tree_of(folder)
        with pytest.raises(ValueError, match=r".+"):
            project.features.apply(LABEL, Change(added=(sign("a"), broken)))
        assert features_of(project) == {"c": curb("c")}
        assert tree_of(folder) == before
        project.features.apply(LABEL, Change(added=(sign("a"),)))
        assert project.history.position == 2


def test_measured_points_of_several_drives_come_back_each_at_its_vertex(tmp_path):
    line = Feature(
        "l",
        "curb_lower",
        Geometry.LINE,
        (
            Vertex((0.1, 0.2, 0.3), PointReference("left", 2**40)),
            Vertex((1.0, 1.0, 1.0)),
            Vertex((2.0, 2.0, 2.0), PointReference("right", 0)),
            Vertex((3.0, 3.0, 3.0), PointReference("left", 1)),
        ),
    )
    folder = new_project(tmp_path / "a.zuka", line)
    with closing(Project.open(folder)) as project:
        assert features_of(project) == {"l": line}
        project.features.undo()
        project.features.redo()
        assert features_of(project) == {"l": line}


def test_own_points_come_back_and_are_undone_with_their_feature(tmp_path):
    tree = with_own_points("tree", ("left", [3, 4, 5, 90]), ("right", [2**40]))
    folder = new_project(tmp_path / "a.zuka", tree)
    with closing(Project.open(folder)) as project:
        assert features_of(project) == {"tree": tree}
        project.features.undo()
        assert features_of(project) == {}
        project.features.redo()
    with closing(Project.open(folder, writing=False)) as project:
        assert features_of(project) == {"tree": tree}


def test_a_change_by_another_program_is_noticed_and_not_overwritten(folder):
    with closing(Project.open(folder)) as project:
        with sqlite3.connect(folder / "project.gpkg") as gis:
            gis.execute('UPDATE features SET attributes = \'{"note":"QGIS"}\'')
        gis.close()
        moved = curb("c", vertices=3)
        for _ in range(2):
            with pytest.raises(BadFile, match="Another program"):
                project.features.apply(LABEL, Change(replaced=(Replacement(curb("c"), moved),)))
    with closing(Project.open(folder)) as project:
        assert features_of(project)["c"].attributes == {"note": "QGIS"}
        with pytest.raises(BadFile, match="Another program"):
            project.features.undo()
        assert features_of(project)["c"].attributes == {"note": "QGIS"}


def test_what_another_program_writes_beside_the_features_does_no_harm(folder):
    with closing(Project.open(folder)) as project:
        with sqlite3.connect(folder / "project.gpkg") as gis:
            gis.execute("CREATE TABLE layer_styles (name TEXT)")
        gis.close()
        project.features.apply(LABEL, Change(added=(sign("a"),)))
        assert set(features_of(project)) == {"a", "c"}


def test_a_spatial_index_made_by_a_gis_program_follows_the_drawing(folder):
    with sqlite3.connect(folder / "project.gpkg") as gis:
        gis.execute("CREATE VIRTUAL TABLE rtree_features_geom USING rtree(id, x0, x1, y0, y1)")
        gis.execute(
            "CREATE TRIGGER rtree_features_geom_insert AFTER INSERT ON features"
            " WHEN NEW.geom NOT NULL AND NOT ST_IsEmpty(NEW.geom) BEGIN"
            " INSERT INTO rtree_features_geom VALUES (NEW.fid, ST_MinX(NEW.geom),"
            " ST_MaxX(NEW.geom), ST_MinY(NEW.geom), ST_MaxY(NEW.geom)); END"
        )
    gis.close()
    with closing(Project.open(folder)) as project:
        project.features.apply(LABEL, Change(added=(sign("a", 8.0, 16.0),)))
    with closing(sqlite3.connect(folder / "project.gpkg")) as gis:
        boxes = gis.execute("SELECT x0, x1, y0, y1 FROM rtree_features_geom").fetchall()
    assert boxes == [(8.0, 8.0, 16.0, 16.0)]


def test_a_feature_moved_by_a_gis_program_is_read(tmp_path):
    folder = new_project(tmp_path / "a.zuka", curb("c"))
    path = folder / "project.gpkg"
    with sqlite3.connect(path) as gis:
        (blob,) = gis.execute("SELECT geom FROM features").fetchone()
        # Other programs put the envelope before the geometry.
        enveloped = blob[:3] + bytes([blob[3] | 2]) + blob[4:8] + bytes(32) + blob[8:]
        gis.execute("UPDATE features SET geom = ?", (enveloped,))
    gis.close()
    assert positions_of(enveloped) == positions_of(blob)
    with closing(Project.open(folder)) as project:
        assert features_of(project) == {"c": curb("c")}


def test_a_run_is_stored_with_its_candidates_and_stays_when_they_are_taken_back(folder):
    moment = datetime(2026, 4, 1, 9, 30, tzinfo=UTC)
    run = Run(
        new_run_id(),
        "curbs",
        2,
        {"step_m": 0.05},
        ("left", "right"),
        moment,
        moment.replace(minute=31),
        Text("Curbs: 1 candidate", "縁石: 候補1件"),
    )
    with closing(Project.open(folder)) as project:
        project.features.apply(run.summary, Change(added=(curb("d"),)), run=run)
        other = dataclasses.replace(run, id=new_run_id())
        project.runs.add(other)
        project.features.undo()
        assert set(features_of(project)) == {"c"}
    with closing(Project.open(folder, writing=False)) as project:
        assert project.runs.all() == (run, other)
        assert project.runs.get(other.id) == other
        assert project.runs.get("none") is None


def test_a_run_is_not_stored_when_its_change_does_not_fit(folder):
    moment = datetime(2026, 4, 1, tzinfo=UTC)
    run = Run(new_run_id(), "curbs", 1, {}, (), moment, moment, Text.same("x"))
    with closing(Project.open(folder)) as project:
        with pytest.raises(ValueError, match="does not fit"):
            project.features.apply(LABEL, Change(added=(curb("c"),)), run=run)
        assert project.runs.all() == ()


def test_settings_are_kept_by_name(folder):
    with closing(Project.open(folder)) as project:
        project.settings.put("view", {"attribute": "height", "sizes": [1, 2.5, None]})
        project.settings.put("view", {"attribute": "intensity"})
    with closing(Project.open(folder, writing=False)) as project:
        assert project.settings.get("view") == {"attribute": "intensity"}
        assert project.settings.get("none") is None
