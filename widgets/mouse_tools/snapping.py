"""SnappingTool: draws hits to vertices, lines and points of note before a tool gets them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from PySide6.QtCore import QObject, Qt
from typing_extensions import override

from processing.image.edges.edges import edge_beside, highest_point, lowest_point
from processing.map.catalogue import Geometry
from processing.map.drafting.crossings import LinePosition, line_positions
from processing.map.drafting.heights import set_on_ground
from processing.map.feature import Feature, PointReference, Vertex
from widgets.mouse_tools.mouse_tool import DragShape, EnclosedHits, Hit, MouseTool
from widgets.mouse_tools.near_features import NearFeatures
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState
from widgets.shared.snap_state import SnapMark, SnapMode

EDGE_PX = 8
"""How far beside an edge a click still means it, pixels of the image."""

_MOST_REACHES = 2.0
"""How many times the reach of the mouse an edge may be away: close up, 8 pixels are far."""

_ALIKE_M = 0.03
_DRAWN_BEFORE = 1.5
"""What is drawn goes before an edge up to so many times its distance, and 3 cm more."""

_MODE_OF_POSITION = {
    "vertex": SnapMode.VERTEX,
    "intersection": SnapMode.CROSSING,
    "line": SnapMode.LINE,
    "perpendicular": SnapMode.LINE,
    "extension": SnapMode.EXTENSION,
}
_ORDER = ("vertex", "intersection", "perpendicular", "line", "extension")


class SnappingTool(MouseTool):
    """Stands between the views and the tool in the hand; every view tells it its hits.

    Vertices go before crossings, those before lines and extensions, drawn things before the edges
    of the cloud. Ctrl turns snapping off while it is held.

    Parameters
    ----------
    source : MapSource
    shared : SharedState

    Attributes
    ----------
    tool : MouseTool
        The tool in the hand.
    """

    def __init__(
        self, source: MapSource, shared: SharedState, tool: MouseTool, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._shared = shared
        self._near = NearFeatures(source, shared.map_changes)
        self.tool = tool

    @property
    @override
    def is_busy(self) -> bool:
        return self.tool.is_busy

    @override
    def press(self, hit: Hit) -> None:
        self.tool.press(self.snapped(hit))

    @override
    def move(self, hit: Hit) -> None:
        self.tool.move(self.snapped(hit))

    @override
    def release(self, hit: Hit) -> None:
        self.tool.release(self.snapped(hit))
        self._shared.snap.show_mark(None)

    @override
    def drag_shape(self, hit: Hit) -> DragShape:
        return self.tool.drag_shape(hit)

    @override
    def choose_box(self, boxed: EnclosedHits) -> None:
        self.tool.choose_box(boxed)

    @override
    def complete(self) -> None:
        self.tool.complete()

    @override
    def step_back(self) -> None:
        self.tool.step_back()

    @override
    def leave(self) -> None:
        self.tool.leave()

    @override
    def put_down(self) -> None:
        self.tool.put_down()
        self._shared.snap.show_mark(None)

    @override
    def delete(self) -> None:
        self.tool.delete()

    def snapped(self, hit: Hit) -> Hit:
        """The hit where a click would land now; its mark is shown in every view."""
        if not self.tool.snaps:
            self._shared.snap.show_mark(None)
            return hit
        hit = self._on_plane(hit)
        is_free = self.tool.ctrl_frees and bool(hit.modifiers & Qt.KeyboardModifier.ControlModifier)
        found = None if is_free or hit.position is None else self._find_snap(hit, hit.position)
        if found is None:
            self._shared.snap.show_mark(None)
            return hit
        position, mode = found
        self._shared.snap.show_mark(SnapMark(position.xyz, mode))
        return replace(hit, position=position)

    def _find_snap(
        self, hit: Hit, position: PickedPosition
    ) -> tuple[PickedPosition, SnapMode] | None:
        """What is drawn, unless an edge of the cloud is much nearer to the mouse.

        Seen from far the circle about the mouse holds both edges of a curb: who points at the upper
        one doesn't mean the lower one that is drawn already.
        """
        drawn, measured = self._find_drawn_position(hit), self._find_measured_position(hit)
        if drawn is None or measured is None:
            return drawn or measured
        to_drawn = math.dist(drawn[0].xyz, position.xyz)
        to_measured = math.dist(measured[0].xyz, position.xyz)
        return drawn if to_drawn <= _DRAWN_BEFORE * to_measured + _ALIKE_M else measured

    def _on_plane(self, hit: Hit) -> Hit:
        plane = self._shared.snap.plane
        if plane is None:
            return hit
        met = None if hit.ray is None else plane.meets(hit.ray.origin, hit.ray.direction)
        if met is None and hit.position is not None:
            easting, northing, _ = hit.position.xyz
            met = (easting, northing, plane.height_at(easting, northing))
        return replace(hit, position=None if met is None else PickedPosition(met, is_occluded=True))

    def _find_drawn_position(self, hit: Hit) -> tuple[PickedPosition, SnapMode] | None:
        """The best place on what is drawn already, among the modes that are on."""
        modes = self._shared.snap.modes
        if hit.position is None or hit.reach_m <= 0 or not modes:
            return None
        own = self._shared.sketch.drawing
        pointed = self._pointed_at(hit, "" if own is None else own.replaces)
        if pointed is not None:
            return pointed, SnapMode.VERTEX
        features = self._near.within(hit.position.xyz, hit.reach_m)
        replaced = "" if own is None else own.replaces
        lines = [_outline(one) for one in features if one.id != replaced]
        if own is not None and not own.replaces:
            lines.append(own.vertices[:-1])
        last = self.tool.last_vertex
        found = line_positions(
            hit.position.xyz,
            [tuple(vertex.xyz for vertex in line) for line in lines if line],
            hit.reach_m,
            from_=None if last is None else last.xyz,
        )
        wanted = [one for one in found if _MODE_OF_POSITION[one.what] in modes]
        if not wanted:
            return None
        best = min(wanted, key=lambda one: (_ORDER.index(one.what), one.distance_m))
        return self._position_of(best, lines), _MODE_OF_POSITION[best.what]

    def _pointed_at(self, hit: Hit, replaced: str) -> PickedPosition | None:
        """The drawn vertex under the mouse in the picture, however far behind it the points are."""
        if SnapMode.VERTEX not in self._shared.snap.modes or hit.vertex < 0:
            return None
        feature = None if hit.feature == replaced else self._source.feature(hit.feature)
        if feature is None or hit.vertex >= len(feature.vertices):
            return None
        vertex = feature.vertices[hit.vertex]
        return PickedPosition(vertex.xyz, vertex.measured, vertex.is_occluded)

    def _position_of(self, found: LinePosition, lines: list[tuple[Vertex, ...]]) -> PickedPosition:
        if found.what == "vertex":
            for line in lines:
                for vertex in line:
                    if vertex.xyz == found.xyz:
                        return PickedPosition(vertex.xyz, vertex.measured, vertex.is_occluded)
        if found.what == "extension":
            vertex = set_on_ground((found.xyz,), self._source.drives())[0]
            return PickedPosition(vertex.xyz, vertex.measured, vertex.is_occluded)
        return PickedPosition(found.xyz)

    def _find_measured_position(self, hit: Hit) -> tuple[PickedPosition, SnapMode] | None:
        """The lowest, the highest or the edge point near the point under the mouse."""
        modes, position = self._shared.snap.modes, hit.position
        if position is None or position.measured is None:
            return None
        drive = self._source.drive(position.measured.drive)
        point = position.measured.point
        if SnapMode.LOWEST in modes:
            found, mode = lowest_point(drive, point, hit.reach_m), SnapMode.LOWEST
        elif SnapMode.HIGHEST in modes:
            found, mode = highest_point(drive, point, hit.reach_m), SnapMode.HIGHEST
        elif SnapMode.EDGE in modes and self.tool.snaps_to_edges:
            edge = edge_beside(drive, point, EDGE_PX)
            if edge is None or math.dist(edge.xyz, position.xyz) > _MOST_REACHES * hit.reach_m:
                return None
            return PickedPosition(edge.xyz, PointReference(drive.id, edge.point)), SnapMode.EDGE
        else:
            return None
        easting, northing, height = drive.xyz(np.array([found]))[0].tolist()
        return PickedPosition((easting, northing, height), PointReference(drive.id, found)), mode


def _outline(feature: Feature) -> tuple[Vertex, ...]:
    """The vertices of a feature; those of an area lead back to the first."""
    if feature.geometry is Geometry.AREA:
        return (*feature.vertices, feature.vertices[0])
    return feature.vertices
