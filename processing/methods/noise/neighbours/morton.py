"""Points in the order of nested cells: one sort serves every cell size."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.monitor import Monitor, SilentMonitor
from processing.methods.noise.neighbours.key_order import order_by_key
from processing.methods.noise.neighbours.sharing import share_out

_BITS = 20
"""Binary digits along an axis: three of them fit a 64-bit number."""

_SMALLEST_M = 1e-3
"""Side of the smallest cubes: what scanners resolve."""

_POINTS_AT_ONCE = 250_000
"""Points of a share of a core's work."""

_NOWHERE = 1 << 60
"""The number of points that aren't finite: above those of all cubes."""


@dataclass(frozen=True)
class NestedCells:
    """Points sorted along a curve through nested cubes.

    At level 0 a cube has the side ``cell_m``; eight cubes of one level make one of the next, and
    the points of a cube of any level are consecutive.

    Attributes
    ----------
    order : (n,) int64
        Index of the input point at each position of the curve.
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
    """Sort the finite points into nested cells.

    Parameters
    ----------
    xyz : (n, 3) float64
        m; points that aren't finite are left out.
    cell_m : float
        Side of the smallest cubes; enlarged where the extent would need more than 2^20 of them.
    """
    monitor = SilentMonitor()
    xyz = np.ascontiguousarray(xyz)
    origin, extent = _origin_and_extent(xyz, monitor)
    side = max(cell_m, _SMALLEST_M, extent / (2**_BITS - 2))
    codes = np.empty(xyz.shape[0], np.int64)

    def number(start: int, stop: int) -> None:
        codes_kernel(xyz[start:stop], origin, side, codes[start:stop])

    share_out(number, xyz.shape[0], _POINTS_AT_ONCE, monitor)
    codes, order = order_by_key(codes, monitor)
    finite = int(np.searchsorted(codes, _NOWHERE))
    codes, order = codes[:finite], order[:finite]
    local_xyz = np.empty((finite, 3))

    def bring(start: int, stop: int) -> None:
        bring_kernel(xyz, origin, order[start:stop], local_xyz[start:stop])

    share_out(bring, finite, _POINTS_AT_ONCE, monitor)
    return NestedCells(order, codes, local_xyz, origin, side)


def _origin_and_extent(
    xyz: NDArray[np.float64], monitor: Monitor
) -> tuple[NDArray[np.float64], float]:
    """The lowest corner of the finite points, and their extent along the longest axis, m."""
    shares = xyz.shape[0] // _POINTS_AT_ONCE + 1
    lows, highs = np.full((shares, 3), np.inf), np.full((shares, 3), -np.inf)

    def look(start: int, stop: int) -> None:
        share = start // _POINTS_AT_ONCE
        extent_kernel(xyz[start:stop], lows[share], highs[share])

    share_out(look, xyz.shape[0], _POINTS_AT_ONCE, monitor)
    low, high = lows.min(axis=0), highs.max(axis=0)
    return (low, float((high - low).max())) if (low <= high).all() else (np.zeros(3), 0.0)


@kernel
def extent_kernel(
    xyz: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]
) -> None:
    """Widen an extent by the finite points."""
    for point in range(xyz.shape[0]):
        x, y, z = xyz[point, 0], xyz[point, 1], xyz[point, 2]
        if np.isfinite(x + y + z):
            low[0], low[1], low[2] = min(low[0], x), min(low[1], y), min(low[2], z)
            high[0], high[1], high[2] = max(high[0], x), max(high[1], y), max(high[2], z)


@kernel
def codes_kernel(
    xyz: NDArray[np.float64], origin: NDArray[np.float64], side: float, codes: NDArray[np.int64]
) -> None:
    """Number of the cube of every point, the bits of its three indices interleaved."""
    for point in range(xyz.shape[0]):
        if not np.isfinite(xyz[point, 0] + xyz[point, 1] + xyz[point, 2]):
            codes[point] = _NOWHERE
            continue
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


@kernel
def bring_kernel(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    order: NDArray[np.int64],
    local_xyz: NDArray[np.float64],
) -> None:
    """Points in an order, from an origin."""
    for position in range(order.size):
        for axis in range(3):
            local_xyz[position, axis] = xyz[order[position], axis] - origin[axis]


def warm_up() -> None:
    """Compile the kernels."""
    nested_cells(np.zeros((2, 3)), 1.0)
