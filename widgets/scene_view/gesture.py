"""Gesture: from the left button and keys to what the tool in the hand is told."""

from __future__ import annotations

from typing import Protocol

from PySide6.QtCore import QPointF, QRectF, Qt

from widgets.mouse_tools.mouse_tool import Boxed, Hit, MouseTool
from widgets.shared.cursor import Cursor

DRAG_PX = 4.0
"""A press that moves less is a click."""


class HitSource(Protocol):
    """Tells what is in the picture."""

    def exact_hit(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> Hit:
        """What is under a pixel, among all measured points."""

    def quick_hit(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> Hit:
        """What is under a pixel, among the points that are drawn."""

    def boxed(self, box: QRectF, modifiers: Qt.KeyboardModifier) -> Boxed:
        """What a rectangle holds."""


class Gesture:
    """One press, drag and release of the left button, told to a tool in hits.

    Parameters
    ----------
    hits : HitSource
    cursor : Cursor
        Put by a click when there is no tool.
    """

    def __init__(self, hits: HitSource, cursor: Cursor) -> None:
        self._hits = hits
        self._cursor = cursor
        self._pressed_at: QPointF | None = None
        self._is_drag = False
        self._may_box = False
        self.tool: MouseTool | None = None
        self.box: QRectF | None = None

    def press(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> None:
        """The left button went down."""
        hit = self._hits.exact_hit(position, modifiers)
        self._pressed_at, self._is_drag = position, False
        if self.tool is not None:
            self.tool.press(hit)
            self._may_box = self.tool.takes_box(hit)
        elif hit.place is not None:
            self._cursor.move_to(hit.place)

    def move(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> Hit | None:
        """The mouse moved; gives what it is over, where that was looked up."""
        pressed = self._pressed_at
        if pressed is not None and not self._is_drag:
            moved = position - pressed
            self._is_drag = max(abs(moved.x()), abs(moved.y())) >= DRAG_PX
            if not self._is_drag:
                return None
        if pressed is not None and self._may_box:
            self.box = QRectF(pressed, position).normalized()
            return None
        hit = self._hits.quick_hit(position, modifiers)
        if self.tool is not None:
            self.tool.move(hit)
        return hit

    def release(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> None:
        """The left button went up."""
        if self._pressed_at is None:
            return
        self.move(position, modifiers)
        box, self.box = self.box, None
        self._pressed_at, self._may_box = None, False
        if self.tool is None:
            return
        if box is not None:
            self.tool.choose_box(self._hits.boxed(box, modifiers))
        else:
            self.tool.release(self._hits.exact_hit(position, modifiers))

    def complete(self) -> None:
        """Double click, right button or Enter; the press of a double click counts no more."""
        self.drop()
        if self.tool is not None:
            self.tool.complete()

    def drop(self) -> None:
        """Forget a press that is under way."""
        self._pressed_at, self._may_box, self.box = None, False, None

    def key(self, key: int) -> bool:
        """Pass a key to the tool; says whether it is one of its keys."""
        tool = self.tool
        if tool is None:
            return False
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            tool.complete()
        elif key == Qt.Key.Key_Backspace:
            tool.step_back()
        elif key == Qt.Key.Key_Escape:
            if self.box is None:
                tool.leave()
            self.drop()
        elif key == Qt.Key.Key_Delete:
            tool.delete()
        else:
            return False
        return True
