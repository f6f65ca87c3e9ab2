"""Clocks: bringing the times of points to the clock of a trajectory.

Deliveries count seconds of the day, of the GPS week, since 1980 (standard), or that less 1e9
(adjusted standard). Two such clocks differ by a constant which the two ranges of time give away.
"""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, date, datetime, timedelta
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.core.errors import UNCHANGED, OutOfRange
from processing.core.text import Text
from processing.recording.vehicle_path.trajectory import Trajectory

DAY_S = 86_400.0
"""s."""

WEEK_S = 604_800.0
"""s; GPS weeks begin on Sunday at midnight."""

ADJUSTMENT_S = 1e9
"""Adjusted standard GPS time is GPS time less 1e9 s (LAS 1.4, global encoding)."""

LEAP_S = 18.0
"""GPS time less UTC since 2017."""

_LEAST_SHARE = 0.9
"""Share of times that a trajectory must cover for its clock to be taken as that of the points. By
trial; no measurement is recorded."""

_BETTER_BY = 0.01
"""Share of times that a later shift must cover more than a simpler one to be taken instead. By
trial; no measurement is recorded."""

_ALL = 0.999
"""Share of times from which no other shift is tried: a point in a thousand may be stray."""

_START = datetime(1980, 1, 6, tzinfo=UTC)
"""Of GPS time."""


class ClockKind(Enum):
    """What a time counts from, as far as its size tells."""

    WEEK_SECONDS = "week seconds"
    STANDARD = "standard"
    ADJUSTED_STANDARD = "adjusted standard"
    UNKNOWN = "unknown"

    @property
    def title(self) -> Text:
        """The clock in words."""
        return _TITLES[self]


_TITLES = {
    ClockKind.WEEK_SECONDS: Text("seconds of the day or week", "日・週の通算秒"),
    ClockKind.STANDARD: Text("standard GPS time", "標準GPS時刻"),
    ClockKind.ADJUSTED_STANDARD: Text("adjusted standard GPS time", "調整標準GPS時刻"),
    ClockKind.UNKNOWN: Text("an unknown clock", "不明な時計"),
}


def kind_of(times: ArrayLike, *, is_adjusted_standard: bool | None = None) -> ClockKind:
    """The clock that times are on, by their size.

    Parameters
    ----------
    times : (n,) float64
        s; NaN are passed over.
    is_adjusted_standard : bool, optional
        What the file says. Believed only where the size allows it, since files err.

    Notes
    -----
    Seconds of the week lie in 0…604,800; a recording over the end of the week may count on. After
    2011-09 standard times exceed 1e9; adjusted ones lie between -1e9 and 1e9.
    """
    seconds = np.asarray(times, dtype=np.float64)
    seconds = seconds[np.isfinite(seconds)]
    if seconds.size == 0:
        return ClockKind.UNKNOWN
    low, high = float(seconds.min()), float(seconds.max())
    if low >= 0.0 and high <= 2 * WEEK_S and not (is_adjusted_standard and high > WEEK_S):
        return ClockKind.WEEK_SECONDS
    if low > ADJUSTMENT_S and high < 3 * ADJUSTMENT_S:
        return ClockKind.STANDARD
    if low >= -ADJUSTMENT_S and high <= ADJUSTMENT_S:
        # 1980 to 2011 on the standard clock and 2011 to 2043 on the adjusted one look alike.
        is_old = is_adjusted_standard is False and low > 0
        return ClockKind.STANDARD if is_old else ClockKind.ADJUSTED_STANDARD
    return ClockKind.UNKNOWN


def day_of(time_s: float, hours_ahead: float = 0.0) -> date | None:
    """The day of a GPS time; None where the clock doesn't tell the day.

    Parameters
    ----------
    hours_ahead : float
        By which the place's time is ahead of UTC.
    """
    kind = kind_of([time_s])
    if kind not in (ClockKind.STANDARD, ClockKind.ADJUSTED_STANDARD):
        return None
    since = time_s + (ADJUSTMENT_S if kind is ClockKind.ADJUSTED_STANDARD else 0.0)
    return (_START + timedelta(seconds=since - LEAP_S, hours=hours_ahead)).date()


def is_of_week(first_s: float, last_s: float) -> bool:
    """Whether times may be seconds of a week, which don't tell one week from the next."""
    return first_s >= 0.0 and last_s <= WEEK_S


def are_within_days(
    one: tuple[float, float], other: tuple[float, float], days: float = 1.0
) -> bool:
    """Whether no more than a few days lie between two recordings, as far as their times tell.

    Parameters
    ----------
    one, other : (float, float)
        First and last time, s, on one clock.
    days : float
        How many.

    Notes
    -----
    Seconds of a week are compared round its end, Saturday with Sunday. Where more than a day lies
    between them that way, it does in whichever weeks they were; where not, nothing tells.
    """
    first, last = min(one[0], other[0]), max(one[1], other[1])
    apart = max(one[0], other[0]) - min(one[1], other[1])
    if is_of_week(first, last):
        apart = min(apart, WEEK_S - (last - first))
    return apart <= days * DAY_S


