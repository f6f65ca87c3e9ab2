"""How sure a window of a strip shows a barrier: the share of right ones among its like."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

from processing.methods.road.barriers.barrier_facts import WindowFacts
from processing.methods.road.logistic import chance_of_logit

_LOW_M, _TALL_M, _HIGH_M = 0.7, 1.4, 4.0
"""Tops of rails and fences lie between 0.6 and 1.2 m (防護柵の設置基準, 2021), those of nets and
noise walls up to 4 m; houses are higher."""

_RAILS_ROWS = 0.2
"""From which difference of its layers on a strip is one of rails."""

_THROUGH = 0.25
"""From which share of the ground seen behind it a sheet can be seen through."""

SCREEN_M = 1.6
"""Between the highest parapets, 1.15 m, and the lowest noise walls, 2 m."""

_BATTER = (0.03, 0.07, 0.22)
"""How far faces of concrete barriers lean, m/m: fully from 0.03 to 0.15, not from 0.22."""

BarrierGroup = Literal["rails", "nets", "walls", "screens"]


class ChanceTerms(NamedTuple):
    """Facts as the weights take them.

    Attributes
    ----------
    short, tall, high : float
        How far the top lies below 0.7 m, over 0.4 m, above 1.4 m, m, and above 4 m, m, each at most
        1.
    batter : float
        1 for a face that leans as concrete barriers do, by 2 to 8°; 0 for upright ones and banks.
    """

    short: float
    tall: float
    high: float
    batter: float
    full: float
    even: float
    over: float
    fill: float
    low: float
    rows: float
    rough: float
    lean: float
    toe: float
    through: float
    free: float
    hidden: float
    rise: float
    across: float
    far: float
    long: float


# Learnt by `processing.laboratory.road_training.barrier_training`.
_WEIGHTS: Mapping[BarrierGroup, tuple[float, ChanceTerms]] = {
    "rails": (
        -5.12,
        ChanceTerms(
            short=-2.35, tall=-3.36, high=-4.41, batter=0.58, full=3.27, even=2.01, over=0.0,
            fill=2.15, low=-0.35, rows=4.76, rough=-1.32, lean=-2.84, toe=0.85, through=0.0,
            free=-1.65, hidden=-0.57, rise=-1.64, across=-6.01, far=-1.64, long=3.04,
        ),
    ),
    "nets": (
        -5.33,
        ChanceTerms(
            short=-3.97, tall=-2.16, high=-2.88, batter=0.0, full=2.74, even=1.25, over=-1.63,
            fill=0.0, low=0.64, rows=3.26, rough=-0.71, lean=-10.36, toe=0.0, through=2.54,
            free=0.0, hidden=0.0, rise=-2.47, across=-6.51, far=0.0, long=0.97,
        ),
    ),
    "walls": (
        -3.16,
        ChanceTerms(
            short=-0.14, tall=-16.85, high=-2.00, batter=1.59, full=0.0, even=0.0, over=-0.90,
            fill=1.64, low=0.0, rows=4.63, rough=-1.97, lean=0.0, toe=0.30, through=2.48,
            free=-1.83, hidden=-2.28, rise=-1.03, across=-4.20, far=0.0, long=2.48,
        ),
    ),
    "screens": (
        -3.84,
        ChanceTerms(
            short=-2.00, tall=2.07, high=-7.27, batter=0.0, full=1.30, even=0.0, over=-5.05,
            fill=0.0, low=0.0, rows=0.55, rough=-6.04, lean=-12.55, toe=0.0, through=0.0,
            free=-4.09, hidden=2.73, rise=-0.57, across=-3.96, far=0.0, long=1.91,
        ),
    ),
}  # fmt: skip


def terms_of(facts: WindowFacts) -> ChanceTerms:
    """Facts as the weights take them."""
    return ChanceTerms(
        min(max(_LOW_M - facts.top, 0.0) / 0.4, 1.0),
        min(max(facts.top - _TALL_M, 0.0), 1.0),
        min(max(facts.top - _HIGH_M, 0.0), 1.0),
        min(facts.lean / _BATTER[0], 1.0, max((_BATTER[2] - facts.lean) / _BATTER[1], 0.0)),
        *facts[1:],
    )


def group_of(facts: WindowFacts) -> BarrierGroup:
    """Whether layers differ as those of rails; else it is a sheet, seen through or not."""
    if facts.rows >= _RAILS_ROWS:
        return "rails"
    if facts.through >= _THROUGH:
        return "nets"
    return "screens" if facts.top > SCREEN_M else "walls"


def chance_of(facts: WindowFacts) -> float:
    """The chance of being a barrier, 0 to 1."""
    constant, weights = _WEIGHTS[group_of(facts)]
    terms = terms_of(facts)
    return chance_of_logit(constant + sum(a * b for a, b in zip(weights, terms, strict=True)))
