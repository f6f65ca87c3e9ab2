"""Rows of a whole drive, chunk by chunk: pulses, the mirror's phase, and where rows begin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.recording.columns.ordering import chunk_ranges
from processing.recording.columns.point_source import PointSource
from processing.recording.revolutions.pulse_clock import (
    LONGEST_MISSING_S,
    PulseClock,
    PulseNumbering,
)
from processing.recording.revolutions.pulse_store import PulseStore
from processing.recording.revolutions.reference_times import (
    SEARCHED_SHARE,
    find_crossings,
    repair_reference_times,
)
from processing.recording.revolutions.revolution_tracking import RevolutionPhase, RevolutionTracker
from processing.recording.revolutions.scan_angle import MirrorRotation, SeenAngle

READ_POINTS = 500_000
"""Points read at a time."""

_TRACKED_PER_REVOLUTION = 64
"""Points of each revolution by which its phase is followed: the rest would say the same."""

_BELOW_CENTRE_M = 0.3
"""Points lower than this below the centre are ground and what stands on it: rows are cut where
nothing of the vehicle's roof is."""

_DENSITY_POINTS = 20_000
"""Points in the middle of a recording by whose times its points per revolution are estimated:
several revolutions of all but the densest scanners."""

_LEAST_S = 1e-9
"""Guard of divisions and of ties: far shorter than any interval between pulses."""

_SPARE_REVOLUTIONS = 3
"""So many before its first point a segment's rows may begin: two that `_expect_rows` has to spare
and the fold's share of one."""

_SHARED_REVOLUTIONS = 2
"""That chunks have in common: one that begins in the chunk before, and what is searched about
it."""

_LATTICE_SLACK = 1e-3
"""Of an interval: a row that begins on a pulse but for rounding begins with that pulse."""


@dataclass(frozen=True)
class FoundRows:
    """Rows as `Revolutions` has them, and the rates found with them."""

    reference_times: Floats
    fold_pulses: NDArray[np.int64]
    segments: NDArray[np.int32]
    row_ends: NDArray[np.int64]
    revolution_rate_hz: float
    interval_s: float
    coherence: float


@dataclass(frozen=True)
class _Segment:
    """A stretch without a stop: its times, and the angles sampled in it."""

    first_time: float
    last_time: float
    phase: RevolutionPhase


@dataclass
class _SegmentRows:
    """Revolutions of a segment: where rows are expected, what was found there."""

    predicted: Floats
    crossed: Floats
    chord: NDArray[np.int64]
    anchor_time: Floats
    anchor_pulse: NDArray[np.int64]


def find_rows(
    points: PointSource,
    clock: PulseClock,
    mirror_rotation: MirrorRotation,
    pulses: PulseStore,
    monitor: Monitor,
) -> FoundRows:
    """Number the pulses of all points and find where rows begin.

    Parameters
    ----------
    pulses : PulseStore
        Empty; holds all pulses afterwards.
    """
    segments, interval_s = _first_pass(points, clock, mirror_rotation, pulses, monitor)
    monitor.report(0.6)
    revolutions = [(segment, _expect_rows(segment, mirror_rotation)) for segment in segments]
    _second_pass(points, mirror_rotation, pulses, revolutions, monitor)
    monitor.report(0.95)
    return _assemble_rows(revolutions, interval_s)


