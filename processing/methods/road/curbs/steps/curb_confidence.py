"""How sure a curb is one: the share of right ones among what looks like it.

Runs of steps get a first chance by what scanlines show of them (`confidence_of`); once edges are
measured, lines get the one that candidates carry (`chance_of`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.curbs.steps.curb_runs import StepRun, median_of

# Bounds of facts, so that none outweighs all others, and the units in which logarithms are taken.
# They were set before the weights were fitted, which make up for any other choice of the units.

_LEAST_SPREAD_M, _LEAST_ROUGH_M = 0.002, 0.003
"""No curb is known to be straighter than scanners tell, and no ground smoother than pavement is."""

_USUAL_SPREAD_M, _USUAL_SIGNIFICANCE = 0.01, 10.0
"""Units of the spread of places, m, and of a step's height in its standard deviations."""

_MOST_SPREAD_M, _LEAST_SIGNIFICANCE, _LEAST_SEEN_M = 0.2, 0.1, 0.1
"""A place farther off weighs no more; guards of logarithms."""

_LONGEST_M, _WIDEST_M = 20.0, 0.3
"""A longer run is no surer, nor one with more level ground before and behind it."""

_USUAL_LONG_M = 5.0
"""Unit of a line's length."""

_VEHICLE_M = 6.0
"""A longer run is no vehicle's side."""

_MOST_LOGIT, _LEAST_BEFORE, _MOST_BEFORE = 50.0, 0.01, 0.99
"""Guards: of the exponential, and of the log-odds of what is certain."""

# Fitted by logistic regression (L2, C = 1, runs weighed by their length up to 30 m) to 1,988 runs
# of at least 1 m and 3 cm on 16 simulated drives of 12 streets with known curbs, none of the
# scenes that results are judged by. Left out one street at a time, 93 % of the runs given 0.9 and
# more were right, 70 % of those from 0.7, 39 % of those from 0.4, 1 % of those below 0.1. Since
# then what hangs over the foot was left out of its roughness along whatever is longer than a
# vehicle; weights fitted anew on 42 streets (seeds 301 to 332, 575 to 589) gave no better lines.
_CONSTANT = -3.12
_SIGNIFICANCE = 3.18  # of the logarithm: grass and gravel rise by few standard deviations
_SPREAD = -0.94  # of the logarithm: concrete is straight, plants are not
_LENGTH = 0.51  # of the logarithm
_TOP, _FOOT = 4.49, 1.82  # per metre: level ground goes on behind and before a curb
_FOOT_ROUGHNESS = -1.59  # of the logarithm: pavement lies before a curb, not soil
_ISLAND, _AS_HIGH = 1.5, 0.3
"""What a curb has raised comes down by another, about as far: log-odds that this adds, set by trial
after the fit; how much the two may differ, as a share of the height."""

_BELOW_M = 0.15
"""So far a road falls to its side by cross slope: 2 % over 7 m."""


class CurbFacts(NamedTuple):
    """What is known of one line. Facts are bounded, so that none outweighs all others.

    Attributes
    ----------
    before : float
        The chance that its steps on scanlines gave it, 0 to 1.
    risen_m : float
        What other steps between the vehicle's path and this one add up to, m, 0 to 0.2; the less
        the longer the line is, 0 from 20 m on. Plinths, house steps and planters are short and
        stand on a pavement that a curb has already raised.
    above_path_m : float
        How far its foot lies above the road at the vehicle's path, m, −0.1 to 0.1; as `risen_m` the
        less the longer the line is. Roads drain to their curbs; what lies 0.25 m below the road is
        none of it, which speaks neither for nor against (0).
    crossing : float
        1 where it lies rather across the vehicle's path than along it, else 0.
    too_tall_m : float
        Height beyond one and a half times what is usual in the recording, m, 0 to 0.2.
    too_flat : float
        Lean of the face beyond half the allowed, m across per m of height, 0 to 0.7.
    uneven : float
        How much place and height change from station to station, in terms of what noise does, 0 to
        1.5.
    rough : float
        How far points lie off carriageway and top, in terms of what they do on even ground, 1 to 4.
    long_m : float
        How much of it was measured, m, 0.5 to 20: curbs go on, steps of houses and edges of lots
        are short.
    faceless : float
        Share of its places where foot and top are seen and no point of the face between them, 0 to
        1: of ground that overhangs, or of an edge that the line crosses.
    walled : float
        Share of all its places above whose upper edge the face goes on, 0 to 1: of walls with a
        recess, and of what stands on the line.
    bridged : float
        Share of its length that nobody saw, 0 to 1: a row of posts or of steps of houses may be
        bridged to one line, of a curb more is seen than hidden.
    verge_m : float
        How much rough ground, grass or soil, lies between the vehicle's path and it, m, 0 to 1; the
        less the more of it lies behind another curb. The road is paved up to its curbs; ridges and
        levees of fields and edges of lots lie behind a verge.
    unraised : float
        1 where the ground falls, seen from the vehicle, and no other curb has raised it; the less
        the more of the line lies behind one. Islands have two curbs, ridges of fields none.
    """

    before: float
    risen_m: float
    above_path_m: float
    crossing: float
    too_tall_m: float
    too_flat: float
    uneven: float
    rough: float
    long_m: float
    faceless: float
    walled: float
    bridged: float
    verge_m: float
    unraised: float


