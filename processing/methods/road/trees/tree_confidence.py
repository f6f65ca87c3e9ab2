"""How sure a trunk with what stands on it is a tree: the share of right ones among its like."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.methods.noise.tree_files import read_trees
from processing.methods.noise.trees import Trees, log_odds
from processing.methods.road.trees.cone_kernels import EVEN_NOISE_M
from processing.methods.road.trees.crowns import Crown, UprightTrunk
from resources import path_of

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

_LEAST_TAPER, _MOST_TAPER = -0.02, 0.012
"""Of the radius in a metre about the height of the tape: more is no surer. Steel posts have 0,
concrete ones 0.007 (JIS A 5373: 1 : 75 of the diameter)."""

MODEL = "models/uprights/trunk_tree.onnx"


class TreeFacts(NamedTuple):
    """What speaks for a tree and against one; bounded, so that none outweighs all others.

    Sizes are none of them, height, diameter and where the crown begins: those of simulated streets
    made pines of a real stand, slender ones with high crowns, unlikely.

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
    taper : float
        What the stem's radius loses in a metre, −0.02 to 0.012.
    free : float
        Slabs of 0.2 m in which the stem stands free.
    sides : float
        Share of twelve directions in which something of the crown is.
    off_m : float
        How far the middle of the crown's points lies from the axis, m.
    goes_on : float
        Share of the next 2 m above its stem in which its axis shows something: above people and
        posts there is nothing but noise.
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
    taper: float
    free: float
    sides: float
    off_m: float
    goes_on: float


SIGNS = (1, -1, -1, -1, -1, 1, 1, -1, 1, -1, -1, 0, 1, 1, 1, 1, -1, 1)
"""Which facts can only speak for a tree (1) or against one (−1)."""


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
        taper=max(_LEAST_TAPER, min(stem.taper, _MOST_TAPER)),
        free=stem.free_slabs,
        sides=crown.shape.sides,
        off_m=crown.shape.off_m,
        goes_on=upright.rise.goes_on,
    )


def chances_of(facts: Sequence[TreeFacts], monitor: Monitor) -> Floats:
    """The chances of being trees, (n,) float64 of 0 to 1.

    By trees of decisions that `python -m processing.laboratory.road_training.tree_training` learns
    (Friedman 2001, Greedy function approximation: a gradient boosting machine).
    """
    if not facts:
        return np.zeros(0)
    odds = log_odds(_model(), np.array(facts, np.float32), monitor)
    chances: Floats = 1 / (1 + np.exp(-odds))
    return chances


@cache
def _model() -> Trees:
    return read_trees(path_of(MODEL))
