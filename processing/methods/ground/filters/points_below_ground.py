"""Points under the ground: multipath and ghosts that a lowest point must not rest on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.methods.ground.filters.cells import LevelsAboveFloor
from processing.methods.ground.filters.morphology import fill_heights, nearest_known
from processing.methods.ground.filters.openings import open_heights
from processing.methods.ground.filters.regions import rim_shares

_SUNK_FLANK = 0.3
_SUNK_M = 0.06
_FEW = 3
_MANY = 3
_WIDEST_SUNK_M = 6.0
_TWO_LEVELS = 0.4
_FALL = 0.3
_FALL_SHARE = 0.6


def ghosts(
    heights: NDArray[np.float32],
    second: NDArray[np.float32],
    ground: NDArray[np.bool_],
    size_m: float,
) -> NDArray[np.bool_]:
    """Cells whose lowest point lies under the ground.

    A hollow is a ghost where most of its cells have points clearly above it and its rim falls
    steeply: a scanner doesn't see through the ground. A true pit has nothing above its bottom.
    """
    import cv2

    surface = fill_heights(heights, ground)
    sunk = np.zeros(ground.shape, np.bool_)
    for radius in range(1, max(2, round(_WIDEST_SUNK_M / 2 / size_m)) + 1):
        closed = -open_heights(-surface, radius)
        sunk |= closed - surface > _SUNK_FLANK * radius * size_m + _SUNK_M
    count, labels = cv2.connectedComponents(sunk.astype(np.uint8), connectivity=8)
    cells = np.bincount(labels[ground], minlength=count)
    with_second = np.bincount(labels[ground & np.isfinite(second)], minlength=count)
    ghost = (with_second >= _TWO_LEVELS * np.maximum(cells, 1)) | (cells <= 2)
    ghost[0] = False
    fall = np.full(ground.shape, _FALL, np.float32)
    falls = rim_shares(sunk, -heights, (ground, nearest_known(ground)), size_m, fall)
    found: NDArray[np.bool_] = ghost[labels] & ground & falls.at_least(_FALL_SHARE)
    return found


def sunk_points(levels: LevelsAboveFloor, size_m: float) -> NDArray[np.bool_]:
    """Cells whose lowest points are few, lie clearly under the median around, and many above."""
    import cv2

    known = np.isfinite(levels.lowest)
    median = cv2.medianBlur(fill_heights(levels.lowest, known), 5)
    deep = median - levels.lowest > _SUNK_FLANK * size_m + _SUNK_M
    few = levels.near * _FEW <= levels.above
    return known & deep & few & (levels.above >= _MANY)
