"""The lowest point of each cell: the published baseline, strict and with a tolerance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.methods.ground.filters.cell_positions import Blocks


class _KeyedPoints(NamedTuple):
    """Points with their keys: (m, parts) keys, (m, 3) coordinates, (m,) numbers."""

    keys: NDArray[np.int64]
    xyz: NDArray[np.float64]
    numbers: NDArray[np.int64]


_MOST_WAITING = 1_000_000
"""Lowest points of blocks that wait to be sorted in, or as many as are held: some 50 MB. Sorting
costs each point about the same then, however many blocks come."""


class LowestPoints:
    """The lowest point of each key, of points that come block by block; the first of equal ones.

    Parameters
    ----------
    parts : int
        Whole numbers that make a key.

    """

    def __init__(self, parts: int) -> None:
        self._held = _KeyedPoints(
            np.empty((0, parts), np.int64), np.empty((0, 3)), np.empty(0, np.int64)
        )
        self._waiting: list[_KeyedPoints] = []

    @property
    def keys(self) -> NDArray[np.int64]:
        """Each once, in rising order, the last number changing slowest: (m, parts)."""
        return self._take_in().keys

    @property
    def xyz(self) -> NDArray[np.float64]:
        """The points in the order of their keys: (m, 3)."""
        return self._take_in().xyz

    @property
    def numbers(self) -> NDArray[np.int64]:
        """Their numbers as they were given: (m,)."""
        return self._take_in().numbers

    @property
    def count_so_far(self) -> int:
        """How many there are at least; asking costs nothing."""
        return len(self._held.keys)

    def add(
        self, keys: NDArray[np.int64], xyz: NDArray[np.float64], numbers: NDArray[np.int64]
    ) -> None:
        """Take in a block; how points are cut into blocks changes nothing."""
        chosen = _lowest_of(keys, xyz[:, 2])
        self._waiting.append(_KeyedPoints(keys[chosen], xyz[chosen], numbers[chosen]))
        # Sorting all that is held for every block would take longer the more is held.
        waiting = sum(len(own.keys) for own in self._waiting)
        if waiting > max(_MOST_WAITING, len(self._held.keys)):
            self._take_in()

    def _take_in(self) -> _KeyedPoints:
        if self._waiting:
            keys, xyz, numbers = (
                np.concatenate(parts) for parts in zip(self._held, *self._waiting, strict=True)
            )
            self._waiting.clear()
            chosen = _lowest_of(keys, xyz[:, 2])
            self._held = _KeyedPoints(keys[chosen], xyz[chosen], numbers[chosen])
        return self._held


def _lowest_of(keys: NDArray[np.int64], heights: NDArray[np.float64]) -> NDArray[np.int64]:
    if not len(keys):
        return np.empty(0, np.int64)
    order = np.lexsort((heights, *keys.T))
    changes = np.any(np.diff(keys[order], axis=0) != 0, axis=1)
    chosen: NDArray[np.int64] = order[np.concatenate(([True], changes))]
    return chosen


@dataclass(frozen=True)
class LowestGround:
    """Lowest heights of cells, and what lies no more than a tolerance above them.

    Attributes
    ----------
    start : (2,) float64
        Corner of the first cell: the lowest easting and northing, so that large coordinates keep
        their digits.
    lowest : LowestPoints
        Keys are column and row of a cell.
    """

    start: NDArray[np.float64]
    cell_m: float
    tolerance_m: float
    lowest: LowestPoints

    def is_ground(self, xyz: NDArray[np.float64], first: int) -> NDArray[np.bool_]:
        """Which points of a block are ground: (n,) bool.

        Parameters
        ----------
        first : int
            Number of the block's first point; without a tolerance one point of a cell is ground.
        """
        is_ground = np.zeros(len(xyz), np.bool_)
        if self.tolerance_m > 0.0:
            with np.errstate(invalid="ignore"):
                is_ground |= self.heights_above(xyz) <= self.tolerance_m
        own = self.lowest.numbers - first
        is_ground[own[(own >= 0) & (own < len(xyz))]] = True
        return is_ground

    def heights_above(self, xyz: NDArray[np.float64]) -> NDArray[np.float64]:
        """Height of points above the lowest of their cells, m: (n,), NaN without coordinates."""
        above = np.full(len(xyz), np.nan)
        finite = np.flatnonzero(np.isfinite(xyz).all(axis=1))
        if not len(self.lowest.numbers):
            return above
        width, held = self._held_cells
        cells = _cells(xyz[finite], self.start, self.cell_m)
        wanted = cells[:, 1] * width + cells[:, 0]
        position = np.minimum(np.searchsorted(held, wanted), len(held) - 1)
        known = np.all(self.lowest.keys[position] == cells, axis=1)
        kept, position = finite[known], position[known]
        above[kept] = xyz[kept, 2] - self.lowest.xyz[position, 2]
        return above

    @cached_property
    def _held_cells(self) -> tuple[int, NDArray[np.int64]]:
        """How many columns there are, and the cells with points, counted along the rows."""
        width = int(self.lowest.keys[:, 0].max()) + 1
        return width, self.lowest.keys[:, 1] * width + self.lowest.keys[:, 0]


def lowest_ground(blocks: Blocks, cell_m: float, tolerance_m: float = 0.0) -> LowestGround:
    """Ground as each cell's lowest point, of a cloud that comes in blocks.

    Parameters
    ----------
    blocks : callable
        Gives the cloud's blocks, each (n, 3) float64, m, afresh at every call; rows that are not
        finite are passed over.
    tolerance_m : float
        0 keeps one point per cell, as the method is described; more keeps a band.
    """
    start = np.full(2, np.inf)
    for xyz in blocks():
        positions = xyz[np.isfinite(xyz).all(axis=1), :2]
        if len(positions):
            start = np.minimum(start, positions.min(axis=0))
    lowest = LowestPoints(2)
    first = 0
    for xyz in blocks():
        finite = np.flatnonzero(np.isfinite(xyz).all(axis=1))
        kept = xyz[finite]
        lowest.add(_cells(kept, start, cell_m), kept, first + finite)
        first += len(xyz)
    return LowestGround(start, cell_m, tolerance_m, lowest)


def _cells(
    xyz: NDArray[np.float64], start: NDArray[np.float64], cell_m: float
) -> NDArray[np.int64]:
    return np.floor((xyz[:, :2] - start) / cell_m).astype(np.int64)
