"""How sure a lid is: the share of such lids that is expected to be right."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from processing.methods.road.gutters.gutter_contrast import Contrast, contrast_of
from processing.methods.road.gutters.gutter_lids import GutterCover
from processing.methods.road.gutters.gutter_runs import GutterRun
from processing.methods.road.gutters.notches.notches import Notches

# Bounds of facts, so that none outweighs all others; set before the weights were fitted.

_FEW_HOLES = 8
"""Notches that make the holes' places half believed."""

_FEW_POINTS = 10
"""With fewer points on its top a cover's plane is that of its neighbours."""

_LEAST_OVER, _MOST_OVER, _MOST_RAISED_M = 1.0, 60.0, 0.3
"""A row of joints that is worth less or more, or one raised higher, is no less sure or no surer."""

_MOST_HOLLOW = 0.2
"""More of a cover that lies below it makes it no less sure: of 98 % of right ones less than 0.15
does."""

_OTHER_LENGTH_M = 0.05
"""Covers of one length differ by less: lids are made in steps of 10 cm and cut at ends."""

_LEAST_CONTRAST, _MOST_CONTRAST = -1.0, 4.0
"""Bounds of both contrasts, as logarithms."""

_LEAST_GAIN, _MOST_GAIN = -1.0, 2.0
"""Bounds of what the holes' places gain for each notch, as logarithms."""

_MOST = 0.99
"""No cover is surer: of those given 0.9 and more 97 and 98 % were right (see `WEIGHTS`)."""


class CoverFacts(NamedTuple):
    """What is known of one cover. Facts are bounded, so that none outweighs all others.

    Attributes
    ----------
    over_chance : float
        Logarithm of what the row of joints is worth more than any of lengths that no lid has, 1 to
        60: by the same notches, so however dense or noisy a scanner is.
    holes : float
        How much likelier its holes' places across the gutter are than chance, −1 to 2: the mean
        logarithm per notch, the less the fewer notches there are.
    lids : float
        How much more of it is open at the joints about than on the lids: a logarithm, −1 to 4.
    beside : float
        How much more than beside it.
    raised_m : float
        How far the gutter lies higher than roads and walks do, m, 0 to 0.3: hedges have gaps too.
    unseen : float
        How many of its own two joints nothing was seen of.
    other_length : float
        1 where it is not as long as most lids of its gutter.
    grating : float
        1 where the row of joints says that it is a grating.
    mistaken : float
        How sure its points are, 0 to 1, that it is no lid, or no grating where the row says that
        it is one.
    few_points : float
        1 where hardly a point lies on its top.
    hollow : float
        Share of its points that lie below its top, 0 to 0.2: open gutters and curbs have steps too.
    """

    over_chance: float
    holes: float
    lids: float
    beside: float
    raised_m: float
    unseen: float
    other_length: float
    grating: float
    mistaken: float
    few_points: float
    hollow: float


WEIGHTS = CoverFacts(
    over_chance=0.89,
    holes=0.59,
    lids=0.31,
    beside=0.62,
    raised_m=-10.00,
    unseen=-0.89,
    other_length=-0.74,
    grating=-0.72,
    mistaken=-1.43,
    few_points=-0.55,
    hollow=-8.46,
)
"""What each fact is worth: see `processing.laboratory.road_training.gutter_training`, which also
says how reliable they are. Learnt from 24 streets, each recorded by other heads (`any_mounting`,
seeds 2000 to 2023). Of these left out one by one, 1,295 of 1,336 covers given 0.9 and more were
right, 144 of 167 of those from 0.7, 21 of 28 of those from 0.5 and 6 of 18 of those below; of
twelve others (2100 to 2111) 898 of 919, 97 of 115, 19 of 30 and 7 of 23; of four streets of another
simulator, from which nothing was learnt, 242 of 244, 51 of 55, 8 of 12 and none of 7."""

CONSTANT = -3.14
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
    over = math.log(min(max(run.over_chance, _LEAST_OVER), _MOST_OVER))
    believed = run.holes.count / (run.holes.count + _FEW_HOLES)
    holes = believed * float(np.clip(run.holes.gain, _LEAST_GAIN, _MOST_GAIN))
    of_run = _RunFacts(over, holes, run.length_m)
    return [
        _facts((one, mistaken), of_run, contrast, k)
        for k, (one, mistaken) in enumerate(zip(covers, _mistaken(run, covers), strict=True))
    ]


class _RunFacts(NamedTuple):
    """Facts that all covers of a gutter share: see `CoverFacts`."""

    over_chance: float
    holes: float
    length_m: float


def _mistaken(run: GutterRun, covers: tuple[GutterCover, ...]) -> list[float]:
    """How sure points are of each cover that it is of the other kind."""
    is_grating = np.array([one.is_grating for one in covers], np.float64)
    barred = is_grating if run.barred is None else run.barred
    return [float(one) for one in np.abs(barred - is_grating)]


def _facts(
    known: tuple[GutterCover, float], of_run: _RunFacts, contrast: Contrast, number: int
) -> CoverFacts:
    cover, mistaken = known
    lids, beside = (
        min(max(float(one[number]), _LEAST_CONTRAST), _MOST_CONTRAST)
        for one in (contrast.lids, contrast.beside)
    )
    return CoverFacts(
        of_run.over_chance,
        of_run.holes,
        lids,
        beside,
        min(contrast.raised_m, _MOST_RAISED_M),
        float((np.array(cover.seen) == 0).sum()),
        float(abs(cover.length_m - of_run.length_m) > _OTHER_LENGTH_M),
        float(cover.is_grating),
        mistaken,
        float(cover.on_top < _FEW_POINTS),
        min(cover.below / max(cover.on_top + cover.below, 1), _MOST_HOLLOW),
    )


def chance_of(facts: CoverFacts) -> float:
    """The chance that a cover is right, 0 to 1.

    References
    ----------
    Hosmer, Lemeshow: Applied Logistic Regression (the model).
    """
    logit = CONSTANT + sum(weight * fact for weight, fact in zip(WEIGHTS, facts, strict=True))
    return min(_MOST, 1.0 / (1.0 + math.exp(-logit)))
