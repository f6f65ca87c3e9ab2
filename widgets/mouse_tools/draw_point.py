"""DrawPoint: every click on a measured point is a feature."""

from __future__ import annotations

from PySide6.QtCore import QObject
from typing_extensions import override

from processing.project.catalogue import Geometry
from widgets.mouse_tools.drawing_tool import DrawingTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.shared_state import SharedState


class DrawPoint(DrawingTool):
    """Draws points; nothing needs to be completed."""

    def __init__(self, shared: SharedState, parent: QObject | None = None) -> None:
        super().__init__(shared, Geometry.POINT, parent)

    @override
    def press(self, hit: Hit) -> None:
        super().press(hit)
        self.complete()
