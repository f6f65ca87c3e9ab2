"""Labels in the map's history: done, taken back, done again; with features, after damage."""

from __future__ import annotations

import shutil
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import BadFile
from processing.core.text import Text
from processing.labels.label_column import labels_of
from processing.map.change import Change
from processing.map.label_change import LabelChange, label_changes
from processing.project.project import Project
from processing.recording.columns.columns import column_path
from tests.processing.project.drawn import sign
from tests.processing.project.labelled import (
    PAINT,
    all_labels,
    labelled_project,
    paint,
    painting,
)


@pytest.fixture(scope="module")
def street(tmp_path_factory) -> Path:
    return labelled_project(tmp_path_factory.mktemp("street"))


@pytest.fixture
def folder(street, tmp_path) -> Path:
    return Path(shutil.copytree(street, tmp_path / "街路.zuka"))


def test_painted_labels_are_taken_back_and_done_again(folder):
    with closing(Project.open(folder)) as project:
        (drive,) = project.drives
        paint(project, range(100, 300), 11)
        paint(project, range(200, 400, 3), 67)
        painted = all_labels(drive)
        assert (painted[100:200] == 11).all()
        assert (painted[200:400:3] == 67).all()
        assert painted[401:].max() == 0
        project.features.undo()
        assert (all_labels(drive)[100:300] == 11).all()
        project.features.undo()
        assert not all_labels(drive).any()
        assert project.history.undo_label == Text("Import street", "street のインポート")
        project.features.redo()
        project.features.redo()
        np.testing.assert_array_equal(all_labels(drive), painted)
    with closing(Project.open(folder)) as project:
        np.testing.assert_array_equal(all_labels(project.drives[0]), painted)
        assert project.history.undo_label == PAINT
        project.features.undo()
        assert (all_labels(project.drives[0])[100:300] == 11).all()


def test_a_step_may_change_features_and_labels_together(folder):
    with closing(Project.open(folder)) as project:
        (drive,) = project.drives
        both = Change(added=(sign("a"),), labels=painting(drive, [1, 2, 9], 6).labels)
        inverse = project.features.apply(Text("Both", "両方"), both)
        assert inverse.inverse() == both
        assert project.features.undo() == inverse
        assert len(project.features) == 0
        assert not all_labels(drive).any()
        assert project.features.redo() == both
        assert labels_of(drive, np.array([1, 2, 9])).tolist() == [6, 6, 6]


def test_what_was_taken_back_is_gone_for_good_after_another_step(folder):
    with closing(Project.open(folder)) as project:
        paint(project, range(50), 11)
        paint(project, range(50), 2)
        project.features.undo()
        project.features.apply(PAINT, Change(added=(sign("a"),)))
        assert not project.history.can_redo
        rows = project._database.rows("SELECT DISTINCT place FROM zuka_history_labels")
        assert rows == [(2,)]


def test_points_that_have_the_label_already_are_no_part_of_a_change(folder):
    with closing(Project.open(folder)) as project:
        paint(project, range(50), 11)
        (change,) = painting(project.drives[0], range(40, 60), 11).labels
        assert change.count == 10
        assert painting(project.drives[0], range(50), 11).is_empty


def test_a_change_of_other_labels_than_there_are_does_not_fit(folder):
    with closing(Project.open(folder)) as project:
        (drive,) = project.drives
        late = painting(drive, range(50), 11)
        paint(project, [7], 2)
        gone = Change(labels=(LabelChange.of("gone", *_codes([1], [0], [3])),))
        beyond = Change(labels=(LabelChange.of(drive.id, *_codes([drive.count], [0], [3])),))
        twice = Change(labels=painting(drive, [99], 3).labels * 2)
        for change in (late, gone, beyond, twice):
            assert not project.features.fits(change)
            with pytest.raises(ValueError, match="does not fit"):
                project.features.apply(PAINT, change)
        assert all_labels(drive).sum() == 2


def _codes(points, before, after):
    return np.array(points), np.array(before, np.uint8), np.array(after, np.uint8)


def test_a_label_change_refuses_codes_that_are_not_one_for_each_point():
    with pytest.raises(ValueError, match="points have"):
        LabelChange.of("a", *_codes([1, 2], [0], [3]))
    good = LabelChange.of("a", *_codes([1, 2], [0, 0], [3, 3]))
    with pytest.raises(ValueError, match="of 5 points"):
        LabelChange("a", 5, good.points, good.before, good.after).unpacked_points()
    with pytest.raises(ValueError, match="for 5 points"):
        LabelChange("a", 5, good.points, good.before, good.after).codes_after()


def test_very_many_points_become_several_changes_with_all_points(monkeypatch):
    monkeypatch.setattr("processing.map.label_change.MOST_POINTS", 10)
    points = np.arange(0, 70, 2)
    changes = label_changes("a", points, np.zeros(points.size, np.uint8), 5)
    assert [change.count for change in changes] == [10, 10, 10, 5]
    joined = np.concatenate([change.unpacked_points() for change in changes])
    np.testing.assert_array_equal(joined, points)


def test_a_damaged_column_is_refused_in_one_sentence_and_nothing_changes(folder):
    with closing(Project.open(folder)) as project:
        (drive,) = project.drives
        paint(project, range(50), 11)
        change = painting(drive, range(100, 120), 2)
        path = column_path(drive.folder, "label")
        path.write_bytes(path.read_bytes()[:-1])
    with closing(Project.open(folder)) as project:
        position = project.history.position
        assert project.features.fits(change)
        with pytest.raises(BadFile) as refusal:
            project.features.apply(PAINT, change)
        assert "label.bin" in refusal.value.where.en
        with pytest.raises(BadFile):
            project.features.undo()
        assert project.history.position == position


def test_where_the_column_can_not_be_made_the_step_is_not_done(folder):
    with closing(Project.open(folder)) as project:
        (drive,) = project.drives
        # A directory where the file is to be written first.
        (drive.folder / "label.part").mkdir()
        with pytest.raises(BadFile):
            paint(project, range(50), 11)
        assert project.history.undo_label != PAINT
        assert not drive.columns.has("label")
        (drive.folder / "label.part").rmdir()
        paint(project, range(50), 11)
        assert (all_labels(drive)[:50] == 11).all()


def test_where_the_column_can_not_be_written_the_step_is_taken_back(folder):
    with closing(Project.open(folder)) as project:
        paint(project, range(50), 11)
    with closing(Project.open(folder)) as project:
        (drive,) = project.drives
        path = column_path(drive.folder, "label")
        kept = drive.folder / "kept"
        change = painting(drive, range(60, 70), 2)
        path.rename(kept)
        path.mkdir()
        (path / "in the way").touch()
        with pytest.raises(BadFile):
            project.features.apply(PAINT, Change(added=(sign("a"),), labels=change.labels))
        assert project.history.undo_label == PAINT
        assert project.history.position == 2
        assert len(project.features) == 0
        shutil.rmtree(path)
        with drive.columns.replacing("label"):
            kept.rename(path)
        project.features.undo()
        assert not all_labels(drive).any()


def test_damaged_packed_labels_are_told_as_a_damaged_project(folder):
    with closing(Project.open(folder)) as project:
        paint(project, range(50), 11)
        with project._database.transaction() as connection:
            connection.execute("UPDATE zuka_history_labels SET points = 'text'")
        with pytest.raises(BadFile):
            project.features.undo()
        assert (all_labels(project.drives[0])[:50] == 11).all()
