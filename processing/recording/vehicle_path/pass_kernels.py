"""Where points lie along and beside a path: the loops over points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel

_MOST_STEPS = 20
"""Of Newton's method; it ends within three but in sharp bends."""

_NEAR_M = 1e-3
"""From so near on what is left is its square times the bend: some ten-thousandth of a
millimetre."""

_FLATTENED, _RECORDS_AHEAD = 0.1, 8
"""Share of `LEAST_STRETCH` below which a step leads nowhere; records of the vehicle that are looked
through one by one before a search: times of points rise."""

_LONGEST_STEP_M = 5.0
"""A step is no longer, so that it stays in the bend it began in."""

LEAST_STRETCH = 0.25
"""How much of a metre along the vehicle's path a metre beside it must be: towards the
centre of a bend the sections come together, and beyond it they cross."""


class PathPlaces(NamedTuple):
    """A vehicle path: its step, m, positions (m, 3) and directions (m, 2)."""

    step_m: float
    positions: Floats
    directions: Floats


class Passage(NamedTuple):
    """When the vehicle was where: times, s, and stations, m."""

    times: Floats
    stations: Floats


class PathReach(NamedTuple):
    """How far along and in plan from the vehicle a place may be; between which heights (m, 2)."""

    reach_m: float
    far_m: float
    heights: Floats


@kernel
def _solve_station(
    east: float, north: float, guess: float, step_m: float, positions: Floats, directions: Floats
) -> tuple[float, float]:
    """Station and across of a place; NaN, NaN where no section near the guess holds it.

    The section at station s holds p where (p − path(s)) · direction(s) = 0, which is solved by
    Newton's steps from the guess. Beyond an end the path goes straight on.
    """
    last = positions.shape[0] - 1
    per_step = 1.0 / step_m
    station = guess
    for _ in range(_MOST_STEPS):
        u = station * per_step
        i = min(max(int(u), 0), last - 1)
        u -= i
        v = min(max(u, 0.0), 1.0)
        start_e, start_n = directions[i, 0], directions[i, 1]
        bend_e, bend_n = directions[i + 1, 0] - start_e, directions[i + 1, 1] - start_n
        along_e, along_n = start_e + v * bend_e, start_n + v * bend_n
        if u == v:
            way_e, way_n = (
                positions[i + 1, 0] - positions[i, 0],
                positions[i + 1, 1] - positions[i, 1],
            )
            from_e, from_n = east - positions[i, 0] - u * way_e, north - positions[i, 1] - u * way_n
            stretch = way_e * along_e + way_n * along_n - from_e * bend_e - from_n * bend_n
            stretch *= per_step
        else:
            end = 0 if u < 0.0 else last
            beyond = (u - v) * step_m
            from_e = east - positions[end, 0] - beyond * along_e
            from_n = north - positions[end, 1] - beyond * along_n
            stretch = 1.0
        ahead = from_e * along_e + from_n * along_n
        if stretch < _FLATTENED * LEAST_STRETCH:
            break
        station += min(max(ahead / stretch, -_LONGEST_STEP_M), _LONGEST_STEP_M)
        if abs(ahead) < _NEAR_M:
            # What is left is its square times the bend: some ten-thousandth of a millimetre.
            if stretch < LEAST_STRETCH:
                break
            return station, from_e * along_n - from_n * along_e
    return np.nan, np.nan


@kernel
def _height_at(station: float, step_m: float, positions: Floats) -> float:
    last = positions.shape[0] - 1
    u = min(max(station / step_m, 0.0), float(last))
    i = min(int(u), last - 1)
    return float(positions[i, 2] + (u - i) * (positions[i + 1, 2] - positions[i, 2]))


@kernel
def _may_count(
    local: Floats,
    station: float,
    vehicle_path: PathPlaces,
    far_m: float,
    heights: Floats,
) -> bool:
    """Whether a place (3,) may lie beside a station's neighbourhood: to solve takes most time."""
    step_m, positions, _ = vehicle_path
    i = min(max(int(station / step_m), 0), positions.shape[0] - 1)
    east, north = local[0] - positions[i, 0], local[1] - positions[i, 1]
    return bool(
        east * east + north * north <= far_m * far_m and heights[i, 0] <= local[2] <= heights[i, 1]
    )


@kernel
def stations_kernel(
    local: Floats,
    time: Floats,
    vehicle_path: PathPlaces,
    passed: Passage,
    reach: PathReach,
    found: Floats,
) -> None:
    """Station, across and height above the path of points, (n, 3) into ``found``; NaN where none.

    ``local`` (n, 3) is about the vehicle path's origin; heights are at each step of the path.
    """
    step_m, positions, directions = vehicle_path
    times, stations = passed
    reach_m, far_m, heights = reach
    j, last = 0, times.shape[0] - 2
    for i in range(local.shape[0]):
        found[i, 0], found[i, 1], found[i, 2] = np.nan, np.nan, np.nan
        if not (times[0] <= time[i] <= times[last + 1]):
            continue
        if times[j] > time[i] or times[min(j + _RECORDS_AHEAD, last)] < time[i]:
            j = min(max(np.searchsorted(times, time[i]) - 1, 0), last)
        while j < last and times[j + 1] < time[i]:
            j += 1
        share = (time[i] - times[j]) / (times[j + 1] - times[j])
        guess = stations[j] + share * (stations[j + 1] - stations[j])
        if not _may_count(local[i], guess, vehicle_path, far_m, heights):
            continue
        station, across = _solve_station(
            local[i, 0], local[i, 1], guess, step_m, positions, directions
        )
        if abs(station - guess) <= reach_m:
            found[i, 0], found[i, 1] = station, across
            found[i, 2] = local[i, 2] - _height_at(station, step_m, positions)


@kernel
def records_kernel(
    local: Floats, guesses: Floats, vehicle_path: PathPlaces, stations: Floats
) -> None:
    """The station of each record of the vehicle itself, never less than the one before."""
    step_m, positions, directions = vehicle_path
    length = step_m * (positions.shape[0] - 1)
    reached = 0.0
    for i in range(local.shape[0]):
        station, _ = _solve_station(
            local[i, 0], local[i, 1], guesses[i], step_m, positions, directions
        )
        if np.isnan(station):
            station = guesses[i]
        reached = max(reached, min(station, length))
        stations[i] = reached


@kernel
def advanced_kernel(stations: Floats, least_m: float, kept: NDArray[np.bool_]) -> None:
    """Mark the first and each that lies so far ahead of the one marked before."""
    last = -np.inf
    for i in range(stations.shape[0]):
        if stations[i] - last >= least_m:
            kept[i] = True
            last = stations[i]


def warm_up() -> None:
    """Compile the kernels."""
    positions = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    vehicle_path = PathPlaces(1.0, positions, np.array([[1.0, 0.0]] * 3))
    passed = Passage(np.arange(3.0), np.arange(3.0))
    reach = PathReach(9.0, 9.0, np.zeros((3, 2)))
    stations_kernel(positions, np.arange(3.0), vehicle_path, passed, reach, np.empty((3, 3)))
    records_kernel(positions, np.arange(3.0), vehicle_path, np.empty(3))
    advanced_kernel(np.arange(3.0), 0.5, np.zeros(3, np.bool_))
