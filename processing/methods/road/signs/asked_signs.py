"""Which of the plates that were found are those that somebody gave rough positions of."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from processing.core.arrays import Floats
from processing.methods.road.signs.initial_positions import FARTHEST_M, InitialPosition
from processing.methods.road.signs.road_signs import RoadSign

_OFF_M = 1.0
"""Standard deviation of a given position, of easting and of northing: errors are anywhere up to 2 m
(Takahashi 2022, 8.3), those of a disc have half of its radius."""

_OFF_HEIGHT_M = 0.5
"""The same of heights: a camera sees them better than the distance."""

_OTHER_SHAPE = 12.0
"""What a plate of another shape than the given one, or another size, costs: as a position that is
three and a half standard deviations off."""

_SUPPLEMENT = 6.0
"""What a plate that hangs below another one costs where its shape wasn't given: positions are given
of signs."""

_SIZE_SHARE = 0.15
"""Sizes are the same so near: standard ones differ by a third."""

_KNOWN_LOGIT = 3.0
"""By how much somebody's word that a sign is here makes a plate surer: among plates that aren't
signs one in twenty lies by chance within 2 m of one."""

_LEAST_CHANCE = 0.2
"""Of what is taken for an asked sign, with that word: what is less likely is rather nothing."""


def asked_signs(
    signs: Sequence[RoadSign], positions: Sequence[InitialPosition]
) -> tuple[tuple[RoadSign, ...], tuple[InitialPosition, ...]]:
    """The plate of each position, and the positions that have none.

    Each plate is of one position at most; all are assigned together, so that two signs on one post
    with a position each get one each.
    """
    likely = [one for one in signs if _with_word(one.confidence) >= _LEAST_CHANCE]
    costs = np.full((len(positions), len(likely)), np.inf)
    for row, position in enumerate(positions):
        for column, sign in enumerate(likely):
            costs[row, column] = _cost(sign, position)
    from scipy.optimize import linear_sum_assignment  # a fifth of a second to load

    rows, columns = linear_sum_assignment(np.where(np.isfinite(costs), costs, 1e6))
    found: dict[int, RoadSign] = {
        int(row): replace(likely[column], confidence=_with_word(likely[column].confidence))
        for row, column in zip(rows, columns, strict=True)
        if np.isfinite(costs[row, column])
    }
    missed = tuple(one for row, one in enumerate(positions) if row not in found)
    return tuple(found[row] for row in sorted(found)), missed


def _with_word(chance: float) -> float:
    odds = chance / max(1.0 - chance, 1e-12) * math.exp(_KNOWN_LOGIT)
    return odds / (1.0 + odds)


def _cost(sign: RoadSign, position: InitialPosition) -> float:
    """Twice the negative logarithm of how likely a plate is the asked one; infinite: too far.

    Of plates about a position each is asked for in so far as it is a sign without anybody's word.
    """
    off = math.hypot(sign.centre[0] - position.easting_m, sign.centre[1] - position.northing_m)
    if off > FARTHEST_M:
        return math.inf
    cost = (off / _OFF_M) ** 2 - 2 * math.log(max(sign.confidence, 1e-9))
    if not math.isnan(position.height_m):
        cost += ((sign.centre[2] - position.height_m) / _OFF_HEIGHT_M) ** 2
    shape = sign.plate.shape
    if sign.is_supplement and not position.shape:
        cost += _SUPPLEMENT
    if position.shape and position.shape != shape.shape:
        cost += _OTHER_SHAPE
    if not math.isnan(position.size_m) and abs(shape.size_m / position.size_m - 1) > _SIZE_SHARE:
        cost += _OTHER_SHAPE
    return cost


def is_near(middle: Floats, positions: Sequence[InitialPosition], reach_m: float) -> bool:
    """Whether a position lies so near to a place in plan."""
    return any(
        math.hypot(middle[0] - one.easting_m, middle[1] - one.northing_m) <= reach_m
        for one in positions
    )
