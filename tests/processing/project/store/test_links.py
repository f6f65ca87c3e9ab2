"""A project never reaches outside of its folder: links in it, and folders that are not its own."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from contextlib import closing, suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import BadFile, InUse
from processing.core.monitor import SilentMonitor
from processing.core.owned_files import MARK, is_marked, make_marked, remove_folder
from processing.core.scratch_folder import scratch_folder
from processing.core.whole_folder import write_whole_folder
from processing.image.tiles.tile_files import TileFiles
from processing.labels.label_column import make_column
from processing.project.evaluation.truth_store import TruthStore
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.importing.unfinished_imports import remove_import, remove_litter
from processing.project.project import Project
from processing.project.store.exchanged_files import ExchangedFiles
from processing.project.store.label_filing import remove_unlisted
from processing.project.store.project_lock import ProjectLock
from processing.project.store.reading_connection import connect
from processing.project.volumes.volume_store import volume_name
from processing.recording.camera_images.calibration import CameraOffset
from processing.recording.camera_images.offset_store import write_offsets
from processing.recording.columns.replacing import finish_replacing, new_columns
from processing.recording.drive import Drive
from processing.recording.drive_info import write_drive_info
from processing.recording.kinds import ImageKind
from tests.processing.project.labelled import labelled_project

FOLDERS = (
    "drives",
    "drives/{drive}",
    "drives/{drive}/truths",
    "drives/{drive}/truths/0123",
    "drives/{drive}/runs",
    "drives/{drive}/unfinished",
    "drives/{drive}/whole",
    "label_steps",
    "label_steps/0123",
    "step_files",
    "step_files/0123",
    "results",
    "results/volumes",
    "results/volumes/0123",
    "tmp",
    "tmp/0123",
    "tmp/import-0123",
    "tmp/0123/inside",
)
FILES = (
    "lock",
    "lock-owner.json",
    "project.gpkg",
    "project.gpkg-journal",
    "project.gpkg-wal",
    "project.gpkg-shm",
    "unfinished.gpkg",
    "drives/{drive}/label.bin",
    "drives/{drive}/label.part",
    "drives/{drive}/drive.json",
    "drives/{drive}/revolutions.npz",
    "drives/{drive}/camera_offsets.json",
    "drives/{drive}/image_rows_scan.npz",
    "label_steps/0123/parts.bin",
    "label_steps/0123/after-left.bin",
    "tmp/import-0123/plan.json",
)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return labelled_project(tmp_path_factory.mktemp("whole"))


@pytest.fixture
def project(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(whole, tmp_path / "p.zuka"))


@pytest.fixture
def outside(tmp_path: Path) -> Path:
    """Somebody else's folder, with files of the names that a project uses."""
    folder = tmp_path / "outside"
    for name in ("mine.txt", "inside/deep.txt", "parts.bin", "after-left.bin", "truth.bin", MARK):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(f"mine: {name}")
    return folder


def tree_of(folder: Path) -> Mapping[str, bytes | str]:
    """What is in a folder, links as what they are."""
    found: dict[str, bytes | str] = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_symlink():
            found[name] = str(path.readlink())
        else:
            found[name] = path.read_bytes() if path.is_file() else "folder"
    return found


def drive_id(project: Path) -> str:
    (drive,) = (project / "drives").iterdir()
    return drive.name


def put_link(position: Path, target: Path) -> None:
    """A link in the place of what may be there, which becomes what the link leads to."""
    position.parent.mkdir(parents=True, exist_ok=True)
    if position.exists():
        shutil.rmtree(target) if target.is_dir() else target.unlink()
        position.rename(target)
    position.symlink_to(target, target_is_directory=target.is_dir())


@pytest.mark.parametrize("writing", [True, False])
@pytest.mark.parametrize("position", [*FOLDERS, *FILES])
def test_a_project_with_a_link_in_it_is_refused_and_nothing_is_touched(
    project: Path, outside: Path, position: str, writing: bool
) -> None:
    link = project / position.format(drive=drive_id(project))
    put_link(link, outside if position in FOLDERS else outside / "mine.txt")
    before = tree_of(outside), tree_of(project)
    with pytest.raises(InUse) as refused:
        Project.open(project, writing=writing).close()
    assert refused.value.where.en == str(link)
    assert (tree_of(outside), tree_of(project)) == before


