"""Every door reads its small file, and ends in a result or one sentence whatever it is given."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from processing.core.errors import UserError
from tests.broken_files.full_project import make_full_project
from tests.reliability.doors import Door, delivered_doors, project_doors
from tests.reliability.fuzzing import altered

DELIVERED = delivered_doors()
FOUND = sorted((Path(__file__).parent / "found").glob("*/*"))
_INPUTS = 40
_ODD = (b"", b"[" * 30_000, b"\xea" * 50, bytes(5_000))


@pytest.fixture(scope="module")
def of_projects(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Door]:
    folder = tmp_path_factory.mktemp("whole")
    return project_doors(make_full_project(folder), tmp_path_factory.mktemp("copies"))


def _read(door: Door, path: Path) -> UserError | None:
    try:
        door.read(path)
    except UserError as error:
        return error
    return None


@pytest.mark.parametrize("name", DELIVERED)
def test_what_a_door_is_given_is_read_or_refused(name: str, tmp_path: Path) -> None:
    door = DELIVERED[name]
    path = tmp_path / door.file
    door.write(path)
    assert _read(door, path) is None
    good, chance = path.read_bytes(), random.Random(name)  # noqa: S311 - chance, no secret
    refused = 0
    for data in (*_ODD, *(altered(good, chance) for _ in range(_INPUTS))):
        path.write_bytes(data)
        refused += _read(door, path) is not None
    assert refused > 0


def test_a_project_with_any_file_altered_is_opened_or_refused(
    of_projects: dict[str, Door], tmp_path: Path
) -> None:
    assert len(of_projects) > 30
    for name, door in of_projects.items():
        path = tmp_path / door.file
        door.write(path)
        assert _read(door, path) is None, name
        good, chance = path.read_bytes(), random.Random(name)  # noqa: S311 - chance, no secret
        for data in (_ODD[1], altered(good, chance)):
            path.write_bytes(data)
            _read(door, path)
        door.write(path)
        _read(door, path)


@pytest.mark.parametrize("path", FOUND, ids=lambda path: f"{path.parent.name}-{path.name}")
def test_what_was_once_no_sentence_is_one_now(
    path: Path, of_projects: dict[str, Door], tmp_path: Path
) -> None:
    door = {**DELIVERED, **of_projects}[path.parent.name]
    given = tmp_path / door.file
    given.write_bytes(path.read_bytes())
    _read(door, given)
