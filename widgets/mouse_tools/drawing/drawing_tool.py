"""DrawingTool: what all tools that make features of a kind have in common."""

from __future__ import annotations

from PySide6.QtCore import QObject
from typing_extensions import override

from processing.core.text import Text
from processing.map.catalogue import FeatureKind, Geometry
from processing.map.change import Change
from processing.map.feature import AttributeValue, Feature, Vertex, new_feature_id
from widgets.mouse_tools.mouse_tool import Hit, MouseTool
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

NO_POINT = Text(
    "There is no measured point here; click on a point.",
    "ここには計測点がありません。点の上をクリックしてください。",
)
NO_KIND = Text("Choose first what to draw.", "先に作図する地物の種別を選んでください。")

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

DRAW = {
    Geometry.POINT: Text("Draw a point", "点の作図"),
    Geometry.LINE: Text("Draw a line", "線の作図"),
    Geometry.AREA: Text("Draw an area", "面の作図"),
}


class DrawingTool(MouseTool):
    """Clicks become features of the kind that was chosen.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    draws : frozenset of Geometry
        The shapes it can make.
    """

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        draws: frozenset[Geometry],
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._shared = shared
        self._sketch = shared.sketch
        self._draws = draws
        self._kind: FeatureKind | None = None

    @property
    def draws(self) -> frozenset[Geometry]:
        """The shapes it can make."""
        return self._draws

    @property
    def kind(self) -> FeatureKind | None:
        """What is drawn; None before anything was chosen."""
        return self._kind

    def set_kind(self, kind: FeatureKind) -> None:
        """Draw features of this kind from now on; the drawing at hand becomes one too."""
        self._kind = kind
        self._show()

    @property
    @override
    def snaps(self) -> bool:
        return self._kind is not None

    @property
    @override
    def snaps_to_edges(self) -> bool:
        return self._kind is not None and self._kind.geometry is not Geometry.POINT

    @property
    @override
    def is_busy(self) -> bool:
        return self._sketch.drawing is not None

    def _show(self) -> None:
        """Show what is being drawn; a subclass says what."""

    def _vertex_of(self, hit: Hit) -> Vertex | None:
        """The vertex of a click, or None after saying why there is none."""
        if self._kind is None:
            self.reported.emit(NO_KIND)
            return None
        vertex = hit.as_vertex()
        if vertex is None:
            self.reported.emit(NO_POINT)
        return vertex

    def _finish(
        self, vertices: tuple[Vertex, ...], attributes: dict[str, AttributeValue] | None = None
    ) -> None:
        """Make a feature of the chosen kind, and put the gesture down."""
        kind = self._kind
        if kind is None:
            return
        known = {
            name: value
            for name, value in (attributes or {}).items()
            if kind.attribute(name) is not None
        }
        feature = Feature(new_feature_id(), kind.id, kind.geometry, vertices, known)
        self.put_down()
        self.change_requested.emit(DRAW[kind.geometry], Change(added=(feature,)))
