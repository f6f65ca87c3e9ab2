"""The column ``judged``: what a run did with each point, where the truth is known."""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

JUDGED = "judged"
"""The column's name."""


class Judgement(IntEnum):
    """What became of a point."""

    UNKNOWN = 0
    """Nobody knows what it is."""
    RIGHTLY_KEPT = 1
    RIGHTLY_REMOVED = 2
    WRONGLY_REMOVED = 3
    WRONGLY_KEPT = 4


def judged(
    is_known: NDArray[np.bool_], should_go: NDArray[np.bool_], has_gone: NDArray[np.bool_]
) -> NDArray[np.uint8]:
    """Judge points: (n,) uint8 of `Judgement` for (n,) bool each."""
    kept = np.where(should_go, Judgement.WRONGLY_KEPT, Judgement.RIGHTLY_KEPT)
    gone = np.where(should_go, Judgement.RIGHTLY_REMOVED, Judgement.WRONGLY_REMOVED)
    found = np.where(has_gone, gone, kept)
    return np.where(is_known, found, Judgement.UNKNOWN).astype(np.uint8)
