"""Tools that make points of their own are asked where to, and run in the background."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QFileDialog

from app.window.window_parts import WindowParts
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.operations.new_points import points_ending


def ask_and_make_points(parts: WindowParts, tool: str, drive_id: str, parameters: object) -> None:
    """Ask for a file, beside the project at first, and have the tool write its points there.

    What is there already is asked for by the dialog.
    """
    project = parts.document.project
    if project is None:
        return
    ending = points_ending(tool)
    kind = next(one for one in FORMATS.written(Content.POINTS) if ending in one.endings)
    chosen, _ = QFileDialog.getSaveFileName(
        parts.window,
        QCoreApplication.translate("PointMaking", "Write the points"),
        str(project.folder.parent / f"{project.name}-{tool}{ending}"),
        kind.file_filter.in_language(parts.language),
    )
    if chosen:
        parts.document.make_points(tool, drive_id, parameters, Path(chosen))
