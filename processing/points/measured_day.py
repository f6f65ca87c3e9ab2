"""The day on which a recording began, where its times tell."""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import UTC, date, datetime, timedelta

import numpy as np

from processing.points.clock import ADJUSTMENT_S, LEAP_S, ClockKind, kind_of
from processing.points.drive import Drive

_GPS_BEGAN = datetime(1980, 1, 6, tzinfo=UTC)
_LOOKED_AT = 1000
_DEG_PER_HOUR = 15.0


def measured_day(drives: Sequence[Drive]) -> date | None:
    """The first day of drives recorded together, by the sun's hour where they are.

    Returns
    -------
    date or None
        None where times count from the week, or there are none: they name no day.
    """
    began = [at for drive in drives if (at := _began(drive)) is not None]
    if not began:
        return None
    return (min(began) + timedelta(hours=_hours_east(drives[0]))).date()


def _began(drive: Drive) -> datetime | None:
    if not drive.count or not drive.columns.has("time"):
        return None
    points = np.unique(np.linspace(0, drive.count - 1, _LOOKED_AT).astype(np.int64))
    times = drive.columns["time"][points]
    times = times[np.isfinite(times)]
    kind = kind_of(times)
    if kind not in (ClockKind.STANDARD, ClockKind.ADJUSTED_STANDARD) or _say_nothing(times):
        return None
    seconds = float(times.min()) + (ADJUSTMENT_S if kind is ClockKind.ADJUSTED_STANDARD else 0.0)
    return _GPS_BEGAN + timedelta(seconds=seconds - LEAP_S)


def _say_nothing(times: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> bool:
    """Whether all points have the same time, which is then a filler."""
    return bool(len(times) > 1 and times.min() == times.max())


def _hours_east(drive: Drive) -> float:
    """Whole hours before Greenwich; 0 where it isn't known where on earth the drive is."""
    from pyproj import CRS, Transformer
    from pyproj.exceptions import ProjError

    if not drive.info.crs:
        return 0.0
    try:
        system = CRS.from_user_input(drive.info.crs)
        to_degrees = Transformer.from_crs(system, 4326, always_xy=True)
        longitude, _ = to_degrees.transform(*drive.info.lowest[:2])
    except ProjError:
        return 0.0
    return float(round(longitude / _DEG_PER_HOUR)) if math.isfinite(longitude) else 0.0
