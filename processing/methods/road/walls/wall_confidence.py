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
_ROUGH, _LEAST_NOISE_M, _LEAN = 3.0, 0.001, 0.2


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
    solid : float
        Share of its points that were measured just after another one on it, from 0 at the half
        to 1 at nine in ten: not of fences, plants.
    airy : float
        How little solid it is, where it is lower than a ground floor: far buildings show few points
        that follow each other, too.
    near : float
        Share of the points about it that are as near as frames of windows: leaves are not.
    filled : float
        Share of it that holds points.
    open : float
        Share of it behind which the ground is seen.
    rough : float
        How far points lie off it, over three times that of the recording's flattest faces, 0 to 1.
    leaning, over : float
        How far it leans either way, and towards the vehicle, over 0.2, 0 to 1: sides of vehicles.
    aside : float
        How far it lies from the vehicle's way, over 6 m, 0 to 1; 1 without a trajectory.
    """

    long: float
    high: float
    raised: float
    solid: float
    airy: float
    near: float
    filled: float
    open: float
    rough: float
    leaning: float
    over: float
    aside: float


# Learnt by `processing.laboratory.road_training.wall_training` from 999 faces of twelve simulated
# streets of five scanners. Left out one street at a time, 197 of 203 of those given 0.9 and more
# were walls or buildings, 71 of 99 of those from 0.5, 35 of 697 of those below; on four others
# 41 of 42, 35 of 46 and 12 of 190.
_CONSTANT = -8.11
_WEIGHTS = WallFacts(
    long=0.48, high=1.35, raised=-3.17, solid=0.26, airy=-2.72, near=6.62, filled=2.24,
    open=-3.01, rough=-3.55, leaning=-1.77, over=-3.26, aside=2.16,
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
        solid=solid,
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
