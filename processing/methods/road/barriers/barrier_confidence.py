"""How sure a window of a strip shows a barrier: the share of right ones among its like."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple

from processing.methods.road.barriers.barrier_facts import WindowFacts
from processing.methods.road.logistic import chance_of_logit

_LOW_M, _TALL_M, _HIGH_M = 0.7, 1.4, 4.0
"""Tops of rails and fences lie between 0.6 and 1.2 m (防護柵の設置基準, 2021), those of nets and
noise walls up to 4 m; houses are higher."""

_RAILS_ROWS = 0.2
"""From which difference of its layers on a strip is one of rails."""

LEANING = 0.02
"""From which a low sheet leans as concrete barriers do, and banks, hedges and vehicles."""

_THROUGH = 0.15
"""From which share of the ground seen behind it a sheet can be seen through."""

SCREEN_M = 1.6
"""Between the highest parapets, 1.15 m, and the lowest noise walls, 2 m."""

_BATTER = (0.03, 0.07, 0.22)
"""How far faces of concrete barriers lean, m/m: fully from 0.03 to 0.15, not from 0.22."""

BarrierGroup = Literal["rails", "leaning", "nets", "walls", "screens"]


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
    banked: float
    across: float
    far: float
    long: float


# Learnt as `processing.laboratory.road_training.barrier_training` learns, from 22,303 windows of 38
# simulated streets of five scanners. On five others 392 of 399 windows of rails given 0.9 and more
# were right, 58 of 117 of those from 0.5; of leaning sheets 77 of 109 from 0.5, of nets 5 of 14.
_WEIGHTS: Mapping[BarrierGroup, tuple[float, ChanceTerms]] = {
    "rails": (
        -6.72,
        ChanceTerms(
            short=-5.00, tall=-3.63, high=-5.02, batter=0.59, clean=0.06, full=3.29, even=2.79,
            over=-1.10, fill=1.51, low=-0.26, rows=6.51, rough=-0.20, lean=-4.17, toe=0.0,
            through=0.30, free=-1.86, hidden=-1.13, roofed=0.0, rise=-0.75, banked=-2.80,
            across=-7.61, far=-1.11, long=4.38,
        ),
    ),
    "leaning": (
        -2.70,
        ChanceTerms(
            short=-2.56, tall=-16.85, high=-2.00, batter=0.82, clean=1.02, full=1.53, even=0.0,
            over=-0.43, fill=0.0, low=0.0, rows=3.62, rough=-0.01, lean=-0.73, toe=0.0,
            through=0.0, free=0.0, hidden=-2.51, roofed=-0.96, rise=0.0, banked=-2.10,
            across=-6.59, far=-0.36, long=1.71,
        ),
    ),
    "nets": (
        -6.00,
        ChanceTerms(
            short=-5.74, tall=-2.32, high=-4.29, batter=0.0, clean=2.21, full=2.59, even=0.0,
            over=-1.87, fill=0.0, low=0.95, rows=3.45, rough=-2.36, lean=-11.64, toe=0.0,
            through=3.48, free=-1.70, hidden=0.0, roofed=0.0, rise=0.0, banked=-1.13,
            across=-4.02, far=0.0, long=1.42,
        ),
    ),
    "walls": (
        -4.63,
        ChanceTerms(
            short=-2.11, tall=-1.42, high=-2.00, batter=2.33, clean=0.0, full=0.0, even=0.32,
            over=0.0, fill=0.0, low=0.0, rows=2.30, rough=-2.40, lean=-1.94, toe=0.14,
            through=5.22, free=-1.23, hidden=-0.65, roofed=-0.70, rise=-2.11, banked=0.0,
            across=-2.76, far=0.0, long=4.71,
        ),
    ),
    "screens": (
        -5.64,
        ChanceTerms(
            short=-2.00, tall=4.16, high=-7.56, batter=0.0, clean=0.0, full=0.07, even=0.0,
            over=-2.81, fill=1.29, low=0.0, rows=0.71, rough=-8.75, lean=-9.26, toe=0.0,
            through=0.0, free=-1.96, hidden=2.88, roofed=-3.63, rise=-0.99, banked=-4.13,
            across=-4.92, far=-0.45, long=4.09,
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
    """Whether layers differ as those of rails; else it is a sheet of one of four sorts."""
    if facts.rows >= _RAILS_ROWS:
        return "rails"
    if facts.lean > LEANING and facts.top <= SCREEN_M:
        return "leaning"
    if facts.through >= _THROUGH:
        return "nets"
    return "screens" if facts.top > SCREEN_M else "walls"


def chance_of(facts: WindowFacts) -> float:
    """The chance of being a barrier, 0 to 1."""
    constant, weights = _WEIGHTS[group_of(facts)]
    terms = terms_of(facts)
    return chance_of_logit(constant + sum(a * b for a, b in zip(weights, terms, strict=True)))


class StretchTerms(NamedTuple):
    """What speaks for a whole stretch.

    Attributes
    ----------
    logit : float
        Of the mean chance of its windows, −5 to 6.
    long : float
        Its length, m, logarithm to the base 2, of 1.5 to 48 m.
    """

    logit: float
    long: float


# Learnt by the same command from 226 stretches of 43 streets; 107 of 111 of those given 0.9 and
# more by weights fitted without their street were right, 35 of 43 from 0.7, 16 of 30 from 0.5.
_STRETCH_CONSTANT = -1.75
_STRETCH = StretchTerms(logit=1.88, long=0.37)


def stretch_terms_of(chance: float, long_m: float) -> StretchTerms:
    """Facts of a stretch as the weights take them, from its windows' mean chance and its length."""
    sure = min(max(chance, 1e-3), 1.0 - 1e-3)
    logit = min(max(math.log(sure / (1.0 - sure)), -5.0), 6.0)
    return StretchTerms(logit, math.log2(min(max(long_m, 1.5), 48.0)))


def stretch_chance_of(chance: float, long_m: float) -> float:
    """The chance of a whole stretch of being a barrier, 0 to 1."""
    terms = stretch_terms_of(chance, long_m)
    return chance_of_logit(
        _STRETCH_CONSTANT + sum(a * b for a, b in zip(_STRETCH, terms, strict=True))
    )


def likeliest(options: Sequence[WindowFacts]) -> tuple[WindowFacts, float]:
    """The likeliest of several facts of one place, and its chance."""
    chances = [chance_of(one) for one in options]
    best = max(range(len(options)), key=chances.__getitem__)
    return options[best], chances[best]
