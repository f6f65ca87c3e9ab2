"""Plates that were found twice, and parts of larger ones: what is left is one of each."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.methods.road.signs.plates import Plate

_ONE_PLATE_M = 0.2
"""Centres of two plates are farther apart: half of the smallest plate."""

_OPPOSED, _POST_BETWEEN_M = 0.7, 0.05
"""Plates that look away from each other, by more than 135°, and are farther apart than the drift of
passes hang on two sides of a post (60 mm and more)."""

_ON_RIM_M = 0.05
"""Middles of plates that hang beside a larger one lie outside of its rim, less its uncertainty."""


_DIGITS = 1
"""Of chances that differ: what lies nearer together is as sure, and the plate that was met by more
points tells more of it than a piece that happened to lie in a plane of its own."""


def distinct_plates(plates: Sequence[Plate], chances: Floats, likely: float) -> list[int]:
    """Numbers of the plates that are left, the surest one first.

    Parameters
    ----------
    chances : (n,) float64
        Of being a sign.
    likely : float
        Chance from which a plate is large for those that lie on it.
    """
    if not plates:
        return []
    centres = np.array([one.centre for one in plates])
    tree = cKDTree(centres)
    points = np.array([one.evidence.points for one in plates])
    order = np.lexsort([-points, -np.round(chances, _DIGITS)]).tolist()
    gone = np.zeros(len(plates), np.bool_)
    for number in order:
        if not gone[number]:
            near = tree.query_ball_point(centres[number], _ONE_PLATE_M)
            same = [one for one in near if not _are_back_to_back(plates[number], plates[one])]
            gone[[one for one in same if one != number]] = True
    for number in order:
        if chances[number] >= likely and not gone[number]:
            gone[_parts_of(number, plates, tree)] = True
    return [number for number in order if not gone[number]]


def _parts_of(whole: int, plates: Sequence[Plate], tree: cKDTree) -> NDArray[np.int64]:
    """Plates that lie on a larger one that was met by more points."""
    plate = plates[whole]
    half = np.array([plate.shape.wide_m, plate.shape.high_m]) / 2
    found = []
    for number in tree.query_ball_point(plate.centre, float(np.hypot(*half))):
        other = plates[number]
        off = np.abs(_offset(plate, other))
        is_on = (off[:2] < half - _ON_RIM_M).all() and off[2] <= _POST_BETWEEN_M
        if number != whole and is_on and other.evidence.points < plate.evidence.points:
            found.append(number)
    return np.array(found, np.int64)


def _offset(plate: Plate, other: Plate) -> Floats:
    """(3,) right, up and before a plate's centre, where another one's is, m."""
    normal = plate.normal
    right = np.array([-normal[1], normal[0], 0.0]) / max(float(np.hypot(*normal[:2])), 1e-9)
    away = other.centre - plate.centre
    return np.array([away @ right, away @ np.cross(normal, right), away @ normal])


def _are_back_to_back(plate: Plate, other: Plate) -> bool:
    """Whether two plates look away from each other with their post between them."""
    off = abs(float((other.centre - plate.centre) @ plate.normal))
    return bool(plate.normal @ other.normal < -_OPPOSED and off > _POST_BETWEEN_M)
