"""The document: the only writer; refusals leave everything as it was."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from app.document.document import Document
from app.jobs.jobs import JobLane, JobQueue
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, Vertex
from processing.project.importing.importing import ImportRequest
from processing.tools.normals import NORMALS
from processing.tools.segments import SEGMENTS, SegmentsParameters
from tests.builders import simulated_drive, write_laz, write_trajectory_csv

SIGN = Feature("f1", "sign", Geometry.POINT, (Vertex((1.0, 2.0, 3.0)),))
LABEL = Text("Draw", "作図")
WAIT_MS = 30_000


@pytest.fixture
def jobs(qapp):
    return JobQueue()


@pytest.fixture
def document(jobs):
    document = Document(jobs)
    yield document
    jobs.close()
    document.close()
    document.tiles.close()


@pytest.fixture
def delivery(tmp_path):
    drive = simulated_drive(3)
    cloud = write_laz(drive, tmp_path / "左.laz")
    return ImportRequest((cloud,), (write_trajectory_csv(drive, tmp_path / "軌跡.csv"),))


def test_a_change_is_told_to_views_and_taken_back(document, tmp_path, qtbot):
    assert document.create(tmp_path / "p.zuka", "EPSG:6677")
    with qtbot.waitSignal(document.shared.map_changes.features_changed) as reported:
        assert document.apply(LABEL, Change(added=(SIGN,)))
    assert reported.args == [("f1",)]
    document.shared.selection.choose_features(frozenset({"f1"}))
    assert document.undo()
    assert document.shared.selection.features == frozenset()
    assert not list(document.features())
    assert document.redo()
    assert document.feature("f1") == SIGN
    assert not document.redo()


def test_an_imported_drive_is_shown_and_its_surfaces_are_prepared(
    document, delivery, tmp_path, qtbot
):
    columns = set()
    document.shared.map_changes.drive_columns_changed.connect(columns.add)
    job = document.import_into_new(tmp_path / "p.zuka", delivery)
    assert job
    with qtbot.waitSignal(document.shared.map_changes.drives_changed, timeout=WAIT_MS):
        pass
    (drive,) = document.drives()
    assert document.shared.view_settings.drive_id == drive.id
    wanted = {column.name for tool in (NORMALS, SEGMENTS) for column in tool.outputs}
    qtbot.waitUntil(lambda: all(drive.columns.has(name) for name in wanted), timeout=WAIT_MS)
    assert columns == {drive.id}


def test_what_was_prepared_does_not_replace_what_was_asked_for(
    document, jobs, delivery, tmp_path, qtbot
):
    document.import_into_new(tmp_path / "p.zuka", delivery)
    qtbot.waitUntil(lambda: bool(document.drives()), timeout=WAIT_MS)
    (drive,) = document.drives()
    qtbot.waitUntil(lambda: drive.columns.has("segment"), timeout=WAIT_MS)
    one_for_each = SegmentsParameters(distance_m=0.01, spacing_ratio=1.0, farthest_m=0.01)
    with qtbot.waitSignal(document.shared.map_changes.drive_columns_changed, timeout=WAIT_MS):
        document.start_run(SEGMENTS.id, drive.id, one_for_each)
    asked = np.array(drive.columns["segment"])
    ended = []
    jobs.finished.connect(lambda job, _: ended.append(job))
    prepared = document.start_run(
        SEGMENTS.id, drive.id, SegmentsParameters(), lane=JobLane.PREPARED
    )
    qtbot.waitUntil(lambda: prepared in ended, timeout=WAIT_MS)
    assert list((tmp_path / "p.zuka" / "tmp").iterdir()) == []
    np.testing.assert_array_equal(drive.columns["segment"], asked)


def test_an_import_that_is_refused_leaves_no_project(document, tmp_path, qtbot):
    damaged = tmp_path / "壊れた.laz"
    damaged.write_bytes(b"LASF" + bytes(300))
    with qtbot.waitSignal(document.refused, timeout=WAIT_MS) as reported:
        document.import_into_new(tmp_path / "p.zuka", ImportRequest((damaged,)))
    assert "壊れた.laz" in reported.args[0].line("ja")
    assert document.project is None
    assert not (tmp_path / "p.zuka").exists()


def test_an_import_that_is_refused_leaves_an_older_project_as_it_was(document, tmp_path, qtbot):
    document.create(tmp_path / "p.zuka", "EPSG:6677")
    document.apply(LABEL, Change(added=(SIGN,)))
    with qtbot.waitSignal(document.refused, timeout=WAIT_MS):
        document.import_files(ImportRequest((Path(tmp_path / "nothing.laz"),)))
    assert document.feature("f1") == SIGN
    assert document.drives() == ()


def test_a_project_that_cannot_be_opened_leaves_the_open_one(document, tmp_path, qtbot):
    document.create(tmp_path / "p.zuka", "")
    with qtbot.waitSignal(document.refused, timeout=30_000):
        assert not document.open(tmp_path / "nowhere.zuka")
    assert document.project.name == "p"


def test_the_reference_system_can_be_said_later_but_not_wrongly(document, tmp_path, qtbot):
    document.create(tmp_path / "p.zuka", "")
    assert document.crs() == ""
    with qtbot.waitSignal(document.refused, timeout=30_000):
        assert not document.set_reference_system("EPSG:1")
    assert document.set_reference_system("epsg:6677")
    assert document.crs() == "EPSG:6677"