def match_clock(
    point_times: ArrayLike,
    trajectory: Trajectory,
    what: str,
    *,
    is_adjusted_standard: bool | None = None,
) -> float:
    """Seconds to add to the times of points so that they fall on the trajectory's clock.

    Parameters
    ----------
    point_times : (n,) float64
        Some times of a recording, its first and last among them; NaN are passed over.
    what : str
        Names the recording in messages.
    is_adjusted_standard : bool, optional
        What the point file says of its clock.

    Returns
    -------
    float
        0 where the times fit as they are; else ±1e9, whole weeks or days, or their sums.

    Raises
    ------
    OutOfRange
        No such shift brings the points into the trajectory's times. The message has both ranges,
        and says when 18 s, the difference of GPS time and UTC, would do it: it is never applied
        unasked, since two drives may well follow each other so closely.

    Notes
    -----
    A shift fits when the trajectory covers nine tenths of the times; of several, the one that
    covers most counts, then the simplest.
    """
    times = np.asarray(point_times, dtype=np.float64)
    times = times[np.isfinite(times)]
    if times.size == 0:
        raise _no_times(what)
    best_shift, best_share = 0.0, 0.0
    for shift in _shifts(times, trajectory, is_adjusted_standard=is_adjusted_standard):
        share = _covered_share(times + shift, trajectory)
        if share > best_share + _BETTER_BY:
            best_shift, best_share = shift, share
        if share >= _ALL:
            break
    if best_share >= _LEAST_SHARE:
        return best_shift
    leap = next(
        (
            seconds
            for shift in _shifts(times, trajectory, is_adjusted_standard=is_adjusted_standard)
            for seconds in (LEAP_S, -LEAP_S)
            if _covered_share(times + shift + seconds, trajectory) >= _LEAST_SHARE
        ),
        0.0,
    )
    raise _not_covered(times, trajectory, what, leap)


def _shifts(
    times: NDArray[np.float64], trajectory: Trajectory, *, is_adjusted_standard: bool | None
) -> Iterator[float]:
    """Shifts that may be right, the simplest first."""
    yield 0.0
    whole = [0.0, ADJUSTMENT_S, -ADJUSTMENT_S]
    if is_adjusted_standard is False:
        whole = [0.0, -ADJUSTMENT_S, ADJUSTMENT_S]
    yield from whole[1:]
    middle = float(np.median(times))
    aim = 0.5 * float(trajectory.time[0] + trajectory.time[-1])
    reach = 0.5 * float(trajectory.time[-1] - trajectory.time[0]) + float(np.ptp(times))
    for unit in _units(float(times.max()), float(trajectory.time[-1])):
        for base in whole:
            nearest = round((aim - middle - base) / unit)
            spare = int(reach // unit) + 1
            for number in sorted(range(nearest - spare, nearest + spare + 1), key=abs):
                if number:
                    yield base + number * unit


def _units(last_point: float, last_pose: float) -> Iterator[float]:
    """Units in which two clocks may differ.

    Only where one of them counts anew each week or day: else a drive of another day at the same
    hour would seem to fit.
    """
    lesser, greater = sorted((last_point, last_pose))
    if 0 <= lesser <= WEEK_S + DAY_S and greater > WEEK_S:
        yield WEEK_S
    if 0 <= lesser <= DAY_S < greater:
        yield DAY_S


def _covered_share(times: NDArray[np.float64], trajectory: Trajectory) -> float:
    return float(np.mean(trajectory.covers(times)))


def _in_words(low: float, high: float, kind: ClockKind) -> Text:
    return Text(
        f"{low:.3f} to {high:.3f} s ({kind.title.en})",
        f"{low:.3f}～{high:.3f} 秒（{kind.title.ja}）",
    )


def _not_covered(
    times: NDArray[np.float64], trajectory: Trajectory, what: str, leap_s: float
) -> OutOfRange:
    points = _in_words(float(times.min()), float(times.max()), kind_of(times))
    first, last = float(trajectory.time[0]), float(trajectory.time[-1])
    vehicle_path = _in_words(first, last, kind_of(trajectory.time))
    remedy = Text(
        "Give the trajectory of this drive. {unchanged}",
        "この走行の走行軌跡を指定してください。{unchanged}",
    )
    if leap_s:
        remedy = Text(
            "Shifted by 18 s, the difference of GPS time and UTC, they would fit: deliver both "
            "with one clock. {unchanged}",
            "GPS時刻とUTCの差（18秒）をずらすと一致します。"
            "両方を同じ時計で用意してください。{unchanged}",
        )
    return OutOfRange(
        Text(
            "The times of the points, {points}, lie outside those of the trajectory, {trajectory}.",
            "点の時刻 {points} が走行軌跡の時刻 {trajectory} の範囲外です。",
        ).filled(points=points, trajectory=vehicle_path),
        Text.same(what),
        remedy.filled(unchanged=UNCHANGED),
    )


def _no_times(what: str) -> OutOfRange:
    return OutOfRange(
        Text(
            "The points have no times, so no trajectory can belong to them.",
            "点に時刻がないため、走行軌跡と対応付けられません。",
        ),
        Text.same(what),
        Text(
            "Import them without the trajectory. {unchanged}",
            "走行軌跡を指定せずにインポートしてください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
