"""Numbers in lines of text, many of them: parsed a few megabytes at a time."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.text import Text

_BLOCK_BYTES = 8 << 20
_SEPARATORS = bytes.maketrans(b",;\t\r", b"    ")
_COMMENTS = (b"#", b"//", b"%")
_EMPTY_CELLS = (b",,", b", ,", b";;", b"; ;", b"\t\t", b"\n,")
_EMPTY_CELL = re.compile(rb"(?m)(?:^|(?<=,)) *(?=,)|(?<=;) *(?=;)|(?<=\t) *(?=\t)")


@dataclass(frozen=True)
class TextPart:
    """Where in a text file the numbers are.

    Attributes
    ----------
    start : int
        Byte where the first line begins.
    skip : int
        Lines to pass over from there, blank ones and comments not counted.
    limit : int or None
        Lines to take after that.
    width : int or None
        Words that each line has where some are no numbers, so that none can be taken for another.
    """

    path: Path
    start: int = 0
    skip: int = 0
    limit: int | None = None
    width: int | None = None


class NumberLines:
    """The lines of an open text file, taken one stretch after the other.

    Blank lines and lines that begin with ``#``, ``//`` or ``%`` are passed over. Numbers are
    divided by blanks, tabs, commas or semicolons; a cell without anything is no number.

    Parameters
    ----------
    path : Path
        For messages.
    file : BinaryIO
        Open at the first line; read by this object alone.
    """

    def __init__(self, path: Path, file: BinaryIO) -> None:
        self._path = path
        self._file = file
        self._following_line = 1 + _lines_before(file)
        self._data = file.read(_BLOCK_BYTES)
        self._rest = b""
        self._kept: list[tuple[int, bytes]] = []
        self._taken = 0

    def skip(self, lines: int) -> None:
        """Pass over so many lines, or all that are left.

        Raises
        ------
        MissingInput, NoSpace, BadFile
            As :meth:`numbers`.
        """
        while lines and self._has_more():
            passed = min(lines, len(self._kept) - self._taken)
            self._taken += passed
            lines -= passed

    def width(self) -> int:
        """Words in the next line, which is not taken; 0 at the end."""
        return len(self._kept[self._taken][1].split()) if self._has_more() else 0

    def numbers(
        self, columns: int | Sequence[int], limit: int | None = None, *, width: int | None = None
    ) -> Iterator[NDArray[np.float64]]:
        """The numbers of the next lines.

        Parameters
        ----------
        columns : int or sequence of int
            How many numbers to take of each line, or which; others on the line are passed over.
        limit : int or None
            Lines to take; None for all that are left.
        width : int or None
            Words that each line must have.

        Yields
        ------
        (k, columns) float64

        Raises
        ------
        MissingInput, NoSpace, BadFile
            The file can't be read, or a line hasn't these numbers: names the line.
        """
        wanted = tuple(range(columns)) if isinstance(columns, int) else tuple(columns)
        while (limit is None or limit > 0) and self._has_more():
            end = len(self._kept) if limit is None else self._taken + limit
            lines = self._kept[self._taken : end]
            self._taken += len(lines)
            if width is not None:
                _refuse_other_widths(self._path, lines, width)
            yield _parse_lines(self._path, lines, wanted)
            if limit is not None:
                limit -= len(lines)

    def _has_more(self) -> bool:
        """Whether a line is at hand, after reading on if need be."""
        while self._taken == len(self._kept) and self._data:
            self._kept, self._taken = self._next_lines(), 0
        return self._taken < len(self._kept)

    def _next_lines(self) -> list[tuple[int, bytes]]:
        """Whole lines with separators made blanks, each with its number in the file."""
        with report_as_user_error(self._path):
            following = self._file.read(_BLOCK_BYTES)
        # The last line may lack its end.
        data = self._rest + self._data + (b"" if following else b"\n")
        head, end, self._rest = data.rpartition(b"\n")
        first_line, self._data = self._following_line, following
        if not end:
            raise _bad_line(self._path, first_line, b"")
        lines = _divide_cells(head).split(b"\n")
        self._following_line += len(lines)
        return [
            (first_line + i, line)
            for i, line in enumerate(lines)
            if line.strip() and not line.lstrip().startswith(_COMMENTS)
        ]


def words_in(line: bytes) -> list[bytes]:
    """The words of a line of numbers as they are counted here; ``?`` for an empty cell."""
    return _divide_cells(line.rstrip(b",;\t\r\n ")).split()


def number_blocks(part: TextPart, columns: int | Sequence[int]) -> Iterator[NDArray[np.float64]]:
    """The numbers of a part of a text file: (k, columns) float64 at a time.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        As :meth:`NumberLines.numbers`.
    """
    with report_as_user_error(part.path), part.path.open("rb") as file:
        file.seek(part.start)
        lines = NumberLines(part.path, file)
        lines.skip(part.skip)
        yield from lines.numbers(columns, part.limit, width=part.width)


def _divide_cells(text: bytes) -> bytes:
    """Lines with separators made blanks; an empty cell stays a word, or the others would move."""
    if text.startswith(b",") or any(cell in text for cell in _EMPTY_CELLS):
        text = _EMPTY_CELL.sub(b"?", text)
    return text.translate(_SEPARATORS)


def _lines_before(file: BinaryIO) -> int:
    """Line ends before the place where the file stands; it stands there again afterwards."""
    start, lines = file.tell(), 0
    file.seek(0)
    while (left := start - file.tell()) > 0:
        lines += file.read(min(left, _BLOCK_BYTES)).count(b"\n")
    return lines


def _refuse_other_widths(path: Path, lines: list[tuple[int, bytes]], width: int) -> None:
    for number, line in lines:
        if len(line.split()) != width:
            raise _bad_line(path, number, line)


def _parse_lines(
    path: Path, lines: list[tuple[int, bytes]], columns: tuple[int, ...]
) -> NDArray[np.float64]:
    words = [line.decode("latin-1") for _, line in lines]
    try:
        return np.loadtxt(words, usecols=columns, ndmin=2, comments=None)
    except ValueError as error:
        for number, line in lines:
            if not _has_numbers(line, columns):
                raise _bad_line(path, number, line) from error
        raise _bad_line(path, lines[0][0], lines[0][1]) from error


def _has_numbers(line: bytes, columns: tuple[int, ...]) -> bool:
    words = line.split()
    try:
        for at in columns:
            float(words[at])
    except (ValueError, IndexError):
        return False
    return True


def _bad_line(path: Path, number: int, line: bytes) -> BadFile:
    shown = " ".join(line[:60].decode("ascii", "replace").split())
    return BadFile(
        Text(
            f"The line is not the numbers it should be: “{shown}”.",
            f"数値の行として読み取れません：「{shown}」。",
        ),
        Text(f"{path}, line {number:,}", f"{path}、{number:,}行目"),
        Text(
            "Correct the line, or copy the file again from the delivery. {unchanged}",
            "その行を修正するか、納品データからコピーし直してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
