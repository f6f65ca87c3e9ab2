"""A street with photographs, and the camera view on a shown window."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from processing.recording.camera_images.image_list import CameraImage, ImageList
from processing.recording.camera_images.image_store import write_images
from processing.recording.drive import Drive
from tests.builders import START
from tests.camera_scene import looking, photograph
from tests.widgets.builders import OpenMap, imported_drive
from widgets.camera_view.panel import CameraPanel
from widgets.camera_view.view import CameraView
from widgets.shared.cursor import PickedPosition

LEFT = Qt.MouseButton.LeftButton


def position_at(east: float, north: float, up: float = 0.0) -> PickedPosition:
    """A place, m from the street's start."""
    easting, northing, height = (START + np.array([east, north, up])).tolist()
    return PickedPosition((easting, northing, height))


@dataclass
class CameraViewUser:
    """A panel and the hand at its mouse and keyboard."""

    qtbot: QtBot
    map: OpenMap
    panel: CameraPanel

    @property
    def view(self) -> CameraView:
        return self.panel.view

    def look_at(self, position: PickedPosition) -> None:
        """Move the cursor elsewhere and wait for the image."""
        self.map.shared.cursor.move_to(position)
        self.wait_sharp()

    def wait_sharp(self) -> None:
        self.qtbot.waitUntil(lambda: self.view.is_sharp, timeout=30_000)

    def do(self, work: Callable[[], object]) -> None:
        work()
        self.wait_sharp()

    def spot(self, position: PickedPosition) -> QPoint:
        pixel = self.view.position_of(position)
        assert pixel is not None
        return pixel.toPoint()

    def click(self, spot: QPoint) -> None:
        self.qtbot.mouseClick(self.view, LEFT, pos=spot)

    @property
    def name(self) -> str:
        taken = self.view.showing.taken
        return "" if taken is None else taken.image.path.stem


def images_below(folder: object) -> tuple[CameraImage, ...]:
    ways = {"front": (0.0, 1.0, -0.2), "left": (-1.0, -0.2, -0.1)}
    return tuple(
        looking(folder / "写真" / f"{name}_{number:04d}.png", (-0.5, along, 2.0), ahead)  # type: ignore[operator]
        for name, ahead in ways.items()
        for number, along in enumerate((0.0, 4.0))
    )


@pytest.fixture(scope="module")
def photographed(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    """Give a street with two cameras and two images of each; offsets may be kept in it."""
    folder = tmp_path_factory.mktemp("photographed")
    drive = imported_drive(folder / "street")
    images = images_below(folder)
    for image in images:
        photograph(image)
    write_images(drive.folder, ImageList(images))
    return Drive(drive.folder)


@pytest.fixture
def user(qtbot: QtBot, photographed: Drive) -> Iterator[CameraViewUser]:
    user = shown(qtbot, OpenMap((photographed,)))
    yield user
    user.view.close()


def shown(qtbot: QtBot, open_map: OpenMap) -> CameraViewUser:
    panel = CameraPanel(open_map, open_map.shared)
    qtbot.addWidget(panel)
    panel.resize(800, 600)
    with qtbot.waitExposed(panel):
        panel.show()
    return CameraViewUser(qtbot, open_map, panel)
