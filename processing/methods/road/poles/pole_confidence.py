"""How sure a shaft is a pole: the share of right ones among its like."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.methods.noise.tree_files import read_trees
from processing.methods.noise.trees import Trees, log_odds
from processing.methods.road.logistic import chance_of_logit
from processing.methods.road.poles.carried import Carried
from processing.methods.road.poles.leaves import LeavesAbout
from processing.methods.road.poles.shaft_kernels import ARC, FREE, INSIDE, POINTS, SLABS
from processing.methods.road.poles.shaft_sides import SeenSides
from processing.methods.road.poles.shafts import Shaft
from processing.methods.road.poles.surroundings import Surroundings
from resources import path_of

_MOST_NOISE = 4.0
"""Times the noise of the recording's smooth shafts; bark, cloth and edges are no smoother."""

_MOST_POINTS = 3.0
"""Decimal logarithm: a thousand points tell as much as ten thousand."""

_HALF = 0.5
"""Of its circumference one scanner sees of any round thing."""

_TALL_M = 5.0
"""A higher shaft is no surer."""

_USUAL_TAPER = 0.012
"""Metres of radius lost in a metre: twice what poles of concrete have (JIS A 5373: 1/75 of the
diameter), and no pole widens upwards."""

_USUAL_M = 0.2
"""Radius up to which poles are common."""

_WIRED = 4.0
"""Half metres of wires on each side that make sure."""

_POST_M, _THICKER_M = 0.045, 0.03
"""Radius of usual posts of signs and mirrors (76.3 and 89.1 mm, JIS G 3444), and m beyond it to one
that carries leaves if leaves are about it."""

_PIPE_M = 0.07
"""Radius of the thickest posts of signs and mirrors, 101.6 mm and a wrap (JIS G 3444)."""


_LEARNT = 0.7
"""Share of the learnt log-odds: of streets that neither knew, what was likely was so most often."""

_LED_ON = 0.375
"""Of 1.6 m: 0.75 m, longer than plates of signs on one post reach. Posts of rails stand 2 m apart,
and what is nearer to the next one counts there."""

_MOST_TOP_M, _LEAST_TAPER, _MOST_TAPER = 15.0, -0.02, 0.03
"""As far as a fact tells more of a shaft's own measures."""


class PoleFacts(NamedTuple):
    """What speaks for a pole and against one; bounded, so that none outweighs all others.

    Attributes
    ----------
    rough : float
        Its noise over that of the recording's smooth shafts, logarithm to the base 2, 0 to 2.
    slabs : float
        Share of its heights that show it.
    inside : float
        Points in it for each on it, 0 to 1.
    free : float
        Share of the heights that have less beside it than on it.
    arc : float
        Share of the circumference that was seen, up to a half.
    points : float
        Decimal logarithm of their number, up to 3.
    tall : float
        Height over 5 m, up to 1.
    hidden_m : float
        How far above the ground it comes in sight, up to 1 m.
    rails : float
        Share of the heights with something on two opposite sides.
    cover : float
        Share of the plan about its top that is filled.
    over : float
        Share of the metre above the top that something fills.
    roof : float
        Share of the way to the top of another post as high that something level fills.
    crown : float
        Share of the directions about the axis that twigs fill, times how far their middle is on
        the axis: a neighbour's crown hangs aside.
    leafy : float
        Decimal logarithm of the cells that twigs fill, and one, up to 2.
    flat : float
        Share of the cells about the axis that are planes or lines.
    trunk : float
        How much it is thicker than a post and has twigs about it, 0 to 1: lamps that stand in
        crowns are few, trunks are many.
    plate : float
        Share of the patches beside it that are smooth surfaces.
    wired : float
        Wires on both of its sides, 0 to 1.
    pipe : float
        How much it is a thin smooth pipe seen on all of its height, 0 to 1: a post, whatever
        hangs about it.
    tapered : float
        How far its taper is off what poles have, over 0.012, up to 2.
    thick_m : float
        Radius beyond 0.2 m.
    square : float
        How far its section has corners as a square has, 0 to 1.
    behind : float
        Share of its points on the side that is turned away from the vehicle.
    top_m, radius_m : float
        How high it was seen, up to 15 m, and its radius.
    taper : float
        What the radius loses in a metre, −0.02 to 0.03.
    shines : float
        Whether a reflector or the face of a sign is on its upper half, 0 or 1; 0.5 where no
        intensity tells.
    tree : float
        How sure the search for trees is of it, 0 to 1; 0 where it was not asked.
    alike : float
        Of a low one, how many about it are like it, logarithm to the base 2 of one more, 0 to 4.
    beam : float
        Whether something leads on from a low one at one height to both sides, 0 or 1.
    """

    rough: float
    slabs: float
    inside: float
    free: float
    arc: float
    points: float
    tall: float
    hidden_m: float
    rails: float
    cover: float
    over: float
    roof: float
    crown: float
    leafy: float
    flat: float
    trunk: float
    plate: float
    wired: float
    pipe: float
    tapered: float
    thick_m: float
    square: float
    behind: float
    top_m: float
    radius_m: float
    taper: float
    shines: float
    tree: float
    alike: float
    beam: float


