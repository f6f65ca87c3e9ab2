"""Which tests belong to a file: those that import it, and those of the folder that mirrors its."""

from __future__ import annotations

import ast
from itertools import takewhile
from pathlib import Path

_FAR = ("journeys", "house_rules", "installer", "mutation")
"""Tests of the whole program: they take long, and what only they see is as good as untested."""

_MOST = 4
"""Test files for one file of the program: what half of the tests import is seen by the nearest."""


def importing_tests(root: Path) -> dict[str, list[Path]]:
    """The test files that import each module, by its dotted name."""
    found: dict[str, list[Path]] = {}
    for path in sorted((root / "tests").rglob("test_*.py")):
        if path.relative_to(root / "tests").parts[0] in _FAR:
            continue
        for module in _imported(ast.parse(path.read_text("utf-8"))):
            found.setdefault(module, []).append(path.relative_to(root))
    return found


def chosen_tests(path: Path, by_module: dict[str, list[Path]], root: Path) -> list[Path]:
    """The tests of a file, all relative to the root; the nearest ones first.

    Those that import it; then those that name it and stand where its folder is mirrored, as what
    the registries load is imported by no one; then those of the files that import it.
    """
    module = ".".join(path.with_suffix("").parts)
    importing = sorted(by_module.get(module, []), key=lambda one: _steps_apart(one, path))
    folder = root / "tests" / path.parent
    while not folder.is_dir():
        folder = folder.parent
    beside = [one.relative_to(root) for one in sorted(folder.glob("test_*.py"))]
    naming = [one for one in beside if path.stem in (root / one).read_text("utf-8")]
    of_users = [
        test
        for user in _users(module, root)
        for test in sorted(by_module.get(user, []), key=lambda one: _steps_apart(one, path))
    ]
    found = [*importing, *naming, *of_users] or beside
    return list(dict.fromkeys(found))[:_MOST]


def _users(module: str, root: Path) -> list[str]:
    """The modules of the program that import one from its own part."""
    folder = (root / Path(*module.split("."))).parent
    return [
        ".".join(one.relative_to(root).with_suffix("").parts)
        for one in sorted(folder.parent.rglob("*.py"))
        if module in _imported(ast.parse(one.read_text("utf-8")))
    ]


def _steps_apart(test: Path, path: Path) -> tuple[int, bool]:
    """Folders up and down from a file to a test, as if they stood in one tree; then by name."""
    there, here = test.parts[1:-1], path.parts[:-1]
    shared = sum(
        1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(there, here, strict=False))
    )
    return len(there) + len(here) - 2 * shared, test.stem != f"test_{path.stem}"


def _imported(tree: ast.Module) -> set[str]:
    """Every module that is named in an import, also as ``from folder import module``."""
    found = set[str]()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {one.name for one in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{one.name}" for one in node.names)}
    return found
