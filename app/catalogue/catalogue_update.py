"""An office's catalogue for the project: kinds that the map uses are kept after asking."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QCoreApplication
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QMessageBox

from app.window.window_parts import WindowParts
from processing.core.errors import UserError


def adopt_catalogue(parts: WindowParts, path: Path) -> None:
    """Use a catalogue file; asks where kinds that the map uses are not in it."""
    project = parts.document.project
    if project is None:
        return
    try:
        comparison = project.compare_catalogue(path)
    except UserError as error:
        parts.document.refused.emit(error)
        return
    if comparison.loses_nothing or comparison.used_reshaped:
        parts.document.adopt_catalogue(path, keep_used=False)
        return
    box = QMessageBox(parts.window)
    box.setWindowTitle(QCoreApplication.translate("CatalogueWish", "Use an office's catalogue"))
    box.setText(
        QCoreApplication.translate(
            "CatalogueWish", "The map uses kinds that the file doesn't have. Keep them with it?"
        )
    )
    lines = [text.in_language(parts.language) for text in comparison.texts()]
    box.setInformativeText("\n".join(lines))
    keep = box.addButton(
        QCoreApplication.translate("CatalogueWish", "Keep them"), QMessageBox.ButtonRole.AcceptRole
    )
    cancel = box.addButton(QMessageBox.StandardButton.Cancel)
    cancel.setIcon(QIcon())  # no other button has one

    def decide() -> None:
        if box.clickedButton() is keep:
            parts.document.adopt_catalogue(path, keep_used=True)
        box.deleteLater()

    box.finished.connect(decide)
    box.open()
