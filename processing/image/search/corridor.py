"""Corridor: the space along a drive, so far to its sides and so high above its road."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.image.search.nearest import nearest_point
from processing.recording.drive import Drive

if TYPE_CHECKING:  # its import takes a third of a second, which the program's start hasn't got
    from scipy.spatial import cKDTree


_CELLS_PER_REACH = 4.0
"""Cells of the search across a corridor: finer ones save no time. By trial; no measurement is
recorded."""

_LEAST_CELL_M = 1.0
"""Cells are no smaller: a path has a place every metre or so."""

_SEGMENTS_ASIDE = 3
"""To either side of the nearest place of the path segments are asked: in bends the nearest place
isn't always of the nearest segment."""

_PROBES = 24
"""Places along a path at which its height above the ground is asked; their median counts."""

_LOWERED_M = 2.5
"""The ground is looked for so far below the path: of a trajectory on a car's roof."""

_PROBE_REACH_M = 4.0
"""So near to that place: a path on the road itself finds it too."""

_USUAL_HEIGHT_M = 2.0
"""Of a vehicle's reference point, where nothing was measured below it."""


@dataclass(frozen=True)
class CorridorExtent:
    """How far a corridor reaches, m.

    Attributes
    ----------
    left_m, right_m : float
        From the vehicle's path, in plan.
    lowest_m, highest_m : float
        Above the road; negative below it.
    """

    left_m: float = 10.0
    right_m: float = 10.0
    lowest_m: float = -0.5
    highest_m: float = 6.0


class Corridor:
    """What lies along a drive's trajectory; equal to nothing but itself.

    What it needs is worked out when it is first asked, which may take some tenths of a second for
    a long drive and isn't for the window's thread.

    Parameters
    ----------
    drive : Drive
        With a trajectory.
    slab : CorridorExtent
    """

    def __init__(self, drive: Drive, slab: CorridorExtent) -> None:
        if drive.trajectory is None:
            message = "a corridor needs a trajectory"
            raise ValueError(message)
        self.slab = slab
        self._drive = drive

    def holds(self, xyz: Floats) -> NDArray[np.bool_]:
        """(n,) which of (n, 3) float64 positions, m, project CRS, lie in it."""
        index, slab = self._index, self.slab
        inside = np.empty(len(xyz), np.bool_)
        corridor_kernel(
            np.ascontiguousarray(xyz, dtype=np.float64),
            index.vehicle_path,
            index.keys,
            index.nearest,
            np.array([*index.corner, index.cell_m, float(index.columns)]),
            np.array([slab.left_m, slab.right_m, slab.lowest_m, slab.highest_m]),
            inside,
        )
        return inside

    def may_hold(self, low: Floats, high: Floats) -> NDArray[np.bool_]:
        """(n,) which boxes, (n, 3) float64 corners, may reach into it."""
        index, slab = self._index, self.slab
        middle, half = (low + high)[:, :2] / 2, (high - low)[:, :2] / 2
        reach = _reach_m(slab) + np.hypot(*half.T) + index.cell_m
        away, _ = index.tree.query(middle)
        near: NDArray[np.bool_] = away <= reach
        heights = index.vehicle_path[:, 2]
        near &= low[:, 2] <= heights.max() + slab.highest_m
        near &= high[:, 2] >= heights.min() + slab.lowest_m
        return near

    @cached_property
    def _index(self) -> _Index:
        return _Index.of(_road_below(self._drive), _reach_m(self.slab))


@dataclass(frozen=True, eq=False)
class _Index:
    """The vehicle's path in steps, and for every cell near it the step that is nearest.

    Attributes
    ----------
    vehicle_path : (m, 3) float64
        On the road, about a cell apart; m ≥ 2.
    corner : (2,) float64
        Lowest easting and northing of all cells.
    columns : int
        Cells per easting.
    keys : (c,) int64
        ``cell easting × columns + cell northing``, rising.
    nearest : (c,) int64
        Indices into the path.
    tree : cKDTree
        Of the path in plan.
    """

    vehicle_path: Floats
    corner: Floats
    cell_m: float
    columns: int
    keys: Integers
    nearest: Integers
    tree: cKDTree

    @staticmethod
    def of(vehicle_path: Floats, reach_m: float) -> _Index:
        cell_m = max(_LEAST_CELL_M, reach_m / _CELLS_PER_REACH)
        vehicle_path = _in_steps(vehicle_path, cell_m)
        rings = int(np.ceil(reach_m / cell_m)) + 1
        corner = vehicle_path[:, :2].min(axis=0) - (rings + 1) * cell_m
        cells = np.floor((vehicle_path[:, :2] - corner) / cell_m).astype(np.int64)
        columns = int(cells[:, 1].max()) + rings + 2
        around = np.arange(-rings, rings + 1)
        offsets = (around[:, None] * columns + around).ravel()
        of_way = np.unique(cells @ np.array([columns, 1]))
        keys = np.unique((of_way[:, None] + offsets).ravel())
        middles = corner + (np.column_stack(np.divmod(keys, columns)) + 0.5) * cell_m
        from scipy.spatial import cKDTree

        tree = cKDTree(vehicle_path[:, :2])
        nearest = np.asarray(tree.query(middles)[1], dtype=np.int64)
        return _Index(vehicle_path, corner, cell_m, columns, keys, nearest, tree)


