"""Statistical outlier removal: a point whose neighbours are unusually far is noise.

After the road-surface study: with d the mean distance to the k nearest, a point is noise when
d > mean(d) + α · standard deviation(d) over the whole cloud; k = 113, α = 1.5. As in Open3D the
point itself is one of the k, and the deviation divides by n − 1; without itself it is PCL's form.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, SilentMonitor
from processing.methods.noise.neighbours.descent_kernels import descent_kernel
from processing.methods.noise.neighbours.far_points import is_far
from processing.methods.noise.neighbours.morton import nested_cells
from processing.methods.noise.neighbours.nearest_kernels import CellPoints, nearest_kernel
from processing.methods.noise.neighbours.sharing import share_out

NEIGHBOURS, DEVIATIONS = 113, 1.5
"""The road-surface study's own (Kogure et al., MMSにより計測した路面の点群データにおけるノイズ除去
方法の比較, section 4); its 1.5 is taken for a multiple of the standard deviation."""

_POINTS_AT_ONCE = 8_192
"""Points of a share of a core's work."""

_COARSE_M = 0.01
"""Side of the smallest cubes from which far points are looked for: an extent of some 10 km."""


class _Counting(NamedTuple):
    """How many neighbours are asked for, and whether a point is one of its own."""

    neighbours: int
    counts_itself: bool


@dataclass(frozen=True)
class DistanceSums:
    """What is kept of the mean distances of many points, to be added up over parts of a cloud."""

    count: int = 0
    total: float = 0.0
    squares: float = 0.0

    @classmethod
    def of(cls, means: NDArray[np.float64]) -> DistanceSums:
        """The sums of (n,) mean distances; NaN are left out."""
        known = means[~np.isnan(means)]
        return cls(known.size, float(known.sum()), float(known @ known))

    def __add__(self, other: DistanceSums) -> DistanceSums:
        return DistanceSums(
            self.count + other.count, self.total + other.total, self.squares + other.squares
        )

    def limit(self, deviations: float) -> float:
        """Mean plus so many standard deviations; infinite for fewer than two points."""
        if self.count < 2:
            return math.inf
        mean = self.total / self.count
        variance = max(0.0, self.squares - self.count * mean * mean) / (self.count - 1)
        return mean + deviations * math.sqrt(variance)


def mean_distances(
    xyz: NDArray[np.float64],
    neighbours: int = NEIGHBOURS,
    *,
    counts_itself: bool = True,
    monitor: Monitor | None = None,
) -> NDArray[np.float64]:
    """Mean distance of every point to its nearest.

    Parameters
    ----------
    xyz : (n, 3) float64
        m; points that aren't finite get NaN and are nobody's neighbour.

    Returns
    -------
    (n,) float64
        m. In a cloud of fewer points all of them are the neighbours.
    """
    wanted = np.flatnonzero(np.isfinite(xyz[:, 0] + xyz[:, 1] + xyz[:, 2]))
    means = np.full(xyz.shape[0], np.nan)
    means[wanted] = distances_of(
        xyz, wanted, neighbours, counts_itself=counts_itself, monitor=monitor
    )[0]
    return means


def distances_of(
    xyz: NDArray[np.float64],
    wanted: NDArray[np.int64],
    neighbours: int = NEIGHBOURS,
    *,
    counts_itself: bool = True,
    monitor: Monitor | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distances of some points of a cloud to their nearest in all of it.

    Parameters
    ----------
    wanted : (k,) int64
        Indices of finite points.

    Returns
    -------
    means, farthest : (k,) float64
        m: the mean over the nearest, and the farthest of them; infinite where there are too few.
    """
    if not wanted.size:
        return np.zeros(0), np.zeros(0)
    cells = nested_cells(xyz, 0.0)
    if cells.cell_m > _COARSE_M:
        finite = np.sort(cells.order)
        far = finite[is_far(xyz[finite])]
        if far.size:
            options = _Counting(neighbours, counts_itself)
            return _distances_beside_far(xyz, wanted, far, options, monitor or SilentMonitor())
    points = CellPoints(cells.codes, cells.local_xyz, cells.cell_m)
    asked = neighbours if counts_itself else neighbours + 1
    nearest = min(cells.order.size, asked)
    divisor = max(1, nearest if counts_itself else nearest - 1)
    is_wanted = np.zeros(xyz.shape[0], np.bool_)
    is_wanted[wanted] = True
    is_wanted = is_wanted[cells.order]
    found = np.full((cells.order.size, 2), np.inf)

    def measure(start: int, stop: int) -> None:
        nearest_kernel(points, is_wanted, nearest, start, stop, found)
        descent_kernel(points, is_wanted, nearest, start, stop, found)

    share_out(measure, cells.order.size, _POINTS_AT_ONCE, monitor or SilentMonitor())
    by_point = np.empty((xyz.shape[0], 2))
    by_point[cells.order] = found
    farthest = by_point[wanted, 1] if nearest == asked else np.full(wanted.size, np.inf)
    return by_point[wanted, 0] / divisor, farthest


def _distances_beside_far(
    xyz: NDArray[np.float64],
    wanted: NDArray[np.int64],
    far: NDArray[np.int64],
    options: _Counting,
    monitor: Monitor,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """As :func:`distances_of`, where far points would make the cells too coarse for the others.

    The others are measured without the far ones, and again with all where a far one may be nearer
    than what was found.
    """
    from scipy.spatial import cKDTree

    neighbours, counts_itself = options
    others = xyz.copy()
    others[far] = np.nan
    is_open = np.isin(wanted, far)
    means, farthest = np.full(wanted.size, np.inf), np.full(wanted.size, np.inf)
    near = np.flatnonzero(~is_open)
    means[near], farthest[near] = distances_of(
        others, wanted[near], neighbours, counts_itself=counts_itself, monitor=monitor
    )
    is_open[near] = farthest[near] > cKDTree(xyz[far]).query(xyz[wanted[near]])[0]
    tree = cKDTree(xyz[np.isfinite(xyz).all(axis=1)])
    asked = neighbours if counts_itself else neighbours + 1
    nearest = min(tree.n, asked)
    left = np.flatnonzero(is_open)
    for start in range(0, left.size, _POINTS_AT_ONCE):
        monitor.check()
        some = left[start : start + _POINTS_AT_ONCE]
        # A list keeps two axes where one neighbour is asked for.
        lengths = np.asarray(tree.query(xyz[wanted[some]], list(range(1, nearest + 1)))[0])
        means[some] = lengths.sum(axis=1) / max(1, nearest if counts_itself else nearest - 1)
        farthest[some] = lengths[:, -1] if nearest == asked else np.inf
    return means, farthest


def statistical_outliers(
    xyz: NDArray[np.float64],
    neighbours: int = NEIGHBOURS,
    deviations: float = DEVIATIONS,
    *,
    counts_itself: bool = True,
    monitor: Monitor | None = None,
) -> NDArray[np.bool_]:
    """Points whose neighbours are farther than usual in the whole cloud.

    Returns
    -------
    (n,) bool
        Points that aren't finite are outliers.
    """
    means = mean_distances(xyz, neighbours, counts_itself=counts_itself, monitor=monitor)
    return ~(means <= DistanceSums.of(means).limit(deviations))


def warm_up() -> None:
    """Compile the kernels."""
    statistical_outliers(np.eye(3))
