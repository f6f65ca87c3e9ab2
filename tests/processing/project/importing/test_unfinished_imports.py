"""Imports that stopped half-way: kept, gone on with, or dropped."""

from __future__ import annotations

import os
import shutil
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core import owned_files
from processing.core.disk_room import refuse_small_disk
from processing.core.errors import BadFile, Cancelled, Interrupted, NoSpace
from processing.core.monitor import SilentMonitor
from processing.formats.points.las.las_header import read_header
from processing.project.importing import import_journal, import_processes
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.importing.unfinished_imports import (
    discard,
    import_folder,
    unfinished_imports,
)
from processing.project.project import Project
from processing.recording.drive import Drive
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from tests.processing.project.drawn import tree_of


@pytest.fixture(scope="module")
def delivery(tmp_path_factory) -> ImportRequest:
    """Two files of one drive and its trajectory."""
    folder = tmp_path_factory.mktemp("納品")
    simulated = simulated_drive(length_m=4.0)
    whole = write_laz(simulated, folder / "whole.laz")
    files = []
    for number, rows in enumerate(np.array_split(np.arange(simulated.count), 2)):
        cloud = laspy.read(whole)
        cloud.points = cloud.points[rows[0] : rows[-1] + 1]
        files.append(folder / f"通り{number}.las")
        cloud.write(files[-1])
    return ImportRequest(tuple(files), (write_trajectory_csv(simulated, folder / "軌跡.csv"),))


class _Crash(RuntimeError):
    """Stands for a program that ends."""


class _EndsAt:
    """Ends the work once it has come so far."""

    def __init__(self, fraction: float, end: Exception) -> None:
        self._fraction = fraction
        self._end = end
        self._is_there = False

    def report(self, fraction, text=None):
        self._is_there |= fraction >= self._fraction

    def check(self):
        if self._is_there:
            raise self._end


@pytest.fixture
def noted_at_once(monkeypatch):
    monkeypatch.setattr(import_journal, "SECONDS", 0.0)


@pytest.fixture
def project(tmp_path):
    with closing(Project.create(tmp_path / "通り.zuka", "")) as project:
        yield project


def _stopped(project: Project, request: ImportRequest, fraction: float = 0.2) -> Path:
    """An import that came so far; gives its folder."""
    into = import_folder(project.folder, request)
    with pytest.raises(_Crash):
        import_drives(request, into, _EndsAt(fraction, _Crash()))
    return into


def _copied(request: ImportRequest, folder: Path) -> ImportRequest:
    """The same delivery elsewhere, to be changed."""
    shutil.copytree(request.inputs[0].parent, folder)
    inputs = tuple(folder / path.name for path in request.inputs)
    return ImportRequest(inputs, tuple(folder / path.name for path in request.trajectories))


def _change_points(path: Path, point: int, data: bytes) -> None:
    """Write over a point in the middle of a file; its size and time stay."""
    status, whole = path.stat(), bytearray(path.read_bytes())
    header = read_header(path)
    at = header.points_at + point * header.point_size
    whole[at : at + len(data)] = data
    path.write_bytes(whole)
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))


@pytest.mark.usefixtures("noted_at_once")
def test_what_was_read_before_a_crash_is_not_read_again(tmp_path, project, delivery):
    request = _copied(delivery, tmp_path / "delivered")
    whole = import_drives(request, tmp_path / "tmp" / "elsewhere", SilentMonitor())
    into = _stopped(project, request)
    # A point of the file that was read is another one now, which nobody notices.
    _change_points(request.inputs[0], 2_800, bytes(20))
    (folder,) = import_drives(request, into, SilentMonitor())
    # All but the checksum, which is that of the file as it is now.
    one, other = (dict(tree_of(drive)) for drive in (folder, whole[0]))
    for name in ("drive.json", "drive.json.sums"):
        assert one.pop(name) != other.pop(name)
    assert one == other


