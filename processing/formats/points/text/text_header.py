"""How a text file of points begins: which column is which, and where the points are."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from processing.core.errors import UNCHANGED, BadFile, OutOfRange, report_as_user_error
from processing.core.japanese_text import decode_text
from processing.core.text import Text
from processing.formats.points.text.column_words import (
    PASSED_OVER,
    POSITION,
    Certainty,
    HeaderReading,
    field_of,
    read_header,
    taken_columns,
)
from processing.formats.points.text.text_numbers import words_in

_LOOKED_AT = 1 << 16
_UTF8_MARK = b"\xef\xbb\xbf"
_COMMENTS = (b"#", b"//", b"%", b";")
_INTENSITY, _COLOUR = ("intensity",), ("red", "green", "blue")
_BY_WIDTH: dict[int, tuple[str, ...]] = {
    3: POSITION,
    4: (*POSITION, *_INTENSITY),
    5: (*POSITION, *_INTENSITY),
    6: (*POSITION, *_COLOUR),
    7: (*POSITION, *_INTENSITY, *_COLOUR),
}
_MOST_USUAL = 7
_LEAST_NUMBERS = 3
_SHOWN_ROWS = 8
_DECIMAL_COMMA = re.compile(rb"^[-+]?\d+,\d+$")
_BETWEEN_CELLS = re.compile(rb"[;\t ]+")


class ColumnsNeeded(BadFile):
    """A text file of points whose columns somebody must name.

    Parameters
    ----------
    path : Path
    what : Text
        Why they are not understood.
    line : int
        Where that is said, 1-based.
    """

    def __init__(self, path: Path, what: Text, line: int) -> None:
        self.path = path
        super().__init__(
            what,
            Text(f"{path}, line {line:,}", f"{path}、{line:,}行目"),
            Text(
                "Name the columns, with - for one to be passed over: --columns x,y,z,intensity on "
                "the command line, the form in the window; or correct the header. {unchanged}",
                "列の名前を指定してください（不要な列は -）。コマンドラインでは --columns x,y,z,"
                "intensity、画面では列の指定フォームを使うか、見出し行を修正してください。"
                "{unchanged}",
            ).filled(unchanged=UNCHANGED),
        )


@dataclass(frozen=True)
class Heading:
    """Where the points of a text file begin, and what their columns are.

    Attributes
    ----------
    columns : tuple of str
        The field of each column, ``-`` for one that is passed over.
    start : int
        Byte of the first line of points.
    has_words : bool
        Whether some cells are no numbers.
    is_named : bool
        Whether the file itself names them.
    """

    columns: tuple[str, ...]
    start: int
    has_words: bool
    is_named: bool


@dataclass(frozen=True)
class TextBeginning:
    """The first lines of a text file of points.

    Attributes
    ----------
    header : tuple of (int, str)
        Lines above the points that are text, with their number.
    line, start : int
        The first line of points: its number, and its byte.
    rows : tuple of tuple of str
        The cells of the first points.
    """

    path: Path
    header: tuple[tuple[int, str], ...]
    line: int
    start: int
    rows: tuple[tuple[str, ...], ...]

    @property
    def width(self) -> int:
        """Columns of the first line of points."""
        return len(self.rows[0])

    @property
    def has_words(self) -> bool:
        """Whether cells of the first line are no numbers."""
        return not all(_is_number(word) for word in self.rows[0])


def read_heading(path: Path, columns: tuple[str, ...] = ()) -> Heading:
    """What the columns of a text file of points are.

    Parameters
    ----------
    columns : tuple of str
        Their names, as somebody gave them; empty to go by the file. A file without a header has
        x y z, x y z intensity, x y z red green blue, or x y z intensity red green blue.

    Raises
    ------
    ColumnsNeeded
        Its header is not understood for certain.
    OutOfRange
        The given names don't fit.
    MissingInput, NoSpace, BadFile
        It can't be read, is not text, or has no points.
    """
    begins = read_beginning(path)
    if columns:
        given = _given_fields(columns, begins)
        return Heading(given, begins.start, begins.has_words, is_named=False)
    readings = [(at, line, read_header(line, begins.width)) for at, line in begins.header]
    certain = {one.columns for _, _, one in readings if one.certainty is Certainty.CERTAIN}
    unclear = [one for one in readings if one[2].certainty is not Certainty.NO_HEADER]
    if len(certain) == 1:
        return Heading(certain.pop(), begins.start, begins.has_words, is_named=True)
    if unclear:
        raise _unclear(begins, *unclear[-1])
    usual = _BY_WIDTH[min(begins.width, _MOST_USUAL)]
    if begins.has_words:
        what = Text(
            "Cells are no numbers, and no header says what the columns are.",
            "数値でない列がありますが、列名の見出し行がありません。",
        )
        raise ColumnsNeeded(path, what, begins.line)
    rest = (PASSED_OVER,) * (begins.width - len(usual))
    return Heading((*usual, *rest), begins.start, has_words=False, is_named=False)


def read_beginning(path: Path) -> TextBeginning:
    """The lines above the points, and the first points.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, is not text, or has no line with three numbers near its start.
    """
    with report_as_user_error(path), path.open("rb") as file:
        start = file.read(_LOOKED_AT)
    position = len(_UTF8_MARK) if start.startswith(_UTF8_MARK) else 0
    header: list[tuple[int, str]] = []
    # A header may be Japanese; a NUL can be in no line of text.
    lines = start[position:].splitlines(keepends=True) if b"\0" not in start else []
    for number, line in enumerate(lines, 1):
        if _is_points(line):
            _refuse_decimal_commas(path, number, line)
            rows = (words_in(one) for one in lines[number - 1 :])
            shown = islice((row for row in rows if row), _SHOWN_ROWS)
            cells = tuple(tuple(decode_text(word, path) for word in row) for row in shown)
            return TextBeginning(path, tuple(header), number, position, cells)
        position += len(line)
        text = decode_text(line, path)
        if text.strip() and not _is_count(text):
            header.append((number, text.strip()))
    raise _no_points(path)


def _is_points(line: bytes) -> bool:
    if line.lstrip().startswith(_COMMENTS):
        return False
    numbers = sum(_is_number(word.decode("latin-1")) for word in words_in(line))
    return numbers >= _LEAST_NUMBERS


def _given_fields(columns: tuple[str, ...], begins: TextBeginning) -> tuple[str, ...]:
    """The fields of columns that somebody named."""
    unknown = [name for name in columns if not field_of(name)]
    fields = taken_columns(columns)
    if unknown:
        what = Text("No column is called “{name}”.", "「{name}」という列名は使えません。").filled(
            name=unknown[0]
        )
    elif len(columns) != begins.width:
        what = _COUNTS.filled(names=len(columns), columns=begins.width)
    elif not fields:
        what = Text(
            "x, y and z must each be named once, and nothing else twice.",
            "x・y・zを1回ずつ指定し、ほかの列名も重複させないでください。",
        )
    else:
        return fields
    raise OutOfRange(
        what,
        Text.same(f"{begins.path}: {','.join(columns)}"),
        Text(
            "Name every column: x, y, z, intensity, red, green, blue, time, class; - for one to be "
            "passed over. Import files with other columns by themselves.",
            "すべての列を x・y・z・intensity・red・green・blue・time・class（不要な列は -）で"
            "指定してください。列の並びが異なるファイルは別々にインポートしてください。",
        ),
    )


_COUNTS = Text(
    "{names} names are given for {columns} columns.",
    "列名が{names}個ですが、データは{columns}列です。",
)


def _unclear(
    begins: TextBeginning, number: int, line: str, reading: HeaderReading
) -> ColumnsNeeded:
    if reading.certainty is Certainty.CERTAIN:
        what = Text(
            "Two header lines name the columns differently: “{line}”.",
            "2つの見出し行で列名が食い違っています：「{line}」。",
        )
    else:
        what = Text(
            "The header “{line}” doesn't say for certain what the {columns} columns are.",
            "見出し行「{line}」からは{columns}列の内容を確定できません。",
        )
    return ColumnsNeeded(begins.path, what.filled(line=line[:80], columns=begins.width), number)


def _refuse_decimal_commas(path: Path, number: int, line: bytes) -> None:
    cells = _BETWEEN_CELLS.split(line.strip())
    if sum(bool(_DECIMAL_COMMA.match(cell)) for cell in cells) < _LEAST_NUMBERS:
        return
    raise BadFile(
        Text(
            "Numbers are written with decimal commas.",
            "小数点にカンマが使われています。",
        ),
        Text(f"{path}, line {number:,}", f"{path}、{number:,}行目"),
        Text(
            "Write the file again with decimal points. {unchanged}",
            "小数点をピリオドにして書き出し直してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def _is_count(text: str) -> bool:
    word = text.strip(' \t\r\n"/#,;')
    return word.isascii() and word.isdigit()


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
            "Choose LAS, LAZ, PLY, PCD, E57, PTX, PulseWaves, or text with x y z on each line. "
            "{unchanged}",
            "LAS・LAZ・PLY・PCD・E57・PTX・PulseWaves、または各行にx・y・zのあるテキストを"
            "選んでください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
