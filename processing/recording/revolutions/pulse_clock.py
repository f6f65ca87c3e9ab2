"""The pulse clock: the interval between laser pulses, and the number of the pulse of each point.

Only pulses that came back are in a file. Their times lie on a lattice whose step is found from the
data, since real rates differ from nominal ones and drift (a relative error of 1e-4 shifts a row of
3,000 pulses by 0.3 px).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.recording.columns.point_source import PointColumns
from processing.recording.revolutions.pulse_clock_kernels import (
    TimeLimits,
    new_state,
    number_exact,
    number_rounded,
)

LONGEST_MISSING_S = 1.0
"""Longer times without a point are a stop; shorter ones are pulses without return."""

_LEAST_COHERENCE = 0.6
"""How well times must lie on a lattice, 0 to 1: of any times it is near 0. By trial; no measurement
is recorded."""

_TIES_OF_ROUNDED_TIMES = 0.15
"""Share of times equal to the one before from which times are rounded; fewer are returns that the
file does not number well: they share a pulse."""

_STAGES = (16, 64, 256, 1024, 4096, 16384)
"""Lengths of pieces, in pulses, over which the interval is made better: each is known well enough
by the one before that no pulse is miscounted."""

_LEAST_PULSES, _LEAST_STEPS = 64, 32
"""Pulses of a stretch, and steps of all stretches, for a median that holds. By trial; no
measurement is recorded."""

_LONGEST_STEP = 4.5
"""Median steps: a step of four missing pulses still shows the lattice, longer ones blur with the
grid's own spacing."""

_MOST_STEPS = 800
"""Steps by which lattices are compared, for the time."""

_PARTS = (1, 2, 3, 4)
"""Of the median step: where most pulses don't come back it is a multiple of the interval."""

_GRID_LOW, _GRID_HIGH, _GRID_STEPS = 0.75, 1.25, 161
"""Steps tried about each part, by 0.3 %: over four steps that shifts the phase by 4.5°."""

_NEAR_PART, _LEAST_ALONE = 0.4, 0.05
"""A common step occurs by itself, to 40 % of it, in a twentieth of the steps at least. By trial; no
measurement is recorded."""

_AS_STRONG = 0.9
"""Of the strongest: the longest step as good as that is the interval, its parts fit as well. By
trial; no measurement is recorded."""

_PIECES = 60
"""Pieces of a stretch by which the interval is made better, for the time."""

_PIECE_PULSES, _PIECES_EVERY = 256, 2048
"""Pulses of a piece whose coherence is measured, and from one piece to the next: the clock's drift
over a piece is nothing beside the interval."""

_FULL_PERCENTILE = 95
"""Of the pulses of a quantum: what one holds without a loss; a few hold others' pulses too."""

_SPECTRUM_SIZE = 1 << 17
"""Quanta whose counts are transformed: a beat is known to a hundred-thousandth."""

_LOWEST_BEAT = 100
"""Part of the spectrum that is left out: the counts' slow drift."""

_CLEAR_PEAK = 50.0
"""Times the spectrum's median from which a beat is a line: noise exceeds 50 medians of power (35
means) once in 10¹⁵ times."""


@dataclass(frozen=True)
class PulseClock:
    """The rhythm of the laser.

    Attributes
    ----------
    interval_s : float
        Between two pulses.
    quantum_s : float
        Step of the recorded times where it is so coarse that pulses share a time, else 0.
    coherence : float
        0..1: how well the times lie on the lattice.
    """

    interval_s: float
    quantum_s: float
    coherence: float


def estimate_clock(samples: Iterable[PointColumns]) -> PulseClock | None:
    """The pulse interval of a recording from some contiguous stretches of it.

    Returns
    -------
    PulseClock or None
        None when the times have no common step: thinned, merged or without enough digits.

    Notes
    -----
    1. The common step δ of neighbouring times maximises the mean of exp(2πi Δt / δ) near the median
       step and its parts; it is then refined on lattices over growing stretches.
    2. Where pulses share times, that step is the quantum of the times, and the interval follows
       from how many pulses share a quantum in stretches without losses.
    """
    chunks = [_pulse_times(sample) for sample in samples]
    chunks = [times for times in chunks if times.size >= _LEAST_PULSES]
    if not chunks:
        return None
    steps = np.concatenate([np.diff(times) for times in chunks])
    apart = steps[(steps > 0) & (steps < LONGEST_MISSING_S)]
    if apart.size < _LEAST_STEPS:
        return None
    distinct = [np.unique(times) for times in chunks]
    step = _common_step(apart)
    if step is None:
        return None
    interval = _refine_interval(distinct, step)
    coherence = _coherence(distinct, interval)
    if coherence < _LEAST_COHERENCE:
        return None
    if np.mean(steps == 0) < _TIES_OF_ROUNDED_TIMES:
        return PulseClock(interval, 0.0, coherence)
    return PulseClock(_interval_of_shared_times(chunks, interval), interval, coherence)


