"""Ledgers as one workbook: a sheet for each ledger, ready to be looked at and printed."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.ledgers.ledger_columns import (
    TableStyle,
    distinct_headers,
    header,
    unguarded,
)
from processing.formats.ledgers.ledger_csv import ledger_columns, style_of
from processing.formats.ledgers.road_columns import ROAD_LEDGER, road_columns
from processing.formats.ledgers.route_tables import route_tables
from processing.formats.map_delivery import MapDelivery, Position
from processing.map.catalogue import Catalogue
from processing.map.feature import Feature
from processing.map.routes.road_sections import RoadSection, road_sections
from processing.map.routes.route_summary import route_summaries

if TYPE_CHECKING:
    from openpyxl import Workbook

NAME = "ledgers.xlsx"
_EMPTY = Text("Ledgers", "台帳")
_MOST_ROWS = 1_048_575  # of a sheet, below its headers
_MOST_LETTERS = 32_767  # of a cell
_MOST_TITLE = 31
_NOT_IN_TITLES = re.compile(r"[\[\]:*?/\\]")
_NOT_IN_CELLS = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f]")
_MOST_SAFE = 1 << 53  # whole numbers beyond it would be rounded
_NARROWEST, _WIDEST = 6.0, 40.0  # letters
_MARGIN = 1.0
"""Letters of a column that its borders take."""

_BOLD = 1.15
"""How much wider bold letters are than those by which columns are measured."""

_SHORT = 10
"""Letters of a header that is not broken: five kanji."""

_LINE_PT = 16.0
_UNBROKEN = re.compile(r"[\x21-\u2fff]+ *|.")
"""What stays on one line: a word of narrow letters with the space behind it, or one kanji."""

_A4, _A3 = 9, 8
_A4_LETTERS = 150.0  # what is wider is printed on A3
_HEAD_FILL = "FFE8EEF4"
_CHECK_EVERY = 256

Cell = tuple[str, bool]
"""What stands there, as in CSV, and whether it is a number."""


@dataclass(frozen=True)
class _Sheet:
    """A table: its name, its first row, its other rows."""

    title: str
    headers: Sequence[str]
    rows: Sequence[Sequence[Cell]]


def write_xlsx_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write the ledgers of a map that is handed in, with the columns that CSV has.

    Where the map has a centre line, the road's ledger sheet comes first, then routes and their
    widths, then a sheet for each kind
    in the catalogue's order. Numbers are numbers with the decimals of CSV; the header row stays in
    sight and is printed on every page.

    Raises
    ------
    Unsuitable
        More features of a kind than a sheet has rows.
    Cancelled
    """
    from openpyxl import Workbook

    style = style_of(delivery)
    book = Workbook(write_only=True)
    shown = _Characters(delivery.tell)
    sheets = _sheets(delivery, style, monitor)
    titles: set[str] = set()
    for sheet in sheets:
        monitor.check()
        _write_sheet(book, sheet, _title(sheet.title, titles), shown, monitor)
    if not titles:
        empty = _Sheet(_EMPTY.in_language(style.language or "en"), [], [])
        _write_sheet(book, empty, _title(empty.title, titles), shown, monitor)
    book.properties.title = shown.of(delivery.name)
    book.properties.creator = "Zuka"
    book.save(position(NAME))
    shown.say()


def _sheets(delivery: MapDelivery, style: TableStyle, monitor: Monitor) -> list[_Sheet]:
    sheets = []
    sections = road_sections(delivery.features, delivery.catalogue)
    monitor.check()
    if sections:
        sheets.append(_road_sheet(sections, delivery.catalogue, style))
    summaries = route_summaries(delivery.features, delivery.catalogue)
    for wide in route_tables(summaries, delivery.catalogue, style):
        table = wide.for_paper()
        title = table.title.in_language(style.language or "en")
        sheets.append(_Sheet(title, table.headers, table.rows))
    monitor.check()
    members: dict[str, list[Feature]] = {}
    for feature in delivery.features:
        members.setdefault(feature.kind, []).append(feature)
    for number, kind in enumerate(delivery.catalogue):
        monitor.check()
        monitor.report(number / len(delivery.catalogue) / 2)
        mine = members.get(kind.id)
        if not mine:
            continue
        name = kind.name.in_language(style.language or "en")
        if len(mine) > _MOST_ROWS:
            raise _too_many(kind.name, len(mine))
        columns = ledger_columns(mine, kind, style)
        rows = [
            [(one.cell(feature), one.is_number(feature)) for one in columns] for feature in mine
        ]
        headers = distinct_headers([one.header(style.language) for one in columns])
        sheets.append(_Sheet(name, headers, rows))
    return sheets


