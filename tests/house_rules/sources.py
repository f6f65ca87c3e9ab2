"""Which files the house rules look at."""

from __future__ import annotations

import ast
import fnmatch
import gc
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
PARTS = ("app", "widgets", "processing", "resources", "installer", "tests")


def tracked(*, with_new_ones: bool = True) -> tuple[str, ...]:
    """List the files of the project as paths with slashes below the checkout.

    Files that git ignores are left out; without git, so are those that match its ignore list.
    """
    more = ("--others", "--exclude-standard") if with_new_ones else ()
    try:
        answer = subprocess.run(
            ["git", "ls-files", "-z", "--cached", *more], cwd=ROOT, capture_output=True, check=True
        )
    except (FileNotFoundError, subprocess.CalledProcessError):
        return tuple(_not_ignored(ROOT))
    names = answer.stdout.decode().split("\0")
    return tuple(sorted(name for name in names if name and (ROOT / name).is_file()))


def _not_ignored(folder: Path) -> Iterator[str]:
    patterns = (ROOT / ".gitignore").read_text().splitlines()
    for path in sorted(folder.iterdir()):
        name = path.name + ("/" if path.is_dir() else "")
        if any(fnmatch.fnmatch(name, pattern) for pattern in patterns) or name == ".git/":
            continue
        if path.is_dir():
            yield from _not_ignored(path)
        else:
            yield path.relative_to(ROOT).as_posix()


def python_files(*parts: str) -> tuple[str, ...]:
    """List the project's Python files below some of its top-level folders (all by default)."""
    wanted = tuple(f"{part}/" for part in (parts or PARTS))
    return tuple(name for name in tracked() if name.endswith(".py") and name.startswith(wanted))


def text_of(name: str) -> str:
    """Give the text of a file of the project."""
    return (ROOT / name).read_text(encoding="utf-8")


def tree_of(source: str) -> ast.Module:
    """Give the syntax tree of a source.

    Python looks for circles among its objects again and again while so many are made, which takes
    twice as long as making them.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        return ast.parse(source)
    finally:
        if was_on:
            gc.enable()


@dataclass(frozen=True)
class FunctionSize:
    """A function of a source: how long it is, and how many parameters go by their place.

    ``self`` and ``cls`` are not counted.
    """

    name: str
    line: int
    lines: int
    positional: int
    decorators: frozenset[str]


@cache
def function_sizes(source: str) -> tuple[FunctionSize, ...]:
    """Give every function and method of a source, inner ones too."""
    return tuple(_size_of(function) for function in _functions_of(source))


def _size_of(function: ast.FunctionDef | ast.AsyncFunctionDef) -> FunctionSize:
    names = [one.arg for one in (*function.args.posonlyargs, *function.args.args)]
    return FunctionSize(
        function.name,
        function.lineno,
        (function.end_lineno or 0) - function.lineno + 1,
        len(names) - (names[:1] in (["self"], ["cls"])),
        frozenset(ast.unparse(decorator) for decorator in function.decorator_list),
    )


def _functions_of(source: str) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    for node in ast.walk(tree_of(source)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node
