"""The vehicle's path from scanner origins, which some files have for every point."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import MissingInput
from processing.core.text import Text
from processing.recording.columns.columns import Columns
from processing.recording.columns.ordering import chunk_ranges
from processing.recording.columns.point_source import PointColumns, PointSource
from processing.recording.vehicle_path.trajectory import Trajectory

_WINDOW_S = 0.1
"""Length of a piece of trajectory in which the scanner moves evenly but for its rotation. By trial;
no measurement is recorded."""

_MOST_POINTS = 400
"""Points of a piece that are looked at."""

_LEAST_REVOLUTIONS, _LEAST_POINTS = 2.0, 20
"""Of a piece from which a rate is told: two whole revolutions and some points in each."""

_MARGIN_S = 1e-3
"""Before the first and behind the last point of a recording: times are known better."""

_READ_POINTS = 1_000_000
"""Points read at a time."""

_RATES_HZ = np.arange(38.0, 310.0, 0.5)
"""Rates of rotation that scanners have: as `SLOWEST_HZ` and `FASTEST_HZ` of `rotation_fit`; over
0.1 s half a hertz is a twentieth of a revolution."""


def trajectory_from_origins(columns: Columns | PointColumns | PointSource) -> Trajectory:
    """The trajectory of the scanner's mean origin.

    Parameters
    ----------
    columns : Columns, PointColumns or RecordedPoints
        With ``time`` and ``origin``.

    Raises
    ------
    MissingInput
        There are no origins, or they all have one time.

    Notes
    -----
    The origin of a scanner with a turning mirror goes round with it. Each tenth of a second is
    fitted by a steady motion and a circular one of the revolution rate; the steady one is kept, so
    parts of revolutions without returns don't pull the mean.
    """
    times: list[float] = []
    positions: list[Floats] = []
    velocities: list[Floats] = []
    rate_hz: float | None = None
    first_time = last_time = np.nan
    for time, origin in _windows(columns):
        first_time = time[0] if not times else first_time
        last_time = time[-1]
        if rate_hz is None:
            rate_hz = _circling_rate(time, origin)
        middle, position, velocity = _steady(time, origin, rate_hz)
        if times and middle <= times[-1]:
            continue
        times.append(middle)
        positions.append(position)
        velocities.append(velocity)
    if not times or not last_time > first_time:
        raise MissingInput(
            Text(
                "The points say nothing about where the scanner was.",
                "点にスキャナの位置が記録されていません。",
            ),
            Text.same("origin"),
            Text(
                "Import the points with a trajectory.",
                "走行軌跡と合わせてインポートしてください。",
            ),
        )
    # From the ends of the recording on, the vehicle is taken to move as in the nearest window.
    before = positions[0] + (first_time - _MARGIN_S - times[0]) * velocities[0]
    after = positions[-1] + (last_time + _MARGIN_S - times[-1]) * velocities[-1]
    return Trajectory.from_positions(
        np.concatenate([[first_time - _MARGIN_S], times, [last_time + _MARGIN_S]]),
        np.vstack([before, *positions, after]),
    )


def _windows(columns: Columns | PointColumns | PointSource) -> list[tuple[Floats, Floats]]:
    """Times and origins of some points of each tenth of a second."""
    windows: list[tuple[Floats, Floats]] = []
    for start, stop in chunk_ranges(columns.count, _READ_POINTS):
        time, origin = _read(columns, start, stop)
        if time.size == 0:
            break
        edges = np.arange(time[0], time[-1] + _WINDOW_S, _WINDOW_S)
        bounds = np.append(np.searchsorted(time, edges[:-1]), time.size)
        for first, last in pairwise(bounds):
            every = max(1, (last - first) // _MOST_POINTS)
            chosen = slice(int(first), int(last), int(every))
            if last - first >= 2:
                windows.append((np.array(time[chosen]), np.array(origin[chosen])))
    return windows


def _read(
    columns: Columns | PointColumns | PointSource, start: int, stop: int
) -> tuple[Floats, Floats]:
    if isinstance(columns, Columns):
        return columns["time"][start:stop], columns["origin"][start:stop]
    part = columns.chunk(start, stop)
    if part.origin is None:
        return part.time[:0], np.empty((0, 3))
    return part.time, part.origin


def _circling_rate(time: Floats, origin: Floats) -> float:
    """The rate at which the origin goes round, once its steady motion is taken away."""
    local = time - time.mean()
    steady = np.column_stack([np.ones(local.size), local])
    rest = origin - origin.mean(axis=0)
    rest = rest - steady @ np.linalg.lstsq(steady, rest)[0]
    power = np.abs(np.exp(-2j * np.pi * np.outer(_RATES_HZ, local)) @ rest) ** 2
    return float(_RATES_HZ[np.argmax(power.sum(axis=1))])


def _steady(time: Floats, origin: Floats, rate_hz: float) -> tuple[float, Floats, Floats]:
    middle = 0.5 * float(time[0] + time[-1])
    local = time - middle
    turned = 2 * np.pi * rate_hz * local
    parts = [np.ones(local.size), local]
    if (time[-1] - time[0]) * rate_hz > _LEAST_REVOLUTIONS and time.size > _LEAST_POINTS:
        parts += [np.cos(turned), np.sin(turned)]
    base = origin[0]
    found = np.linalg.lstsq(np.column_stack(parts), origin - base)[0]
    return middle, base + found[0], found[1]