@pytest.mark.parametrize("name", ["lock", "lock-owner.json", "unfinished.gpkg-wal"])
def test_a_new_project_is_not_made_through_a_link(tmp_path: Path, outside: Path, name: str) -> None:
    before = tree_of(outside)
    (tmp_path / "n.zuka").mkdir()
    (tmp_path / "n.zuka" / name).symlink_to(outside / "mine.txt")
    with suppress(InUse):
        Project.create(tmp_path / "n.zuka", "").close()
    assert tree_of(outside) == before


def test_a_project_behind_a_link_and_columns_on_another_disk_are_fine(
    project: Path, tmp_path: Path
) -> None:
    column = project / "drives" / drive_id(project) / "intensity.bin"
    put_link(column, _file(tmp_path / "disk" / "intensity.bin"))
    (tmp_path / "here.zuka").symlink_to(project, target_is_directory=True)
    with closing(Project.open(tmp_path / "here.zuka")) as opened:
        assert opened.drives[0].columns["intensity"].size == opened.drives[0].count
    assert column.is_symlink()


def _file(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"")
    return path


@pytest.mark.parametrize("name", ["../outside", "..", "", "a/b"])
def test_a_database_does_not_name_drives_outside_of_the_project(project: Path, name: str) -> None:
    with closing(connect(project / "project.gpkg", "rw")) as connection, connection:
        connection.execute("UPDATE zuka_drives SET id = ?", (name,))
    with pytest.raises(BadFile):
        Project.open(project)


def _files(project: Path) -> ExchangedFiles:
    return ExchangedFiles(project, {}.__getitem__)


def _volumes_forgotten(project: Path) -> None:
    step = _files(project).new()
    step.take_away(volume_name("0123"))
    files = step.files()
    assert files is not None
    _files(project).exchange(files)


REMOVALS: Mapping[str, tuple[str, Callable[[Path], object]]] = {
    "litter": ("tmp", lambda project: remove_litter(project, ())),
    "litter of a run": ("tmp/0123", lambda project: remove_litter(project, ())),
    "litter of an import": ("tmp/import-0123", lambda project: remove_litter(project, ())),
    "an import": ("tmp/import-0123", lambda project: remove_import(project / "tmp/import-0123")),
    "labels": ("label_steps", lambda project: remove_unlisted(project / "label_steps", ())),
    "a step": ("label_steps/0123", lambda project: remove_unlisted(project / "label_steps", ())),
    "a listed step": (
        "label_steps/0123",
        lambda project: remove_unlisted(project / "label_steps", ("0123",)),
    ),
    "files": ("step_files", lambda project: _files(project).remove_unlisted(())),
    "files of a step": ("step_files/0123", lambda project: _files(project).remove_unlisted(())),
    "volumes": ("results/volumes", _volumes_forgotten),
    "a volume": ("results/volumes/0123", _volumes_forgotten),
    "a folder": ("tmp", lambda project: remove_folder(project / "tmp" / "inside", project)),
}


@pytest.mark.parametrize("what", REMOVALS)
def test_nothing_is_removed_through_a_link_that_came_later(
    project: Path, outside: Path, what: str
) -> None:
    position, remove = REMOVALS[what]
    put_link(project / position, outside)
    before = tree_of(outside)
    with suppress(InUse):
        remove(project)
    assert tree_of(outside) == before


def test_truths_behind_a_link_stay(project: Path, outside: Path) -> None:
    with closing(Project.open(project)) as opened:
        put_link(opened.drives[0].folder / "truths", outside)
        before = tree_of(outside)
        TruthStore(opened.settings).remove_unlisted(opened.drives)
        assert tree_of(outside) == before


def _rewritten(drive: Drive) -> None:
    write_drive_info(drive.folder, replace(drive.info, name="new"))


WRITES: Mapping[str, tuple[str, Callable[[Drive], object]]] = {
    "a column": ("label.part", make_column),
    "the description": ("drive.part", _rewritten),
    "offsets": (
        "camera_offsets.part",
        lambda drive: write_offsets(drive.folder, {"a": CameraOffset()}),
    ),
    "the lock": ("lock-owner.json", lambda drive: _locked(drive.folder)),
    "a lock": ("lock", lambda drive: _locked(drive.folder)),
    "new columns": ("unfinished", lambda drive: new_columns(drive.folder)),
    "whole columns": ("whole", lambda drive: finish_replacing(drive.folder)),
}


def _locked(folder: Path) -> None:
    ProjectLock(folder).release()


