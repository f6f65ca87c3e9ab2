"""Select: the pointer. Choosing features and points, putting the cursor, dragging a vertex."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Qt
from typing_extensions import override

from widgets.mouse_tools.drawing_tool import NO_POINT
from widgets.mouse_tools.edit_vertices import MOVE_VERTEX
from widgets.mouse_tools.mouse_tool import Boxed, Hit, MouseTool
from widgets.mouse_tools.removal import removal_of
from widgets.mouse_tools.vertex_drag import VertexDrag
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_SHIFT = Qt.KeyboardModifier.ShiftModifier


class Select(MouseTool):
    """A click chooses and puts the cursor, a drag draws a box or moves a chosen feature's vertex.

    With Shift, what is hit is added to what was chosen.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    """

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._cursor = shared.cursor
        self._selection = shared.selection
        self._sketch = shared.sketch
        self._drag: VertexDrag | None = None

    @override
    def press(self, hit: Hit) -> None:
        feature = self._source.feature(hit.feature) if hit.feature else None
        if feature is not None and hit.vertex >= 0 and feature.id in self._selection.features:
            self._drag = VertexDrag.of_vertex(feature, hit.vertex)

    @override
    def takes_box(self, hit: Hit) -> bool:
        return self._drag is None

    @override
    def move(self, hit: Hit) -> None:
        vertex = hit.as_vertex()
        if self._drag is not None and vertex is not None:
            self._drag = self._drag.moved_to(vertex)
            self._sketch.show(self._drag.drawing)

    @override
    def release(self, hit: Hit) -> None:
        drag = self._drag
        self.put_down()
        if drag is None or drag.change.is_empty:
            self._choose(hit)
        elif hit.place is None:
            self.told.emit(NO_POINT)
        else:
            self.change_requested.emit(MOVE_VERTEX, drag.change)

    @override
    def choose_box(self, boxed: Boxed) -> None:
        self.put_down()
        selection = self._selection
        if boxed.modifiers & _SHIFT:
            points = selection.points
            for drive, added in boxed.points.items():
                points[drive] = _joined(points.get(drive), added)
            selection.choose_features(selection.features | boxed.features)
            selection.choose_points(points)
        else:
            selection.choose_features(boxed.features)
            selection.choose_points(dict(boxed.points))

    @override
    def delete(self) -> None:
        chosen = [self._source.feature(id_) for id_ in sorted(self._selection.features)]
        features = tuple(feature for feature in chosen if feature is not None)
        if features:
            self.change_requested.emit(*removal_of(features))

    @override
    def leave(self) -> None:
        if self._drag is not None:
            self.put_down()
        else:
            self._selection.clear()

    @override
    def put_down(self) -> None:
        if self._drag is not None:
            self._drag = None
            self._sketch.show(None)

    def _choose(self, hit: Hit) -> None:
        selection = self._selection
        clicked = frozenset((hit.feature,) if hit.feature else ())
        if hit.modifiers & _SHIFT:
            selection.choose_features(selection.features ^ clicked)
        else:
            selection.choose_features(clicked)
            selection.choose_points({})
        if hit.place is not None:
            self._cursor.move_to(hit.place)


def _joined(one: NDArray[np.int64] | None, other: NDArray[np.int64]) -> NDArray[np.int64]:
    return other if one is None else np.concatenate([one, other])
