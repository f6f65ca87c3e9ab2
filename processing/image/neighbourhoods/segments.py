"""Connected components over pixels: points joined with their neighbours along and across rows."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, SilentMonitor
from processing.image.neighbourhoods.segment_kernels import (
    JoiningRows,
    join_rows_kernel,
    roots_kernel,
    tangents_kernel,
)
from processing.image.rows.grid import PixelGrid

OVERLAP_ROWS = 1
"""Rows beyond its own that a block needs so that no join between rows is missed."""

_POINTS_AT_ONCE = 200_000
"""Some tens of MB with all that is worked out, and short enough for a cancel to be felt at once."""


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
    bend_deg : float
        Nor those where the row turns by more: a surface ends at a corner. 180: only distances
        count.
    """

    distance_m: float
    spacing_ratio: float
    farthest_m: float
    bend_deg: float = 180.0


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
    3. Points where the row bends, within 0.15 m on either side, are corners or leaves and are
       joined among each other only. Others are joined when the rows run in the same direction
       there, so a surface ends where the row turns the corner to another.
    4. Rows of different segments (stops) are never joined.
    """
    monitor = monitor or SilentMonitor()
    starts = grid.row_starts
    rows = JoiningRows(
        xyz=np.ascontiguousarray(xyz),
        columns=grid.columns,
        row_starts=starts,
        segments=grid.segments,
        limits=np.array(
            [
                limits.distance_m,
                limits.spacing_ratio,
                limits.farthest_m,
                math.cos(math.radians(limits.bend_deg)),
            ]
        ),
        scratch=np.empty(int(np.diff(starts).max(initial=0)) + 1),
        tangents=np.zeros(xyz.shape, dtype=np.float32),
        is_bent=np.zeros(xyz.shape[0], dtype=np.bool_),
        parents=np.arange(xyz.shape[0], dtype=np.int64),
    )
    if limits.bend_deg < 180:
        for first, end in _row_stretches(starts):
            monitor.check()
            tangents_kernel(rows, first, end)
    for first, end in _row_stretches(starts):
        monitor.check()
        join_rows_kernel(rows, first, end)
    roots_kernel(rows.parents)
    return number_by_first(rows.parents)


def number_by_first(roots: NDArray[np.int64]) -> NDArray[np.int32]:
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
    connected_segments(np.zeros((2, 3)), grid, JoinLimits(0.3, 2.0, 1.0, 25.0))


def _row_stretches(starts: NDArray[np.int64]) -> Iterator[tuple[int, int]]:
    """First row and end of consecutive stretches of rows with so many points."""
    first, count = 0, starts.size - 1
    while first < count:
        wanted = int(np.searchsorted(starts, starts[first] + _POINTS_AT_ONCE))
        end = min(max(wanted, first + 1), count)
        yield first, end
        first = end