@pytest.mark.usefixtures("noted_at_once")
def test_an_import_that_stopped_is_there_when_the_project_is_opened_again(project, delivery):
    into = _stopped(project, delivery)
    litter = project.temporary_folder()
    litter.mkdir()
    project.close()
    with closing(Project.open(project.folder)) as again:
        (unfinished,) = unfinished_imports(again.folder)
        assert unfinished.folder == into
        assert not litter.exists()
        assert not again.is_empty
        request = unfinished.request
        assert {path.name for path in request.inputs} == {path.name for path in delivery.inputs}
        again.adopt_drives(import_drives(request, into, SilentMonitor()))
        assert unfinished_imports(again.folder) == ()
        assert list((again.folder / "tmp").iterdir()) == []


@pytest.mark.usefixtures("noted_at_once")
def test_an_import_that_is_discarded_leaves_nothing(project, delivery):
    _stopped(project, delivery)
    (unfinished,) = unfinished_imports(project.folder)
    discard(unfinished)
    assert list((project.folder / "tmp").iterdir()) == []
    assert project.is_empty


@pytest.mark.usefixtures("noted_at_once")
@pytest.mark.parametrize("change", ["longer", "gone", "newer"])
def test_an_import_whose_files_changed_is_dropped(tmp_path, project, delivery, change):
    request = _copied(delivery, tmp_path / "delivered")
    into = _stopped(project, request)
    last = request.inputs[1]
    match change:
        case "longer":
            last.write_bytes(last.read_bytes() + b"\0")
        case "gone":
            last.unlink()
        case "newer":
            os.utime(last, ns=(1, 1))
    assert unfinished_imports(project.folder) == ()
    project.close()
    Project.open(project.folder).close()
    assert not into.exists()


@pytest.mark.usefixtures("noted_at_once")
@pytest.mark.parametrize("end", [Cancelled(), BadFile.__new__(BadFile)])
def test_a_cancelled_or_refused_import_is_not_offered_again(project, delivery, end):
    into = import_folder(project.folder, delivery)
    with pytest.raises(type(end)):
        import_drives(delivery, into, _EndsAt(0.2, end))
    assert not into.exists()


def test_an_import_that_the_end_of_the_program_interrupts_goes_on_another_day(
    tmp_path, project, delivery
):
    into = import_folder(project.folder, delivery)
    with pytest.raises(Interrupted):
        import_drives(delivery, into, _EndsAt(0.2, Interrupted()))
    (unfinished,) = unfinished_imports(project.folder)
    (folder,) = import_drives(unfinished.request, into, SilentMonitor())
    whole = import_drives(delivery, tmp_path / "elsewhere", SilentMonitor())
    assert tree_of(folder) == tree_of(whole[0])


@pytest.mark.usefixtures("noted_at_once")
@pytest.mark.parametrize("removes", ["discard", "adopt", "cancel", "open"])
def test_a_kill_while_an_import_is_removed_leaves_nothing_to_go_on_with(
    monkeypatch, project, delivery, removes
):
    into = import_folder(project.folder, delivery)
    at_kill = []
    monkeypatch.setattr(
        owned_files.shutil,
        "rmtree",
        lambda *_a, **_k: at_kill.append(unfinished_imports(project.folder)),
    )
    match removes:
        case "discard":
            _stopped(project, delivery)
            discard(*unfinished_imports(project.folder))
        case "adopt":
            project.adopt_drives(import_drives(delivery, into, SilentMonitor()))
        case "cancel":
            with pytest.raises(Cancelled):
                import_drives(delivery, into, _EndsAt(0.2, Cancelled()))
        case "open":
            request = replace(delivery, inputs=delivery.inputs[:1])
            done = import_drives(request, import_folder(project.folder, request), SilentMonitor())
            into = done[0].parent
            kept = {one.name: one.read_bytes() for one in into.iterdir() if one.is_file()}
            assert import_journal.PLAN in kept
            project.adopt_drives(done)
            at_kill.clear()
            into.mkdir(exist_ok=True)
            for name, text in kept.items():
                (into / name).write_bytes(text)
            project.close()
            Project.open(project.folder).close()
    assert at_kill
    assert not any(at_kill)


