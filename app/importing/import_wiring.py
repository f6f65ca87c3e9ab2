"""What the window offers about imports: to go on with one, to add a trajectory that lies beside."""

from __future__ import annotations

from PySide6.QtCore import QObject
from PySide6.QtGui import QAction

from app.document.import_words import offered_words
from app.importing.written_files import WrittenFilesOffer
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Text
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.unfinished_imports import (
    UnfinishedImport,
    discard,
    unfinished_imports,
)

_MOST_NAMES = 3


def connect_imports(parts: WindowParts) -> None:
    """Connect the message bar with what can be done about imports and exports; for new widgets."""
    ImportOffer(parts)
    WrittenFilesOffer(parts)


class ImportOffer(QObject):
    """Offers to go on with an import or to give it up, or to add what was left out of one."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts
        self._waiting: list[UnfinishedImport] = []
        self._go_on = QAction(self.tr("Go on"), self)
        self._go_on.triggered.connect(self._on_go_on_triggered)
        self._discard = QAction(self.tr("Discard"), self)
        self._discard.triggered.connect(self._on_discard_triggered)
        self._add = QAction(self)
        self._add.triggered.connect(self._on_add_triggered)
        self._offer: tuple[ImportRequest, tuple[str, ...]] | None = None
        parts.document.opened.connect(self._on_document_opened)
        parts.document.closed.connect(self._on_document_closed)
        parts.document.drive_results.beside_found.connect(self._on_beside_found)

    def _on_document_opened(self) -> None:
        project = self._parts.document.project
        self._waiting = [] if project is None else list(unfinished_imports(project.folder))
        if self._waiting:
            self._show_next()

    def _on_document_closed(self) -> None:
        self._offer = None

    def _on_beside_found(self, offer: ImportRequest, drives: tuple[str, ...]) -> None:
        self._offer = offer, drives
        names = ", ".join(path.name for path in offer.trajectories)
        self._add.setText(self.tr("Add {name}").format(name=names))
        self._parts.message_bar.show_error(offered_words(offer), self._add)

    def _on_add_triggered(self) -> None:
        if self._offer is not None:
            offer, drives = self._offer
            self._offer = None
            self._parts.message_bar.hide()
            self._parts.document.import_files(offer, drives)

    def _show_next(self) -> None:
        if self._waiting:
            reported = describe_import_offer(self._waiting[0])
            self._parts.message_bar.show_error(reported, self._go_on, self._discard)
        else:
            self._parts.message_bar.hide()

    def _on_go_on_triggered(self) -> None:
        self._parts.document.import_files(self._waiting.pop(0).request)
        self._show_next()

    def _on_discard_triggered(self) -> None:
        discard(self._waiting.pop(0))
        self._show_next()


def describe_import_offer(unfinished: UnfinishedImport) -> UserError:
    """What is said of an import that can go on."""
    inputs = unfinished.request.inputs
    names = ", ".join(path.name for path in inputs[:_MOST_NAMES])
    return UserError(
        Text("An import was interrupted.", "インポートが中断されています。"),
        Text.same(names if len(inputs) <= _MOST_NAMES else f"{names} …"),
        Text(
            "Go on where it stopped, or discard what is done of it.",
            "中断したところから再開するか、途中の結果を破棄してください。",
        ),
    )
