"""How sure a line is the edge of the carriageway: the share of right ones among its like."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.methods.road.edges.edge_facts import EdgeFacts
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
    sure : float
        Mean chance of its stations.
    restless : float
        How far it moves aside from station to station otherwise than it did before, over a
        decimetre, 0 to 1.
    unlike, uneven : float
        How far brightness and roughness inside differ from the lane's.
    rough : float
        How much rougher it is outside.
    """

    long: float
    sure: float
    restless: float
    unlike: float
    uneven: float
    rough: float


# Learnt by `processing.laboratory.road_training.edge_training` from 547 lines of 59 simulated
# streets of five scanners. Left out one street at a time, 108 of 115 of those given 0.9 and more
# were edges, 125 of 165 of those from 0.5, 59 of 267 of those below.
_CONSTANT = -6.88
_WEIGHTS = EdgeLineFacts(
    long=0.70, sure=7.19, restless=-6.13, unlike=-0.20, uneven=-0.08, rough=0.72,
)  # fmt: skip


def facts_of(line: CarriagewayLine) -> EdgeLineFacts:
    """The facts of a line."""
    means = EdgeFacts(*line.facts.tolist())
    turns = np.abs(np.diff(line.away_m, 2)) if len(line.away_m) > 2 else np.zeros(1)
    return EdgeLineFacts(
        long=math.log2(min(max(line.length_m, 0.5), _LONGEST_M)),
        sure=float(line.chances.mean()),
        restless=min(float(turns.mean()) / _STEADY_M, 1.0),
        unlike=means.unlike,
        uneven=means.uneven,
        rough=means.far_rough,
    )


def chance_of(facts: EdgeLineFacts) -> float:
    """The chance of being the edge of the carriageway, 0 to 1."""
    logit = _CONSTANT + sum(weight * fact for weight, fact in zip(_WEIGHTS, facts, strict=True))
    return chance_of_logit(logit)
