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
    clean : float
        1 for what is whole, even, flat and has nothing above it.
    batter : float
        1 for a face that leans as concrete barriers do, by 2 to 8°; 0 for upright ones and banks.
    """

    short: float
    tall: float
    high: float
    batter: float
    clean: float
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
        -5.87,
        ChanceTerms(
            short=-6.55, tall=-3.40, high=-4.95, batter=0.48, clean=0.31, full=2.85, even=2.49,
            over=-0.79, fill=1.66, low=-0.63, rows=6.55, rough=-0.53, lean=-3.81, toe=0.0,
            through=0.17, free=-3.06, hidden=-1.15, roofed=0.0, rise=-1.17, across=-7.36,
            far=-1.62, long=4.37,
        ),
    ),
    "nets": (
        -3.27,
        ChanceTerms(
            short=-4.73, tall=-2.28, high=-4.73, batter=0.0, clean=2.11, full=1.32, even=0.0,
            over=-1.08, fill=0.0, low=0.15, rows=5.91, rough=0.0, lean=-10.46, toe=0.0,
            through=0.73, free=-0.92, hidden=-0.61, roofed=0.0, rise=-2.58, across=-5.48,
            far=0.0, long=1.84,
        ),
    ),
    "walls": (
        -4.78,
        ChanceTerms(
            short=-3.11, tall=-19.16, high=-2.00, batter=2.33, clean=0.0, full=1.01, even=0.0,
            over=-0.99, fill=0.64, low=0.86, rows=4.12, rough=-3.88, lean=0.0, toe=2.06,
            through=8.73, free=-0.24, hidden=-2.93, roofed=-1.51, rise=-0.40, across=-4.16,
            far=-0.06, long=2.49,
        ),
    ),
    "screens": (
        -5.48,
        ChanceTerms(
            short=-2.00, tall=4.30, high=-7.53, batter=0.0, clean=0.0, full=0.42, even=0.0,
            over=-2.95, fill=0.76, low=0.0, rows=0.54, rough=-8.72, lean=-9.32, toe=0.0,
            through=0.0, free=-2.39, hidden=2.99, roofed=-3.51, rise=-1.53, across=-4.66,
            far=-0.62, long=3.92,
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
        facts.full * facts.even * (1.0 - facts.over) * max(1.0 - facts.rough, 0.0),
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
