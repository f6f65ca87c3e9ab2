"""How sure a lid is: the share of such lids that is expected to be right."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from processing.methods.road.gutters.gutter_contrast import Contrast, contrast_of
from processing.methods.road.gutters.gutter_lids import GutterCover
from processing.methods.road.gutters.gutter_runs import GutterRun
from processing.methods.road.gutters.notches import Notches

# Bounds of facts, so that none outweighs all others; set before the weights were fitted.

_FEW_HOLES = 8
"""Notches that make the holes' places half believed."""

_FEW_POINTS = 10
"""With fewer points on its top a cover's plane is that of its neighbours."""

_MOST_JOINTS, _MOST_RAISED_M = 60.0, 0.3
"""A row of joints that is worth more, or one raised higher, is no surer."""

_LEAST_CONTRAST, _MOST_CONTRAST = -1.0, 4.0
"""Bounds of both contrasts, as logarithms."""

_LEAST_GAIN, _MOST_GAIN = -1.0, 2.0
"""Bounds of what the holes' places gain for each notch, as logarithms."""

_MOST = 0.99
"""No cover is surer: of those given 0.9 and more 93 to 98 % were right (see `WEIGHTS`)."""


class CoverFacts(NamedTuple):
    """What is known of one cover. Facts are bounded, so that none outweighs all others.

    Attributes
    ----------
    joints : float
        Logarithm of what the notches are worth for the gutter's row of joints, up to 60.
    holes : float
        How much likelier its holes' places across the gutter are than chance, −1 to 2: the mean
        logarithm per notch, the less the fewer notches there are.
    lids : float
        How much more of it is open at the joints about than on the lids: a logarithm, −1 to 4.
    beside : float
        How much more than beside it.
    raised_m : float
        How far the gutter lies higher than roads and walks do, m, 0 to 0.3: hedges have gaps too.
    one_hole : float
        1 where lids of one hole fit best, which are rare: joints of curb stones are narrow too.
    bridged : float
        1 where nothing was seen at either.
    grating : float
        1 where the row of joints says that it is a grating.
    few_points : float
        1 where hardly a point lies on its top.
    hollow : float
        Share of its points that lie below its top, 0 to 1: open gutters have steps too.
    """

    joints: float
    holes: float
    lids: float
    beside: float
    raised_m: float
    one_hole: float
    bridged: float
    grating: float
    few_points: float
    hollow: float


WEIGHTS = CoverFacts(
    joints=0.38,
    holes=1.47,
    lids=0.99,
    beside=0.67,
    raised_m=-13.83,
    one_hole=-0.27,
    bridged=-0.53,
    grating=-0.52,
    few_points=-0.50,
    hollow=-1.98,
)
"""What each fact is worth: see `processing.laboratory.road_training.gutter_training`, which also
says how reliable they are. Of 32 streets left out one by one, 1,117 of 1,195 covers given 0.9 and
more were right, 265 of 313 of those from 0.7, 44 of 58 of those from 0.5 and 20 of 99 of those
below; of ten others 426 of 436, 101 of 104, 3 of 3 and 3 of 14."""

CONSTANT = -6.03
"""Log-odds of a cover of which nothing is known; fitted with `WEIGHTS`."""


def facts_of(
    run: GutterRun, covers: tuple[GutterCover, ...], notches: Sequence[Notches]
) -> list[CoverFacts]:
    """The facts of all covers of a gutter.

    Parameters
    ----------
    run : GutterRun
    covers : tuple of GutterCover
        All of its row's.
    notches : sequence of Notches
        Of each drive.
    """
    contrast = contrast_of(run, notches)
    joints = math.log(min(max(run.row.value, 1.0), _MOST_JOINTS))
    believed = run.holes.count / (run.holes.count + _FEW_HOLES)
    holes = believed * float(np.clip(run.holes.gain, _LEAST_GAIN, _MOST_GAIN))
    of_run = _RunFacts(joints, holes, float(run.holes.type.holes == 1))
    return [_facts(one, of_run, contrast, k) for k, one in enumerate(covers)]


class _RunFacts(NamedTuple):
    """Facts that all covers of a gutter share: see `CoverFacts`."""

    joints: float
    holes: float
    one_hole: float


def _facts(cover: GutterCover, of_run: _RunFacts, contrast: Contrast, number: int) -> CoverFacts:
    lids, beside = (
        min(max(float(one[number]), _LEAST_CONTRAST), _MOST_CONTRAST)
        for one in (contrast.lids, contrast.beside)
    )
    return CoverFacts(
        of_run.joints,
        of_run.holes,
        lids,
        beside,
        min(contrast.raised_m, _MOST_RAISED_M),
        of_run.one_hole,
        float(cover.is_bridged),
        float(cover.is_grating),
        float(cover.on_top < _FEW_POINTS),
        cover.below / max(cover.on_top + cover.below, 1),
    )


def chance_of(facts: CoverFacts) -> float:
    """The chance that a cover is right, 0 to 1.

    References
    ----------
    Hosmer, Lemeshow: Applied Logistic Regression (the model).
    """
    logit = CONSTANT + sum(weight * fact for weight, fact in zip(WEIGHTS, facts, strict=True))
    return min(_MOST, 1.0 / (1.0 + math.exp(-logit)))
