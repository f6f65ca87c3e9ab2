"""Files, functions and argument lists stay small enough to be read at once."""

from __future__ import annotations

from tests.house_rules.sources import function_sizes, python_files, text_of

MOST_LINES = 600
MOST_FUNCTION_LINES = 60
MOST_POSITIONAL = 5


def too_long(source: str) -> bool:
    return len(source.splitlines()) > MOST_LINES


def long_functions(source: str) -> list[str]:
    return [
        f"{one.name} (line {one.line}): {one.lines} lines"
        for one in function_sizes(source)
        if one.lines > MOST_FUNCTION_LINES
    ]


def wide_functions(source: str) -> list[str]:
    """Name functions with too many positional parameters.

    Kernels take arrays one by one: numba knows no keyword-only parameters.
    """
    return [
        f"{one.name} (line {one.line}): {one.positional} positional parameters"
        for one in function_sizes(source)
        if one.positional > MOST_POSITIONAL and not one.decorators & {"kernel", "parallel_kernel"}
    ]


def test_no_file_is_longer_than_600_lines() -> None:
    assert [name for name in python_files() if too_long(text_of(name))] == []


def test_a_file_of_601_lines_is_caught() -> None:
    assert too_long("x = 1\n" * 601)
    assert not too_long("x = 1\n" * 600)


def test_no_function_is_longer_than_60_lines() -> None:
    found = {name: long_functions(text_of(name)) for name in python_files()}
    assert {name: functions for name, functions in found.items() if functions} == {}


def test_a_function_of_61_lines_is_caught() -> None:
    body = "    x = 1\n"
    assert long_functions("def f():\n" + body * 60) == ["f (line 1): 61 lines"]
    assert long_functions("def f():\n" + body * 59) == []
    assert long_functions("class C:\n  async def f(self):\n" + body * 60) != []


def test_no_function_takes_more_than_five_positional_parameters() -> None:
    found = {name: wide_functions(text_of(name)) for name in python_files()}
    assert {name: functions for name, functions in found.items() if functions} == {}


def test_a_function_with_six_positional_parameters_is_caught() -> None:
    assert wide_functions("def f(a, b, c, d, e, f): ...") != []
    assert wide_functions("def f(a, b, /, c, d, e, f): ...") != []
    assert wide_functions("def f(a, b, c, d, e, *, f): ...") == []
    assert wide_functions("class C:\n    def f(self, a, b, c, d, e): ...") == []
    assert wide_functions("@kernel\ndef f(a, b, c, d, e, f): ...") == []


def test_the_rules_look_at_every_part_of_the_program() -> None:
    parts = {name.split("/")[0] for name in python_files()}
    assert parts == {"app", "widgets", "processing", "resources", "installer", "tests"}
