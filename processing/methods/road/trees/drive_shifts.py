"""Points about a stem with each drive laid onto the others.

Positions of two passes differ by centimetres, those of two heads by what their mounting is off. A
circle through both is then too thick, too thin, or none.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.methods.road.trees.cone_kernels import CAPTURED_M, apart_kernel, shift_kernel
from processing.methods.road.trees.stem_bodies import BREAST_M, SHAPE_M
from processing.methods.road.trees.stems import FittedStem, stems_of

_FARTHEST_M, _ASKED, _THICKEST_M = 0.15, 400, 1.5
"""How far aside passes may lie where satellites are hidden, points that are asked for it, and the
thickest stem that one drive shows.
"""

_FEWEST = 20
"""Points of a drive on a stem that tell where it lies."""

_NEARER = 1.15
"""So many times as much has to lie on the stem with the shifts as without them: a shift always
brings some nearer, since bark isn't quite round."""


_AGREE, _SURELY, _LEAST_ERROR_M = 3, 3.0, 0.001
"""Stems that have to agree on how drives lie apart; over how many standard errors they have to; and
the least such error: three that agree by chance within a millimetre are no surer."""

_NONE_M = 0.003
"""Standard error of what stems agree on, below which they agree that there is no shift."""

_SPREAD, _MEDIAN = 1.4826, 1.2533
"""Standard deviation over the median distance from the median, and of a median over that of a
mean; of what is distributed normally."""


class JoinedPoints(NamedTuple):
    """Points with those of each drive laid onto the others'.

    Attributes
    ----------
    shifts : dict of int to (2,) float64
        How far each drive lies aside of the one with the most points there, m east and north; empty
        where fewer than two drives have points on the stem.
    points : (n, 3) float64 or None
        None where these points alone don't show that drives lie apart.
    """

    shifts: dict[int, Floats]
    points: Floats | None

    @property
    def is_told(self) -> bool:
        """Whether two drives and more have points on the stem."""
        return len(self.shifts) > 1


def agreed_shifts(own: JoinedPoints, near: Sequence[JoinedPoints]) -> dict[int, Floats]:
    """How far drives lie aside where a stem and those near it agree; empty where they don't.

    Zero where they agree that a drive doesn't.

    One trunk doesn't tell a shift of a centimetre from bark that isn't round; several do, since
    bark is out of round in another direction on each.

    Parameters
    ----------
    own : JoinedPoints
        Of the stem.
    near : sequence of JoinedPoints
        Of the nearest ones, itself included.
    """
    first = next((drive for drive, shift in own.shifts.items() if not shift.any()), None)
    agreed: dict[int, Floats] = {}
    for drive in own.shifts:
        both = [one.shifts for one in near if {drive, first} <= one.shifts.keys()]
        if first is None or drive == first or len(both) < _AGREE:
            continue
        apart = np.array([one[drive] - one[first] for one in both])
        middle: Floats = np.median(apart, axis=0)
        spread = _SPREAD * np.median(np.abs(apart - middle), axis=0)
        error = float(np.hypot(*spread)) * _MEDIAN / math.sqrt(len(both))
        if np.hypot(*middle) > _SURELY * max(error, _LEAST_ERROR_M):
            agreed[drive] = middle
        elif error < _NONE_M:
            agreed[drive] = np.zeros(2)
    return agreed


def laid_by(points: Floats, drives: Integers, shifts: Mapping[int, Floats]) -> Floats:
    """Points with those of some drives moved back by how far they lie aside: (n, 3) float64."""
    moved: Floats = points.copy()
    for drive, shift in shifts.items():
        moved[drives == drive, :2] -= shift
    return moved


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
        return JoinedPoints({}, None)
    about = _points_on(points, stem, CAPTURED_M)
    counts = np.bincount(group[about], minlength=known.size)
    first = int(counts.argmax())
    if counts[first] < _FEWEST:
        return JoinedPoints({}, None)
    own = _as_one_shows(points[group == first], stem)
    about = _points_on(points, own, _FARTHEST_M)
    is_told = np.bincount(group[about], minlength=known.size) >= _FEWEST
    is_told[first] = False
    if not is_told.any():
        return JoinedPoints({}, None)
    local = points[about] - (0.0, 0.0, BREAST_M)
    shifts = np.zeros((known.size, 2))
    for one in np.flatnonzero(is_told):
        mine = local[group[about] == one]
        shift_kernel(mine[:: len(mine) // _ASKED + 1], own.body, _FARTHEST_M, shifts[one])
    unmoved = np.full(known.size, -1, np.int64), np.zeros_like(shifts)
    numbers = np.where(is_told, np.cumsum(is_told) - 1, -1)
    before = apart_kernel(local, (group[about], unmoved[0]), SHAPE_M, stem.body, unmoved[1])
    after = apart_kernel(local, (group[about], numbers), SHAPE_M, own.body, shifts)
    if np.hypot(*shifts.T).max() > _FARTHEST_M:
        return JoinedPoints({}, None)
    is_told[first] = True
    told = {int(known[one]): shifts[one] for one in np.flatnonzero(is_told)}
    is_clear = after >= _NEARER * before
    return JoinedPoints(told, laid_by(points, drives, told) if is_clear else None)


def _as_one_shows(points: Floats, stem: FittedStem) -> FittedStem:
    """A stem as the points of one drive show it; as told where they show none there."""

    def away(one: FittedStem) -> float:
        return float(np.hypot(*(one.middle_at(BREAST_M) - stem.middle_at(BREAST_M))))

    near = [one for one in stems_of(points, _THICKEST_M) if away(one) < _FARTHEST_M]
    return max(near, key=lambda one: one.lines.size, default=stem)


def _points_on(points: Floats, stem: FittedStem, off_m: float) -> Integers:
    """Points near its surface."""
    about = np.flatnonzero((points[:, 2] >= stem.low_m) & (points[:, 2] <= stem.high_m))
    up = points[about, 2] - BREAST_M
    beside = points[about, :2] - stem.axis_at(points[about, 2])
    away = np.hypot(beside[:, 0], beside[:, 1]) - stem.radius_m + stem.taper * up
    near: Integers = about[np.abs(away) <= off_m]
    return near
