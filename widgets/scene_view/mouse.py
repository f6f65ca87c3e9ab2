"""SceneMouse: what mouse and keys do in the 3D picture."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QObject, QPointF, Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QWheelEvent
from typing_extensions import override

from widgets.mouse_tools.gesture import DRAG_PX, Gesture
from widgets.plane_view.navigation import notches_of
from widgets.scene_view.camera_controller import (
    CameraController,
    move_along_path,
    move_by_key,
    zoom_camera,
)
from widgets.scene_view.hits import SceneHits
from widgets.shared.shared_state import SharedState

_LOOK_UP_MS = 30
_LEAST_POINT_PX, _MOST_POINT_PX = 1.0, 12.0


class SceneMouse(QObject):
    """Filters the events of the picture: left acts, right turns, middle pushes, the wheel zooms.

    Parameters
    ----------
    hits : SceneHits
        What is in the picture.
    shared : SharedState
    course_deg : callable
        From a place (metres from the view's origin) to the direction of the drive there.

    Signals
    -------
    camera_moved(camera: Camera)
        The user moved the camera.
    acted()
        Something that is painted over the picture may be another.
    menu_requested(where: QPointF), everything_requested, selection_requested
        The context menu, Home, F.
    """

    camera_moved = Signal(object)
    acted = Signal()
    menu_requested = Signal(QPointF)
    everything_requested = Signal()
    selection_requested = Signal()

    def __init__(
        self,
        hits: SceneHits,
        shared: SharedState,
        course_deg: Callable[[NDArray[np.float64]], float],
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self.gesture = Gesture(hits, shared.cursor)
        self.is_enabled = False
        self._hits = hits
        self._shared = shared
        self._course_deg = course_deg
        self._camera_controller = CameraController()
        self._right_at: QPointF | None = None
        self._mouse: tuple[QPointF, Qt.KeyboardModifier] | None = None
        self._is_clicking = False
        self._look_up = QTimer(self, singleShot=True, interval=_LOOK_UP_MS)
        self._look_up.timeout.connect(self._on_look_up_timeout)

    @property
    def is_clicking(self) -> bool:
        """Whether a click is being told to the tool just now."""
        return self._is_clicking

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        kind = event.type()
        if isinstance(event, QKeyEvent):
            return self._on_key(event)
        if kind == QEvent.Type.Leave:
            self._look_up.stop()
            self._shared.cursor.hover_over(None)
        elif isinstance(event, QWheelEvent):
            self._on_wheel(event)
        elif isinstance(event, QMouseEvent):
            self._on_mouse(kind, event)
        else:
            return kind in (QEvent.Type.Enter, QEvent.Type.ContextMenu)
        event.accept()
        return True

    def _on_mouse(self, kind: QEvent.Type, event: QMouseEvent) -> None:
        if not self.is_enabled:
            return
        if kind == QEvent.Type.MouseButtonPress:
            self._on_press(event)
        elif kind == QEvent.Type.MouseMove:
            self._on_move(event)
        elif kind == QEvent.Type.MouseButtonRelease:
            self._on_release(event)
        elif kind == QEvent.Type.MouseButtonDblClick:
            if event.button() == Qt.MouseButton.LeftButton:
                self.gesture.complete()
            else:
                self._on_press(event)
        self.acted.emit()

    def _on_press(self, event: QMouseEvent) -> None:
        position = event.position()
        if self._camera_controller.pushes(event.button()):
            self._camera_controller.begin(
                position, self._hits.position_under(position), turns=False
            )
        elif event.button() == Qt.MouseButton.RightButton:
            self._right_at = position
        elif event.button() == Qt.MouseButton.LeftButton:
            self._click(self.gesture.press, event)

    def _on_move(self, event: QMouseEvent) -> None:
        position = event.position()
        if self._right_at is not None and not self._camera_controller.is_dragging:
            moved = position - self._right_at
            if max(abs(moved.x()), abs(moved.y())) >= DRAG_PX:
                pivot = self._hits.position_under(self._right_at)
                self._camera_controller.begin(self._right_at, pivot, turns=True)
        if self._camera_controller.is_dragging:
            self.camera_moved.emit(self._camera_controller.dragged(self._hits.projection, position))
        elif self._right_at is None:
            self._mouse = position, event.modifiers()
            if not self._look_up.isActive():
                self._look_up.start()

    def _on_release(self, event: QMouseEvent) -> None:
        right_at, self._right_at = self._right_at, None
        if self._camera_controller.is_dragging:
            self._camera_controller.end()
        elif event.button() == Qt.MouseButton.LeftButton:
            self._look_up.stop()
            self._click(self.gesture.release, event)
        elif event.button() == Qt.MouseButton.RightButton and right_at is not None:
            if self.gesture.is_busy:
                self.gesture.complete()
            else:
                self.menu_requested.emit(event.position())

    def _click(
        self, tell: Callable[[QPointF, Qt.KeyboardModifier], None], event: QMouseEvent
    ) -> None:
        self._is_clicking = True
        try:
            tell(event.position(), event.modifiers())
        finally:
            self._is_clicking = False

    def _on_wheel(self, event: QWheelEvent) -> None:
        if not self.is_enabled:
            return
        notches = notches_of(event)
        camera = self._hits.projection.camera
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            settings = self._shared.view_settings
            size_px = settings.look.point_size_px + 0.5 * notches
            settings.change_look(point_size_px=min(max(size_px, _LEAST_POINT_PX), _MOST_POINT_PX))
        elif event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            course = self._course_deg(camera.focal_point)
            self.camera_moved.emit(move_along_path(camera, notches, course))
        else:
            pivot = self._hits.position_under(event.position())
            self.camera_moved.emit(zoom_camera(camera, pivot, notches))

    def _on_key(self, event: QKeyEvent) -> bool:
        key, is_press = event.key(), event.type() == QEvent.Type.KeyPress
        if key == Qt.Key.Key_Space:
            if not event.isAutoRepeat():
                self._camera_controller.is_space_down = is_press
            return True
        if not is_press or not self.is_enabled:
            # What no one here takes goes on to the window.
            event.ignore()
            return event.type() != QEvent.Type.ShortcutOverride
        moved = move_by_key(self._hits.projection, key)
        if moved is not None:
            self.camera_moved.emit(moved)
        elif key == Qt.Key.Key_Home:
            self.everything_requested.emit()
        elif key == Qt.Key.Key_F:
            self.selection_requested.emit()
        elif not self.gesture.key(key):
            event.ignore()
            return True
        self.acted.emit()
        event.accept()
        return True

    def _on_look_up_timeout(self) -> None:
        if self._mouse is None or not self.is_enabled:
            return
        hit = self.gesture.move(*self._mouse)
        if hit is not None:
            self._shared.cursor.hover_over(hit.position)
        self.acted.emit()
