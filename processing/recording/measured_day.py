"""The day on which a recording began, where its times tell."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import date

import numpy as np

from processing.recording.drive import Drive
from processing.recording.vehicle_path.clock import day_of

_LOOKED_AT = 1000
"""Times that are looked at, spread over the drive."""

_HOURS_AHEAD = 9.0
"""Of Japan, of UTC: the day a survey is named after."""


def measured_day(drives: Sequence[Drive], *, is_said: bool = True) -> date | None:
    """The first day of drives recorded together.

    Parameters
    ----------
    is_said : bool
        Whether a day that somebody said counts before the times.

    Returns
    -------
    date or None
        None where times count from the week, or there are none: they name no day, and nobody said
        one.
    """
    days = [day for drive in drives if (day := _first_day(drive, is_said=is_said)) is not None]
    return min(days, default=None)


def _first_day(drive: Drive, *, is_said: bool) -> date | None:
    if is_said and drive.info.measured_on:
        return date.fromisoformat(drive.info.measured_on)
    if not (drive.count and drive.info.has_measured_times and drive.columns.has("time")):
        return None
    points = np.unique(np.linspace(0, drive.count - 1, _LOOKED_AT).astype(np.int64))
    times = drive.columns["time"][points]
    times = times[np.isfinite(times)]
    # One time for all points is a filler.
    is_reported = bool(times.size) and (len(points) == 1 or times.min() < times.max())
    return day_of(float(times.min()), _HOURS_AHEAD) if is_reported else None