class PulseNumbering:
    """Numbers pulses chunk by chunk, locked to the clock, which it follows as it drifts."""

    def __init__(self, clock: PulseClock, first_time: float, first_number: int) -> None:
        self._clock = clock
        self._first_number = first_number
        self._state = new_state(first_time, clock.interval_s)

    @property
    def interval_s(self) -> float:
        """The interval as tracked so far."""
        return float(self._state[2])

    def number(self, points: PointColumns, *, is_last: bool) -> NDArray[np.int64]:
        """The pulse of each point of the next stretch.

        Parameters
        ----------
        points : PointColumns
            More than share one time.
        is_last : bool
            False: pulses that share their time with the last point may follow.

        Returns
        -------
        (m,) int64
            From the first number, not decreasing. ``m`` is the number of points, or less by those
            of the last shared time, which are to be given again at the start of the next chunk.
        """
        times = np.ascontiguousarray(points.time)
        pulses = np.empty(times.size, dtype=np.int64)
        repeats = _is_same_pulse(points)
        if self._clock.quantum_s == 0.0:
            number_exact(times, LONGEST_MISSING_S, self._state, pulses)
            pulses += self._first_number
            return pulses
        done = times.size
        if not is_last:
            done = int(np.searchsorted(times, times[-1] - 0.5 * self._clock.quantum_s)) or done
        pulses = pulses[:done]
        limits = TimeLimits(self._clock.quantum_s, LONGEST_MISSING_S)
        number_rounded(times, repeats, limits, self._state, pulses)
        pulses += self._first_number
        return pulses


def _is_same_pulse(points: PointColumns) -> NDArray[np.bool_]:
    """Whether a point is a later return of the pulse of the point before it."""
    same = np.zeros(points.count, dtype=np.bool_)
    later = np.flatnonzero(points.time[1:] == points.time[:-1]) + 1
    number, returns = points.return_number, points.number_of_returns
    rises = (number[later] > number[later - 1]) & (returns[later] > 1) & (returns[later - 1] > 1)
    is_copy = (points.xyz[later] == points.xyz[later - 1]).all(axis=1)
    same[later] = rises | is_copy
    return same


def _pulse_times(sample: PointColumns) -> Floats:
    """Times from the first on, one per pulse; files without return numbers say nothing of ties."""
    times = sample.time[~_is_same_pulse(sample)]
    if sample.count and sample.number_of_returns.max() == 0:
        times = np.unique(times)
    return times - times[0] if times.size else times


def _common_step(steps: Floats) -> float | None:
    """The step of which most others are multiples, to a few per cent; None where there is none."""
    median = float(np.median(steps))
    short = steps[steps < _LONGEST_STEP * median]
    short = short[:: max(1, short.size // _MOST_STEPS)]
    best: list[tuple[float, float]] = []
    for part in _PARTS:
        grid = median / part * np.linspace(_GRID_LOW, _GRID_HIGH, _GRID_STEPS)
        # Times rounded to decimals have a finer common step that never occurs alone.
        is_alone = np.abs(short - median / part) < _NEAR_PART * median / part
        if np.mean(is_alone) < _LEAST_ALONE:
            continue
        waves = np.exp((2j * np.pi) * np.outer(1.0 / grid, short))
        strength = waves.mean(axis=1).real
        at = int(np.argmax(strength))
        best.append((float(strength[at]), float(grid[at])))
    most = max((strength for strength, _ in best), default=0.0)
    if most <= 0:
        return None  # the steps avoid the multiples of each
    return next(step for strength, step in best if strength >= _AS_STRONG * most)


def _refine_interval(chunks: list[Floats], step: float) -> float:
    for size in _STAGES:
        slopes = [
            _slopes(times, starts, size, step)
            for times in chunks
            if (
                starts := np.arange(0, times.size - size + 1, max(size, times.size // _PIECES))
            ).size
        ]
        if slopes:
            step = float(np.median(np.concatenate(slopes)))
    return step


def _slopes(times: Floats, starts: NDArray[np.int64], size: int, step: float) -> Floats:
    """The step of the lattice on which each of some pieces of a stretch lies best."""
    pieces = np.lib.stride_tricks.sliding_window_view(times, size)[starts]
    along = pieces - pieces[:, :1]
    offset = along - np.rint(along / step) * step
    turned = np.angle(np.exp((2j * np.pi / step) * offset).mean(axis=1)) / (2 * np.pi)
    near = np.rint(along / step - turned[:, None])
    centred = near - near.mean(axis=1, keepdims=True)
    spread = (centred**2).sum(axis=1)
    # A piece without a step, all its pulses at one time, says nothing.
    has_steps = (spread > 0) & (along[:, -1] > 0)
    slopes = np.full(starts.size, step)
    np.divide((centred * along).sum(axis=1), spread, out=slopes, where=has_steps)
    return slopes


def _coherence(chunks: list[Floats], step: float) -> float:
    """How well stretches of some hundred pulses lie on the lattice, 0..1."""
    parts = [
        np.abs(np.mean(np.exp(2j * np.pi * (times[at : at + _PIECE_PULSES] / step))))
        for times in chunks
        for at in range(0, max(1, times.size - _PIECE_PULSES + 1), _PIECES_EVERY)
    ]
    return float(np.median(parts))


def _interval_of_shared_times(chunks: list[Floats], quantum: float) -> float:
    """The pulse interval where several pulses share a time.

    A quantum holds the integer part of quantum / interval pulses, or one more; how often it holds
    one more beats with the fraction, and the beat is a sharp line in the spectrum of the counts.
    """
    counts = [np.bincount(np.rint(times / quantum).astype(np.int64)) for times in chunks]
    often = np.concatenate(counts)
    often = often[often > 0]
    most = int(np.percentile(often, _FULL_PERCENTILE))
    dense = float(np.mean(often[often >= most - 1]))
    size = _SPECTRUM_SIZE
    power = np.zeros(size // 2 + 1)
    for count in counts:
        full = count >= most - 1
        wave = np.where(full, count - dense, 0.0)[:size] * full[:size]
        power += np.abs(np.fft.rfft(wave, size)) ** 2
    low = size // _LOWEST_BEAT
    peak = low + int(np.argmax(power[low:]))
    if power[peak] < _CLEAR_PEAK * np.median(power[low:]):
        return quantum / max(1, round(dense))
    beat = peak / size
    shared = min((most - 1 + beat, most - beat), key=lambda number: abs(number - dense))
    return quantum / shared