def _reach_m(slab: CorridorExtent) -> float:
    return max(slab.left_m, slab.right_m, 0.0)


def _road_below(drive: Drive) -> Floats:
    """(m, 3): where the vehicle was while this drive's points were measured, on the road.

    A vehicle's reference point keeps its height above the road, so a few positions show it.
    """
    trajectory = drive.trajectory
    if trajectory is None:
        return np.zeros((0, 3))
    low, high = np.array(drive.info.lowest), np.array(drive.info.highest)
    inside = ((trajectory.xyz >= low) & (trajectory.xyz <= high))[:, :2].all(axis=1)
    vehicle_path = trajectory.xyz[inside] if inside.sum() > 1 else trajectory.xyz
    heights = []
    for position in vehicle_path[np.linspace(0, len(vehicle_path) - 1, _PROBES).astype(np.int64)]:
        point = nearest_point(drive, position - [0.0, 0.0, _LOWERED_M], _PROBE_REACH_M)
        if point >= 0:
            heights.append(float(position[2] - drive.xyz(np.array([point]))[0, 2]))
    return vehicle_path - [0.0, 0.0, float(np.median(heights)) if heights else _USUAL_HEIGHT_M]


def _in_steps(vehicle_path: Floats, step_m: float) -> Floats:
    """The path with a position about every step, however slow the vehicle was; at least two."""
    gone = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(vehicle_path[:, :2], axis=0).T))])
    count = max(2, int(np.ceil(gone[-1] / step_m)) + 1)
    positions = np.linspace(0.0, max(float(gone[-1]), 1e-6), count)
    return np.column_stack([np.interp(positions, gone, axis) for axis in vehicle_path.T])


@kernel
def corridor_kernel(
    xyz: NDArray[np.float64],
    vehicle_path: NDArray[np.float64],
    keys: NDArray[np.int64],
    nearest: NDArray[np.int64],
    cells: NDArray[np.float64],
    limits: NDArray[np.float64],
    inside: NDArray[np.bool_],
) -> None:
    """Whether positions lie along a path.

    ``cells``: lowest easting and northing, size, cells per easting. ``limits``: left, right,
    lowest, highest. The foot of a position is looked for on the segments about the step that is
    nearest to its cell.
    """
    columns = int(cells[3])
    for i in range(xyz.shape[0]):
        inside[i] = False
        x, y = xyz[i, 0], xyz[i, 1]
        east, north = (x - cells[0]) / cells[2], (y - cells[1]) / cells[2]
        if not (east >= 0.0 and 0.0 <= north < columns):
            continue
        key = int(east) * columns + int(north)
        at = np.searchsorted(keys, key)
        if at >= keys.size or keys[at] != key:
            continue
        first = max(nearest[at] - _SEGMENTS_ASIDE, 0)
        last = min(nearest[at] + _SEGMENTS_ASIDE, vehicle_path.shape[0] - 1)
        best, side, height = np.inf, 0.0, 0.0
        for step in range(first, last):
            ax, ay = vehicle_path[step, 0], vehicle_path[step, 1]
            dx, dy = vehicle_path[step + 1, 0] - ax, vehicle_path[step + 1, 1] - ay
            share = ((x - ax) * dx + (y - ay) * dy) / max(dx * dx + dy * dy, 1e-12)
            share = min(max(share, 0.0), 1.0)
            away = (x - ax - share * dx) ** 2 + (y - ay - share * dy) ** 2
            if away < best:
                best = away
                side = dx * (y - ay) - dy * (x - ax)
                height = vehicle_path[step, 2] + share * (
                    vehicle_path[step + 1, 2] - vehicle_path[step, 2]
                )
        above = xyz[i, 2] - height
        limit = limits[0] if side >= 0.0 else limits[1]
        inside[i] = best <= limit * limit and limits[2] <= above <= limits[3]


def warm_up() -> None:
    """Compile the kernel."""
    corridor_kernel(
        np.zeros((2, 3)),
        np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
        np.array([0]),
        np.array([0]),
        np.array([-1.0, -1.0, 1.0, 4.0]),
        np.ones(4),
        np.empty(2, np.bool_),
    )
