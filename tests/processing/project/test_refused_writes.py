"""Full disks and read-only folders: one sentence, and the project as it was."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from processing.project.project import Project
from tests.processing.project.drawn import features_of, new_project, replayed_history, sign, tree_of

# The process may write no file longer than the database is now: as on a full disk.
ON_A_FULL_DISK = """
import json, resource, sys
from pathlib import Path
from processing.core.errors import NoSpace
from processing.map.change import Change
from processing.project.project import Project
from tests.processing.project.drawn import LABEL, curb, features_of
folder, room = Path(sys.argv[1]), int(sys.argv[2])
project = Project.open(folder)
size = (folder / "project.gpkg").stat().st_size
soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
resource.setrlimit(resource.RLIMIT_FSIZE, (size + room, hard))
refused = done = 0
while not refused and done < 5000:
    before, position = features_of(project), project.history.position
    try:
        project.features.apply(LABEL, Change(added=(curb(f"full{done}", vertices=300),)))
        done += 1
    except NoSpace:
        refused += 1
        assert features_of(project) == before
        assert project.history.position == position
resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
project.features.apply(LABEL, Change(added=(curb("after"),)))
project.close()
print(json.dumps([done, refused]))
"""

WITHOUT_RIGHTS = """
import os, sys
from pathlib import Path
from processing.core.errors import NoSpace
from processing.project.project import Project
# What is imported late must be there before the rights are given up.
Project.open(Path(sys.argv[1]), writing=False).close()
if os.getuid() == 0:
    os.setuid(65534)
folder = Path(sys.argv[1])
reading = Project.open(folder, writing=False)
assert [feature.id for feature in reading.features.all()] == ["a"]
reading.close()
told = []
for refused in (lambda: Project.open(folder), lambda: Project.create(folder / "b.zuka", "")):
    try:
        refused()
    except NoSpace as error:
        assert str(folder) in error.where.en
        told.append(error.remedy.en)
    else:
        raise SystemExit("it was not refused")
assert "Copy its folder" in told[0]
print("refused")
"""


@pytest.mark.parametrize("room", [0, 10_000, 40_000])
def test_on_a_full_disk_nothing_changes_in_memory_or_on_disk_and_work_goes_on_after(tmp_path, room):
    folder = new_project(tmp_path / "a.zuka", sign("a"))
    command = [sys.executable, "-c", ON_A_FULL_DISK, folder, str(room)]
    told = subprocess.run(command, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    done, refused = json.loads(told.stdout)
    assert refused == 1
    with closing(Project.open(folder)) as project:
        assert len(project.features) == 2 + done
        assert features_of(project) == replayed_history(folder)


@pytest.fixture
def folder_for_all() -> Iterator[Path]:
    """A folder that other users may enter; pytest's own are closed, now and then anew."""
    with TemporaryDirectory(prefix="zuka-") as position:
        Path(position).chmod(0o755)
        yield Path(position)


def test_a_folder_without_rights_is_read_and_refuses_to_be_written_in_one_sentence(folder_for_all):
    folder = new_project(folder_for_all / "a.zuka", sign("a"))
    before = tree_of(folder)
    folder.chmod(0o555)
    for path in folder.iterdir():
        path.chmod(0o444)
    try:
        command = [sys.executable, "-c", WITHOUT_RIGHTS, folder]
        told = subprocess.run(command, capture_output=True, text=True, check=False)
        assert told.stdout == "refused\n", told.stderr
    finally:
        folder.chmod(0o755)
    assert tree_of(folder) == before


def test_a_project_that_could_not_be_made_leaves_no_folder(tmp_path):
    occupied = tmp_path / "occupied.zuka"
    occupied.mkdir()
    # A directory where the database is to be built.
    (occupied / "lock").touch()
    with closing(Project.create(occupied, "EPSG:6677")) as project:
        assert project.crs == "EPSG:6677"
    kept = tmp_path / "kept.zuka"
    kept.mkdir()
    (kept / "mine.txt").write_text("mine")
    Project.remove_new(kept)
    assert (kept / "mine.txt").read_text() == "mine"
