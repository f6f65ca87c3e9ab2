"""PlaneMouse: what mouse and keys do in a plane view."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QCursor, QKeyEvent, QMouseEvent, QWheelEvent

from widgets.mouse_tools.gesture import Gesture, HitSource
from widgets.plane_view.navigation import ZOOM_PER_NOTCH, Navigation, notches_of
from widgets.plane_view.viewport import PlaneViewport
from widgets.shared.shared_state import SharedState

_LEAST_POINT_PX, _MOST_POINT_PX = 1.0, 12.0


class NavigableView(Protocol):
    """The view that the hand moves."""

    @property
    def viewport(self) -> PlaneViewport:
        """What is shown."""

    def set_viewport(self, viewport: PlaneViewport) -> None:
        """Show another part."""

    def move_along(self, notches: float) -> None:
        """The wheel with Shift."""

    def show_everything(self) -> None:
        """Home."""

    def center_on_selection(self) -> None:
        """F."""

    def setCursor(self, shape: QCursor | Qt.CursorShape | QCursor, /) -> None:  # noqa: N802
        """Give the mouse a shape."""

    def update(self) -> None:
        """Paint again."""


class PlaneMouse:
    """Passes the left button to the tool; moves the view by everything else.

    Parameters
    ----------
    view : NavigableView
    hits : HitSource
        What is in the picture.
    shared : SharedState

    Attributes
    ----------
    gesture : Gesture
    is_clicking : bool
        Whether a click is being told to the tool just now.
    """

    def __init__(self, view: NavigableView, hits: HitSource, shared: SharedState) -> None:
        self._view = view
        self._shared = shared
        self._navigation = Navigation()
        self.gesture = Gesture(hits, shared.cursor)
        self.is_clicking = False

    def pans_with(self, button: Qt.MouseButton) -> bool:
        """Whether a press of this button would begin to push the picture."""
        return self._navigation.starts_with(button)

    def press(self, event: QMouseEvent) -> bool:
        """A button went down; says whether a menu is wanted."""
        if self._navigation.starts_with(event.button()):
            self._navigation.begin(event.position())
            self.show_mouse()
        elif event.button() == Qt.MouseButton.LeftButton:
            self._click(self.gesture.press, event)
        elif event.button() == Qt.MouseButton.RightButton:
            if not self.gesture.is_busy:
                return True
            self.gesture.complete()
        return False

    def move(self, event: QMouseEvent) -> None:
        """The mouse moved."""
        position = event.position()
        if self._navigation.is_panning:
            self._view.set_viewport(self._navigation.dragged(self._view.viewport, position))
            return
        had_outline = self.gesture.outline is not None
        hit = self.gesture.move(position, event.modifiers())
        if hit is not None:
            self._shared.cursor.hover_over(hit.position)
        if had_outline or self.gesture.outline is not None:
            self._view.update()

    def release(self, event: QMouseEvent) -> None:
        """A button went up."""
        if self._navigation.is_panning:
            self._navigation.end()
            self.show_mouse()
        elif event.button() == Qt.MouseButton.LeftButton:
            self._click(self.gesture.release, event)
            self._view.update()

    def turn_wheel(self, event: QWheelEvent) -> None:
        """Zoomed at the mouse; with Shift along, with Ctrl the size of points."""
        notches, position = notches_of(event), event.position()
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            settings = self._shared.view_settings
            size_px = settings.look.point_size_px + 0.5 * notches
            settings.change_look(point_size_px=min(max(size_px, _LEAST_POINT_PX), _MOST_POINT_PX))
        elif event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            self._view.move_along(notches)
        else:
            factor = ZOOM_PER_NOTCH**notches
            self._view.set_viewport(self._view.viewport.zoomed(factor, position.x(), position.y()))

    def press_key(self, event: QKeyEvent) -> bool:
        """A key went down; says whether it means anything here."""
        key = event.key()
        moved = self._navigation.keyed(self._view.viewport, key)
        if moved is not None:
            self._view.set_viewport(moved)
        elif key == Qt.Key.Key_Space:
            self._hold_space(is_down=True)
        elif key == Qt.Key.Key_Home:
            self._view.show_everything()
        elif key == Qt.Key.Key_F:
            self._view.center_on_selection()
        elif self.gesture.key(key):
            self._view.update()
        else:
            return False
        return True

    def release_key(self, event: QKeyEvent) -> bool:
        """A key went up; says whether it means anything here."""
        if event.key() != Qt.Key.Key_Space or event.isAutoRepeat():
            return False
        self._hold_space(is_down=False)
        return True

    def show_mouse(self) -> None:
        """Give the mouse the shape for what it does."""
        self._view.setCursor(self._navigation.mouse_shape(self._shared.snap.modes))

    def _hold_space(self, *, is_down: bool) -> None:
        self._navigation.is_space_down = is_down
        self.show_mouse()

    def _click(
        self, tell: Callable[[QPointF, Qt.KeyboardModifier], None], event: QMouseEvent
    ) -> None:
        self.is_clicking = True
        try:
            tell(event.position(), event.modifiers())
        finally:
            self.is_clicking = False
