"""The points of drives, a chunk at a time, without what is known to be noise."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.core.worked_ahead import one_ahead
from processing.recording.columns.counted_classes import class_columns
from processing.recording.columns.ordering import chunk_ranges
from processing.recording.drive import Drive

_POINTS_AT_ONCE = 1_000_000
"""Read at a time: 24 MB, and less than a tenth of a second, so that a cancel is felt at once."""


@dataclass(frozen=True)
class DriveChunk:
    """Points of a drive that follow each other.

    Attributes
    ----------
    drive : int
        Which of the drives.
    start : int
        The first point.
    local : (n, 3) float64
        m about the origin that was asked for.
    is_noise : (n,) bool
    """

    drive: int
    start: int
    local: Floats
    is_noise: NDArray[np.bool_]


def chunks_of(drives: Sequence[Drive], origin: Floats, monitor: Monitor) -> Iterator[DriveChunk]:
    """All points of drives, in their order; the next ones are read while these are looked at.

    Parameters
    ----------
    origin : (3,) float64
        m, project CRS.
    monitor : Monitor
        Told how much was read.
    """
    return one_ahead(_chunks_of(drives, origin, monitor))


def _chunks_of(drives: Sequence[Drive], origin: Floats, monitor: Monitor) -> Iterator[DriveChunk]:
    total, done = max(1, sum(drive.count for drive in drives)), 0
    for number, drive in enumerate(drives):
        classes = class_columns(drive.columns)
        for start, stop in chunk_ranges(drive.count, _POINTS_AT_ONCE):
            monitor.check()
            local = drive.coordinates.chunk_about(start, stop, origin)
            yield DriveChunk(number, start, local, classes.noise_between(start, stop))
            done += stop - start
            monitor.report(done / total)