WEIGHTS = CurbFacts(
    before=0.45,
    risen_m=-19.70,
    above_path_m=-6.77,
    crossing=-2.04,
    too_tall_m=-20.60,
    too_flat=-8.38,
    uneven=-0.04,
    rough=-1.77,
    long_m=0.54,
    faceless=-4.73,
    walled=-2.15,
    bridged=-3.31,
    verge_m=-6.76,
    unraised=-4.32,
)
"""What each fact is worth, of `before` its log-odds, of `uneven` and `faceless` the square, of
`long_m` its logarithm; none of the scenes that results are judged by was learnt from. Learnt by
`processing.laboratory.road_training.curb_training` as it comes: 60 streets of 60 m, of them 18 with
worn stones and a drifting trajectory and 30 country roads and highways; 185 lines, of which 129 are
curbs. Of streets left out one by one, 94 of 95 lines given 0.9 and more were curbs, 22 of 30 of
those from 0.7, 6 of 10 of those from 0.5 and 7 of 50 of those below."""

CONSTANT = 3.99
"""Log-odds of a line of which nothing is known; fitted with `WEIGHTS`."""


def terms_of(facts: CurbFacts) -> CurbFacts:
    """The facts as the weights take them: log-odds of the first chance, logarithm of the length.

    Unevenness is squared: worn stones differ by what noise does, soil and grass by far more; the
    share without a face is, too: pulses miss half of some curbs' faces, but never all of one.
    """
    before = min(max(facts.before, _LEAST_BEFORE), _MOST_BEFORE)
    return facts._replace(
        before=math.log(before / (1 - before)),
        uneven=facts.uneven**2,
        faceless=facts.faceless**2,
        long_m=math.log(facts.long_m / _USUAL_LONG_M),
    )


def chance_of(facts: CurbFacts) -> float:
    """The chance that a line is a curb, 0 to 1.

    References
    ----------
    Hosmer, Lemeshow: Applied Logistic Regression (the model).
    """
    logit = CONSTANT + sum(w * term for w, term in zip(WEIGHTS, terms_of(facts), strict=True))
    return 1.0 / (1.0 + math.exp(-logit))


def confidence_of(run: StepRun) -> float:
    """The chance that a run is a curb, 0 to 1.

    References
    ----------
    Hosmer, Lemeshow: Applied Logistic Regression (the model). The facts are physical: see the
    coefficients.
    """
    seen = run.is_seen
    if not seen.any():
        return 0.0
    significance = max(_median(run.significance, run), _LEAST_SIGNIFICANCE)
    spread = math.sqrt(float(np.nanmean(np.minimum(run.spread_m[seen], _MOST_SPREAD_M) ** 2)))
    # Blades of a verge hang over a curb's foot; so do vehicles over their tyres, which are short.
    rough_m = run.foot_cover_m if run.seen_m < _VEHICLE_M else run.foot_roughness_m
    logit = (
        _CONSTANT
        + _SIGNIFICANCE * math.log(significance / _USUAL_SIGNIFICANCE)
        + _SPREAD * math.log(max(spread, _LEAST_SPREAD_M) / _USUAL_SPREAD_M)
        + _LENGTH * math.log(min(max(run.seen_m, _LEAST_SEEN_M), _LONGEST_M))
        + _TOP * min(_median(run.top_m, run), _WIDEST_M)
        + _FOOT * min(_median(run.foot_m, run), _WIDEST_M)
        + _FOOT_ROUGHNESS * math.log(max(_median(rough_m, run), _LEAST_ROUGH_M) / _LEAST_ROUGH_M)
    )
    if run.rises < 0 and _comes_down_again(run):
        logit += _ISLAND
    return max(
        1.0 / (1.0 + math.exp(-min(max(logit, -_MOST_LOGIT), _MOST_LOGIT))), run.chance_beside
    )


def _comes_down_again(run: StepRun) -> bool:
    """Whether the ground falls to the road, as far as other steps have raised it: by an island.

    Levees between fields rise and fall as well, from lower ground.
    """
    high_m = _median(run.heights_m, run)
    is_on_road = _median(run.above_path_m, run) >= -_BELOW_M
    return is_on_road and abs(_median(run.risen_m, run) - high_m) <= _AS_HIGH * high_m


def _median(values: NDArray[np.float64], run: StepRun) -> float:
    """Of the places that were seen, where all is known."""
    return median_of(values[run.is_seen])
