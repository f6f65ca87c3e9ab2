"""The page of the architecture is true: what it names is there, and every folder is named."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import PurePosixPath

import pytest

from tests.house_rules.imports import program
from tests.house_rules.sources import ROOT, python_files, text_of

PAGE = "docs/architecture.md"
BASES = ("", "processing/", "widgets/", "app/")
"""What paths on the page are relative to."""
FORMER = "### What became of the old folders"  # names folders that are gone
_FILE = re.compile(r"(?<![\w/.*])(?:\w+/)*\w+\.py\b")
_FOLDER = re.compile(r"`((?:\w+/)+)`")
_BLOCK = re.compile(r"```python\n(.*?)```", re.DOTALL)
_DEFINED = re.compile(r"\b(?:class|def) (\w+)")
_CALLED = re.compile(r"(?<![\w.])([A-Za-z_]\w{3,})\(")
_CAMEL = re.compile(r"\b[A-Z][a-z]+(?:[A-Z][a-z]+)+\b")


def page() -> str:
    """Give the page without the section that tells of folders that are gone."""
    before, _, rest = text_of(PAGE).partition(FORMER)
    return before + rest[rest.index("\n## ") :]


def missing_files(text: str, known: Iterable[str]) -> list[str]:
    """Name the files of a text that are nowhere; one without a folder may be in any."""
    paths = set(known)
    names = {PurePosixPath(path).name for path in paths}
    return sorted(
        name
        for name in set(_FILE.findall(text))
        if not any(base + name in paths for base in BASES) and name not in names
    )


def missing_folders(text: str, known: Iterable[str]) -> list[str]:
    """Name the folders of a text, written with a slash at their end, that are nowhere."""
    paths = set(known)
    return sorted(
        name
        for name in set(_FOLDER.findall(text))
        if not any(base + name.rstrip("/") in paths for base in BASES)
    )


def unnamed_folders(text: str, folders: Iterable[str]) -> list[str]:
    """Name the folders with code that a text doesn't name."""
    named = set(_FOLDER.findall(text))
    return sorted(
        folder
        for folder in folders
        if not any(
            f"{folder}/".removeprefix(base) in named for base in BASES if folder.startswith(base)
        )
    )


def signatures(text: str) -> Iterator[tuple[tuple[str, ...], str]]:
    """Give what the blocks of code define or call, with the files that it is said of."""
    for block in _BLOCK.findall(text):
        files: tuple[str, ...] = ()
        for line in block.splitlines():
            here = tuple(_FILE.findall(line))
            if line.startswith("#") and here:
                files = here
            names = _DEFINED.findall(line)
            if line.startswith("# ") and here == files:
                names += _CALLED.findall(line)
            yield from ((files, name) for name in names)


def sources_of(names: Iterable[str]) -> str:
    """Give the text of files as the page names them."""
    return "\n".join(
        text
        for name in names
        for path, text in program().items()
        if any(path == base + name for base in BASES)
        or ("/" not in name and PurePosixPath(path).name == name)
    )


def test_every_file_that_the_page_names_is_there() -> None:
    assert missing_files(page(), python_files()) == []


def test_every_folder_that_the_page_names_is_there() -> None:
    below = {path.relative_to(ROOT).as_posix() for path in ROOT.glob("*/**/") if path.is_dir()}
    assert missing_folders(page(), below | {path.name for path in ROOT.iterdir()}) == []


def test_every_folder_with_code_is_named() -> None:
    files = python_files("processing", "widgets", "app")
    folders = {
        str(PurePosixPath(name).parent) for name in files if not name.endswith("__init__.py")
    }
    assert unnamed_folders(page(), folders) == []


def test_every_signature_stands_in_its_file() -> None:
    absent = [
        (files, name)
        for files, name in signatures(page())
        if not re.search(rf"\b{name}\b", sources_of(files))
    ]
    assert absent == []


def test_every_class_that_the_page_names_is_there() -> None:
    words = set(re.findall(r"\w+", "\n".join(program().values())))
    said = {name.removesuffix("s") for name in _CAMEL.findall(page())}
    known = {word.removesuffix("s") for word in words}
    assert sorted(said - known - {"GeoPackage"}) == []


def test_what_is_not_there_is_caught() -> None:
    known = ["processing/map/feature.py", "app/wiring.py"]
    assert missing_files("`map/feature.py`, `wiring.py` and `map/gone.py`", known) == [
        "map/gone.py"
    ]
    assert missing_folders("`map/`, `app/`, `points/`", ["processing/map", "app"]) == ["points/"]
    assert unnamed_folders("`map/`", ["processing/map", "app/cli"]) == ["app/cli"]


@pytest.mark.parametrize("line", ["class Feature: ...", "# map/feature.py  with_kind(feature)"])
def test_signatures_are_read_with_their_file(line: str) -> None:
    ((files, name),) = signatures(f"```python\n# map/feature.py\n{line}\n```")
    assert files == ("map/feature.py",)
    assert name in {"Feature", "with_kind"}
