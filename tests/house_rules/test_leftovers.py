"""Nothing half done and nothing generated is kept."""

from __future__ import annotations

import re
from collections.abc import Iterable
from fnmatch import fnmatch

from tests.house_rules.sources import python_files, text_of, tracked

THIS_FILE = "tests/house_rules/test_leftovers.py"  # names what it looks for
LEFTOVERS = re.compile(
    r"\b(TODO|FIXME|XXX|HACK)\b|NotImplementedError|unittest\.mock|MagicMock|mock\.patch"
    r"|pytest\.mark\.(skip|xfail)"
)
GENERATED = (
    "*.qm",
    "*.pyc",
    "*.nbi",
    "*.nbc",
    "*_rc.py",
    "ui_*.py",
    "*.egg-info/*",
    "build/*",
    "dist/*",
    "demo-output/*",
    ".venv/*",
)


def leftovers(source: str) -> list[str]:
    return [
        f"line {number}: {line.strip()}"
        for number, line in enumerate(source.splitlines(), 1)
        if LEFTOVERS.search(line)
    ]


def generated(names: Iterable[str]) -> list[str]:
    return [
        name
        for name in names
        if any(fnmatch(name, one) or fnmatch(name, f"*/{one}") for one in GENERATED)
    ]


def test_no_work_is_left_in_a_comment_and_nothing_is_mocked() -> None:
    found = {name: leftovers(text_of(name)) for name in python_files() if name != THIS_FILE}
    assert {name: lines for name, lines in found.items() if lines} == {}


def test_leftovers_are_caught() -> None:
    for line in ("# TODO: later", "raise NotImplementedError", "from unittest.mock import patch"):
        assert leftovers(f"x = 1\n{line}\n") == [f"line 2: {line}"]
    assert leftovers("todo = 1\n") == []


def test_no_generated_file_is_in_git() -> None:
    names = tracked(with_new_ones=False)
    assert "pyproject.toml" in names
    assert generated(names) == []


def test_a_generated_file_is_caught() -> None:
    names = ["resources/translations/zuka_ja.qm", "widgets/ui_form.py", "zuka.egg-info/PKG-INFO"]
    assert generated(names) == names
    assert generated(["resources/translations/zuka_ja.ts", "widgets/guide.py"]) == []


def test_the_sample_street_is_small_enough_to_be_carried_along() -> None:
    from resources import path_of

    files = [path for path in path_of("sample_street").rglob("*") if path.is_file()]
    assert 1_000_000 < sum(path.stat().st_size for path in files) < 3_500_000
