"""How sure a plate is a road sign: the share of right ones among its like."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats
from processing.methods.road.logistic import chance_of_logit
from processing.methods.road.signs.brightness import SHINING
from processing.methods.road.signs.plates import Plate, PlateEvidence
from processing.methods.road.signs.sign_posts import PostForm
from processing.methods.road.signs.sign_shapes import RECTANGLE

_LOW_EDGE_M = 1.6
"""Lower edges of signs hang higher (道路標識設置基準 2-2: 1.8 m), those of machines and of boards
on the ground lower."""

_FULL_TURNS = 12
"""Scan lines beyond which a plate is no better known."""

_NOISE_M, _FULL_NOISE_M = 0.005, 0.01
"""How far points lie off a plate that is flat, by the noise of most scanners; leaves and rough
walls scatter more."""
_LARGE_M = 1.0
_PLAIN = (RECTANGLE, "square")
_HIGH_M = 3.5
"""Signs beside a road hang lower; over a road they are guide signs, and their backs plain."""

_OVERHEAD_M, _ABOVE_ROADS_M = 9.0, 12.0
"""Heights up to which the middles of signs over a road hang (道路標識設置基準: lower edges at
5 m, with plates of a few metres), and from which surely none does: what shines there are windows
and walls."""

_NARROWEST_M, _WIDE_M = 0.2, 0.35
"""The narrowest plates are 40 cm wide (標識令, 別表第二), less what their rims are uncertain by."""

_LOWEST_BOARD_M, _LOW_BOARD_M = 0.1, 0.2
"""Heights of boards with a line of letters: guide signs have letters of 10 cm and more with as much
above and below (標識令, 別表第二)."""

_METAL, _PAINT = 0.75, 1.5
"""Standard deviations above the middle of diffuse things up to which the metal back of a sign is,
and from which only paint and plastic are (:mod:`.plate_sides`)."""

_WHITE = 2.5
"""The same of the brightest paint; faces of signs begin at `SHINING`."""

_USUAL_ACROSS = 0.3
"""Where nobody knows the way of the vehicle: about what most signs have."""

_ASKANCE, _SQUARE = 0.7, 0.95
"""Sines of the angle between a plate's look and the road up to which it may be meant for who drives
by (45°), and from which it surely isn't (72°)."""

_BRIGHT = 0.5
"""Share of bright points from which a side is a face."""


class SignFacts(NamedTuple):
    """What speaks for a sign and against one; bounded, so that none outweighs all others.

    Attributes
    ----------
    bright : float
        Share of its points that shine on the side where more do, by how near they come to the
        brightest faces of the survey.
    cost : float
        Mean of what the ends of its lines say against it, over their most: 0 to 1.
    explained : float
        Share of what lies in its plane that plates explain.
    sectors : float
        Share of the directions about its middle in which its rim was seen.
    turns : float
        Logarithm of the scan lines on it, over that of 12: 0 to 1.
    open_ends : float
        Share of its lines' ends at which it was seen to end.
    noise : float
        How far points lie off it, 0 up to 5 mm, 1 from 1 cm on.
    low : float
        How far its lower edge is below 1.6 m above the ground, m, 0 to 1.
    askew : float
        Roll and tilt, 1 for ten degrees together, 2 at most.
    is_plain : float
        1 of a rectangle or a square that is dull: boards, windows and walls look alike.
    is_large : float
        Of what is dull, how far its longer side is above a metre, 0 to 1.
    across : float
        Sine of the angle in plan between where it looks and where the vehicle drove by: signs look
        along the road.
    thick : float
        By how much more of its scan lines go on at one of two opposite edges than at the other:
        over the side of a board or a box, or a roof; plates are thin.
    narrow : float
        How far it is narrower than 35 cm, 1 from 20 cm on, or lower than 20 cm, 1 from 10 cm on,
        where it hangs below no other: no sign is, but strips of poles, edges of roofs and pieces
        of larger plates are.
    other_disc : float
        1 of a disc of a size that bus stops and mirrors have and signs don't.
    unheld : float
        1 of what hangs on no post, arm or gantry of its own, as far as was seen: parts of
        buildings, boards on walls and poles.
    painted : float
        1 of what shows neither a face nor the metal of a back: one side is as bright as paint, or
        both were seen and neither shines. 0 where nothing of a recording shines.
    cut : float
        Share of its points of drives that begin or end on it: pieces of larger things.
    averted : float
        1 of what is dull and looks across the road, where other things of the recording shine: a
        face looks at who drives by.
    over_board : float
        1 of what is dull and has a higher board right below it: bus stops have a disc over their
        timetable.
    faint : float
        Of what shines, how far it stays below the brightest faces of the survey, 0 to 1: white
        walls and frames of windows shine a little where they are met straight on.
    high : float
        Of what is dull, how far its middle is above 3.5 m, over 3.5 m, 0 to 1; of anything twice
        how far above 9 m, over 3 m, 0 to 2: parts of buildings are.
    """

    bright: float
    cost: float
    explained: float
    sectors: float
    turns: float
    open_ends: float
    noise: float
    low: float
    askew: float
    is_plain: float
    is_large: float
    high: float
    across: float
    thick: float
    narrow: float
    other_disc: float
    unheld: float
    painted: float
    cut: float
    averted: float
    over_board: float
    faint: float


