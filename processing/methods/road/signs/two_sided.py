"""Boards both of whose sides were found, each as a plate of its own: neither shines, no sign is so.

Sides of a plate that lie in one plane are one group (:mod:`.plate_groups`); those of boxes and of
boards on frames lie centimetres apart.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from processing.methods.road.signs.brightness import SHINING
from processing.methods.road.signs.plates import Plate

_THICKEST_M = 0.2
"""Of a board on its frame, with the drift between passes: boxes that are lit from inside."""

_OPPOSED = -np.cos(np.radians(12.0))
"""Normals of the two sides of a board, which are flat and parallel."""

_FARTHEST_M = 1.5
"""Between the middles of two sides that were seen in part each."""


def with_other_side(plates: Sequence[Plate]) -> list[int | None]:
    """For each plate the number of the one that is its other side; None: there is none.

    Two signs back to back on one post have a face each, and faces shine; of such a pair neither is
    the other's back.
    """
    if not plates:
        return []
    tree = cKDTree(np.array([one.centre for one in plates]))
    found: list[int | None] = []
    for plate in plates:
        near = tree.query_ball_point(plate.centre, _FARTHEST_M)
        others = [number for number in near if _is_other_side(plate, plates[number])]
        found.append(max(others, key=lambda number: plates[number].evidence.points, default=None))
    return found


def _is_other_side(plate: Plate, other: Plate) -> bool:
    if plate.normal @ other.normal > _OPPOSED or _shines(plate) or _shines(other):
        return False
    right = np.array([-plate.normal[1], plate.normal[0], 0.0])
    right /= max(float(np.linalg.norm(right)), 1e-9)
    away = other.centre - plate.centre
    if abs(away @ plate.normal) > _THICKEST_M:
        return False
    level = abs(float(away @ right)), abs(float(away @ np.cross(plate.normal, right)))
    halves = (
        (plate.shape.wide_m + other.shape.wide_m) / 2,
        (plate.shape.high_m + other.shape.high_m) / 2,
    )
    return level[0] < halves[0] and level[1] < halves[1]


def _shines(plate: Plate) -> bool:
    return plate.evidence.shine >= SHINING
