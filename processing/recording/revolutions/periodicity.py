"""The scanner's path found from the points alone, where no trajectory was delivered.

In a few hundredths of a second a line scanner stays nearly in place: its points lie in one plane,
and the only centre in that plane about which their angle keeps step with the clock is the scanner.
"""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.recording.columns.ordering import chunk_ranges
from processing.recording.columns.point_source import PointColumns, PointSource
from processing.recording.revolutions.rotation_fit import PlanePoints, RotationFit, fit_rotation
from processing.recording.revolutions.scan_plane import ScanPlane, find_plane
from processing.recording.vehicle_path.trajectory import Trajectory

_WINDOW_S = 0.06
"""Length of a piece that is looked at: two revolutions of the slowest scanner, within which a
vehicle moves and turns evenly."""

_EVERY_S = 0.2
"""From piece to piece: a vehicle hardly turns within it."""

_MOST_POINTS = 1_500
"""Points of a piece that are looked at."""

_LEAST_POINTS = 200
"""Points that a piece must have. By trial; no measurement is recorded."""

_FLATTEST = 0.05
"""Points flatter than this share of their distance lie in one plane, whose rotation says nothing.
By trial; no measurement is recorded."""

_LEAST_COHERENCE = 0.8
"""How well directions must follow one rotation, 0 to 1: of any directions it is near 0. By trial;
no measurement is recorded."""

_LESS_COHERENT = 0.03
"""By how much a start found nearby may be worse than usual and still be taken without a search. By
trial; no measurement is recorded."""

_STARTS_M = ((-1.5, 0.0), (0.0, 3.0), (0.0, -3.0))
"""Where centres are looked for beside the one before, m along and aside. By trial; no measurement
is recorded."""

_TRIED_IN_VAIN = 8
"""Pieces in which no rotation was found, after which no more are tried. By trial; no measurement is
recorded."""

_LEAST_FOUND = 0.3
"""Share of the pieces in which a rotation must be found: a line scanner shows it in nearly all. By
trial; no measurement is recorded."""

_GAP_S = 3 * _EVERY_S
"""Between pieces: where two and more are missing the vehicle may have stood or turned."""

_MARGIN_S = 1e-3
"""Before the first and behind the last point of a recording: times are known better."""

_NEIGHBOURS = 5
"""Pieces over whose velocities a median is taken: two of them may be wrong."""

_LEAST_LEVEL = 0.2
"""Level part of the spin axis, a unit vector: nearer than 12° to the vertical its azimuth is that
of noise. By trial; no measurement is recorded."""

_STANDS_M_S = 0.5
"""A slower motion is that of the centres' own noise, a few centimetres from piece to piece. By
trial; no measurement is recorded."""

_READ_POINTS = 2_000_000
"""Points read at a time."""


def trajectory_from_points(points: PointSource, monitor: Monitor) -> Trajectory | None:
    """Where the scanner was; None when the points don't tell.

    Returns
    -------
    Trajectory or None
        Of the scanner's centre; the heading follows the turn of the scan plane.
    """
    finder = _CentreFinder()
    next_time = -np.inf
    tried = 0
    for start, stop in chunk_ranges(points.count, _READ_POINTS):
        part = points.chunk(start, stop)
        time = float(part.time[0])
        while True:
            time = max(time, next_time)
            first = int(np.searchsorted(part.time, time))
            if first >= part.count:
                break
            time = float(part.time[first])
            last = int(np.searchsorted(part.time, time + _WINDOW_S))
            next_time = time + _EVERY_S
            monitor.check()
            if last - first >= _LEAST_POINTS:
                finder.add(part.chunk(first, last))
                tried += 1
            if tried >= _TRIED_IN_VAIN and not finder.times:
                return None
    if not finder.times or len(finder.times) < _LEAST_FOUND * tried:
        return None
    ends = (float(points.chunk(0, 1).time[0]), float(part.time[-1]))
    return finder.trajectory(ends)


