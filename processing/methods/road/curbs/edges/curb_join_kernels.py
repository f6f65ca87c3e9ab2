"""Loop that makes one value at each station of what several drives measured there."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]

_MOST_OFFSET_M = 0.15
"""Between drives of one survey: what trajectories differ by where satellites are hidden. Offsets
beyond it are of two different edges, and none is removed. By trial: no measurement is recorded."""

_LEAST_TOGETHER = 8
"""Stations that several drives measured, two metres: from fewer no offset is told from noise. By
trial."""

_ROUNDS = 5
"""Offsets and means are found in turn; the median of what is off has settled by then. By trial."""

_LEAST_WEIGHT = 1e-12
"""Guard of a division where nothing was measured."""


@kernel
def join_kernel(values: _Floats, errors: _Floats, mean: _Floats, error: _Floats) -> None:
    """Weighted mean of drives after their offsets are removed, and its error.

    Parameters
    ----------
    values, errors : (d, m)
        What each drive measured at each station, m; the error infinite where nothing.
    mean, error : (m,)
        Filled; NaN and infinite where nothing was measured.
    """
    drives, stations = values.shape
    weights = np.zeros((drives, stations))
    for drive in range(drives):
        for k in range(stations):
            if errors[drive, k] < math.inf:
                weights[drive, k] = 1.0 / errors[drive, k] ** 2
    offsets = np.zeros(drives)
    _find_offsets(values, weights, offsets)
    for k in range(stations):
        total, summed = _total(values, weights, offsets, k)
        mean[k] = summed / total if total > 0 else math.nan
        error[k] = 1.0 / math.sqrt(total) if total > 0 else math.inf


@kernel
def _find_offsets(values: _Floats, weights: _Floats, offsets: _Floats) -> None:
    """How far each drive lies off what all of them together measured, where they overlap."""
    drives, stations = values.shape
    means, shifts = np.empty(stations), np.empty(drives)
    together = np.zeros(stations, np.bool_)
    for k in range(stations):
        together[k] = np.sum(weights[:, k] > 0) > 1
    if together.sum() < _LEAST_TOGETHER:
        return
    for _ in range(_ROUNDS):
        for k in range(stations):
            total, summed = _total(values, weights, offsets, k)
            means[k] = summed / max(total, _LEAST_WEIGHT)
        for drive in range(drives):
            off = (values[drive] - offsets[drive] - means)[together & (weights[drive] > 0)]
            shifts[drive] = np.median(off) if off.size >= _LEAST_TOGETHER else 0.0
        offsets += shifts
    for drive in range(drives):
        if abs(offsets[drive]) > _MOST_OFFSET_M:
            offsets[drive] = 0.0


@kernel
def _total(values: _Floats, weights: _Floats, offsets: _Floats, k: int) -> tuple[float, float]:
    """Sums of the weights and of the weighted values at a station."""
    total, summed = 0.0, 0.0
    for drive in range(values.shape[0]):
        if weights[drive, k] > 0:
            total += weights[drive, k]
            summed += weights[drive, k] * (values[drive, k] - offsets[drive])
    return total, summed


def warm_up() -> None:
    """Compile the kernel."""
    values = np.zeros((2, 9))
    join_kernel(values, values + 1.0, np.empty(9), np.empty(9))
