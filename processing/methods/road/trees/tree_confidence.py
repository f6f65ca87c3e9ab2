"""How sure a trunk with what stands on it is a tree: the share of right ones among its like."""

from __future__ import annotations

import math
from typing import NamedTuple

from processing.methods.road.logistic import chance_of_logit
from processing.methods.road.trees.cone_kernels import EVEN_NOISE_M
from processing.methods.road.trees.crowns import Crown, UprightTrunk

_MOST_GAP_M = 1.5
"""A wider gap between stem and crown tells no more: another thing's crown hangs over a post."""

_USUAL_M = 0.4
"""Diameter up to which trunks of street trees are common; thicker ones have to be rounder."""

_MOST_SEEN_M = 2.0
"""A longer piece of a stem is no surer."""

_SUITS = 0.3
"""Of the radius of a neighbour's crown: what would put that so far aside is no part of it."""

_MOST_RISE_M = 4.0
"""A post that goes on so far is one; tall ones are no surer."""

_THINS = 0.08
"""Of the radius in a metre of height: a trunk of 12 m is gone at its top; concrete poles lose half
as much (JIS A 5373: 1 : 75 of the diameter), steel ones mostly less."""

_SLENDER = 50.0
"""Height over diameter of trees that stand in the open (Wang, Titus, LeMay 1998, Canadian Journal
of Forest Research 28: those beyond 100 are blown over)."""

_MOST_CORE = 3.0
"""Powers of two; more is no surer."""

_MOST_LEAN_DEG = 6.0
"""Posts that were run into lean more."""

_HALF = 0.5
"""Of its circumference one scanner sees of any round thing; a second head shows no better what it
is."""

# Learnt by `python -m processing.laboratory.road_training.tree_training` from 1,482 upright things,
# 182 of them trees, on avenues of seeds 600 to 615 and worn streets of seeds 540 to 551. Left out
# one street at a time, 99 % of 110 given 0.9 and more were trees, 87 % of 30 from 0.7, 69 % of 32
# from 0.5, 41 % of 27 from 0.3, 8 % of 61 from 0.1, 1 % of 1,222 below. Posts among the likely ones
# are mostly lamps and poles that end within a crown; shrubs with stems of a metre are next.
WEIGHTS = (
    *(-5.75, 1.86, -7.72, -3.34, -2.91, -3.93, 2.09, 1.18, -3.68),
    *(1.33, -3.38, -0.68, 0.27, 0.22),
)
"""A constant, and in the order of the facts."""


class TreeFacts(NamedTuple):
    """What speaks for a tree and against one; bounded, so that none outweighs all others.

    Attributes
    ----------
    filled : float
        Decimal logarithm of the cells that twigs fill, and one.
    flat : float
        Share of the cells about the axis that are planes or lines: walls, signs, arms.
    aside : float
        How far the crown's middle lies from the axis, over half its width, 0 to 1.
    gap_m : float
        Between the stem and the crown, m, 0 to 1.5.
    thick_m : float
        Diameter beyond 0.4 m: pieces of walls and vehicles are wide.
    arc : float
        Share of the circumference that was seen, up to a half.
    seen_m : float
        Of the stem, 0 to 2 m.
    loose : float
        How far points lie off the stem over how far they would with no surface there, cubed:
        whatever the noise of the scanner, 0.1 or less of a surface.
    rival : float
        How ill its crown would suit a neighbour's trunk, −1 to 1 for 0.3 of a radius.
    stout_m : float
        How far the stem goes on straight and round within its crown without growing thinner, 0 to
        4 m; half of it for poles of concrete. Trunks fork, bend and thin there, posts don't.
    slender : float
        Height over diameter beyond 50, over 50: trees that stand by themselves are stouter.
    core : float
        How much denser points lie about its axis above than beside it, as a power of two, −3 to 3.
    lean_deg : float
        From the vertical, up to 6: posts are set plumb, trunks seldom grow so.
    """

    filled: float
    flat: float
    aside: float
    gap_m: float
    thick_m: float
    arc: float
    seen_m: float
    loose: float
    rival: float
    stout_m: float
    slender: float
    core: float
    lean_deg: float


def facts_of(upright: UprightTrunk, crown: Crown) -> TreeFacts:
    """The facts of a trunk and what stands on it."""
    stem = upright.trunk.stems[0]
    begins = crown.lowest_m if math.isfinite(crown.lowest_m) else upright.rise.high_m
    into = max(0.0, min(upright.rise.high_m - max(begins, stem.high_m), _MOST_RISE_M))
    return TreeFacts(
        filled=math.log10(1 + crown.cells),
        flat=crown.flat_share,
        aside=min(crown.aside, 1.0),
        gap_m=min(crown.gap_m, _MOST_GAP_M),
        thick_m=max(0.0, 2 * stem.radius_m - _USUAL_M),
        arc=min(stem.arc, _HALF),
        seen_m=min(stem.high_m - stem.low_m, _MOST_SEEN_M),
        loose=min(stem.noise_m / EVEN_NOISE_M, 1.0) ** 3,
        rival=max(-1.0, min(crown.rival / _SUITS, 1.0)),
        stout_m=into * max(0.0, 1.0 - max(0.0, upright.rise.thins) / _THINS),
        slender=max(0.0, crown.height_m / upright.trunk.diameter_m / _SLENDER - 1.0),
        core=max(-_MOST_CORE, min(upright.rise.core, _MOST_CORE)),
        lean_deg=min(upright.trunk.lean_deg, _MOST_LEAN_DEG),
    )


def chance_of(facts: TreeFacts) -> float:
    """The chance of being a tree, 0 to 1."""
    logit = sum(weight * fact for weight, fact in zip(WEIGHTS, (1.0, *facts), strict=True))
    return chance_of_logit(logit)
