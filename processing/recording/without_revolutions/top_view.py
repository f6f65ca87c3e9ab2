"""Top-view cells: what stands in for rows and pulses where a cloud has no revolutions.

A cell of a square grid plays the pulse, a strip of cells the row, so the same image, tiles and
views carry clouds of every origin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_LEAST_CELL_M = 1e-3
"""Cells are no smaller: coordinates are in millimetres."""

_MOST_CELLS = 1e10
"""More would not fit into memory, as facts of their tiles."""

_MOST_ACROSS = 1e7
"""Cells across: rows and columns of tiles stay far below what 32 bits count."""

_EDGE_SLACK = 1e-9
"""Of a cell: a side of whole cells has no more of them for the rounding of a division."""

_COARSEST, _FINEST = 7, 24
"""Levels of division that are tried: 2 to the power of so many cells across."""

_POINTS_TO_GO_FINER = 8
"""Points of a sample for each filled cell from which cells may be finer: with fewer an emptier cell
is chance. By trial; no measurement is recorded."""

_ODD_SHARE = 0.001
"""Share of points at each side that are left out of the extent: strays."""

_LEAST_SAMPLE = 1_000
"""Of fewer points all count."""


@dataclass(frozen=True)
class TopView:
    """A grid of square cells seen from above, north up.

    Attributes
    ----------
    west, north : float
        Easting of the left edge, northing of the upper edge, metres.
    cell_m : float
    cells_per_row, rows : int
        A point outside is in the nearest cell at the edge.
    """

    west: float
    north: float
    cell_m: float
    cells_per_row: int
    rows: int

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
        np.clip(rows, 0, self.rows - 1, out=rows)
        return np.asarray(rows * self.cells_per_row + columns)


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

    Notes
    -----
    1. The grid covers the points but for odd ones: what one point in a thousand at either end
       spreads over is left out where it is more than half of what the others need.
    2. The area of the points is that of the filled cells of a coarse grid over the sample, made
       finer as long as its filled cells hold several points.
    3. A cell is the share of a point in that area.
    """
    low, high = _without_odd_points(sample[:, :2], lowest[:2], highest[:2])
    width, height = (max(float(side), _LEAST_CELL_M) for side in high - low)
    area = _covered_area(sample[:, :2] - low, width, height)
    cell_m = math.sqrt(area / max(count, 1))
    # What tiles need grows with the cells, filled or not; long strips may have fine ones.
    cell_m = max(cell_m, math.sqrt(width * height / _MOST_CELLS), _LEAST_CELL_M)
    cell_m = max(cell_m, max(width, height) / _MOST_ACROSS)
    # Points on the outer edges are in the last cells.
    columns, rows = (math.ceil(side / cell_m - _EDGE_SLACK) for side in (width, height))
    return TopView(float(low[0]), float(high[1]), cell_m, columns, rows)


def _without_odd_points(
    sample: NDArray[np.float64], lowest: NDArray[np.float64], highest: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    if sample.shape[0] < _LEAST_SAMPLE:
        return lowest, highest
    ends = np.quantile(sample, [_ODD_SHARE, 1 - _ODD_SHARE], axis=0)
    margin = (ends[1] - ends[0]) / 2
    return np.maximum(lowest, ends[0] - margin), np.minimum(highest, ends[1] + margin)


def _covered_area(positions: NDArray[np.float64], width: float, height: float) -> float:
    """m² of a plan that points cover, from a sample of them."""
    area = width * height
    for level in range(_COARSEST, _FINEST):
        side = max(width, height) / 2**level
        columns = int(width / side) + 1
        across, down = (np.floor(axis / side).astype(np.int64) for axis in positions.T)
        inside = (across >= 0) & (down >= 0) & (across * side <= width) & (down * side <= height)
        filled = np.unique(down[inside] * columns + across[inside]).size
        if level > _COARSEST and inside.sum() < _POINTS_TO_GO_FINER * filled:
            return area
        area = min(area, filled * side * side)
    return area
