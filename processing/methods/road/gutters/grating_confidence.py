"""How sure a grating is: the share of such rectangles that is expected to be one."""

from __future__ import annotations

import math
from typing import NamedTuple

from processing.methods.road.gutters.grating_facts import GratingFacts

# Bounds of facts, so that none outweighs all others, and the units in which logarithms are taken;
# set before the weights were fitted.

_DEEP_M, _DEEPEST_M, _FLATTEST_M = 0.02, 0.10, 0.01
"""Unit of depths, and their bounds: rough asphalt is less deep than the unit, bars are 5 to 10 cm
high, and 1 cm is the least that counts as open (z_t of Takahashi 2022, Table 7-3)."""

_LITTLE = 0.02
"""Share of a surface, added to both of a ratio, so that nearly none against none says nothing."""

_MOST_ROWS, _MOST_RAISED_M = 30.0, 0.3
"""More rows of a slow vehicle say no more, nor does what is raised higher than a hedge's foot."""

_MOST_OPEN, _MOST_PART = 0.8, 0.6
"""Share that bars leave open; of one of nine parts, which fewer rows cross."""


class GratingTerms(NamedTuple):
    """Facts as the weights take them. They are bounded, so that none outweighs all others.

    Attributes
    ----------
    open : float
        Share of the rectangle that is open, 0 to 0.8.
    depth : float
        Logarithm of the depth by 2 cm, that of 1 to 10 cm: rough asphalt is open, but not deep.
    least_part : float
        Share that is open of its closed parts, 0 to 0.6: what is open here and there is none.
    contrast : float
        Logarithm of how much more of it than of the road around is open.
    rows : float
        Logarithm of how many revolutions show it, up to 30.
    raised_m : float
        How far it lies higher than roads and walks do, m, 0 to 0.3: hedges are open all over.
    """

    open: float
    depth: float
    least_part: float
    contrast: float
    rows: float
    raised_m: float


WEIGHTS = GratingTerms(
    open=2.19,
    depth=0.10,
    least_part=6.96,
    contrast=1.78,
    rows=1.43,
    raised_m=-11.40,
)
"""What each fact is worth: see `processing.laboratory.road_training.gutter_training`, which also
says how reliable they are, and `gutter_confidence` for the streets. Of those learnt from, left out
one by one, 50 of 50 rectangles given 0.9 and more were gratings, 8 of 14 of those from 0.5 and 4 of
52 of those below; of twelve others 26 of 26, 9 of 10 and 3 of 81; of another simulator's 6 of 6,
9 of 9 and none of 8."""

CONSTANT = -10.73
"""Log-odds of a rectangle of which nothing is known; fitted with `WEIGHTS`."""


def terms_of(facts: GratingFacts) -> GratingTerms:
    """The facts as the weights take them."""
    depth = min(max(facts.depth_m, _FLATTEST_M), _DEEPEST_M)
    return GratingTerms(
        min(facts.open_share, _MOST_OPEN),
        math.log(depth / _DEEP_M),
        min(facts.least_part, _MOST_PART),
        math.log((facts.open_share + _LITTLE) / (facts.about + _LITTLE)),
        math.log(min(max(facts.rows, 1), _MOST_ROWS)),
        min(facts.raised_m, _MOST_RAISED_M),
    )


def grating_chance(facts: GratingFacts) -> float:
    """The chance that a rectangle is a grating, 0 to 1.

    References
    ----------
    Hosmer, Lemeshow: Applied Logistic Regression (the model).
    """
    logit = CONSTANT + sum(w * term for w, term in zip(WEIGHTS, terms_of(facts), strict=True))
    return 1.0 / (1.0 + math.exp(-logit))
