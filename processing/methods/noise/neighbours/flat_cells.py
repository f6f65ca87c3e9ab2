"""Points in equal cells: each cell's points follow each other, and so do a column's cells."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.monitor import Monitor, SilentMonitor
from processing.methods.noise.neighbours.key_order import order_by_key
from processing.methods.noise.neighbours.sharing import share_out

_CLIP = 2**19 - 4
"""Cells from the middle to the last one: three axes of 20 binary digits, with room for a search
beyond, fit a 64-bit key."""

_BESIDE = 2
"""Cells that a search looks to either side: a radius is less than two of its cells."""

_POINTS_AT_ONCE = 250_000
"""Points of a share of a core's work."""

_SAMPLE = 1_000
"""Points whose median is the middle; it need not be sure."""


class FlatCells(NamedTuple):
    """Occupied cells of finite points.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, as they came, in the order of their cells.
    order : (n,) int64
        Where they came from.
    keys : (c,) int64
        Rising; cells above each other differ by one.
    starts : (c + 1,) int64
        Into the ordered points.
    is_border : (c,) bool
        Cells into which far points were put, so that they may be larger than a cell.
    along, across : int
        What one cell further along x, along y adds to a key.
    """

    xyz: NDArray[np.float64]
    order: NDArray[np.int64]
    keys: NDArray[np.int64]
    starts: NDArray[np.int64]
    is_border: NDArray[np.bool_]
    along: int
    across: int


def flat_cells(xyz: NDArray[np.float64], side_m: float, monitor: Monitor) -> FlatCells:
    """Sort the finite points into cells.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.
    side_m : float
        Side of a cell. Points more than some 500,000 cells from the middle count to the last one.
    """
    xyz = np.ascontiguousarray(xyz)
    middle = _middle(xyz)
    ranges = np.tile([_CLIP, -_CLIP], (xyz.shape[0] // _POINTS_AT_ONCE + 1, 3)).astype(np.int64)

    def look(start: int, stop: int) -> None:
        ranges_kernel(xyz, middle, side_m, start, stop, ranges[start // _POINTS_AT_ONCE])

    share_out(look, xyz.shape[0], _POINTS_AT_ONCE, monitor)
    low, high = ranges[:, ::2].min(axis=0) - _BESIDE, ranges[:, 1::2].max(axis=0) + _BESIDE
    sizes = np.maximum(high - low + 1, 1)
    keys = np.empty(xyz.shape[0], np.int64)

    def number(start: int, stop: int) -> None:
        keys_kernel(xyz, middle, side_m, low, sizes, start, stop, keys)

    share_out(number, xyz.shape[0], _POINTS_AT_ONCE, monitor)
    keys, order = order_by_key(keys, monitor)
    finite = int(np.searchsorted(keys, int(sizes.prod())))
    keys, order = keys[:finite], order[:finite]
    firsts = np.flatnonzero(np.r_[True, keys[1:] != keys[:-1]]) if finite else np.zeros(0, np.int64)
    cell_keys = keys[firsts]
    across, along = int(sizes[2]), int(sizes[1] * sizes[2])
    indices = [cell_keys // along, cell_keys % along // across, cell_keys % across]
    is_border = np.zeros(firsts.size, np.bool_)
    for axis in range(3):
        is_border |= np.abs(indices[axis] + low[axis]) >= _CLIP
    # Coordinates as they came: distances are the same to the bit in whatever part of a cloud.
    ordered = np.take(xyz, order, axis=0)
    starts = np.r_[firsts, finite]
    return FlatCells(ordered, order, cell_keys, starts, is_border, along, across)


def _middle(xyz: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3,) m: about the middle of most points, whatever a few of them are."""
    sample = xyz[:: max(1, xyz.shape[0] // _SAMPLE)]
    sample = sample[np.isfinite(sample).all(axis=1)]
    return np.median(sample, axis=0) if sample.size else np.zeros(3)


@kernel
def ranges_kernel(
    xyz: NDArray[np.float64],
    middle: NDArray[np.float64],
    side: float,
    start: int,
    stop: int,
    ranges: NDArray[np.int64],
) -> None:
    """Lowest and highest index along each axis, (6,), of the finite points of a range."""
    for point in range(start, stop):
        for axis in range(3):
            position = np.floor((xyz[point, axis] - middle[axis]) / side)
            if np.isfinite(position):
                index = int(min(max(position, -_CLIP), _CLIP))
                ranges[2 * axis] = min(ranges[2 * axis], index)
                ranges[2 * axis + 1] = max(ranges[2 * axis + 1], index)


@kernel
def keys_kernel(
    xyz: NDArray[np.float64],
    middle: NDArray[np.float64],
    side: float,
    low: NDArray[np.int64],
    sizes: NDArray[np.int64],
    start: int,
    stop: int,
    keys: NDArray[np.int64],
) -> None:
    """Number of the cell of each point; of a point that isn't finite, one above all."""
    for point in range(start, stop):
        key = 0
        is_finite = True
        for axis in range(3):
            position = np.floor((xyz[point, axis] - middle[axis]) / side)
            is_finite &= np.isfinite(position)
            index = int(min(max(position, -_CLIP), _CLIP)) if is_finite else 0
            key = key * sizes[axis] + index - low[axis]
        keys[point] = key if is_finite else sizes[0] * sizes[1] * sizes[2]


def warm_up() -> None:
    """Compile the kernels."""
    flat_cells(np.zeros((2, 3)), 1.0, SilentMonitor())
