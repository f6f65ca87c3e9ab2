"""WrittenFilesOffer: after an export, its folder and its files are one click away."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, QUrl
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu

from app.document.long_work import exported_words
from app.help.manual import open_outside
from app.window.window_parts import WindowParts
from processing.operations.project_export import WrittenFiles
from widgets.parts.literal_text import literal

_MOST_FILES = 20


class WrittenFilesOffer(QObject):
    """Shows what was written above the views; goes with the widgets."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window.centralWidget())
        self._parts = parts
        self._menu = QMenu(parts.window.centralWidget())
        self._open_folder = QAction(self.tr("Open the folder"), self)
        self._open_folder.triggered.connect(self._on_open_folder_triggered)
        self._open_file = QAction(self.tr("Open a file"), self)
        self._open_file.setMenu(self._menu)
        self._folder = Path()
        parts.document.exported.connect(self._on_document_exported)

    def _on_document_exported(self, written: WrittenFiles, folder: Path) -> None:
        self._folder = folder
        self._menu.clear()
        for path in written.paths[:_MOST_FILES]:
            name = path.relative_to(folder) if path.is_relative_to(folder) else path
            entry = self._menu.addAction(literal(str(name)))
            entry.triggered.connect(partial(self._show, path))
        words = exported_words(written, folder)
        file = self._open_file if written.paths else None
        self._parts.message_bar.show_news(words, self._open_folder, file)

    def _on_open_folder_triggered(self) -> None:
        self._show(self._folder)

    def _show(self, path: Path, _is_checked: object = None) -> None:
        open_outside(self._parts, QUrl.fromLocalFile(str(path)))
