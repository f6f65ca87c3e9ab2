"""Reports as tables: rows of words and numbers, as CSV and as XLSX with a picture."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import OutOfRange
from processing.core.safe_write import write_safely
from processing.core.text import Language, Text
from processing.formats.ledgers.ledger_columns import guard_text
from processing.formats.reports.pdf_page import Rgb
from processing.methods.earthwork.maps.heat_map import ColourClass

if TYPE_CHECKING:
    from openpyxl.worksheet.worksheet import Worksheet

SheetValue = Text | str | float | int | None

# Shift_JIS has another minus, dash and wave than Unicode's first, and no raised digits.
_CP932 = str.maketrans("〜−—‖²³", "～－―∥23")
_PICTURE_PX = 560
_WIDEST, _LINE_POINTS = 40.0, 15.0
_FORMATS = {1: "#,##0.0", 2: "#,##0.00", 3: "#,##0.000"}


@dataclass(frozen=True)
class SheetRow:
    """A row of a report.

    Attributes
    ----------
    is_head : bool
        Its cells name those below, or it is a title: set off from the others.
    digits : int
        Of its numbers behind the point.
    """

    cells: Sequence[SheetValue]
    is_head: bool = False
    digits: int = 1


@dataclass(frozen=True)
class SheetPicture:
    """A map beside the rows.

    Attributes
    ----------
    rgb : (rows, columns, 3) uint8
        Its first row above.
    classes : tuple of ColourClass
        Of its legend, lowest first, with digits and unit of their labels.
    extra : tuple of (Text, colour)
        What else the map shows.
    """

    title: Text
    rgb: NDArray[np.uint8]
    classes: tuple[ColourClass, ...]
    digits: int
    unit: str
    extra: tuple[tuple[Text, Rgb], ...] = ()


@dataclass(frozen=True)
class ReportSheet:
    """A sheet: what it is called, its rows, and perhaps a map."""

    name: Text
    rows: Sequence[SheetRow]
    picture: SheetPicture | None = field(default=None)


def write_report_csv(
    path: Path,
    rows: Iterable[SheetRow],
    language: Language,
    encoding: str = "utf-8",
    *,
    never: Iterable[Path] = (),
) -> None:
    """Write rows as CSV; numbers stand alone, with a dot.

    Parameters
    ----------
    encoding : "utf-8" or "cp932"
        UTF-8 is written with its mark, by which spreadsheets know it.

    Raises
    ------
    OutOfRange
        A character that the encoding lacks; it is named.
    UserError
        What :func:`processing.core.safe_write.write_safely` raises.
    """
    words = io.StringIO()
    writer = csv.writer(words, lineterminator="\r\n")
    for row in rows:
        writer.writerow([_csv_cell(value, row.digits, language) for value in row.cells])
    text = words.getvalue()
    if encoding == "cp932":
        text = text.translate(_CP932)
    try:
        content = text.encode("utf-8-sig" if encoding == "utf-8" else encoding)
    except UnicodeEncodeError as error:
        raise _lacking(path, error) from error
    with write_safely(path, never=never) as temporary:
        temporary.write_bytes(content)


def write_report_xlsx(
    path: Path,
    sheets: Sequence[ReportSheet],
    language: Language,
    *,
    never: Iterable[Path] = (),
) -> None:
    """Write sheets as a workbook for spreadsheets (ISO/IEC 29500).

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises.
    """
    from openpyxl import Workbook

    book = Workbook()
    book.remove(book.worksheets[0])
    for one in sheets:
        sheet = book.create_sheet(_sheet_name(one.name.in_language(language)))
        _fill(sheet, one, language)
    content = io.BytesIO()  # in memory: a full disk then meets one plain write
    book.save(content)
    with write_safely(path, never=never) as temporary:
        temporary.write_bytes(content.getvalue())


def _csv_cell(value: SheetValue, digits: int, language: Language) -> str:
    if isinstance(value, bool) or value is None:
        return ""
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return f"{value:.{digits}f}" if math.isfinite(value) else ""
    return guard_text(" ".join(_in_language(value, language).split()))


def _in_language(value: Text | str, language: Language) -> str:
    return value if isinstance(value, str) else value.in_language(language)


def _fill(sheet: Worksheet, report: ReportSheet, language: Language) -> None:
    from openpyxl.styles import Alignment, Border, Font, PatternFill, Side

    thin = Side(style="thin", color="808080")
    head = PatternFill("solid", fgColor="ECECEC")
    columns = max((len(row.cells) for row in report.rows), default=1)
    for number, row in enumerate(report.rows, 1):
        for column, value in enumerate(row.cells, 1):
            cell: Any = sheet.cell(number, column)
            _set(cell, value, row.digits, language)
            if len(row.cells) > 1:
                cell.border = Border(left=thin, right=thin, top=thin, bottom=thin)
                cell.alignment = Alignment(vertical="center", wrap_text=column == 2)
            if row.is_head:
                cell.font = Font(bold=True, size=14 if len(row.cells) == 1 else None)
                cell.fill = head if len(row.cells) > 1 else PatternFill()
    widths = _widths(report, columns, language)
    for column, width in enumerate(widths):
        sheet.column_dimensions[chr(ord("A") + column)].width = width
    for number, row in enumerate(report.rows, 1):
        if len(row.cells) == 2 and columns > 2:
            # What a name has to say takes the rest of the row; a merged cell finds no height.
            sheet.merge_cells(start_row=number, end_row=number, start_column=2, end_column=columns)
            lines = -(-_wide(row.cells[1], language) // sum(widths[1:]))
            sheet.row_dimensions[number].height = _LINE_POINTS * max(lines, 1)
    sheet.page_setup.orientation = "landscape"
    sheet.page_setup.paperSize = sheet.PAPERSIZE_A4
    sheet.page_setup.fitToHeight = 0
    sheet.sheet_properties.pageSetUpPr.fitToPage = True
    if report.picture is not None:
        _add_picture(sheet, report.picture, columns + 2, language)


def _set(
    cell: Any, value: SheetValue, digits: int, language: Language
) -> None:  # openpyxl has no types
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return
    if isinstance(value, (int, float)):
        cell.value = value
        cell.number_format = "#,##0" if isinstance(value, int) else _FORMATS[digits]
        return
    cell.value = " ".join(_printable(_in_language(value, language)).split())
    # Never a formula, whatever the words begin with.
    cell.data_type = "s"


def _printable(words: str) -> str:
    """Words without control characters, which a workbook can't hold."""
    return "".join(one if one.isprintable() else " " for one in words)


