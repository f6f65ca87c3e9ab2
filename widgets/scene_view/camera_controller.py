"""CameraController: how drags, wheel and keys move the camera."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, Qt

from processing.core.arrays import Floats
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.rendering.projection import SceneProjection

ZOOM_PER_NOTCH = 1.25
_DEGREES_PER_PX = 0.3
_ALONG_PER_NOTCH = 0.15  # of the distance to what is looked at


@dataclass(frozen=True)
class _Drag:
    """A movement under way.

    Attributes
    ----------
    turns : bool
        About the pivot; else the picture is pushed.
    pivot : (3,) float64
        What was under the mouse.
    """

    turns: bool
    pivot: Floats
    position: QPointF


class CameraController:
    """Remembers a drag that moves the camera; everything else is a function of the event."""

    def __init__(self) -> None:
        self._drag: _Drag | None = None
        self.is_space_down = False

    @property
    def is_dragging(self) -> bool:
        """Whether a drag is moving the camera."""
        return self._drag is not None

    def pushes(self, button: Qt.MouseButton) -> bool:
        """Whether a drag with this button pushes the picture."""
        is_space_drag = button == Qt.MouseButton.LeftButton and self.is_space_down
        return button == Qt.MouseButton.MiddleButton or is_space_drag

    def begin(self, position: QPointF, pivot: Floats, *, turns: bool) -> None:
        """Take hold of the place under the mouse, metres from the view's origin."""
        self._drag = _Drag(turns, pivot, position)

    def dragged(self, projection: SceneProjection, position: QPointF) -> SceneCamera:
        """The camera after the mouse moved here."""
        drag, camera = self._drag, projection.camera
        if drag is None:
            return camera
        moved = position - drag.position
        self._drag = _Drag(drag.turns, drag.pivot, position)
        if drag.turns:
            return _turned(camera, drag.pivot, moved)
        depth_m = float(projection.in_view(drag.pivot[None])[0, 2])
        metres = projection.metres_per_px(max(depth_m, camera.distance_m * 0.05))
        return camera.panned(-moved.x() * metres, moved.y() * metres)

    def end(self) -> None:
        """Let go."""
        self._drag = None


def _turned(camera: SceneCamera, pivot: Floats, moved: QPointF) -> SceneCamera:
    """The camera turned about a place; who looks down on it is not led below it."""
    right_deg, up_deg = moved.x() * _DEGREES_PER_PX, -moved.y() * _DEGREES_PER_PX
    turned = camera.orbited(pivot, right_deg, up_deg)
    if camera.position[2] >= pivot[2] > turned.position[2]:
        return camera.orbited(pivot, right_deg, 0.0)
    return turned


def zoom_camera(camera: SceneCamera, pivot: Floats, notches: float) -> SceneCamera:
    """Nearer to what is under the mouse by turns of the wheel."""
    return camera.zoomed(pivot, ZOOM_PER_NOTCH**notches)


def move_along_path(camera: SceneCamera, notches: float, course_deg: float) -> SceneCamera:
    """Moved along the drive by turns of the wheel.

    Parameters
    ----------
    course_deg : float
        Of the drive here, clockwise from grid north; either way, as the camera decides.
    """
    course = math.radians(course_deg)
    vehicle_path = np.array([math.sin(course), math.cos(course), 0.0])
    right, up, forward = camera.axes
    # Looking down, "forward" is up in the picture.
    ahead = forward + up
    vehicle_path = -vehicle_path if vehicle_path @ ahead < 0 else vehicle_path
    step = vehicle_path * notches * _ALONG_PER_NOTCH * camera.distance_m
    return camera.panned(float(right @ step), float(up @ step)).advanced(float(forward @ step))


def move_by_key(projection: SceneProjection, key: int) -> SceneCamera | None:
    """The camera moved by an arrow or zoomed by plus and minus; None for other keys."""
    camera = projection.camera
    step = 0.1 * projection.metres_per_px(camera.distance_m) * projection.height_px
    moves = {
        Qt.Key.Key_Left: (-step, 0.0),
        Qt.Key.Key_Right: (step, 0.0),
        Qt.Key.Key_Up: (0.0, step),
        Qt.Key.Key_Down: (0.0, -step),
    }
    for arrow, move in moves.items():
        if key == arrow:
            return camera.panned(*move)
    if key in (Qt.Key.Key_Plus, Qt.Key.Key_Equal):
        return camera.zoomed(camera.focal_point, ZOOM_PER_NOTCH)
    if key == Qt.Key.Key_Minus:
        return camera.zoomed(camera.focal_point, 1 / ZOOM_PER_NOTCH)
    return None
