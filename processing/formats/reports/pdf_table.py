"""Tables on papers: rows of cells, as high as their words need, over as many pages as it takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from processing.core.text import Text
from processing.formats.reports.pdf_page import PALE, Align, Paper, break_lines, leading_mm

_PADDING_MM = 1.2
_LEAST_ROW_MM = 5.2


@dataclass(frozen=True)
class TableCell:
    """A cell; its words are broken into lines where they are too long.

    Attributes
    ----------
    columns : int
        How many columns it takes.
    is_head : bool
        Shaded, as what names other cells.
    """

    words: Text | str
    align: Align = "left"
    columns: int = 1
    is_head: bool = False


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

    @property
    def width(self) -> float:
        """All columns together, mm."""
        return sum(self.widths)

    def height_of(self, paper: Paper, row: TableRow) -> float:
        """How high a row is, mm."""
        lines = max(len(self._lines(paper, cell, width)) for cell, width in self._placed(row))
        return max(lines * leading_mm(self.size) + 1.4, _LEAST_ROW_MM)

    def draw(self, paper: Paper, y: float, rows: Sequence[TableRow]) -> float:
        """Draw rows from y down; gives where they end."""
        for row in rows:
            height = self.height_of(paper, row)
            x = self.x
            for cell, width in self._placed(row):
                paper.box((x, y), (width, height), fill=PALE if cell.is_head else None)
                self._draw_words(paper, cell, (x, y), (width, height))
                x += width
            y += height
        return y

    def rows_that_fit(self, paper: Paper, rows: Sequence[TableRow], height: float) -> int:
        """How many of the first rows fit into a height; at least one."""
        used = 0.0
        for number, row in enumerate(rows):
            used += self.height_of(paper, row)
            if used > height + 1e-6:
                return max(number, 1)
        return len(rows)

    def _draw_words(
        self,
        paper: Paper,
        cell: TableCell,
        corner: tuple[float, float],
        size_mm: tuple[float, float],
    ) -> None:
        lines = self._lines(paper, cell, size_mm[0])
        step = leading_mm(self.size)
        top = corner[1] + 0.5 * (size_mm[1] - len(lines) * step)
        x = {
            "left": corner[0] + _PADDING_MM,
            "centre": corner[0] + 0.5 * size_mm[0],
            "right": corner[0] + size_mm[0] - _PADDING_MM,
        }[cell.align]
        for number, line in enumerate(lines):
            paper.text(x, top + (number + 0.5) * step, line, self.size, cell.align)

    def _lines(self, paper: Paper, cell: TableCell, width: float) -> list[str]:
        return break_lines(paper.in_language(cell.words), self.size, width - 2 * _PADDING_MM)

    def _placed(self, row: TableRow) -> list[tuple[TableCell, float]]:
        placed, column = [], 0
        for cell in row:
            placed.append((cell, sum(self.widths[column : column + cell.columns])))
            column += cell.columns
        return placed
