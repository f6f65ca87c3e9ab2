"""A second look at cells under things: their lowest point must fit the open ground beside."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.methods.ground.filters.morphology import fill_heights, steepness_of

_NEAR_CELLS = 2.0
_LOW_M = 0.4
_EARTH_SLOPE = 0.8
_AROUND = 5
_LEAST_M = 0.02
_DEVIATIONS = 3.0
_SLOPE_SHARE = 0.3
_NORMAL = 1.48


def off_neighbours(
    heights: NDArray[np.float32],
    ground: NDArray[np.bool_],
    crowded: NDArray[np.bool_],
    size_m: float,
) -> NDArray[np.bool_]:
    """Ground cells whose lowest point is a low rim, a foot or a ghost: (rows, columns) bool.

    Parameters
    ----------
    heights : (rows, columns) float32
        Lowest heights, m.
    ground : (rows, columns) bool
        Cells held to be ground so far.
    crowded : (rows, columns) bool
        Where points lie above the lowest one, no higher than a person reaches.
    size_m : float
        Side of a cell.

    Notes
    -----
    A crowded cell beside open ground is compared with the surface of the open ground alone. What
    is off by more than that ground's own unevenness, on either side, is none; but not beside a
    step, where the open ground says nothing about the height between.
    """
    import cv2

    free = ground & ~crowded
    if not free.any() or free.all():
        return np.zeros(ground.shape, np.bool_)
    surface = fill_heights(heights, free)
    near = cv2.distanceTransform((~free).astype(np.uint8), cv2.DIST_L2, 5) <= _NEAR_CELLS
    slope = steepness_of(surface, size_m)
    around = np.ones((_AROUND, _AROUND), np.uint8)
    is_earth = cv2.dilate(slope, around) < _EARTH_SLOPE
    uneven = np.abs(cv2.blur(surface, (3, 3)) - surface)[free]
    deviation = _NORMAL * float(np.median(uneven))
    tolerance = _LEAST_M + _DEVIATIONS * deviation + _SLOPE_SHARE * size_m * slope
    off = np.abs(heights - surface)
    found: NDArray[np.bool_] = (
        ground & crowded & near & is_earth & (off > tolerance) & (off < _LOW_M)
    )
    return found