class ShaftAbout(NamedTuple):
    """What is known about a shaft besides its own measures.

    ``beside``: what stands about it; ``carried``; ``sides``: which of its sides were seen;
    ``shines``, ``tree``: as of :class:`PoleFacts`.
    """

    beside: Surroundings
    carried: Carried
    sides: SeenSides
    shines: float
    tree: float


_LOW_M = 1.8
"""Top below which shafts are judged as bollards and delineators are, among posts of fences, stakes
and people, which end below; the lowest plates of signs hang from there on (道路標識設置基準)."""

# Logistic weights, held to what reasoning expects, of 1,761 low and 2,018 high shafts, 49 and 427
# of them poles, of 18 usual streets and 16 avenues by scanners of the catalogue; those of what
# shines and of trees, with the constants beside them, of the streets of `pole_training`.
# What speaks now for and now against a pole, as its like do, only trees of decisions ask. Beams
# weigh by reasoning alone: of 166 low poles of these streets they led on from two.
_LOW_CONSTANT = -8.22
_LOW_WEIGHTS = PoleFacts(
    rough=-2.21,
    slabs=0.02,
    inside=-4.68,
    free=7.52,
    arc=0.0,
    points=0.55,
    tall=0.0,
    hidden_m=-1.51,
    rails=-2.05,
    cover=-15.65,
    over=-0.17,
    roof=-0.1,
    crown=-1.0,
    leafy=-0.5,
    flat=0.52,
    trunk=-0.1,
    plate=0.1,
    wired=0.1,
    pipe=0.1,
    tapered=-2.15,
    thick_m=-8.48,
    square=-3.75,
    behind=-0.05,
    top_m=0.0,
    radius_m=0.0,
    taper=0.0,
    shines=4.9,
    tree=-0.5,
    alike=0.0,
    beam=-10.0,
)

_HIGH_CONSTANT = -4.06
_HIGH_WEIGHTS = PoleFacts(
    rough=-4.23,
    slabs=0.0,
    inside=-1.97,
    free=3.35,
    arc=0.96,
    points=1.2,
    tall=2.02,
    hidden_m=-0.97,
    rails=-2.57,
    cover=0.0,
    over=-3.24,
    roof=-3.14,
    crown=0.0,
    leafy=-0.14,
    flat=0.33,
    trunk=-1.72,
    plate=2.08,
    wired=1.71,
    pipe=1.24,
    tapered=-3.67,
    thick_m=-5.03,
    square=-6.13,
    behind=-3.27,
    top_m=0.0,
    radius_m=0.0,
    taper=0.0,
    shines=3.9,
    tree=-5.0,
    alike=0.0,
    beam=0.0,
)


SIGNS = (
    *(-1, 1, -1, 1, 1, 1, 0, -1, -1, 0, -1, -1, 0, 0, 0, -1, 1, 1, 0, -1, -1, -1, -1),
    *(0, 0, 0, 1, -1, 0, -1),
)
"""Which facts can only speak for a pole (1) or against one (−1), whatever the others are."""

MODELS = {True: "models/uprights/low_post.onnx", False: "models/uprights/high_post.onnx"}
"""Of low shafts and of high ones, as
`python -m processing.laboratory.road_training.pole_training` learns them."""


