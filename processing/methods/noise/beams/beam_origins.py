"""Where the beams of a recording began, found from the points alone.

Within a revolution the beam sweeps at a steady rate about one centre, and noise, too, lies along
its beam; so a few revolutions say where the centre is. With a trajectory it stays at one position
in the vehicle, which serves the whole drive; without, every stretch of revolutions has its own.

Where a constant says “by trial”, no measurement varied it alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.worked_ahead import in_order
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from processing.recording.vehicle_path.trajectory import Trajectory

_Floats = NDArray[np.float64]

_MOMENTS = 24
"""Moments, spread over a drive, whose centres are found; by trial, so that some that fail are no
harm to the median."""

_REVOLUTIONS = 2.0
"""Revolutions around a moment: the vehicle moves by some decimetres meanwhile, far less than what
they show. By trial."""

_MOST_POINTS = 4_000
"""Of a moment, evenly chosen: more don't make the centre surer, by trial."""

_FEWEST_POINTS, _FEWEST_RADIANS = 60, 0.7
"""Of a moment, and the angle (40°) that they span: fewer or narrower ones don't tell a centre. By
trial."""

_NEAR_M = 100.0
"""From the middle of a moment's points; farther ones are spikes or tell little. By trial."""

_PLANE_ROUNDS = 3
"""Rounds in which the plane of the beams is fitted and what lies off it is left out; by trial."""

_OFF_PLANE_MEDIANS, _OFF_PLANE_M = 4, 0.01
"""Distance from the plane, in medians of all and at least, up to which points are used: about 2.7
standard deviations of a normal distribution, and a scanner's noise."""

_FARTHEST_M = 8.0
"""Of a scanner from the vehicle's reference point: the length of a large van."""

_MOST_MISFIT_M = 0.5
"""How far beams may pass beside their centre, and centres lie from their middle, in the median; by
trial: a scanner is smaller, and beams are asked for directions at metres and more."""

_KNOT_POINTS = 64
"""From point to point at which the scanner's position is worked out, linear between: a fraction of
a revolution, in which it hardly leaves a line."""

_LEAST_SCALE = 1e-9
_LEAST_LENGTH = 1e-12
"""Keep points that all lie at one position from dividing by nothing."""


@dataclass(frozen=True)
class BeamOrigins:
    """The scanner's centre at any point of a drive.

    Attributes
    ----------
    drive : Drive
    in_vehicle : (3,) float64 or None
        Forward, left, up of the trajectory's reference point, m; None without a trajectory.
    points, positions : (k,) int64, (k, 3) float64
        Where there is no trajectory: centres at some points of the recording, m, project CRS.
    """

    drive: Drive
    in_vehicle: _Floats | None
    points: NDArray[np.int64]
    positions: _Floats

    def of(self, points: NDArray[np.int64]) -> _Floats:
        """(n, 3) float64: the origins of the beams of points, m, project CRS."""
        trajectory = self.drive.trajectory
        if self.in_vehicle is not None and trajectory is not None:
            times = np.asarray(self.drive.columns["time"][points], np.float64)
            times = np.clip(times, trajectory.time[0], trajectory.time[-1])
            if times.size <= _KNOT_POINTS or (np.diff(times) < 0).any():
                return _carried(trajectory, times, self.in_vehicle)
            knots = np.append(times[::_KNOT_POINTS], times[-1])
            carried = _carried(trajectory, knots, self.in_vehicle)
            return np.column_stack([np.interp(times, knots, axis) for axis in carried.T])
        return np.column_stack(
            [np.interp(points, self.points, self.positions[:, axis]) for axis in range(3)]
        )


def _carried(trajectory: Trajectory, times: _Floats, in_vehicle: _Floats) -> _Floats:
    """(n, 3): where a point of the vehicle was at some times."""
    turned = trajectory.rotations_at(times) @ in_vehicle
    return np.asarray(trajectory.positions_at(times) + turned)


