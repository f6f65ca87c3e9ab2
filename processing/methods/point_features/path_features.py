"""Height over the trajectory and distance from it (Takahashi 2022, section 4.5).

The trajectory's nearest place is sought in plan, within half a minute of the point's time: bridges,
loops and other passes of the street are somebody else's nearest place.
"""

from __future__ import annotations

import math
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.noise.neighbours.sharing import share_out
from processing.recording.columns.ordering import chunk_ranges, read_chunk
from processing.recording.drive import Drive
from processing.recording.vehicle_path.smooth_path import apart
from processing.recording.vehicle_path.trajectory import LONGEST_GAP_S, Trajectory

_POINTS_AT_ONCE = 65_536
"""Points of a share of a core's work."""

_WITHIN_S = 30.0
"""Before and after the point was measured: beyond the reach of a scanner at any speed of a street,
and too short for the way round a block."""

_APART_M = 0.5
"""Between the places that are kept of the trajectory: the chord of a turn of 6 m radius is then
5 mm off."""

_TOGETHER = 32
"""Places that are passed over at once where they are too far."""


class TrajectoryPlaces(NamedTuple):
    """Places that a vehicle passed.

    ``times`` (m,) s rising, ``xyz`` (m, 3) m, ``way_m`` (m,) driven in plan since the first;
    ``is_joined`` (m,): none is lacking before it.
    """

    times: Floats
    xyz: Floats
    way_m: Floats
    is_joined: Flags


def has_path(drive: Drive) -> bool:
    """Whether a drive's points have times on a trajectory."""
    if drive.trajectory is None or not drive.count:
        return False
    middle = drive.count // 2
    times = read_chunk(drive.folder, "time", middle, middle + 1)
    return bool(np.isfinite(times).all())


def path_features(drive: Drive, found: tuple[NDArray[np.float32], ...], monitor: Monitor) -> None:
    """Height over the trajectory and distance from it, m; NaN where the trajectory isn't known.

    Parameters
    ----------
    found : two of (n,) float32
        Get the heights, and the distances.

    Raises
    ------
    Cancelled
    """
    trajectory = drive.trajectory
    if trajectory is None:
        message = "a drive without a trajectory was not refused"
        raise ValueError(message)
    places = path_places(trajectory)
    for start, stop in chunk_ranges(drive.count):
        monitor.check()
        monitor.report(start / drive.count)
        times = read_chunk(drive.folder, "time", start, stop)
        xyz = drive.coordinates.chunk_xyz(start, stop)
        is_known = trajectory.covers(times)
        both = np.full((2, stop - start), np.nan, np.float32)

        look = partial(_look, (xyz, times, is_known), places, both)
        share_out(look, stop - start, _POINTS_AT_ONCE, monitor)
        for values, part in zip(found, both, strict=True):
            values[start:stop] = part


def path_places(trajectory: Trajectory) -> TrajectoryPlaces:
    """The places of a trajectory, half a metre apart."""
    kept = np.unique(np.concatenate([apart(trajectory.xyz, _APART_M), [trajectory.time.size - 1]]))
    # A vehicle that stands goes on being where it is.
    last = np.flatnonzero(np.diff(trajectory.time) > LONGEST_GAP_S)
    kept = np.unique(np.concatenate([kept, last, last + 1]))
    xyz = np.ascontiguousarray(trajectory.xyz[kept], np.float64)
    steps = np.hypot(*np.diff(xyz[:, :2], axis=0).T)
    return TrajectoryPlaces(
        np.ascontiguousarray(trajectory.time[kept], np.float64),
        xyz,
        np.concatenate([[0.0], np.cumsum(steps)]),
        ~np.isin(kept, last + 1),
    )


def _look(
    points: tuple[Floats, Floats, Flags],
    places: TrajectoryPlaces,
    found: NDArray[np.float32],
    start: int,
    stop: int,
) -> None:
    part = slice(start, stop)
    xyz, times, is_known = points
    beside_kernel(xyz[part], times[part], is_known[part], places, found[:, part])


@kernel
def beside_kernel(
    xyz: Floats,
    times: Floats,
    is_known: Flags,
    places: TrajectoryPlaces,
    found: NDArray[np.float32],
) -> None:
    """Heights over the nearest place in plan, and distances from it, ``found`` (2, n), m."""
    for point in range(xyz.shape[0]):
        if not is_known[point]:
            continue
        first = int(np.searchsorted(places.times, times[point] - _WITHIN_S))
        end = int(np.searchsorted(places.times, times[point] + _WITHIN_S, side="right"))
        first, end = max(first - 1, 0), min(end, places.times.size - 1)
        best, height = np.inf, 0.0
        start = first
        while start < end:
            stop = min(start + _TOGETHER, end)
            x, y = xyz[point, 0] - places.xyz[start, 0], xyz[point, 1] - places.xyz[start, 1]
            way = places.way_m[stop] - places.way_m[start]
            if math.hypot(x, y) - way > math.sqrt(best):
                start = stop
                continue
            for k in range(start, stop):
                if not places.is_joined[k + 1]:
                    continue
                share, square = _nearest_on(places.xyz, k, xyz[point])
                if square < best:
                    best = square
                    height = places.xyz[k, 2] + share * (places.xyz[k + 1, 2] - places.xyz[k, 2])
            start = stop
        if best < np.inf:
            found[0, point] = xyz[point, 2] - height
            found[1, point] = math.sqrt(best)


@kernel
def _nearest_on(places: Floats, k: int, position: Floats) -> tuple[float, float]:
    """Where between two places is nearest in plan, as a share, and the distance's square, m²."""
    way_x, way_y = places[k + 1, 0] - places[k, 0], places[k + 1, 1] - places[k, 1]
    x, y = position[0] - places[k, 0], position[1] - places[k, 1]
    square = way_x * way_x + way_y * way_y
    share = min(1.0, max(0.0, (x * way_x + y * way_y) / square)) if square > 0.0 else 0.0
    return share, (x - share * way_x) ** 2 + (y - share * way_y) ** 2


def warm_up() -> None:
    """Compile the kernels."""
    places = TrajectoryPlaces(np.arange(2.0), np.zeros((2, 3)), np.zeros(2), np.ones(2, np.bool_))
    xyz, known = np.zeros((2, 3)), np.ones(2, np.bool_)
    beside_kernel(xyz, np.zeros(2), known, places, np.empty((2, 2), np.float32))
