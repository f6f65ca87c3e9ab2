"""Navigation: how wheel, drag and keys move a picture under the window, the same in every view."""

from __future__ import annotations

from typing import Protocol, Self, TypeVar

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QCursor, QWheelEvent

from widgets.mouse_tools.gesture import REACH_PX
from widgets.shared.mouse_shape import drawing_cursor
from widgets.shared.snap_state import SnapMode

ZOOM_PER_NOTCH = 1.25

_NOTCH = 120.0
_KEY_SHARE = 0.1  # of the window's size

_ARROWS = {
    Qt.Key.Key_Left: (1, 0),
    Qt.Key.Key_Right: (-1, 0),
    Qt.Key.Key_Up: (0, 1),
    Qt.Key.Key_Down: (0, -1),
}
_ZOOMS = {
    Qt.Key.Key_Plus: ZOOM_PER_NOTCH,
    Qt.Key.Key_Equal: ZOOM_PER_NOTCH,
    Qt.Key.Key_Minus: 1 / ZOOM_PER_NOTCH,
}


class Movable(Protocol):
    """What is shown of a picture, and how large; every change gives a new one."""

    @property
    def width(self) -> float:
        """Of the window, screen pixels."""

    @property
    def height(self) -> float:
        """Of the window, screen pixels."""

    @property
    def middle(self) -> tuple[float, float]:
        """The middle of the window, widget pixels."""

    def panned(self, right_px: float, down_px: float, /) -> Self:
        """The picture pushed by so many screen pixels."""

    def zoomed(self, factor: float, x: float, y: float, /) -> Self:
        """Larger or smaller; what is at the position stays there."""


ViewportT = TypeVar("ViewportT", bound=Movable)


def notches_of(event: QWheelEvent) -> float:
    """How far the wheel was turned, forwards positive."""
    angle = event.angleDelta()
    # Some systems turn a wheel with Shift into a sideways one.
    return (angle.y() or angle.x()) / _NOTCH


class Navigation:
    """Remembers a drag that pushes the picture; everything else is a function of the event."""

    def __init__(self) -> None:
        self._from: QPointF | None = None
        self.is_space_down = False

    @property
    def is_panning(self) -> bool:
        """Whether a drag is pushing the picture."""
        return self._from is not None

    def mouse_shape(self, modes: frozenset[SnapMode]) -> QCursor:
        """What the mouse looks like over a picture while clicks snap to these."""
        if self.is_panning:
            return QCursor(Qt.CursorShape.ClosedHandCursor)
        if self.is_space_down:
            return QCursor(Qt.CursorShape.OpenHandCursor)
        return drawing_cursor(modes, REACH_PX)

    def starts_with(self, button: Qt.MouseButton) -> bool:
        """Whether a press of this button begins to push."""
        is_space_drag = button == Qt.MouseButton.LeftButton and self.is_space_down
        return button == Qt.MouseButton.MiddleButton or is_space_drag

    def begin(self, position: QPointF) -> None:
        """Take hold of the picture."""
        self._from = position

    def dragged(self, viewport: ViewportT, position: QPointF) -> ViewportT:
        """The picture pushed to where the mouse is."""
        if self._from is None:
            return viewport
        moved = position - self._from
        self._from = position
        return viewport.panned(moved.x(), moved.y())

    def end(self) -> None:
        """Let go."""
        self._from = None

    @staticmethod
    def keyed(viewport: ViewportT, key: int) -> ViewportT | None:
        """Moved or zoomed by a key; None for keys that do neither."""
        for arrow, (right, down) in _ARROWS.items():
            if key == arrow:
                share_px = _KEY_SHARE * viewport.width, _KEY_SHARE * viewport.height
                return viewport.panned(right * share_px[0], down * share_px[1])
        for zoom, factor in _ZOOMS.items():
            if key == zoom:
                return viewport.zoomed(factor, *viewport.middle)
        return None