def _first_pass(
    points: PointSource,
    clock: PulseClock,
    mirror_rotation: MirrorRotation,
    pulses: PulseStore,
    monitor: Monitor,
) -> tuple[list[_Segment], float]:
    first_time = float(points.chunk(0, 1).time[0])
    # Room for the revolution that has begun before the first point, and one more.
    per_revolution = 1.0 / (clock.interval_s * abs(mirror_rotation.rate_hz))
    numbering = PulseNumbering(clock, first_time, int(2.0 * per_revolution) + 1)
    every = max(1, int(_points_per_revolution(points, mirror_rotation) / _TRACKED_PER_REVOLUTION))
    segments = _Segments(mirror_rotation, first_time)
    start, last_time = 0, first_time
    while start < points.count:
        monitor.check()
        stop = min(start + READ_POINTS, points.count)
        part = points.chunk(start, stop)
        numbers = numbering.number(part, is_last=stop == points.count)
        pulses.append(numbers)
        part = part.chunk(0, numbers.size)
        time, angle = mirror_rotation.mirror.angles(part, every)
        steps = np.diff(part.time, prepend=last_time)
        stops = [
            (float(part.time[at - 1]) if at else last_time, float(part.time[at]))
            for at in np.flatnonzero(steps > LONGEST_MISSING_S)
        ]
        segments.add(time, angle, stops)
        last_time = float(part.time[-1])
        start += numbers.size
        monitor.report(0.2 + 0.4 * start / points.count)
    pulses.finish()
    return segments.finished(last_time), numbering.interval_s


def _points_per_revolution(points: PointSource, mirror_rotation: MirrorRotation) -> float:
    size = min(points.count, _DENSITY_POINTS)
    start = (points.count - size) // 2
    time = points.chunk(start, start + size).time
    return size / (max(float(time[-1] - time[0]), _LEAST_S) * abs(mirror_rotation.rate_hz))


class _Segments:
    """The segments of a drive, followed as its points come."""

    def __init__(self, mirror_rotation: MirrorRotation, first_time: float) -> None:
        self._mirror_rotation = mirror_rotation
        self._start = first_time
        self._tracker = RevolutionTracker(mirror_rotation.rate_hz)
        self._ended: list[_Segment] = []

    def add(self, time: Floats, angle: Floats, stops: list[tuple[float, float]]) -> None:
        """Take sampled points and the stops among them: when points end and go on again."""
        for end, start in stops:
            last, first = np.searchsorted(time, [end + _LEAST_S, start])
            self._tracker.add(time[:last], angle[:last])
            self._end(end)
            self._start, self._tracker = start, RevolutionTracker(self._mirror_rotation.rate_hz)
            time, angle = time[first:], angle[first:]
        self._tracker.add(time, angle)

    def finished(self, last_time: float) -> list[_Segment]:
        """All segments, when all points came."""
        self._end(last_time)
        return self._ended

    def _end(self, end: float) -> None:
        if self._tracker.has_points:
            phase = self._tracker.phase()
        else:
            middle = np.array([0.5 * (self._start + end)])
            phase = RevolutionPhase(middle, np.zeros(1), abs(self._mirror_rotation.rate_hz), 0.0)
        self._ended.append(_Segment(self._start, end, phase))


def _expect_rows(segment: _Segment, mirror_rotation: MirrorRotation) -> _SegmentRows:
    """The revolutions that may hold points of the segment, with one to spare at both ends."""
    fold = mirror_rotation.fold_angle * np.sign(mirror_rotation.rate_hz) / (2 * np.pi)
    first, last = (
        segment.phase.revolutions_at(np.array([segment.first_time, segment.last_time])) - fold
    )
    revolutions = np.arange(np.floor(first) - 1, np.ceil(last) + 2) + fold
    predicted = segment.phase.times_of(revolutions)
    return _SegmentRows(
        predicted=predicted,
        crossed=np.full(predicted.size, np.nan),
        chord=np.zeros(predicted.size, dtype=np.int64),
        anchor_time=np.full(predicted.size, np.nan),
        anchor_pulse=np.zeros(predicted.size, dtype=np.int64),
    )


