"""Points so far from all others that no scanner measured them: spikes of kilometres."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_ENDS_PERCENT = 1.0
"""Of the points at either end of an axis that may be far; by trial, spikes are fewer."""

_EXTENTS, _LEAST_M = 50.0, 1_000.0
"""How far they lie away from the rest, in its extents and at least: no scanner measures so far
from its own cloud. By trial; spikes that were met lay thousands of kilometres away."""

_SAMPLE = 100_000
"""Points whose percentiles are taken: a thousand of them lie beyond each."""


def is_far(xyz: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether points lie many times the extent of nearly all points away from them.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, finite.

    Returns
    -------
    (n,) bool
    """
    if not xyz.shape[0]:
        return np.zeros(0, np.bool_)
    sample = xyz[:: max(1, xyz.shape[0] // _SAMPLE)]
    low, high = np.percentile(sample, (_ENDS_PERCENT, 100.0 - _ENDS_PERCENT), axis=0)
    reach = max(_LEAST_M, _EXTENTS * float((high - low).max()))
    least, most = low - reach, high + reach
    far = np.zeros(xyz.shape[0], np.bool_)
    # Axis by axis: NumPy takes ten times as long over rows of three.
    for axis, values in enumerate(xyz.T):
        if values.min() < least[axis] or values.max() > most[axis]:
            far |= (values < least[axis]) | (values > most[axis])
    return far


def heights_of_far(xyz: NDArray[np.float64], others: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) height of far points above the lowest of the other points, m."""
    lowest = float(others[:, 2].min()) if others.shape[0] else 0.0
    heights: NDArray[np.float64] = xyz[:, 2] - lowest
    return heights
