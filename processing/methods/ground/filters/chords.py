"""Cells of a sparse cloud against straight lines through their neighbours, on any slope.

Openings look at heights alone: on a steep slope a shrub is no higher than the ground a cell
farther up, and the crest of a terrace sticks out as a thing does. Lines through neighbours follow
the slope.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.methods.ground.filters.morphology import fill_heights, steepness_of

_DIRECTIONS = ((0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1))
"""From a cell to its neighbours: rows north, columns east; the first four and their opposites."""

_ROUNDS = 2
"""The second sees cells beside those that the first changed: a shrub or a crest two cells wide.
What is wider is a matter of whole regions."""

_EVEN_M = 0.05
"""Unevenness of bare ground that says nothing: clods and tufts, ``GroundAssumptions.rise_m``."""

_DEVIATIONS = 2.0
"""Of the open ground's own unevenness; 95 % of what is scattered normally lies within."""

_WITHIN_CELLS = 0.41
"""Of a cell's rise: two points anywhere in two cells are 0.41 sides (1 / √6) nearer or farther than
the cells' centres, in the standard deviation."""

_SIGMA_PER_MEDIAN = 1.48
"""Standard deviation of a normal distribution over its median absolute deviation (1.4826)."""

_SUPPORTS = 2
"""Lines that a cell must carry on: one may meet a roof's eaves by chance. With three, crests of
terraces on simulated quarries stayed lost, and on no scene was it better."""


def single_bumps(
    heights: NDArray[np.float32], ground: NDArray[np.bool_], size_m: float
) -> NDArray[np.bool_]:
    """Ground cells that lie above every line between opposite neighbours: (rows, columns) bool.

    Parameters
    ----------
    heights : (rows, columns) float32
        Lowest heights, m.
    ground : (rows, columns) bool
        Cells held to be ground so far; one at least.
    size_m : float
        Side of a cell.

    Notes
    -----
    A ridge and a crest lie on the lines along them. How far above counts as a bump is measured:
    the same height over all ground cells, and the rise that the points' places within their cells
    account for on the steepest slope near by.
    """
    import cv2

    found = np.zeros(ground.shape, np.bool_)
    for _ in range(_ROUNDS):
        left = ground & ~found
        surface = fill_heights(heights, left)
        wide = np.pad(surface, 1, mode="reflect", reflect_type="odd")
        above = np.full(surface.shape, np.inf, np.float32)
        for down, right in _DIRECTIONS[: len(_DIRECTIONS) // 2]:
            chord = (_shifted(wide, 1, down, right) + _shifted(wide, 1, -down, -right)) / 2
            above = np.minimum(above, surface - chord)
        deviation = _SIGMA_PER_MEDIAN * float(np.median(np.abs(above[left])))
        steepest = cv2.dilate(steepness_of(surface, size_m), np.ones((3, 3), np.uint8))
        tolerance = _EVEN_M + _DEVIATIONS * deviation + _WITHIN_CELLS * size_m * steepest
        new = left & (above > tolerance)
        if not new.any() or np.array_equal(new, left):
            break
        found |= new
    return found


def carried_on(
    heights: NDArray[np.float32], ground: NDArray[np.bool_], tolerance_m: float
) -> NDArray[np.bool_]:
    """Ground cells, and those that carry on lines through two ground cells beside.

    Parameters
    ----------
    heights, ground
        As for :func:`single_bumps`; heights are not finite where nothing was measured.
    tolerance_m : float
        How far off such a line a cell may lie.
    """
    joined = ground.copy()
    wide = np.pad(heights, 2, constant_values=np.nan)
    for _ in range(_ROUNDS):
        known = np.where(np.pad(joined, 2), wide, np.float32(np.nan))
        supports = np.zeros(ground.shape, np.uint8)
        for down, right in _DIRECTIONS:
            near, far = (_shifted(known, 2, step * down, step * right) for step in (1, 2))
            with np.errstate(invalid="ignore"):
                supports += np.abs(2 * near - far - heights) <= tolerance_m
        new = ~joined & (supports >= _SUPPORTS)
        if not new.any():
            break
        joined |= new
    return joined


def _shifted(wide: NDArray[np.float32], margin: int, down: int, right: int) -> NDArray[np.float32]:
    """The heights so many cells north and east of every cell, of a grid with a margin."""
    rows, columns = wide.shape
    return wide[margin + down : rows - margin + down, margin + right : columns - margin + right]
