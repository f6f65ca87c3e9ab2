"""Top-view cells: what stands in for rows and pulses where a cloud has no revolutions.

A cell of a square grid plays the pulse, a strip of cells the row, so the same image, tiles and
views carry clouds of every origin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class TopView:
    """A grid of square cells seen from above, north up.

    Attributes
    ----------
    west, north : float
        Easting of the left edge, northing of the upper edge, metres.
    cell_m : float
    cells_per_row : int
    """

    west: float
    north: float
    cell_m: float
    cells_per_row: int

    def cells_of(self, xyz: NDArray[np.float64]) -> NDArray[np.int64]:
        """The cell of every point, row by row from the north-west.

        Parameters
        ----------
        xyz : (n, 3) float64
            m, project CRS.

        Returns
        -------
        (n,) int64
        """
        columns = np.floor((xyz[:, 0] - self.west) / self.cell_m).astype(np.int64)
        rows = np.floor((self.north - xyz[:, 1]) / self.cell_m).astype(np.int64)
        np.clip(columns, 0, self.cells_per_row - 1, out=columns)
        return np.asarray(np.maximum(rows, 0) * self.cells_per_row + columns)


def top_view_of(
    sample: NDArray[np.float64],
    count: int,
    lowest: NDArray[np.float64],
    highest: NDArray[np.float64],
) -> TopView:
    """A grid with about one point in a filled cell.

    Parameters
    ----------
    sample : (k, 3) float64
        Some of the points, evenly drawn.
    count : int
        Number of all points.
    lowest, highest : (3,) float64
        Extent.
    """
    width, height = (max(float(highest[axis] - lowest[axis]), 1e-3) for axis in (0, 1))
    side = 128
    columns = np.minimum(((sample[:, 0] - lowest[0]) / width * side).astype(int), side - 1)
    rows = np.minimum(((sample[:, 1] - lowest[1]) / height * side).astype(int), side - 1)
    filled_share = np.unique(rows * side + columns).size / side**2
    cell_m = math.sqrt(filled_share * width * height / max(count, 1))
    # Not finer than 10,000 times the extent allows: a handful of points needs no vast picture.
    cell_m = max(cell_m, max(width, height) / 100_000, 1e-3)
    return TopView(float(lowest[0]), float(highest[1]), cell_m, int(width / cell_m) + 1)
