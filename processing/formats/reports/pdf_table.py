"""Tables on papers: reportlab's, its cells broken into lines as Japanese is printed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from processing.core.text import Text
from processing.formats.reports.pdf_page import (
    BLACK,
    FONT,
    LEADING,
    PALE,
    POINTS_OF_MM,
    THICK_MM,
    THIN_MM,
    Align,
    Paper,
    break_lines,
)

if TYPE_CHECKING:
    from reportlab.platypus import Table as PlacedTable

_PADDING_MM, _ABOVE_MM = 1.2, 0.7
_LEAST_ROW_MM = 5.2
_ALL = ((0, 0), (-1, -1))


@dataclass(frozen=True)
class TableCell:
    """A cell; its words are broken into lines where they are too long.

    Attributes
    ----------
    columns, rows : int
        How many it takes; the rows below have an empty cell there.
    is_head : bool
        Shaded, as what names other cells.
    is_result : bool
        In a thick frame, its type larger.
    """

    words: Text | str
    align: Align = "left"
    columns: int = 1
    rows: int = 1
    is_head: bool = False
    is_result: bool = False


TableRow = Sequence[TableCell]


@dataclass(frozen=True)
class Table:
    """Where rows are drawn, and how large their type is.

    Attributes
    ----------
    x : float
        Left edge, mm.
    widths : tuple of float
        Of the columns, mm.
    size : float
        Of the type, points.
    """

    x: float
    widths: tuple[float, ...]
    size: float = 8.0

    def draw(
        self, paper: Paper, y: float, rows: Sequence[TableRow], *, is_framed: bool = False
    ) -> float:
        """Draw rows from y down, perhaps in a thick frame; gives where they end, mm."""
        return paper.place(self._laid_out(paper, rows, is_framed=is_framed), self.x, y)

    def draw_over_pages(
        self, paper: Paper, rows: Sequence[TableRow], next_page: Callable[[], float], bottom: float
    ) -> None:
        """Draw rows on new pages down to ``bottom``; the first row stands again on each.

        Parameters
        ----------
        next_page : callable
            Begins a page; gives where the table begins on it, mm.
        """
        left = [self._laid_out(paper, rows)]
        while left:
            y = next_page()
            parts = left[0].split(sum(self.widths) * POINTS_OF_MM, (bottom - y) * POINTS_OF_MM)
            page, *left = parts or left  # a row that is higher than a page can't be split
            paper.place(page, self.x, y)

    def _laid_out(
        self, paper: Paper, rows: Sequence[TableRow], *, is_framed: bool = False
    ) -> PlacedTable:
        from reportlab.platypus import Table as PlacedTable

        words = [[""] * len(self.widths) for _ in rows]
        style = [*_type(_ALL, self.size), ("GRID", *_ALL, THIN_MM * POINTS_OF_MM, BLACK)]
        style += [(f"{one}PADDING", *_ALL, _PADDING_MM * POINTS_OF_MM) for one in ("LEFT", "RIGHT")]
        style += [(f"{one}PADDING", *_ALL, _ABOVE_MM * POINTS_OF_MM) for one in ("TOP", "BOTTOM")]
        style += _frame(_ALL) if is_framed else ()
        for row, cells in enumerate(rows):
            column = 0
            for cell in cells:
                after = column + cell.columns
                width = sum(self.widths[column:after]) - 2 * _PADDING_MM
                lines = break_lines(paper.in_language(cell.words), self.size, width)
                words[row][column] = "\n".join(lines)
                style += self._style_of(cell, ((column, row), (after - 1, row + cell.rows - 1)))
                column = after
        widths = [width * POINTS_OF_MM for width in self.widths]
        least = [_LEAST_ROW_MM * POINTS_OF_MM] * len(rows)
        return PlacedTable(words, widths, style=style, minRowHeights=least, repeatRows=1)

    def _style_of(self, cell: TableCell, area: _Area) -> Iterator[_Command]:
        yield ("ALIGN", *area, cell.align.upper())
        if cell.columns * cell.rows > 1:
            yield ("SPAN", *area)
        if cell.is_head:
            yield ("BACKGROUND", *area, tuple(part / 255 for part in PALE))
        if cell.is_result:
            yield from _type(area, self.size + 3.0)
            yield from _frame(area)


_Area = tuple[tuple[int, int], tuple[int, int]]
_Command = tuple[Any, ...]  # of reportlab: its name, the area, and what it takes


def _type(area: _Area, size: float) -> Iterator[_Command]:
    yield ("FONT", *area, FONT, size, size * LEADING)
    yield ("VALIGN", *area, "MIDDLE")


def _frame(area: _Area) -> Iterator[_Command]:
    yield ("BOX", *area, THICK_MM * POINTS_OF_MM, BLACK)
