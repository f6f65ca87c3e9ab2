"""How far a stem goes on upwards, straight and as round as below: posts do to their end.

A trunk forks, bends and thins where its crown begins. A lamp post under a neighbour's crown goes
on through it, a sign post ends below.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.trees.cone_kernels import NUMBERS, settle_kernel
from processing.methods.road.trees.stem_bodies import BREAST_M, SHAPE_M
from processing.methods.road.trees.stems import HIGHEST_M as LOOKED_M
from processing.methods.road.trees.stems import THICK_M, FittedStem

HIGHEST_M = 8.0
"""Above the foot: what goes on straight up to there is no trunk with branches below."""

_SEEN_M = LOOKED_M + THICK_M / 2
"""Up to which height stems are looked for."""

_STEP_M = 0.2
"""Scan lines lie nearer to each other on what is 8 m high beside the road."""

_TOLERANCE_M = 0.015
"""From the surface: the noise, and what lean and taper of the piece below leave open."""

_SLEEVES_M = (0.01, 0.02, 0.03, 0.04)
"""What a sleeve about the foot of a pole (防護カバー) or a wrap of a trunk adds to the radius."""

_BESIDE_M = 0.3
"""Beyond the surface: leaves there tell how many would lie near it by chance."""

_STRAIGHT_M = 0.6
"""The last piece of a stem that bends, from which it is followed straight on."""

_FEWEST = 3
"""Points on the surface of a slab."""

_MOST_INSIDE = 0.3
"""Points inside it for each on it: nothing shines through a stem."""

_CHANCE = 3.0
"""Times as many as by chance."""

_HIDDEN = 5
"""Slabs that leaves before it may hide: a metre."""

_ROUNDS = 3
"""Each fits the body again to what was found, and looks farther."""

_CORE_M, _ROUND_CORE_M, _CORE_HIGH_M = 0.3, 0.65, 1.5
"""m: the axis with the branches that begin there; a ring about it; how high both are."""

_NEXT = 10
"""Slabs above a stem that are asked for what goes on: 2 m, in which crowns begin over most."""

_THINLY = 0.1
"""Of the points that a slab of the stem shows: fewer are stray ones of a noisy scanner, which is
all that is above a man's head."""


class StemRise(NamedTuple):
    """What becomes of a stem above the heights at which trunks are looked for.

    Attributes
    ----------
    high_m : float
        Up to which height above the foot it goes on as it is, 8 m at most.
    thins : float
        Share of its radius that it loses in a metre of height up to there.
    core : float
        How much denser points lie about its axis above that than beside it, as a power of two: at
        the end of a trunk branches meet, over a post that ends hang leaves as everywhere.
    goes_on : float
        Share of the next 2 m above it in which the axis shows a tenth of the stem's points and
        more: stem, boughs or leaves.
    """

    high_m: float
    thins: float
    core: float
    goes_on: float


def rise_of(points: Floats, stem: FittedStem) -> StemRise:
    """How a stem goes on upwards.

    Parameters
    ----------
    points : (n, 3) float64
        About the foot, of all heights.
    """
    body = stem.straight_on
    near = points[_within(points, body)]
    near = near[np.argsort(near[:, 2], kind="stable")]
    low, top = stem.low_m, stem.high_m
    if stem.bend.any():
        low = max(low, top - _STRAIGHT_M)
    if not _climbed(near, body, top):
        body, low = _thinner(near, body, top), top
    for _ in range(_ROUNDS):
        last = _climbed(near, body, top)
        if last == 0:
            break
        top += last * _STEP_M
        whole = near[(near[:, 2] >= low) & (near[:, 2] <= top)] - (0.0, 0.0, BREAST_M)
        fitted = body.copy()
        room = np.empty(len(whole)), np.zeros(len(whole), np.bool_)
        _, noise = settle_kernel(whole, SHAPE_M, fitted, *room)
        if noise > 0 and abs(fitted[4] - body[4]) < _TOLERANCE_M:
            body = fitted
    thins = float(-body[5] / body[4])
    return StemRise(
        min(top, HIGHEST_M), thins, _core(points, body, top), _goes_on(near, stem, body, top)
    )


