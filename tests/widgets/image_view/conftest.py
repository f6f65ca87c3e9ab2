"""The image view on a shown window, sharp, with a map behind it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from PySide6.QtCore import QPoint
from pytestqt.qtbot import QtBot

from processing.image.attributes.tile_cache import TileCache
from processing.image.images_of_drives import image_of
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.widgets.builders import OpenMap, position_on
from tests.widgets.view_user import ViewUser
from widgets.image_view.view import ImageView


@dataclass
class ImageViewUser(ViewUser):
    """A view and the hand at its mouse and keyboard."""

    view: ImageView
    drive: Drive

    def spot(self, point: int) -> QPoint:
        """Where the middle of a point's pixel is."""
        position = self.view.position_of(position_on(self.drive, point))
        assert position is not None
        return QPoint(int(np.floor(position.x())), int(np.floor(position.y())))

    def points_across(self, count: int, row_step: int = 6) -> list[int]:
        """Points in the middle columns of rows some way apart, far enough to be told apart."""
        image = image_of(self.drive, ImageKind.TRAJECTORY_CENTER)
        rows = image.rows // 4 + row_step * np.arange(count)
        columns = image.width // 2 + 12 * np.arange(count)
        return [
            image.nearest_filled(int(row), int(column), 5)
            for row, column in zip(rows, columns, strict=True)
        ]


@pytest.fixture
def open_map(left_drive: Drive, right_drive: Drive) -> OpenMap:
    return OpenMap((left_drive, right_drive))


@pytest.fixture
def user(qtbot: QtBot, open_map: OpenMap, tiles: TileCache, left_drive: Drive) -> ImageViewUser:
    """Give a view of the left drive with pixels large enough to be aimed at."""
    settings = open_map.shared.view_settings
    settings.show_image(left_drive.id, ImageKind.TRAJECTORY_CENTER)
    view = ImageView(open_map, open_map.shared, tiles)
    qtbot.addWidget(view)
    view.resize(900, 700)
    with qtbot.waitSignal(view.sharpened, timeout=30_000):
        view.show()
    view.show_everything()
    user = ImageViewUser(qtbot, open_map, view, left_drive)
    user.view.zoom_by(4.0 / view.viewport.zoom_v)
    view.center_on(position_on(left_drive, user.points_across(3)[1]))
    return user
