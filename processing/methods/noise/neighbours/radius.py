"""Radius outlier removal: a point with too few others within a radius is noise.

After the road-surface study: a point is noise when its sphere of 0.5 m holds at most 113 points.
The point itself counts, as it does in Open3D and PCL, so that the three agree point by point.

1. Cells with a diagonal below the radius: more than N points in one cell keep each other, and
   where the cells around hold no more than N, all are noise; no distance is measured.
2. Elsewhere the points of the cells around are measured, nearest column first, until more than N
   are found. Rounded distances do unless so many are near the radius that they may decide; then
   exact ones are taken.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.monitor import Monitor, SilentMonitor
from processing.methods.noise.neighbours.flat_cells import FlatCells, flat_cells
from processing.methods.noise.neighbours.sharing import share_out

RADIUS_M, NEIGHBOURS = 0.5, 113
"""The road-surface study's own (Kogure et al., MMSにより計測した路面の点群データにおけるノイズ除去
方法の比較, section 4, after Mizue et al.): they go with the density of that scan."""

_CELLS_AT_ONCE = 4_096
"""Cells of a share of a core's work."""

_REACH = 2
"""Cells to either side within which a radius ends: a cell's side is the radius over √3."""

_LESS_A_BIT = 1 - 1e-9
"""Keeps a cell's diagonal below the radius whatever is rounded."""

_MOST_NEAR, _BLOCK = 4_096, 128
"""Candidates whose rounded distances are taken, and how many at a time: 48 kB, which a core's cache
holds. They change the time only."""

_ROUNDING = 4e-6
"""Of a square, for coordinates of 24 binary digits within 3 cells."""

_KEPT, _OUTLIER, _OPEN = 0, 1, 2


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
    monitor = monitor or SilentMonitor()
    outliers = np.ones(xyz.shape[0], np.bool_)
    cells = flat_cells(xyz, radius_m / np.sqrt(3.0) * _LESS_A_BIT, monitor)
    columns = _columns_by_distance(cells)
    limit = neighbours if counts_itself else neighbours + 1

    def judge(start: int, stop: int) -> None:
        radius_kernel(cells, columns, radius_m, limit, start, stop, outliers)

    share_out(judge, cells.keys.size, _CELLS_AT_ONCE, monitor)
    return outliers


def _columns_by_distance(cells: FlatCells) -> NDArray[np.int64]:
    """(k,) what leads from a cell's key to those of the columns around, nearest first."""
    steps = np.arange(-_REACH, _REACH + 1)
    grid = np.stack(np.meshgrid(steps, steps, indexing="ij"), -1).reshape(-1, 2)
    near = grid[np.argsort((grid**2).sum(axis=1), kind="stable")]
    offsets: NDArray[np.int64] = near[:, 0] * cells.along + near[:, 1] * cells.across
    return offsets


@kernel
def radius_kernel(
    cells: FlatCells,
    columns: NDArray[np.int64],
    radius: float,
    limit: int,
    first: int,
    stop: int,
    outliers: NDArray[np.bool_],
) -> None:
    """Mark the outliers of the cells ``first … stop − 1``."""
    runs = np.empty((columns.size, 2), np.int64)
    positions = np.searchsorted(cells.keys, cells.keys[first] + columns - _REACH)
    near = np.empty((3, _MOST_NEAR), np.float32)
    for cell in range(first, stop):
        start, end = cells.starts[cell], cells.starts[cell + 1]
        if end - start > limit and not cells.is_border[cell]:
            for point in range(start, end):
                outliers[cells.order[point]] = False
            continue
        total = _find_runs(cells, cells.keys[cell], columns, positions, runs)
        if total <= limit:
            continue
        count = 0 if cells.is_border[cell] else _gather(cells.xyz, start, runs, near)
        for point in range(start, end):
            verdict = _rounded(cells.xyz, start, point, near, count, radius, limit)
            if verdict == _OPEN or (verdict == _OUTLIER and count < total):
                verdict = _exact(cells.xyz, point, runs, radius, limit)
            outliers[cells.order[point]] = verdict == _OUTLIER


