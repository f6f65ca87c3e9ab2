"""Radius outlier removal: a point with too few others within a radius is noise.

After the road-surface study: a point is noise when its sphere of 0.5 m holds at most 113 points.
The point itself counts, as it does in Open3D and PCL, so that the three agree point by point.

1. Cells with a diagonal below the radius: more than N points in one cell keep each other, and no
   distance is measured.
2. Elsewhere the points of the cells around are measured, nearest cell first, until more than N
   are found.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.kernels import kernel
from processing.monitor import Monitor, SilentMonitor
from processing.noise.sharing import shared_out

RADIUS_M = 0.5
NEIGHBOURS = 113

_CLIP = 2**20 - 2
_CELLS_AT_ONCE = 4_096


class FlatCells(NamedTuple):
    """Occupied cells, with the places that find them.

    ``starts``: (c + 1,) into the sorted points; ``keys``: (c,) rising; ``is_border``: (c,) cells
    into which far points were put, so that they may be larger than a cell.
    """

    xyz: NDArray[np.float64]
    keys: NDArray[np.int64]
    starts: NDArray[np.int64]
    is_border: NDArray[np.bool_]


def radius_outliers(
    xyz: NDArray[np.float64],
    radius_m: float = RADIUS_M,
    neighbours: int = NEIGHBOURS,
    *,
    counts_itself: bool = True,
    monitor: Monitor | None = None,
) -> NDArray[np.bool_]:
    """Points with at most so many points within a radius.

    Parameters
    ----------
    xyz : (n, 3) float64
        m. Points that aren't finite are outliers.
    radius_m : float
        Points at exactly this distance don't count, as in Open3D.
    neighbours : int
        A point is an outlier when it has this many or fewer.
    counts_itself : bool
        Whether a point is one of its own neighbours.
    monitor : Monitor, optional

    Returns
    -------
    (n,) bool
    """
    outliers = np.ones(xyz.shape[0], bool)
    finite = np.flatnonzero(np.isfinite(xyz).all(axis=1))
    if not finite.size:
        return outliers
    cells, order = _flat_cells(xyz[finite], radius_m / np.sqrt(3.0) * (1 - 1e-9))
    found = np.zeros(finite.size, np.bool_)
    offsets, reach = _offsets_by_distance()
    limit = neighbours if counts_itself else neighbours + 1

    def count(start: int, stop: int) -> None:
        radius_kernel(cells, offsets, reach, radius_m, limit, start, stop, found)

    shared_out(count, cells.keys.size, _CELLS_AT_ONCE, monitor or SilentMonitor())
    outliers[finite[order]] = found
    return outliers


def _flat_cells(xyz: NDArray[np.float64], side: float) -> tuple[FlatCells, NDArray[np.int64]]:
    middle = np.median(xyz, axis=0)
    indices = np.floor((xyz - middle) / side)
    is_far = np.abs(indices).max(axis=1) >= _CLIP // 2
    whole = np.clip(indices, -_CLIP // 2, _CLIP // 2).astype(np.int64) + _CLIP // 2 + 1
    keys = (whole[:, 0] << 42) | (whole[:, 1] << 21) | whole[:, 2]
    order = np.argsort(keys, kind="stable")
    keys = keys[order]
    firsts: NDArray[np.int64] = np.flatnonzero(np.r_[True, keys[1:] != keys[:-1]])
    is_border = np.zeros(firsts.size, np.bool_)
    is_border[np.searchsorted(firsts, np.flatnonzero(is_far[order]), "right") - 1] = True
    # Coordinates as they came: distances are the same to the bit in whatever part of a cloud.
    return FlatCells(xyz[order], keys[firsts], np.r_[firsts, keys.size], is_border), order


def _offsets_by_distance() -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """(k, 3) steps to the cells that a sphere may reach, nearest first; (k,) the own cell."""
    steps = np.arange(-2, 3)
    grid = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), -1).reshape(-1, 3)
    gaps = np.maximum(np.abs(grid) - 1, 0)
    is_reached = (gaps**2).sum(axis=1) < 3.0 + 1e-6  # radius² in cells
    near = grid[is_reached]
    far = (near**2).sum(axis=1)
    chosen = np.ascontiguousarray(near[np.argsort(far, kind="stable")]).astype(np.int64)
    return chosen, far[np.argsort(far, kind="stable")] == 0


@kernel
def radius_kernel(
    cells: FlatCells,
    offsets: NDArray[np.int64],
    is_own: NDArray[np.bool_],
    radius: float,
    limit: int,
    first: int,
    stop: int,
    outliers: NDArray[np.bool_],
) -> None:
    """Mark the outliers of the cells ``first … stop − 1``."""
    near_starts = np.empty(offsets.shape[0], np.int64)
    near_stops = np.empty(offsets.shape[0], np.int64)
    square = radius * radius
    for cell in range(first, stop):
        start, end = cells.starts[cell], cells.starts[cell + 1]
        own = 0 if cells.is_border[cell] else end - start
        if own > limit:
            outliers[start:end] = False
            continue
        used = _find_near(cells, cell, offsets, is_own, near_starts, near_stops)
        for point in range(start, end):
            count = own
            x, y, z = cells.xyz[point, 0], cells.xyz[point, 1], cells.xyz[point, 2]
            for k in range(used):
                for other in range(near_starts[k], near_stops[k]):
                    dx = cells.xyz[other, 0] - x
                    dy = cells.xyz[other, 1] - y
                    dz = cells.xyz[other, 2] - z
                    if dx * dx + dy * dy + dz * dz < square:
                        count += 1
                if count > limit:
                    break
            outliers[point] = count <= limit


@kernel
def _find_near(
    cells: FlatCells,
    cell: int,
    offsets: NDArray[np.int64],
    is_own: NDArray[np.bool_],
    starts: NDArray[np.int64],
    stops: NDArray[np.int64],
) -> int:
    """Note the points of the occupied cells around one, without its own unless at the border."""
    used = 0
    key = cells.keys[cell]
    for k in range(offsets.shape[0]):
        if is_own[k] and not cells.is_border[cell]:
            continue
        wanted = key + (offsets[k, 0] << 42) + (offsets[k, 1] << 21) + offsets[k, 2]
        place = np.searchsorted(cells.keys, wanted)
        if place < cells.keys.size and cells.keys[place] == wanted:
            starts[used] = cells.starts[place]
            stops[used] = cells.starts[place + 1]
            used += 1
    return used


def warm_up() -> None:
    """Compile the kernels."""
    radius_outliers(np.zeros((2, 3)))
