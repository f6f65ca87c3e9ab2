"""The likeliest course of an edge along a way: one place beside each station."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

_NEAR = 3
"""Cells that an edge may lie farther out or in at the next station, as the vehicle swerves: 15 cm
over half a metre."""


@kernel
def likeliest_kernel(gains: Floats, turn: float, jump: float, course: Integers) -> None:
    """The course with the largest sum of gains, less what its turns and jumps cost.

    Parameters
    ----------
    gains : (stations, places) float64
    turn, jump : float
        Cost of each place that it moves by from a station to the next, up to three; and of moving
        anywhere.
    course : (stations,) int64

    References
    ----------
    Bellman, R. 1957: Dynamic programming; Viterbi's algorithm.
    """
    stations, places = gains.shape
    before = np.empty((stations, places), np.int32)
    best = gains[0].copy()
    after = np.empty(places)
    for station in range(1, stations):
        top = int(np.argmax(best))
        for place in range(places):
            found, value = top, best[top] - jump
            for step in range(-_NEAR, _NEAR + 1):
                other = place + step
                if 0 <= other < places:
                    reached = best[other] - turn * abs(step)
                    if reached > value:
                        found, value = other, reached
            before[station, place] = found
            after[place] = value + gains[station, place]
        best[:] = after
    at = int(np.argmax(best))
    for station in range(stations - 1, -1, -1):
        course[station] = at
        at = before[station, at]
