"""Who imports whom among the program's own files, read from the sources."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import PurePosixPath

from tests.house_rules.sources import python_files, text_of, tree_of

Graph = Mapping[str, frozenset[str]]
"""What each file, or each folder, imports of the others."""


@cache
def program() -> Mapping[str, str]:
    """Give the sources of the window, the views and the arithmetic by path."""
    return {name: text_of(name) for name in python_files("app", "widgets", "processing")}


@cache
def program_imports() -> Graph:
    """Give what the files of the program import of each other."""
    return imports_of(program())


def imports_of(sources: Mapping[str, str]) -> Graph:
    """Give which of the files each file imports, inside functions and for types too."""
    return {
        name: frozenset(_imported(source, sources)) - {name} for name, source in sources.items()
    }


def folders_of(files: Graph) -> Graph:
    """Give which folders the files of a folder import from."""
    found: dict[str, set[str]] = {}
    for name, imported in files.items():
        folder = folder_of(name)
        others = {folder_of(other) for other in imported} - {folder}
        found.setdefault(folder, set()).update(others)
    return {folder: frozenset(others) for folder, others in found.items()}


def folder_of(name: str) -> str:
    """Give the folder of a file."""
    return PurePosixPath(name).parent.as_posix()


def mutual(graph: Graph) -> list[tuple[str, str]]:
    """Name the pairs that import each other."""
    return sorted(
        (one, other)
        for one, others in graph.items()
        for other in others
        if one < other and one in graph.get(other, ())
    )


def importers(files: Graph) -> dict[str, list[str]]:
    """Give who imports each file."""
    found: dict[str, list[str]] = {name: [] for name in files}
    for name, imported in files.items():
        for other in imported:
            found[other].append(name)
    return found


def _imported(source: str, files: Mapping[str, str]) -> Iterator[str]:
    for node in ast.walk(tree_of(source)):
        if isinstance(node, ast.Import):
            modules = [(one.name, "") for one in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            modules = [(node.module, one.name) for one in node.names]
        else:
            continue
        for module, name in modules:
            path = module.replace(".", "/")
            for candidate in (f"{path}/{name}.py", f"{path}.py"):
                if candidate in files:
                    yield candidate
                    break
