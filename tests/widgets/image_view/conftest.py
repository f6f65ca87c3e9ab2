"""The image view on a shown window, sharp, with a map behind it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from processing.image.attributes.tile_cache import TileCache
from processing.image.images_of_drives import image_of
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.mouse_events import NO_KEYS, move_mouse, turn_wheel
from tests.widgets.builders import OpenMap, position_on
from widgets.image_view.view import ImageView
from widgets.mouse_tools.mouse_tool import MouseTool

LEFT = Qt.MouseButton.LeftButton


@dataclass
class ImageViewUser:
    """A view and the hand at its mouse and keyboard."""

    qtbot: QtBot
    map: OpenMap
    view: ImageView
    drive: Drive

    def spot(self, point: int) -> QPoint:
        """Where the middle of a point's pixel is."""
        position = self.view.position_of(position_on(self.drive, point))
        assert position is not None
        return QPoint(int(np.floor(position.x())), int(np.floor(position.y())))

    def take(self, tool: MouseTool) -> MouseTool:
        self.map.listen_to(tool)
        self.view.set_mouse_tool(tool)
        return tool

    def click(self, spot: QPoint, keys: Qt.KeyboardModifier = NO_KEYS) -> None:
        self.qtbot.mouseClick(self.view, LEFT, keys, spot)

    def move(self, spot: QPoint, buttons: Qt.MouseButton = Qt.MouseButton.NoButton) -> None:
        move_mouse(self.view, spot, buttons)

    def drag(
        self, start: QPoint, end: QPoint, keys: Qt.KeyboardModifier = NO_KEYS, button=LEFT
    ) -> None:
        self.qtbot.mousePress(self.view, button, keys, start)
        self.move((start + end) / 2, button)
        self.move(end, button)
        self.qtbot.mouseRelease(self.view, button, keys, end)

    def wheel(self, spot: QPoint, notches: int, keys: Qt.KeyboardModifier = NO_KEYS) -> None:
        turn_wheel(self.view, spot, notches, keys)

    def key(self, key: Qt.Key) -> None:
        self.qtbot.keyClick(self.view, key)

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
def tiles(open_map: OpenMap) -> Iterator[TileCache]:
    cache = TileCache()
    cache.use(open_map.drive)
    yield cache
    cache.close()


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
