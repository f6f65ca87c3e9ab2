"""The angle of the mirror for each point: from the scanner's frame, or as the file delivers it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.recording.columns.point_source import PointColumns, PointSource, samples_of
from processing.recording.revolutions.rotation_fit import PlanePoints, fit_rotation
from processing.recording.revolutions.scan_plane import ScanPlane, find_plane
from processing.recording.revolutions.vehicle_frame import Poses

_WINDOWS = 5
"""Pieces of a recording that are looked at; their median counts."""

_WINDOW_S = 0.1
"""Length of a piece: several revolutions."""

_POINTS_PER_WINDOW = 700
"""Points of a piece."""

_SAMPLE_POINTS = 60_000
"""Points read for each piece."""

_FLATTEST = 0.1
"""As in `periodicity`, for pieces of any plane. By trial; no measurement is recorded."""

_LEAST_COHERENCE = 0.75
"""How well directions follow one rotation, 0 to 1. By trial; no measurement is recorded."""

_LEAST_POINTS = 200
"""Points of all pieces together. By trial; no measurement is recorded."""

_STARTS_M = ((0.0, 0.0), (-2.0, 0.0))
"""Where the centre is looked for, m down and aside in the scan plane: at the trajectory's reference
point, and as high above it as a roof is above an axle. By trial; no measurement is recorded."""

_BINS_PER_RADIAN, _LEAST_BINS = 4, 14
"""Delivered angles are counted by quarters of a radian, 26 of which make a circle: a mirror that
only swings fills half of them at most."""

_LEAST_DELIVERED_COHERENCE = 0.95
"""As `_LEAST_COHERENCE` where the file has the angles: they are those of the mirror itself. By
trial; no measurement is recorded."""

_LOW_SHARE = 0.4
"""Share of a piece's points, the lowest ones, whose middle direction is down. By trial; no
measurement is recorded."""

_TRIED_STARTS = 32
"""Where in a sample a piece may begin: the densest is taken, so that a gap isn't."""


class MirrorAngle(Protocol):
    """Gives angles that rise or fall by a full circle a revolution."""

    def angles(self, points: PointColumns, every: int) -> tuple[Floats, Floats]:
        """Every n-th point's time and angle, rad; points of which nothing is known left out."""


@dataclass(frozen=True)
class SeenAngle:
    """Angles about the scanner's centre in its plane, in the vehicle's frame.

    Attributes
    ----------
    centre : (2,) float64
        m, in the plane.
    height_m : float
        Of the centre above the trajectory's reference point.
    """

    poses: Poses
    plane: ScanPlane
    centre: Floats
    height_m: float

    def angles(self, points: PointColumns, every: int) -> tuple[Floats, Floats]:
        """Every n-th point's time and angle; 0 is down where the plane knows it."""
        time, beam = self.poses.beams(points, every)
        flat = self.plane.project(beam) - self.centre
        return time, np.arctan2(flat[:, 1], flat[:, 0])


@dataclass(frozen=True)
class DeliveredAngle:
    """Angles as the file has them."""

    def angles(self, points: PointColumns, every: int) -> tuple[Floats, Floats]:
        """Every n-th point's time and mirror angle."""
        if points.scan_angle_deg is None:
            message = "these points have no scan angle"
            raise ValueError(message)
        angle = np.radians(points.scan_angle_deg[::every].astype(np.float64))
        return np.ascontiguousarray(points.time[::every]), angle


@dataclass(frozen=True)
class MirrorRotation:
    """A mirror found to turn.

    Attributes
    ----------
    rate_hz : float
        Signed by the sense in which the angle runs.
    fold_angle : float
        Angle, rad, at which a revolution is below the vehicle, as far as known without crossings.
    """

    mirror: MirrorAngle
    rate_hz: float
    fold_angle: float
    coherence: float


