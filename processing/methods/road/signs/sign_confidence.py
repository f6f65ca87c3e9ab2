"""How sure a plate is a road sign: the share of right ones among its like."""

from __future__ import annotations

import math
from typing import NamedTuple

from processing.methods.road.signs.plates import Plate
from processing.methods.road.signs.sign_shapes import RECTANGLE

_MOST_LOGIT = 30.0
"""Guard of the exponential."""

_LOW_EDGE_M = 1.6
"""Lower edges of signs hang higher (道路標識設置基準 2-2: 1.8 m), those of machines and boards on the
ground lower."""

_FULL_TURNS = 12
"""Scan lines beyond which a plate is no better known."""

_FULL_NOISE_M = 0.01
_LARGE_M = 1.0


class SignFacts(NamedTuple):
    """What speaks for a sign and against one; bounded, so that none outweighs all others.

    Attributes
    ----------
    bright : float
        Share of its points that shine on the side where more do.
    cost : float
        Mean of what the ends of its lines say against it, over their most: 0 to 1.
    explained : float
        Share of what lies in its plane that plates explain.
    sectors : float
        Share of the directions about its middle in which its rim was seen.
    turns : float
        Logarithm of the scan lines on it, over that of 12: 0 to 1.
    open_ends : float
        Share of its lines' ends at which it was seen to end.
    noise : float
        How far points lie off it, 1 for 1 cm.
    low : float
        How far its lower edge is below 1.6 m above the ground, m, 0 to 1.
    askew : float
        Roll and tilt, 1 for ten degrees together.
    is_plain : float
        1 of a rectangle that is dull: boards, windows and walls look alike.
    is_large : float
        Of such a one, how far its longer side is above a metre, 0 to 1.
    """

    bright: float
    cost: float
    explained: float
    sectors: float
    turns: float
    open_ends: float
    noise: float
    low: float
    askew: float
    is_plain: float
    is_large: float


# Set by trial before the first fit.
_CONSTANT = -5.0
_WEIGHTS = SignFacts(6.0, -6.0, 3.0, 4.0, 2.0, 2.0, -2.0, -4.0, -2.0, -2.0, -1.0)


def facts_of(plate: Plate, ground_m: float) -> SignFacts:
    """The facts of a plate.

    Parameters
    ----------
    ground_m : float
        Height of the ground below it, about the same origin.
    """
    one = plate.evidence
    edge = float(plate.outline[:, 2].min()) - ground_m
    is_plain = plate.shape.shape == RECTANGLE and one.bright < 0.5
    longer = max(plate.shape.wide_m, plate.shape.high_m)
    return SignFacts(
        bright=one.bright,
        cost=min(one.cost / 4.0, 1.0),
        explained=max(0.0, one.explained),
        sectors=one.sectors,
        turns=min(math.log(max(one.turns, 1)) / math.log(_FULL_TURNS), 1.0),
        open_ends=min(one.open_ends / (2.0 * len(plate.pieces)), 1.0),
        noise=min(one.noise_m / _FULL_NOISE_M, 1.0),
        low=min(max(_LOW_EDGE_M - edge, 0.0), 1.0),
        askew=min((abs(math.degrees(one.roll_rad)) + abs(math.degrees(one.tilt))) / 10.0, 1.0),
        is_plain=float(is_plain),
        is_large=min(max(longer - _LARGE_M, 0.0), 1.0) * is_plain,
    )


def chance_of(facts: SignFacts) -> float:
    """The chance of being a sign, 0 to 1."""
    logit = _CONSTANT + sum(weight * fact for weight, fact in zip(_WEIGHTS, facts, strict=True))
    return 1 / (1 + math.exp(-max(-_MOST_LOGIT, min(_MOST_LOGIT, logit))))
