"""What every search along a street begins with, made once of the drives of a survey.

Trees, signs, poles and wires ask for the ground below them, trees and poles for upright columns
too. Both are kept with the first of the drives as long as it is open, and made again where what is
known as noise has changed.
"""

from __future__ import annotations

import threading
import zlib
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.objects.columns import UprightColumns, find_columns
from processing.methods.road.objects.ground_heights import ground_heights
from processing.methods.road.objects.sparse_plan import SparsePlan, plan_of
from processing.recording.columns.counted_classes import class_columns
from processing.recording.columns.ordering import chunk_ranges
from processing.recording.drive import Drive

_CODES_AT_ONCE = 16_000_000


class SurveyGround(NamedTuple):
    """The coarse ground of a survey.

    Attributes
    ----------
    plan : SparsePlan
        With the tiles of all points; its origin is what everything else is told about.
    heights : (tiles, 16, 16) float32
        As :func:`processing.methods.road.objects.ground_heights.ground_heights` finds them.
    """

    plan: SparsePlan
    heights: NDArray[np.float32]


def survey_ground(drives: Sequence[Drive], monitor: Monitor) -> SurveyGround:
    """The ground of all drives together.

    Parameters
    ----------
    drives : sequence of Drive
        One or more.

    Raises
    ------
    OutOfRange
        The drives lie too far apart.
    """
    return _kept_of(drives).ground(drives, monitor)


def survey_columns(
    drives: Sequence[Drive], monitor: Monitor
) -> tuple[SurveyGround, UprightColumns]:
    """The ground of all drives together, and what stands upright on it.

    Raises
    ------
    OutOfRange
        The drives lie too far apart.
    """
    return _kept_of(drives).columns(drives, monitor)


class _KeptSurvey:
    """Ground and columns of some drives, and of which noise they were made."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._noise: tuple[int, ...] = ()
        self._ground: SurveyGround | None = None
        self._columns: UprightColumns | None = None

    def ground(self, drives: Sequence[Drive], monitor: Monitor) -> SurveyGround:
        with self._lock:
            return self._ground_now(drives, monitor)

    def columns(
        self, drives: Sequence[Drive], monitor: Monitor
    ) -> tuple[SurveyGround, UprightColumns]:
        with self._lock:
            below = self._ground_now(drives, PartMonitor(monitor, 0.0, 0.5))
            if self._columns is None:
                part = PartMonitor(monitor, 0.5, 1.0)
                self._columns = find_columns(drives, below.plan, below.heights, part)
            return below, self._columns

    def _ground_now(self, drives: Sequence[Drive], monitor: Monitor) -> SurveyGround:
        noise = tuple(_known_noise(drive) for drive in drives)
        if self._ground is None or noise != self._noise:
            plan = plan_of([(drive.info.lowest, drive.info.highest) for drive in drives])
            heights = ground_heights(drives, plan, monitor)
            self._columns = None
            self._ground, self._noise = SurveyGround(plan, heights), noise
        return self._ground


def _kept_of(drives: Sequence[Drive]) -> _KeptSurvey:
    key = ("survey", *(str(drive.folder) for drive in drives))
    return drives[0].kept(key, _KeptSurvey)


def _known_noise(drive: Drive) -> int:
    """A checksum of what is known to be noise."""
    classes = class_columns(drive.columns)
    checksum = 0
    if classes.delivered.size or classes.labels.size:
        for start, stop in chunk_ranges(drive.count, _CODES_AT_ONCE):
            checksum = zlib.crc32(
                np.packbits(classes.noise_between(start, stop)).tobytes(), checksum
            )
    return checksum
