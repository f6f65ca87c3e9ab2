"""What the squares of 25 cm hold that points lie in, seen from above (Takahashi 2022, 4.4.3)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.recording.columns.point_features import CELL_FEATURES

CELL_M = 0.25
"""Side of a square; squares begin at whole multiples of it in the project's system."""

CELL = len(CELL_FEATURES)
"""Columns of what is found."""


def cell_features(xyz: Floats, own: int) -> NDArray[np.float32]:
    """Number of points, range and deviation of heights, height over the lowest.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, project CRS; finite. All points of the squares that the first ``own`` lie in.

    Returns
    -------
    (own, 4) float32
    """
    squares = np.floor(xyz[:, :2] / CELL_M).astype(np.int64)
    squares -= squares.min(axis=0)
    numbers = squares[:, 0] * (int(squares[:, 1].max()) + 1) + squares[:, 1]
    used, square_of = np.unique(numbers, return_inverse=True)
    sums = np.zeros((used.size, 3))
    low, high = np.full(used.size, np.inf), np.full(used.size, -np.inf)
    heights = np.ascontiguousarray(xyz[:, 2] - xyz[0, 2])
    found = np.empty((own, CELL), np.float32)
    squares_kernel(heights, square_of.reshape(-1), (sums, low, high), found)
    return found


@kernel
def squares_kernel(
    heights: Floats,
    square_of: Integers,
    squares: tuple[Floats, Floats, Floats],
    found: NDArray[np.float32],
) -> None:
    """Features of the first points; ``squares``: sums (s, 3) zero, lowest and highest (s,)."""
    sums, low, high = squares
    for point in range(heights.size):
        square, z = square_of[point], heights[point]
        sums[square, 0] += 1.0
        sums[square, 1] += z
        sums[square, 2] += z * z
        low[square], high[square] = min(low[square], z), max(high[square], z)
    for point in range(found.shape[0]):
        square = square_of[point]
        count = sums[square, 0]
        mean = sums[square, 1] / count
        found[point, 0] = count
        found[point, 1] = high[square] - low[square]
        found[point, 2] = np.sqrt(max(sums[square, 2] / count - mean * mean, 0.0))
        found[point, 3] = heights[point] - low[square]


def warm_up() -> None:
    """Compile the kernel."""
    cell_features(np.zeros((2, 3)), 2)
