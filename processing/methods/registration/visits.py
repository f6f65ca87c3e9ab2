"""Visits: what each drive saw of a part of the survey, every time it came by.

A survey is worked through in square parts of the plan. The vehicle is within reach of a part for a
while at a time; the points of that while are a stretch of the recording, so that no index is
needed and memory holds one part.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.methods.registration.drift_correction import DriftCorrection
from processing.methods.registration.tracks import Track
from processing.recording.drive import Drive
from processing.recording.vehicle_path.trajectory import Trajectory

REACH_M = 30.0
"""Farther points are sparse, and an error of the angles moves them too much to be told from one of
the place."""

PART_M = 50.0
"""Side of a part of the plan."""

_APART_S = 5.0
"""The vehicle came by twice where it was out of reach for longer."""

_LOOKED_AT_S = 0.1
_READ_POINTS = 500_000
_RUN = 64
_MOST_POINTS = 3_000_000
"""Of a visit: more are thinned out, evenly over its time, as while the vehicle waits."""


@dataclass(frozen=True)
class Area:
    """A square of the plan.

    Attributes
    ----------
    east, north : float
        Of its lower left corner, m, project CRS.
    side_m : float
    reach_m : float
        Points farther from the vehicle are left out.
    """

    east: float
    north: float
    side_m: float
    reach_m: float = REACH_M

    @property
    def low(self) -> Floats:
        """(2,) its lower left corner."""
        return np.array([self.east, self.north])


@dataclass(frozen=True, eq=False)
class Visit:
    """What a drive saw of a part while the vehicle came by once.

    Attributes
    ----------
    drive : int
        Among the drives of the survey.
    xyz : (n, 3) float64
        m about the survey's origin.
    time : (n,) float64
    intensity : (n,) float64
    """

    drive: int
    xyz: Floats
    time: Floats
    intensity: Floats


@dataclass(frozen=True, eq=False)
class Survey:
    """Drives that are registered together.

    Attributes
    ----------
    drives : tuple of Drive
    tracks : tuple of Track
    origin : (3,) float64
        m, project CRS; whole metres.
    """

    drives: tuple[Drive, ...]
    tracks: tuple[Track, ...]
    origin: Floats

    def track_of(self, drive: int) -> int:
        """Number of the track along which a drive was recorded."""
        return next(n for n, track in enumerate(self.tracks) if drive in track.drives)

    def parts(self) -> list[Area]:
        """The parts of the plan that any vehicle came through or near, in order."""
        seen: set[tuple[int, int]] = set()
        for track in self.tracks:
            cells = np.floor((track.trajectory.xyz[:, :2] - self.origin[:2]) / PART_M)
            columns, rows = np.unique(cells.astype(np.int64), axis=0).T
            for east in (-1, 0, 1):
                for north in (-1, 0, 1):
                    beside = zip((columns + east).tolist(), (rows + north).tolist(), strict=True)
                    seen.update(beside)
        return [
            Area(self.origin[0] + east * PART_M, self.origin[1] + north * PART_M, PART_M)
            for east, north in sorted(seen)
        ]


def visits_of(
    survey: Survey,
    area: Area,
    corrections: Sequence[DriftCorrection] | None,
    *,
    check: Callable[[], None],
    fewest: int = 2,
) -> list[Visit]:
    """All visits to an area; points are moved by corrections where there are any.

    An area to which fewer than ``fewest`` came has nothing to compare, so it gives none.

    Parameters
    ----------
    check : callable
        Asked now and then; may raise Cancelled.
    """
    whiles = [
        _While(number, first, last)
        for track in survey.tracks
        for first, last in _whiles(track.trajectory, area)
        for number in track.drives
    ]
    if len(whiles) < fewest:
        return []
    visits = [_visit(survey, one, area, corrections, check) for one in whiles]
    return [one for one in visits if one.time.size]


@dataclass(frozen=True)
class _While:
    drive: int
    first: float
    last: float


def _whiles(trajectory: Trajectory, area: Area) -> Iterator[tuple[float, float]]:
    """Times from and to which the vehicle was within reach, going one way."""
    step = max(1, int(_LOOKED_AT_S / max(float(np.median(np.diff(trajectory.time))), 1e-6)))
    time = trajectory.time[::step]
    away = np.abs(trajectory.xyz[::step, :2] - (area.low + area.side_m / 2)).max(axis=1)
    near = np.flatnonzero(away < area.side_m / 2 + area.reach_m)
    if not near.size:
        return
    heading = np.radians(trajectory.roll_pitch_heading_deg[::step, 2])
    begin = near[0]
    for before, now in pairwise(near.tolist()):
        is_apart = time[now] - time[before] > _APART_S
        if is_apart or np.cos(heading[now] - heading[begin]) < 0:
            yield float(time[begin]), float(time[before])
            begin = now
    yield float(time[begin]), float(time[near[-1]])


def _visit(
    survey: Survey,
    span: _While,
    area: Area,
    corrections: Sequence[DriftCorrection] | None,
    check: Callable[[], None],
) -> Visit:
    drive = survey.drives[span.drive]
    track = survey.tracks[survey.track_of(span.drive)].trajectory
    times = drive.columns["time"]
    ends = [span.first - _LOOKED_AT_S, span.last + _LOOKED_AT_S]
    start, stop = np.searchsorted(times, ends).tolist()
    kept: list[tuple[Floats, Floats, Floats]] = []
    for begin in range(start, stop, _READ_POINTS):
        check()
        end = min(stop, begin + _READ_POINTS)
        xyz = drive.coordinates.chunk_xyz(begin, end)
        at = xyz[:, :2] - area.low
        inside = np.flatnonzero(((at >= 0) & (at < area.side_m)).all(axis=1))
        time = np.array(times[begin:end], np.float64)[inside]
        near = _is_near(track, time, xyz[inside], area.reach_m)
        inside, time = inside[near], time[near]
        intensity = drive.columns["intensity"][begin:end][inside].astype(np.float64)
        kept.append((xyz[inside], time, intensity))
    if not kept:
        return Visit(span.drive, np.empty((0, 3)), np.empty(0), np.empty(0))
    xyz, time, intensity = (np.concatenate(one) for one in zip(*kept, strict=True))
    chosen = _thinned(time.size)
    xyz, time, intensity = xyz[chosen], time[chosen], intensity[chosen]
    if corrections is not None:
        xyz = xyz + corrections[span.drive].shifts(time, xyz)
    return Visit(span.drive, xyz - survey.origin, time, intensity)


def _is_near(trajectory: Trajectory, time: Floats, xyz: Floats, reach_m: float) -> Flags:
    square = np.zeros(time.size)
    for axis in range(3):
        square += (np.interp(time, trajectory.time, trajectory.xyz[:, axis]) - xyz[:, axis]) ** 2
    return np.asarray(square < reach_m**2)


def _thinned(count: int) -> slice | Integers:
    """Whole short runs of points, evenly: neighbours on a scan line stay together."""
    if count <= _MOST_POINTS:
        return slice(None)
    share = max(2, -(-count // _MOST_POINTS))
    chosen = np.arange(0, count, _RUN)[::share]
    points = (chosen[:, None] + np.arange(_RUN)).reshape(-1)
    return np.asarray(points[points < count])
