"""Points in the order of nested cells: one sort serves every cell size."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.kernels import kernel

_BITS = 20
_SMALLEST_M = 1e-3


@dataclass(frozen=True)
class NestedCells:
    """Points sorted along a curve through nested cubes.

    At level 0 a cube has the side ``cell_m``; eight cubes of one level make one of the next, and
    the points of a cube of any level are consecutive.

    Attributes
    ----------
    order : (n,) int64
        Index of the input point at each place of the curve.
    codes : (n,) int64
        Cube number of level 0; not decreasing. ``codes >> 3 * level`` numbers larger cubes.
    local_xyz : (n, 3) float64
        m from ``origin``, along the curve.
    origin : (3,) float64
        The lowest corner.
    cell_m : float
    """

    order: NDArray[np.int64]
    codes: NDArray[np.int64]
    local_xyz: NDArray[np.float64]
    origin: NDArray[np.float64]
    cell_m: float


def nested_cells(xyz: NDArray[np.float64], cell_m: float) -> NestedCells:
    """Sort points into nested cells.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, finite.
    cell_m : float
        Side of the smallest cubes; enlarged where the extent would need more than 2^20 of them.
    """
    origin = xyz.min(axis=0) if xyz.shape[0] else np.zeros(3)
    extent = float(np.ptp(xyz, axis=0).max(initial=0.0)) if xyz.shape[0] else 0.0
    side = max(cell_m, _SMALLEST_M, extent / (2**_BITS - 2))
    codes = np.empty(xyz.shape[0], np.int64)
    codes_kernel(np.ascontiguousarray(xyz), origin, side, codes)
    order = np.argsort(codes)
    return NestedCells(order, codes[order], xyz[order] - origin, origin, side)


@kernel
def codes_kernel(
    xyz: NDArray[np.float64], origin: NDArray[np.float64], side: float, codes: NDArray[np.int64]
) -> None:
    """Number of the cube of every point, the bits of its three indices interleaved."""
    for point in range(xyz.shape[0]):
        code = 0
        for axis in range(3):
            value = int((xyz[point, axis] - origin[axis]) / side)
            value = (value | (value << 32)) & 0x1F00000000FFFF
            value = (value | (value << 16)) & 0x1F0000FF0000FF
            value = (value | (value << 8)) & 0x100F00F00F00F00F
            value = (value | (value << 4)) & 0x10C30C30C30C30C3
            value = (value | (value << 2)) & 0x1249249249249249
            code |= value << axis
        codes[point] = code


def warm_up() -> None:
    """Compile the kernels."""
    nested_cells(np.zeros((2, 3)), 1.0)
