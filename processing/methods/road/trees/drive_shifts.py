"""Points about a stem with each drive laid onto the others.

Positions of two passes differ by centimetres, those of two heads by what their mounting is off. A
circle through both is then too thick, too thin, or none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.methods.road.trees.cone_kernels import CAPTURED_M, apart_kernel
from processing.methods.road.trees.stems import BREAST_M, SHAPE_M, FittedStem

_FEWEST = 20
"""Points of a drive on a stem that tell where it lies."""

_NEARER = 1.15
"""So many times as much has to lie on the stem with the shifts as without them: a shift always
brings some nearer, since bark isn't quite round."""


class JoinedPoints(NamedTuple):
    """Points with those of each drive laid onto the others'.

    Attributes
    ----------
    is_told : bool
        Whether two drives and more have points on the stem.
    points : (n, 3) float64 or None
        None where drives lie on each other as they are.
    """

    is_told: bool
    points: Floats | None


def without_shifts(points: Floats, drives: Integers, stem: FittedStem) -> JoinedPoints:
    """The points about a foot with those of each drive laid onto the others'.

    Parameters
    ----------
    points : (n, 3) float64
        m about the foot.
    drives : (n,) int64
        Which drive each is of.
    stem : FittedStem
        As all points together, or those of one drive, show it.
    """
    known, group = np.unique(drives, return_inverse=True)
    if known.size < 2:
        return JoinedPoints(is_told=False, points=None)
    about = _points_on(points, stem)
    counts = np.bincount(group[about], minlength=known.size)
    first = int(counts.argmax())
    is_told = counts >= _FEWEST
    is_told[first] = False
    if not is_told.any() or counts[first] < _FEWEST:
        return JoinedPoints(is_told=False, points=None)
    local = points[about] - (0.0, 0.0, BREAST_M)
    start, shifts = stem.body, np.zeros((known.size, 2))
    unmoved = np.full(known.size, -1, np.int64)
    numbers = np.where(is_told, np.cumsum(is_told) - 1, -1)
    before = apart_kernel(local, (group[about], unmoved), SHAPE_M, start.copy(), shifts)
    after = apart_kernel(local, (group[about], numbers), SHAPE_M, start.copy(), shifts)
    if after < _NEARER * before or np.hypot(*shifts.T).max() > CAPTURED_M:
        return JoinedPoints(is_told=True, points=None)
    moved: Floats = points.copy()
    moved[:, :2] -= shifts[group]
    return JoinedPoints(is_told=True, points=moved)


def _points_on(points: Floats, stem: FittedStem) -> Integers:
    """Points near its surface."""
    about = np.flatnonzero((points[:, 2] >= stem.low_m) & (points[:, 2] <= stem.high_m))
    up = points[about, 2] - BREAST_M
    beside = points[about, :2] - stem.middle_at(BREAST_M) - up[:, None] * stem.lean
    away = np.hypot(beside[:, 0], beside[:, 1]) - stem.radius_m + stem.taper * up
    near: Integers = about[np.abs(away) <= CAPTURED_M]
    return near
