"""DrawTemplate: the wanted profile, and where nothing should be, drawn in the section."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np
from PySide6.QtCore import QObject, Qt, Signal
from typing_extensions import override

from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.feature import Position, Vertex
from processing.methods.templates.profile_template import TemplateProfile
from processing.section.cut import Cut
from widgets.mouse_tools.mouse_tool import Hit, MouseTool
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Drawing, Note

NEEDS_SECTION = Text(
    "Open the section first: templates are drawn in it.",
    "先に断面ビューを開いてください。テンプレートは断面に描きます。",
)
NOT_IN_SECTION = Text(
    "Click in the section in which the template was begun.",
    "テンプレートを描き始めた断面の中をクリックしてください。",
)
TOO_SHORT = Text(
    "A template needs at least two vertices.", "テンプレートには少なくとも2つの頂点が必要です。"
)
TOO_SMALL = Text(
    "An empty zone needs at least three vertices.",
    "空白域には少なくとも3つの頂点が必要です。",
)
BEGIN = Text(
    "The line will be made at the first vertex; click on it again to draw its other side.",
    "最初の頂点の位置に線を作成します。もう一度クリックすると反対側を描けます。",
)

_SAME_M = 0.005
_DECIMALS = 3


class TemplatePart(Enum):
    """What is drawn."""

    SHAPE = "shape"
    EMPTY_ZONE = "empty-zone"


@dataclass(frozen=True)
class DrawnProfile:
    """What was drawn in a section.

    Attributes
    ----------
    part : TemplatePart
    cut : Cut
        The section.
    lines : tuple of tuple of Position
        Places in space, m, project CRS: polylines that begin at the anchor; or one ring.
    """

    part: TemplatePart
    cut: Cut
    lines: tuple[tuple[Position, ...], ...]

    @property
    def anchor(self) -> Position:
        """The place that was clicked first."""
        return self.lines[0][0]

    def about(self, position: Position) -> tuple[TemplateProfile, ...]:
        """Offsets to the right and heights about a place, to the millimetre."""
        origin = self.cut.to_section([position])[0, :2]
        return tuple(
            tuple(
                (round(offset, _DECIMALS) + 0.0, round(height, _DECIMALS) + 0.0)
                for offset, height in (self.cut.to_section(line)[:, :2] - origin).tolist()
            )
            for line in self.lines
        )


class DrawTemplate(MouseTool):
    """Clicks in the section add vertices; Enter or the right button ends the profile.

    A shape begins at its anchor. A click back on the anchor begins another stretch from there.
    Nothing snaps: in a section the points under the mouse are seen one by one.

    Parameters
    ----------
    shared : SharedState
    part : TemplatePart

    Signals
    -------
    drawn(profile: DrawnProfile)
        The profile is whole.
    """

    drawn = Signal(object)

    def __init__(
        self, shared: SharedState, part: TemplatePart, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._sketch = shared.sketch
        self._part = part
        self._cut: Cut | None = None
        self._begun_in: Cut | None = None
        self._lines: tuple[tuple[Vertex, ...], ...] = ()
        self._preview: Vertex | None = None

    @property
    def part(self) -> TemplatePart:
        """What it draws."""
        return self._part

    def use_cut(self, cut: Cut | None) -> None:
        """The section is here now; what was begun stays where it was begun."""
        self._cut = cut

    @property
    @override
    def is_busy(self) -> bool:
        return bool(self._lines)

    @property
    @override
    def last_vertex(self) -> Vertex | None:
        return self._lines[-1][-1] if self._lines else None

    @override
    def press(self, hit: Hit) -> None:
        cut = self._begun_in or self._cut
        if cut is None:
            self.reported.emit(NEEDS_SECTION)
            return
        vertex = self._vertex_of(hit, cut)
        if vertex is None:
            self.reported.emit(NOT_IN_SECTION)
            return
        if not self._lines:
            self._begun_in, self._lines = cut, ((vertex,),)
            if self._part is TemplatePart.SHAPE:
                self.reported.emit(BEGIN)
        elif self._returns(vertex, cut, hit.reach_m):
            self._lines += (self._lines[0][:1],)
        elif _apart(cut, vertex, self._lines[-1][-1]) > _SAME_M:
            self._lines = (*self._lines[:-1], (*self._lines[-1], vertex))
        self._preview = None
        self._show()

    @override
    def move(self, hit: Hit) -> None:
        if self._begun_in is not None:
            self._preview = self._vertex_of(hit, self._begun_in)
            self._show()

    @override
    def complete(self) -> None:
        cut, lines = self._begun_in, tuple(line for line in self._lines if len(line) > 1)
        if cut is None or not self._lines:
            return
        if self._part is TemplatePart.SHAPE and not lines:
            self.reported.emit(TOO_SHORT)
            return
        if self._part is TemplatePart.EMPTY_ZONE and len(self._lines[0]) < 3:
            self.reported.emit(TOO_SMALL)
            return
        positions = tuple(tuple(vertex.xyz for vertex in line) for line in lines)
        self.put_down()
        self.drawn.emit(DrawnProfile(self._part, cut, positions))

    @override
    def step_back(self) -> None:
        if not self._lines:
            return
        last = self._lines[-1][:-1]
        # The anchor of a second stretch isn't a click of its own beyond the one that began it.
        self._lines = (*self._lines[:-1], last) if last else self._lines[:-1]
        if not self._lines:
            self._begun_in = None
        self._show()

    @override
    def put_down(self) -> None:
        self._lines, self._begun_in, self._preview = (), None, None
        self._show()

    def _vertex_of(self, hit: Hit, cut: Cut) -> Vertex | None:
        """Where a click lands on the section's plane: beside a measured point, or free of them."""
        is_free = bool(hit.modifiers & Qt.KeyboardModifier.ControlModifier)
        on_plane = None if hit.ray is None else _meet_cut(cut, hit)
        if hit.position is not None and (on_plane is None or not (is_free or self._draws_zone)):
            section = cut.to_section([hit.position.xyz])
            if cut.holds(section)[0]:
                section[0, 2] = 0.0
                easting, northing, height = cut.to_space(section)[0].tolist()
                return Vertex((easting, northing, height), is_occluded=hit.position.is_occluded)
        elif on_plane is not None and cut.holds(cut.to_section([on_plane]))[0]:
            return Vertex(on_plane, is_occluded=True)
        return None

    @property
    def _draws_zone(self) -> bool:
        return self._part is TemplatePart.EMPTY_ZONE

    def _returns(self, vertex: Vertex, cut: Cut, reach_m: float) -> bool:
        """Whether a click means the anchor once more."""
        if self._draws_zone or len(self._lines[-1]) < 2:
            return False
        return _apart(cut, vertex, self._lines[0][0]) <= max(reach_m, _SAME_M)

    def _show(self) -> None:
        if not self._lines:
            self._sketch.show(None)
            return
        # One stroke: back to the anchor over what is drawn already, then along the next stretch.
        stroke = self._lines[0]
        for line in self._lines[1:]:
            stroke += (*stroke[-2::-1], *line[1:])
        preview = () if self._preview is None else (self._preview,)
        geometry = Geometry.AREA if self._draws_zone else Geometry.LINE
        notes = self._notes(preview)
        self._sketch.show(Drawing("", geometry, stroke, preview, notes=notes))

    def _notes(self, preview: tuple[Vertex, ...]) -> tuple[Note, ...]:
        """Offset and height of what is under the mouse about the anchor."""
        cut = self._begun_in
        if not preview or cut is None:
            return ()
        here, anchor = cut.to_section([preview[0].xyz, self._lines[0][0].xyz])
        across, up = (here - anchor)[:2].tolist()
        return (Note(preview[0].xyz, f"{across:+.3f} / {up:+.3f} m"),)


def _apart(cut: Cut, one: Vertex, other: Vertex) -> float:
    """Distance of two vertices in the picture of the section, m."""
    across, up, _ = (cut.to_section([one.xyz]) - cut.to_section([other.xyz]))[0].tolist()
    return math.hypot(across, up)


def _meet_cut(cut: Cut, hit: Hit) -> Position | None:
    """Where a line of sight goes through the plane of the section."""
    if hit.ray is None:
        return None
    origin, direction = np.array(hit.ray.origin), np.array(hit.ray.direction)
    towards = float(direction[:2] @ np.array(cut.normal))
    if abs(towards) < 1e-6:
        return None
    away = -float(cut.to_section([hit.ray.origin])[0, 2]) / towards
    easting, northing, height = (origin + away * direction).tolist()
    return easting, northing, height
