"""MouseToolbox: which mouse tool is in the hand, and which kind of feature it draws."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from PySide6.QtCore import QObject, Signal

from processing.project.catalogue import FeatureKind, Geometry
from widgets.mouse_tools.drawing_tool import DrawingTool
from widgets.mouse_tools.mouse_tool import MouseTool

POINTER = "select"

_TOOL_OF_GEOMETRY = {Geometry.POINT: "point", Geometry.LINE: "line", Geometry.AREA: "area"}


class ToolUser(Protocol):
    """A view that passes its hits to a mouse tool."""

    def set_mouse_tool(self, tool: MouseTool | None) -> None:
        """Use a tool from now on."""


class MouseToolbox(QObject):
    """The tools by name; one of them is in the hand, the same in all views.

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
    told = Signal(object)

    def __init__(
        self,
        tools: Mapping[str, MouseTool],
        views: tuple[ToolUser, ...],
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._tools = dict(tools)
        self._views = views
        self._name = POINTER
        self._kind: FeatureKind | None = None
        for tool in self._tools.values():
            tool.change_requested.connect(self.change_requested)
            tool.told.connect(self.told)
            tool.finished.connect(self._on_tool_finished)
        self._hand_out()

    @property
    def name(self) -> str:
        """The tool in the hand."""
        return self._name

    @property
    def kind(self) -> FeatureKind | None:
        """The kind that is drawn; None before one was chosen."""
        return self._kind

    def use_views(self, views: tuple[ToolUser, ...]) -> None:
        """Serve these views from now on; what is being drawn goes on in them."""
        for view in self._views:
            view.set_mouse_tool(None)
        self._views = views
        self._hand_out()

    def choose(self, name: str) -> None:
        """Take a tool; what the one before was drawing is dropped."""
        if name == self._name:
            return
        self._tools[self._name].put_down()
        self._name = name
        self._hand_out()
        self.tool_chosen.emit(name)

    def choose_kind(self, kind: FeatureKind) -> None:
        """Draw features of this kind from now on, with the tool for their shape."""
        if kind != self._kind:
            self._kind = kind
            for tool in self._tools.values():
                if isinstance(tool, DrawingTool) and tool.geometry is kind.geometry:
                    tool.set_kind(kind.id)
            self.kind_chosen.emit(kind)
        self.choose(_TOOL_OF_GEOMETRY[kind.geometry])

    def complete(self) -> None:
        """End the gesture of the tool in the hand and keep what it made."""
        self._tools[self._name].complete()

    def _hand_out(self) -> None:
        for view in self._views:
            view.set_mouse_tool(self._tools[self._name])

    def _on_tool_finished(self) -> None:
        self.choose(POINTER)
