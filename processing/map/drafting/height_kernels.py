"""The one pass over points that finds those near any place of a line."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel


@kernel
def near_points_kernel(
    xyz: NDArray[np.int32],
    frame: NDArray[np.float64],
    near: NDArray[np.uint8],
    cell_starts: NDArray[np.int64],
    order: NDArray[np.int64],
    positions: NDArray[np.float64],
    reach: NDArray[np.float64],
    owners: NDArray[np.int64],
    offsets: NDArray[np.float64],
) -> int:
    """Pairs of a place and a point within its reach.

    Parameters
    ----------
    xyz : (n, 3) int32
    frame : (7,) float64
        Scale of the integers; their offset about the grid's corner; the cell's size. All in m.
    near : (rows, columns) uint8
        Whether a cell or one of its eight neighbours holds a place.
    cell_starts : (rows · columns + 1,) int64
        Cell c holds the places ``order[cell_starts[c]:cell_starts[c + 1]]``.
    positions : (p, 3) float64
        About the grid's corner.
    reach : (2,) float64
        In plan and in height; the cell is at least as large as the former.
    owners : (k,) int64
        Written: the place of each pair, as far as there is room.
    offsets : (k, 3) float64
        Written: from the place to the point.

    Returns
    -------
    int
        How many pairs there are.
    """
    rows, columns = near.shape
    found = 0
    for point in range(xyz.shape[0]):
        east = xyz[point, 0] * frame[0] + frame[3]
        north = xyz[point, 1] * frame[1] + frame[4]
        column, row = int(np.floor(east / frame[6])), int(np.floor(north / frame[6]))
        if row < 0 or column < 0 or row >= rows or column >= columns or not near[row, column]:
            continue
        height = xyz[point, 2] * frame[2] + frame[5]
        first, last = max(column - 1, 0), min(column + 1, columns - 1)
        for line in range(max(row - 1, 0), min(row + 1, rows - 1) + 1):
            start = cell_starts[line * columns + first]
            for one in range(start, cell_starts[line * columns + last + 1]):
                position = order[one]
                dx, dy = east - positions[position, 0], north - positions[position, 1]
                dz = height - positions[position, 2]
                if dx * dx + dy * dy > reach[0] * reach[0] or abs(dz) > reach[1]:
                    continue
                if found < owners.size:
                    owners[found] = position
                    offsets[found, 0], offsets[found, 1], offsets[found, 2] = dx, dy, dz
                found += 1
    return found


def warm_up() -> None:
    """Compile the kernel."""
    near_points_kernel(
        _read_only(np.zeros((1, 3), np.int32)),
        np.ones(7),
        np.ones((1, 1), np.uint8),
        np.array([0, 1]),
        np.array([0]),
        np.zeros((1, 3)),
        np.array([0.15, 0.5]),
        np.empty(1, np.int64),
        np.empty((1, 3)),
    )


def _read_only(values: NDArray[np.int32]) -> NDArray[np.int32]:
    # Columns of a drive are mapped read-only, which is a type of its own to the compiler.
    values.flags.writeable = False
    return values
