"""Points as text: XYZ, PTS, TXT, CSV, with or without a header line."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from processing.errors import UNCHANGED, BadFile, told_as_user_error
from processing.formats.delivered_floats import Block, FloatFile
from processing.formats.field_names import block_of, has_position
from processing.formats.japanese_text import decoded
from processing.formats.text_numbers import TextPart, number_blocks
from processing.text import Text

_LOOKED_AT = 1 << 16
_UTF8_MARK = b"\xef\xbb\xbf"
_BY_COLUMNS: dict[int, tuple[str, ...]] = {
    3: ("x", "y", "z"),
    4: ("x", "y", "z", "intensity"),
    5: ("x", "y", "z", "intensity"),
    6: ("x", "y", "z", "red", "green", "blue"),
    7: ("x", "y", "z", "intensity", "red", "green", "blue"),
}
_MOST_COLUMNS = 7


@dataclass(frozen=True)
class _Layout:
    names: tuple[str, ...]
    part: TextPart


def open_text_points(path: Path) -> FloatFile:
    """A text file of points.

    Parameters
    ----------
    path : Path
        Lines of numbers, divided by blanks, tabs, commas or semicolons. A header line names the
        columns; without one they are x y z, x y z intensity, x y z red green blue, or x y z
        intensity red green blue (more are passed over). A first line with one whole number is
        the number of points (PTS) and passed over.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, is not text, or doesn't begin with points.
    """
    layout = _read_layout(path)
    return FloatFile(path, "text", lambda: _blocks(layout))


def _blocks(layout: _Layout) -> Iterator[Block]:
    for numbers in number_blocks(layout.part, len(layout.names)):
        yield block_of({name: numbers[:, i] for i, name in enumerate(layout.names)})


def _read_layout(path: Path) -> _Layout:
    with told_as_user_error(path), path.open("rb") as file:
        start = file.read(_LOOKED_AT)
    place = len(_UTF8_MARK) if start.startswith(_UTF8_MARK) else 0
    # A header may be Japanese; a NUL can be in no line of text.
    for line in start[place:].splitlines(keepends=True) if b"\0" not in start else ():
        place += len(line)
        words = _words(decoded(line, path))
        if not words or _is_count(words):
            continue
        if all(_is_number(word) for word in words):
            names = _BY_COLUMNS.get(min(len(words), _MOST_COLUMNS))
            if names is None:
                break
            return _Layout(names, TextPart(path, place - len(line)))
        if has_position(tuple(words)):
            return _Layout(tuple(words), TextPart(path, place))
        if not line.lstrip().startswith((b"#", b"//")):
            break
    raise _no_points(path)


def _words(line: str) -> list[str]:
    separator = next((mark for mark in (",", ";", "\t") if mark in line), None)
    words = [word.strip(' \t\r\n"/#') for word in line.split(separator)]
    while words and not words[-1]:
        words.pop()
    return words


def _is_count(words: list[str]) -> bool:
    return len(words) == 1 and words[0].isascii() and words[0].isdigit()


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _no_points(path: Path) -> BadFile:
    return BadFile(
        Text("It is not a point file that Zuka knows.", "対応していない点群ファイルです。"),
        Text.same(str(path)),
        Text(
            "Choose LAS, LAZ, PLY, PCD, E57, PTX, or text with x y z on each line. {unchanged}",
            "LAS・LAZ・PLY・PCD・E57・PTX、または各行にx・y・zのあるテキストを選んでください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
