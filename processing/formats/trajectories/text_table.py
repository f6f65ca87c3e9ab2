"""CSV with a header line: columns found by name, numbers checked, damage named by line."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, BadFile
from processing.core.japanese_text import read_lines
from processing.core.text import Text

_SEPARATORS = (",", "\t", ";")


@dataclass(frozen=True)
class TextTable:
    """A table of text cells.

    Attributes
    ----------
    columns : tuple of str
        Names in the header, lower case, without blanks around them.
    rows : tuple of list of str
        Rows that are not blank, each as long as the header.
    lines : tuple of int
        Line of each row in the file, 1-based.
    """

    path: Path
    columns: tuple[str, ...]
    rows: tuple[list[str], ...]
    lines: tuple[int, ...]

    def has(self, column: str) -> bool:
        """Whether the table has a column of this name."""
        return column.lower() in self.columns

    def words(self, column: str) -> list[str]:
        """The cells of one column.

        Raises
        ------
        BadFile
            There is no such column.
        """
        self.require((column,))
        position = self.columns.index(column.lower())
        return [row[position].strip() for row in self.rows]

    def numbers(
        self, column: str, low: float = -np.inf, high: float = np.inf
    ) -> NDArray[np.float64]:
        """The numbers of one column.

        Parameters
        ----------
        low, high : float
            What a number must lie between.

        Returns
        -------
        (n,) float64
            Finite.

        Raises
        ------
        BadFile
            The column is missing; a cell is no number, not finite, or out of bounds: its line.
        """
        words = self.words(column)
        try:
            values = np.array([float(word) for word in words], dtype=np.float64)
        except ValueError:
            bad = next(i for i, word in enumerate(words) if not _is_number(word))
            raise self.damage(bad, _NO_NUMBER.filled(cell=words[bad][:40], column=column)) from None
        good = np.isfinite(values) & (values >= low) & (values <= high)
        if not good.all():
            bad = int(np.argmin(good))
            raise self.damage(bad, _NOT_POSSIBLE.filled(cell=words[bad][:40], column=column))
        return values

    def require(self, columns: Sequence[str]) -> None:
        """Check that columns are there.

        Raises
        ------
        BadFile
            Names those that are not.
        """
        missing = [name for name in columns if name.lower() not in self.columns]
        if missing:
            names = ", ".join(missing)
            raise _bad_file(
                self.path,
                1,
                Text(f"The header lacks {names}.", f"見出し行に {names} がありません。"),
            )

    def damage(self, row: int, what: Text) -> BadFile:
        """What is wrong in a row, with its line."""
        return _bad_file(self.path, self.lines[row], what)


_NO_NUMBER = Text(
    "“{cell}” in column {column} is not a number.", "{column}列の「{cell}」は数値ではありません。"
)
_NOT_POSSIBLE = Text(
    "{cell} can't be a value of column {column}.", "{column}列の値 {cell} は使えません。"
)


def read_table(path: Path) -> TextTable:
    """Read a table of text cells.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, is not text, has no header, or a row is too short (names the line).
    """
    lines = read_lines(path)
    first = next((i for i, line in enumerate(lines) if line.strip()), None)
    if first is None:
        raise _bad_file(path, 1, Text("The file is empty.", "ファイルが空です。"))
    separator = max(_SEPARATORS, key=lines[first].count)
    header: list[str] = []
    rows: list[list[str]] = []
    numbers: list[int] = []
    reader = csv.reader(lines[first:], delimiter=separator)
    try:
        for row in reader:
            if not any(cell.strip() for cell in row):
                continue
            if not header:
                header = [cell.strip().lower() for cell in row]
                continue
            if len(row) < len(header):
                raise _bad_file(
                    path,
                    first + reader.line_num,
                    Text(
                        f"The line has {len(row)} cells; the header has {len(header)}.",
                        f"この行には{len(row)}個の値しかありません（見出しは{len(header)}列）。",
                    ),
                )
            rows.append(row)
            numbers.append(first + reader.line_num)
    except csv.Error as error:
        raise _bad_file(
            path,
            first + reader.line_num,
            Text("The line can't be divided into cells.", "行を列に分割できません。"),
        ) from error
    return TextTable(path, tuple(header), tuple(rows), tuple(numbers))


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _bad_file(path: Path, line: int, what: Text) -> BadFile:
    return BadFile(
        what,
        Text(f"{path}, line {line:,}", f"{path}、{line:,}行目"),
        Text(
            "Correct the line, or copy the file again from the delivery. {unchanged}",
            "その行を修正するか、納品データからコピーし直してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
