"""How sure a line is the edge of the carriageway: the share of right ones among its like."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.methods.road.edges.edge_lines import CarriagewayLine
from processing.methods.road.logistic import chance_of_logit

_LONGEST_M = 32.0
_STEADY_M = 0.1


class EdgeLineFacts(NamedTuple):
    """What speaks for a line and against it; bounded, so that none outweighs all others.

    Attributes
    ----------
    long : float
        Its length, logarithm to the base 2 of metres, −1 to 5.
    told : float
        Share of its stations that tell it.
    sure : float
        Mean chance of its stations.
    restless : float
        How far it moves aside from station to station otherwise than it did before, over a
        decimetre, 0 to 1.
    unlike, uneven : float
        How far brightness and roughness inside differ from the lane's.
    fleeting : float
        How much of its change in brightness is gone farther out.
    rough : float
        How much rougher it is outside.
    """

    long: float
    told: float
    sure: float
    restless: float
    unlike: float
    uneven: float
    fleeting: float
    rough: float


# Learnt by `processing.laboratory.road_training.edge_training`.
_CONSTANT = -8.16
_WEIGHTS = EdgeLineFacts(
    long=0.43, told=1.36, sure=7.90, restless=-2.41, unlike=-0.67, uneven=-1.85, fleeting=-0.45,
    rough=0.53,
)  # fmt: skip


def facts_of(line: CarriagewayLine) -> EdgeLineFacts:
    """The facts of a line."""
    from processing.methods.road.edges.edge_facts import EdgeFacts

    means = EdgeFacts(*line.facts.tolist())
    turns = np.abs(np.diff(line.away_m, 2)) if len(line.away_m) > 2 else np.zeros(1)
    return EdgeLineFacts(
        long=math.log2(min(max(line.length_m, 0.5), _LONGEST_M)),
        told=float(line.told.mean()),
        sure=float(line.chances.mean()),
        restless=min(float(turns.mean()) / _STEADY_M, 1.0),
        unlike=means.unlike,
        uneven=means.uneven,
        fleeting=means.fleeting,
        rough=means.far_rough,
    )


def chance_of(facts: EdgeLineFacts) -> float:
    """The chance of being the edge of the carriageway, 0 to 1."""
    logit = _CONSTANT + sum(weight * fact for weight, fact in zip(_WEIGHTS, facts, strict=True))
    return chance_of_logit(logit)
