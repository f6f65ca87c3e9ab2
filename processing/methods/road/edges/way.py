"""The ways along which the edges of a carriageway are looked for: stations of the driven paths.

What lies beside a way is told by its station and how far it is to the left. Of several heads and
passes along one carriageway the first one's path is the way of all.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.methods.road.objects.ground_heights import GROUND_CELLS, GROUND_M
from processing.methods.road.objects.sparse_plan import CELL_M, TILE, SparsePlan
from processing.recording.drive import Drive
from processing.recording.vehicle_path.smooth_path import monotone_runs, smooth_way

_EVERY = 2
"""Of the smooth path's positions, a quarter of a metre apart: half a metre along the road shows
some scan lines at any speed, and no edge turns much within it."""

_APART_M = 4.0
"""A path farther from the ways there are is a way of its own: another carriageway, or the lanes
beyond the next one. Lanes are 2.75 to 3.5 m wide (道路構造令 第5条)."""

_LEAST_STATIONS = 10


@dataclass(frozen=True)
class RoadWays:
    """Stations of all ways, one way after the other.

    Attributes
    ----------
    places : (n, 3) float64
        m about the plan's origin.
    directions : (n, 2) float64
        Unit vectors in plan.
    way : (n,) int64
        Which way each belongs to.
    step_m : float
        Between stations.
    """

    places: Floats
    directions: Floats
    way: Integers
    step_m: float

    def __len__(self) -> int:
        return len(self.places)

    def stretches(self) -> list[tuple[int, int]]:
        """First station of each way, and the one behind its last."""
        ends = np.r_[0, np.flatnonzero(np.diff(self.way)) + 1, len(self.way)]
        return [(a, b) for a, b in itertools.pairwise(ends.tolist()) if b > a]

    def about(self, place: Floats, reach_m: float) -> RoadWays:
        """The stations so near to a place in plan."""
        near = np.hypot(*(self.places[:, :2] - place[:2]).T) <= reach_m
        return RoadWays(self.places[near], self.directions[near], self.way[near], self.step_m)

    def beside(self, stations: Integers, left_m: Floats) -> Floats:
        """(k, 2) float64: places so far to the left of stations."""
        ahead = self.directions[stations]
        across = np.column_stack([-ahead[:, 1], ahead[:, 0]])
        return np.asarray(self.places[stations, :2] + left_m[:, None] * across)


def road_ways(drives: Sequence[Drive], plan: SparsePlan) -> RoadWays:
    """The ways of some drives; none without a trajectory."""
    from scipy.spatial import cKDTree

    places, directions = [np.empty((0, 3))], [np.empty((0, 2))]
    numbers: list[Integers] = [np.empty(0, np.int64)]
    step_m, count = 0.5, 0
    for drive in drives:
        if drive.trajectory is None or len(drive.trajectory.xyz) < 2:
            continue
        xyz = np.asarray(drive.trajectory.xyz - plan.origin)
        for first, last in monotone_runs(xyz):
            path = smooth_way(xyz[first:last])
            if path is None:
                continue
            own, ahead = path.positions[::_EVERY], path.directions[::_EVERY]
            known = np.concatenate(places)
            is_new = np.ones(len(own), np.bool_)
            if len(known):
                is_new = np.asarray(cKDTree(known[:, :2]).query(own[:, :2])[0]) > _APART_M
            for start, stop in _stretches(is_new):
                places.append(own[start:stop])
                directions.append(ahead[start:stop])
                numbers.append(np.full(stop - start, count, np.int64))
                count += 1
    return RoadWays(
        np.concatenate(places), np.concatenate(directions), np.concatenate(numbers), step_m
    )


def _stretches(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    turns = np.flatnonzero(np.diff(np.r_[0, flags.astype(np.int64), 0])).reshape(-1, 2)
    return [(a, b) for a, b in turns.tolist() if b - a >= _LEAST_STATIONS]


def nearest_stations(table: NDArray[np.int32], ways: RoadWays) -> NDArray[np.int32]:
    """(cells,) int32 the station nearest to the middle of each coarse cell of some tiles."""
    from scipy.spatial import cKDTree

    tiles = np.argwhere(table >= 0)
    corners = np.empty((len(tiles), 2))
    corners[table[tuple(tiles.T)]] = tiles * (CELL_M * TILE)
    side = (np.arange(GROUND_CELLS) + 0.5) * GROUND_M
    within = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    middles = (corners[:, None] + within[None]).reshape(-1, 2)
    return np.asarray(cKDTree(ways.places[:, :2]).query(middles)[1], np.int32)
