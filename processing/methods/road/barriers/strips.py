"""Long thin strips in which things stand, as lines in the plan."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.methods.road.barriers.raised_cells import LOWEST_M, SLAB_M, RaisedCells
from processing.methods.road.barriers.strip_kernels import (
    StripCells,
    directions_kernel,
    follow_kernel,
    mark_kernel,
    near_kernel,
    places_kernel,
    unused,
)

_BAND_M = (0.35, 1.4)
"""Heights in which every barrier has something: rails from 0.3, tops of fences below 1.3 m; crowns
and signs hang higher."""

_DIRECTIONS = 24
"""7.5° apart: at the end of the 3 m that are looked at, half of it is 0.1 m aside."""

_LEAST_SCORE = 5.0
_LONGEST_NODES = 4000
_SHORTEST_M = 1.5


@dataclass(frozen=True)
class FollowedStrip:
    """A followed strip.

    Attributes
    ----------
    nodes : (n, 2) float64
        Half a metre apart, m about the origin of the plan.
    """

    nodes: Floats


def strips_of(cells: RaisedCells, monitor: Monitor) -> list[FollowedStrip]:
    """All strips, each place in one.

    Notes
    -----
    1. Where something stands between 0.35 and 1.4 m, one place of each block of 0.4 m is looked at
       in 24 directions: how much of 3 m is filled, and of the freer flank.
    2. From the best place on, strips are followed to both sides; what was followed is not looked
       at again.
    """
    first, last = (round((one - LOWEST_M) / SLAB_M) for one in _BAND_M)
    band = np.uint32(((1 << last) - 1) & ~((1 << first) - 1))
    raised = ((cells.slabs & band) > 0).astype(np.uint8).reshape(-1)
    corners = cells.corners()
    near = np.zeros_like(raised)
    near_kernel(raised, corners, cells.plan.table, near)
    raster = StripCells(cells.plan.table, raised, near, np.zeros_like(raised))
    places = np.empty((len(cells.plan) * 32 * 32, 2))
    places = places[: places_kernel(raised, corners, places)]
    monitor.check()
    angles = np.arange(_DIRECTIONS) * np.pi / _DIRECTIONS
    directions = np.column_stack([np.cos(angles), np.sin(angles)])
    best = np.zeros(len(places), np.int32)
    scores = np.zeros(len(places), np.float32)
    directions_kernel(places, directions, raster, best, scores)
    monitor.check()
    strips = []
    for place in np.argsort(-scores, kind="stable").tolist():
        if scores[place] < _LEAST_SCORE:
            break
        if unused(places[place : place + 1], raster).size:
            nodes = _followed(places[place], directions[best[place]], raster)
            monitor.check()
            if len(nodes) > 1:
                mark_kernel(nodes, raster)
            if (len(nodes) - 1) * 0.5 >= _SHORTEST_M:
                strips.append(FollowedStrip(nodes))
    return strips


def _followed(place: Floats, direction: Floats, raster: StripCells) -> Floats:
    """The nodes to both sides of a place, in order."""
    forward, backward = (np.empty((_LONGEST_NODES, 2)) for _ in range(2))
    ahead = forward[: follow_kernel(place, direction, raster, forward)]
    behind = backward[: follow_kernel(place, -direction, raster, backward)]
    return np.concatenate([behind[:0:-1], ahead])
