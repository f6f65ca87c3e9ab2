"""How sure a cover is one: the share of right ones among its like."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.methods.road.covers.cover_fits import CoverEdge, FittedCover
from processing.methods.road.covers.edge_kernels import edge_means_kernel
from processing.methods.road.covers.shape_kernels import PATCHY
from processing.methods.road.logistic import chance_of_logit

_LEAST_WEIGHT = 0.5
"""Of a band's cells in a sector that says something."""

_USUAL_M = (0.22, 0.95)
"""Shorter sides of covers, with what they are off by: valves of 0.25 m to manholes of 0.9 m."""

_ROUND_M, _OFF_M = (0.3, 0.6, 0.9), 0.03
"""Diameters of round covers, and how far those that are found are off."""

_BRIGHT = 0.5
"""Over the road's tone: paint is brighter, iron hardly is."""

_HIGH_M = 0.012
"""What lies higher or lower is seldom a cover that is driven over."""


class RoadCoverFacts(NamedTuple):
    """What speaks for a cover and against one; bounded, so that none outweighs all others.

    Attributes
    ----------
    clear : float
        How surely its edge parts something, natural logarithm, 3 to 7.
    toned : float
        The difference of tones over what they vary by around it, 0 to 3.
    raised : float
        How far it stands above the road over what heights vary by around it, 0 to 3.
    sunk : float
        The same of what lies below the road, 0 to 3.
    open : float
        The share of points below it, less that around it, 0 to 0.5.
    bright : float
        How much brighter than iron it is, 0 to 1.
    step : float
        How much higher or lower than covers lie, over 12 mm, 0 to 2.
    uneven : float
        How much the tone of the road about it changes, over its difference, 0 to 2, as far as it
        differs by its tone and not by its height.
    rough : float
        How much the heights of the road about it change, over a texture, logarithm, 0 to 3, as far
        as it differs by its height.
    mixed : float
        How much its own tone changes from sector to sector and within, over its difference, 0 to 2,
        as far as it differs by its tone.
    sharp : float
        The difference next to the edge over that of the whole bands, of what differs most, 0 to
        1.5: dirt and water fade over a decimetre.
    usual : float
        1 for a round one of 0.3, 0.6 or 0.9 m, less for others (JIS A 5506 has these sizes).
    missing : float
        Share of its edge that wasn't seen.
    small, large : float
        How far its shorter side is from those of covers, logarithm to the base 2, 0 to 1.
    long : float
        Length over width, logarithm to the base 2, 0 to 1.4.
    filled : float
        Share of its area that was measured.
    """

    clear: float
    toned: float
    raised: float
    sunk: float
    open: float
    bright: float
    step: float
    uneven: float
    rough: float
    mixed: float
    sharp: float
    usual: float
    missing: float
    small: float
    large: float
    long: float
    filled: float


# Learnt by `processing.laboratory.road_training.cover_training` from 10,019 shapes, 96 of them
# covers, of 13 simulated streets of five scanners. Left out one street at a time, 42 of the 46
# given 0.9 and more were covers, 20 of the 23 from 0.5 on, 34 of the others.
_CONSTANT = -11.36
_WEIGHTS = RoadCoverFacts(
    clear=1.03, toned=1.95, raised=2.69, sunk=2.48, open=22.26, bright=-9.33, step=-2.80,
    uneven=-3.66, rough=-2.10, mixed=-4.10, sharp=0.97, usual=0.55, missing=-6.02, small=-3.84,
    large=-2.45, long=-0.76, filled=1.09,
)  # fmt: skip


class EdgeMeans(NamedTuple):
    """Means over the sectors of an edge that were seen.

    Attributes
    ----------
    tone, height_m, below : float
        Inside minus outside.
    tone_spread, height_spread_m : float
        Standard deviations of these differences from sector to sector.
    outer_tone_spread, outer_height_spread_m : float
        The same of the band outside alone.
    inner_tone_spread : float
        The same of the band inside.
    seen : float
        Share of the sectors that were seen.
    """

    tone: float
    height_m: float
    below: float
    tone_spread: float
    height_spread_m: float
    outer_tone_spread: float
    outer_height_spread_m: float
    inner_tone_spread: float
    seen: float


def edge_means(edge: CoverEdge) -> EdgeMeans:
    """What an edge parts on the whole, and how alike its sectors are."""
    told = np.empty(len(EdgeMeans._fields))
    edge_means_kernel(edge.bands, _LEAST_WEIGHT, told)
    return EdgeMeans(*told.tolist())


def facts_of(cover: FittedCover) -> RoadCoverFacts:
    """The facts of a cover."""
    means = edge_means(cover.edge)
    long, wide = cover.sides_m
    core, noise = cover.edge.core, cover.edge.noise
    own = math.sqrt(max(core[1, 1] / core[0, 0] - core[0, 1] ** 2, 0.0)) if core[0, 0] > 0 else 0.0
    inside = math.hypot(means.inner_tone_spread, max(own - noise[0], 0.0))
    tone = abs(means.tone) + PATCHY[0]
    high = means.height_m / math.hypot(means.height_spread_m, PATCHY[1])
    toned = min(abs(means.tone) / math.hypot(means.tone_spread, PATCHY[0]), 6.0) / 2
    share = toned**2 / (toned**2 + (min(abs(high), 6.0) / 2) ** 2 + 1e-6)
    return RoadCoverFacts(
        clear=min(max(math.log(max(cover.gain, 1.0)), 3.0), 7.0),
        toned=toned,
        raised=min(max(high, 0.0), 6.0) / 2,
        sunk=min(max(-high, 0.0), 6.0) / 2,
        open=min(max(means.below, 0.0), 0.5),
        bright=min(max(means.tone - _BRIGHT, 0.0), 1.0),
        step=min(max(abs(means.height_m) / _HIGH_M - 1.0, 0.0), 2.0),
        uneven=share * min(means.outer_tone_spread / tone, 2.0),
        rough=(1 - share) * min(math.log(max(means.outer_height_spread_m / PATCHY[1], 1.0)), 3.0),
        mixed=share * min(inside / tone, 2.0),
        sharp=_sharpness(cover.edge, means),
        usual=_usual(wide) if cover.is_round else 0.0,
        missing=1.0 - means.seen,
        small=min(max(math.log2(_USUAL_M[0] / wide), 0.0), 1.0),
        large=min(max(math.log2(wide / _USUAL_M[1]), 0.0), 1.0),
        long=min(math.log2(long / wide), 1.4),
        filled=cover.filled,
    )


def _sharpness(edge: CoverEdge, means: EdgeMeans) -> float:
    """The difference next to the edge over that of the bands, of tone or of height."""
    near = edge.core[2] - edge.core[3]
    if edge.core[2, 0] <= 0 or edge.core[3, 0] <= 0:
        return 1.0
    toned, raised = abs(means.tone) / PATCHY[0], abs(means.height_m) / PATCHY[1]
    one, other = (near[1], means.tone) if toned > raised else (near[2], means.height_m)
    return min(max(float(one / other), 0.0), 1.5) if other else 0.0


def _usual(diameter_m: float) -> float:
    off = min(abs(diameter_m - one) for one in _ROUND_M)
    return math.exp(-0.5 * (off / _OFF_M) ** 2)


def chance_of(facts: RoadCoverFacts) -> float:
    """The chance of being a cover, 0 to 1."""
    logit = _CONSTANT + sum(weight * fact for weight, fact in zip(_WEIGHTS, facts, strict=True))
    return chance_of_logit(logit)
