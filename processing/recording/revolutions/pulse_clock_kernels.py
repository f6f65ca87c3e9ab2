"""Kernels that number pulses: a second-order loop locked to the lattice of the pulse times."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

Floats = NDArray[np.float64]

# Gain on the phase per point once locked, its quarter square on the interval (critical damping):
# a memory of some thousand pulses, so that a sky gap of half a turn is bridged to 0.01 pulse.
_GAIN = 4e-4
_STEADY_AFTER = 400


def new_state(first_time: float, interval_s: float) -> Floats:
    """What the loop remembers between stretches.

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
    limits: Floats,
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
    limits : (2,) float64
        Step of the times, and the longest time that is no stop, s.
    pulses : (m,) int64
        Filled for the first ``m`` points.
    """
    _number_rounded_kernel(times, repeats, limits, state, pulses)


@kernel
def _number_exact_kernel(
    times: Floats, longest_s: float, state: Floats, pulses: NDArray[np.int64]
) -> None:
    base, lattice, interval, age, last = state[0], state[1], state[2], state[4], state[5]
    nominal = state[6]
    number = np.int64(state[3])
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
                    interval += 0.25 * _GAIN * _GAIN * error
                    if abs(interval - nominal) > 1e-3 * nominal:
                        interval = nominal
        last = time
        pulses[i] = number
    state[1], state[2], state[3], state[4], state[5] = lattice, interval, float(number), age, last


@kernel
def _number_rounded_kernel(
    times: Floats,
    repeats: NDArray[np.bool_],
    limits: Floats,
    state: Floats,
    pulses: NDArray[np.int64],
) -> None:
    """Fill the slots of each quantum.

    Points that follow a gap and run on belong to the last slots of their quantum, others to the
    first free ones.
    """
    base, lattice, interval, age, last = state[0], state[1], state[2], state[4], state[5]
    number = np.int64(state[3])
    quantum, longest_s = limits[0], limits[1]
    count = times.shape[0]
    start = 0
    while start < pulses.shape[0]:
        time = times[start] - base
        stop = start + 1
        pulses_here = 1
        while stop < count and times[stop] - base < time + 0.5 * quantum:
            pulses_here += 0 if repeats[stop] else 1
            stop += 1
        follows = number >= 0 and time - last < 1.5 * quantum
        leads = stop < count and times[stop] - base < time + 1.5 * quantum
        if number < 0:
            lattice, age = time - interval, 0.0
            first = np.int64(0)
        else:
            free = number + 1
            # The lattice holds the time of the last pulse; slack forgives its noise.
            slot = number + np.int64(np.ceil((time - lattice) / interval - 0.6))
            past = number + np.int64(np.ceil((time + quantum - lattice) / interval - 0.4))
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
            gain = max(1.0 / (age + 1.0), 4.0 * _GAIN)
            lattice += gain * error
            if age > _STEADY_AFTER:
                interval += 0.25 * gain * gain * error / pulses_here
        age += 1.0
        pulse = first - 1
        for i in range(start, stop):
            pulse += 0 if i > start and repeats[i] else 1
            pulses[i] = pulse
        last = time
        start = stop
    state[1], state[2], state[3], state[4], state[5] = lattice, interval, float(number), age, last


def warm_up() -> None:
    """Compile the kernels."""
    times = np.array([0.0, 1e-5, 2e-5])
    pulses = np.empty(3, dtype=np.int64)
    number_exact(times, 1.0, new_state(0.0, 1e-5), pulses)
    limits = np.array([1e-5, 1.0])
    number_rounded(times, np.zeros(3, dtype=np.bool_), limits, new_state(0.0, 4e-6), pulses)
