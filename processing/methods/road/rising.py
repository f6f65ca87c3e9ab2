"""Places along a line, in rising order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def nearest_rising(at: NDArray[np.float64], positions: NDArray[np.float64]) -> NDArray[np.int64]:
    """(k,) index of the value nearest to each of (k,) places, among (n,) rising ones, n > 0."""
    after = np.clip(np.searchsorted(at, positions), 1, max(1, at.size - 1))
    after = np.minimum(after, at.size - 1)
    before = np.maximum(after - 1, 0)
    is_before = np.abs(positions - at[before]) <= np.abs(at[after] - positions)
    return np.where(is_before, before, after)