def followed(points: Floats, stems: Sequence[FittedStem]) -> tuple[FittedStem, ...]:
    """Stems up to where they end, of several in one column.

    Twigs and other stems hide one from a height on, and a stem that ended there would be taken for
    a stake.

    Parameters
    ----------
    points : (n, 3) float64
        About the foot, of all heights.
    """
    if len(stems) < 2:
        return tuple(stems)
    return tuple(
        replace(stem, high_m=max(stem.high_m, min(rise_of(points, stem).high_m, _SEEN_M)))
        for stem in stems
    )


def _climbed(near: Floats, body: Floats, top: float) -> int:
    """Slabs above a height that show a body."""
    levels = np.arange(top, HIGHEST_M + _STEP_M, _STEP_M)
    return int(climb_kernel(near, np.searchsorted(near[:, 2], levels), body))


def _thinner(near: Floats, body: Floats, top: float) -> Floats:
    """The body without a sleeve about it, if one so much thinner goes on above it."""
    thinner = np.eye(NUMBERS)[4]
    bodies = [body - less * thinner for less in _SLEEVES_M]
    bodies = [one for one in bodies if one[4] > _TOLERANCE_M]
    return max(bodies, key=lambda one: _climbed(near, one, top), default=body)


def _core(points: Floats, body: Floats, top: float) -> float:
    """How much denser points are about the axis above a height than beside it."""
    up = points[:, 2]
    above = points[(up > top) & (up < top + _CORE_HIGH_M)]
    beside = above[:, :2] - body[:2] - (above[:, 2:] - BREAST_M) * body[2:4]
    away = np.hypot(beside[:, 0], beside[:, 1])
    inner = np.count_nonzero(away < _CORE_M)
    outer = np.count_nonzero((away >= _CORE_M) & (away < _ROUND_CORE_M))
    areas = (_ROUND_CORE_M / _CORE_M) ** 2 - 1
    return math.log2(areas * (inner + 1) / (outer + 1))


def _goes_on(near: Floats, stem: FittedStem, body: Floats, top: float) -> float:
    """The share of slabs above a stem that show something about its axis; points rise."""
    beside = near[:, :2] - body[:2] - (near[:, 2:] - BREAST_M) * body[2:4]
    up = near[np.hypot(beside[:, 0], beside[:, 1]) < _CORE_M, 2]
    edges = top + _STEP_M * np.arange(_NEXT + 1)
    slabs = np.diff(np.searchsorted(up, edges))
    of_stem = stem.lines.size * _STEP_M / max(stem.high_m - stem.low_m, _STEP_M)
    return float((slabs > _THINLY * of_stem).mean())


def _within(points: Floats, body: Floats) -> Integers:
    """Points near the body's axis, however high."""
    beside = points[:, :2] - body[:2] - (points[:, 2:] - BREAST_M) * body[2:4]
    wide = body[4] + _BESIDE_M
    return np.flatnonzero((beside**2).sum(axis=1) < wide**2)


@kernel
def climb_kernel(points: Floats, starts: Integers, body: Floats) -> int:
    """How many slabs above each other show the body, hidden ones between included.

    Parameters
    ----------
    points : (n, 3) float64
        About the foot, rising.
    starts : (slabs + 1,) int64
        The first point of each slab.
    """
    last, hidden = 0, 0
    for slab in range(starts.size - 1):
        on, inside, beside = 0, 0, 0
        radius = body[4]
        for point in range(starts[slab], starts[slab + 1]):
            up = points[point, 2] - BREAST_M
            east = points[point, 0] - body[0] - body[2] * up
            north = points[point, 1] - body[1] - body[3] * up
            radius = body[4] + body[5] * up
            off = math.hypot(east, north) - radius
            if abs(off) <= _TOLERANCE_M:
                on += 1
            elif off < 0:
                inside += 1
            elif off < _BESIDE_M:
                beside += 1
        if radius <= 0:
            break
        # Areas of both rings, without what they share.
        share = 4 * radius * _TOLERANCE_M / (_BESIDE_M * (2 * radius + _BESIDE_M))
        if on >= _FEWEST and inside <= _MOST_INSIDE * on and on >= _CHANCE * share * beside:
            last, hidden = slab + 1, 0
        else:
            hidden += 1
            if hidden > _HIDDEN:
                break
    return last
