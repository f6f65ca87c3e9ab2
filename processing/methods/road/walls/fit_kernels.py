"""Loops that lay lines through the stations of a wall."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

_ROUNDS = 6
"""Of weighting; steps are far below a millimetre then."""

_FEWEST = 3
"""Stations that straighten one."""

_ONE_PLACE = 1e-30
"""Square of a width, over the weight, below which stations lie at one place and tell no slope."""


@kernel
def robust_fit_kernel(terms: Floats, values: Floats, huber_m: float, found: Floats) -> None:
    """Coefficients of (n, k) terms by least squares with the weights of Huber."""
    root = np.ones(len(values))
    for _ in range(_ROUNDS):
        found[:] = np.linalg.lstsq(terms * root[:, None], values * root)[0]
        left = np.abs(values - terms @ found)
        root[:] = np.sqrt(huber_m / np.maximum(left, huber_m))


@kernel
def running_fit_kernel(
    along: Floats, values: Floats, run: int, huber_m: float, found: Floats
) -> None:
    """Put each station on the straight line through those about it, up to ``run`` to either side.

    Least squares with the weights of Huber: what lies farther off than ``huber_m`` counts less.
    """
    weights = np.empty(2 * run + 1)
    for at in range(len(along)):
        low, high = max(0, at - run), min(len(along), at + run + 1)
        found[at] = values[at]
        if high - low < _FEWEST:
            continue
        weights[:] = 1.0
        for _ in range(_ROUNDS):
            total, x, y, xx, xy = 0.0, 0.0, 0.0, 0.0, 0.0
            for k in range(low, high):
                total += weights[k - low]
                x += weights[k - low] * (along[k] - along[at])
                y += weights[k - low] * values[k]
            x /= total
            y /= total
            for k in range(low, high):
                off = along[k] - along[at] - x
                xx += weights[k - low] * off * off
                xy += weights[k - low] * off * (values[k] - y)
            slope = xy / xx if xx > _ONE_PLACE * total else 0.0
            found[at] = y - slope * x
            for k in range(low, high):
                left = abs(values[k] - found[at] - slope * (along[k] - along[at]))
                weights[k - low] = huber_m / max(left, huber_m)


@kernel
def station_medians_kernel(
    station: Integers, along: Floats, off: Floats, fewest: int, told: Floats
) -> int:
    """Mean place and median distance of the points of each station that has enough; how many.

    Parameters
    ----------
    station : (n,) int64
        Of each point, from 0 on.
    told : (m, 2) float64
        For m stations at most, filled from the start.
    """
    starts = np.zeros(len(told) + 1, np.int64)
    for point in range(len(station)):
        starts[station[point] + 1] += 1
    starts = np.cumsum(starts)
    places, order = starts[:-1].copy(), np.empty(len(station), np.int64)
    for point in range(len(station)):
        order[places[station[point]]] = point
        places[station[point]] += 1
    count = 0
    for one in range(len(told)):
        own = order[starts[one] : starts[one + 1]]
        if len(own) < max(fewest, 1):
            continue
        total = 0.0
        for point in own:
            total += along[point] - along[own[0]]
        told[count, 0] = along[own[0]] + total / len(own)
        told[count, 1] = np.median(off[own])
        count += 1
    return count
