"""The column ``judged``: what a run did with each point, where the truth is known."""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

ERROR_MAP = "judged"
"""The column's name."""


class ErrorMapValue(IntEnum):
    """What became of a point."""

    UNKNOWN = 0
    """Nobody knows what it is."""
    RIGHTLY_KEPT = 1
    RIGHTLY_REMOVED = 2
    WRONGLY_REMOVED = 3
    WRONGLY_KEPT = 4


def map_errors(
    is_known: NDArray[np.bool_], should_go: NDArray[np.bool_], has_gone: NDArray[np.bool_]
) -> NDArray[np.uint8]:
    """Judge points: (n,) uint8 of `ErrorMapValue` for (n,) bool each."""
    kept = np.where(should_go, ErrorMapValue.WRONGLY_KEPT, ErrorMapValue.RIGHTLY_KEPT)
    gone = np.where(should_go, ErrorMapValue.RIGHTLY_REMOVED, ErrorMapValue.WRONGLY_REMOVED)
    found = np.where(has_gone, gone, kept)
    return np.where(is_known, found, ErrorMapValue.UNKNOWN).astype(np.uint8)
