"""MouseToolbox: which mouse tool is in the hand, and which kind of feature it draws."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Protocol, TypeVar

from PySide6.QtCore import QObject, Signal

from processing.core.text import Text
from processing.map.catalogue import FeatureKind, Geometry
from processing.map.feature import Feature
from widgets.mouse_tools.drawing.draw_line import DrawLine
from widgets.mouse_tools.drawing.draw_parallel import DrawParallel
from widgets.mouse_tools.drawing.drawing_tool import DrawingTool
from widgets.mouse_tools.drawing.legs import LegMode
from widgets.mouse_tools.mouse_tool import MouseTool
from widgets.mouse_tools.snapping import SnappingTool
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

POINTER = "select"
_TOOL_OF_GEOMETRY = {Geometry.POINT: "point", Geometry.LINE: "line", Geometry.AREA: "area"}
_MODES = {mode.value: mode for mode in LegMode if mode is not LegMode.STRAIGHT}
_MOST_RECENT = 6

CHOOSE_A_LINE = Text("Choose one line first.", "先に線を1つ選択してください。")


AnyTool = TypeVar("AnyTool", bound=MouseTool)


class ToolUser(Protocol):
    """A view that passes its hits to a mouse tool."""

    def set_mouse_tool(self, tool: MouseTool | None) -> None:
        """Use a tool from now on."""


class MouseToolbox(QObject):
    """The tools by name; one of them is in the hand, the same in all views.

    ``arc``, ``spline`` and ``trace`` are ways of the line or the area at hand: a drawing goes on
    when they change.

    Parameters
    ----------
    tools : mapping of str to MouseTool
        With ``select``, ``point``, ``line`` and ``area`` among them.
    views : tuple of ToolUser

    Signals
    -------
    tool_chosen(name: str), kind_chosen(kind: FeatureKind)
        Another tool, another kind to draw.
    change_requested(label: Text, change: Change), told(text: Text)
        Passed on from the tools.
    """

    tool_chosen = Signal(str)
    kind_chosen = Signal(object)
    change_requested = Signal(object, object)
    reported = Signal(object)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        tools: Mapping[str, MouseTool],
        views: tuple[ToolUser, ...] = (),
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._shared = shared
        self._tools = dict(tools)
        self._views = views
        self._name = POINTER
        self._kind: FeatureKind | None = None
        self._kinds: dict[Geometry, FeatureKind] = {}
        self._recent: list[str] = []
        self.current_tool = SnappingTool(source, shared, self._tools[POINTER], self)
        for tool in self._tools.values():
            tool.change_requested.connect(self.change_requested)
            tool.reported.connect(self.reported)
            tool.finished.connect(self._on_tool_finished)
            if isinstance(tool, DrawParallel):
                tool.kind_taken.connect(self._on_parallel_kind_taken)
        self._hand_out()

    @property
    def name(self) -> str:
        """The tool in the hand, or the way in which it draws."""
        return self._name

    @property
    def tool(self) -> MouseTool:
        """The tool in the hand."""
        return self.current_tool.tool

    def tools_of(self, kind_of_tool: type[AnyTool]) -> tuple[AnyTool, ...]:
        """The tools of a class, to listen to what only they tell."""
        return tuple(one for one in self._tools.values() if isinstance(one, kind_of_tool))

    @property
    def kind(self) -> FeatureKind | None:
        """The kind that is drawn; None before one was chosen."""
        return self._kind

    @property
    def recent_kinds(self) -> tuple[FeatureKind, ...]:
        """Kinds drawn last that the catalogue has, newest first."""
        catalogue = self._source.catalogue()
        return tuple(catalogue[id_] for id_ in self._recent if id_ in catalogue)

    def use_views(self, views: tuple[ToolUser, ...]) -> None:
        """Hand the tool to other views from now on."""
        self._views = views
        self._hand_out()

    def choose(self, name: str) -> None:
        """Take a tool; what the one before had drawn is kept where it is whole."""
        if name == self._name:
            return
        tool = self._tool_of(name)
        if tool is not self.current_tool.tool:
            self.current_tool.tool.settle()
            self.current_tool.tool = tool
        self._name = name
        if isinstance(tool, DrawLine):
            tool.set_mode(_MODES.get(name, LegMode.STRAIGHT))
        if isinstance(tool, DrawingTool):
            self._give_kind(tool)
        self._hand_out()
        self.tool_chosen.emit(name)

    def choose_kind(self, kind: FeatureKind) -> None:
        """Draw features of this kind from now on, with a tool that can."""
        tool = self.current_tool.tool
        if isinstance(tool, DrawParallel) and tool.makes(kind):
            self._take_kind(kind)
            tool.set_kind(kind)
            return
        can_draw = isinstance(tool, DrawingTool) and kind.geometry in tool.draws
        if not can_draw:
            tool.settle()
        self._take_kind(kind)
        if isinstance(tool, DrawingTool) and can_draw:
            tool.set_kind(kind)
        else:
            self.choose(_TOOL_OF_GEOMETRY[kind.geometry])

    def cycle_kind(self) -> None:
        """Draw the kind again that was drawn longest ago among the last ones."""
        recent = self.recent_kinds
        if len(recent) > 1:
            self.choose_kind(recent[-1])

    def forget_kinds(self) -> None:
        """Another catalogue counts from now on."""
        self.current_tool.tool.put_down()
        self._kind = None
        self._kinds.clear()
        self.choose(POINTER)

    def complete(self) -> None:
        """End the gesture of the tool in the hand and keep what it made."""
        self.current_tool.complete()

    def put_away(self) -> None:
        """The project is closed: what is whole is kept, the rest is forgotten."""
        self.current_tool.tool.settle()
        for tool in self._tools.values():
            tool.forget()

    def take_back(self) -> None:
        """The change that was asked for was refused: what was drawn is at hand again."""
        self.current_tool.tool.take_back()

    def step_back(self) -> bool:
        """Take the last click back; says whether a gesture was under way."""
        if not self.current_tool.is_busy:
            return False
        self.current_tool.step_back()
        return True

    def continue_line(self, chosen: Sequence[Feature]) -> None:
        """Go on drawing the chosen line at its end nearest to the cursor, or at its last one."""
        lines = [one for one in chosen if one.geometry is Geometry.LINE]
        tool = self._tools["line"]
        if len(lines) != 1 or not isinstance(tool, DrawLine):
            self.reported.emit(CHOOSE_A_LINE)
            return
        (line,) = lines
        if line.kind in self._source.catalogue():
            self.choose_kind(self._source.catalogue()[line.kind])
        if not isinstance(self.current_tool.tool, DrawLine):
            self.choose("line")
        position = self._shared.cursor.position
        start, end = line.vertices[0].xyz, line.vertices[-1].xyz
        at_start = position is not None and math.dist(position.xyz, start) < math.dist(
            position.xyz, end
        )
        tool.continue_line(line, at_start=at_start)

    def close_drawing(self) -> None:
        """Lead the drawing at hand back to its start and complete it."""
        tool = self.current_tool.tool
        if isinstance(tool, DrawLine):
            tool.close()

    def _tool_of(self, name: str) -> MouseTool:
        if name not in _MODES:
            return self._tools[name]
        if isinstance(self.current_tool.tool, DrawLine):
            return self.current_tool.tool
        is_area = self._kind is not None and self._kind.geometry is Geometry.AREA
        return self._tools["area" if is_area else "line"]

    def _give_kind(self, tool: DrawingTool) -> None:
        """Let a tool draw the kind at hand, or the last one of a shape that it can draw."""
        kind = self._kind
        if kind is None or kind.geometry not in tool.draws:
            usual = (one for one in self._source.catalogue() if one.geometry in tool.draws)
            known = (self._kinds[one] for one in Geometry if one in tool.draws & set(self._kinds))
            kind = next(known, None) or next(usual, None)
        if kind is not None:
            self._take_kind(kind)
            tool.set_kind(kind)

    def _take_kind(self, kind: FeatureKind) -> None:
        if kind == self._kind:
            return
        self._kind = self._kinds[kind.geometry] = kind
        self._recent = [kind.id, *(one for one in self._recent if one != kind.id)][:_MOST_RECENT]
        self.kind_chosen.emit(kind)

    def _hand_out(self) -> None:
        for view in self._views:
            view.set_mouse_tool(self.current_tool)

    def _on_parallel_kind_taken(self, kind: str) -> None:
        if kind in self._source.catalogue():
            self._take_kind(self._source.catalogue()[kind])

    def _on_tool_finished(self) -> None:
        self.choose(POINTER)
