"""DrawingTool: what drawing points, lines and areas have in common."""

from __future__ import annotations

from PySide6.QtCore import QObject
from typing_extensions import override

from processing.project.catalogue import Geometry
from processing.project.change import Change
from processing.project.feature import Feature, Vertex, new_feature_id
from processing.text import Text
from widgets.mouse_tools.mouse_tool import Hit, MouseTool
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Drawing

NO_POINT = Text(
    "There is no measured point here; click on a point.",
    "ここには計測点がありません。点の上をクリックしてください。",
)
NO_KIND = Text("Choose first what to draw.", "先に作図する地物の種類を選んでください。")

LEAST_VERTICES = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}
"""Fewer vertices make no feature of that shape."""

TOO_FEW = {
    Geometry.POINT: Text("A point needs one vertex.", "点には頂点が1つ必要です。"),
    Geometry.LINE: Text(
        "A line needs at least two vertices.", "線には少なくとも2つの頂点が必要です。"
    ),
    Geometry.AREA: Text(
        "An area needs at least three vertices.", "面には少なくとも3つの頂点が必要です。"
    ),
}

_LABELS = {
    Geometry.POINT: Text("Draw a point", "点の作図"),
    Geometry.LINE: Text("Draw a line", "線の作図"),
    Geometry.AREA: Text("Draw an area", "面の作図"),
}


class DrawingTool(MouseTool):
    """Clicks become vertices; the feature is there when the gesture is completed.

    Parameters
    ----------
    shared : SharedState
    geometry : Geometry
        The shape that is drawn.
    """

    def __init__(
        self, shared: SharedState, geometry: Geometry, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._sketch = shared.sketch
        self._geometry = geometry
        self._kind = ""
        self._vertices: tuple[Vertex, ...] = ()
        self._preview: Vertex | None = None
        self._is_leaving = False

    @property
    def geometry(self) -> Geometry:
        """The shape that is drawn."""
        return self._geometry

    @property
    def kind(self) -> str:
        """The feature kind that is drawn; empty before one was set."""
        return self._kind

    def set_kind(self, kind: str) -> None:
        """Draw features of this kind from now on; the drawing at hand becomes one too."""
        self._kind = kind
        self._show()

    @override
    def press(self, hit: Hit) -> None:
        vertex = hit.as_vertex()
        if not self._kind:
            self.told.emit(NO_KIND)
        elif vertex is None:
            self.told.emit(NO_POINT)
        # Where a view sends both presses of a double click, the second one adds nothing.
        elif vertex not in self._vertices[-1:]:
            self._vertices += (vertex,)
            self._show()

    @override
    def move(self, hit: Hit) -> None:
        self._preview = hit.as_vertex()
        self._show()

    @override
    def complete(self) -> None:
        if not self._vertices:
            return
        if len(self._vertices) < LEAST_VERTICES[self._geometry]:
            self.told.emit(TOO_FEW[self._geometry])
            return
        feature = Feature(new_feature_id(), self._kind, self._geometry, self._vertices)
        self.put_down()
        self.change_requested.emit(_LABELS[self._geometry], Change(added=(feature,)))

    @override
    def step_back(self) -> None:
        self._vertices = self._vertices[:-1]
        self._show()

    @override
    def leave(self) -> None:
        if self._vertices:
            self.put_down()
        elif not self._is_leaving:
            # Whoever takes the hand back may tell this tool to leave in turn.
            self._is_leaving = True
            self.finished.emit()
            self._is_leaving = False

    @override
    def put_down(self) -> None:
        self._vertices, self._preview = (), None
        self._show()

    def _show(self) -> None:
        self._sketch.show(
            Drawing(self._kind, self._geometry, self._vertices, self._preview)
            if self._vertices
            else None
        )
