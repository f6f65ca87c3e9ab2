"""GeoTIFF as other programs read it: tags and numbers through an independent reader."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from processing.core.errors import Cancelled
from processing.core.monitor import SilentMonitor
from processing.formats.surfaces.geotiff import TILE, Raster, write_geotiff
from tests.monitors import CancelledAfter

_RASTER = Raster(300, 520, -12_400.0, -36_000.0, 0.25, "EPSG:6677", ("height", "filled"))


def _bands() -> np.ndarray:
    rows, columns = np.mgrid[:300, :520].astype(np.float32)
    heights = 100.0 + 0.01 * rows + 0.002 * columns
    heights[:, 513:] = np.nan
    return np.stack([heights, (columns > 100).astype(np.float32)])


def _write(path: Path, bands: np.ndarray, raster: Raster = _RASTER) -> None:
    tiles = [(row, column) for row in range(2) for column in range(3)]

    def window(rows: range, columns: range) -> np.ndarray:
        return bands[:, rows.start : rows.stop, columns.start : columns.stop]

    write_geotiff(path, raster, window, tiles, SilentMonitor())


def test_place_system_and_no_data_are_said_as_the_standard_wants(tmp_path: Path) -> None:
    path = tmp_path / "s.tif"
    _write(path, _bands())
    with Image.open(path) as read:
        tags = dict(read.tag_v2)  # type: ignore[attr-defined] - of TIFF files
    assert (tags[256], tags[257], tags[277]) == (520, 300, 2)
    assert tags[33550] == (0.25, 0.25, 0.0)
    assert tags[33922] == (0.0, 0.0, 0.0, -12_400.0, -36_000.0, 0.0)
    keys = np.array(tags[34735]).reshape(-1, 4)
    assert {int(key): int(value) for key, _, _, value in keys[1:]} == {
        1024: 1,
        1025: 1,
        3072: 6677,
        3076: 9001,
    }
    assert tags[42113] == "nan"
    assert 'sample="1" role="description">filled<' in tags[42112]


def test_cells_come_back_and_empty_tiles_take_no_room(tmp_path: Path) -> None:
    import zlib

    bands = _bands()
    bands[:, :256, :256] = np.nan
    path = tmp_path / "s.tif"
    _write(path, bands)
    with Image.open(path) as read:
        offsets, sizes = read.tag_v2[324], read.tag_v2[325]  # type: ignore[attr-defined]
    assert sizes[0] == sizes[6] == 0
    content = path.read_bytes()
    found = np.full((2, 2 * TILE, 3 * TILE), np.nan, np.float32)
    for number, (at, size) in enumerate(zip(offsets, sizes, strict=True)):
        if size:
            band, position = divmod(number, 6)
            row, column = divmod(position, 3)
            cells = np.frombuffer(zlib.decompress(content[at : at + size]), "<f4")
            rows, columns = slice(row * TILE, (row + 1) * TILE), slice(column * TILE, None)
            found[band, rows, columns][:, :TILE] = cells.reshape(TILE, TILE)
    np.testing.assert_array_equal(found[:, :300, :520], bands)


def test_without_a_system_none_is_named(tmp_path: Path) -> None:
    path = tmp_path / "s.tif"
    _write(path, _bands(), Raster(300, 520, 0.0, 0.0, 0.25, "", ("height", "filled")))
    with Image.open(path) as read:
        assert read.tag_v2[34735] == (1, 1, 1, 1, 1025, 0, 1, 1)  # type: ignore[attr-defined]


def test_a_cancel_comes_through(tmp_path: Path) -> None:
    with pytest.raises(Cancelled):
        write_geotiff(
            tmp_path / "s.tif", _RASTER, lambda _r, _c: _bands(), [(0, 0)], CancelledAfter()
        )
