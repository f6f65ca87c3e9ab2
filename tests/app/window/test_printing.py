"""Sheets on a printer that writes PDF: their own size, true to scale, nothing shrunk."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pypdfium2
import pytest
from PySide6.QtGui import QPageSize
from PySide6.QtPrintSupport import QPrintDialog, QPrinter
from PySide6.QtWidgets import QDialog, QDialogButtonBox
from pytestqt.qtbot import QtBot

from app.importing.printed_pages import opened_pages, print_pages, set_paper
from processing.core.errors import BadFile, Unsuitable
from processing.core.text import Text
from processing.formats.reports.pdf_page import write_report_page
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, Vertex
from tests.app.conftest import shown_window
from widgets.dialogs.print_sheets import PrintForm

_MM = 25.4 / 72


def _page(path: Path, size_mm: tuple[float, float] = (420.0, 297.0)) -> Path:
    """Two pages with an upright line at 100 mm and one at 300 mm."""
    with write_report_page(path, size_mm, "en", "t") as paper:
        for number in range(2):
            if number:
                paper.next_page()
            for x in (100.0, 300.0):
                paper.line([(x, 50.0), (x, 250.0)], 0.35)
    return path


def _printer(path: Path) -> QPrinter:
    printer = QPrinter(QPrinter.PrinterMode.HighResolution)
    printer.setOutputFormat(QPrinter.OutputFormat.PdfFormat)
    printer.setOutputFileName(str(path))
    return printer


def test_lines_are_where_the_sheet_has_them(qtbot: QtBot, tmp_path: Path) -> None:
    document = opened_pages(_page(tmp_path / "a.pdf"))
    printer = _printer(tmp_path / "printed.pdf")
    set_paper(printer, document)
    assert print_pages(document, printer) == 2
    printed = pypdfium2.PdfDocument(tmp_path / "printed.pdf")
    assert len(printed) == 2
    assert np.array(printed[1].get_size()) * _MM == pytest.approx([420.0, 297.0], abs=0.4)
    grey = np.asarray(printed[1].render(scale=4.0).to_pil().convert("L"))
    dark = np.flatnonzero(grey[grey.shape[0] // 2] < 128) * _MM / 4.0
    left, right = dark[dark < 200.0].mean(), dark[dark > 200.0].mean()
    assert left == pytest.approx(100.0, abs=0.3)
    assert right - left == pytest.approx(200.0, abs=0.2)


def test_smaller_paper_is_refused(qtbot: QtBot, tmp_path: Path) -> None:
    printer = _printer(tmp_path / "printed.pdf")
    printer.setPageSize(QPageSize(QPageSize.PageSizeId.A4))
    with pytest.raises(Unsuitable, match="larger than the printer's paper"):
        print_pages(opened_pages(_page(tmp_path / "a.pdf")), printer)
    assert not (tmp_path / "printed.pdf").exists()


def test_what_is_no_pdf_is_refused(qtbot: QtBot, tmp_path: Path) -> None:
    (tmp_path / "a.pdf").write_text("nothing")
    with pytest.raises(BadFile, match="can't be read"):
        opened_pages(tmp_path / "a.pdf")


def test_the_file_menu_prints_the_sheets_of_the_map(
    qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def accept(dialog: QPrintDialog) -> QDialog.DialogCode:
        printer = dialog.printer()
        printer.setOutputFormat(QPrinter.OutputFormat.PdfFormat)
        printer.setOutputFileName(str(tmp_path / "printed.pdf"))
        return QDialog.DialogCode.Accepted

    monkeypatch.setattr(QPrintDialog, "exec", accept)
    with shown_window(qtbot, tmp_path) as parts:
        assert parts.document.create(tmp_path / "A.zuka", "EPSG:6677")
        places = ((-8000.0, -36000.0, 1.0), (-7950.0, -36000.0, 1.0))
        vertices = tuple(Vertex(one) for one in places)
        edge = Feature("edge", "road_edge", Geometry.LINE, vertices)
        parts.document.apply(Text.same("edge"), Change(added=(edge,)))
        parts.window.actions_by_id["print"].trigger()
        (form,) = [one for one in parts.window.findChildren(PrintForm) if one.isVisible()]
        assert form.format == "sheets"
        (buttons,) = form.findChildren(QDialogButtonBox)
        said: list[str] = []
        parts.document.reported.connect(lambda words: said.append(words.en))
        buttons.accepted.emit()
        qtbot.waitUntil(lambda: "Printed 1 sheets." in said, timeout=30_000)
    printed = pypdfium2.PdfDocument(tmp_path / "printed.pdf")
    assert np.array(printed[0].get_size()) * _MM == pytest.approx([841.0, 594.0], abs=0.4)
