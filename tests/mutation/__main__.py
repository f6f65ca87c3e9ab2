"""``python -m tests.mutation PATH... [--count N] [--seed S]``: what tests don't see.

Lines of the program are changed one at a time in a copy, and the tests that belong to the file
are run on each. A mutant that no test kills is a line that may break unnoticed, or one whose change
makes no difference: a person reads which.

Files are drawn in proportion to the changes that they allow and some changes of each, so that the
share that is killed is that of the paths given. Tests with windows need a display.
"""

from __future__ import annotations

import argparse
import random
import shutil
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from tests.mutation.chosen_tests import chosen_tests, importing_tests
from tests.mutation.forked_tests import KILLED, PASSED, SAID, load_libraries, run_tests
from tests.mutation.mutants import Mutant, count_mutants, mutant_of

_ROOT = Path(__file__).parents[2]
_PARTS = ("app", "widgets", "processing", "resources", "installer", "tests", "docs")
_A_FILE = 4
"""Changes of one file: its tests run unchanged once for them all."""

_LONGEST_S, _START_S = 40.0, 30.0
"""Tests that take longer unchanged are left out unless it is said otherwise; a mutant may take
twice their time and a start."""

_NO_TEST = "no test"


@dataclass(frozen=True)
class _Drawn:
    """A file, relative to the root, and the numbers of its changes."""

    path: Path
    numbers: list[int]


def main() -> int:
    """Draw, change, run, and say what survived; gives 0."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__)
    parser.add_argument("paths", nargs="+", type=Path, metavar="PATH")
    parser.add_argument("--count", type=int, default=100, help="changes")
    parser.add_argument("--seed", type=int, default=1, help="the same number draws the same")
    parser.add_argument("--longest", type=float, default=_LONGEST_S, help="of a file's tests, s")
    arguments = parser.parse_args()
    load_libraries()
    with tempfile.TemporaryDirectory(prefix="zuka-mutation-") as folder:
        copy = Path(folder)
        copy_program(copy)
        outcomes = Counter[str]()
        by_module = importing_tests(copy)
        for one in draw(arguments.paths, arguments.count, arguments.seed):
            tests = chosen_tests(one.path, by_module, copy)
            outcomes += _try_file(copy, one, tests, arguments.longest)
            _say("so far: " + ", ".join(f"{count} {name}" for name, count in outcomes.items()))
    return 0


def copy_program(copy: Path) -> None:
    """Copy what the tests need, with kernels as they are compiled."""
    for part in _PARTS:
        shutil.copytree(_ROOT / part, copy / part, ignore=shutil.ignore_patterns("*.pyc"))
    for name in ("pyproject.toml", "README.md", "CHANGELOG.md"):
        shutil.copy2(_ROOT / name, copy)


def draw(paths: list[Path], count: int, seed: int) -> list[_Drawn]:
    """Files in proportion to the changes that they allow, and some changes of each."""
    files = {one: count_mutants((_ROOT / one).read_text("utf-8")) for one in _sources(paths)}
    files = {one: allowed for one, allowed in files.items() if allowed}
    chance = random.Random(seed)  # noqa: S311 - a draw that can be made again
    drawn, left = list[_Drawn](), count
    while left > 0 and files:
        (path,) = chance.choices(list(files), list(files.values()))
        numbers = chance.sample(range(files[path]), min(files.pop(path), _A_FILE, left))
        drawn.append(_Drawn(path, sorted(numbers)))
        left -= len(numbers)
    return drawn


def _sources(paths: list[Path]) -> list[Path]:
    """The program's files at the paths, relative to the root."""
    found = list[Path]()
    for path in paths:
        whole = (_ROOT / path).resolve()
        files = sorted(whole.rglob("*.py")) if whole.is_dir() else [whole]
        found += [one.relative_to(_ROOT) for one in files if one.name != "__init__.py"]
    return found


def _try_file(copy: Path, drawn: _Drawn, tests: list[Path], longest_s: float) -> Counter[str]:
    if not tests:
        return _report_untested(drawn)
    outcome, seconds = run_tests(copy, tests, longest_s, is_changed=False)
    if outcome != PASSED:
        *_, last = ["", *(copy / SAID).read_text("utf-8", "replace").splitlines()]
        _say(f"{drawn.path}: left out, its tests unchanged: {outcome}, {seconds:.0f} s, {last}")
        return Counter({"left out": len(drawn.numbers)})
    source, found = (copy / drawn.path).read_text("utf-8"), Counter[str]()
    for number in drawn.numbers:
        mutant = mutant_of(source, number)
        (copy / drawn.path).write_text(mutant.source, "utf-8")
        outcome, _ = run_tests(copy, tests, 2 * seconds + _START_S)
        found[outcome if outcome != PASSED else "survived"] += 1
        if outcome == PASSED:
            _say(_line(drawn.path, mutant, "survived"))
    shutil.copy2(_ROOT / drawn.path, copy / drawn.path)
    _say(f"{drawn.path}: {found[KILLED]} of {len(drawn.numbers)} killed, {seconds:.0f} s a run")
    return found


def _report_untested(drawn: _Drawn) -> Counter[str]:
    source = (_ROOT / drawn.path).read_text("utf-8")
    for number in drawn.numbers:
        _say(_line(drawn.path, mutant_of(source, number), _NO_TEST))
    return Counter({_NO_TEST: len(drawn.numbers)})


def _line(path: Path, mutant: Mutant, outcome: str) -> str:
    change = f"{mutant.before[:100]}  →  {mutant.after[:100]}".replace("\n", " ")
    return f"{path}:{mutant.line}: {outcome}: {change}"


def _say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
