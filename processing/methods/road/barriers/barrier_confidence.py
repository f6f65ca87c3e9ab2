"""How sure a window of a strip shows a barrier: the share of right ones among its like."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple

from processing.methods.road.barriers.barrier_facts import WindowFacts
from processing.methods.road.logistic import chance_of_logit

_LOW_M, _TALL_M, _HIGH_M = 0.7, 1.4, 4.0
"""Tops of rails and fences lie between 0.6 and 1.2 m (防護柵の設置基準, 2021), those of nets and
noise walls up to 4 m; houses are higher."""

_RAILS_ROWS = 0.2
"""From which difference of its layers on a strip is one of rails."""

_THROUGH = 0.15
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
    roofed: float
    rise: float
    across: float
    far: float
    long: float


# Learnt by `processing.laboratory.road_training.barrier_training`.
_WEIGHTS: Mapping[BarrierGroup, tuple[float, ChanceTerms]] = {
    "rails": (
        -7.61,
        ChanceTerms(
            short=-5.86, tall=-4.99, high=-4.53, batter=0.28, full=3.72, even=3.49, over=-0.74,
            fill=3.67, low=-0.83, rows=4.26, rough=-0.85, lean=-3.49, toe=0.81, through=0.0,
            free=-2.25, hidden=-0.57, roofed=0.0, rise=-1.68, across=-6.25, far=-1.39, long=4.03,
        ),
    ),
    "nets": (
        -4.70,
        ChanceTerms(
            short=-5.30, tall=-2.11, high=-4.38, batter=0.0, full=2.51, even=0.95, over=-2.40,
            fill=0.0, low=0.0, rows=2.51, rough=-1.16, lean=-13.53, toe=0.0, through=2.85,
            free=-0.18, hidden=0.0, roofed=0.0, rise=-2.35, across=-5.73, far=0.0, long=1.93,
        ),
    ),
    "walls": (
        -5.76,
        ChanceTerms(
            short=-3.69, tall=-17.66, high=-2.00, batter=2.66, full=1.08, even=0.0, over=-1.38,
            fill=1.48, low=0.42, rows=5.03, rough=-0.95, lean=0.0, toe=0.96, through=5.72,
            free=-0.19, hidden=-3.27, roofed=-2.10, rise=-0.09, across=-4.13, far=0.0, long=2.67,
        ),
    ),
    "screens": (
        -4.86,
        ChanceTerms(
            short=-2.00, tall=3.19, high=-7.21, batter=0.0, full=0.66, even=0.11, over=-2.73,
            fill=0.48, low=0.0, rows=1.59, rough=-7.64, lean=-8.56, toe=0.0, through=0.0,
            free=-1.52, hidden=3.34, roofed=-4.11, rise=-1.51, across=-4.59, far=-0.41,
            long=3.25,
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


def likeliest(options: Sequence[WindowFacts]) -> tuple[WindowFacts, float]:
    """The likeliest of several facts of one place, and its chance."""
    chances = [chance_of(one) for one in options]
    best = max(range(len(options)), key=chances.__getitem__)
    return options[best], chances[best]
