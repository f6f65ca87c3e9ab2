"""What is run as a program can write every character, whatever its terminal lacks."""

from __future__ import annotations

from tests.house_rules.sources import python_files, text_of

START = 'if __name__ == "__main__":\n'
FIRST = "    write_every_character()\n"
DOOR = "app/__main__.py"
"""Its ``main`` is the installed program too, so the first thing stands there."""


def starts_without(source: str) -> bool:
    """Tell whether a source is a program that may fail for want of a character."""
    _, start, then = source.partition(START)
    return bool(start) and not then.startswith(FIRST)


def test_every_program_first_sees_to_its_output() -> None:
    found = [
        name
        for name in python_files("app", "processing", "widgets")
        if starts_without(text_of(name))
    ]
    assert found == [DOOR]
    _, _, body = text_of(DOOR).partition("def main() -> int:\n")
    assert body.splitlines()[1] == FIRST.rstrip("\n")


def test_a_program_that_does_not_is_caught() -> None:
    assert starts_without(f"{START}    sys.exit(main())\n")
    assert not starts_without(f"{START}{FIRST}    sys.exit(main())\n")
    assert not starts_without("def main() -> None: ...\n")
