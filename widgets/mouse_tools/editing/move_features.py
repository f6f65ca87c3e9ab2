"""MoveFeatures: features dragged from one measured point to another, or copied there."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QObject, Qt
from typing_extensions import override

from processing.core.text import Text
from processing.map.change import Change, Replacement
from processing.map.drafting.line_edits import move_feature
from processing.map.feature import Feature, Position, Vertex, new_feature_id
from widgets.mouse_tools.drawing.drawing_tool import NO_POINT
from widgets.mouse_tools.editing_tool import PICK_FEATURE, EditingTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Drawing, Note

MOVE = Text("Move {count} features", "{count}個の地物の移動")
COPY = Text("Copy {count} features", "{count}個の地物の複写")

_SHIFT_NOTE = "ΔE {east:+.3f}  ΔN {north:+.3f}  ΔH {up:+.3f} m"


class MoveFeatures(EditingTool):
    """A press on a chosen feature takes all chosen ones, on another that one; Ctrl copies.

    The way from the point pressed to the point released is the way of every vertex, heights
    included; what was moved rests on no measured point any more.
    """

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(source, shared, parent)
        self._held: tuple[Feature, ...] = ()
        self._from: Vertex | None = None
        self._to: Vertex | None = None

    @property
    @override
    def snaps(self) -> bool:
        return self._from is not None

    @property
    @override
    def ctrl_frees(self) -> bool:
        return False  # it copies

    @property
    @override
    def is_busy(self) -> bool:
        return self._from is not None

    @override
    def press(self, hit: Hit) -> None:
        feature = self._feature_of(hit)
        if feature is None:
            self.reported.emit(PICK_FEATURE)
            return
        if feature.id not in self._selection.features:
            self._selection.choose_features(frozenset({feature.id}))
        vertex = hit.as_vertex()
        grip = feature.vertices[hit.vertex] if hit.vertex >= 0 else vertex
        if grip is None:
            self.reported.emit(NO_POINT)
            return
        self._held, self._from, self._to = self._selected_features(), grip, None

    @override
    def move(self, hit: Hit) -> None:
        self._to = hit.as_vertex()
        way, held = self._way(), self._held
        if way is None or self._from is None or self._to is None or not held:
            return
        first = move_feature(held[0], way)
        east, north, up = way
        note = Note(self._to.xyz, _SHIFT_NOTE.format(east=east, north=north, up=up))
        self._sketch.show(
            Drawing(first.kind, first.geometry, first.vertices, (), held[0].id, (note,))
        )

    @override
    def release(self, hit: Hit) -> None:
        self._to = hit.as_vertex()
        way, held = self._way(), self._held
        was_held = self._from is not None
        self.put_down()
        if way is None or way == (0.0, 0.0, 0.0):
            if was_held and hit.position is None:
                self.reported.emit(NO_POINT)
            return
        if hit.modifiers & Qt.KeyboardModifier.ControlModifier:
            copies = tuple(replace(move_feature(one, way), id=new_feature_id()) for one in held)
            self.change_requested.emit(COPY.filled(count=len(held)), Change(added=copies))
        else:
            pairs = tuple(Replacement(one, move_feature(one, way)) for one in held)
            self.change_requested.emit(MOVE.filled(count=len(held)), Change(replaced=pairs))

    @override
    def put_down(self) -> None:
        self._held, self._from, self._to = (), None, None
        self._sketch.show(None)

    def _way(self) -> Position | None:
        if self._from is None or self._to is None:
            return None
        (x, y, z), (to_x, to_y, to_z) = self._from.xyz, self._to.xyz
        return to_x - x, to_y - y, to_z - z
