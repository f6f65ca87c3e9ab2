"""PaintOutline: labels all measured points inside a rectangle or a lasso, in any view."""

from __future__ import annotations

from PySide6.QtCore import QObject
from typing_extensions import override

from widgets.mouse_tools.mouse_tool import DragShape, EnclosedHits, Hit
from widgets.mouse_tools.painting.paint_tool import PaintTool
from widgets.mouse_tools.tracing import BackgroundRunner
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState


class PaintOutline(PaintTool):
    """A drag draws the outline; all measured points inside it get the label, drawn or not.

    Parameters
    ----------
    shape : DragShape
        A box or a lasso.
    """

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        in_background: BackgroundRunner,
        shape: DragShape,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(source, shared, in_background, parent)
        self._shape = shape

    @override
    def drag_shape(self, hit: Hit) -> DragShape:
        return self._shape

    @override
    def choose_box(self, boxed: EnclosedHits) -> None:
        self._begin()
        if boxed.find_every is None:
            self._paint(boxed.points)
        else:
            self._paint_later(boxed.every)
