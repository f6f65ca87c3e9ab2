"""DrawShape: rectangles and circles by three points, for lids, gratings, manholes and trunks."""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import Enum

import numpy as np
from PySide6.QtCore import QObject
from typing_extensions import override

from processing.core.errors import UserError
from processing.map.catalogue import Geometry
from processing.map.drafting.constructions import circle_through, rectangle_from
from processing.map.feature import AttributeValue, Position, Vertex
from widgets.mouse_tools.drawing.drawing_tool import DrawingTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Drawing, Note

Construction = Callable[[Position, Position, Position], tuple[Position, ...]]


class ThreePointShape(Enum):
    """What three points make."""

    RECTANGLE = "rectangle"
    CIRCLE = "circle"


_MADE_BY: dict[ThreePointShape, Construction] = {
    ThreePointShape.RECTANGLE: rectangle_from,
    ThreePointShape.CIRCLE: circle_through,
}
_POINTS = 3


class DrawShape(DrawingTool):
    """The third click completes the shape.

    Of a kind that is an area it makes a ring, of a line a closed line, of a point its middle, with
    the size and the direction where the kind has such attributes.
    """

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        shape: ThreePointShape,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(source, shared, frozenset(Geometry), parent)
        self._shape = shape
        self._clicked: tuple[Vertex, ...] = ()
        self._preview: Vertex | None = None
        self._asked: tuple[Vertex, ...] = ()

    @property
    @override
    def last_vertex(self) -> Vertex | None:
        return self._clicked[-1] if self._clicked else None

    @property
    @override
    def snaps_to_edges(self) -> bool:
        return self._kind is not None

    @override
    def press(self, hit: Hit) -> None:
        vertex = self._vertex_of(hit)
        if vertex is None or vertex.xyz in [one.xyz for one in self._clicked]:
            return
        if len(self._clicked) + 1 < _POINTS:
            self._clicked += (vertex,)
            self._show()
            return
        try:
            ring = self._ring((*self._clicked, vertex))
        except UserError as refusal:  # three points in one line make no shape
            self.reported.emit(refusal.what)
            return
        self._asked = self._clicked
        self._complete_with(ring)

    @override
    def move(self, hit: Hit) -> None:
        self._preview = hit.as_vertex()
        self._show()

    @override
    def step_back(self) -> None:
        self._clicked = self._clicked[:-1]
        self._show()

    @override
    def put_down(self) -> None:
        self._clicked, self._preview = (), None
        self._show()

    @override
    def take_back(self) -> None:
        self._clicked = self._asked
        self._show()

    def _ring(self, clicked: tuple[Vertex, ...]) -> tuple[Vertex, ...]:
        first, second, third = clicked
        positions = _MADE_BY[self._shape](first.xyz, second.xyz, third.xyz)
        known = {vertex.xyz: vertex for vertex in clicked}
        return tuple(known.get(position, Vertex(position)) for position in positions)

    def _complete_with(self, ring: tuple[Vertex, ...]) -> None:
        geometry = None if self._kind is None else self._kind.geometry
        if geometry is Geometry.AREA:
            self._finish(ring)
        elif geometry is Geometry.LINE:
            self._finish((*ring, ring[0]))
        else:
            xyz = np.array([vertex.xyz for vertex in ring])
            east, north, up = xyz.mean(axis=0).tolist()
            self._finish((Vertex((east, north, up)),), self._facts(ring))

    def _facts(self, ring: tuple[Vertex, ...]) -> dict[str, AttributeValue]:
        """Sizes as attributes name them; the kind keeps those it knows."""
        first, second, third = (np.array(ring[position].xyz) for position in (0, 1, 2))
        length, width = (float(np.linalg.norm(way)) for way in (second - first, third - second))
        if self._shape is ThreePointShape.CIRCLE:
            middle = np.array([vertex.xyz for vertex in ring]).mean(axis=0)
            across = 2 * float(np.linalg.norm(first - middle))
            return {"diameter_m": round(across, 3), "size_m": round(across, 3)}
        east, north, _ = (second - first).tolist()
        return {
            "length_m": round(length, 3),
            "width_m": round(width, 3),
            "direction_deg": round(math.degrees(math.atan2(east, north)) % 360.0, 1),
        }

    @override
    def _show(self) -> None:
        if not self._clicked or self._kind is None:
            self._sketch.show(None)
            return
        preview: tuple[Vertex, ...] = () if self._preview is None else (self._preview,)
        if preview and len(self._clicked) + 1 == _POINTS:
            try:
                ring = self._ring((*self._clicked, *preview))
            except UserError:  # not yet a shape
                ring = ()
            if ring:
                coming = (*ring[1:], ring[0])
                notes = (Note(preview[0].xyz, self._size_of(ring)),)
                drawing = Drawing(self._kind.id, Geometry.LINE, ring[:1], coming, notes=notes)
                self._sketch.show(drawing)
                return
        self._sketch.show(Drawing(self._kind.id, Geometry.LINE, self._clicked, preview))

    def _size_of(self, ring: tuple[Vertex, ...]) -> str:
        facts = self._facts(ring)
        if self._shape is ThreePointShape.CIRCLE:
            return f"⌀ {facts['diameter_m']:.2f} m"
        return f"{facts['length_m']:.2f} × {facts['width_m']:.2f} m"