@pytest.mark.usefixtures("noted_at_once")
def test_a_cut_off_last_note_costs_only_itself(tmp_path, project, delivery):
    whole = import_drives(delivery, tmp_path / "elsewhere", SilentMonitor())
    into = _stopped(project, delivery)
    journal = into / import_journal.JOURNAL
    journal.write_bytes(journal.read_bytes()[:-9])
    (folder,) = import_drives(delivery, into, SilentMonitor())
    assert tree_of(folder) == tree_of(whole[0])


def test_the_same_delivery_twice_gives_two_drives_of_the_same_points(project, delivery):
    into = import_folder(project.folder, delivery)
    (first,) = project.adopt_drives(import_drives(delivery, into, SilentMonitor()))
    folders = import_drives(delivery, into, SilentMonitor(), taken=(first.id,))
    (second,) = project.adopt_drives(folders)
    assert second.id == f"{first.id}-2"
    names = {"drive.json", "drive.json.sums"}
    alike = [
        {name: data for name, data in tree_of(drive.folder).items() if name not in names}
        for drive in (first, second)
    ]
    assert alike[0] == alike[1]


def test_processes_beside_write_what_one_process_writes(tmp_path, monkeypatch, delivery):
    alone = import_drives(delivery, tmp_path / "alone", SilentMonitor())
    monkeypatch.setattr(import_processes, "FEWEST_POINTS", 0)
    beside = import_drives(delivery, tmp_path / "beside", SilentMonitor())
    assert [folder.name for folder in alone] == [folder.name for folder in beside]
    assert tree_of(alone[0]) == tree_of(beside[0])


def test_a_file_damaged_in_the_middle_is_named_by_a_process_beside(tmp_path, monkeypatch, delivery):
    monkeypatch.setattr(import_processes, "FEWEST_POINTS", 0)
    request = _copied(delivery, tmp_path / "delivered")
    _change_points(request.inputs[1], 2_800, b"\xff\xff\xff\x7f")
    with pytest.raises(BadFile, match="通り1"):
        import_drives(request, tmp_path / "in", SilentMonitor())
    assert not (tmp_path / "in").exists()


@pytest.mark.usefixtures("noted_at_once")
@pytest.mark.parametrize("fewest_points", [0, 10**9])
def test_a_full_disk_keeps_what_is_done_and_says_how_to_go_on(
    tmp_path, monkeypatch, project, delivery, fewest_points
):
    whole = import_drives(delivery, tmp_path / "elsewhere", SilentMonitor())
    into = _stopped(project, delivery)
    monkeypatch.setattr(import_processes, "FEWEST_POINTS", fewest_points)
    column, aside = into / "0-0" / "intensity.bin", tmp_path / "aside"
    column.rename(aside)
    column.symlink_to("/dev/full")
    with pytest.raises(NoSpace) as refusal:
        import_drives(delivery, into, SilentMonitor())
    assert "goes on where it stopped" in refusal.value.line("en")
    assert "再開" in refusal.value.line("ja")
    column.unlink()
    aside.rename(column)
    (folder,) = import_drives(delivery, into, SilentMonitor())
    assert tree_of(folder) == tree_of(whole[0])


def test_a_disk_that_is_too_small_is_said_before_anything_is_read(tmp_path):
    with pytest.raises(NoSpace) as refusal:
        refuse_small_disk(tmp_path, 10**18)
    assert "1000000000.0 GB" in refusal.value.line("en")


def test_a_drive_of_many_files_says_where_each_point_was_delivered(tmp_path, delivery):
    (folder,) = import_drives(delivery, tmp_path / "in", SilentMonitor())
    drive = Drive(folder)
    files, indices = drive.sources(0, drive.count)
    counts = [source.points for source in drive.info.sources]
    assert files.tolist() == np.repeat([0, 1], counts).tolist()
    assert indices.tolist() == [*range(counts[0]), *range(counts[1])]
