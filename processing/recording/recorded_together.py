"""Which drives record one place at one time: stations of a site, heads of a car, no two epochs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from processing.recording.drive import SCAN, Drive
from processing.recording.vehicle_path.clock import are_within_days, is_of_week

_TIMES = 1000
"""Times of each drive that are compared, spread over it."""

_COPY_OFF = 2e-3
"""By how much extents, m, and times, s, of a copy may differ: what files round them to. No second
pass has the same number of points at the same times."""

_TOGETHER_DAYS = 1.0
"""Files measured more than a day apart are drives of their own."""

_SURVEY_DAYS = 31.0
"""Lanes, missed streets and the way back are driven within weeks."""


def recorded_together(drive: Drive, beside: Sequence[Drive]) -> tuple[Drive, ...]:
    """A drive, first, and those of the others that were recorded together with it."""
    return _find_met_drives(drive, beside, _TOGETHER_DAYS)


def surveyed_together(drive: Drive, beside: Sequence[Drive]) -> tuple[Drive, ...]:
    """A drive, first, and the others of its survey: the same ground within a month.

    What stands along a street is mapped once from them. What was recorded later is another epoch,
    since the street may have been rebuilt.
    """
    return _find_met_drives(drive, beside, _SURVEY_DAYS)


def _find_met_drives(drive: Drive, beside: Sequence[Drive], days: float) -> tuple[Drive, ...]:
    # Of two copies of a strip that which came with the drive is met, so it is asked first.
    others = sorted(beside, key=lambda other: not _files(drive) & _files(other))
    together = [drive]
    for one in together:
        met = [other for other in others if _is_together(one, other, days)]
        others = [other for other in others if other not in met]
        for other in met:
            if not any(_are_copies(other, known) for known in together):
                together.append(other)
    return tuple(together)


def recordings_of(drives: Sequence[Drive]) -> tuple[tuple[Drive, ...], ...]:
    """Drives parted into those that were recorded together; each is in exactly one part."""
    parts: list[tuple[Drive, ...]] = []
    left = list(drives)
    while left:
        parts.append(recorded_together(left[0], left[1:]))
        left = [drive for drive in left if drive not in parts[-1]]
    return tuple(parts)


def _is_together(one: Drive, other: Drive, days: float) -> bool:
    """Whether two drives share a delivered file, or days and ground; stations a folder.

    Clouds without times that come in files of their own may be two epochs, so they stay apart,
    but for stations of a standing scanner that were delivered side by side.
    """
    if _files(one) & _files(other):
        return True
    if one.info.crs != other.info.crs or not _extents_meet(one, other):
        return False
    is_side_by_side = bool(_folders(one) & _folders(other))
    span, other_span = _times(one), _times(other)
    if span is None or other_span is None:
        both_stand = one.info.rows_by == SCAN and other.info.rows_by == SCAN
        return span is None and other_span is None and both_stand and is_side_by_side
    is_dated = not is_of_week(min(span[0], other_span[0]), max(span[1], other_span[1]))
    return are_within_days(span, other_span, days) and (is_dated or is_side_by_side)


def _are_copies(one: Drive, other: Drive) -> bool:
    """Whether two drives hold the same points, as where one is written anew with waveforms.

    Together they would count every point twice.
    """
    if one.count != other.count or _files(one) & _files(other):
        return False
    span, other_span = _times(one), _times(other)
    if span is None or other_span is None:
        return False
    ours, theirs = (
        np.array([*own.info.lowest, *own.info.highest, *times])
        for own, times in ((one, span), (other, other_span))
    )
    return bool(np.abs(ours - theirs).max() < _COPY_OFF)


def _files(drive: Drive) -> set[str]:
    return {source.path for source in drive.info.sources}


def _folders(drive: Drive) -> set[Path]:
    return {Path(source.path).parent for source in drive.info.sources}


def _extents_meet(one: Drive, other: Drive) -> bool:
    low = np.maximum(one.info.lowest, other.info.lowest)
    high = np.minimum(one.info.highest, other.info.highest)
    return bool(np.all(low[:2] <= high[:2]))


def _times(drive: Drive) -> tuple[float, float] | None:
    """About the first and the last time, s; None where a cloud has none, or one for all points."""
    if drive.count == 0 or not drive.info.has_measured_times:
        return None
    points = np.unique(np.linspace(0, drive.count - 1, _TIMES).astype(np.int64))
    times = drive.columns["time"][points]
    times = times[np.isfinite(times)]
    if times.size == 0 or (times.min() == times.max() and drive.count > 1):
        return None
    return float(times.min()), float(times.max())
