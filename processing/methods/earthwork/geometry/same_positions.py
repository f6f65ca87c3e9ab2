"""Places that are one but for rounding, given one number."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def number_positions(
    positions: NDArray[np.float64], within_m: float
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """A number for each position, the same for those that round to one.

    Parameters
    ----------
    positions : (n, d) float64
        Near the origin, m.

    Returns
    -------
    numbers : (n,) int64
    firsts : (k,) int64
        The first position of each number.
    """
    whole = np.round(positions / within_m).astype(np.int64)
    order = np.lexsort(whole.T)
    is_new = np.ones(len(positions), bool)
    is_new[1:] = np.any(np.diff(whole[order], axis=0) != 0, axis=1)
    numbers = np.empty(len(positions), np.int64)
    numbers[order] = np.cumsum(is_new) - 1
    return numbers, order[is_new]
