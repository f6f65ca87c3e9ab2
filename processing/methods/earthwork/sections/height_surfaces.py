"""Grounds that know their height at a position: what sections are cut through."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from processing.methods.ground.filters.band import heights_at
from processing.methods.ground.filters.cells import CellGrid

Floats = NDArray[np.float64]


class HeightSurface(Protocol):
    """A ground that knows its height at a position."""

    def heights_at(self, xy: Floats) -> Floats:
        """Heights at positions (n, 2): (n,) float64, m; NaN where there is no ground."""


@dataclass(frozen=True)
class LevelSurface:
    """A ground that is at one height everywhere.

    Attributes
    ----------
    height_m : float
    """

    height_m: float

    def heights_at(self, xy: Floats) -> Floats:
        """The height, for each position: (n,) float64, m."""
        return np.full(len(xy), self.height_m)


@dataclass(frozen=True)
class GridSurface:
    """A ground of cells, as both of a ``ChangeGrid`` are.

    Attributes
    ----------
    grid : CellGrid
    heights : (rows, columns) float32
        Of the middles of cells, m above the grid's origin; NaN without ground.
    """

    grid: CellGrid
    heights: NDArray[np.float32]

    def heights_at(self, xy: Floats) -> Floats:
        """Between the middles of four cells; beside a hole that of the cell itself: (n,), m."""
        found = heights_at(xy, self.grid, self.heights)
        positions = np.floor((xy - self.grid.origin[:2]) / self.grid.size_m)
        is_in = np.all((positions >= 0) & (positions < [self.grid.columns, self.grid.rows]), axis=1)
        beside = np.flatnonzero(np.isnan(found) & is_in)
        column, row = positions[beside].astype(np.int64).T
        found[beside] = self.heights[row, column] + self.grid.origin[2]
        return found
