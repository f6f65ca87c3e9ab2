"""Which tiles hold some points, at every level."""

from __future__ import annotations

import numpy as np
import pytest

from processing.image.attributes.tile_cache import TileCache, TileRequest
from processing.image.images_of_drives import image_of
from processing.image.search.touched_tiles import TouchedTiles
from processing.image.tiles.tiles import TILE
from processing.recording.kinds import ImageKind
from tests.widgets.builders import imported_drive


@pytest.fixture(scope="module")
def drive(tmp_path_factory):
    return imported_drive(tmp_path_factory.mktemp("street"))


@pytest.mark.parametrize("kind", [one for one in ImageKind if one.follows_path])
def test_the_tiles_of_points_are_those_that_their_pixels_are_in(drive, kind):
    image = image_of(drive, kind)
    random = np.random.default_rng(3)
    for points in (np.array([random.integers(drive.count)]), np.arange(100, 5000, 7)):
        rows, columns = image.pixel_of(points)
        touched = TouchedTiles(image, points)
        for level in range(image.pyramid.levels):
            size = TILE << level
            wanted = set(zip((rows // size).tolist(), (columns // size).tolist(), strict=True))
            found = {(k.row, k.column) for k in image.pyramid.keys(level) if k in touched}
            assert found == wanted
    assert image.pyramid.top not in TouchedTiles(image, np.empty(0, np.int64))


def test_the_cache_forgets_only_the_tiles_of_points_that_changed(drive):
    image = image_of(drive, ImageKind.REVERSIBLE)
    cache = TileCache()
    cache.use(lambda _: drive)
    try:
        requests = [
            TileRequest(drive.id, ImageKind.REVERSIBLE, key, attribute, 2.0, 98.0)
            for key in image.pyramid.keys(0)
            for attribute in ("label", "height")
        ]
        for request in requests:
            pixels = cache._pixels_of(request, lambda _: drive)
            with cache._changed:
                cache._keep(request, pixels)
        before = cache.held_bytes
        touched = TouchedTiles(image, np.array([0]))
        cache.drop_relabelled(drive, np.array([0]))
        gone = [request for request in requests if cache.get(request) is None]
        assert gone == [r for r in requests if r.attribute == "label" and r.key in touched]
        assert 0 < len(gone) < len(requests) / 2
        assert cache.held_bytes < before
    finally:
        cache.close()
