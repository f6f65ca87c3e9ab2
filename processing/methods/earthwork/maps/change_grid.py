"""ChangeGrid: two grounds on the same cells, and by how much one lies above the other."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from processing.methods.ground.filters.cells import CellGrid


@dataclass(frozen=True)
class ChangeGrid:
    """Ground before and after, on the same cells; row = north, column = east.

    Attributes
    ----------
    grid : CellGrid
        ``origin``: lower left corner of the first cell and the height that others are counted
        from, m, project CRS.
    before, after : (rows, columns) float32
        Mean height of the ground in a cell, m above the grid's origin; NaN without a surface.
    is_measured : (rows, columns) bool
        Both were measured there; elsewhere at least one is filled in, or missing.
    inside : (rows, columns) float32
        Share of the cell within the boundary, 0 to 1.
    """

    grid: CellGrid
    before: NDArray[np.float32]
    after: NDArray[np.float32]
    is_measured: NDArray[np.bool_]
    inside: NDArray[np.float32]

    @cached_property
    def change_m(self) -> NDArray[np.float32]:
        """By how much ``after`` lies above ``before``, m: (rows, columns) float32, NaN outside."""
        change: NDArray[np.float32] = np.where(self.inside > 0, self.after - self.before, np.nan)
        return change.astype(np.float32, copy=False)

    def change_at(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        """Change in the cell that holds each position: (n,) float64, m; NaN where there is none.

        Parameters
        ----------
        xy : (n, 2) float64
            m, project CRS.
        """
        positions = np.floor((xy - self.grid.origin[:2]) / self.grid.size_m)
        is_in = np.all((positions >= 0) & (positions < [self.grid.columns, self.grid.rows]), axis=1)
        found = np.full(len(xy), np.nan)
        column, row = positions[is_in].astype(np.int64).T
        found[is_in] = self.change_m[row, column]
        return found