@kernel
def _find_runs(
    cells: FlatCells,
    key: int,
    columns: NDArray[np.int64],
    positions: NDArray[np.int64],
    runs: NDArray[np.int64],
) -> int:
    """Note the points of the columns around a cell; gives how many they are.

    ``positions`` goes up through the cells as ``key`` does, so that nothing is searched for.
    """
    total = 0
    last = cells.keys.size
    for k in range(columns.size):
        wanted = key + columns[k] - _REACH
        position = positions[k]
        while position < last and cells.keys[position] < wanted:
            position += 1
        positions[k] = position
        runs[k, 0] = cells.starts[position]
        while position < last and cells.keys[position] <= wanted + 2 * _REACH:
            position += 1
        runs[k, 1] = cells.starts[position]
        total += runs[k, 1] - runs[k, 0]
    return total


@kernel
def _gather(
    xyz: NDArray[np.float64], origin: int, runs: NDArray[np.int64], near: NDArray[np.float32]
) -> int:
    """Copy the points of the columns, from a point as origin, as far as there is room."""
    count = 0
    x, y, z = xyz[origin, 0], xyz[origin, 1], xyz[origin, 2]
    for k in range(runs.shape[0]):
        for point in range(runs[k, 0], min(runs[k, 1], runs[k, 0] + near.shape[1] - count)):
            near[0, count] = xyz[point, 0] - x
            near[1, count] = xyz[point, 1] - y
            near[2, count] = xyz[point, 2] - z
            count += 1
    near[:, count : -(-count // _BLOCK) * _BLOCK] = np.inf
    return count


@kernel
def _rounded(
    xyz: NDArray[np.float64],
    origin: int,
    point: int,
    near: NDArray[np.float32],
    count: int,
    radius: float,
    limit: int,
) -> int:
    """What rounded distances to the gathered points say: kept, outlier, or open."""
    x = np.float32(xyz[point, 0] - xyz[origin, 0])
    y = np.float32(xyz[point, 1] - xyz[origin, 1])
    z = np.float32(xyz[point, 2] - xyz[origin, 2])
    surely = np.float32(radius * radius * (1 - _ROUNDING))
    perhaps = np.float32(radius * radius * (1 + _ROUNDING))
    least, most = 0, 0
    for start in range(0, count, _BLOCK):
        inside, outside = np.int32(0), np.int32(0)
        eastings, northings = near[0, start : start + _BLOCK], near[1, start : start + _BLOCK]
        heights = near[2, start : start + _BLOCK]
        for other in range(_BLOCK):  # always whole blocks: so many at a time
            dx, dy, dz = eastings[other] - x, northings[other] - y, heights[other] - z
            square = dx * dx + dy * dy + dz * dz
            inside = np.int32(inside + np.int32(square < surely))
            outside = np.int32(outside + np.int32(square > perhaps))
        least += int(inside)
        most += _BLOCK - int(outside)
        if least > limit:
            return _KEPT
    return _OUTLIER if most <= limit else _OPEN


@kernel
def _exact(
    xyz: NDArray[np.float64], point: int, runs: NDArray[np.int64], radius: float, limit: int
) -> int:
    """Kept or outlier, from the coordinates as they are."""
    count = 0
    x, y, z = xyz[point, 0], xyz[point, 1], xyz[point, 2]
    for k in range(runs.shape[0]):
        for other in range(runs[k, 0], runs[k, 1]):
            dx, dy, dz = xyz[other, 0] - x, xyz[other, 1] - y, xyz[other, 2] - z
            count += dx * dx + dy * dy + dz * dz < radius * radius
        if count > limit:
            return _KEPT
    return _OUTLIER


def warm_up() -> None:
    """Compile the kernels."""
    radius_outliers(np.zeros((2, 3)))
