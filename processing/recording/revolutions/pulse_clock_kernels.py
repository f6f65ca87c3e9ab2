"""Kernels that number pulses: a second-order loop locked to the lattice of the pulse times."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel

_GAIN = 4e-4
"""On the phase per point once locked, its quarter square on the interval (critical damping): a
memory of some thousand pulses, so that a sky gap of half a revolution is bridged to 0.01 pulse."""

_DAMPED = 0.25
"""Of the square of the gain: what the interval takes over at critical damping."""

_STEADY_AFTER = 400
"""Points until the loop is locked; before that phases are averaged. By trial; no measurement is
recorded."""

_MOST_DRIFT = 1e-3
"""Share by which an interval may drift off the nominal one before it is set back: clocks are good
to a millionth."""

_SLOT_SLACK, _PAST_SLACK = 0.6, 0.4
"""Of an interval: noise of the lattice that is forgiven when slots of a quantum are counted. By
trial; no measurement is recorded."""

_SAME_QUANTUM, _NEXT_QUANTUM = 0.5, 1.5
"""Times nearer than half a step are equal; nearer than one and a half follow."""

_GAIN_OF_QUANTA = 4.0
"""A whole quantum of pulses weighs so many times as much as one of them."""

_BASE, _LATTICE, _INTERVAL, _NUMBER, _AGE, _LAST, _NOMINAL = range(7)
"""Of the state: see `new_state`."""


class TimeLimits(NamedTuple):
    """Step of the times, and the longest time that is no stop, s."""

    quantum_s: float
    longest_s: float


def new_state(first_time: float, interval_s: float) -> Floats:
    """What the loop remembers between chunks.

    Returns
    -------
    (7,) float64
        Base time; time of the last pulse on the lattice, from the base; interval, s; number of the
        last pulse; points since the loop was anchored; last recorded time, from the base; nominal
        interval, s.
    """
    return np.array([first_time, 0.0, interval_s, -1.0, 0.0, -1.0, interval_s])


def number_exact(times: Floats, longest_s: float, state: Floats, pulses: NDArray[np.int64]) -> None:
    """Number the pulses of points whose times tell pulses apart; equal times are one pulse."""
    _number_exact_kernel(times, longest_s, state, pulses)


def number_rounded(
    times: Floats,
    repeats: NDArray[np.bool_],
    limits: TimeLimits,
    state: Floats,
    pulses: NDArray[np.int64],
) -> None:
    """Number the pulses of points of which several share a recorded time, in their order.

    Parameters
    ----------
    times : (n,) float64
        May hold more points than are to be numbered: what follows tells where a gap is.
    repeats : (n,) bool
        Whether a point is a later return of the pulse before it.
    limits : TimeLimits
    pulses : (m,) int64
        Filled for the first ``m`` points.
    """
    _number_rounded_kernel(times, repeats, limits, state, pulses)


@kernel
def _number_exact_kernel(
    times: Floats, longest_s: float, state: Floats, pulses: NDArray[np.int64]
) -> None:
    base, lattice, interval = state[_BASE], state[_LATTICE], state[_INTERVAL]
    age, last = state[_AGE], state[_LAST]
    nominal = state[_NOMINAL]
    number = np.int64(state[_NUMBER])
    for i in range(times.shape[0]):
        time = times[i] - base
        if number < 0:
            number, lattice, age = np.int64(0), time, 0.0
        elif time > last:
            ahead = time - lattice
            steps = np.int64(np.floor(ahead / interval + 0.5))
            if time - last > longest_s:
                number += steps if steps > 0 else 1
                lattice, age = time, 0.0
            elif steps > 0:
                number += steps
                error = ahead - steps * interval
                age += 1.0
                if age < _STEADY_AFTER:
                    lattice += steps * interval + error / (age + 1.0)
                else:
                    lattice += steps * interval + _GAIN * error
                    interval += _DAMPED * _GAIN * _GAIN * error
                    if abs(interval - nominal) > _MOST_DRIFT * nominal:
                        interval = nominal
        last = time
        pulses[i] = number
    state[_LATTICE], state[_INTERVAL], state[_NUMBER] = lattice, interval, float(number)
    state[_AGE], state[_LAST] = age, last


@kernel
def _number_rounded_kernel(
    times: Floats,
    repeats: NDArray[np.bool_],
    limits: TimeLimits,
    state: Floats,
    pulses: NDArray[np.int64],
) -> None:
    """Fill the slots of each quantum.

    Points that follow a gap and run on belong to the last slots of their quantum, others to the
    first free ones.
    """
    base, lattice, interval = state[_BASE], state[_LATTICE], state[_INTERVAL]
    age, last, number = state[_AGE], state[_LAST], np.int64(state[_NUMBER])
    quantum, longest_s = limits.quantum_s, limits.longest_s
    start, count = 0, times.shape[0]
    while start < pulses.shape[0]:
        time = times[start] - base
        stop = start + 1
        pulses_here = 1
        while stop < count and times[stop] - base < time + _SAME_QUANTUM * quantum:
            pulses_here += 0 if repeats[stop] else 1
            stop += 1
        follows = number >= 0 and time - last < _NEXT_QUANTUM * quantum
        leads = stop < count and times[stop] - base < time + _NEXT_QUANTUM * quantum
        if number < 0:
            lattice, age = time - interval, 0.0
            first = np.int64(0)
        else:
            free = number + 1
            # The lattice holds the time of the last pulse; slack forgives its noise.
            slot = number + np.int64(np.ceil((time - lattice) / interval - _SLOT_SLACK))
            past = number + np.int64(np.ceil((time + quantum - lattice) / interval - _PAST_SLACK))
            first = max(free, slot)
            if not follows and leads:
                first = max(first, past - pulses_here)
            if time - last > longest_s:
                age = 0.0
        middle = first + 0.5 * (pulses_here - 1)
        expected = lattice + (middle - number) * interval
        error = time + 0.5 * quantum - expected
        lattice += (first + pulses_here - 1 - number) * interval
        number = first + pulses_here - 1
        if age == 0.0:
            lattice += 0.5 * error
        elif follows and leads:
            gain = max(1.0 / (age + 1.0), _GAIN_OF_QUANTA * _GAIN)
            lattice += gain * error
            if age > _STEADY_AFTER:
                interval += _DAMPED * gain * gain * error / pulses_here
        age += 1.0
        pulse = first - 1
        for i in range(start, stop):
            pulse += 0 if i > start and repeats[i] else 1
            pulses[i] = pulse
        last = time
        start = stop
    state[_LATTICE], state[_INTERVAL], state[_NUMBER] = lattice, interval, float(number)
    state[_AGE], state[_LAST] = age, last


def warm_up() -> None:
    """Compile the kernels."""
    times = np.array([0.0, 1e-5, 2e-5])
    pulses = np.empty(3, dtype=np.int64)
    number_exact(times, 1.0, new_state(0.0, 1e-5), pulses)
    limits = TimeLimits(1e-5, 1.0)
    number_rounded(times, np.zeros(3, dtype=np.bool_), limits, new_state(0.0, 4e-6), pulses)