def beam_origins(drive: Drive) -> BeamOrigins | None:
    """Find the origins; None where there are no revolutions or the points don't tell.

    A standing scanner's own grid has rows, too, and its file says where it stood.
    """
    position = drive.info.scanner_position
    if position is not None and ImageKind.SCAN in drive.image_kinds and drive.count:
        return BeamOrigins(drive, None, np.zeros(1, np.int64), np.array([position]))
    if drive.revolutions is None or drive.count < _FEWEST_POINTS:
        return None
    per_revolution = drive.revolutions.pulses_per_revolution

    def fit(middle: int) -> tuple[int, _Floats | None]:
        return _fit(drive, per_revolution, middle)

    fits = in_order(fit, _middles(drive.count).tolist())
    known = [(point, centre) for point, centre in fits if centre is not None]
    if not known:
        return None
    points = np.array([point for point, _ in known], np.int64)
    positions = np.array([centre for _, centre in known])
    if drive.trajectory is None:
        return BeamOrigins(drive, None, points, positions)
    middle = np.median(positions, axis=0)
    spread = float(np.median(np.linalg.norm(positions - middle, axis=1)))
    if spread > _MOST_MISFIT_M or np.linalg.norm(middle) > _FARTHEST_M:
        return None
    return BeamOrigins(drive, middle, points, positions)


def _middles(count: int) -> NDArray[np.int64]:
    shares = (np.arange(_MOMENTS) + 0.5) / _MOMENTS
    return np.unique((shares * count).astype(np.int64))


def _fit(drive: Drive, per_revolution: float, middle: int) -> tuple[int, _Floats | None]:
    """The centre of the revolutions around a point, in the vehicle's frame where there is one."""
    pulses = drive.columns["pulse"]
    half = _REVOLUTIONS / 2 * per_revolution
    start, stop = (_first_from(pulses, pulses[middle] + off) for off in (-half, half))
    if stop - start < _FEWEST_POINTS:
        return middle, None
    points = np.arange(start, stop, max(1, (stop - start) // _MOST_POINTS))
    xyz = drive.xyz(points)
    if drive.trajectory is not None:
        times = np.asarray(drive.columns["time"][points], np.float64)
        if not drive.trajectory.covers(times).all():
            return middle, None
        xyz = drive.trajectory.to_vehicle(xyz, times)
    angles = (np.asarray(pulses[points]) - pulses[start]) * (2 * np.pi / per_revolution)
    return middle, _centre(xyz, angles)


def _first_from(pulses: NDArray[np.int64], least: float) -> int:
    """The first point from a pulse on; a number of their own kind spares a copy of all."""
    return int(np.searchsorted(pulses, pulses.dtype.type(math.ceil(least))))


def _centre(xyz: _Floats, angles: _Floats) -> _Floats | None:
    """(3,): the centre from which beams at these angles of one plane pass through the points."""
    middle = np.median(xyz, axis=0)
    near = np.linalg.norm(xyz - middle, axis=1) <= _NEAR_M
    used = near.copy()
    for _ in range(_PLANE_ROUNDS):
        mean = xyz[used].mean(axis=0)
        _, _, axes = np.linalg.svd(xyz[used] - mean, full_matrices=False)
        away = np.abs((xyz - mean) @ axes[2])
        usual = float(np.median(away[near]))
        used = near & (away <= max(_OFF_PLANE_MEDIANS * usual, _OFF_PLANE_M))
        if used.sum() < _FEWEST_POINTS:
            return None
    if np.ptp(angles[used]) < _FEWEST_RADIANS:
        return None
    flat = (xyz[used] - mean) @ axes[:2].T
    found = [_turned_centre(flat, sense * angles[used]) for sense in (1.0, -1.0)]
    (centre, misfit) = min(found, key=lambda one: one[1])
    if misfit > _MOST_MISFIT_M:
        return None
    position: _Floats = mean + centre @ axes[:2]
    return position


def _turned_centre(flat: _Floats, angles: _Floats) -> tuple[_Floats, float]:
    """Centre and misfit (m) of beams at known angle differences, all in one plane."""
    x, y = flat.T
    sines, cosines = np.sin(angles), np.cos(angles)
    scale = max(float(np.abs(flat).max()), _LEAST_SCALE)
    rows = np.column_stack(
        [(x * sines - y * cosines) / scale, (x * cosines + y * sines) / scale, -sines, -cosines]
    )
    _, values, basis = np.linalg.svd(rows, full_matrices=False)
    cos_p, sin_p, a, b = basis[-1]
    length = max(float(np.hypot(cos_p, sin_p)), _LEAST_LENGTH)
    cos_p, sin_p, a, b = cos_p / length, sin_p / length, a * scale / length, b * scale / length
    centre = np.array([a * cos_p + b * sin_p, a * sin_p - b * cos_p])
    return centre, float(values[-1]) / length * scale / np.sqrt(angles.size)