def _widths(report: ReportSheet, columns: int, language: Language) -> list[float]:
    widths = [8.0] * columns
    for row in report.rows:
        # What stands alone may run over its neighbours, and so may the values of two.
        if len(row.cells) > 2:
            for column, value in enumerate(row.cells):
                wide = _wide(value, language) + 2.0
                widths[column] = max(widths[column], min(wide, _WIDEST))
    return widths


def _wide(value: SheetValue, language: Language) -> float:
    """How wide words are, in digits; Japanese characters are twice as wide."""
    if not isinstance(value, (Text, str)):
        return 0.0
    return float(sum(1 + (ord(one) > 255) for one in _in_language(value, language)))


def _add_picture(sheet: Worksheet, picture: SheetPicture, column: int, language: Language) -> None:
    from openpyxl.drawing.image import Image as SheetImage
    from openpyxl.styles import PatternFill
    from PIL import Image

    file = io.BytesIO()
    Image.fromarray(picture.rgb).save(file, format="PNG")
    file.seek(0)
    image = SheetImage(file)
    scale = _PICTURE_PX / max(picture.rgb.shape[:2])
    image.width, image.height = (round(scale * length) for length in picture.rgb.shape[1::-1])
    letter = chr(ord("A") + column - 1)
    sheet.cell(1, column).value = picture.title.in_language(language)
    entries = [
        (one.label(picture.digits, picture.unit), one.rgb) for one in reversed(picture.classes)
    ]
    entries += picture.extra
    for number, (name, rgb) in enumerate(entries, 2):
        cell: Any = sheet.cell(number, column)
        cell.fill = PatternFill("solid", fgColor="{:02X}{:02X}{:02X}".format(*rgb))
        label: Any = sheet.cell(number, column + 1)
        label.value = name.in_language(language)
        label.data_type = "s"
    sheet.column_dimensions[chr(ord(letter) + 1)].width = 20.0
    sheet.add_image(image, f"{letter}{len(entries) + 3}")


def _sheet_name(words: str) -> str:
    # 31 characters at most, and none of these.
    return "".join("_" if one in "[]:*?/\\" else one for one in words)[:31]


def _lacking(path: Path, error: UnicodeEncodeError) -> OutOfRange:
    character = error.object[error.start]
    code = f"U+{ord(character):04X}"
    line = error.object.count("\n", 0, error.start) + 1
    shown = character if character.isprintable() else ""
    return OutOfRange(
        Text(
            f"Shift_JIS (cp932) has no character “{shown}” ({code}).",
            f"Shift_JIS (cp932)では文字「{shown}」（{code}）を表せません。",
        ),
        Text(f"{path}, line {line}", f"{path}、{line}行目"),
        Text(
            "Replace the character, or export as UTF-8; nothing was written.",
            "その文字を置き換えるか、UTF-8で書き出してください。何も書き込まれていません。",
        ),
    )
