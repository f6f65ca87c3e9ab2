"""No name that the program writes or removes in a project leads it out of the project."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.broken_files.full_project import make_full_project
from tests.processing.project.store.test_links import tree_of
from tests.reliability.operations import LATER, OPERATIONS, do
from tests.reliability.written_names import foreseen_names, make_outside, put_link


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project with a file of every kind; what can be imported lies beside it."""
    made = make_full_project(tmp_path_factory.mktemp("whole"))
    assert (made.parent / LATER).is_file()
    return made


@pytest.fixture(scope="module")
def written(whole: Path, tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, str]:
    """Every name that an operation changes and that can be foreseen, and one such operation."""
    found: dict[str, str] = {}
    for operation in OPERATIONS:
        work = tmp_path_factory.mktemp("walk")

        def act(project: Path, operation: str = operation, work: Path = work) -> None:
            assert do(operation, project, whole.parent, work / "out").status == 0, operation

        for name in foreseen_names(whole, work, act):
            found.setdefault(name, operation)
    return found


def test_links_under_every_name_that_is_written_or_removed_are_not_followed(
    whole: Path, written: Mapping[str, str], tmp_path: Path
) -> None:
    assert {"lock", "lock-owner.json"} < written.keys()
    assert len(written) > 50
    outside, project = tmp_path / "outside", tmp_path / "p.zuka"
    make_outside(outside)
    before = tree_of(outside)
    for name, operation in written.items():
        shutil.copytree(whole, project)
        put_link(project / name, outside)
        answer = do(operation, project, whole.parent, tmp_path / "out")
        assert tree_of(outside) == before, f"{operation} reached out of the project by {name}"
        assert answer.is_right, f"{operation} with a link at {name}: {answer}"
        shutil.rmtree(project)
        shutil.rmtree(tmp_path / "out", ignore_errors=True)


def test_what_writes_through_a_link_is_seen(tmp_path: Path) -> None:
    outside, project = tmp_path / "outside", tmp_path / "p.zuka"
    make_outside(outside)
    before = tree_of(outside)
    (project / "drives").mkdir(parents=True)

    def act(folder: Path) -> None:
        (folder / "drives" / "new.bin").write_bytes(b"new")

    assert foreseen_names(project, tmp_path, act) == {"drives/new.bin"}
    put_link(project / "drives" / "new.bin", outside)
    act(project)
    assert tree_of(outside) != before
