"""Where something solid is: walls, roofs and dense leaves, which scan lines cross in long runs.

A wire has air about it; the edge of a roof, a gutter or a row of a scanned wall has not.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel

_CELL_M = 0.3
"""Cells of space; a cell and its neighbours tell of what is 0.3 to 0.6 m away: less than wires are
from the walls they pass (有線電気通信設備令施行規則 第9条: 0.3 m)."""

_HALF = 1 << 20
"""Cells to either side of the origin that a key can tell: 300 km."""


class SolidCells:
    """Cells of space that solid things fill.

    Parameters
    ----------
    keys : sequence of (n,) int64
        As :func:`solid_keys` told them.
    """

    def __init__(self, keys: Sequence[Integers]) -> None:
        self._keys = np.unique(np.concatenate([np.empty(0, np.int64), *keys]))

    def share_beside(self, places: Floats) -> float:
        """The share of places that are beside something solid.

        Parameters
        ----------
        places : (n, 3) float64
            m about the plan's origin.
        """
        if not len(places) or not self._keys.size:
            return 0.0
        home = np.floor(places / _CELL_M).astype(np.int64) + _HALF
        is_beside = np.zeros(len(places), np.bool_)
        for step in np.ndindex(3, 3, 3):
            keys = _keys_of(home + np.array(step) - 1)
            at = np.minimum(np.searchsorted(self._keys, keys), self._keys.size - 1)
            is_beside |= self._keys[at] == keys
        return float(is_beside.mean())


def solid_keys(local: Floats, is_solid: NDArray[np.bool_]) -> Integers:
    """Keys of the cells that solid points of a stretch fill.

    Parameters
    ----------
    local : (n, 3) float64
        m about the plan's origin.
    is_solid : (n,) bool
    """
    keys = np.empty(len(local), np.int64)
    return np.unique(keys[: _keys_kernel(local, is_solid, 1.0 / _CELL_M, keys)])


def _keys_of(cells: Integers) -> Integers:
    return np.asarray((cells[:, 0] << 42) | (cells[:, 1] << 21) | cells[:, 2])


@kernel
def _keys_kernel(local: Floats, is_solid: Flags, scale: float, keys: Integers) -> int:
    """Write the cell of each solid point that is in another one than the point before; how many."""
    count, last = 0, np.int64(-1)
    for point in range(len(local)):
        if not is_solid[point]:
            continue
        key = np.int64(0)
        for axis in range(3):
            key = (key << 21) | (np.int64(np.floor(local[point, axis] * scale)) + (1 << 20))
        if key != last:
            keys[count] = last = key
            count += 1
    return count
