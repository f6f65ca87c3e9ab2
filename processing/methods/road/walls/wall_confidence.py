"""How sure a face is one of a wall or a building: the share of right ones among its like."""

from __future__ import annotations

import math
from typing import NamedTuple

from processing.methods.road.logistic import chance_of_logit
from processing.methods.road.walls.wall_cells import LOWEST_M
from processing.methods.road.walls.wall_lines import HOUSE_M, WallLine

_LONGEST_M, _HIGHEST_M = 16.0, 3.2
_SOLID = (0.5, 0.9)
_RAISED_M = 0.5
_WAY_M = 6.0
_ROUGH, _LEAST_NOISE_M, _LEAN = 5.0, 0.001, 0.2


class WallFacts(NamedTuple):
    """What speaks for a wall and against one; bounded, so that none outweighs all others.

    Attributes
    ----------
    long : float
        Length of its faces, logarithm to the base 2 of metres, −1 to 4.
    high : float
        From its lowest to its highest point, logarithm to the base 2 of metres, −2 to 1.7.
    raised : float
        How far its lowest point lies over where faces begin, over half a metre,
        0 to 1: balconies, vehicles.
    airy : float
        How few of its points were measured just after another one on it, from 0 at nine in ten to 1
        at the half: fences and plants. 0 where it is as high as a ground floor, since far
        buildings show few points that follow each other, too.
    near : float
        Share of the points about it that are as near as frames of windows: leaves are not.
    filled : float
        Share of it that holds points.
    open : float
        Share of it behind which the ground is seen.
    rough : float
        How far points lie off it, over five times that of the recording's flattest faces, 0 to 1.
    leaning, over : float
        How far it leans either way, and towards the vehicle, over 0.2, 0 to 1: sides of vehicles.
    aside : float
        How far it lies from the vehicle's way, over 6 m, 0 to 1; 1 without a trajectory.
    """

    long: float
    high: float
    raised: float
    airy: float
    near: float
    filled: float
    open: float
    rough: float
    leaning: float
    over: float
    aside: float


# Learnt by `processing.laboratory.road_training.wall_training` from 948 faces of twelve simulated
# streets of five scanners. Left out one street at a time, 196 of 202 of those given 0.9 and more
# were walls or buildings, 72 of 101 of those from 0.5, 30 of 645 of those below; on four others
# 50 of 51, 24 of 35 and 11 of 185.
_CONSTANT = -9.01
_WEIGHTS = WallFacts(
    long=0.5, high=1.37, raised=-2.78, airy=-2.95, near=7.63, filled=2.56,
    open=-3.07, rough=-5.54, leaning=-1.7, over=-3.37, aside=1.94,
)  # fmt: skip


def facts_of(line: WallLine, aside_m: float, flat_m: float) -> WallFacts:
    """The facts of a line.

    Parameters
    ----------
    aside_m : float
        How far it lies from the vehicle's way; infinite without a trajectory.
    flat_m : float
        How far points lie off the recording's flattest faces.
    """
    face = line.face
    solid = min(max((face.solid - _SOLID[0]) / (_SOLID[1] - _SOLID[0]), 0.0), 1.0)
    high = min(max(face.top_m - face.low_m, 0.25), _HIGHEST_M)
    return WallFacts(
        long=math.log2(min(max(line.seen_m, 0.5), _LONGEST_M)),
        high=math.log2(high),
        raised=min(max(face.low_m - 2 * LOWEST_M, 0.0) / _RAISED_M, 1.0),
        airy=1.0 - solid if face.top_m < HOUSE_M else 0.0,
        near=face.near,
        filled=face.filled,
        open=face.is_open,
        rough=min(face.noise_m / max(flat_m, _LEAST_NOISE_M) / _ROUGH, 1.0),
        leaning=min(abs(face.lean) / _LEAN, 1.0),
        over=min(max(-face.lean, 0.0) / _LEAN, 1.0),
        aside=min(aside_m / _WAY_M, 1.0),
    )


def chance_of(facts: WallFacts) -> float:
    """The chance of being a wall or a face of a building, 0 to 1."""
    logit = _CONSTANT + sum(weight * fact for weight, fact in zip(_WEIGHTS, facts, strict=True))
    return chance_of_logit(logit)
