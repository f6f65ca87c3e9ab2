"""The 3D view on a shown window, sharp, with a map behind it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot
from typing_extensions import override

from processing.image.attributes.tile_cache import TileCache
from processing.recording.drive import Drive
from tests.widgets.builders import OpenMap
from tests.widgets.view_user import ViewUser
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.rendering.scene_picture import ScenePicture
from widgets.scene_view.view import SceneView
from widgets.shared.cursor import PickedPosition

RIGHT = Qt.MouseButton.RightButton


@dataclass
class SceneViewUser(ViewUser):
    """A view and the hand at its mouse and keyboard."""

    view: SceneView
    drive: Drive

    @property
    @override
    def picture(self) -> ScenePicture:
        """The widget that gets the mouse."""
        picture = self.view.picture
        assert picture is not None
        return picture

    def sharpen(self) -> None:
        self.qtbot.waitUntil(lambda: self.view.is_settled, timeout=20_000)

    def look_at(
        self, position: PickedPosition, distance_m: float = 4.0, pitch_deg: float = -50.0
    ) -> None:
        """Look at a place from near, so that its pixel shows no other point."""
        camera = SceneCamera((0.0, 0.0, 0.0), heading_deg=20.0, pitch_deg=pitch_deg)
        self.view.look_from(camera.centred_on(self.local(position), distance_m))
        self.sharpen()

    def local(self, position: PickedPosition) -> NDArray[np.float64]:
        return np.array(position.xyz) - self.map.origin()

    def spot(self, position: PickedPosition) -> QPoint:
        pixel = self.view.position_of(position)
        assert pixel is not None
        return pixel.toPoint()

    def road_points(self, count: int) -> list[int]:
        """Points on the road some metres apart along the drive, with nothing above them."""
        vehicle_path = self.drive.trajectory
        assert vehicle_path is not None
        all_points = np.arange(self.drive.count)
        xyz = self.drive.xyz(slice(None))
        low = xyz[:, 2] < np.percentile(xyz[:, 2], 30)
        inside = (vehicle_path.xyz[:, 1] > xyz[:, 1].min() + 3) & (
            vehicle_path.xyz[:, 1] < xyz[:, 1].max() - 3
        )
        stops = vehicle_path.xyz[inside][:: max(1, int(inside.sum()) // count)][:count]
        road = all_points[low]
        return [
            int(road[np.hypot(*(xyz[road, :2] - stop[:2] - [0.4, 0.0]).T).argmin()])
            for stop in stops
        ]


@pytest.fixture
def open_map(left_drive: Drive, right_drive: Drive) -> OpenMap:
    return OpenMap((left_drive, right_drive))


@pytest.fixture
def user(
    qtbot: QtBot, open_map: OpenMap, tiles: TileCache, left_drive: Drive
) -> Iterator[SceneViewUser]:
    view = SceneView(open_map, open_map.shared, tiles)
    qtbot.addWidget(view)
    view.resize(800, 600)
    with qtbot.waitSignal(view.sharpened, timeout=60_000):
        view.show()
    yield SceneViewUser(qtbot, open_map, view, left_drive)
    view.close()
