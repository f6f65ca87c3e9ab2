"""Places along a line, in rising order."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel


def nearest_rising(at: Floats, positions: Floats) -> Integers:
    """(k,) index of the value nearest to each of (k,) places, among (n,) rising ones, n > 0."""
    found = np.empty(positions.size, np.int64)
    nearest_kernel(np.ascontiguousarray(at), np.ascontiguousarray(positions), found)
    return found


@kernel
def nearest_kernel(at: Floats, positions: Floats, found: Integers) -> None:
    """Write the index of the value nearest to each place; of two as near the first."""
    for one in range(positions.size):
        after = min(max(np.searchsorted(at, positions[one]), 1), max(1, at.size - 1))
        after = min(after, at.size - 1)
        before = max(after - 1, 0)
        is_before = abs(positions[one] - at[before]) <= abs(at[after] - positions[one])
        found[one] = before if is_before else after
