"""A damaged database of a project: read, or refused in one sentence; never changed by reading."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from processing.project.project import Project
from tests.broken_files.damage import flipped, outcome, overwritten
from tests.processing.project.drawn import curb, new_project, sign

_CASES = 25


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> Path:
    features = [sign(f"s{n}", float(n)) for n in range(20)]
    return new_project(tmp_path_factory.mktemp("whole") / "a.zuka", *features, curb("c"))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("damage", [flipped, overwritten])
def test_a_damaged_database_is_read_or_refused(whole, tmp_path, damage, seed):
    folder = tmp_path / "a.zuka"
    folder.mkdir()
    path = folder / "project.gpkg"
    data = (whole / "project.gpkg").read_bytes()

    def read() -> None:
        with closing(Project.open(folder, writing=False)) as project:
            project.runs.all()
            project.history.last()

    for damaged in damage(data, _CASES, seed):
        path.write_bytes(damaged)
        outcome(read, path)
        assert path.read_bytes() == damaged


@pytest.mark.parametrize("share", [0.01, 0.1, 0.5, 0.9, 0.999])
def test_a_database_that_is_cut_off_is_refused(whole, tmp_path, share):
    folder = tmp_path / "a.zuka"
    folder.mkdir()
    path = folder / "project.gpkg"
    data = (whole / "project.gpkg").read_bytes()
    path.write_bytes(data[: int(len(data) * share)])
    for writing in (False, True):
        error = outcome(lambda writing=writing: Project.open(folder, writing=writing), path)
        assert error is not None
    assert path.read_bytes() == data[: int(len(data) * share)]
