"""Folders stay small, import each other in no circle, and files stand for a subject."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import PurePosixPath

from tests.house_rules.imports import (
    Graph,
    folder_of,
    folders_of,
    importers,
    imports_of,
    mutual,
    program,
    program_imports,
)
from tests.house_rules.sources import python_files

MOST_FILES = 22
SHORT_LINES = 50
MOST_SMALL_PARTS = 21
"""Files below `SHORT_LINES` that one other file alone imports; it may fall, never rise."""


def crowded(names: Iterable[str]) -> dict[str, int]:
    """Count the files of folders that hold too many."""
    files = (name for name in names if PurePosixPath(name).name != "__init__.py")
    count = Counter(folder_of(name) for name in files)
    return {folder: files for folder, files in count.items() if files > MOST_FILES}


def circle_of(graph: Graph) -> list[str]:
    """Give one circle of a graph; empty where there is none."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def small_parts(sources: Mapping[str, str], files: Graph) -> list[str]:
    """Name the short files that exist for one other file."""
    return sorted(
        f"{name} ({others[0]})"
        for name, others in importers(files).items()
        if len(others) == 1
        and PurePosixPath(name).name != "__init__.py"
        and len(sources[name].splitlines()) < SHORT_LINES
    )


def test_no_folder_holds_more_than_22_files() -> None:
    # A journey is a file of its own: a folder of them is looked through by what they are called.
    found = crowded(python_files())
    assert {folder for folder in found if folder != "tests/journeys"} == set()


def test_every_folder_of_code_is_a_package() -> None:
    # A folder without ``__init__`` imports here and is left out of a frozen program.
    files = set(python_files())
    folders = {folder_of(name) for name in files if not name.startswith("tests/")}
    assert {one for one in folders if f"{one}/__init__.py" not in files} == set()


def test_no_folders_import_each_other() -> None:
    folders = folders_of(program_imports())
    assert mutual(folders) == []
    assert circle_of(folders) == []


def test_no_more_small_files_exist_for_one_other() -> None:
    found = small_parts(program(), program_imports())
    assert len(found) <= MOST_SMALL_PARTS, found


def test_imports_are_read_from_the_sources() -> None:
    sources = {
        "app/window.py": "from app.parts import bar\n\ndef f():\n    import app.parts.menu\n",
        "app/parts/bar.py": "from app.parts.menu import Menu\n",
        "app/parts/menu.py": "import numpy\n",
    }
    files = imports_of(sources)
    assert files["app/window.py"] == {"app/parts/bar.py", "app/parts/menu.py"}
    assert folders_of(files) == {"app": {"app/parts"}, "app/parts": frozenset()}
    assert small_parts(sources, files) == ["app/parts/bar.py (app/window.py)"]


def test_folders_that_import_each_other_are_caught() -> None:
    sources = {"app/a.py": "import app.x.b", "app/x/b.py": "", "app/x/c.py": "import app.a"}
    folders = folders_of(imports_of(sources))
    assert mutual(folders) == [("app", "app/x")]
    assert set(circle_of(folders)) == {"app", "app/x"}
    assert circle_of({"a": frozenset({"b"}), "b": frozenset()}) == []


def test_a_folder_of_23_files_is_caught() -> None:
    assert crowded(f"app/file{number}.py" for number in range(23)) == {"app": 23}
    assert crowded(f"app/file{number}.py" for number in range(22)) == {}
