"""VertexDragTool: tools in which a vertex follows the mouse."""

from __future__ import annotations

from PySide6.QtCore import QObject
from typing_extensions import override

from widgets.mouse_tools.editing.vertex_drag import VertexDrag
from widgets.mouse_tools.editing_tool import EditingTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState


class VertexDragTool(EditingTool):
    """Holds the vertex that is dragged; while it is, hits snap."""

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(source, shared, parent)
        self._drag: VertexDrag | None = None

    @property
    @override
    def snaps(self) -> bool:
        return self._drag is not None

    @property
    @override
    def snaps_to_edges(self) -> bool:
        return self._drag is not None and len(self._drag.vertices) > 1

    @property
    @override
    def is_busy(self) -> bool:
        return self._drag is not None

    @override
    def move(self, hit: Hit) -> None:
        vertex = hit.as_vertex()
        if self._drag is not None and vertex is not None:
            self._take(self._drag.moved_to(vertex))

    @override
    def put_down(self) -> None:
        if self._drag is not None:
            self._drag = None
            self._sketch.show(None)

    def _take(self, drag: VertexDrag) -> None:
        """Hold a vertex, or hold it elsewhere."""
        self._drag = drag
        self._sketch.show(drag.drawing)
