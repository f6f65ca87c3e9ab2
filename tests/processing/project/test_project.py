"""The project's folder: made whole, opened once for writing, refused when damaged."""

from __future__ import annotations

import shutil
import sqlite3
from contextlib import closing

import numpy as np
import pyogrio
import pytest
import shapely

from processing.core.errors import BadFile, InUse, MissingInput, OutOfRange
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, PointReference, Vertex
from processing.project.project import Project, is_project

LABEL = Text("Draw", "作図")
LINE = Feature(
    "f1",
    "curb_lower",
    Geometry.LINE,
    (
        Vertex((-11380.123, -35124.456, 125.789), PointReference("left", 7)),
        Vertex((-11381.0, -35125.0, 125.5)),
    ),
    {"note": "縁石", "height_m": 0.15},
)


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / "国道 二四六号.zuka"
    project = Project.create(path, "EPSG:6677")
    project.features.apply(LABEL, Change(added=(LINE,)))
    project.close()
    return path


def test_what_was_drawn_is_there_again_to_the_last_bit(folder):
    project = Project.open(folder)
    assert list(project.features.all()) == [LINE]
    assert project.crs == "EPSG:6677"
    assert project.history.undo_label == LABEL
    project.close()


def test_gdal_reads_the_database_with_heights_attributes_and_reference_system(folder):
    path = folder / "project.gpkg"
    info = pyogrio.read_info(path, layer="features")
    assert info["crs"] == "EPSG:6677"
    _, _, blobs, _ = pyogrio.raw.read(path, layer="features")
    drawn = shapely.get_coordinates(shapely.from_wkb(blobs[0]), include_z=True)
    assert (drawn == np.array([vertex.xyz for vertex in LINE.vertices])).all()


def test_a_second_window_is_refused_and_told_who_has_it_but_reading_goes_on(folder):
    project = Project.open(folder)
    with pytest.raises(InUse) as refusal:
        Project.open(folder)
    assert "process" in refusal.value.line("en")
    reading = Project.open(folder, writing=False)
    assert len(reading.features) == 1
    reading.close()
    project.close()
    Project.open(folder).close()


def test_a_change_that_does_not_fit_is_a_defect_and_changes_nothing(folder):
    project = Project.open(folder)
    other = Feature("f2", "sign", Geometry.POINT, (Vertex((0.0, 0.0, 0.0)),))
    for change in (
        Change(added=(LINE,)),
        Change(removed=(other,)),
        Change(replaced=(Replacement(other, other),)),
        Change(added=(other, other)),
    ):
        with pytest.raises(ValueError, match=r".+"):
            project.features.apply(LABEL, change)
    assert list(project.features.all()) == [LINE]
    project.close()


def test_a_new_change_takes_the_place_of_what_was_undone(folder):
    project = Project.open(folder)
    project.features.undo()
    other = Feature("f2", "sign", Geometry.POINT, (Vertex((0.0, 0.0, 0.0)),))
    project.features.apply(LABEL, Change(added=(other,)))
    assert not project.history.can_redo
    assert project.features.redo() is None
    project.close()


def test_a_folder_without_a_project_and_a_place_in_use_are_said(tmp_path, folder):
    with pytest.raises(MissingInput):
        Project.open(tmp_path)
    with pytest.raises(InUse):
        Project.create(folder, "")
    with pytest.raises(OutOfRange):
        Project.create(tmp_path / "new.zuka", "EPSG:999999")
    assert not (tmp_path / "new.zuka").exists()


@pytest.mark.parametrize("damage", ["text", "empty", "cut", "foreign"])
def test_a_damaged_database_is_refused_in_one_sentence_and_left_as_it_was(folder, damage):
    path = folder / "project.gpkg"
    if damage == "foreign":
        path.unlink()
        with sqlite3.connect(path) as connection:
            connection.execute("CREATE TABLE other (a)")
            connection.execute("PRAGMA user_version = 3")
        connection.close()
    else:
        data = path.read_bytes()
        path.write_bytes({"text": b"no database" * 99, "empty": b"", "cut": data[:5000]}[damage])
    before = path.read_bytes()
    assert is_project(folder)
    for writing in (True, False):
        if damage == "empty" and writing:
            continue
        with pytest.raises(BadFile) as refusal:
            Project.open(folder, writing=writing)
        assert str(path) in refusal.value.line("ja")
    assert path.read_bytes() == before


def test_a_missing_drive_is_named_and_the_map_opens(folder):
    with sqlite3.connect(folder / "project.gpkg") as connection:
        connection.execute("INSERT INTO zuka_drives VALUES ('left-1', 0)")
    connection.close()
    with closing(Project.open(folder)) as project:
        (refusal,) = project.damaged_drives.values()
        assert list(project.features.all()) == [LINE]
    assert isinstance(refusal, MissingInput)
    assert "left-1" in refusal.where.en


def test_a_copied_project_opens_elsewhere(folder, tmp_path):
    copy = tmp_path / "copy.zuka"
    shutil.copytree(folder, copy)
    project = Project.open(copy)
    assert list(project.features.all()) == [LINE]
    project.close()
