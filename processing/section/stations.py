"""Stations: metres along a line, where they are, and the cuts across and along it there."""

from __future__ import annotations

from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.recording.vehicle_path.smooth_path import apart
from processing.recording.vehicle_path.trajectory import Trajectory
from processing.section.cut import Cut

_CHORD_M = 0.5
"""The direction at a station is that of the chord from so far before to so far behind it: a trace's
own jitter of some centimetres turns it by a few degrees at most."""

_SEARCHED_M = 1.0
"""To either side of the nearest station, within which that square to the line is looked for: twice
the chord's half."""

_EXACT_M = 1e-5
"""To which a station is found: far finer than a millimetre."""

_TURN_M = 1e-3
"""A line whose chord is shorter turns back there: both ends are at one position to a millimetre."""

_DRAWN_STEP_M, _DRIVEN_STEP_M = 1e-3, 0.05
"""Vertices nearer than this in plan count as one: on drawn lines, written in millimetres, and on
trajectories, which are noisy by some centimetres where a vehicle stands."""


class Stations:
    """A line measured in plan from its first vertex; straight on beyond its ends.

    Parameters
    ----------
    xyz : (m, 3) float64
        Its vertices, m, project CRS.
    is_closed : bool
        Whether it leads back to the first.
    times : (m,) float64 or None
        When each vertex was passed, where the line is a trajectory.

    Attributes
    ----------
    length_m : float
        In plan.
    bounds : tuple of float
        Least easting and northing, greatest easting and northing.

    Raises
    ------
    Unsuitable
        The line has no length in plan.
    """

    def __init__(
        self, xyz: ArrayLike, *, is_closed: bool = False, times: ArrayLike | None = None
    ) -> None:
        positions = np.asarray(xyz, dtype=np.float64).reshape(-1, 3)
        if is_closed and len(positions):
            positions = np.concatenate([positions, positions[:1]])
        kept = _apart(positions, _DRAWN_STEP_M if times is None else _DRIVEN_STEP_M)
        if kept.size < 2:
            raise Unsuitable(
                Text("The line has no length.", "線の長さがありません。"),
                Text("{count} places", "{count} 点").filled(count=len(positions)),
                Text(
                    "Choose a line with two places that are apart in plan.",
                    "平面上で離れた2点以上をもつ線を選んでください。",
                ),
            )
        self._origin = positions[kept[0]].copy()
        self._local = positions[kept] - self._origin
        self._axes = tuple(np.ascontiguousarray(axis) for axis in self._local.T)
        self._times = None if times is None else np.asarray(times, dtype=np.float64)[kept]
        steps = np.hypot(*np.diff(self._local[:, :2], axis=0).T)
        self._stations = np.concatenate([[0.0], np.cumsum(steps)])
        self.length_m = float(self._stations[-1])
        low, high = positions[:, :2].min(axis=0), positions[:, :2].max(axis=0)
        self.bounds: tuple[float, float, float, float] = (*low.tolist(), *high.tolist())

    @classmethod
    def of_trajectory(cls, trajectory: Trajectory) -> Self:
        """The reference point of the vehicle's path."""
        return cls(trajectory.xyz, times=trajectory.time)

    def measured_positions(self) -> tuple[Floats, Floats]:
        """The stations (k,), m, rising, and positions (k, 3), m, project CRS, it is measured by."""
        return self._stations.copy(), self._local + self._origin

    def position_at(self, station_m: float) -> tuple[float, float, float]:
        """Where a station is; before the beginning and behind the end straight on and level."""
        inside = min(max(station_m, 0.0), self.length_m)
        local = np.array([np.interp(inside, self._stations, axis) for axis in self._axes])
        beyond = station_m - inside
        if beyond:
            east, north = self.direction_at(inside)
            local += beyond * np.array([east, north, 0.0])
        easting, northing, height = (local + self._origin).tolist()
        return easting, northing, height

    def direction_at(self, station_m: float) -> tuple[float, float]:
        """Unit vector in plan along the line, over half a metre on either side."""
        inside = min(max(station_m, 0.0), self.length_m)
        ends = np.clip([inside - _CHORD_M, inside + _CHORD_M], 0.0, self.length_m)
        chord = np.array([np.diff(np.interp(ends, self._stations, axis))[0] for axis in self._axes])
        if np.hypot(chord[0], chord[1]) < _TURN_M:  # the line turns back here
            side = int(np.searchsorted(self._stations, inside, side="right")) - 1
            side = min(max(side, 0), len(self._stations) - 2)
            chord = self._local[side + 1] - self._local[side]
        east, north = (chord[:2] / np.hypot(chord[0], chord[1])).tolist()
        return east, north

    def cut_at(self, station_m: float, width_m: float, half_length_m: float) -> Cut:
        """The cut across the line; one looks along it."""
        east, north = self.direction_at(station_m)
        return Cut(self.position_at(station_m), (north, -east), width_m, half_length_m)

    def cut_along(self, station_m: float, width_m: float, half_length_m: float) -> Cut:
        """The cut along the line, which leads to the right; one looks to its left."""
        direction = self.direction_at(station_m)
        return Cut(self.position_at(station_m), direction, width_m, half_length_m)

    def nearest(self, xyz: ArrayLike, between: tuple[float, float] | None = None) -> float:
        """The station nearest to a position in plan, also straight on beyond the ends.

        Parameters
        ----------
        xyz : (3,) float64
            m, project CRS.
        between : tuple of float or None
            Look only between these stations: where a line passes a position several times.
        """
        plan = (np.asarray(xyz, dtype=np.float64) - self._origin)[:2]
        low, high = (0.0, self.length_m) if between is None else between
        first = int(np.searchsorted(self._stations, low, side="right")) - 1
        last = int(np.searchsorted(self._stations, high, side="left"))
        first, last = max(first, 0), min(max(last, first + 1), len(self._stations) - 1)
        first = min(first, last - 1)
        starts = self._local[first:last, :2]
        along = self._local[first + 1 : last + 1, :2] - starts
        lengths = np.hypot(*along.T)
        shares = ((plan - starts) * along).sum(axis=1) / lengths**2
        inside = np.clip(shares, 0.0, 1.0)
        away = np.hypot(*(starts + inside[:, None] * along - plan).T)
        side = int(away.argmin())
        station = float(self._stations[first + side] + inside[side] * lengths[side])
        return self._beyond(station, plan)

    def through(self, xyz: ArrayLike, between: tuple[float, float] | None = None) -> float:
        """The station near a position whose cut across the line goes through it.

        Where the line bends the nearest station need not be it: directions are those of chords.

        Parameters
        ----------
        xyz : (3,) float64
            m, project CRS.
        between : tuple of float or None
            As in :meth:`nearest`, which is the answer where no cut near by goes through it.
        """
        nearest = self.nearest(xyz, between)
        low, high = nearest - _SEARCHED_M, nearest + _SEARCHED_M
        if abs(self._ahead(nearest, xyz)) < _EXACT_M:
            return nearest
        if self._ahead(low, xyz) < 0 or self._ahead(high, xyz) > 0:
            return nearest
        while high - low > _EXACT_M:
            middle = (low + high) / 2
            low, high = (middle, high) if self._ahead(middle, xyz) > 0 else (low, middle)
        return (low + high) / 2

    def distance(self, xyz: ArrayLike, station_m: float) -> float:
        """How far a place is in plan from a station, or from the end that is nearest to it; m."""
        east, north, _ = self.position_at(min(max(station_m, 0.0), self.length_m))
        easting, northing, _ = np.asarray(xyz, dtype=np.float64).tolist()
        return float(np.hypot(easting - east, northing - north))

    def station_at_time(self, time_s: float) -> float | None:
        """Where the vehicle was; None without times and outside of them."""
        times = self._times
        if times is None or not times[0] <= time_s <= times[-1]:
            return None
        return float(np.interp(time_s, times, self._stations))

    def _ahead(self, station_m: float, xyz: ArrayLike) -> float:
        """How far a position lies ahead of the cut at a station; m."""
        from_there = np.asarray(xyz, dtype=np.float64) - np.array(self.position_at(station_m))
        return float(from_there[:2] @ np.array(self.direction_at(station_m)))

    def _beyond(self, station_m: float, plan: Floats) -> float:
        if 0.0 < station_m < self.length_m:
            return station_m
        end = self._local[0 if station_m <= 0.0 else -1, :2]
        ahead = float((plan - end) @ np.array(self.direction_at(station_m)))
        is_outside = ahead < 0 if station_m <= 0.0 else ahead > 0
        return station_m + ahead if is_outside else station_m


def _apart(positions: Floats, step_m: float) -> NDArray[np.int64]:
    """Indices of positions that are so far apart in plan; the last position ends the line."""
    kept = apart(positions, step_m)
    if kept.size > 1:
        kept[-1] = len(positions) - 1
    return kept
