"""DrawArea: corner by corner; the ring closes by itself when it is completed."""

from __future__ import annotations

from PySide6.QtCore import QObject

from processing.project.catalogue import Geometry
from widgets.mouse_tools.drawing_tool import DrawingTool
from widgets.shared.shared_state import SharedState


class DrawArea(DrawingTool):
    """Draws areas of at least three measured points."""

    def __init__(self, shared: SharedState, parent: QObject | None = None) -> None:
        super().__init__(shared, Geometry.AREA, parent)
