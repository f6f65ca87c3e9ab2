"""How sure a thin line in the air is a wire: the share of right ones among its like."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.methods.road.logistic import chance_of_logit
from processing.methods.road.wires.solid_cells import SolidCells
from processing.methods.road.wires.spans import WireSpan

_LONGEST_M = 16.0
"""A longer one is no surer: railings, gutters and edges of roofs are seldom so long."""

_ROUGH_M = 0.01
"""Noise of wires: half a cable's thickness and the scanner's own."""

_STIFF_M = 0.01
"""Sag below which a thing may be stiff: a straight pipe as it is measured."""

_MOST_BEND = 0.02
"""1/m; half the second derivative of a service drop of 8 m that sags by 0.3 m."""


_STEP_M = 0.25
"""Between places that are asked whether something solid is beside them."""


class WireFacts(NamedTuple):
    """What speaks for a wire and against one; bounded, so that none outweighs all others.

    Attributes
    ----------
    long : float
        Its length, logarithm to the base 2, 0 to 4.
    hangs : float
        Its sag over what a stiff thing may seem to have, 0 to 3.
    bulges : float
        The same of what bends upwards, 0 to 3: ridges and branches.
    rough : float
        How far its points lie off it over 1 cm, 0 to 3.
    dense : float
        Points in a metre, logarithm to the base 10, 0 to 2.
    sharp : float
        How much more it bends than wires do, 0 to 1.
    walled : float
        The share of it that is beside something solid, 0 to 1: edges of roofs, rows of walls.
    """

    long: float
    hangs: float
    bulges: float
    rough: float
    dense: float
    sharp: float
    walled: float


# Learnt by `processing.laboratory.road_training.wire_training` from 2,376 lines, 236 of them wires,
# of its 12 simulated streets, none of the scenes that results are judged by. Left out one street at
# a time, all 202 of those given 0.9 and more were wires, 14 of 16 of those from 0.7, 1 of 12 of
# those from 0.5. On six other streets: 162 of 162, 8 of 9, 3 of 7; by length F 98.2, where the
# weights before with -6 for `walled` reached 97.7.
_CONSTANT = -10.29
_WEIGHTS = WireFacts(
    long=2.77, hangs=0.58, bulges=-1.74, rough=-1.13, dense=4.0, sharp=-2.24, walled=-5.3
)


def facts_of(span: WireSpan, solid: SolidCells) -> WireFacts:
    """The facts of a span among what is solid beside it."""
    sag = span.sag_m / (_STIFF_M + span.noise_m)
    dense = span.lines.size / max(span.long_m, 1.0)
    return WireFacts(
        long=math.log2(min(max(span.long_m, 1.0), _LONGEST_M)),
        hangs=min(max(sag, 0.0), 3.0),
        bulges=min(max(-sag, 0.0), 3.0),
        rough=min(span.noise_m / _ROUGH_M, 3.0),
        dense=min(math.log10(max(dense, 1.0)), 2.0),
        sharp=min(max(abs(float(span.rise[2])) / _MOST_BEND - 1.0, 0.0), 1.0),
        walled=solid.share_beside(span.at(np.arange(span.start_m, span.end_m, _STEP_M))),
    )


def chance_of(facts: WireFacts) -> float:
    """The chance of being a wire, 0 to 1."""
    logit = _CONSTANT + sum(weight * fact for weight, fact in zip(_WEIGHTS, facts, strict=True))
    return chance_of_logit(logit)
