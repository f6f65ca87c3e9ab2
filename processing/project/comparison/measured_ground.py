"""Where the drives of a project measured anything, coarsely."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import shapely

from processing.core.arrays import Flags, Floats, Integers
from processing.core.monitor import Monitor
from processing.map.map_extent import Bounds
from processing.recording.drive import Drive

_CELL_M = 2.0
"""Finer than what is looked for on a map is apart, coarser than points lie on ground seen."""

_MOST_POINTS = 1_000_000
"""Of a drive, evenly over its length: with hundreds of points a cell of a street one in a hundred
tells the same."""

_CHUNK = 100_000


class MeasuredGround:
    """Cells of 2 m, with a margin of a cell, in which points were measured.

    Parameters
    ----------
    drives : iterable of Drive
        Without any, every place counts as measured: the map was drawn from something else.

    Raises
    ------
    Cancelled
    """

    def __init__(self, drives: Iterable[Drive], monitor: Monitor) -> None:
        keys = [np.zeros(0, np.int64)]
        lows, highs = [], []
        for drive in drives:
            step = max(1, drive.count // _MOST_POINTS)
            numbers = np.arange(0, drive.count, step)
            for start in range(0, len(numbers), _CHUNK):
                monitor.check()
                xy = drive.xyz(numbers[start : start + _CHUNK])[:, :2]
                keys.append(np.unique(_keys(np.floor(xy / _CELL_M).astype(np.int64))))
                lows.append(xy.min(axis=0))
                highs.append(xy.max(axis=0))
        cells = np.unique(np.concatenate(keys))
        around = [cells + _keys(np.array([[dx, dy]])) for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
        self._cells: Integers = np.unique(np.concatenate(around))
        self.bounds: Bounds | None = None
        if lows:
            (west, south), (east, north) = np.min(lows, axis=0), np.max(highs, axis=0)
            self.bounds = float(west), float(south), float(east), float(north)

    def holds(self, xy: Floats) -> Flags:
        """Of (n, 2) places, m, whether anything was measured there."""
        if not len(self._cells):
            return np.ones(len(xy), dtype=np.bool_)
        found: Flags = np.isin(_keys(np.floor(xy / _CELL_M).astype(np.int64)), self._cells)
        return found

    def bounds_with(self, other: Bounds | None) -> Bounds | None:
        """The extent of what was measured and of something else; None without both."""
        boxes = [one for one in (self.bounds, other) if one is not None]
        if not boxes:
            return None
        west, south, east, north = shapely.total_bounds([shapely.box(*one) for one in boxes])
        return float(west), float(south), float(east), float(north)


def _keys(cells: Integers) -> Integers:
    keys: Integers = cells[:, 0] * (1 << 31) + cells[:, 1]
    return keys
