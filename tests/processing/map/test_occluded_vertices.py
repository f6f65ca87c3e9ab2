"""Vertices without a measured point: kept, undone and redone."""

from __future__ import annotations

import json
import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from processing.map.change import Change, Replacement
from processing.map.feature import Feature
from processing.project.project import Project
from tests.processing.project.drawn import LABEL, curb, features_of, new_project


def _with_hidden(line: Feature, *numbers: int) -> Feature:
    return line.with_vertices(
        tuple(
            replace(vertex, measured=None, is_occluded=True) if number in numbers else vertex
            for number, vertex in enumerate(line.vertices)
        )
    )


def test_which_vertices_rest_on_no_point_is_kept_through_undo_and_reopening(tmp_path: Path) -> None:
    line = curb("a", vertices=5)
    hidden = _with_hidden(line, 1, 3)
    folder = new_project(tmp_path / "street.zuka", line)
    with closing(Project.open(folder)) as project:
        project.features.apply(LABEL, Change(replaced=(Replacement(line, hidden),)))
    with closing(Project.open(folder)) as project:
        assert features_of(project) == {"a": hidden}
        project.features.undo()
        assert features_of(project) == {"a": line}
        project.features.redo()
    with closing(Project.open(folder)) as project:
        assert features_of(project) == {"a": hidden}


def test_a_gis_program_reads_which_vertices_they_are(tmp_path: Path) -> None:
    folder = new_project(tmp_path / "street.zuka", _with_hidden(curb("a", vertices=5), 1, 3))
    with closing(sqlite3.connect(folder / "project.gpkg")) as connection:
        ((occluded,),) = connection.execute("SELECT occluded FROM features")
    assert json.loads(occluded) == [1, 3]