# As `python -m processing.laboratory.road_training.sign_training` learns them, on 9,219 plates, of
# which 377 lie within 15 cm of signs, of its 48 simulated streets and avenues of five scanners (80
# m each); none of them is on the page of accuracy. Left out one street at a time, 322 of 323 given
# 0.9 and more were right, 21 of 27 from 0.7, 14 of 20 from 0.5, 6 of 23 from 0.3, 14 of 8,826
# below.
# What hardly occurs there (`over_board`, `other_disc`) stands nearly as reasoning expects it.
_CONSTANT = -4.74
_WEIGHTS = SignFacts(
    bright=4.98,
    cost=-1.16,
    explained=5.56,
    sectors=3.29,
    turns=0.0,
    open_ends=2.10,
    noise=-1.80,
    low=-7.43,
    askew=-3.27,
    is_plain=-1.39,
    is_large=-2.80,
    high=-3.95,
    across=-1.75,
    thick=-3.00,
    narrow=-2.24,
    other_disc=-5.00,
    unheld=-1.66,
    painted=-3.32,
    cut=-1.34,
    averted=-2.10,
    over_board=-3.80,
    faint=-2.24,
)

_OVER_ROAD: tuple[PostForm, ...] = ("cantilever", "gantry")
_OF_SIGNS = ("single", "double", *_OVER_ROAD)
"""What signs hang on that is theirs, and what holds large ones over the road."""


