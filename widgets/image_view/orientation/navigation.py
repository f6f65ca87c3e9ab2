"""What is shown of an image when it comes, and when the wheel is turned."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QWheelEvent

from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.image_view.orientation.viewport import Viewport
from widgets.plane_view.navigation import ZOOM_PER_NOTCH, notches_of

_ALONG_PER_NOTCH = 0.12  # of the window's size along the street


def viewport_on(
    picture: OrientedImage, before: OrientedImage | None, viewport: Viewport
) -> Viewport:
    """What is shown when a picture comes.

    The same points of the same drive; of another drive what it measured at the same time, as
    large as before: the other scanner of the same street; otherwise its beginning.
    """
    width, height = picture.size
    shown = viewport.showing((width, height), picture.stretch)
    if before is None:
        return beginning(picture, shown)
    if before.drive.id != picture.drive.id:
        row = _row_at_the_same_time(picture, before, viewport)
        share = viewport.centre[1] / max(before.size[1], 1)
        if row < 0:
            return beginning(picture, shown)
        return shown.centred_on(row + 0.5, share * height)
    if before.image.kind is picture.image.kind:
        return shown
    row, _ = before.pixel_at(*viewport.centre)
    row = min(max(row, 0), max(before.image.rows - 1, 0))
    first = min(int(before.image.row_starts[row]), max(picture.image.drive_count - 1, 0))
    rows, columns = picture.image.pixel_of(np.array([first]))
    position = picture.positions(np.maximum(rows, 0), columns.astype(np.int64))[0]
    if picture.rows_go_right:
        return shown.centred_on(float(position[0]), height / 2)
    return shown.centred_on(width / 2, float(position[1]))


def beginning(picture: OrientedImage | None, viewport: Viewport) -> Viewport:
    """What is shown at first: where a street begins, all of a view from above or of a scan."""
    if picture is None or picture.follows_path:
        return viewport.with_start()
    return viewport.with_everything(picture.stretch)


def _row_at_the_same_time(picture: OrientedImage, before: OrientedImage, viewport: Viewport) -> int:
    """The row measured when that in the middle of the picture before was; −1 where none was."""
    if not (picture.follows_path and before.follows_path and picture.image.rows):
        return -1
    row = min(max(before.pixel_at(*viewport.centre)[0], 0), max(before.image.rows - 1, 0))
    moment, times = before.image.row_times[row], picture.image.row_times
    if not times[0] <= moment <= times[-1]:
        return -1
    return int(np.searchsorted(times, moment))


def zoom_by_wheel(viewport: Viewport, event: QWheelEvent) -> Viewport:
    """Zoomed at the mouse; with Shift moved along the drive."""
    notches = notches_of(event)
    if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
        return viewport.rolled(notches * _ALONG_PER_NOTCH)
    position = event.position()
    return viewport.zoomed(ZOOM_PER_NOTCH**notches, position.x(), position.y())
