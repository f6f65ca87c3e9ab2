"""Connected components over pixels: points joined with their neighbours along and across rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.image.grid import PixelGrid
from processing.image.segment_kernels import JoiningRows, join_rows_kernel, roots_kernel
from processing.monitor import Monitor, SilentMonitor

OVERLAP_ROWS = 1
"""Rows beyond its own that a block needs so that no join between rows is missed."""

_POINTS_AT_ONCE = 200_000


@dataclass(frozen=True)
class JoinLimits:
    """When neighbouring points belong together.

    Attributes
    ----------
    distance_m : float
        Neighbours nearer than this are always joined.
    spacing_ratio : float
        Farther ones are joined up to so many times the distance that neighbours have there.
    farthest_m : float
        Farther ones are never joined.
    """

    distance_m: float
    spacing_ratio: float
    farthest_m: float


def connected_segments(
    xyz: NDArray[np.float64], grid: PixelGrid, limits: JoinLimits, monitor: Monitor | None = None
) -> NDArray[np.int32]:
    """Numbers of connected components, 0 for the one with the first point, and so on.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.

    Returns
    -------
    (n,) int32

    Notes
    -----
    1. Points that follow each other in a row are neighbours, with one missing point between them
       at most and three columns apart; so are the last of a row and the first of the next, which
       were measured one after the other. Expected there is the distance of the pairs before and
       after, the shorter of the two.
    2. A point and the nearest in space among those of the next row that are at most three columns
       away are neighbours. Expected there is the median of such distances in the row.
    3. Rows of different segments (stops) are never joined.
    """
    monitor = monitor or SilentMonitor()
    starts = grid.row_starts
    rows = JoiningRows(
        xyz=np.ascontiguousarray(xyz),
        columns=grid.columns,
        row_starts=starts,
        segments=grid.segments,
        limits=np.array([limits.distance_m, limits.spacing_ratio, limits.farthest_m]),
        scratch=np.empty(int(np.diff(starts).max(initial=0)) + 1),
        parents=np.arange(xyz.shape[0], dtype=np.int64),
    )
    first, count = 0, starts.size - 1
    while first < count:
        monitor.check()
        wanted = int(np.searchsorted(starts, starts[first] + _POINTS_AT_ONCE))
        end = min(max(wanted, first + 1), count)
        join_rows_kernel(rows, first, end)
        first = end
    roots_kernel(rows.parents)
    return numbered_by_first(rows.parents)


def numbered_by_first(roots: NDArray[np.int64]) -> NDArray[np.int32]:
    """Components numbered in the order of their first points.

    Parameters
    ----------
    roots : (n,) int64
        The first point of each point's component.
    """
    is_first = roots == np.arange(roots.size)
    return (np.cumsum(is_first) - 1).astype(np.int32)[roots]


def warm_up() -> None:
    """Compile the kernels."""
    grid = PixelGrid(
        np.array([0, 1, 2]), np.array([0, 1], np.int32), np.zeros(2, np.int32), width=2
    )
    connected_segments(np.zeros((2, 3)), grid, JoinLimits(0.3, 2.0, 1.0))
