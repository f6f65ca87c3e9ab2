"""How steep the faces of steps are: earth leans, a built wall stands upright."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.ground.filters.cell_positions import Blocks
from processing.methods.ground.filters.cells import CellGrid

_UPRIGHT_DEG = 85.0
"""From here up a face is a wall and no ground. Built walls lean back by 1:0.1 (84°) at most, most
less; the earth of three sites leaned 40 to 82°. The ground study draws the line at 80° (Sakurai
et al., section 3(2)a): there one cut face of those sites was lost, here none."""

_UNIT_M = 1e-4
"""Positions are summed in whole units of this size, which add up to the same in any order."""

_WINDOW_M = 2.0
"""Side of the window whose points say how steep a face is: several cells along it, and short
enough that it hardly turns."""

_LEAST_POINTS = 8
"""Points of a window for a slope: the standard error of a slope from eight is a third of the
scatter over the height that they span."""


class FaceRange(NamedTuple):
    """Heights between which a cell's points lie on a face, m: (rows, columns); low > high: none."""

    low: NDArray[np.float32]
    high: NDArray[np.float32]


class _Moments(NamedTuple):
    """Sums over the points of each cell: how many, x, y, z, x z, y z, z z, in ``_UNIT_M``."""

    points: NDArray[np.int64]
    sums: NDArray[np.int64]
    products: NDArray[np.int64]


def upright_faces(blocks: Blocks, grid: CellGrid, face: FaceRange) -> NDArray[np.bool_]:
    """Cells whose faces stand upright: (rows, columns) bool.

    Parameters
    ----------
    face : FaceRange
        Where points of faces are looked for, m above the grid's origin.

    Notes
    -----
    The plan position of a face's points is fitted by a line over their height, within each cell,
    and the cells of a window together: its run over its rise is the cotangent of the inclination.
    Within cells, since those along a face lie beside each other, not above.
    """
    import cv2

    chosen = face.high > face.low
    if not chosen.any():
        return chosen
    shape = chosen.shape
    moments = _Moments(
        np.zeros(shape, np.int64), np.zeros((3, *shape), np.int64), np.zeros((3, *shape), np.int64)
    )
    for xyz in blocks():
        _moments_kernel(np.ascontiguousarray(xyz), grid.origin, grid.size_m, face, moments)
    count = np.maximum(moments.points, 1)
    x, y, z = moments.sums.astype(np.float64)
    centred = moments.products - np.stack((x, y, z)) * z / count
    side = 2 * round(_WINDOW_M / grid.size_m / 2) + 1
    number, *around = (
        cv2.boxFilter(one.astype(np.float64), cv2.CV_64F, (side, side), normalize=False)
        for one in (moments.points, *centred)
    )
    run = np.hypot(around[0], around[1])
    upright: NDArray[np.bool_] = (
        chosen & (number >= _LEAST_POINTS) & (run * np.tan(np.radians(_UPRIGHT_DEG)) < around[2])
    )
    return upright


@kernel
def _moments_kernel(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    size_m: float,
    face: FaceRange,
    moments: _Moments,
) -> None:
    rows, columns = face.low.shape
    for point in range(xyz.shape[0]):
        x = (xyz[point, 0] - origin[0]) / size_m
        y = (xyz[point, 1] - origin[1]) / size_m
        z = xyz[point, 2] - origin[2]
        if np.isfinite(z) and 0.0 <= x < columns and 0.0 <= y < rows:
            row, column = int(y), int(x)
            low = face.low[row, column]
            if low < z < face.high[row, column]:
                east = int(np.rint((x - column) * size_m / _UNIT_M))
                north = int(np.rint((y - row) * size_m / _UNIT_M))
                up = int(np.rint((z - low) / _UNIT_M))
                moments.points[row, column] += 1
                moments.sums[0, row, column] += east
                moments.sums[1, row, column] += north
                moments.sums[2, row, column] += up
                moments.products[0, row, column] += east * up
                moments.products[1, row, column] += north * up
                moments.products[2, row, column] += up * up


def warm_up() -> None:
    """Compile the kernel of this file."""
    one = np.ones((1, 1), np.float32)
    grid = CellGrid(np.zeros(3), 1.0, 1, 1)
    upright_faces(lambda: [np.array([[0.5, 0.5, 0.5]])], grid, FaceRange(0 * one, one))
