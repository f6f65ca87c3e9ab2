"""The command that finds what tests don't see: its changes, its choice of tests, its verdicts."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

from tests.mutation.chosen_tests import chosen_tests, importing_tests
from tests.mutation.mutants import count_mutants, mutant_of

ROOT = Path(__file__).parents[2]
SOURCE = '''"""Widths."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from nowhere import one

LEAST_M: float = 0.5


def is_wide(width_m: float, *, is_checked: bool = True) -> bool:
    """Whether 1 + 1 is said."""
    check(f"{width_m + 1}")
    return is_checked and not width_m - LEAST_M < 2


@kernel
def add(first: int) -> int:
    return first + 1
'''


def changes(source: str) -> set[tuple[str, str]]:
    mutants = [mutant_of(source, number) for number in range(count_mutants(source))]
    return {(one.before, one.after) for one in mutants}


def test_each_part_that_decides_is_changed_and_nothing_that_only_speaks() -> None:
    whole = "is_checked and (not width_m - LEAST_M < 2)"
    assert changes(SOURCE) == {
        ("0.5", "1.0"),
        ("check(f'{width_m + 1}')", "pass"),
        (f"return {whole}", "return None"),
        (whole, "is_checked or not width_m - LEAST_M < 2"),
        ("not width_m - LEAST_M < 2", "width_m - LEAST_M < 2"),
        ("width_m - LEAST_M < 2", "width_m - LEAST_M <= 2"),
        ("width_m - LEAST_M", "width_m + LEAST_M"),
        ("2", "3"),
    }


def test_a_mutant_differs_in_one_place_and_says_its_line() -> None:
    one = mutant_of(SOURCE, 0)
    assert (one.line, one.before) == (8, "0.5")
    plain, changed = (ast.unparse(ast.parse(text)).splitlines() for text in (SOURCE, one.source))
    assert [after for before, after in zip(plain, changed, strict=True) if before != after] == [
        "LEAST_M: float = 1.0"
    ]


def test_the_tests_of_a_file_import_it_name_it_or_use_what_uses_it(tmp_path: Path) -> None:
    texts = {
        "map/line.py": "",
        "map/plan.py": "from map import line",
        "map/reader.py": "",
        "tests/map/test_line.py": "from map.line import length",
        "tests/map/test_files.py": "# the reader is loaded by its name",
        "tests/test_plan.py": "import map.plan",
        "tests/journeys/test_all.py": "from map.line import length",
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    by_module = importing_tests(tmp_path)

    def chosen(name: str) -> list[str]:
        return [str(one) for one in chosen_tests(Path(name), by_module, tmp_path)]

    assert chosen("map/line.py") == ["tests/map/test_line.py", "tests/test_plan.py"]
    assert chosen("map/reader.py") == ["tests/map/test_files.py"]


def test_a_change_that_no_test_sees_is_named_and_one_that_a_test_sees_is_not(
    tmp_path: Path,
) -> None:
    (tmp_path / "pyproject.toml").write_text("[tool.pytest.ini_options]\npythonpath = ['.']\n")
    (tmp_path / "widths.py").write_text("def half(width):\n    return width / 2\n")
    (tmp_path / "test_widths.py").write_text(
        "from widths import half\n\n\ndef test_half():\n    assert half(4) == 2\n"
    )
    tried = (
        "from pathlib import Path; from tests.mutation.forked_tests import run_tests;"
        f"print(run_tests(Path({str(tmp_path)!r}), [Path('test_widths.py')], 60.0)[0])"
    )

    def outcome() -> str:
        words = [sys.executable, "-c", tried]
        return subprocess.run(
            words, cwd=ROOT, check=True, capture_output=True, text=True
        ).stdout.strip()

    assert outcome() == "passed"
    (tmp_path / "widths.py").write_text(mutant_of("def half(w):\n    return w / 2\n", 1).source)
    assert outcome() == "killed"
