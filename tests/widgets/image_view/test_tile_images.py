"""Tiles are there before they are looked at, and never leave a hole while they are not."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import QDeadlineTimer, QThread
from pytestqt.qtbot import QtBot

from processing.image.attributes.tile_cache import TileCache, TilePixels, TileRequest
from processing.image.tiles.tiles import TileKey
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.image_view.tile_images import TileImages
from widgets.shared.view_settings import PointStyle

KIND = ImageKind.TRAJECTORY_CENTER


@pytest.fixture
def images(tiles: TileCache, picture: OrientedImage, qapp: object) -> Iterator[TileImages]:
    made = TileImages(tiles)
    made.show(picture, PointStyle())
    yield made
    tiles.tell_nobody()


@pytest.fixture
def picture(left_drive: Drive) -> OrientedImage:
    return OrientedImage.of(left_drive, KIND)


def request_for(drive: Drive, key: TileKey) -> TileRequest:
    look = PointStyle()
    return TileRequest(drive.id, KIND, key, look.attribute, look.low_percent, look.high_percent)


def load(qtbot: QtBot, tiles: TileCache, request: TileRequest) -> TilePixels:
    found: list[TilePixels] = []
    tiles.request(request, lambda _request, pixels: found.append(pixels))
    qtbot.waitUntil(lambda: bool(found), timeout=30_000)
    return found[0]


def test_what_may_be_looked_at_next_is_loaded_once_the_rest_is_there(
    images: TileImages, tiles: TileCache, left_drive: Drive, qtbot: QtBot
) -> None:
    seen, beside = TileKey(0, 0, 0), TileKey(0, 0, 1)
    with qtbot.waitSignal(images.changed, timeout=30_000):
        assert not images.images([seen], 1, [beside])
    assert tiles.get(request_for(left_drive, beside)) is None
    version = images.version
    assert list(images.images([seen], 1, [beside])) == [seen]
    qtbot.waitUntil(lambda: tiles.get(request_for(left_drive, beside)) is not None, timeout=30_000)
    assert images.version == version  # nothing is painted for it
    assert list(images.images([beside])) == [beside]


def test_a_tile_that_another_view_loaded_stands_in_until_the_sharp_one_comes(
    images: TileImages, tiles: TileCache, picture: OrientedImage, qtbot: QtBot
) -> None:
    top = picture.image.pyramid.top
    assert images.available(top) is None
    pixels = load(qtbot, tiles, request_for(picture.drive, top))
    stand_in = images.available(top)
    assert stand_in is not None
    height, width = pixels.points.shape
    assert (stand_in.width(), stand_in.height()) == (height, width)  # rows go to the right
    assert images.available(top) is stand_in


def test_a_tile_that_became_old_on_its_way_is_not_shown(
    images: TileImages, tiles: TileCache, left_drive: Drive, qtbot: QtBot
) -> None:
    key = TileKey(0, 0, 0)
    request = request_for(left_drive, key)
    images.images([key])
    # What a loader has told waits in the event queue, which is not served meanwhile.
    deadline = QDeadlineTimer(30_000)
    while tiles.get(request) is None and not deadline.hasExpired():
        QThread.yieldCurrentThread()
    tiles.drop(left_drive.id)
    with qtbot.waitSignal(images.changed, timeout=30_000):
        pass
    assert images.version == 0
    with qtbot.waitSignal(images.changed, timeout=30_000):
        assert not images.images([key])
    assert list(images.images([key])) == [key]
