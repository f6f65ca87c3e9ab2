"""Values along a line, smoothed: as near to what was measured as its errors allow, with few bends.

Bends are weighed by how sharp they are (an L1 norm, iterated): a curb is straight or evenly curved
for metres, and then has a corner or a ramp's end, which stays a corner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded
from scipy.ndimage import median_filter

_Floats = NDArray[np.float64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_ROUNDS = 4
"""Of the iteration that weighs sharp bends less. By trial."""

_BESIDE = 9
"""Values among which one stands out: two metres of a curb. By trial."""

_FAR = 2.0
"""What is off by more than so many times the usual weighs less and less, at twice that a
seventeenth."""

_OF_MEDIAN = 1.5
"""A standard deviation is about so many times the median of what is off (1.48 of normal noise)."""

_LEAST_WEIGHT = 1e-12
"""Keeps the equations solvable where nothing is known."""


@dataclass(frozen=True)
class Smoothness:
    """How values are smoothed.

    Attributes
    ----------
    stiffness : float
        Weight of a bend against that of a value.
    kink : float
        A bend (second difference) as great as this, in the values' unit, costs half as much.
    """

    stiffness: float
    kink: float


def smooth_values(values: _Floats, weights: _Floats, smoothness: Smoothness) -> _Floats:
    """Values at even spacing, smoothed.

    Parameters
    ----------
    values : (n,) float64
        NaN only where the weight is 0.
    weights : (n,) float64
        1 / variance, in whatever unit of all; 0: nothing is known.

    Returns
    -------
    (n,) float64
        NaN where nothing is known at all.
    """
    known = weights > 0
    if values.size < 3 or known.sum() < 2:
        return np.where(known, values, values[known][0] if known.any() else np.nan)
    filled = np.where(known, values, 0.0)
    trust = np.zeros(values.size)
    trust[known] = _trust_of(values[known], weights[known], smoothness.kink)
    bends = np.ones(values.size - 2)
    result = filled
    for _ in range(_ROUNDS):
        result = _solve(filled, trust, bends * smoothness.stiffness)
        bends = 1.0 / (1.0 + np.abs(np.diff(result, 2)) / smoothness.kink)
    return result


def _trust_of(values: _Floats, weights: _Floats, least: float) -> _Floats:
    """Weights, less where a value stands out from those beside it; a corner does not."""
    off = np.abs(values - median_filter(values, _BESIDE, mode="nearest"))
    usual = max(_OF_MEDIAN * float(np.median(off)), least)
    return np.asarray(weights / (1.0 + (off / (_FAR * usual)) ** 4))


def _solve(values: _Floats, weights: _Floats, bends: _Floats) -> _Floats:
    """Least squares of values and second differences."""
    count = values.size
    band = np.zeros((3, count))
    band[2] = weights + _LEAST_WEIGHT
    band[2, :-2] += bends
    band[2, 1:-1] += 4 * bends
    band[2, 2:] += bends
    band[1, 1:-1] += -2 * bends
    band[1, 2:] += -2 * bends
    band[0, 2:] += bends
    return np.asarray(solveh_banded(band, weights * values))
