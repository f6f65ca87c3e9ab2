"""GeoTIFF: grids of numbers with their place, written a tile at a time, however large they are.

Tiles without a number are left out of the file, which GDAL, and so QGIS, reads as “no data”.
Pillow and OpenCV want the whole picture in memory; rasterio would bring GDAL a second time, beside
pyogrio's.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor

if TYPE_CHECKING:
    from PIL.TiffImagePlugin import ImageFileDirectory_v2

TILE = 256
_MOST_CLASSIC = 3_500_000_000
_ASCII, _SHORT, _LONG, _DOUBLE, _LONG8 = 2, 3, 4, 12, 16
_DEFLATE, _SEPARATE, _FLOAT = 8, 2, 3
_PROJECTED, _PIXEL_IS_AREA, _METRE = 1, 1, 9001

WindowReader = Callable[[range, range], NDArray[np.float32]]
"""From rows (from the north) and columns to (bands, rows, columns) float32; NaN where no data."""


@dataclass(frozen=True)
class Raster:
    """What a GeoTIFF says about its cells.

    Attributes
    ----------
    rows, columns : int
        Rows count from the north.
    west, north : float
        Outer corner of the first cell, m.
    cell_m : float
    crs : str
        ``EPSG:n`` of a projected system, or empty when unknown.
    bands : tuple of str
        What each band says.
    """

    rows: int
    columns: int
    west: float
    north: float
    cell_m: float
    crs: str
    bands: tuple[str, ...]


def write_geotiff(
    path: Path,
    raster: Raster,
    window: WindowReader,
    filled: Iterable[tuple[int, int]],
    monitor: Monitor,
) -> None:
    """Write bands of float32 with NaN for “no data”; the caller gives the file its name.

    Parameters
    ----------
    window : callable
        The cells of a rectangle; asked for one tile at a time.
    filled : iterable of (int, int)
        Row and column of the tiles, counted in tiles of 256 cells, that may hold numbers.

    Raises
    ------
    NoSpace, Cancelled

    References
    ----------
    TIFF 6.0; OGC 19-008r4 (GeoTIFF 1.1); GDAL's own tags for “no data” and names of bands.
    """
    across, down = -(-raster.columns // TILE), -(-raster.rows // TILE)
    positions = sorted(set(filled))
    is_big = len(positions) * len(raster.bands) * TILE * TILE * 4 > _MOST_CLASSIC
    offsets = np.zeros((len(raster.bands), down, across), np.int64)
    sizes = np.zeros_like(offsets)
    with report_as_user_error(path), path.open("wb") as file:
        file.write(_start(0, is_big=is_big))
        for done, (row, column) in enumerate(positions):
            monitor.check()
            monitor.report(done / len(positions))
            rows = range(row * TILE, min((row + 1) * TILE, raster.rows))
            columns = range(column * TILE, min((column + 1) * TILE, raster.columns))
            bands = window(rows, columns)
            if np.isfinite(bands).any():
                for band, cells in enumerate(bands):
                    offsets[band, row, column] = file.tell()
                    sizes[band, row, column] = _write_tile(file, cells)
        file.write(bytes(file.tell() % 2))
        at = file.tell()
        file.write(_directory(raster, offsets, sizes, is_big=is_big).tobytes(at))
        file.seek(0)
        file.write(_start(at, is_big=is_big))


def _start(directory: int, *, is_big: bool) -> bytes:
    if is_big:
        return struct.pack("<2sHHHQ", b"II", 43, 8, 0, directory)
    return struct.pack("<2sHL", b"II", 42, directory)


def _write_tile(file: BinaryIO, cells: NDArray[np.float32]) -> int:
    whole = np.full((TILE, TILE), np.nan, "<f4")
    whole[: cells.shape[0], : cells.shape[1]] = cells
    packed = zlib.compress(whole.tobytes(), 6)
    file.write(packed)
    return len(packed)


def _directory(
    raster: Raster, offsets: NDArray[np.int64], sizes: NDArray[np.int64], *, is_big: bool
) -> ImageFileDirectory_v2:
    from PIL.TiffImagePlugin import ImageFileDirectory_v2

    count = len(raster.bands)
    long = _LONG8 if is_big else _LONG
    directory = ImageFileDirectory_v2(_start(0, is_big=is_big))
    described = "".join(
        f'<Item name="DESCRIPTION" sample="{band}" role="description">{escape(name)}</Item>'
        for band, name in enumerate(raster.bands)
    )
    tags: Sequence[tuple[int, int, object]] = (
        (256, _LONG, raster.columns),
        (257, _LONG, raster.rows),
        (258, _SHORT, (32,) * count),
        (259, _SHORT, _DEFLATE),
        (262, _SHORT, 1),
        (277, _SHORT, count),
        (284, _SHORT, _SEPARATE),
        (322, _SHORT, TILE),
        (323, _SHORT, TILE),
        (324, long, tuple(offsets.ravel().tolist())),
        (325, long, tuple(sizes.ravel().tolist())),
        # Bands after the first are of no meaning to TIFF itself.
        (338, _SHORT, (0,) * (count - 1)),
        (339, _SHORT, (_FLOAT,) * count),
        (33550, _DOUBLE, (raster.cell_m, raster.cell_m, 0.0)),
        (33922, _DOUBLE, (0.0, 0.0, 0.0, raster.west, raster.north, 0.0)),
        (34735, _SHORT, _geo_keys(raster.crs)),
        (42112, _ASCII, f"<GDALMetadata>{described}</GDALMetadata>"),
        (42113, _ASCII, "nan"),
    )
    for tag, kind, value in tags:
        if value != ():
            directory.tagtype[tag] = kind
            directory[tag] = value
    return directory


def _geo_keys(crs: str) -> tuple[int, ...]:
    keys = [(1025, _PIXEL_IS_AREA)]
    authority, _, code = crs.partition(":")
    if authority == "EPSG" and code.isdecimal():
        keys = [(1024, _PROJECTED), *keys, (3072, int(code)), (3076, _METRE)]
    flat = [value for key, reported in keys for value in (key, 0, 1, reported)]
    return (1, 1, 1, len(keys), *flat)
