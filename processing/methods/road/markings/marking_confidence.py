"""How sure a marking is one: the share of right ones among its like."""

from __future__ import annotations

import math
from typing import NamedTuple

from processing.methods.road.logistic import chance_of_logit
from processing.methods.road.markings.marking_lines import MarkingLine

_LONGEST_M = 32.0
_STEP_M = 0.04
"""What rises more between a marking and the vehicle's way is a curb; lower ones may be worn."""

_USUAL_WIDE_M = (0.08, 0.5)
"""Markings are 10 to 45 cm wide, and seen a little narrower or wider."""


class MarkingFacts(NamedTuple):
    """What speaks for a marking and against one; bounded, so that none outweighs all others.

    Attributes
    ----------
    bright : float
        Its paint over the usual, 0 to 1.
    dim : float
        How painted the road beside it seems over its own paint, 0 to 1: gutters, walks.
    seen : float
        Share of its length at which both edges were measured.
    long : float
        Its painted length, logarithm to the base 2, 0 to 5.
    rough : float
        Spread of its widths over the width, 0 to 0.5.
    odd : float
        How far its width is from those of markings, logarithm to the base 2, 0 to 1.
    raised : float
        The step between it and the vehicle's way over that of a worn curb, 0 to 2.
    fellows : float
        How many dashes or bars it has with others, logarithm to the base 2, 0 to 3.
    across : float
        1 for a stop line.
    """

    bright: float
    dim: float
    seen: float
    long: float
    rough: float
    odd: float
    raised: float
    fellows: float
    across: float


# Learnt by `processing.laboratory.road_training.marking_training` from 96 strokes, 62 of them
# markings, of five simulated streets of five scanners. Left out one street at a time, all 40 of
# those given 0.9 and more were markings, 17 of 24 of those from 0.5, 5 of 32 of those below.
_CONSTANT = -5.86
_WEIGHTS = MarkingFacts(
    bright=6.1, dim=-4.28, seen=3.67, long=0.15, rough=-2.36, odd=-2.0, raised=-0.69,
    fellows=0.49, across=-0.33,
)  # fmt: skip


def facts_of(marking: MarkingLine, step_m: float) -> MarkingFacts:
    """The facts of a marking.

    Parameters
    ----------
    step_m : float
        The highest step between it and the vehicle's way; NaN where nothing tells.
    """
    paint, wide = marking.mean_of("paint"), marking.width_m
    odd = max(math.log2(_USUAL_WIDE_M[0] / wide), math.log2(wide / _USUAL_WIDE_M[1]), 0.0)
    return MarkingFacts(
        bright=min(paint, 1.0),
        dim=min(marking.mean_of("beside") / max(paint, 0.01), 1.0),
        seen=marking.mean_of("seen_share"),
        long=math.log2(min(max(marking.painted_m, 1.0), _LONGEST_M)),
        rough=min(marking.mean_of("width_spread_m") / wide, 0.5),
        odd=min(odd, 1.0),
        raised=min(step_m / _STEP_M, 2.0) if math.isfinite(step_m) else 0.0,
        fellows=math.log2(min(marking.fellows, 8)),
        across=float(marking.type == "stop_line"),
    )


def chance_of(facts: MarkingFacts) -> float:
    """The chance of being a marking, 0 to 1."""
    logit = _CONSTANT + sum(weight * fact for weight, fact in zip(_WEIGHTS, facts, strict=True))
    return chance_of_logit(logit)
