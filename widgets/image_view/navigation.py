"""Navigation: how wheel, drag and keys move the picture."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QCursor, QWheelEvent

from widgets.image_view.picture import Picture
from widgets.image_view.viewport import Viewport
from widgets.mouse_tools.gesture import REACH_PX
from widgets.shared.mouse_shape import drawing_cursor
from widgets.shared.snap_state import SnapMode

NOTCH = 120.0
ZOOM_PER_NOTCH = 1.25
_ALONG_PER_NOTCH = 0.12  # of the window's size along the street
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


def viewport_on(picture: Picture, before: Picture | None, viewport: Viewport) -> Viewport:
    """What is shown when a picture comes.

    The same points of the same drive; of another drive what it measured at the same time, as
    large as before: the other scanner of the same street; otherwise its beginning.
    """
    width, height = picture.size
    shown = viewport.showing((width, height), picture.stretch)
    if before is None:
        return shown.with_start()
    if before.drive.id != picture.drive.id:
        row = _row_at_the_same_time(picture, before, viewport)
        share = viewport.centre[1] / max(before.size[1], 1)
        return shown.with_start() if row < 0 else shown.centred_on(row + 0.5, share * height)
    row, _ = before.pixel_at(*viewport.centre)
    row = min(max(row, 0), max(before.image.rows - 1, 0))
    first = min(int(before.image.row_starts[row]), max(picture.image.drive_count - 1, 0))
    rows, columns = picture.image.pixel_of(np.array([first]))
    place = picture.places(np.maximum(rows, 0), columns.astype(np.int64))[0]
    if picture.rows_go_right:
        return shown.centred_on(float(place[0]), height / 2)
    return shown.centred_on(width / 2, float(place[1]))


def _row_at_the_same_time(picture: Picture, before: Picture, viewport: Viewport) -> int:
    """The row measured when that in the middle of the picture before was; −1 where none was."""
    if not (picture.rows_go_right and before.rows_go_right and picture.image.rows):
        return -1
    row = min(max(before.pixel_at(*viewport.centre)[0], 0), max(before.image.rows - 1, 0))
    moment, times = before.image.row_times[row], picture.image.row_times
    if not times[0] <= moment <= times[-1]:
        return -1
    return int(np.searchsorted(times, moment))


class Navigation:
    """Remembers a drag that pushes the picture; everything else is a function of the event."""

    def __init__(self) -> None:
        self._from: QPointF | None = None
        self.is_space_down = False

    def mouse_shape(self, modes: frozenset[SnapMode]) -> QCursor:
        """What the mouse looks like over a picture while clicks snap to these."""
        if self.is_space_down:
            return QCursor(Qt.CursorShape.OpenHandCursor)
        return drawing_cursor(modes, REACH_PX)

    @property
    def is_panning(self) -> bool:
        """Whether a drag is pushing the picture."""
        return self._from is not None

    def starts_with(self, button: Qt.MouseButton) -> bool:
        """Whether a press of this button begins to push."""
        is_space_drag = button == Qt.MouseButton.LeftButton and self.is_space_down
        return button == Qt.MouseButton.MiddleButton or is_space_drag

    def begin(self, position: QPointF) -> None:
        """Take hold of the picture."""
        self._from = position

    def dragged(self, viewport: Viewport, position: QPointF) -> Viewport:
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
    def wheeled(viewport: Viewport, event: QWheelEvent) -> Viewport:
        """Zoomed at the mouse; with Shift moved along the drive."""
        angle = event.angleDelta()
        # Some systems turn a wheel with Shift into a sideways one.
        notches = (angle.y() or angle.x()) / NOTCH
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            return viewport.rolled(notches * _ALONG_PER_NOTCH)
        position = event.position()
        return viewport.zoomed(ZOOM_PER_NOTCH**notches, position.x(), position.y())

    @staticmethod
    def keyed(viewport: Viewport, key: int) -> Viewport | None:
        """Moved or zoomed by a key; None for keys that do neither."""
        for arrow, (right, down) in _ARROWS.items():
            if key == arrow:
                share_px = _KEY_SHARE * viewport.width, _KEY_SHARE * viewport.height
                return viewport.panned(right * share_px[0], down * share_px[1])
        for zoom, factor in _ZOOMS.items():
            if key == zoom:
                return viewport.zoomed(factor, *viewport.middle)
        return None
