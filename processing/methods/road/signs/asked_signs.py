"""Which of the plates that were found are those that somebody gave rough positions of."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from processing.core.arrays import Floats
from processing.methods.road.signs.initial_positions import FARTHEST_M, InitialPosition
from processing.methods.road.signs.road_signs import RoadSign, SoughtShapes
from processing.methods.road.signs.sign_shapes import (
    RECTANGLE,
    SignShape,
    looked_for,
    shape_of,
    standard_shapes,
)

_OFF_M = 1.0
"""Standard deviation of a given position, of easting and of northing: errors are anywhere up to 2 m
(Takahashi 2022, 8.3), those of a disc have half of its radius."""

_OFF_HEIGHT_M = 0.5
"""The same of heights: a camera sees them better than the distance."""

_OTHER_SYSTEM_M = 3.0
"""Heights that are farther off are of another reference (ellipsoid and geoid lie decametres apart),
or wrong: they tell plates on one post apart no longer."""

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


_CUT_OUT_M = 3.0
"""About a position, plates are looked at (Takahashi 2022, 8.3)."""

_SAME_PLATE_M = 0.15
"""Between the middles of outlines that are laid on one plate: less than half of the smallest."""


def asked_signs(
    signs: Sequence[RoadSign], positions: Sequence[InitialPosition]
) -> dict[int, RoadSign]:
    """The plate of each position, by the position's number; those that have none are not in it.

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
    return {
        int(row): replace(likely[column], confidence=_with_word(likely[column].confidence))
        for row, column in zip(rows, columns, strict=True)
        if np.isfinite(costs[row, column])
    }


def with_other_heights(
    found: Mapping[int, RoadSign], positions: Sequence[InitialPosition]
) -> tuple[int, ...]:
    """Lines of the positions whose given height can't be that of the plate found."""
    return tuple(
        positions[number].line
        for number, one in sorted(found.items())
        if abs(_higher_m(one, positions[number])) > _OTHER_SYSTEM_M
    )


def doubtful_numbers(
    found: Mapping[int, RoadSign], positions: Sequence[InitialPosition]
) -> tuple[int, ...]:
    """The positions whose given shape or size isn't that of the plate found, or that have none."""
    return tuple(
        number
        for number, one in enumerate(positions)
        if one.shape and (number not in found or not _is_as_given(found[number], one))
    )


def with_given_shapes(
    found: Mapping[int, RoadSign],
    again: Sequence[RoadSign],
    positions: Sequence[InitialPosition],
    doubtful: Sequence[int],
) -> dict[int, RoadSign]:
    """The plates of positions, the doubtful ones replaced by those that are as was given.

    What points speak against clearly is not taken on somebody's word.

    Parameters
    ----------
    again : sequence of RoadSign
        What is found where nothing but the given shapes is looked for (:func:`sought_about`).
    """
    sure = {number: one for number, one in found.items() if number not in doubtful}
    free = [
        one
        for one in again
        if all(np.linalg.norm(one.centre - own.centre) > _SAME_PLATE_M for own in sure.values())
    ]
    asked = [positions[number] for number in doubtful]
    better = {
        doubtful[row]: one
        for row, one in asked_signs(free, asked).items()
        if _is_as_given(one, asked[row]) and _is_allowed(one, found.get(doubtful[row]))
    }
    return {**found, **better}


def sought_about(
    place: Floats, positions: Sequence[InitialPosition], doubtful: Sequence[int]
) -> SoughtShapes | None:
    """What plates about a place look like by what is given of the positions about it.

    None where no doubtful position is near.
    """
    if not is_about(place, [positions[number] for number in doubtful]):
        return None
    near = [one for one in positions if is_about(place, [one])]
    if not all(one.shape for one in near):
        return SoughtShapes(looked_for())
    shapes = dict.fromkeys(shape for one in near for shape in _given_shapes(one))
    return SoughtShapes(tuple(shapes), any(one.shape == RECTANGLE for one in near))


def _is_allowed(given: RoadSign, free: RoadSign | None) -> bool:
    """Whether the points say no more against a given shape than somebody's word is worth."""
    if free is None:
        return True
    one, other = given.plate.evidence, free.plate.evidence
    return (one.cost - other.cost) * max(one.open_ends, other.open_ends) <= _OTHER_SHAPE


def _given_shapes(position: InitialPosition) -> tuple[SignShape, ...]:
    """The templates of what is given; none of a rectangle, whose sides follow from the points."""
    if position.shape == RECTANGLE:
        return ()
    of_shape = tuple(one for one in standard_shapes() if one.shape == position.shape)
    if math.isnan(position.size_m):
        return of_shape
    of_size = tuple(one for one in of_shape if _is_size(one, position))
    return of_size or (shape_of(position.shape, position.size_m),)


def _is_as_given(sign: RoadSign, position: InitialPosition) -> bool:
    shape = sign.plate.shape
    if position.shape and position.shape != shape.shape:
        return False
    return math.isnan(position.size_m) or _is_size(shape, position)


def _is_size(shape: SignShape, position: InitialPosition) -> bool:
    return abs(shape.size_m / position.size_m - 1) <= _SIZE_SHARE


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
        higher = min(abs(_higher_m(sign, position)), _OTHER_SYSTEM_M)
        cost += (higher / _OFF_HEIGHT_M) ** 2
    shape = sign.plate.shape
    if sign.is_supplement and not position.shape:
        cost += _SUPPLEMENT
    if position.shape and position.shape != shape.shape:
        cost += _OTHER_SHAPE
    if not math.isnan(position.size_m) and not _is_size(shape, position):
        cost += _OTHER_SHAPE
    return cost


def _higher_m(sign: RoadSign, position: InitialPosition) -> float:
    """How much higher a plate's middle is than was given; NaN where no height was."""
    return float(sign.centre[2]) - position.height_m


def is_about(place: Floats, positions: Sequence[InitialPosition]) -> bool:
    """Whether plates about a place (m, project CRS) may be those of a position."""
    reach_m = _CUT_OUT_M + FARTHEST_M
    return any(
        math.hypot(place[0] - one.easting_m, place[1] - one.northing_m) <= reach_m
        for one in positions
    )
