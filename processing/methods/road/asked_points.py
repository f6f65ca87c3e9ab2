"""The points of a drive about a place that somebody asked for, for diagnostics."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats
from processing.image.scan_lines.scanlines import ScanlineSettings, scanlines_about
from processing.methods.road.requested_position import RequestedPosition

_ALONG_M = 1.5
"""Scan lines so far along the path to either side hold what stands at a place, tilted heads
included."""


def points_beside(asked: RequestedPosition, radius_m: float) -> Floats:
    """Points so near to the place in plan: (n, 3) m about it.

    Raises
    ------
    MissingInput
        The drive has no trajectory.
    """
    about = scanlines_about(asked.drive, asked.xyz, _ALONG_M, ScanlineSettings())
    numbers = np.concatenate([np.empty(0, np.int64), *(one.point for one in about)])
    if numbers.size == 0:
        return np.empty((0, 3))
    first, last = int(numbers.min()), int(numbers.max())
    local = asked.drive.coordinates.chunk_about(first, last + 1, asked.xyz)
    near: Floats = local[np.hypot(local[:, 0], local[:, 1]) < radius_m]
    return near


def stretch_about(asked: RequestedPosition, along_m: float) -> tuple[int, int]:
    """The first point measured while the vehicle passed the place, and the one after the last.

    Parameters
    ----------
    along_m : float
        How far along the path to either side.
    """
    trajectory, times = asked.drive.trajectory, asked.scanlines.time_s
    if trajectory is None or times.size == 0:
        return 0, 0
    steps = np.hypot(*np.diff(trajectory.xyz[:, :2], axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    passed = float(np.interp(np.median(times), trajectory.time, along))
    first = int(np.searchsorted(along, passed - along_m))
    last = min(int(np.searchsorted(along, passed + along_m)), len(along) - 1)
    measured = asked.drive.columns["time"]
    start, stop = np.searchsorted(measured, trajectory.time[[first, last]])
    return int(start), int(stop)