def _road_sheet(sections: Sequence[RoadSection], catalogue: Catalogue, style: TableStyle) -> _Sheet:
    columns = road_columns(catalogue, style)
    rows = [[(one.cell(section), one.is_number) for one in columns] for section in sections]
    headers = [header(*one.title, style.language) for one in columns]
    return _Sheet(ROAD_LEDGER.in_language(style.language or "en"), headers, rows)


def _too_many(name: Text, count: int) -> Unsuitable:
    return Unsuitable(
        Text(
            f"There are {count:,} rows; a sheet of XLSX holds {_MOST_ROWS:,}.",
            f"{count:,}行あり、XLSXのシートの上限（{_MOST_ROWS:,}行）を超えています。",
        ),
        name,
        Text(
            "Export CSV instead; nothing was written.",
            "CSVで書き出してください。何も書き込まれていません。",
        ),
    )


class _Characters:
    """Text as cells hold it; counts what they don't."""

    def __init__(self, tell: Callable[[Text], None]) -> None:
        self._tell = tell
        self._replaced = self._cut = 0

    def of(self, text: str) -> str:
        """A text without control characters, and not longer than a cell holds."""
        plain = text.encode("utf-8", "replace").decode("utf-8")
        plain, count = _NOT_IN_CELLS.subn("\ufffd", plain)
        self._replaced += count
        self._cut += len(plain) > _MOST_LETTERS
        return plain[:_MOST_LETTERS]

    def say(self) -> None:
        """Tell what was altered."""
        if self._replaced:
            self._tell(
                Text(
                    f"XLSX holds no control characters: {self._replaced} were replaced by \ufffd.",
                    f"XLSXでは制御文字を表せないため、{self._replaced}文字を\ufffdに置き換えました。",
                )
            )
        if self._cut:
            self._tell(
                Text(
                    f"XLSX holds {_MOST_LETTERS:,} letters a cell: {self._cut} texts were cut.",
                    f"XLSXの1セルは{_MOST_LETTERS:,}文字までのため、{self._cut}個の文字列を"
                    "切り詰めました。",
                )
            )


def _title(words: str, taken: set[str]) -> str:
    """A sheet's name: short, without signs that formulas use, and no other sheet's."""
    plain = _NOT_IN_CELLS.sub(" ", _NOT_IN_TITLES.sub("_", words)).strip("' ") or "Sheet"
    name, number = plain[:_MOST_TITLE], 2
    while name.casefold() in taken:
        end = f" ({number})"
        name, number = plain[: _MOST_TITLE - len(end)] + end, number + 1
    taken.add(name.casefold())
    return name


