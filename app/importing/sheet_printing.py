"""SheetPrinting: drawing sheets of the map on paper, true to scale."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QTemporaryDir
from PySide6.QtPrintSupport import QPrintDialog, QPrinter
from PySide6.QtWidgets import QDialog

from app.importing.printed_pages import opened_pages, print_pages, set_paper
from app.window.action import Action
from app.window.project_dialogs import ProjectDialogs
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Text
from processing.formats.registry import FORMATS
from processing.operations.export import ExportRequest
from widgets.dialogs.export_map import ExportChoices
from widgets.dialogs.print_sheets import PrintForm, PrintOptions


class SheetPrinting:
    """Asks which sheets, makes them as PDF in a job, then asks for the printer.

    Parameters
    ----------
    dialogs : ProjectDialogs
        Where its form is shown.
    """

    def __init__(self, parts: WindowParts, dialogs: ProjectDialogs) -> None:
        self._parts = parts
        self._dialogs = dialogs

    def action(self) -> Action:
        """The entry of the file menu."""
        return Action(
            "print",
            Text("Print…", "印刷…"),
            self.choose,
            "file",
            ("Ctrl+P",),
            "mdi6.printer-outline",
            hint=Text(
                "Prints drawing sheets and sections true to scale.",
                "図面や縦断・横断図を縮尺どおりに印刷します。",
            ),
            needs_project=True,
        )

    def choose(self) -> None:
        """Show the form of what to print."""
        if self._parts.document.project is None:
            return
        printed = {one.id: one for one in FORMATS.maps() if one.pages}
        owners = {id_: own for id_, own in FORMATS.map_option_owners().items() if id_ in printed}
        own = {id_ for ids in owners.values() for id_ in ids}

        def make() -> PrintForm:
            titles = tuple((one.id, one.name) for one in printed.values())
            options = tuple(one for one in FORMATS.map_options() if one.id in own)
            choices = ExportChoices(titles, options, owners)
            form = PrintForm(choices, self._parts.language, self._parts.window)
            form.print_requested.connect(self._on_form_print_requested)
            return form

        self._dialogs.show(PrintForm, make)

    def print_file(self, path: Path, printer: QPrinter) -> None:
        """Print the pages of a PDF, and say how many; a refusal is shown."""
        try:
            count = print_pages(opened_pages(path), printer)
        except UserError as error:
            self._parts.document.refused.emit(error)
            return
        told = Text("Printed {count} sheets.", "図面を{count}枚印刷しました。")
        self._parts.document.reported.emit(told.filled(count=count))

    def _on_form_print_requested(self, asked: PrintOptions) -> None:
        folder = QTemporaryDir()
        request = ExportRequest(
            formats=(asked.format,),
            folder=Path(folder.path()),
            language=self._parts.language,
            options=asked.options,
            candidates=asked.candidates,
        )

        def ask_printer() -> None:
            self._ask_printer(Path(folder.path()) / FORMATS[asked.format].pages)
            folder.remove()

        self._parts.document.make_pages(request, ask_printer)

    def _ask_printer(self, path: Path) -> None:
        printer = QPrinter(QPrinter.PrinterMode.HighResolution)
        try:
            document = opened_pages(path)
        except UserError as error:
            self._parts.document.refused.emit(error)
            return
        set_paper(printer, document)
        dialog = QPrintDialog(printer, self._parts.window)
        dialog.setMinMax(1, document.pageCount())
        if dialog.exec() == QDialog.DialogCode.Accepted:
            self.print_file(path, printer)