@pytest.mark.parametrize("what", WRITES)
def test_nothing_is_written_through_a_link(project: Path, outside: Path, what: str) -> None:
    name, write = WRITES[what]
    drive = Drive(project / "drives" / drive_id(project))
    is_folder = name in ("unfinished", "whole")
    (drive.folder / name).symlink_to(
        outside if is_folder else outside / "mine.txt", target_is_directory=is_folder
    )
    before = tree_of(outside)
    with suppress(InUse):
        write(drive)
    assert tree_of(outside) == before


def test_facts_on_tiles_are_not_written_through_a_link(
    tmp_path: Path, outside: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("threading.get_ident", lambda: 7)
    (tmp_path / "tile_bounds_scan.7.part").symlink_to(outside / "mine.txt")
    before = tree_of(outside)
    TileFiles(tmp_path, ImageKind.SCAN, (1, 10)).keep_whole(np.zeros((1, 10)))
    assert tree_of(outside) == before
    assert (tmp_path / "tile_bounds_scan.npy").is_file()


OTHERS = (
    "tmp/photos",
    "tmp/import-2024",
    "label_steps/notes",
    "step_files/notes",
    "results/volumes/mine",
)


@pytest.mark.parametrize("position", OTHERS)
def test_what_somebody_put_into_a_project_stays(project: Path, position: str) -> None:
    (project / position).mkdir(parents=True)
    (project / position / "mine.txt").write_text("mine")
    (project / "tmp").mkdir(exist_ok=True)
    (project / "tmp" / "mine.txt").write_text("mine")
    with closing(Project.open(project)) as opened:
        mine = opened.drives[0].folder / "truths" / "mine"
        mine.mkdir(parents=True)
        (mine / "mine.txt").write_text("mine")
        TruthStore(opened.settings).remove_unlisted(opened.drives)
    assert (project / position / "mine.txt").read_text() == "mine"
    assert (project / "tmp" / "mine.txt").read_text() == "mine"
    assert (mine / "mine.txt").read_text() == "mine"


def test_what_the_program_made_for_a_while_goes(project: Path) -> None:
    make_marked(project / "tmp" / "0123")
    (project / "tmp" / "0123" / "xyz.bin").write_bytes(b"half")
    (project / "tmp" / "empty").mkdir(parents=True)
    Project.open(project).close()
    assert not any((project / "tmp").iterdir())


def test_an_import_takes_no_folder_that_is_not_its_own(project: Path, whole: Path) -> None:
    into = project / "tmp" / "import-0123"
    into.mkdir(parents=True)
    (into / "mine.txt").write_text("mine")
    request = ImportRequest((whole.parent / "street.laz",))
    with pytest.raises(InUse):
        import_drives(request, into, SilentMonitor())
    assert (into / "mine.txt").read_text() == "mine"


def test_scratch_removes_only_scratch(tmp_path: Path, outside: Path) -> None:
    mine = tmp_path / ".zuka-settings"
    mine.mkdir()
    (mine / "mine.txt").write_text("mine")
    (tmp_path / ".zuka-link").symlink_to(outside, target_is_directory=True)
    left = tmp_path / ".zuka-0123"
    make_marked(left)
    before = tree_of(outside), tree_of(mine)
    with scratch_folder(tmp_path) as made:
        assert is_marked(made)
        assert not left.exists()
    assert not made.exists()
    assert (tree_of(outside), tree_of(mine)) == before


@pytest.mark.parametrize("is_linked", [False, True])
def test_a_simulation_takes_no_folder_that_is_not_its_own(
    tmp_path: Path, outside: Path, is_linked: bool
) -> None:
    with write_whole_folder(tmp_path / "street") as hidden:
        pass
    assert not (tmp_path / "street" / MARK).exists()
    (tmp_path / "street").rmdir()
    if is_linked:
        hidden.symlink_to(outside, target_is_directory=True)
    else:
        hidden.mkdir()
        (hidden / "mine.txt").write_text("mine")
    before = tree_of(outside), tree_of(hidden)
    with pytest.raises(InUse), write_whole_folder(tmp_path / "street"):
        pass
    assert (tree_of(outside), tree_of(hidden)) == before


def test_the_mark_is_what_a_removal_takes_last(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "import-1"
    make_marked(folder)
    for number in range(20):
        (folder / f"{number}.bin").touch()
    (folder / "drive").mkdir()
    monkeypatch.setattr("shutil.rmtree", lambda *_, **__: None)  # as a kill before the last step
    assert remove_folder(folder)
    assert sorted(path.name for path in folder.iterdir()) == [MARK, "drive"]
