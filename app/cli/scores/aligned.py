"""Tables on a terminal, in which Japanese letters are two places wide."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence


def align_lines(rows: Sequence[Sequence[str]]) -> list[str]:
    """Lines of a table: the first column to the left, all others to the right.

    Parameters
    ----------
    rows : sequence of sequence of str
        The cells of each row, the same number in all.
    """
    widths = [max(_width(cell) for cell in column) for column in zip(*rows, strict=True)]
    return [
        "  ".join(
            _pad_words(cell, width, is_left=position == 0)
            for position, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def _width(words: str) -> int:
    return sum(2 if unicodedata.east_asian_width(one) in "WF" else 1 for one in words)


def _pad_words(words: str, width: int, *, is_left: bool) -> str:
    blanks = " " * (width - _width(words))
    return words + blanks if is_left else blanks + words
