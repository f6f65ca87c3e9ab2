"""DrawLine: click by click, completed by Enter, the right button or a double click."""

from __future__ import annotations

from PySide6.QtCore import QObject

from processing.project.catalogue import Geometry
from widgets.mouse_tools.drawing_tool import DrawingTool
from widgets.shared.shared_state import SharedState


class DrawLine(DrawingTool):
    """Draws lines of at least two measured points."""

    def __init__(self, shared: SharedState, parent: QObject | None = None) -> None:
        super().__init__(shared, Geometry.LINE, parent)
