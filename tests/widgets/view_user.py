"""The hand at a view's mouse and keyboard."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from tests.mouse_events import NO_KEYS, move_mouse, turn_wheel
from tests.widgets.builders import OpenMap
from widgets.mouse_tools.mouse_tool import MouseTool

LEFT = Qt.MouseButton.LeftButton


@dataclass
class ViewUser:
    """A view with a map behind it."""

    qtbot: QtBot
    map: OpenMap
    view: Any  # the user of each view says which

    @property
    def picture(self) -> QWidget:
        """The widget that gets the mouse."""
        picture: QWidget = self.view
        return picture

    def take(self, tool: MouseTool) -> MouseTool:
        self.map.listen_to(tool)
        self.view.set_mouse_tool(tool)
        return tool

    def click(self, spot: QPoint, keys: Qt.KeyboardModifier = NO_KEYS, button=LEFT) -> None:
        self.qtbot.mouseClick(self.picture, button, keys, spot)

    def move(self, spot: QPoint, buttons: Qt.MouseButton = Qt.MouseButton.NoButton) -> None:
        move_mouse(self.picture, spot, buttons)

    def drag(
        self, start: QPoint, end: QPoint, keys: Qt.KeyboardModifier = NO_KEYS, button=LEFT
    ) -> None:
        self.qtbot.mousePress(self.picture, button, keys, start)
        self.move((start + end) / 2, button)
        self.move(end, button)
        self.qtbot.mouseRelease(self.picture, button, keys, end)

    def wheel(self, spot: QPoint, notches: int, keys: Qt.KeyboardModifier = NO_KEYS) -> None:
        turn_wheel(self.picture, spot, notches, keys)

    def key(self, key: Qt.Key, keys: Qt.KeyboardModifier = NO_KEYS) -> None:
        self.qtbot.keyClick(self.picture, key, keys)
