"""What tests of widgets share: two imported drives, made once."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from processing.image.attributes.tile_cache import TileCache
from processing.recording.drive import Drive
from tests.widgets.builders import OpenMap, imported_drive


@pytest.fixture(scope="session")
def left_drive(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    """Give the left scanner's recording of a street of ten metres; read only."""
    return imported_drive(tmp_path_factory.mktemp("left"))


@pytest.fixture(scope="session")
def right_drive(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    """Give the right scanner's recording of the same street; read only."""
    return imported_drive(tmp_path_factory.mktemp("right"), head="right", seed=2)


@pytest.fixture
def tiles(open_map: OpenMap) -> Iterator[TileCache]:
    """Give a cache of what the test's map has open."""
    cache = TileCache()
    cache.use(open_map.drive)
    yield cache
    cache.close()
