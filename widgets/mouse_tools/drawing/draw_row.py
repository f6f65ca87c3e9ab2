"""DrawRow: lids at the size and spacing of those that lie there, by two clicks or by one."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QObject
from typing_extensions import override

from processing.core.arrays import Floats
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.drafting.lid_rows import LidPattern, lid_in_gap, pattern_near, row_between
from processing.map.feature import Feature, Status, Vertex, new_feature_id
from widgets.mouse_tools.drawing.drawing_tool import DrawingTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Drawing, Note

ROW_OF_LIDS = Text("Lay a row of lids", "側溝蓋の列の配置")
NO_LID = Text(
    "Draw or find one lid of this kind first: the row takes its size and its spacing.",
    "先に同じ種別の側溝蓋を1枚、作図または抽出してください。大きさと間隔をそれに合わせます。",
)
LAST_LID = Text(
    "Click the middle of the last lid; Enter lays one lid here.",
    "最後の側溝蓋の中心をクリックしてください。Enterで1枚だけ配置します。",
)
_KEPT = ("gutter_type", "run")


class DrawRow(DrawingTool):
    """The first click is the middle of the first lid, the second that of the last.

    A click into a gap of a run that lacks one lid lays that one at once.
    """

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(source, shared, frozenset({Geometry.AREA}), parent)
        self._first: Vertex | None = None
        self._preview: Vertex | None = None

    @property
    @override
    def last_vertex(self) -> Vertex | None:
        return self._first

    @override
    def press(self, hit: Hit) -> None:
        vertex = self._vertex_of(hit)
        if vertex is None:
            return
        pattern = self._pattern(vertex)
        if pattern is None:
            self.reported.emit(NO_LID)
            return
        if self._first is not None:
            self._place(pattern, row_between(pattern, _xyz(self._first), _xyz(vertex)))
            return
        single = lid_in_gap(pattern, self._rings(), _xyz(vertex))
        if single is not None:
            self._place(pattern, (single,))
            return
        self._first = vertex
        self.reported.emit(LAST_LID)
        self._show()

    @override
    def move(self, hit: Hit) -> None:
        self._preview = hit.as_vertex()
        self._show()

    @override
    def complete(self) -> None:
        first = self._first
        pattern = None if first is None else self._pattern(first)
        if first is not None and pattern is not None:
            self._place(pattern, row_between(pattern, _xyz(first), _xyz(first)))

    @override
    def step_back(self) -> None:
        self.put_down()

    @override
    def put_down(self) -> None:
        self._first = self._preview = None
        self._show()

    def _lids(self) -> list[Feature]:
        kind = self._kind
        return [
            one
            for one in self._source.features()
            if kind is not None and one.kind == kind.id and one.status is not Status.REJECTED
        ]

    def _rings(self) -> list[Floats]:
        return [np.array([vertex.xyz for vertex in one.vertices]) for one in self._lids()]

    def _pattern(self, near: Vertex) -> LidPattern | None:
        return pattern_near(self._rings(), _xyz(near))

    def _place(self, pattern: LidPattern, rings: tuple[Floats, ...]) -> None:
        kind = self._kind
        if kind is None:
            return
        sizes = {"length_m": round(pattern.length_m, 3), "width_m": round(pattern.width_m, 3)}
        model = min(
            self._lids(),
            key=lambda one: float(
                np.linalg.norm(np.mean([v.xyz for v in one.vertices], axis=0) - pattern.middle)
            ),
        )
        kept = {name: model.attributes[name] for name in _KEPT if name in model.attributes}
        known = {
            name: value
            for name, value in {**kept, **sizes}.items()
            if kind.attribute(name) is not None
        }
        lids = tuple(
            Feature(new_feature_id(), kind.id, Geometry.AREA, _vertices(ring), known)
            for ring in rings
        )
        self.put_down()
        self.change_requested.emit(ROW_OF_LIDS, Change(added=lids))

    @override
    def _show(self) -> None:
        first, kind = self._first, self._kind
        pattern = None if first is None else self._pattern(first)
        if first is None or kind is None or pattern is None:
            self._sketch.show(None)
            return
        last = self._preview or first
        rings = row_between(pattern, _xyz(first), _xyz(last))
        # One outline of all: joints show as it turns back along each lid.
        outline = [vertex for ring in rings for vertex in _vertices(np.vstack([ring, ring[:1]]))]
        note = Note(last.xyz, f"{len(rings)} × {pattern.length_m:.2f} m")
        drawing = Drawing(
            kind.id, Geometry.LINE, tuple(outline[:1]), tuple(outline[1:]), notes=(note,)
        )
        self._sketch.show(drawing)


def _xyz(vertex: Vertex) -> Floats:
    return np.array(vertex.xyz)


def _vertices(ring: Floats) -> tuple[Vertex, ...]:
    return tuple(Vertex((east, north, up)) for east, north, up in ring.tolist())
