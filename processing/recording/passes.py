"""Passes: stretches of a drive in which the vehicle goes on, measured along its smoothed path.

A pass ends where the vehicle turns back and where its trajectory has a gap. A stop is part of a
pass: time goes on there and the station stays. What lies beside the vehicle's path has the
station of the path driven about the time of its measurement, so two passes of one street stay
apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from processing.core.arrays import Floats
from processing.core.errors import MissingInput
from processing.core.text import Text
from processing.recording.drive import Drive
from processing.recording.vehicle_path.pass_kernels import (
    Passage,
    PathPlaces,
    PathReach,
    records_kernel,
    stations_kernel,
)
from processing.recording.vehicle_path.smooth_path import (
    SmoothPath,
    apart,
    monotone_runs,
    smooth_way,
)
from processing.recording.vehicle_path.trajectory import LONGEST_GAP_S, Trajectory

REACH_M = 25.0
"""A beam that leaves at 45° meets a place 15 m aside as far ahead, in bends somewhat farther."""

_FAR_M = 60.0
"""Farther from the vehicle than this in plan a place has no station: points on the ground are
sparse there, and in bends sections cross."""

_SHORTEST_M = 1.0
"""A shorter drive between two stops is no pass: manoeuvring."""

_MARGIN_M = 0.01
"""Heights are looked at so much farther than asked: rounding of the smooth path."""


@dataclass(frozen=True)
class PathSurroundings:
    """Which positions beside a path are asked for; of others nothing need be known.

    Attributes
    ----------
    far_m : float
        No position is farther from the vehicle in plan.
    heights : (m, 2) float64
        Lowest and highest at each step of the path, m about the origin.
    """

    far_m: float
    heights: Floats


@dataclass(frozen=True, eq=False)
class Pass:
    """One stretch of a drive.

    Attributes
    ----------
    number : int
        Among the passes of its drive.
    origin : (3,) float64
        The local origin, m, project CRS.
    vehicle_path : SmoothPath
        About the origin.
    times : (m,) float64
        Of the vehicle's records, rising strictly, s on the trajectory's clock.
    stations_m : (m,) float64
        Of the records, never falling; alike while the vehicle stands.
    """

    number: int
    origin: Floats
    vehicle_path: SmoothPath
    times: Floats
    stations_m: Floats

    @property
    def length_m(self) -> float:
        """Its length in plan; stations go from 0 to it, and straight on beyond."""
        return self.vehicle_path.length_m

    def station_at(self, times: ArrayLike) -> Floats:
        """The vehicle's own station at times, that of the nearer end outside: like ``times``, m."""
        found: Floats = np.interp(np.asarray(times, dtype=np.float64), self.times, self.stations_m)
        return found

    def time_at(self, stations_m: ArrayLike) -> Floats:
        """When the vehicle came to stations first, s; like ``stations_m``."""
        is_new = np.concatenate([[True], np.diff(self.stations_m) > 0])
        known, times = self.stations_m[is_new], self.times[is_new]
        passed: Floats = np.interp(np.asarray(stations_m, dtype=np.float64), known, times)
        return passed

    def time_nearest(self, position: ArrayLike) -> float:
        """When the vehicle was nearest to a place in plan, s."""
        away = (
            self.vehicle_path.positions[:, :2]
            + self.origin[:2]
            - np.asarray(position, dtype=np.float64)[:2]
        )
        nearest = int((away**2).sum(axis=1).argmin())
        return float(self.time_at(nearest * self.vehicle_path.step_m))

    def directions_at(self, stations_m: ArrayLike) -> Floats:
        """Unit vectors in plan along the vehicle's path: (n, 2) float64."""
        along = self._interpolate_values(
            self.vehicle_path.directions, np.asarray(stations_m, dtype=np.float64)
        )
        units: Floats = along / np.hypot(along[:, 0], along[:, 1])[:, None]
        return units

    def rights_at(self, stations_m: ArrayLike) -> Floats:
        """Unit vectors in plan to the right of the path: (n, 2) float64."""
        along = self.directions_at(stations_m)
        return np.column_stack([along[:, 1], -along[:, 0]])

    def positions_at(self, stations_m: ArrayLike) -> Floats:
        """Where the path is, straight on and level beyond its ends: (n, 3) float64, project CRS."""
        stations = np.asarray(stations_m, dtype=np.float64)
        positions = self._interpolate_values(self.vehicle_path.positions, stations)
        beyond = stations - np.clip(stations, 0.0, self.length_m)
        positions[:, :2] += beyond[:, None] * self.directions_at(stations)
        return positions + self.origin

    def xyz_at(self, stations_m: ArrayLike, across_m: ArrayLike) -> Floats:
        """Places beside the vehicle's path at its height: (n, 3) float64, m, project CRS."""
        positions = self.positions_at(stations_m)
        across = np.asarray(across_m, dtype=np.float64)
        positions[:, :2] += across[:, None] * self.rights_at(stations_m)
        return positions

    def stations_of(self, xyz: ArrayLike, time: ArrayLike) -> tuple[Floats, Floats]:
        """Where measured points lie along the path and beside it.

        Parameters
        ----------
        xyz : (n, 3) float64
            m, project CRS.
        time : (n,) float64
            When they were measured, s on the trajectory's clock. In any order, fastest as they
            were measured.

        Returns
        -------
        station : (n,) float64
            m; NaN for points outside the times of the pass, farther than `REACH_M` along the
            vehicle's path from the vehicle, and about the centre of a bend, where sections cross.
        across : (n,) float64
            m to the right of the path; NaN likewise.
        """
        local = np.asarray(xyz, dtype=np.float64).reshape(-1, 3) - self.origin
        found = self.stations_of_local(local, np.asarray(time, dtype=np.float64))
        return np.ascontiguousarray(found[:, 0]), np.ascontiguousarray(found[:, 1])

    def stations_of_local(
        self, local: Floats, time: Floats, asked: PathSurroundings | None = None
    ) -> Floats:
        """The same for positions about the origin, with the height above the path: (n, 3) float64.

        Where only some positions are ``asked`` for, the others may be NaN too.
        """
        found = np.empty((len(local), 3))
        if asked is None:
            asked = PathSurroundings(
                _FAR_M, np.tile([-np.inf, np.inf], (len(self.vehicle_path.positions), 1))
            )
        stations_kernel(
            np.ascontiguousarray(local),
            np.ascontiguousarray(time),
            self._kernel_path,
            Passage(self.times, self.stations_m),
            PathReach(REACH_M, float(asked.far_m), asked.heights),
            found,
        )
        return found

    def beside(self, half_width_m: float, lowest_m: float, highest_m: float) -> PathSurroundings:
        """What holds all positions so near to the path and between two heights above it."""
        step_m, z = self.vehicle_path.step_m, self.vehicle_path.positions[:, 2]
        size = 2 * (int(REACH_M / step_m) + 2) + 1
        low, high = minimum_filter1d(z, size), maximum_filter1d(z, size)
        heights = np.column_stack([low + lowest_m - _MARGIN_M, high + highest_m + _MARGIN_M])
        return PathSurroundings(min(_FAR_M, REACH_M + half_width_m + 2 * step_m), heights)

    @property
    def _kernel_path(self) -> PathPlaces:
        path = self.vehicle_path
        return PathPlaces(path.step_m, path.positions, path.directions)

    def _interpolate_values(self, values: NDArray[Any], stations: Floats) -> Floats:
        known = np.arange(len(values)) * self.vehicle_path.step_m
        return np.column_stack([np.interp(stations, known, axis) for axis in values.T])


