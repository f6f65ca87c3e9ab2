"""TilePyramid: blocks of rows × columns with their place in space, coarser and coarser.

The pyramid is virtual: coarser tiles sample rows and columns of the image itself. What is kept is
one small table: for every tile of every level where it is, how many pixels it fills and how far
they are apart.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.image.coordinates import Coordinates
from processing.image.tile_kernels import COUNT, HIGHEST, LOWEST, STEPS, VALUES, tile_kernel

if TYPE_CHECKING:  # the image makes its pyramid, so importing it here would be a circle
    from processing.image.point_image import PointCloudImage

TILE = 256
_POINTS_AT_ONCE = 4_000_000


@dataclass(frozen=True, order=True)
class TileKey:
    """A tile's place: it covers TILE · 2^level rows and columns of the image."""

    level: int
    row: int
    column: int


class TilePyramid:
    """The tiles of one image.

    Parameters
    ----------
    image : PointCloudImage
    coordinates : Coordinates

    Attributes
    ----------
    levels : int
        The coarsest, ``levels − 1``, has one tile; 0 is the image itself.
    """

    def __init__(self, image: PointCloudImage, coordinates: Coordinates) -> None:
        self._image = image
        self._coordinates = coordinates
        self._lock = threading.Lock()
        self._table: NDArray[np.float64] | None = None
        self._shapes = _shapes_of(image.rows, image.width)
        sizes = [rows * columns for rows, columns in self._shapes]
        self._starts = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
        self.levels = len(self._shapes)

    @property
    def top(self) -> TileKey:
        """The one tile of the coarsest level."""
        return TileKey(self.levels - 1, 0, 0)

    def shape(self, level: int) -> tuple[int, int]:
        """Rows and columns of tiles at a level."""
        return self._shapes[level]

    def keys(self, level: int) -> Iterator[TileKey]:
        """All tiles of a level, filled or not, row by row."""
        rows, columns = self._shapes[level]
        return (TileKey(level, row, column) for row in range(rows) for column in range(columns))

    def parent(self, key: TileKey) -> TileKey:
        """The tile of the next coarser level; the coarsest is its own parent."""
        if key.level == self.levels - 1:
            return key
        return TileKey(key.level + 1, key.row // 2, key.column // 2)

    def children(self, key: TileKey) -> tuple[TileKey, ...]:
        """Up to four tiles of the next finer level; none of level 0."""
        if key.level == 0:
            return ()
        rows, columns = self._shapes[key.level - 1]
        return tuple(
            TileKey(key.level - 1, row, column)
            for row in (2 * key.row, 2 * key.row + 1)
            for column in (2 * key.column, 2 * key.column + 1)
            if row < rows and column < columns
        )

    def rows_columns(self, key: TileKey) -> tuple[range, range]:
        """Rows and columns of the image that a tile covers."""
        size = TILE << key.level
        return (
            range(key.row * size, min(self._image.rows, (key.row + 1) * size)),
            range(key.column * size, min(self._image.width, (key.column + 1) * size)),
        )

    def points(self, key: TileKey) -> NDArray[np.int64]:
        """The points that a tile shows: at most (256, 256) int64, −1 where empty."""
        rows, columns = self.rows_columns(key)
        return self._image.raster(rows, columns, 1 << key.level)

    def bounds(self, key: TileKey) -> NDArray[np.float64] | None:
        """Lowest and highest coordinates of all points below a tile; None when it has none.

        Returns
        -------
        (2, 3) float64
            m, project CRS.
        """
        values = self.table[self.index(key)]
        if values[COUNT] == 0:
            return None
        return np.stack([values[LOWEST], values[HIGHEST]])

    def count(self, key: TileKey) -> int:
        """How many pixels of a tile are filled."""
        return int(self.table[self.index(key), COUNT])

    def spacing_m(self, key: TileKey) -> float:
        """Mean distance of neighbours in a tile, along and across rows; 0 where unknown."""
        return float(self.table[self.index(key), STEPS].mean()) * (1 << key.level)

    def index(self, key: TileKey) -> int:
        """The tile's line in `table`."""
        _, columns = self._shapes[key.level]
        return int(self._starts[key.level]) + key.row * columns + key.column

    @property
    def is_ready(self) -> bool:
        """Whether bounds can be asked for without waiting."""
        return self._table is not None

    def prepare(self) -> None:
        """Make the table of bounds or read it; some seconds for 100 million points."""
        with self._lock:
            if self._table is None:
                self._table = self._read() if self._path else None
            if self._table is None:
                self._table = self._computed()
                self._write(self._table)

    @property
    def table(self) -> NDArray[np.float64]:
        """Facts on all tiles, level after level; made when first asked for.

        Returns
        -------
        (tiles, 9) float64
            Lowest and highest coordinates (m, project CRS), number of filled pixels, distance of
            neighbours along and across rows at level 0 (m).
        """
        if self._table is None:
            self.prepare()
        table = self._table
        if table is None:
            message = "the table was not made"
            raise RuntimeError(message)
        return table

    @property
    def _path(self) -> Path | None:
        folder = self._coordinates.folder
        return folder / f"tile_bounds_{self._image.kind.value}.npy" if folder else None

    def _read(self) -> NDArray[np.float64] | None:
        path = self._path
        try:
            # What can be computed again is computed again when the file is lost or damaged.
            table = np.load(path) if path is not None else None
        except (OSError, ValueError, EOFError):
            return None
        except SystemError:
            # Python 3.11 may stumble over the file's header while another thread parses too.
            return None
        is_whole = table is not None and table.shape == (int(self._starts[-1]), VALUES)
        return table if is_whole else None

    def _write(self, table: NDArray[np.float64]) -> None:
        path = self._path
        if path is None:
            return
        temporary = path.with_suffix(f".{threading.get_ident()}.part")
        try:
            with temporary.open("wb") as file:
                np.save(file, table)
            temporary.replace(path)
        except OSError:
            # A read-only or full disk: the table is made again next time.
            temporary.unlink(missing_ok=True)

    def _computed(self) -> NDArray[np.float64]:
        sums = np.zeros((int(self._starts[-1]), VALUES + 2))
        sums[:, LOWEST] = np.inf
        sums[:, HIGHEST] = -np.inf
        tile_columns = np.array([columns for _, columns in self._shapes])
        scale = np.array(self._coordinates.scale)
        image = self._image
        for rows in _row_stretches(image.row_starts, _POINTS_AT_ONCE):
            start, stop = int(image.row_starts[rows.start]), int(image.row_starts[rows.stop])
            integers = self._coordinates.stretch(start, stop)
            columns = image.columns_of(start, stop)
            tile_kernel(
                integers,
                columns,
                image.row_starts[rows.start : rows.stop + 1] - start,
                scale,
                rows.start,
                self._starts,
                tile_columns,
                sums,
            )
        self._unite(sums)
        table = sums[:, :VALUES]
        table[:, LOWEST] = table[:, LOWEST] * scale + np.array(self._coordinates.offset)
        table[:, HIGHEST] = table[:, HIGHEST] * scale + np.array(self._coordinates.offset)
        return np.ascontiguousarray(table)

    def _unite(self, sums: NDArray[np.float64]) -> None:
        """Bounds and distances of coarser tiles from those of their children."""
        weights = sums[:, VALUES:]
        for level in range(1, self.levels):
            for key in self.keys(level):
                below = sums[[self.index(child) for child in self.children(key)]]
                line = self.index(key)
                sums[line, LOWEST] = below[:, LOWEST].min(axis=0)
                sums[line, HIGHEST] = below[:, HIGHEST].max(axis=0)
                sums[line, STEPS] = below[:, STEPS].sum(axis=0)
                weights[line] = below[:, VALUES:].sum(axis=0)
        # The square of the mean root is less moved by jumps between objects than the mean.
        means = np.divide(sums[:, STEPS], weights, out=np.zeros_like(weights), where=weights > 0)
        sums[:, STEPS] = means**2


def _shapes_of(rows: int, width: int) -> list[tuple[int, int]]:
    shapes = [(max(1, -(-rows // TILE)), max(1, -(-width // TILE)))]
    while shapes[-1] != (1, 1):
        shapes.append(((shapes[-1][0] + 1) // 2, (shapes[-1][1] + 1) // 2))
    return shapes


def _row_stretches(row_starts: NDArray[np.int64], points: int) -> Iterator[range]:
    """Consecutive rows with about so many points each."""
    rows, first = row_starts.size - 1, 0
    while first < rows:
        wanted = np.searchsorted(row_starts, row_starts[first] + points, side="right") - 1
        end = min(rows, max(first + 1, int(wanted)))
        yield range(first, end)
        first = end
