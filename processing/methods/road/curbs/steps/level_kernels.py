"""Loops over scanlines that tell the height of the ground at even places across."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_LOWEST_M = 0.06
"""What lies so near above the lowest point of a cell is ground with it: cells are 10 cm wide, and a
face of 3 cm and more stands out of the mean less than points of plants would. By trial."""


class LevelGrid(NamedTuple):
    """Even places across: how far the first is to the left of 0, and how far apart they are; m."""

    half_m: float
    spacing_m: float


@kernel
def levels_kernel(
    across: _Floats, height: _Floats, starts: _Integers, grid: LevelGrid, levels: _Floats
) -> None:
    """Mean height of what lies lowest at each place.

    Parameters
    ----------
    across, height : (n,)
        Vertices, left to right, m.
    starts : (s + 1,)
        Where the scanlines begin.
    grid : LevelGrid
    levels : (s, k)
        Filled; NaN where nothing was measured.
    """
    half, spacing = grid.half_m, grid.spacing_m
    cells = levels.shape[1]
    low, counts = np.empty(cells), np.empty(cells)
    for section in range(starts.size - 1):
        row = levels[section]
        low[:] = math.inf
        counts[:] = 0.0
        row[:] = 0.0
        for i in range(starts[section], starts[section + 1]):
            cell = math.floor((across[i] + half) / spacing + 0.5)
            if 0 <= cell < cells:
                low[cell] = min(low[cell], height[i])
        for i in range(starts[section], starts[section + 1]):
            cell = math.floor((across[i] + half) / spacing + 0.5)
            if 0 <= cell < cells and height[i] <= low[cell] + _LOWEST_M:
                counts[cell] += 1.0
                row[cell] += height[i]
        for cell in range(cells):
            row[cell] = row[cell] / counts[cell] if counts[cell] > 0 else math.nan


def warm_up() -> None:
    """Compile the kernel."""
    positions = np.linspace(-1.0, 1.0, 5)
    levels_kernel(positions, positions, np.array([0, 5]), LevelGrid(1.0, 0.5), np.empty((1, 5)))
