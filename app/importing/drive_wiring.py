"""Wiring of drives: which are shown where, and where their delivered files are."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject

from app.importing.source_watch import SourceWatch
from app.importing.source_words import describe_file_problems, describe_found_files, words_by_drive
from app.views.attribute_notices import AttributeNotices
from app.views.view_memory import ViewMemory
from app.window.window_parts import WindowParts


def connect_drives(parts: WindowParts) -> None:
    """Connect tree, images and the watch over delivered files; again for new widgets."""
    wiring = DriveWiring(parts)
    ViewMemory(parts.document, parts.image_views, wiring)
    AttributeNotices(parts.document, wiring).reported.connect(parts.status_line.show_message)
    tree, watch = parts.project_tree, parts.of(SourceWatch)
    tree.beside_requested.connect(parts.image_views.show_beside)
    tree.find_requested.connect(wiring.on_tree_find_requested)
    parts.document.opened.connect(wiring.on_document_opened)
    parts.document.closed.connect(wiring.show_troubles)
    watch.looked.connect(wiring.on_watch_looked)
    watch.moved.connect(parts.camera_view.read_images)
    watch.chosen.connect(wiring.on_watch_chosen)
    wiring.show_troubles()


class DriveWiring(QObject):
    """What has to be translated between the watch and the window."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts
        self._is_to_be_told = False
        self._missed_before: int | None = None

    def show_troubles(self) -> None:
        """Mark the drives whose files are missing."""
        words = words_by_drive(self._parts.of(SourceWatch).troubles, self._parts.language)
        self._parts.project_tree.show_troubles(words)

    def on_document_opened(self) -> None:
        """Trouble is told once for each opening."""
        self._is_to_be_told = True

    def on_tree_find_requested(self) -> None:
        """As the file menu does it."""
        self._parts.window.actions_by_id["find-files"].trigger()

    def on_watch_chosen(self, _folder: Path) -> None:
        """What comes of a folder that the user chose is told."""
        self._missed_before = len(self._parts.of(SourceWatch).troubles)

    def on_watch_looked(self) -> None:
        """Tell what is missing, once, with the way to say where it is."""
        troubles = self._parts.of(SourceWatch).troubles
        self.show_troubles()
        before, self._missed_before = self._missed_before, None
        found = None if before is None else describe_found_files(before, troubles)
        error = describe_file_problems(troubles)
        if error is not None and (self._is_to_be_told or before is not None):
            find = self._parts.window.actions_by_id["find-files"]
            self._parts.message_bar.show_error(error, remedy=find)
        if found is not None:
            self._parts.document.reported.emit(found)
        self._is_to_be_told = False