def _write_sheet(
    book: Workbook, sheet: _Sheet, title: str, shown: _Characters, monitor: Monitor
) -> None:
    from openpyxl.styles import Alignment, Border, Font, PatternFill, Side
    from openpyxl.utils import get_column_letter

    page = book.create_sheet(title)
    widths = _widths(sheet)
    for number, width in enumerate(widths, 1):
        page.column_dimensions[get_column_letter(number)].width = width
    _set_page(page, title, sum(widths))
    lines = max((_lines(*one) for one in zip(sheet.headers, widths, strict=True)), default=1)
    page.row_dimensions[1].height = _LINE_PT * lines
    line = Side("thin", color="FF999999")
    border = Border(line, line, line, line)
    head_fill, head_font = PatternFill("solid", fgColor=_HEAD_FILL), Font(bold=True)
    centred = Alignment("center", "center", wrap_text=True)
    headers = [_text_cell(page, shown.of(unguarded(one))) for one in sheet.headers]
    for cell in headers:
        cell.fill, cell.font, cell.alignment, cell.border = head_fill, head_font, centred, border
    page.append(headers)
    for number, row in enumerate(sheet.rows):
        if number % _CHECK_EVERY == 0:
            monitor.check()
        page.append([_cell(page, one, shown) for one in row])
    if sheet.headers:
        last = f"{get_column_letter(len(sheet.headers))}{len(sheet.rows) + 1}"
        page.auto_filter.ref = f"A1:{last}"


# Any: openpyxl has no types.
def _set_page(page: Any, title: str, letters: float) -> None:
    """A wide sheet on paper: as wide as the page, headers on each, its name and number below."""
    page.freeze_panes = "A2"
    page.print_title_rows = "1:1"
    page.page_setup.orientation = "landscape"
    page.page_setup.paperSize = _A4 if letters <= _A4_LETTERS else _A3
    page.page_setup.fitToWidth, page.page_setup.fitToHeight = 1, 0
    page.sheet_properties.pageSetUpPr.fitToPage = True
    page.print_options.gridLines = True  # a border a cell takes three times as long
    page.page_margins.left = page.page_margins.right = 0.4
    page.oddHeader.center.text = title.replace("&", "&&")
    page.oddFooter.center.text = "&P / &N"


# Any: openpyxl has no types.
def _cell(page: Any, cell: Cell, shown: _Characters) -> Any:
    from openpyxl.cell import WriteOnlyCell

    words, is_number = cell
    if not words:
        return WriteOnlyCell(page, None)
    if is_number and (value := _number(words)) is not None:
        made = WriteOnlyCell(page, value)
        made.number_format = _number_format(words)
        return made
    return _text_cell(page, shown.of(words if is_number else unguarded(words)))


# Any: openpyxl has no types.
def _text_cell(page: Any, words: str) -> Any:
    """A text that is no formula, whatever it begins with."""
    from openpyxl.cell import WriteOnlyCell

    made = WriteOnlyCell(page, words)
    made.data_type = "s"
    made.number_format = "@"
    made.quotePrefix = words.startswith(("=", "+", "-", "@"))
    return made


def _number(words: str) -> float | int | None:
    try:
        value = float(words) if any(sign in words for sign in ".eE") else int(words)
    except ValueError:
        return None
    return value if isinstance(value, float) or abs(value) < _MOST_SAFE else None


def _number_format(words: str) -> str:
    """The decimals that the words have."""
    if "e" in words.lower():
        return "General"
    _, _, decimals = words.partition(".")
    return f"0.{'0' * len(decimals)}" if decimals else "0"


def _widths(sheet: _Sheet) -> list[float]:
    """Of columns, in narrow letters: the longest cell, and the header, broken where it is long."""
    widths = []
    for number, words in enumerate(sheet.headers):
        longest = max((_letters(row[number][0]) for row in sheet.rows), default=0)
        head = _letters(words)
        shown = head if head <= _SHORT else (head + 1) // 2
        wanted = max(longest, _BOLD * shown) + 2.0
        widths.append(min(max(wanted, _NARROWEST), _WIDEST))
    return widths


def _lines(words: str, width: float) -> int:
    """Lines that a header takes: broken between words, and between any two kanji."""
    room = width - _MARGIN
    lines, filled = 1, 0.0
    for piece in _UNBROKEN.findall(words):
        long = _BOLD * _letters(piece)
        if filled and filled + _BOLD * _letters(piece.rstrip()) > room:
            lines, filled = lines + 1, 0.0
        filled += long
    return lines


def _letters(words: str) -> int:
    """Kanji are two letters wide."""
    return sum(2 if unicodedata.east_asian_width(one) in "WF" else 1 for one in words)
