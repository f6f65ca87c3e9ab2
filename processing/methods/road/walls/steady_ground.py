"""The coarse ground without pits: windows and puddles mirror the street far below it.

The coarse map keeps the lowest that was measured. Behind a wall, where no ground is seen, that may
be a mirrored point; faces there would seem to begin many metres above the ground.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.methods.road.objects.ground_heights import GROUND_CELLS, GROUND_M
from processing.methods.road.objects.sparse_plan import SparsePlan

_DEEPEST_M = 3.0
"""Below the middle height of what lies within a tile around: a street of 1 : 7 falls less over
19 m; ground that lies deeper is beyond a bank, and its walls aren't beside the road."""

_REACH_M = 15.0
"""How far the ground is taken from the nearest cell that knows it: across a yard."""


def steady_ground(
    plan: SparsePlan, ground: NDArray[np.float32], monitor: Monitor
) -> NDArray[np.float32]:
    """The ground of all cells, with pits and unknown cells filled from the nearest others.

    Parameters
    ----------
    ground : (tiles, 16, 16) float32
        As :func:`processing.methods.road.objects.ground_heights.ground_heights` finds it.

    Returns
    -------
    (tiles, 16, 16) float32
        A copy; NaN where nothing within 15 m is known.
    """
    from scipy.spatial import cKDTree

    steady = ground.copy()
    for tile in range(len(plan)):
        monitor.check()
        around = plan.window(ground, tile, GROUND_CELLS, np.nan)
        known = around[np.isfinite(around)]
        if known.size:
            steady[tile][ground[tile] < np.median(known) - _DEEPEST_M] = np.nan
    places = _middles(plan)
    known_cells = np.isfinite(steady.reshape(-1))
    missing = np.flatnonzero(~known_cells)
    if not missing.size or not known_cells.any():
        return steady
    sources = np.flatnonzero(known_cells)
    away, nearest = cKDTree(places[sources]).query(places[missing], distance_upper_bound=_REACH_M)
    found = np.isfinite(np.asarray(away))
    chosen = sources[np.asarray(nearest)[found]]
    steady.reshape(-1)[missing[found]] = steady.reshape(-1)[chosen]
    return steady


def _middles(plan: SparsePlan) -> NDArray[np.float64]:
    """(cells, 2) float64 the middles of the ground's cells, tile after tile, m."""
    tiles = np.empty((len(plan), 2))
    there = np.argwhere(plan.table >= 0)
    tiles[plan.table[tuple(there.T)]] = there
    side = np.arange(GROUND_CELLS) + 0.5
    within = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    cells = tiles[:, None] * GROUND_CELLS + within[None]
    return np.asarray(cells.reshape(-1, 2) * GROUND_M)
