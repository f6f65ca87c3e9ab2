"""Numbers in lines of text, many of them: parsed a few megabytes at a time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.errors import UNCHANGED, BadFile, told_as_user_error
from processing.text import Text

_BLOCK_BYTES = 8 << 20
_SEPARATORS = bytes.maketrans(b",;\t\r", b"    ")
_COMMENTS = (b"#", b"//")


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
    """

    path: Path
    start: int = 0
    skip: int = 0
    limit: int | None = None


def number_blocks(part: TextPart, columns: int) -> Iterator[NDArray[np.float64]]:
    """The numbers of a part of a text file.

    Parameters
    ----------
    columns : int
        How many numbers to take of each line; more on the line are passed over.

    Yields
    ------
    (k, columns) float64
        Blank lines and lines that begin with ``#`` or ``//`` are left out. Numbers are divided
        by blanks, tabs, commas or semicolons.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        The file can't be read, or a line doesn't begin with so many numbers: names the line.
    """
    skip, left = part.skip, part.limit
    for first_line, lines in _line_blocks(part):
        kept = [
            (first_line + i, line)
            for i, line in enumerate(lines)
            if line.strip() and not line.lstrip().startswith(_COMMENTS)
        ]
        passed = min(skip, len(kept))
        skip -= passed
        kept = kept[passed:] if left is None else kept[passed : passed + left]
        if kept:
            yield _parsed(part.path, kept, columns)
        if left is not None:
            left -= len(kept)
            if left == 0:
                return


def _line_blocks(part: TextPart) -> Iterator[tuple[int, list[bytes]]]:
    """Whole lines with separators made blanks, and the number of the first one in the file."""
    with told_as_user_error(part.path), part.path.open("rb") as file:
        line = file.read(part.start).count(b"\n") + 1
        rest, data = b"", file.read(_BLOCK_BYTES)
        while data:
            following = file.read(_BLOCK_BYTES)
            # The last line may lack its end.
            head, end, tail = (rest + data + (b"" if following else b"\n")).rpartition(b"\n")
            if not end:
                raise _bad_line(part.path, line, b"")
            lines = head.translate(_SEPARATORS).split(b"\n")
            yield line, lines
            line += len(lines)
            rest, data = tail, following


def _parsed(path: Path, lines: list[tuple[int, bytes]], columns: int) -> NDArray[np.float64]:
    words = [line.decode("latin-1") for _, line in lines]
    try:
        return np.loadtxt(words, usecols=range(columns), ndmin=2, comments=None)
    except ValueError as error:
        for number, line in lines:
            if not _has_numbers(line, columns):
                raise _bad_line(path, number, line) from error
        raise _bad_line(path, lines[0][0], lines[0][1]) from error


def _has_numbers(line: bytes, columns: int) -> bool:
    words = line.split()[:columns]
    try:
        return len([float(word) for word in words]) == columns
    except ValueError:
        return False


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
