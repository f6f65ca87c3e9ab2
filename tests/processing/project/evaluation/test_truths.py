"""Truths made of classes as they stand, and of files; runs judged by them; counts by hand."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import BadFile, Cancelled
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.image.search.clip import Clip
from processing.labels.label_column import make_column, write_labels
from processing.project.evaluation.class_evaluation import error_map_columns, evaluate_classes
from processing.project.evaluation.truth_making import truth_as_it_stands
from processing.project.evaluation.truth_of_file import coded_truth, truth_of_file
from processing.project.evaluation.truth_store import Truth, TruthStore, has_truth, read_truth
from processing.project.importing.importing import ImportRequest
from processing.project.importing.importing import import_drives as imported
from processing.project.project import Project
from processing.project.results.run_findings import (
    adopt_finding,
    finding_path,
    has_finding,
    read_finding,
    write_finding,
)
from processing.project.store.runs import Run
from processing.recording.columns.columns import ColumnWriter
from processing.recording.columns.error_map import ERROR_MAP, ErrorMapValue
from processing.recording.drive import Drive
from processing.tools.listed.registry import TOOLS
from processing.tools.tool import FinishedColumns
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.monitors import CancelledAfter

SILENT = SilentMonitor()
NAME = Text("by hand", "手動")
NOW = datetime(2024, 5, 1, 12, tzinfo=UTC)
LOW, HIGH, SIGN = 7, 18, 65


@pytest.fixture
def project(tmp_path: Path) -> Iterator[Project]:
    street = simulated_drive(3, length_m=2.0)
    street.columns["classification"][:] = np.arange(street.count) % 3
    cloud = write_laz(street, tmp_path / "左.laz")
    way = write_trajectory_csv(street, tmp_path / "軌跡.csv")
    project = Project.create(tmp_path / "p.zuka", "EPSG:6677")
    into = project.temporary_folder()
    into.mkdir(parents=True)
    project.adopt_drives(imported(ImportRequest((cloud,), (way,)), into, SILENT))
    yield project
    project.close()


@pytest.fixture
def drive(project: Project) -> Drive:
    return project.drives[0]


def label(drive: Drive, points: NDArray[np.int64], code: int) -> None:
    make_column(drive)
    with drive.columns.replacing("label"):
        write_labels(drive, points, np.full(points.size, code, np.uint8))


def keep(
    project: Project, truth: str, *, clip: Clip | None = None, only_painted: bool = False
) -> Truth:
    (drive,) = project.drives
    into = project.temporary_folder()
    made = truth_as_it_stands((drive,), into, SILENT, clip=clip, only_painted=only_painted)
    kept = Truth(truth, NAME, dict(made.known), NOW)
    TruthStore(project.settings).add(kept, made.folders, project.drive)
    return kept


def run_that_says(project: Project, run: str, is_noise: NDArray[np.bool_]) -> Run:
    """A run of the tool that is remembered to have called these points noise."""
    (drive,) = project.drives
    into = project.temporary_folder()
    into.mkdir(parents=True)
    with ColumnWriter(into) as writer:
        writer.append({"classification": np.where(is_noise, HIGH, 1).astype(np.uint8)})
    result = FinishedColumns(into, ("classification",), drive.count)
    write_finding(result, {LOW, HIGH}, into / "said")
    adopt_finding(drive, TOOLS["noise"], run, into / "said")
    return Run(run, "noise", 1, {"method": "radius"}, (drive.id,), NOW, NOW, NAME)


def all_of(drive: Drive, truth: str) -> NDArray[np.uint8]:
    return read_truth(drive, truth, 0, drive.count)


def test_classes_as_they_stand_are_labels_over_what_was_delivered(
    project: Project, drive: Drive
) -> None:
    delivered = np.asarray(drive.columns["classification"])
    label(drive, np.arange(10, 20), HIGH)
    kept = keep(project, "a")
    expected = np.maximum(delivered, 1)
    expected[10:20] = HIGH
    np.testing.assert_array_equal(all_of(drive, "a"), expected)
    assert kept.points == drive.count


def test_outside_of_the_clip_nothing_is_known(project: Project, drive: Drive) -> None:
    xyz = drive.xyz(slice(None))
    middle = np.median(xyz[:, 2])
    clip = Clip(((0.0, 0.0, 1.0, float(middle)),))
    kept = keep(project, "a", clip=clip)
    np.testing.assert_array_equal(all_of(drive, "a") > 0, xyz[:, 2] >= middle)
    assert kept.points == (xyz[:, 2] >= middle).sum()


def test_painted_points_are_known_but_not_those_that_a_run_labelled(
    project: Project, drive: Drive
) -> None:
    said = np.zeros(drive.count, np.bool_)
    said[100:200] = True
    run_that_says(project, "r", said)
    label(drive, np.arange(100, 200), HIGH)
    label(drive, np.arange(150, 160), SIGN)
    label(drive, np.arange(300, 310), LOW)
    keep(project, "a", only_painted=True)
    known = np.flatnonzero(all_of(drive, "a"))
    np.testing.assert_array_equal(known, [*range(150, 160), *range(300, 310)])


def test_a_truth_is_there_after_a_restart_and_gone_when_it_is_removed(
    project: Project, tmp_path: Path
) -> None:
    kept = keep(project, "a")
    project.close()
    again = Project.open(tmp_path / "p.zuka")
    (drive,) = again.drives
    store = TruthStore(again.settings)
    assert store.all() == (kept,)
    assert has_truth(drive, "a")
    (drive.folder / "truths" / "of a killed program").mkdir()
    store.remove_unlisted(again.drives)
    assert [one.name for one in (drive.folder / "truths").iterdir()] == ["a"]
    store.remove("a", again.drive)
    assert store.all() == ()
    assert not has_truth(drive, "a")
    again.close()


@pytest.mark.parametrize("ending", ["npy", "npz", "laz"])
def test_a_file_in_delivered_order_says_the_truth(
    project: Project, drive: Drive, tmp_path: Path, ending: str
) -> None:
    codes = (np.random.default_rng(1).uniform(size=drive.count) < 0.2).astype(np.uint8) * HIGH
    path = tmp_path / f"truth.{ending}"
    if ending == "npy":
        np.save(path, codes)
    elif ending == "npz":
        np.savez(path, code=codes)
    else:
        street = simulated_drive(3, length_m=2.0)
        street.columns["classification"][:] = codes
        write_laz(street, path)
    made = truth_of_file(project.drives, coded_truth(path), project.temporary_folder(), SILENT)
    assert dict(made.known) == {drive.id: drive.count}
    TruthStore(project.settings).add(
        Truth("f", NAME, dict(made.known), NOW), made.folders, project.drive
    )
    _, indices = drive.sources(0, drive.count)
    np.testing.assert_array_equal(all_of(drive, "f"), np.maximum(codes, 1)[indices])


def test_a_file_for_another_cloud_is_refused_and_leaves_nothing(
    project: Project, tmp_path: Path
) -> None:
    np.save(tmp_path / "t.npy", np.zeros(10, np.uint8))
    into = project.temporary_folder()
    with pytest.raises(BadFile, match="10 points"):
        truth_of_file(project.drives, coded_truth(tmp_path / "t.npy"), into, SILENT)
    assert not into.exists()


def test_a_cancelled_truth_leaves_nothing(project: Project, drive: Drive) -> None:
    into = project.temporary_folder()
    with pytest.raises(Cancelled):
        truth_as_it_stands((drive,), into, CancelledAfter())
    assert not into.exists()


def test_what_a_run_said_is_read_back_from_any_point_on(project: Project, drive: Drive) -> None:
    said = np.random.default_rng(2).uniform(size=drive.count) < 0.4
    run_that_says(project, "r", said)
    assert has_finding(drive, "noise", "r")
    assert finding_path(drive, "noise", "r").stat().st_size == -(-drive.count // 8)
    for start, stop in ((0, 1), (3, 11), (8, 8), (777, drive.count), (0, drive.count)):
        np.testing.assert_array_equal(
            read_finding(drive, "noise", "r", start, stop), said[start:stop]
        )


def test_runs_and_the_cloud_as_it_stands_are_counted_where_the_truth_is_known(
    project: Project, drive: Drive
) -> None:
    label(drive, np.arange(0, 100), HIGH)
    label(drive, np.arange(100, 1000), 1)
    keep(project, "a", only_painted=True)
    said = np.zeros(drive.count, np.bool_)
    said[60:140] = True
    said[5000:6000] = True  # where nobody knows
    run = run_that_says(project, "r", said)
    first, now = evaluate_classes((run,), project.drives, "a", SILENT)
    counts = first.counts
    assert (counts.hits, counts.false_alarms, counts.misses, counts.rejections) == (40, 40, 60, 860)
    assert counts.precision == pytest.approx(0.5)
    assert counts.recall == pytest.approx(0.4)
    assert counts.f_measure == pytest.approx(2 * 0.5 * 0.4 / 0.9)
    assert counts.turned().recall == pytest.approx(860 / 900)
    assert now.run is None
    assert now.counts.f_measure == 1.0
    columns = error_map_columns(drive, "a", first, project.temporary_folder(), SILENT)
    seen = np.bincount(columns.read(ERROR_MAP, 0, drive.count), minlength=5)
    assert seen[ErrorMapValue.RIGHTLY_KEPT] == 860
    assert seen[ErrorMapValue.RIGHTLY_REMOVED] == 40
    assert seen[ErrorMapValue.WRONGLY_REMOVED] == 40
    assert seen[ErrorMapValue.WRONGLY_KEPT] == 60
    assert seen[ErrorMapValue.UNKNOWN] == drive.count - 1000


def test_a_run_that_said_nothing_or_on_another_drive_is_left_out(
    project: Project, drive: Drive
) -> None:
    keep(project, "a")
    other = Run("x", "noise", 1, {}, (drive.id,), NOW, NOW, NAME)
    assert evaluate_classes((other,), project.drives, "a", SILENT) == ()
    assert evaluate_classes((other,), project.drives, "no such truth", SILENT) == ()