def _second_pass(
    points: PointSource,
    mirror_rotation: MirrorRotation,
    pulses: PulseStore,
    revolutions: list[tuple[_Segment, _SegmentRows]],
    monitor: Monitor,
) -> None:
    for start, stop in _overlapping(points, 1.0 / abs(mirror_rotation.rate_hz)):
        monitor.check()
        part = points.chunk(start, stop)
        numbers = pulses.chunk(start, stop)
        for segment, mine in revolutions:
            period = 1.0 / segment.phase.rate_hz
            low = -np.inf if start == 0 else part.time[0] + SEARCHED_SHARE * period
            first = int(
                np.searchsorted(
                    mine.predicted, max(low, segment.first_time - _SPARE_REVOLUTIONS * period)
                )
            )
            last = int(np.searchsorted(mine.predicted, part.time[-1]))
            if stop == points.count:
                last = mine.predicted.size
            if last <= first or part.time[-1] < segment.first_time:
                continue
            asked = slice(first, last)
            _anchor(mine, asked, segment, part.time, numbers)
            if isinstance(mirror_rotation.mirror, SeenAngle):
                mine.crossed[asked], mine.chord[asked] = find_crossings(
                    part,
                    numbers,
                    mirror_rotation.mirror.poses,
                    mine.predicted[asked],
                    period_s=period,
                    below_m=mirror_rotation.mirror.height_m - _BELOW_CENTRE_M,
                )
        monitor.report(0.6 + 0.35 * stop / points.count)


def _overlapping(points: PointSource, period_s: float) -> list[tuple[int, int]]:
    """Stretches that share two revolutions, so that each revolution lies whole in one of them."""
    found = []
    for start, stop in chunk_ranges(points.count, READ_POINTS):
        lead = max(0, start - READ_POINTS // 4)
        if start:
            time = points.chunk(lead, start).time
            lead += int(np.searchsorted(time, time[-1] - _SHARED_REVOLUTIONS * period_s))
        found.append((lead, stop))
    return found


def _anchor(
    revolutions: _SegmentRows,
    asked: slice,
    segment: _Segment,
    time: Floats,
    numbers: NDArray[np.int64],
) -> None:
    """Note a point of known pulse near each expected row start."""
    first = int(np.searchsorted(time, segment.first_time))
    last = int(np.searchsorted(time, segment.last_time, side="right")) - 1
    if last < first:
        return
    after = np.clip(np.searchsorted(time, revolutions.predicted[asked]), first, last)
    before = np.clip(after - 1, first, last)
    wanted = revolutions.predicted[asked]
    nearer = np.where(np.abs(time[before] - wanted) < np.abs(time[after] - wanted), before, after)
    revolutions.anchor_time[asked] = time[nearer]
    revolutions.anchor_pulse[asked] = numbers[nearer]


def _assemble_rows(
    revolutions: list[tuple[_Segment, _SegmentRows]], interval_s: float
) -> FoundRows:
    segments = [segment for segment, _ in revolutions]
    times, folds, ends, numbers = [], [], [], []
    last_time, last_fold = 0.0, 0
    for number, (segment, mine) in enumerate(revolutions):
        period = 1.0 / segment.phase.rate_hz
        begins = repair_reference_times(mine.predicted, mine.crossed, mine.chord, period)
        first = max(0, int(np.searchsorted(begins, segment.first_time, side="right")) - 1)
        last = int(np.searchsorted(begins, segment.last_time, side="right"))
        kept = slice(first, last + 1)
        steps = np.ceil((begins[kept] - mine.anchor_time[kept]) / interval_s - _LATTICE_SLACK)
        fold = np.maximum.accumulate(mine.anchor_pulse[kept] + steps.astype(np.int64))
        times.append(begins[kept][:-1])
        folds.append(fold[:-1])
        ends.append(fold[1:])
        numbers.append(np.full(fold.size - 1, number, dtype=np.int32))
        last_time, last_fold = float(begins[kept][-1]), int(fold[-1])
    weights = [segment.last_time - segment.first_time + _LEAST_S for segment in segments]
    return FoundRows(
        reference_times=np.append(np.concatenate(times), last_time),
        fold_pulses=np.append(np.concatenate(folds), last_fold),
        segments=np.concatenate(numbers),
        row_ends=np.concatenate(ends),
        revolution_rate_hz=float(np.median([segment.phase.rate_hz for segment in segments])),
        interval_s=interval_s,
        coherence=float(
            np.average([segment.phase.coherence for segment in segments], weights=weights)
        ),
    )
