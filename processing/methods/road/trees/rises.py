"""How far a stem goes on upwards, straight and as round as below: posts do to their end.

A trunk forks, bends and thins where its crown begins. A lamp post under a neighbour's crown goes
on through it, a sign post ends below.
"""

from __future__ import annotations

import math

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.trees.cone_kernels import NUMBERS, settle_kernel
from processing.methods.road.trees.stems import BREAST_M, FittedStem

HIGHEST_M = 8.0
"""Above the foot: what goes on straight up to there is no trunk with branches below."""

_STEP_M = 0.2
"""Scan lines lie nearer to each other on what is 8 m high beside the road."""

_TOLERANCE_M = 0.015
"""From the surface: the noise, and what lean and taper of the piece below leave open."""

_BESIDE_M = 0.3
"""Beyond the surface: leaves there tell how many would lie near it by chance."""

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

_SHAPE_M = 0.003


def rise_of(points: Floats, stem: FittedStem) -> float:
    """The height above the foot up to which a stem goes on as it is.

    Parameters
    ----------
    points : (n, 3) float64
        About the foot, of all heights.
    """
    body = np.zeros(NUMBERS)
    body[:2], body[2:4] = stem.middle_at(BREAST_M), stem.lean
    body[4], body[5] = stem.radius_m, -stem.taper
    near = points[_within(points, body)]
    near = near[np.argsort(near[:, 2], kind="stable")]
    top = stem.high_m
    for _ in range(_ROUNDS):
        levels = np.arange(top, HIGHEST_M + _STEP_M, _STEP_M)
        starts = np.searchsorted(near[:, 2], levels)
        last = climb_kernel(near, starts, body)
        if last == 0:
            break
        top = float(levels[last])
        whole = near[(near[:, 2] >= stem.low_m) & (near[:, 2] <= top)] - (0.0, 0.0, BREAST_M)
        fitted = body.copy()
        room = np.empty(len(whole)), np.zeros(len(whole), np.bool_)
        _, noise = settle_kernel(whole, _SHAPE_M, fitted, *room)
        if noise > 0 and abs(fitted[4] - body[4]) < _TOLERANCE_M:
            body = fitted
    return min(top, HIGHEST_M)


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
