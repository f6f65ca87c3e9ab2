"""Gesture: from the left button and keys to what the tool in the hand is told, in any view."""

from __future__ import annotations

from typing import Protocol

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPolygonF

from widgets.mouse_tools.mouse_tool import DragShape, EnclosedHits, Hit, MouseTool
from widgets.shared.cursor import Cursor

DRAG_PX = 4.0
"""A press that moves less is a click."""

REACH_PX = 12.0
"""Radius of the circle about the mouse in which things are looked for."""


class HitSource(Protocol):
    """Tells what is in the picture."""

    def exact_hit(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> Hit:
        """What is under a pixel, among all measured points."""

    def quick_hit(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> Hit:
        """What is under a pixel, among the points that are drawn."""

    def enclosed(self, outline: QPolygonF, modifiers: Qt.KeyboardModifier) -> EnclosedHits:
        """What an outline in the window holds."""


class Gesture:
    """One press, drag and release of the left button, told to a tool in hits.

    Parameters
    ----------
    hits : HitSource
    cursor : Cursor
        Put by a click when there is no tool.

    Attributes
    ----------
    outline : QPolygonF or None
        The rectangle or the lasso that is being drawn, widget pixels.
    """

    def __init__(self, hits: HitSource, cursor: Cursor) -> None:
        self._hits = hits
        self._cursor = cursor
        self._pressed_at: QPointF | None = None
        self._is_drag = False
        self._shape = DragShape.NONE
        self.tool: MouseTool | None = None
        self.outline: QPolygonF | None = None

    @property
    def is_busy(self) -> bool:
        """Whether the right button would end something."""
        return self.tool is not None and self.tool.is_busy

    def press(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> None:
        """The left button went down."""
        hit = self._hits.exact_hit(position, modifiers)
        self._pressed_at, self._is_drag = position, False
        if self.tool is not None:
            self.tool.press(hit)
            self._shape = self.tool.drag_shape(hit)
        elif hit.position is not None:
            self._cursor.move_to(hit.position)

    def move(self, position: QPointF, modifiers: Qt.KeyboardModifier) -> Hit | None:
        """The mouse moved; gives what it is over, where that was looked up."""
        pressed = self._pressed_at
        if pressed is not None and not self._is_drag:
            moved = position - pressed
            self._is_drag = max(abs(moved.x()), abs(moved.y())) >= DRAG_PX
            if not self._is_drag:
                return None
        if pressed is not None and self._shape is not DragShape.NONE:
            self._draw_outline(pressed, position)
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
        outline, self.outline = self.outline, None
        self._pressed_at, self._shape = None, DragShape.NONE
        if self.tool is None:
            return
        if outline is not None:
            self.tool.choose_box(self._hits.enclosed(outline, modifiers))
        else:
            self.tool.release(self._hits.exact_hit(position, modifiers))

    def complete(self) -> None:
        """Double click, right button or Enter; the press of a double click counts no more."""
        self.drop()
        if self.tool is not None:
            self.tool.complete()

    def drop(self) -> None:
        """Forget a press that is under way."""
        self._pressed_at, self._shape, self.outline = None, DragShape.NONE, None

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
            if self.outline is None:
                tool.leave()
            self.drop()
        elif key == Qt.Key.Key_Delete:
            tool.delete()
        else:
            return False
        return True

    def _draw_outline(self, pressed: QPointF, position: QPointF) -> None:
        if self._shape is DragShape.BOX:
            self.outline = QPolygonF(QRectF(pressed, position).normalized())
        elif self.outline is None:
            self.outline = QPolygonF([pressed, position])
        else:
            self.outline.append(position)
