"""Points under the ground: multipath and ghosts that a lowest point must not rest on.

Where a constant says “by trial”, no measurement varied it alone: docs/accuracy.md judges all values
together, on simulated earthwork sites and on airborne samples of the ISPRS filter test.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.methods.ground.filters.cells import LevelsAboveFloor
from processing.methods.ground.filters.morphology import fill_heights, nearest_known
from processing.methods.ground.filters.openings import open_heights
from processing.methods.ground.filters.regions import FreeCells, rim_shares

_SUNK_FLANK, _SUNK_M = 0.3, 0.06
"""A hollow is looked at where it is deeper than this share of its half width and this depth more;
by trial, above the roughness of graded ground and the rise within a cell on usual slopes."""

_ABOVE_PER_NEAR = 3
"""Points above for each near the lowest, from which the lower ones are the strays; by trial."""

_LEAST_ABOVE = 3
"""Points above that make a ground of their own; by trial, so that no single stray does."""

_MEDIAN_CELLS = 5
"""Side of the window of the median around a cell: two cells to every side outweigh a stray cell
and its neighbours. OpenCV takes 3 or 5 for heights in single precision."""

_WIDEST_SUNK_M = 6.0
"""Width up to which hollows are looked at, by trial: ghosts lie below what mirrors them, as a wet
spot or a machine; wider hollows are pits."""

_TWO_LEVELS_SHARE = 0.4
"""Share of a hollow's cells with points clearly above the lowest from which it is a ghost; by
trial. A true pit has nothing above its bottom."""

_FEWEST_CELLS = 2
"""Hollows of so few cells are ghosts without that: a share says nothing there."""

_FALL_SLOPE, _FALL_SHARE = 0.3, 0.6
"""Slope (17°) by which a ghost's rim falls, and share of its rim that does; by trial."""


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
    ghost = (with_second >= _TWO_LEVELS_SHARE * np.maximum(cells, 1)) | (cells <= _FEWEST_CELLS)
    ghost[0] = False
    fall = np.full(ground.shape, _FALL_SLOPE, np.float32)
    falls = rim_shares(sunk, -heights, FreeCells(ground, nearest_known(ground)), size_m, fall)
    found: NDArray[np.bool_] = ghost[labels] & ground & falls.at_least(_FALL_SHARE)
    return found


def sunk_points(levels: LevelsAboveFloor, size_m: float) -> NDArray[np.bool_]:
    """Cells whose lowest points are few, lie clearly under the median around, and many above."""
    import cv2

    known = np.isfinite(levels.lowest)
    median = cv2.medianBlur(fill_heights(levels.lowest, known), _MEDIAN_CELLS)
    deep = median - levels.lowest > _SUNK_FLANK * size_m + _SUNK_M
    few = levels.near * _ABOVE_PER_NEAR <= levels.above
    return known & deep & few & (levels.above >= _LEAST_ABOVE)
