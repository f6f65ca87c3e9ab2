"""How sure something really hangs over the road: the share of right ones among its like."""

from __future__ import annotations

import math
from typing import NamedTuple

from processing.methods.road.logistic import chance_of_logit

_MOST_POINTS, _MOST_DENSE = 10.0, 5.0
_DEEP_M, _UNDER_M = 1.0, 0.5
_LOW_M, _LOW_SPAN_M = 1.8, 0.8


class ClearanceFacts(NamedTuple):
    """What speaks for it and against it; each from 0 to 1.

    Attributes
    ----------
    points : float
        Logarithm to the base 2 of its points, over 10.
    dense : float
        The same of its points in a cube of 0.3 m, over 5: drops fill many cubes once.
    deep : float
        How far it reaches inside the edge, over a metre.
    under : float
        How far it hangs below the limit, over half a metre.
    low : float
        How far its lowest point lies below 1.8 m, over 0.8 m: upper parts of people and vehicles
        whose lower parts are hidden.
    walk : float
        1 over a walk, whose ends are told less surely.
    unseen : float
        1 where no edge was seen on its side of the road.
    """

    points: float
    dense: float
    deep: float
    under: float
    low: float
    walk: float
    unseen: float


# Learnt by `processing.laboratory.road_training.clearance_training` from 35 places over the
# carriageways of fourteen simulated streets of five scanners, 29 of which were right: few, so that
# the weights stay near to what reasoning expects. Left out one street at a time, 7 of 10 of those
# given 0.9 and more were right, 13 of 16 from 0.7, 9 of 9 from 0.5; on four others all 7. That over
# walks isn't learnt, since no truth knows them.
_CONSTANT = -1.26
_WEIGHTS = ClearanceFacts(
    points=1.06, dense=2.59, deep=0.05, under=0.14, low=-1.99, walk=-0.25, unseen=-1.5
)


def facts_of(
    counts: tuple[int, int],
    heights: tuple[float, float],
    depth_m: float,
    *,
    is_walk: bool,
    is_seen: bool,
) -> ClearanceFacts:
    """The facts of a place.

    Parameters
    ----------
    counts : (int, int)
        Points, and cubes of 0.3 m that they fill.
    heights : (float, float)
        Its lowest over the road, and the limit, m.
    depth_m : float
        How far it reaches inside the edge.
    """
    points, voxels = counts
    lowest, limit = heights
    return ClearanceFacts(
        points=min(math.log2(max(points, 1)) / _MOST_POINTS, 1.0),
        dense=min(max(math.log2(max(points, 1) / max(voxels, 1)), 0.0) / _MOST_DENSE, 1.0),
        deep=min(max(depth_m, 0.0) / _DEEP_M, 1.0),
        under=min(max(limit - lowest, 0.0) / _UNDER_M, 1.0),
        low=min(max((_LOW_M - lowest) / _LOW_SPAN_M, 0.0), 1.0),
        walk=float(is_walk),
        unseen=float(not is_seen),
    )


def chance_of(facts: ClearanceFacts) -> float:
    """The chance that something hangs there, 0 to 1."""
    logit = _CONSTANT + sum(weight * fact for weight, fact in zip(_WEIGHTS, facts, strict=True))
    return chance_of_logit(logit)