def passes_of(drive: Drive) -> tuple[Pass, ...]:
    """The passes of a drive, in the order of time; none where the vehicle only stood.

    Raises
    ------
    MissingInput
        The drive has no trajectory.
    """
    if drive.trajectory is None:
        raise MissingInput(
            Text("The drive has no trajectory.", "走行データに走行軌跡がありません。"),
            Text.same(drive.info.name),
            Text(
                "Import it again together with its trajectory.",
                "走行軌跡と一緒にインポートし直してください。",
            ),
        )
    return passes_of_trajectory(drive.trajectory)


def passes_of_trajectory(trajectory: Trajectory) -> tuple[Pass, ...]:
    """The passes of a trajectory, in the order of time."""
    gaps = np.flatnonzero(np.diff(trajectory.time) > LONGEST_GAP_S) + 1
    ends = [0, *gaps.tolist(), trajectory.time.size]
    passes: list[Pass] = []
    for first, end in pairwise(ends):
        for start, stop in monotone_runs(trajectory.xyz[first:end]):
            run = slice(first + start, first + stop)
            found = _pass_of(len(passes), trajectory.time[run], trajectory.xyz[run])
            if found is not None:
                passes.append(found)
    return tuple(passes)


def _pass_of(number: int, time: Floats, xyz: Floats) -> Pass | None:
    if time.size < 2:
        return None
    origin = np.floor(xyz.min(axis=0))
    local = np.ascontiguousarray(xyz - origin)
    vehicle_path = smooth_way(local)
    if vehicle_path is None or vehicle_path.length_m < _SHORTEST_M:
        return None
    stations = np.empty(time.size)
    guesses = _guesses(local, vehicle_path)
    records_kernel(
        local,
        guesses,
        PathPlaces(vehicle_path.step_m, vehicle_path.positions, vehicle_path.directions),
        stations,
    )
    return Pass(number, origin, vehicle_path, np.ascontiguousarray(time), stations)


def _guesses(local: Floats, vehicle_path: SmoothPath) -> Floats:
    """About where on the path each record is, by what was driven apart from all trembling."""
    marks = apart(local)
    driven = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(local[marks, :2], axis=0).T))])
    driven *= vehicle_path.length_m / max(float(driven[-1]), vehicle_path.length_m / 2)
    guesses: Floats = np.interp(np.arange(len(local)), marks, driven)
    return guesses