class _CentreFinder:
    """Finds the scanner's centre window by window; each starts from the one before."""

    def __init__(self) -> None:
        self.times: list[float] = []
        self._centres: list[Floats] = []
        self._velocities: list[Floats] = []
        self._normals: list[Floats] = []
        self._coherences: list[float] = []
        self._rate_hz: float | None = None

    def add(self, window: PointColumns) -> None:
        """Take one window of points; nothing is added when it doesn't tell."""
        part = window.chunk(0, window.count)
        every = max(1, part.count // _MOST_POINTS)
        middle = 0.5 * float(part.time[0] + part.time[-1])
        time = part.time[::every] - middle
        positions = part.quantisation.metres(part.xyz[::every])
        base = np.median(positions, axis=0)
        local = positions - base
        steady = np.column_stack([np.ones(time.size), time])
        plane = find_plane(local, steady)
        if plane.flatness > _FLATTEST:
            return
        fit = self._fit_window(plane, local, time, middle, base)
        if fit.coherence < _LEAST_COHERENCE:
            return
        off_plane = np.linalg.lstsq(steady, local @ plane.normal)[0]
        self.times.append(middle)
        self._coherences.append(fit.coherence)
        self._centres.append(base + fit.centre @ plane.axes + off_plane[0] * plane.normal)
        self._velocities.append(fit.velocity @ plane.axes + off_plane[1] * plane.normal)
        same_side = not self._normals or self._normals[-1] @ plane.normal > 0
        self._normals.append(plane.normal if same_side else -plane.normal)
        self._rate_hz = fit.rate_hz if same_side else -fit.rate_hz

    def trajectory(self, ends: tuple[float, float]) -> Trajectory:
        """All windows together, led on steadily to both ends of the recording."""
        times, centres = np.array(self.times), np.array(self._centres)
        normals = np.array(self._normals)
        velocities = np.array(self._velocities)
        # Each run of windows is led on to its ends: over a gap the vehicle may have stood.
        gaps = np.flatnonzero(np.diff(times) > _GAP_S)
        first = np.concatenate([[0], gaps + 1])
        last = np.concatenate([gaps, [times.size - 1]])
        begins = np.concatenate([[ends[0] - _MARGIN_S], times[first[1:]] - _EVERY_S])
        stops = np.concatenate([times[last[:-1]] + _EVERY_S, [ends[1] + _MARGIN_S]])
        led_times = np.concatenate([begins, times, stops])
        order = np.argsort(led_times)
        led = np.concatenate([first, np.arange(times.size), last])[order]
        times, since = led_times[order], led_times[order] - times[led]
        centres = centres[led] + since[:, None] * _smooth_velocities(velocities)[led]
        normals = normals[led]
        velocity = np.median(velocities, axis=0)
        angles = np.zeros((times.size, 3))
        angles[:, 2] = _headings_deg(times, centres, normals, velocity)
        return Trajectory(times, centres, angles, has_attitude=False)

    def _fit_window(
        self, plane: ScanPlane, local: Floats, time: Floats, middle: float, base: Floats
    ) -> RotationFit:
        flat = PlanePoints(plane.project(local), time, np.zeros(time.size, dtype=np.int64))
        starts = [np.median(flat.position, axis=0)]
        starts += [starts[0] + np.array(step) for step in _STARTS_M]
        rates = None
        if self._rate_hz is not None:
            # The sense of the angle depends on the side the normal points to.
            same_side = self._normals[-1] @ plane.normal > 0
            rates = [self._rate_hz if same_side else -self._rate_hz]
            since = middle - self.times[-1]
            guess = self._centres[-1] + since * self._velocities[-1] - base
            if since < _GAP_S:
                near = fit_rotation(flat, [plane.project(guess)], moves=True, rates_hz=rates)
                if near.coherence > np.median(self._coherences) - _LESS_COHERENT:
                    return near
        return fit_rotation(flat, starts, moves=True, rates_hz=rates)


def _smooth_velocities(velocities: Floats) -> Floats:
    """Medians of neighbours: one short window gives a velocity badly."""
    padded = np.pad(velocities, ((_NEIGHBOURS // 2,) * 2, (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, _NEIGHBOURS, axis=0)
    median: Floats = np.median(windows, axis=2)
    return median


def _headings_deg(times: Floats, centres: Floats, normals: Floats, velocity: Floats) -> Floats:
    """Clockwise from north: the plane's azimuth, set to the motion on the whole."""
    azimuth = np.unwrap(np.arctan2(normals[:, 0], normals[:, 1]))
    if np.median(np.hypot(normals[:, 0], normals[:, 1])) < _LEAST_LEVEL:
        azimuth = np.zeros(times.size)
    speed = np.hypot(velocity[0], velocity[1])
    if speed < _STANDS_M_S or times.size < 2:
        level: Floats = np.degrees(azimuth - azimuth[0]) % 360.0
        return level
    motion = np.diff(centres, axis=0)[:, :2]
    middle = 0.5 * (azimuth[1:] + azimuth[:-1])
    # Motion as seen along the plane's azimuth: one constant angle for a vehicle that drives ahead.
    turned = (motion[:, 1] + 1j * motion[:, 0]) * np.exp(-1j * middle)
    headings: Floats = np.degrees(azimuth + np.angle(turned.sum())) % 360.0
    return headings
