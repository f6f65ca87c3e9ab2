"""Kernels over points in order of measurement: how a beam that turns about a centre explains them.

All of them work in the plane of the sweep: x to the right, y up, as :mod:`sweep_fit` lays it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel

NEAR_RAD = 0.14
"""8°: points that follow one another in a sweep are seen no farther apart, but where beams went
into the sky; a scanner with fewer than some hundred pulses a turn draws no lines."""

_STEPS_TRIED = 11
"""Angular steps that are tried about the median of the increments, and how far off it."""

_FARTHEST_STEP = 0.2

_HALF = 0.5

_LEAST_NEAR = 50
"""Increments from which a step can be told."""

_BACK = -1.0
"""What an increment that goes back counts, as much as one half-way between two pulses."""

_LEAST_TURN_BACK_RAD = 0.09
"""5°: a beam never goes back, but its angle seen from an estimated centre does: by 10 cm of error
over 1.2 m, the nearest that anything stands to a scanner."""

_SAME_BEAM_SPACINGS = 5.0
"""A later return of a pulse lies farther behind the one before than so many spacings of pulses:
nearer ones are neighbours whose angles coordinates round together."""


@kernel
def increments_kernel(plane: Floats, x: float, y: float, sense: float, increments: Floats) -> None:
    """Angles from each point to the next one, seen from a place in the plane, rad, ± half a turn.

    Parameters
    ----------
    plane : (n, 2) float64
        m.
    sense : float
        1 for angles that grow to the left, −1 for the reverse.
    increments : (n − 1,) float64
        Written.
    """
    for at in range(increments.size):
        ax, ay = plane[at, 0] - x, plane[at, 1] - y
        bx, by = plane[at + 1, 0] - x, plane[at + 1, 1] - y
        increments[at] = sense * np.arctan2(ax * by - ay * bx, ax * bx + ay * by)


@kernel
def lattice_kernel(increments: Floats, weights: Floats, step: float) -> tuple[float, float]:
    """How well increments are whole numbers of pulses that go forward.

    Parameters
    ----------
    increments, weights : (n,) float64
        rad; what each counts, not below 0.
    step : float
        rad from pulse to pulse; 0 for one that is to be found.

    Returns
    -------
    coherence : float
        −1..1: mean cosine of what is left beside whole steps; −1 where most don't follow.
    step : float
        rad.
    """
    near = increments[np.abs(increments) < NEAR_RAD]
    forward = near[near > 0]
    if near.size < _HALF * increments.size or forward.size < _LEAST_NEAR:
        return -1.0, step
    middle = step if step > 0 else float(np.median(forward))
    tried = 1 if step > 0 else _STEPS_TRIED
    best, best_step = -2.0, middle
    for number in range(tried):
        share = 2.0 * number / (tried - 1) - 1.0 if tried > 1 else 0.0
        asked = middle * (1.0 + _FARTHEST_STEP * share)
        total, weight = 0.0, 1e-12
        for at in range(increments.size):
            turned = increments[at]
            if abs(turned) >= NEAR_RAD:
                continue
            value = np.cos(2 * np.pi * turned / asked) if turned > _HALF * asked else _BACK
            total += weights[at] * value
            weight += weights[at]
        if total / weight > best:
            best, best_step = total / weight, asked
    return best, best_step


@kernel
def refined_step_kernel(increments: Floats, weights: Floats, step: float) -> float:
    """The mean step, rad, of increments that are about whole steps; 0 without any."""
    turned, steps = 0.0, 0.0
    for at in range(increments.size):
        whole = np.round(increments[at] / step)
        if whole >= 1 and increments[at] < NEAR_RAD:
            turned += weights[at] * increments[at]
            steps += weights[at] * whole
    return turned / steps if steps > 0 else 0.0


@kernel
def search_kernel(
    plane: Floats, weights: Floats, asked: Floats, step: float, found: Floats
) -> None:
    """The place from which the increments are best explained, of those on a grid.

    Parameters
    ----------
    asked : (places, 3) float64
        x, y and sense.
    step : float
        rad; 0 for unknown.
    found : (5,) float64
        x, y, sense, step and coherence of the best; kept where it is better than all.
    """
    increments = np.empty(plane.shape[0] - 1)
    for at in range(asked.shape[0]):
        x, y, sense = asked[at, 0], asked[at, 1], asked[at, 2]
        increments_kernel(plane, x, y, sense, increments)
        coherence, seen = lattice_kernel(increments, weights, step)
        if coherence > found[4]:
            found[0], found[1], found[2], found[3], found[4] = x, y, sense, seen, coherence


@kernel
def unwrap_kernel(angles: Floats, last: Floats, phases: Floats) -> None:
    """Turns since the beginning of angles that only go forward.

    Parameters
    ----------
    angles : (n,) float64
        rad, in the sense of the turning, from below.
    last : (1,) float64
        Turns at the point before; NaN at the beginning. Goes on.
    phases : (n,) float64
        Turns; written.
    """
    turn_back = _LEAST_TURN_BACK_RAD / (2 * np.pi)
    for at in range(angles.size):
        share = angles[at] / (2 * np.pi)
        if np.isnan(last[0]):
            last[0] = share
        else:
            miss = share - last[0]
            last[0] += miss - np.floor(miss + turn_back)
        phases[at] = last[0]


@kernel
def pulses_kernel(
    phases: Floats, ranges: Floats, per_turn: int, last: Floats, pulses: NDArray[np.int64]
) -> None:
    """Number of the pulse of each point, never going back.

    Parameters
    ----------
    phases, ranges : (n,) float64
        Turns; m from the centre.
    last : (3,) float64
        Pulse, turns and range of the point before. Goes on.
    pulses : (n,) int64
        Written.

    Notes
    -----
    A point has the pulse that its angle rounds to. One that the point before has already is
    followed by the next pulse, unless the point is a later return: in the same direction, but
    clearly farther. So rounded coordinates put no two pulses into one pixel, and every gap of the
    sweep takes back what was pushed on.
    """
    for at in range(phases.size):
        wanted = np.round(phases[at] * per_turn)
        steps = (phases[at] - last[1]) * per_turn
        spacing = 2 * np.pi / per_turn * min(ranges[at], last[2])
        is_later = abs(steps) < _HALF and (
            abs(ranges[at] - last[2]) > _SAME_BEAM_SPACINGS * spacing
        )
        last[0] = max(wanted, last[0] if is_later else last[0] + 1)
        last[1], last[2] = phases[at], ranges[at]
        pulses[at] = np.int64(last[0])


def warm_up() -> None:
    """Compile the kernels."""
    angles = np.linspace(0.0, 3.0, 100)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    weights, turns = np.ones(99), np.empty(100)
    increments_kernel(circle, 0.0, 0.0, 1.0, weights)
    lattice_kernel(weights, weights, 0.0)
    refined_step_kernel(weights, weights, 0.03)
    search_kernel(circle, np.ones(99), np.zeros((1, 3)), 0.03, np.zeros(5))
    unwrap_kernel(angles, np.array([np.nan]), turns)
    pulses_kernel(turns, angles, 100, np.zeros(3), np.zeros(100, np.int64))