def facts_of(plate: Plate, ground_m: float, along: Floats) -> SignFacts:
    """The facts of a plate, but for what it hangs on.

    Parameters
    ----------
    ground_m : float
        Height of the ground below it, about the same origin.
    along : (2,) float64
        The way of the vehicle beside it, a unit vector in plan; NaN where it isn't known.
    """
    one = plate.evidence
    edge = float(plate.outline[:, 2].min()) - ground_m
    high = float(plate.centre[2]) - ground_m
    is_dull = one.bright < _BRIGHT
    longer = max(plate.shape.wide_m, plate.shape.high_m)
    across = _across(plate, along)
    return SignFacts(
        bright=one.bright * (1.0 - one.faint),
        cost=min(one.cost / 4.0, 1.0),
        explained=max(0.0, one.explained),
        sectors=one.sectors,
        turns=min(math.log(max(one.turns, 1)) / math.log(_FULL_TURNS), 1.0),
        open_ends=min(one.open_ends / (2.0 * len(plate.pieces)), 1.0),
        noise=_over(one.noise_m, _NOISE_M, _FULL_NOISE_M),
        low=min(max(_LOW_EDGE_M - edge, 0.0), 1.0),
        askew=min((abs(math.degrees(one.roll_rad)) + abs(math.degrees(one.tilt))) / 10.0, 2.0),
        is_plain=float(is_dull and plate.shape.shape in _PLAIN),
        is_large=min(max(longer - _LARGE_M, 0.0), 1.0) * is_dull,
        high=_high(high, is_bright=one.bright >= _BRIGHT),
        across=across,
        thick=one.thick,
        narrow=1.0
        - min(
            _over(plate.shape.wide_m, _NARROWEST_M, _WIDE_M),
            _over(plate.shape.high_m, _LOWEST_BOARD_M, _LOW_BOARD_M) if plate.upper < 0 else 1.0,
        ),
        other_disc=float(plate.shape.is_other_disc),
        unheld=0.0,
        painted=_painted(one),
        cut=one.cut,
        averted=_averted(one, across),
        over_board=float(one.over_board and is_dull),
        faint=one.faint,
    )


def facts_with_post(facts: SignFacts, post: PostForm | None) -> SignFacts:
    """The same, what a plate hangs on being known, or known not to have been measured.

    Large plates high up are usual on arms and gantries over the road.
    """
    if post in _OVER_ROAD:
        facts = facts._replace(high=0.0, is_large=0.0)
    return facts._replace(unheld=0.0 if post in _OF_SIGNS else 1.0)


def best_chance_of(facts: SignFacts) -> float:
    """The chance of a plate if what holds it turns out to be what holds signs."""
    return max(chance_of(facts), chance_of(facts_with_post(facts, _OVER_ROAD[0])))


def facts_with_other_side(facts: SignFacts, plate: Plate, other: Plate) -> SignFacts:
    """The same of a plate of which the other side was found as a plate of its own."""
    shine = max(plate.evidence.shine, other.evidence.shine)
    return facts._replace(painted=_painted(plate.evidence._replace(shine=shine, both_seen=True)))


def _high(high_m: float, *, is_bright: bool) -> float:
    """How much a plate hangs higher than its like, 0 to 2."""
    beside_road = 0.0 if is_bright else min(max(high_m / _HIGH_M - 1.0, 0.0), 1.0)
    return max(beside_road, 2.0 * _over(high_m, _OVERHEAD_M, _ABOVE_ROADS_M))


def _over(value: float, low: float, high: float) -> float:
    """Where a value lies between two, 0 to 1."""
    return min(max((value - low) / (high - low), 0.0), 1.0)


def _painted(evidence: PlateEvidence) -> float:
    """How surely what was seen of a plate is neither a face nor metal, 0 to 1."""
    if evidence.bright >= _BRIGHT or math.isnan(evidence.shine):
        return 0.0
    is_face = _over(evidence.shine, _WHITE, SHINING)
    above = 1.0 if evidence.both_seen else _over(evidence.shine, _METAL, _PAINT)
    return above * (1.0 - is_face)


def _averted(evidence: PlateEvidence, across: float) -> float:
    """How surely a plate that is dull, by what shines beside it, looks across the road."""
    if evidence.bright >= _BRIGHT or math.isnan(evidence.shine):
        return 0.0
    return _over(across, _ASKANCE, _SQUARE)


def _across(plate: Plate, along: Floats) -> float:
    look = plate.normal[:2] / max(float(np.hypot(*plate.normal[:2])), 1e-9)
    off = abs(float(look[0] * along[1] - look[1] * along[0]))
    return off if math.isfinite(off) else _USUAL_ACROSS


def chance_of(facts: SignFacts) -> float:
    """The chance of being a sign, 0 to 1."""
    logit = _CONSTANT + sum(weight * fact for weight, fact in zip(_WEIGHTS, facts, strict=True))
    return chance_of_logit(logit)