def find_seen_spin(points: PointSource, poses: Poses) -> MirrorRotation | None:
    """The turning mirror as seen from the vehicle; None when none is.

    Notes
    -----
    1. In some short windows over the drive, beams are brought to the vehicle's frame.
    2. The plane in which they lie has the spin axis as its normal.
    3. In it, rate and centre are fitted together (:func:`fit_rotation`).
    """
    beams, window, time = _windows(points, poses)
    if time.size < _LEAST_POINTS:
        return None
    plane = find_plane(beams, np.ones((time.size, 1)), reference=np.zeros(3))
    if plane.flatness > _FLATTEST:
        return None
    flat = PlanePoints(plane.project(beams), time, window)
    fit = fit_rotation(flat, [np.array(start) for start in _STARTS_M], moves=False)
    if fit.coherence < _LEAST_COHERENCE:
        return None
    level = float(np.median(beams @ plane.normal)) * plane.normal[2]
    height = level + float(plane.axes[:, 2] @ fit.centre)
    mirror = SeenAngle(poses, plane, fit.centre, height)
    rays = flat.position - fit.centre
    fold = 0.0 if plane.knows_down else _opposite_of_gap(np.arctan2(rays[:, 1], rays[:, 0]))
    return MirrorRotation(mirror, fit.rate_hz, fold, fit.coherence)


def find_delivered_spin(points: PointSource) -> MirrorRotation | None:
    """The turning mirror from delivered scan angles; None when they don't make full revolutions."""
    mirror = DeliveredAngle()
    times, angles, windows, heights = [], [], [], []
    for number, sample in enumerate(samples_of(points, _WINDOWS, _SAMPLE_POINTS)):
        part = _window_of(sample)
        every = max(1, part.count // _POINTS_PER_WINDOW)
        time, angle = mirror.angles(part, every)
        times.append(time - time.mean())
        angles.append(angle)
        windows.append(np.full(time.size, number, dtype=np.int64))
        heights.append(part.xyz[::every, 2] - float(np.mean(part.xyz[:, 2])))
    time, angle = np.concatenate(times), np.concatenate(angles)
    turned = np.mod(angle, 2 * np.pi)
    bins = np.bincount((turned * _BINS_PER_RADIAN).astype(int))
    if time.size < _LEAST_POINTS or np.count_nonzero(bins) < _LEAST_BINS:
        return None
    circle = PlanePoints(
        np.column_stack([np.cos(angle), np.sin(angle)]), time, np.concatenate(windows)
    )
    fit = fit_rotation(circle, [np.zeros(2)], moves=False)
    if fit.coherence < _LEAST_DELIVERED_COHERENCE:
        return None
    height = np.concatenate(heights)
    low = height < np.quantile(height, _LOW_SHARE)
    fold = float(np.angle(np.mean(np.exp(1j * angle[low]))))
    return MirrorRotation(mirror, fit.rate_hz, fold, fit.coherence)


def _windows(points: PointSource, poses: Poses) -> tuple[Floats, NDArray[np.int64], Floats]:
    beams, windows, times = [], [], []
    for number, sample in enumerate(samples_of(points, _WINDOWS, _SAMPLE_POINTS)):
        part = _window_of(sample)
        every = max(1, part.count // _POINTS_PER_WINDOW)
        time, beam = poses.beams(part, every)
        if time.size == 0:
            continue
        beams.append(beam)
        times.append(time - time.mean())
        windows.append(np.full(time.size, number, dtype=np.int64))
    if not beams:
        return np.empty((0, 3)), np.empty(0, dtype=np.int64), np.empty(0)
    return np.concatenate(beams), np.concatenate(windows), np.concatenate(times)


def _window_of(sample: PointColumns) -> PointColumns:
    """The densest tenth of a second of a sample."""
    time = sample.time
    starts = np.linspace(0, max(0, time.size - 2), _TRIED_STARTS).astype(np.int64)
    stops = np.searchsorted(time, time[starts] + _WINDOW_S)
    best = int(np.argmax(stops - starts))
    return sample.chunk(int(starts[best]), int(stops[best]))


def _opposite_of_gap(angle: Floats) -> float:
    """Opposite of the middle of the widest arc without returns: the sky."""
    ordered = np.sort(np.mod(angle, 2 * np.pi))
    gaps = np.diff(ordered, append=ordered[0] + 2 * np.pi)
    at = int(np.argmax(gaps))
    return float(ordered[at] + gaps[at] / 2 + np.pi)
