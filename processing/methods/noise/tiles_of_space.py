"""A cloud of any size, read by position: an order of its points by square tiles, kept in a file.

A drive passes the same position more than once, so that neighbours in space may lie anywhere in the
recording. Three passes over the recording put the numbers of its points in the order of tiles;
after that every part of space is one short read, and parts are as small as memory asks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.scratch_arrays import scratch_array

XyzReader = Callable[[NDArray[np.int64] | slice], NDArray[np.float64]]

POINTS_PER_PART = 2_000_000
"""Points in memory at a time, with those around: some 200 MB."""

_POINTS_AT_ONCE = 1_000_000
"""Points read at a time while they are sorted into tiles: 24 MB."""

_MOST_TILES = 2_000
"""Along one side: 32 MB of beginnings."""

_SAMPLE, _ENDS_PERCENT = 100_000, 0.1
"""The extent is that of so many points without this share at either end, which may be spikes; what
lies beyond is in the outermost tiles."""

_COUNTING_SHARE = 0.5
"""Of the progress of sorting, for counting; the rest for putting in order."""


@dataclass(frozen=True)
class SpacePart:
    """A rectangle seen from above, with what lies near it.

    Attributes
    ----------
    own : (k,) int64
        The points in it; every point of the cloud is in exactly one part.
    around : (m,) int64
        Other points no farther from the rectangle than was asked.
    low, high : (2,) float64
        The rectangle; infinite where it holds everything beyond.
    """

    own: NDArray[np.int64]
    around: NDArray[np.int64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]


class TiledCloud:
    """The points of a cloud in the order of tiles.

    Parameters
    ----------
    read : callable
        Coordinates (m) of points, by a slice or by rising numbers.
    count : int
        Number of points.
    file : Path
        Where the order is kept, 8 bytes a point; the caller deletes it.
    tile_m : float
        Side of a tile; enlarged for a very wide cloud.

    Attributes
    ----------
    read, count
        As given.
    shape : tuple of int
        Number of tiles along either axis.
    spacing_m : float
        How far apart the points are, seen from above, where there are any.

    Raises
    ------
    NoSpace
        The disk can't hold the order.
    """

    def __init__(
        self, read: XyzReader, count: int, file: Path, tile_m: float, *, monitor: Monitor
    ) -> None:
        self.read = read
        self.count = count
        step = max(1, count // _SAMPLE)
        sample = read(np.arange(0, count, step))[:, :2]
        sample = sample[np.isfinite(sample).all(axis=1)]
        if not sample.size:
            sample = np.zeros((1, 2))
        self._low = np.percentile(sample, _ENDS_PERCENT, axis=0) - tile_m
        extent = np.percentile(sample, 100 - _ENDS_PERCENT, axis=0) + tile_m - self._low
        self._side = max(tile_m, float(extent.max()) / _MOST_TILES)
        across, along = np.ceil(extent / self._side).astype(np.int64) + 1
        self.shape = (int(across), int(along))
        self._starts = np.zeros(self.shape[0] * self.shape[1] + 1, np.int64)
        self._order: NDArray[np.int64] = scratch_array(file, np.int64, count)
        self._sort(monitor)
        occupied = int((np.diff(self._starts) > 0).sum())
        self.spacing_m = self._side * float(np.sqrt(occupied / max(count, 1)))

    def parts(
        self,
        reach_m: float,
        most: int = POINTS_PER_PART,
        wanted: NDArray[np.bool_] | None = None,
    ) -> Iterator[SpacePart]:
        """Parts that hold, with what is near, about ``most`` points or a single tile.

        Parameters
        ----------
        wanted : (n,) bool, optional
            Parts without such points are left out.
        """
        for tiles in self.tiles_of_parts(reach_m, most):
            if wanted is None or wanted[self._in_tiles(*tiles)].any():
                yield self.part(tiles, reach_m)

    def tiles_of_parts(self, reach_m: float, most: int) -> Iterator[tuple[int, int, int, int]]:
        """The tiles of parts, as :meth:`parts` and :meth:`part` take them."""
        pending = [(0, 0, *self.shape)]
        ring = int(np.ceil(reach_m / self._side))
        while pending:
            x0, y0, x1, y1 = pending.pop()
            if self._count_in(x0, y0, x1, y1) == 0:
                continue
            wide = self._count_in(x0 - ring, y0 - ring, x1 + ring, y1 + ring)
            if wide > most and max(x1 - x0, y1 - y0) > 1:
                middle_x, middle_y = (x0 + x1) // 2, (y0 + y1) // 2
                if x1 - x0 >= y1 - y0:
                    pending += [(middle_x, y0, x1, y1), (x0, y0, middle_x, y1)]
                else:
                    pending += [(x0, middle_y, x1, y1), (x0, y0, x1, middle_y)]
                continue
            yield x0, y0, x1, y1

    def tiles_of(self, xyz: NDArray[np.float64]) -> NDArray[np.int64]:
        """(n,) int64: numbers of the tiles of positions, row by row of the tiles' `shape`."""
        positions = np.nan_to_num((xyz[:, :2] - self._low) / self._side, nan=0.0)
        tiles = np.clip(positions, 0, np.array(self.shape) - 1).astype(np.int64)
        numbers: NDArray[np.int64] = tiles[:, 0] * self.shape[1] + tiles[:, 1]
        return numbers

    def part(self, tiles: tuple[int, int, int, int], reach_m: float) -> SpacePart:
        """The part that some tiles are."""
        x0, y0, x1, y1 = tiles
        ring = int(np.ceil(reach_m / self._side))
        own = np.sort(self._in_tiles(x0, y0, x1, y1))
        everything = self._in_tiles(x0 - ring, y0 - ring, x1 + ring, y1 + ring)
        around = np.setdiff1d(everything, own, assume_unique=True)
        low = np.where([x0 > 0, y0 > 0], self._low + np.array([x0, y0]) * self._side, -np.inf)
        is_inside = np.array([x1, y1]) < self.shape
        high = np.where(is_inside, self._low + np.array([x1, y1]) * self._side, np.inf)
        if around.size:
            xy = self.read(around)[:, :2]
            gaps = np.maximum(np.maximum(low - xy, xy - high), 0.0)
            around = around[(gaps**2).sum(axis=1) <= reach_m**2]
        return SpacePart(own, around, low, high)

    def _in_tiles(self, x0: int, y0: int, x1: int, y1: int) -> NDArray[np.int64]:
        runs = self._runs(x0, y0, x1, y1)
        return np.concatenate([self._order[start:end] for start, end in runs])

    def _count_in(self, x0: int, y0: int, x1: int, y1: int) -> int:
        return int(sum(end - start for start, end in self._runs(x0, y0, x1, y1)))

    def _runs(self, x0: int, y0: int, x1: int, y1: int) -> list[tuple[int, int]]:
        width = self.shape[1]
        rows = range(max(x0, 0), min(x1, self.shape[0]))
        y0, y1 = max(y0, 0), min(y1, width)
        starts = self._starts
        return [(int(starts[x * width + y0]), int(starts[x * width + y1])) for x in rows]

    def _sort(self, monitor: Monitor) -> None:
        chunks = [
            slice(a, min(a + _POINTS_AT_ONCE, self.count))
            for a in range(0, self.count, _POINTS_AT_ONCE)
        ]
        for chunk in chunks:
            monitor.check()
            tiles = self.tiles_of(self.read(chunk))
            self._starts[1:] += np.bincount(tiles, minlength=self._starts.size - 1)
            monitor.report(_COUNTING_SHARE * chunk.stop / self.count)
        np.cumsum(self._starts, out=self._starts)
        nexts = self._starts[:-1].copy()
        for chunk in chunks:
            monitor.check()
            tiles = self.tiles_of(self.read(chunk))
            order = np.argsort(tiles, kind="stable")
            found, firsts, counts = np.unique(tiles[order], return_index=True, return_counts=True)
            positions = np.repeat(nexts[found] - firsts, counts) + np.arange(order.size)
            self._order[positions] = order + chunk.start
            nexts[found] += counts
            done = chunk.stop / self.count
            monitor.report(_COUNTING_SHARE + (1.0 - _COUNTING_SHARE) * done)
