"""A checked project names every damaged file, and what the delivery still gives is made again."""

from __future__ import annotations

import random
import shutil
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from processing.core.errors import BadFile, InUse, UserError
from processing.core.monitor import SilentMonitor
from processing.project.checking.findings import FindingState
from processing.project.checking.project_check import check_project
from processing.project.project import Project
from processing.recording.drive_files import FileOrigin, origin_of, summed_files
from tests.broken_files.full_project import make_full_project
from tests.older_project import forget_all_sums
from tests.processing.project.labelled import all_labels, paint

SILENT = SilentMonitor()


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_full_project(tmp_path_factory.mktemp("whole"))


@pytest.fixture
def project(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(whole, tmp_path / "p.zuka"))


def drive_of(project: Path) -> Path:
    (folder,) = (project / "drives").iterdir()
    return folder


def contents(project: Path) -> dict[str, bytes]:
    folder = drive_of(project)
    return {str(path.relative_to(folder)): path.read_bytes() for path in summed_files(folder)}


def turn_over(path: Path, bit: int) -> None:
    data = bytearray(path.read_bytes())
    data[bit // 8] ^= 1 << bit % 8
    path.write_bytes(data)


def test_nothing_is_said_of_a_whole_project(project: Path) -> None:
    report = check_project(project, SILENT)
    assert not report.findings
    assert report.files > 15


@given(chance=st.randoms(use_true_random=False))
@settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_a_bit_that_turned_over_in_any_file_is_named_and_turned_back(
    whole: Path, chance: random.Random
) -> None:
    project = whole.with_name("bits.zuka")
    shutil.rmtree(project, ignore_errors=True)
    shutil.copytree(whole, project)
    before = contents(project)
    damaged = chance.sample(sorted(before), 2)
    for name in damaged:
        turn_over(drive_of(project) / name, chance.randrange(len(before[name]) * 8))
    report = check_project(project, SILENT)
    assert {Path(one.file).name for one in report.damaged} == {Path(name).name for name in damaged}
    repaired = check_project(project, SILENT, is_repairing=True)
    assert {one.state for one in repaired.findings} == {FindingState.REPAIRED}
    assert contents(project) == before
    assert not check_project(project, SILENT).findings


def test_what_was_delivered_is_made_again_in_its_order_and_the_map_stays(project: Path) -> None:
    before, folder = contents(project), drive_of(project)
    database = (project / "project.gpkg").read_bytes()
    delivered = [name for name in before if origin_of(folder / name) is FileOrigin.DELIVERED]
    assert {"xyz.bin", "time.bin", "pulse.bin", "drive.json", "trajectory.npy"} <= set(delivered)
    for name in delivered:
        if name == "intensity.bin":
            (folder / name).unlink()
        else:
            middle = len(before[name]) // 2
            (folder / name).write_bytes(before[name][:middle] + bytes(9) + before[name][middle:])
    with pytest.raises(UserError):
        _read_all(project)
    report = check_project(project, SILENT, is_repairing=True)
    assert not report.damaged
    assert {Path(one.file).name for one in report.repaired} == set(delivered)
    assert contents(project) == before
    with closing(Project.open(project, writing=False)) as opened:
        assert len(opened.features) == 4
    assert (project / "project.gpkg").read_bytes() == database
    assert not any((project / "tmp").iterdir())


def _read_all(project: Path) -> None:
    with closing(Project.open(project, writing=False)) as opened:
        for error in opened.damaged_drives.values():
            raise error


def test_results_of_tools_go_and_labels_stay_as_they_are_with_a_sentence(project: Path) -> None:
    folder = drive_of(project)
    for name in ("normal.bin", "label.bin", "ground_surface.tiles"):
        data = bytearray((folder / name).read_bytes())
        data[100:200] = b"\x55" * 100
        (folder / name).write_bytes(data)
    report = check_project(project, SILENT, is_repairing=True)
    (left,) = report.damaged
    assert left.file.endswith("label.bin")
    assert "backup" in left.remedy.en
    assert not (folder / "normal.bin").exists()
    assert "ground_surface.tiles" in {Path(one.file).name for one in report.repaired}


def test_without_the_delivered_files_the_remedy_names_them(project: Path, whole: Path) -> None:
    folder = drive_of(project)
    data = (folder / "xyz.bin").read_bytes()
    (folder / "xyz.bin").write_bytes(bytes(5000) + data[5000:])
    delivered = whole.parent / "street.laz"
    aside = delivered.rename(delivered.with_suffix(".aside"))
    try:
        report = check_project(project, SILENT, is_repairing=True)
    finally:
        aside.rename(delivered)
    (left,) = report.damaged
    assert "street.laz" in left.remedy.en
    assert "street.laz" in left.remedy.ja


def test_an_older_project_gets_checksums_and_is_judged_by_them_afterwards(project: Path) -> None:
    forget_all_sums(project)
    turn_over(drive_of(project) / "intensity.bin", 5)
    before = check_project(project, SILENT)
    assert not before.damaged
    assert {one.state for one in before.findings} == {FindingState.NOTED}
    assert not check_project(project, SILENT, is_repairing=True).damaged
    turn_over(drive_of(project) / "intensity.bin", 9)
    assert [Path(one.file).name for one in check_project(project, SILENT).damaged] == [
        "intensity.bin"
    ]


def test_an_older_project_gets_a_lost_column_back_where_the_order_is_the_same(
    project: Path,
) -> None:
    before = contents(project)
    forget_all_sums(project)
    (drive_of(project) / "time.bin").unlink()
    with closing(Project.open(project, writing=False)) as opened:
        assert opened.damaged_drives
    report = check_project(project, SILENT, is_repairing=True)
    assert [Path(one.file).name for one in report.repaired] == ["time.bin"]
    assert contents(project)["time.bin"] == before["time.bin"]


def test_painting_keeps_the_checksums_true(project: Path) -> None:
    with closing(Project.open(project)) as opened:
        paint(opened, np.arange(10, 4000, 3), 7)
        assert not check_project(project, SILENT).damaged
        paint(opened, np.arange(5, 900, 2), 3)
        labels = all_labels(opened.drives[0])
    assert not check_project(project, SILENT).findings
    turn_over(drive_of(project) / "label.bin", 800)
    with closing(Project.open(project)) as opened, pytest.raises(BadFile, match=r"label\.bin"):
        all_labels(opened.drives[0])
    assert not check_project(project, SILENT, is_repairing=True).damaged
    with closing(Project.open(project)) as opened:
        assert (all_labels(opened.drives[0]) == labels).all()


def test_a_damaged_drive_leaves_the_rest_of_the_project_open(project: Path) -> None:
    (drive_of(project) / "drive.json").write_text("[" * 100_000)
    with closing(Project.open(project)) as opened:
        (error,) = opened.damaged_drives.values()
        assert "drive.json" in error.where.en
        assert not opened.drives
        assert len(opened.features) == 4


def test_a_project_that_is_open_elsewhere_is_checked_and_not_repaired(project: Path) -> None:
    with closing(Project.open(project)):
        assert not check_project(project, SILENT).damaged
        with pytest.raises(InUse):
            check_project(project, SILENT, is_repairing=True)