def facts_of(shaft: Shaft, about: ShaftAbout, usual_noise_m: float) -> PoleFacts:
    """The facts of a shaft.

    Parameters
    ----------
    usual_noise_m : float
        How far points lie off the smooth shafts of this recording.
    """
    beside, carried, sides, shines, tree = about
    told, crown = shaft.told, beside.crown
    rough = min(max(shaft.noise_m / usual_noise_m, 1.0), _MOST_NOISE)
    taper = max(-shaft.taper, shaft.taper - _USUAL_TAPER, 0.0)
    return PoleFacts(
        rough=math.log2(rough),
        slabs=float(told[SLABS]),
        inside=min(float(told[INSIDE]), 1.0),
        free=float(told[FREE]),
        arc=min(float(told[ARC]), _HALF),
        points=min(math.log10(max(float(told[POINTS]), 1.0)), _MOST_POINTS),
        tall=min(shaft.top_m / _TALL_M, 1.0),
        hidden_m=min(max(shaft.low_m, 0.0), 1.0),
        rails=beside.rails,
        cover=beside.cover,
        over=beside.over,
        roof=beside.roof,
        crown=crown.sectors / 12 * (1 - min(crown.aside, 1.0)) if crown else 0.0,
        leafy=min(math.log10(1 + crown.cells), 2.0) if crown else 0.0,
        flat=crown.flat_share if crown else 1.0,
        trunk=_trunk(shaft, crown) if crown else 0.0,
        plate=carried.smooth,
        wired=min(carried.wires / _WIRED, 1.0),
        pipe=_pipe(shaft, rough),
        tapered=min(taper / _USUAL_TAPER, 2.0),
        thick_m=max(0.0, shaft.radius_m - _USUAL_M),
        square=sides.square,
        behind=sides.behind,
        top_m=min(shaft.top_m, _MOST_TOP_M),
        radius_m=shaft.radius_m,
        taper=max(_LEAST_TAPER, min(shaft.taper, _MOST_TAPER)),
        shines=shines,
        tree=tree,
        alike=beside.alike,
        beam=float(beside.beam >= _LED_ON),
    )


def _trunk(shaft: Shaft, crown: LeavesAbout) -> float:
    """How much a shaft is a thick thing amid twigs; each measure counts as far as others agree."""
    leafy = min(math.log10(1 + crown.cells), 2.0) / 2
    thick = (shaft.radius_m - _POST_M) / _THICKER_M
    return leafy * (1 - crown.flat_share) * min(max(thick, 0.0), 1.0)


def _pipe(shaft: Shaft, rough: float) -> float:
    """How much a shaft is a thin smooth pipe; each measure counts as far as it leaves doubt."""
    slabs, inside = float(shaft.told[SLABS]), float(shaft.told[INSIDE])
    measures = (
        1 - 2 * math.log2(rough),
        (slabs - 0.8) / 0.2,
        1 - inside / 0.05,
        (_PIPE_M - shaft.radius_m) / 0.03,
        shaft.top_m - _LOW_M,
    )
    return math.prod(min(max(one, 0.0), 1.0) for one in measures)


def is_low(shaft: Shaft) -> bool:
    """Whether a shaft is judged among low ones."""
    return shaft.top_m < _LOW_M


def chances_of(facts: Sequence[PoleFacts], *, are_low: Sequence[bool]) -> Floats:
    """(n,) float64: the chance of each of being a pole, 0 to 1.

    Of two log-odds some of each: of weights that reasoning holds, and of boosted trees of decisions
    (Friedman 2001, Greedy function approximation). Trees tell more, and less of what no training
    street had.
    """
    rows = np.array(facts, np.float64).reshape(-1, len(PoleFacts._fields))
    low = np.array(are_low, np.bool_)
    odds = np.zeros(len(rows))
    for is_low, constant, weights in (
        (True, _LOW_CONSTANT, _LOW_WEIGHTS),
        (False, _HIGH_CONSTANT, _HIGH_WEIGHTS),
    ):
        mine = low == is_low
        reasoned = constant + rows[mine] @ np.array(weights)
        learnt = log_odds(_model(is_low=is_low), rows[mine].astype(np.float32), SilentMonitor())
        odds[mine] = (1 - _LEARNT) * reasoned + _LEARNT * learnt
    return np.array([chance_of_logit(one) for one in odds.tolist()])


@cache
def _model(*, is_low: bool) -> Trees:
    return read_trees(path_of(MODELS[is_low]))


def most_chances_of(
    shafts: Sequence[Shaft], beside: Sequence[Surroundings], usual_noise_m: float
) -> Floats:
    """(n,) float64: the chances if all they carry and each side of them spoke for poles, 0 to 1.

    What is carried never speaks against a pole, and no side for one.
    """
    best = Carried(wires=math.ceil(_WIRED), smooth=1.0)
    sides = SeenSides(square=0.0, behind=0.0)
    facts = [
        facts_of(shaft, ShaftAbout(one, best, sides, shines=1.0, tree=0.0), usual_noise_m)
        for shaft, one in zip(shafts, beside, strict=True)
    ]
    return chances_of(facts, are_low=[is_low(shaft) for shaft in shafts])
