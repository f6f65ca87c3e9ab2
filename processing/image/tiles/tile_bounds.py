"""TileBounds: where the tiles of an image are; roughly at once, exactly stretch by stretch.

A pass over all points of a long recording takes many seconds. So the tiles' places are sketched
from a few rows first, and the exact ones replace them, those near the camera before others.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.image.rows.pixel_rows import PixelRows
from processing.image.tiles.tile_files import TileFiles
from processing.image.tiles.tile_kernels import (
    COUNT,
    HIGHEST,
    LOWEST,
    POINTS,
    STEPS,
    TILE,
    VALUES,
    tile_kernel,
)
from processing.recording.columns.coordinates import Coordinates

PORTION_POINTS = 1_000_000
"""Points that one step of the pass reads: 12 MB, short enough for views to wait."""

_ROWS_TOGETHER = 8
"""The pass takes distances in every so manyth row, to the row that follows: as `_SAMPLED_ROWS` of
`tile_kernels`."""

_KEPT_EVERY_S = 3.0
"""What is known is written so often: lost at most that much of a pass."""

_SMALL_POINTS = 500_000
"""A recording with fewer points is known exactly sooner than it would be sketched first."""

_MOST_SAMPLES = 4096
"""Tiles for which a sketch reads points, so that it takes the same time for any length."""

_ROOM = 0.15
"""Share of its diagonal by which the box of a sketched tile is made larger. By trial; no
measurement is recorded."""

_LEAST_ROOM_M = 0.5
"""The same at least: what stands up between two samples. By trial; no measurement is recorded."""


class TileBounds:
    """Facts on the tiles of one image; may be used from any thread.

    Parameters
    ----------
    image : PixelRows
    coordinates : Coordinates
    shapes : sequence of (rows, columns)
        Of tiles, level by level, the finest first.

    Attributes
    ----------
    facts : (tiles, 10) float64
        What is known now of each tile, level after level: lowest and highest coordinates (m,
        project CRS; infinite and the wrong way round where a tile is empty), filled pixels,
        distances of neighbours along and across rows at level 0 (m; 0 where unknown), points.
        Changes in place until all is exact.
    is_begun, is_whole : bool
        Whether anything of it is known, and whether all of it is exact.
    """

    def __init__(
        self, image: PixelRows, coordinates: Coordinates, shapes: list[tuple[int, int]]
    ) -> None:
        self._image = image
        self._coordinates = coordinates
        self._shapes = shapes
        sizes = [rows * columns for rows, columns in shapes]
        self.starts: Integers = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
        self._files = TileFiles(
            coordinates.folder, image.kind, (int(self.starts[-1]), VALUES), coordinates.key
        )
        self._lock = threading.Lock()
        self.is_begun = False
        self._kept_at = 0.0
        self.facts: Floats = np.zeros((int(self.starts[-1]), VALUES))
        self.is_whole = False
        edges = np.minimum(np.arange(shapes[0][0] + 1) * TILE, image.rows)
        self._ends: Integers = image.row_starts[edges]
        self._done: NDArray[np.bool_] = np.zeros(shapes[0][0], np.bool_)
        self._sums: Floats = np.empty((0, VALUES + 2))

    def sketch(self) -> None:
        """Know roughly where all tiles are, or exactly what was worked out before."""
        if not self.is_begun:
            with self._lock:
                self._begin()

    def extend(self, near: Floats | None = None, points: int = PORTION_POINTS) -> bool:
        """Work out the exact facts of some more rows, and say whether all are exact now.

        Parameters
        ----------
        near : (3,) float64, optional
            Rows whose tiles lie near this place come first; m, project CRS.
        points : int
            Of about so many points; of at least one row of tiles.
        """
        with self._lock:
            self._begin()
            if self.is_whole:
                return True
            rows = self._next_rows(near, points)
            for first, end in _runs(rows):
                self._pass_over(range(first * TILE, min(end * TILE, self._image.rows)))
                self._done[first:end] = True
                self._refresh(first, end)
            if self._done.all():
                self._finish()
            elif time.monotonic() - self._kept_at > _KEPT_EVERY_S:
                self._keep_begun()
            return self.is_whole

    def keep(self) -> None:
        """Write what was worked out to the drive's folder, so that it isn't done again."""
        with self._lock:
            if self._done.any() and not self.is_whole:
                self._keep_begun()

    def are_exact(self, tile_rows: Integers) -> bool:
        """Whether all is known of these rows of tiles of the finest level."""
        return self.is_whole or bool(self._done[tile_rows].all())

    def _begin(self) -> None:
        if self.is_begun:
            return
        whole = self._files.whole()
        if whole is not None:
            self.facts, self.is_whole, self.is_begun = whole, True, True
            return
        sums = np.zeros((self.facts.shape[0], VALUES + 2))
        sums[:, LOWEST], sums[:, HIGHEST] = np.inf, -np.inf
        self._sums = sums
        begun = self._files.begun(sums.shape, self._done.shape)
        if begun is not None:
            self._sums, self._done = begun
        self._kept_at = time.monotonic()
        tiles, columns = self._shapes[0]
        self.facts[: tiles * columns, :COUNT] = self._sketch_bounds().reshape(-1, COUNT)
        if self._image.drive_count <= _SMALL_POINTS:
            self._pass_over(range(self._image.rows))
            self._done[:] = True
        self._refresh(0, tiles)
        if self._done.all():
            self._finish()
        self.is_begun = True

    def _finish(self) -> None:
        self._done[:] = True
        self.is_whole = True
        self._sums = np.empty((0, VALUES + 2))
        self._files.keep_whole(self.facts)

    def _keep_begun(self) -> None:
        self._files.keep_begun(self._sums, self._done)
        self._kept_at = time.monotonic()

    def _next_rows(self, near: Floats | None, points: int) -> Integers:
        waiting = np.flatnonzero(~self._done)
        if near is not None:
            tiles, columns = self._shapes[0]
            facts = self.facts[: tiles * columns].reshape(tiles, columns, VALUES)[waiting]
            low, high = facts[:, :, LOWEST].min(axis=1), facts[:, :, HIGHEST].max(axis=1)
            away = np.maximum(0.0, np.maximum(low - near, near - high))
            waiting = waiting[np.argsort((away**2).sum(axis=1), kind="stable")]
        counts = self._ends[waiting + 1] - self._ends[waiting]
        few = int(np.searchsorted(np.cumsum(counts), points)) + 1
        return np.sort(waiting[:few])

    def _pass_over(self, rows: range) -> None:
        tile_columns = np.array([columns for _, columns in self._shapes])
        image = self._image
        for some in _row_stretches(image.row_starts, rows, PORTION_POINTS):
            start, stop = int(image.row_starts[some.start]), int(image.row_starts[some.stop])
            tile_kernel(
                self._coordinates.chunk(start, stop),
                image.columns_of(start, stop),
                image.row_starts[some.start : some.stop + 1] - start,
                np.array(self._coordinates.quantisation.scale),
                some.start,
                self.starts,
                tile_columns,
                self._sums,
            )

    def _refresh(self, first: int, end: int) -> None:
        """Take over what is known of some rows of tiles, and of all tiles above them."""
        shape = self._shapes[0]
        facts = self.facts[: shape[0] * shape[1]].reshape(*shape, VALUES)
        sums = self._sums[: shape[0] * shape[1]].reshape(*shape, VALUES + 2)
        rows = np.arange(first, end)
        known, unknown = rows[self._done[rows]], rows[~self._done[rows]]
        facts[known] = self._in_metres(sums[known])
        facts[unknown, :, COUNT] = self._expected_pixels(0, unknown)
        facts[unknown, :, POINTS] = facts[unknown, :, COUNT]
        for level in range(1, len(self._shapes)):
            first, end = first // 2, (end + 1) // 2
            self._unite(level, np.arange(first, end))

    def _unite(self, level: int, rows: Integers) -> None:
        """The facts of consecutive rows of coarser tiles from those of their children."""
        shape, below = self._shapes[level], self._shapes[level - 1]
        own = slice(int(self.starts[level]), int(self.starts[level + 1]))
        finer = slice(int(self.starts[level - 1]), int(self.starts[level]))
        children = slice(2 * int(rows[0]), min(2 * int(rows[-1]) + 2, below[0]))
        facts = self.facts[finer].reshape(*below, VALUES)[children]
        sums = self._sums[own].reshape(*shape, VALUES + 2)
        steps = self._sums[finer].reshape(*below, VALUES + 2)[children, :, STEPS.start :]
        sums[rows, :, STEPS.start :] = _fourfold(np.add, steps)
        ends = np.minimum((rows + 1) << level, self._done.size)
        done = np.concatenate([[0], np.cumsum(self._done)])
        is_exact = done[ends] - done[rows << level] == ends - (rows << level)
        united = np.empty((rows.size, shape[1], VALUES))
        united[:, :, LOWEST] = _fourfold(np.minimum, facts[:, :, LOWEST])
        united[:, :, HIGHEST] = _fourfold(np.maximum, facts[:, :, HIGHEST])
        united[:, :, COUNT] = np.where(
            is_exact[:, None], sums[rows, :, COUNT], self._expected_pixels(level, rows)
        )
        united[:, :, STEPS] = _mean_steps(sums[rows])
        united[:, :, POINTS] = _fourfold(np.add, facts[:, :, POINTS])
        self.facts[own].reshape(*shape, VALUES)[rows] = united

    def _in_metres(self, sums: Floats) -> Floats:
        metres = self._coordinates.quantisation.metres
        facts = sums[..., :VALUES].copy()
        facts[..., LOWEST] = metres(facts[..., LOWEST])
        facts[..., HIGHEST] = metres(facts[..., HIGHEST])
        facts[..., STEPS] = _mean_steps(sums)
        return facts

    def _expected_pixels(self, level: int, rows: Integers) -> Floats:
        """How many pixels of rows of tiles may be filled: (rows, tile columns)."""
        size = TILE << level
        firsts, ends = rows << level, np.minimum((rows + 1) << level, self._done.size)
        points = (self._ends[ends] - self._ends[firsts]).astype(np.float64)
        left = np.arange(self._shapes[level][1]) * size
        share = np.clip(self._image.width - left, 0, size) / max(self._image.width, 1)
        expected = np.ceil(points[:, None] * share / 4.0**level)
        pixels: Floats = np.minimum(expected, float(TILE * TILE))
        return pixels

    def _sketch_bounds(self) -> Floats:
        """(tile rows, tile columns, 6): where tiles may be, by the rows between them.

        1. Take the rows at which rows of tiles meet, fewer of a very long recording.
        2. A row of tiles lies between the two rows at its ends, or those beyond, with some room;
           so does each of its tiles, with the whole row's points where it has none of its own.
        """
        tiles, columns = self._shapes[0]
        filled = np.flatnonzero(np.diff(self._image.row_starts) > 0)
        if not filled.size:
            return _nowhere((tiles, columns))
        every = -(-tiles // _MOST_SAMPLES)
        wanted = np.append(np.arange(0, tiles, every) * TILE, self._image.rows - 1)
        positions = np.minimum(np.searchsorted(filled, wanted), filled.size - 1)
        samples = np.stack([self._bounds_of_row(int(row)) for row in filled[positions]])
        empty = ~np.isfinite(samples[:, :, 0])
        whole = np.concatenate(
            [samples[:, :, :3].min(axis=1), samples[:, :, 3:].max(axis=1)], axis=1
        )
        samples[empty] = np.repeat(whole[:, None], columns, axis=1)[empty]
        before = np.arange(tiles) // every
        low = np.minimum(samples[before, :, :3], samples[before + 1, :, :3])
        high = np.maximum(samples[before, :, 3:], samples[before + 1, :, 3:])
        room = _LEAST_ROOM_M + _ROOM * np.linalg.norm(high - low, axis=2, keepdims=True)
        bounds = np.concatenate([low - room, high + room], axis=2)
        bounds[np.diff(self._ends) == 0] = _nowhere((1, columns))
        return bounds

    def _bounds_of_row(self, row: int) -> Floats:
        """(tile columns, 6): where the points of one row are, by their tile."""
        start, stop = self._image.row_starts[row : row + 2].tolist()
        # So few points are mapped: a file need not be opened for each row.
        xyz = self._coordinates.xyz(slice(start, stop))
        # Columns don't fall within a row.
        tiles, firsts = np.unique(self._image.columns_of(start, stop) // TILE, return_index=True)
        bounds: Floats = _nowhere((1, self._shapes[0][1]))[0]
        bounds[tiles, :3] = np.minimum.reduceat(xyz, firsts)
        bounds[tiles, 3:] = np.maximum.reduceat(xyz, firsts)
        return bounds


def _nowhere(shape: tuple[int, int]) -> Floats:
    bounds = np.full((*shape, 6), np.inf)
    bounds[:, :, 3:] = -np.inf
    return bounds


def _mean_steps(sums: Floats) -> Floats:
    # The square of the mean root is less moved by jumps between objects than the mean.
    totals, weights = sums[..., STEPS], sums[..., VALUES:]
    means: Floats = np.divide(totals, weights, out=np.zeros_like(totals), where=weights > 0)
    squares: Floats = means * means
    return squares


def _fourfold(unite: np.ufunc, values: Floats) -> Floats:
    """Two rows and two columns become one; what is left over at the ends as well."""
    of_rows = unite.reduceat(values, np.arange(0, values.shape[0], 2), axis=0)
    united: Floats = unite.reduceat(of_rows, np.arange(0, values.shape[1], 2), axis=1)
    return united


def _runs(numbers: Integers) -> Iterator[tuple[int, int]]:
    """First and end of the stretches of consecutive numbers among rising ones."""
    breaks = np.flatnonzero(np.diff(numbers) > 1) + 1
    for run in np.split(numbers, breaks):
        if run.size:
            yield int(run[0]), int(run[-1]) + 1


def _row_stretches(row_starts: Integers, rows: range, points: int) -> Iterator[range]:
    """Consecutive rows with about so many points each, cut where no distance is taken across."""
    first = rows.start
    while first < rows.stop:
        wanted = int(np.searchsorted(row_starts, row_starts[first] + points, side="right")) - 1
        end = max(first + _ROWS_TOGETHER, wanted // _ROWS_TOGETHER * _ROWS_TOGETHER)
        yield range(first, min(end, rows.stop))
        first = end
