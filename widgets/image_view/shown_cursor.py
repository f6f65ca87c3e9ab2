"""ShownCursor: where the shared cursor is in the picture, and where it was before."""

from __future__ import annotations

import numpy as np

from processing.image.search.nearest import nearest_point
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.shared.cursor import PickedPosition

PicturePoint = tuple[float, float]

NEAR_M = 1.0
"""How far the cursor may be from the point of the drive that stands for it."""


class ShownCursor:
    """Finds places in the picture; remembers the last two of the cursor."""

    def __init__(self) -> None:
        self.spot: PicturePoint | None = None
        self.before: PicturePoint | None = None

    def move_to(
        self, picture: OrientedImage | None, position: PickedPosition | None
    ) -> PicturePoint | None:
        """Where the cursor is now, picture coordinates; None when it isn't in the picture."""
        spot = None if picture is None or position is None else self.find(picture, position)
        self.before, self.spot = self.spot, spot
        return spot

    def forget_trail(self) -> None:
        """Another picture is shown; where the cursor was in the one before means nothing."""
        self.before = None

    @staticmethod
    def find(picture: OrientedImage, position: PickedPosition) -> PicturePoint | None:
        """Picture coordinates of a place; None when no point of the drive is near."""
        measured, drive = position.measured, picture.drive
        if measured is not None and measured.drive == drive.id:
            point = measured.point if 0 <= measured.point < drive.count else -1
        else:
            point = nearest_point(drive, np.array(position.xyz), NEAR_M)
        if point < 0:
            return None
        rows, columns = picture.image.pixel_of(np.array([point]))
        if rows[0] < 0:
            return None
        u, v = picture.positions(rows, columns.astype(np.int64))[0].tolist()
        return u, v
