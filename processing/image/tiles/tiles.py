"""TilePyramid: blocks of rows × columns with their place in space, coarser and coarser.

The pyramid is virtual: coarser tiles sample rows and columns of the image itself. What is kept is
one small table: for every tile of every level where it is, how many pixels it fills and how far
they are apart.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.image.rows.pixel_rows import PixelRows
from processing.image.tiles.tile_bounds import PORTION_POINTS, TileBounds
from processing.image.tiles.tile_kernels import COUNT, HIGHEST, LOWEST, STEPS
from processing.image.tiles.tile_kernels import TILE as TILE
from processing.recording.columns.coordinates import Coordinates
from processing.recording.columns.counted_classes import ClassColumns

_FEW_PIXELS = 4096
"""The coarsest level has no more pixels, so that a hundred drives can be drawn together."""


@dataclass(frozen=True, order=True)
class TileKey:
    """A tile's place: it covers TILE · 2^level rows and columns of the image.

    Attributes
    ----------
    has_all : bool
        Of level 0, and with every point of its pixels, not only the one that each shows.
    """

    level: int
    row: int
    column: int
    has_all: bool = False

    @property
    def above(self) -> TileKey:
        """The next coarser tile that covers it, whether the image has that level or not."""
        if self.has_all:
            return TileKey(0, self.row, self.column)
        return TileKey(self.level + 1, self.row // 2, self.column // 2)

    @property
    def rank(self) -> int:
        """How many steps it is from the finest that there is."""
        return 0 if self.has_all else self.level + 1


class TilePyramid:
    """The tiles of one image.

    Parameters
    ----------
    image : PixelRows
    coordinates : Coordinates

    Attributes
    ----------
    levels : int
        The coarsest, ``levels − 1``, has one tile; 0 is the image itself.
    """

    def __init__(self, image: PixelRows, coordinates: Coordinates) -> None:
        self._image = image
        self._shapes = _shapes_of(image.rows, image.width)
        self._bounds = TileBounds(image, coordinates, self._shapes)
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
        return key if key.level == self.levels - 1 and not key.has_all else key.above

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

    def points(
        self, key: TileKey, *, without_noise: ClassColumns | None = None
    ) -> NDArray[np.int64]:
        """The points that a tile shows: at most (256, 256) int64, −1 where empty.

        Of a tile that has all points these, one behind the other: (1, n). Without noise, as
        :meth:`PointCloudImage.raster` leaves it out.
        """
        rows, columns = self.rows_columns(key)
        if key.has_all:
            points = self._image.points_in(rows, columns)
            if without_noise is not None:
                points = points[~without_noise.are_noise(points)]
            return points[None]
        return self._image.raster(rows, columns, 1 << key.level, without_noise=without_noise)

    def bounds(self, key: TileKey) -> NDArray[np.float64] | None:
        """Lowest and highest coordinates of all points below a tile; None when it has none.

        Returns
        -------
        (2, 3) float64
            m, project CRS.
        """
        values = self.table[self.index(key)]
        if values[0] > values[3]:
            return None
        return np.stack([values[LOWEST], values[HIGHEST]])

    def count(self, key: TileKey) -> int:
        """How many pixels of a tile are filled."""
        return int(self.table[self.index(key), COUNT])

    def spacing_m(self, key: TileKey) -> float:
        """Mean distance of neighbours in a tile, along and across rows.

        Where it isn't known yet, or where no pixels are neighbours, as if the points lay evenly.
        """
        facts = self.facts[self.index(key)]
        steps = float(facts[STEPS].mean()) * (1 << key.level)
        return steps or _even_spacing_m(facts)

    def index(self, key: TileKey) -> int:
        """The tile's line in `table` and `facts`."""
        _, columns = self._shapes[key.level]
        return int(self._bounds.starts[key.level]) + key.row * columns + key.column

    @property
    def shapes(self) -> NDArray[np.int64]:
        """(levels, 3): rows and columns of tiles, and the line of `facts` where a level begins."""
        return np.column_stack([np.array(self._shapes), self._bounds.starts[:-1]])

    @property
    def facts(self) -> NDArray[np.float64]:
        """What is known of the tiles now; as `table`, but not all of it exact.

        Each tile is about where it says; see :class:`TileBounds`.
        """
        self._bounds.sketch()
        return self._bounds.facts

    @property
    def is_ready(self) -> bool:
        """Whether exact bounds can be asked for without waiting."""
        return self._bounds.is_whole

    def sketch(self) -> None:
        """Know roughly where tiles are, of a short recording exactly.

        Takes a fraction of a second, however long the recording is.
        """
        self._bounds.sketch()

    def extend(self, near: NDArray[np.float64] | None = None, points: int = PORTION_POINTS) -> bool:
        """Make some more of the bounds exact, near a place first; says whether all are now.

        Parameters
        ----------
        near : (3,) float64, optional
            m, project CRS.
        points : int
            Of about so many points.
        """
        return self._bounds.extend(near, points)

    def keep(self) -> None:
        """Write what :meth:`extend` has worked out, which otherwise happens from time to time."""
        self._bounds.keep()

    def is_exact(self, key: TileKey) -> bool:
        """Whether a tile's bounds are exact by now."""
        last = min((key.row + 1) << key.level, self._shapes[0][0])
        return self._bounds.are_exact(np.arange(key.row << key.level, last))

    def prepare(self, monitor: Monitor | None = None) -> None:
        """Make all bounds exact or read them; some seconds for 100 million points.

        Raises
        ------
        Cancelled
            The monitor was told to stop; what was worked out is kept.
        """
        while not self._bounds.extend():
            if monitor is not None:
                monitor.check()

    @property
    def table(self) -> NDArray[np.float64]:
        """Facts on all tiles, level after level; waits until all are exact.

        Returns
        -------
        (tiles, 10) float64
            Lowest and highest coordinates (m, project CRS), number of filled pixels, distance of
            neighbours along and across rows at level 0 (m), points.
        """
        if not self._bounds.is_whole:
            self.prepare()
        return self._bounds.facts


def _shapes_of(rows: int, width: int) -> list[tuple[int, int]]:
    """Rows and columns of tiles, level by level.

    The last levels have one tile each, the coarsest of few pixels: so a hundred drives can be
    drawn together, each with something.
    """
    shapes = [(max(1, -(-rows // TILE)), max(1, -(-width // TILE)))]
    while shapes[-1] != (1, 1) or (rows * width) >> 2 * (len(shapes) - 1) > _FEW_PIXELS:
        shapes.append(((shapes[-1][0] + 1) // 2, (shapes[-1][1] + 1) // 2))
    return shapes


def _even_spacing_m(facts: NDArray[np.float64]) -> float:
    size = facts[HIGHEST] - facts[LOWEST]
    return float(np.hypot(size[0], size[1])) / TILE if np.isfinite(size).all() else 0.0
