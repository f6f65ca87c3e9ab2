"""Pages of a PDF on a printer, true to scale: each on its own size, nothing shrunk."""

from __future__ import annotations

import math
from pathlib import Path

from PySide6.QtCore import QMarginsF, QRect, QSize, QSizeF
from PySide6.QtGui import QPageLayout, QPageSize, QPainter
from PySide6.QtPdf import QPdfDocument, QPdfDocumentRenderOptions
from PySide6.QtPrintSupport import QPrinter

from processing.core.errors import BadFile, NoSpace, Unsuitable
from processing.core.text import Text

MOST_DPI = 300
"""Finer than this the lines of a sheet, 0.13 mm and more, look no better."""

_BAND_PIXELS = 8_000_000
_POINTS_OF_INCH, _POINTS_OF_MM = 72.0, 72.0 / 25.4
_TOLERANCE_MM = 1.0


def opened_pages(path: Path) -> QPdfDocument:
    """A PDF whose pages can be printed.

    Raises
    ------
    BadFile
        It can't be read.
    """
    document = QPdfDocument()
    if document.load(str(path)) != QPdfDocument.Error.None_ or not document.pageCount():
        raise BadFile(
            Text("The pages can't be read.", "ページを読み込めません。"),
            Text.same(str(path)),
            Text("Make the sheets again.", "図面を作り直してください。"),
        )
    return document


def set_paper(printer: QPrinter, document: QPdfDocument) -> None:
    """Propose the size of the first page."""
    size = document.pagePointSize(0)
    paper = QPageSize(
        size.transposed() if size.width() > size.height() else size,
        QPageSize.Unit.Point,
        "",
        QPageSize.SizeMatchPolicy.FuzzyMatch,
    )
    turned = size.width() > size.height()
    way = QPageLayout.Orientation.Landscape if turned else QPageLayout.Orientation.Portrait
    printer.setPageLayout(QPageLayout(paper, way, QMarginsF()))
    printer.setFullPage(True)


def print_pages(document: QPdfDocument, printer: QPrinter) -> int:
    """Print the pages that the printer is asked for; gives their number.

    Raises
    ------
    Unsuitable
        The printer's paper is smaller than a page.
    NoSpace
        The printer takes no page.
    """
    printer.setFullPage(True)
    first, last = printer.fromPage() or 1, printer.toPage() or document.pageCount()
    numbers = range(max(1, first) - 1, min(last, document.pageCount()))
    for number in numbers:
        _check_paper(document.pagePointSize(number), printer)
    painter = QPainter()
    if not painter.begin(printer):
        raise _not_taken(printer)
    try:
        for number in numbers:
            if number != numbers[0] and not printer.newPage():
                raise _not_taken(printer)
            _paint(painter, document, number, printer.resolution())
    finally:
        painter.end()
    return len(numbers)


def _paint(painter: QPainter, document: QPdfDocument, number: int, resolution: int) -> None:
    """Paint a page in bands, since a large sheet as one picture takes gigabytes."""
    size = document.pagePointSize(number)
    dpi = min(MOST_DPI, resolution)
    whole = QSize(*(round(one * dpi / _POINTS_OF_INCH) for one in (size.width(), size.height())))
    rows = max(1, _BAND_PIXELS // max(1, whole.width()))
    painter.save()
    painter.scale(resolution / dpi, resolution / dpi)
    for top in range(0, whole.height(), rows):
        band = QRect(0, top, whole.width(), min(rows, whole.height() - top))
        options = QPdfDocumentRenderOptions()
        options.setScaledSize(whole)
        options.setScaledClipRect(band)
        painter.drawImage(band.topLeft(), document.render(number, band.size(), options))
    painter.restore()


def _check_paper(page: QSizeF, printer: QPrinter) -> None:
    paper = printer.pageLayout().fullRect(QPageLayout.Unit.Point)
    room = _TOLERANCE_MM * _POINTS_OF_MM
    if page.width() <= paper.width() + room and page.height() <= paper.height() + room:
        return
    sizes = [
        " × ".join(f"{math.floor(one / _POINTS_OF_MM + 0.5)}" for one in (it.width(), it.height()))
        for it in (page, paper)
    ]
    raise Unsuitable(
        Text(
            "The sheet is larger than the printer's paper.",
            "図面がプリンターの用紙より大きいです。",
        ),
        Text.same(f"{sizes[0]} mm > {sizes[1]} mm"),
        Text(
            "Choose that paper in the printer's form, or a smaller paper of the sheets; nothing"
            " was printed.",
            "プリンターの用紙を変更するか、図面の用紙を小さくしてください。印刷していません。",
        ),
    )


def _not_taken(printer: QPrinter) -> NoSpace:
    return NoSpace(
        Text("The printer takes no page.", "プリンターで印刷できません。"),
        Text.same(printer.outputFileName() or printer.printerName() or "-"),
        Text("Look whether it is ready, or print to a file.",
             "プリンターの状態を確認するか、ファイルに印刷してください。"),
    )  # fmt: skip
