"""The map view on a shown window, sharp, with a map behind it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest
from PySide6.QtCore import QPoint
from pytestqt.qtbot import QtBot

from processing.image.attributes.tile_cache import TileCache
from processing.recording.drive import Drive
from tests.widgets.builders import OpenMap
from tests.widgets.view_user import ViewUser
from widgets.map_view.view import MapView
from widgets.shared.cursor import PickedPosition


@dataclass
class MapViewUser(ViewUser):
    """A view and the hand at its mouse."""

    view: MapView
    drive: Drive

    def look_at(self, position: PickedPosition, px_per_m: float) -> None:
        """Look at a place from so near, and wait until the picture is sharp."""
        projection = self.view.projection()
        assert projection is not None
        x, y = projection.to_plane(np.array([position.xyz]))[0].tolist()
        viewport = self.view.viewport
        with self.qtbot.waitSignal(self.view.sharpened, timeout=30_000):
            self.view.set_viewport(
                viewport.zoomed(px_per_m / viewport.scale, 0.0, 0.0).centred_on(x, y)
            )

    def spot(self, position: PickedPosition) -> QPoint:
        pixel = self.view.position_of(position)
        assert pixel is not None
        return pixel.toPoint()

    def road_points(self, count: int) -> list[int]:
        """Points of the road that nothing is above, the highest for half a metre, far apart."""
        xyz = self.drive.xyz(slice(None))
        is_road = np.abs(xyz[:, 2] - np.median(xyz[:, 2])) < 0.3
        found: list[int] = []
        for point in np.flatnonzero(is_road).tolist():
            away = np.hypot(*(xyz[:, :2] - xyz[point, :2]).T)
            alone = xyz[away < 0.5, 2].max() < xyz[point, 2] + 0.09
            if alone and all(np.hypot(*(xyz[one] - xyz[point])[:2]) > 1.0 for one in found):
                found.append(point)
            if len(found) == count:
                break
        assert len(found) == count
        return found


@pytest.fixture
def open_map(left_drive: Drive) -> OpenMap:
    return OpenMap((left_drive,))


@pytest.fixture
def user(
    qtbot: QtBot, open_map: OpenMap, tiles: TileCache, left_drive: Drive
) -> Iterator[MapViewUser]:
    """Give a view of the left drive, all of it in the window."""
    view = MapView(open_map, open_map.shared, tiles)
    qtbot.addWidget(view)
    view.resize(900, 700)
    with qtbot.waitSignal(view.sharpened, timeout=30_000):
        view.show()
    yield MapViewUser(qtbot, open_map, view, left_drive)
    view.close()
