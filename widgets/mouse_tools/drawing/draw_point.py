"""DrawPoint: every click on a measured point is a feature; a drag gives it a direction."""

from __future__ import annotations

import math

from PySide6.QtCore import QObject
from typing_extensions import override

from processing.map.catalogue import Geometry
from processing.map.feature import AttributeValue, Vertex
from widgets.mouse_tools.drawing.drawing_tool import DrawingTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Drawing, Note

DIRECTIONS = ("facing_deg", "direction_deg")
"""Attributes that say where a thing looks, degrees clockwise from grid north."""

_LEAST_DRAG_M = 0.05


class DrawPoint(DrawingTool):
    """Press, and drag to where a sign faces or a lamp reaches; nothing needs to be completed."""

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(source, shared, frozenset({Geometry.POINT}), parent)
        self._vertex: Vertex | None = None
        self._towards: Vertex | None = None

    @override
    def press(self, hit: Hit) -> None:
        self._vertex, self._towards = self._vertex_of(hit), None

    @override
    def move(self, hit: Hit) -> None:
        if self._vertex is not None and self._can_turn():
            self._towards = hit.as_vertex()
            self._show()

    @override
    def release(self, hit: Hit) -> None:
        if self._vertex is None:
            return
        direction = self._direction_deg()
        turned: dict[str, AttributeValue] = (
            {} if direction is None else dict.fromkeys(DIRECTIONS, round(direction, 1))
        )
        self._finish((self._vertex,), turned)

    @override
    def put_down(self) -> None:
        self._vertex = self._towards = None
        self._sketch.show(None)

    def _can_turn(self) -> bool:
        kind = self._kind
        return kind is not None and any(kind.attribute(name) is not None for name in DIRECTIONS)

    def _direction_deg(self) -> float | None:
        if self._vertex is None or self._towards is None:
            return None
        east = self._towards.xyz[0] - self._vertex.xyz[0]
        north = self._towards.xyz[1] - self._vertex.xyz[1]
        if math.hypot(east, north) < _LEAST_DRAG_M:
            return None
        return math.degrees(math.atan2(east, north)) % 360.0

    @override
    def _show(self) -> None:
        direction = self._direction_deg()
        if self._vertex is None or self._towards is None or self._kind is None or direction is None:
            return
        note = Note(self._towards.xyz, f"{direction:.0f}°")
        self._sketch.show(
            Drawing(self._kind.id, Geometry.POINT, (self._vertex,), (self._towards,), notes=(note,))
        )
