"""Select: the pointer. Choosing features and points, putting the cursor, dragging a vertex."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Qt
from typing_extensions import override

from widgets.mouse_tools.drawing.drawing_tool import NO_POINT
from widgets.mouse_tools.editing.edit_vertices import MOVE_VERTEX
from widgets.mouse_tools.editing.vertex_drag import VertexDrag
from widgets.mouse_tools.editing.vertex_drag_tool import VertexDragTool
from widgets.mouse_tools.mouse_tool import DragShape, EnclosedHits, Hit
from widgets.mouse_tools.removal import removal_of
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_SHIFT = Qt.KeyboardModifier.ShiftModifier


class Select(VertexDragTool):
    """A click chooses and puts the cursor, a drag draws a box or moves a chosen feature's vertex.

    With Shift, what is hit is added to what was chosen.

    Parameters
    ----------
    shape : DragShape
        What a drag over nothing draws: a box or a lasso.
    """

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        shape: DragShape = DragShape.BOX,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(source, shared, parent)
        self._cursor = shared.cursor
        self._shape = shape

    @override
    def press(self, hit: Hit) -> None:
        feature = self._feature_of(hit)
        if feature is not None and hit.vertex >= 0 and feature.id in self._selection.features:
            self._drag = VertexDrag.of_vertex(feature, hit.vertex)

    @override
    def drag_shape(self, hit: Hit) -> DragShape:
        return self._shape if self._drag is None else DragShape.NONE

    @override
    def release(self, hit: Hit) -> None:
        drag = self._drag
        self.put_down()
        if drag is None or drag.after == drag.before:
            self._choose(hit)
        elif hit.position is None:
            self.reported.emit(NO_POINT)
        else:
            self._replace(MOVE_VERTEX, drag.before, drag.after)

    @override
    def choose_box(self, boxed: EnclosedHits) -> None:
        self.put_down()
        selection = self._selection
        if boxed.modifiers & _SHIFT:
            points = selection.points
            for drive, added in boxed.points.items():
                points[drive] = _join_points(points.get(drive), added)
            selection.choose_features(selection.features | boxed.features)
            selection.choose_points(points)
        else:
            selection.choose_features(boxed.features)
            selection.choose_points(dict(boxed.points))

    @override
    def delete(self) -> None:
        features = self._selected_features()
        if features:
            self.change_requested.emit(*removal_of(features))

    @override
    def leave(self) -> None:
        if self._drag is not None:
            self.put_down()
        elif self._shape is not DragShape.BOX:
            super().leave()
        else:
            self._selection.clear()

    def _choose(self, hit: Hit) -> None:
        selection = self._selection
        clicked = frozenset((hit.feature,) if hit.feature else ())
        if hit.modifiers & _SHIFT:
            selection.choose_features(selection.features ^ clicked)
        else:
            selection.choose_features(clicked)
            selection.choose_points({})
        if hit.position is not None:
            self._cursor.move_to(hit.position)


def _join_points(one: NDArray[np.int64] | None, other: NDArray[np.int64]) -> NDArray[np.int64]:
    return other if one is None else np.concatenate([one, other])
