"""The lowest point of each cell: the published baseline, strict and with a tolerance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.errors import OutOfRange
from processing.ground.cells import Blocks
from processing.text import Text


class LowestPoints:
    """The lowest point of each key, of points that come block by block; the first of equal ones.

    Parameters
    ----------
    parts : int
        Whole numbers that make a key.

    Attributes
    ----------
    keys : (m, parts) int64
        Each once, in rising order, the last number changing slowest.
    xyz : (m, 3) float64
    numbers : (m,) int64
        As they were given.
    """

    def __init__(self, parts: int) -> None:
        self.keys = np.empty((0, parts), np.int64)
        self.xyz = np.empty((0, 3))
        self.numbers = np.empty(0, np.int64)

    def add(
        self, keys: NDArray[np.int64], xyz: NDArray[np.float64], numbers: NDArray[np.int64]
    ) -> None:
        """Take in a block; how points are cut into blocks changes nothing."""
        chosen = _lowest_of(keys, xyz[:, 2])
        keys = np.concatenate([self.keys, keys[chosen]])
        xyz = np.concatenate([self.xyz, xyz[chosen]])
        numbers = np.concatenate([self.numbers, numbers[chosen]])
        chosen = _lowest_of(keys, xyz[:, 2])
        self.keys, self.xyz, self.numbers = keys[chosen], xyz[chosen], numbers[chosen]


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
        width = int(self.lowest.keys[:, 0].max()) + 1
        cells = _cells(xyz[finite], self.start, self.cell_m)
        held = self.lowest.keys[:, 1] * width + self.lowest.keys[:, 0]
        wanted = cells[:, 1] * width + cells[:, 0]
        place = np.minimum(np.searchsorted(held, wanted), len(held) - 1)
        known = np.all(self.lowest.keys[place] == cells, axis=1)
        kept, place = finite[known], place[known]
        above[kept] = xyz[kept, 2] - self.lowest.xyz[place, 2]
        return above


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
        places = xyz[np.isfinite(xyz).all(axis=1), :2]
        if len(places):
            start = np.minimum(start, places.min(axis=0))
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


def require_points(blocks: Blocks, least: int) -> None:
    """Raise when there are too few points with finite coordinates.

    Raises
    ------
    OutOfRange
    """
    count = sum(int(np.isfinite(xyz).all(axis=1).sum()) for xyz in blocks())
    if count < least:
        raise OutOfRange(
            Text(
                f"Ground needs at least {least} points at different places; there are {count}.",
                f"地面の抽出には位置の異なる{least}点以上が必要です（有効な点：{count}）。",
            ),
            Text("The whole cloud", "点群全体"),
            Text("Choose a cloud with more points.", "点数の多い点群を選んでください。"),
        )
