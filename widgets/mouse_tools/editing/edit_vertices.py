"""EditVertices: vertices are dragged to other measured points, put in and taken out."""

from __future__ import annotations

from PySide6.QtCore import QObject
from typing_extensions import override

from processing.core.text import Text
from processing.map.feature import Feature
from widgets.mouse_tools.drawing.drawing_tool import LEAST_VERTICES, NO_POINT, TOO_FEW
from widgets.mouse_tools.editing.vertex_drag import VertexDrag
from widgets.mouse_tools.editing.vertex_drag_tool import VertexDragTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.mouse_tools.removal import removal_of
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

MOVE_VERTEX = Text("Move a vertex", "頂点の移動")
INSERT_VERTEX = Text("Insert a vertex", "頂点の挿入")
REMOVE_VERTEX = Text("Remove a vertex", "頂点の削除")


class EditVertices(VertexDragTool):
    """A press on a vertex takes hold of it, a press on a segment puts a vertex in."""

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(source, shared, parent)
        self._under_mouse = Hit(None)

    @override
    def press(self, hit: Hit) -> None:
        self._under_mouse = hit
        feature = self._feature_of(hit)
        self._selection.choose_features(frozenset((feature.id,) if feature else ()))
        if feature is None:
            return
        vertex = hit.as_vertex()
        if hit.vertex >= 0:
            self._take(VertexDrag.of_vertex(feature, hit.vertex))
        elif hit.segment >= 0 and vertex is None:
            self.reported.emit(NO_POINT)
        elif hit.segment >= 0 and vertex is not None:
            self._take(VertexDrag.of_segment(feature, hit.segment, vertex))

    @override
    def move(self, hit: Hit) -> None:
        self._under_mouse = hit
        super().move(hit)

    @override
    def release(self, hit: Hit) -> None:
        drag = self._drag
        if drag is None:
            return
        self.put_down()
        if hit.position is None and drag.vertices != drag.before.vertices:
            self.reported.emit(NO_POINT)
            return
        is_new = len(drag.vertices) > len(drag.before.vertices)
        self._replace(INSERT_VERTEX if is_new else MOVE_VERTEX, drag.before, drag.after)

    @override
    def delete(self) -> None:
        hit = self._under_mouse
        feature = self._feature_of(hit)
        if self._drag is not None:
            return
        if feature is not None and 0 <= hit.vertex < len(feature.vertices):
            self._remove_vertex(feature, hit.vertex)
            return
        features = self._selected_features()
        if features:
            self.change_requested.emit(*removal_of(features))

    def _remove_vertex(self, feature: Feature, index: int) -> None:
        if len(feature.vertices) <= LEAST_VERTICES[feature.geometry]:
            self.reported.emit(TOO_FEW[feature.geometry])
            return
        vertices = (*feature.vertices[:index], *feature.vertices[index + 1 :])
        self._under_mouse = Hit(None)  # its vertex numbers no longer hold
        self._replace(REMOVE_VERTEX, feature, feature.with_vertices(vertices))
