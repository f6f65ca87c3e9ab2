"""A template laid on the points of one slab.

Where a constant says “by trial”, it was set on the left head of a simulated town street; no
measurement varied it alone. Scores of all values together are in docs/accuracy.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.methods.templates.fit_kernels import (
    HEIGHT,
    OFFSET,
    POSE,
    TILT,
    ExpectedPose,
    ScoreLimits,
    refine_kernel,
    score_kernel,
    search_kernel,
)
from processing.methods.templates.shape import FittableTemplate
from processing.methods.templates.slab import SlabPoints

_Floats = NDArray[np.float64]

_FEWEST = 12
"""Points of a slab that can show a shape; by trial."""

_SEARCHED_POINTS = 400
"""Points by which the poses of a search are compared; by trial, it only finds where to begin."""

_SEARCH_STEP_M = 0.02
"""From one pose of a search to the next: the usual tolerance, so that none is passed over."""

_SEARCH_TOLERANCES = 1.5
"""Tolerance of a search, in the template's: the best pose may lie between two that are tried."""

_SEARCHED_AT_ONCE = 250
"""Poses between two checks: some 10 ms."""

TILTS_RAD = (0.0, math.radians(-3.0), math.radians(3.0))
"""Searched where nothing is known of the tilt."""

_LOOKED_THROUGH, _BEST_KEPT, _APART_STEPS = 200, 3, 2
"""Of a search's poses, how many of the best are looked through, how many are refined, and by how
many steps these lie apart; by trial."""

_UNDETERMINED = 0.5
"""A shape that fits as well beside its position, as a level piece of road, scores no more."""

_ASIDE_TOLERANCES = 3.0
"""How far aside it is tried for that: out of what the tolerance covers."""

_CONTRAST_WEIGHT = 5.0
"""By which a score may be higher than ``_UNDETERMINED`` for what it is higher than aside: a tenth
more is a full score. By trial."""

_AWAY_COSTS = 0.10
"""Of the score, at the end of what is searched: of two alike the nearer is meant. By trial."""


@dataclass(frozen=True)
class PoseFit:
    """How a template lies in a slab.

    Attributes
    ----------
    pose : (POSE,) float64
        See `fit_kernels`.
    score : float
        0 to 1.
    seen : float
        Share of the shape's length with points near it.
    """

    pose: _Floats
    score: float
    seen: float


@dataclass(frozen=True)
class PosePrior:
    """What is known before a fit.

    Attributes
    ----------
    pose, spread : (POSE,) float64
        The pose expected and its standard deviations.
    """

    pose: _Floats
    spread: _Floats


def refine_pose(shape: FittableTemplate, slab: SlabPoints, expected: PosePrior) -> PoseFit:
    """The pose nearest to the one expected."""
    return _refine_from(shape, slab, expected, expected.pose)


def search_pose(
    shape: FittableTemplate,
    slab: SlabPoints,
    expected: PosePrior,
    reach: tuple[float, float],
    tilts: tuple[float, ...] = (0.0,),
    *,
    monitor: Monitor,
) -> PoseFit:
    """The best pose within some offset and height of the one expected; nearer ones go before.

    Parameters
    ----------
    tilts : tuple of float
        Tried besides, from the one expected, rad.

    Raises
    ------
    Cancelled
    """
    if slab.points.size < _FEWEST:
        return _nothing(expected)
    poses = _grid(expected.pose, reach, tilts)
    scores = np.empty(len(poses))
    step = float(max(1, slab.points.size // _SEARCHED_POINTS))
    limits = ScoreLimits(_SEARCH_TOLERANCES * shape.tolerance_m, shape.reach_m, step)
    for first in range(0, len(poses), _SEARCHED_AT_ONCE):
        monitor.check()
        some = slice(first, first + _SEARCHED_AT_ONCE)
        search_kernel(slab.local, poses[some], shape.segments, shape.zones, limits, scores[some])
    away = (poses - expected.pose)[:, [OFFSET, HEIGHT]] / np.maximum(reach, _SEARCH_STEP_M)
    scores -= _AWAY_COSTS * (away**2).sum(axis=1)
    best = _nothing(expected)
    for start in _far_apart(poses, scores):
        monitor.check()
        moved = PosePrior(poses[start], expected.spread)
        found = _refine_from(shape, slab, moved, poses[start])
        if found.score > best.score:
            best = found
    return best


def _refine_from(
    shape: FittableTemplate, slab: SlabPoints, expected: PosePrior, start: _Floats
) -> PoseFit:
    if slab.points.size < _FEWEST:
        return _nothing(expected)
    pose = start.copy()
    prior = ExpectedPose(expected.pose, expected.spread)
    refine_kernel(slab.local, pose, prior, shape.segments, shape.tolerance_m)
    score, seen = _score(shape, slab, pose)
    if score > _UNDETERMINED:
        cos, sin = math.cos(pose[TILT]), math.sin(pose[TILT])
        across, up = shape.weak_direction
        aside = _ASIDE_TOLERANCES * shape.tolerance_m
        shift = np.zeros(POSE)
        shift[OFFSET] = aside * (across * cos - up * sin)
        shift[HEIGHT] = aside * (across * sin + up * cos)
        beside = max(_score(shape, slab, pose + side * shift)[0] for side in (1, -1))
        score = min(score, _UNDETERMINED + _CONTRAST_WEIGHT * max(0.0, score - beside))
    return PoseFit(pose, score, seen)


def _score(shape: FittableTemplate, slab: SlabPoints, pose: _Floats) -> tuple[float, float]:
    limits = ScoreLimits(shape.tolerance_m, shape.reach_m, 1.0)
    found = score_kernel(slab.local, pose, shape.segments, shape.zones, limits)
    return float(found.score), float(found.seen)


def _nothing(expected: PosePrior) -> PoseFit:
    return PoseFit(expected.pose.copy(), 0.0, 0.0)


def _grid(middle: _Floats, reach: tuple[float, float], tilts: tuple[float, ...]) -> _Floats:
    """(m, POSE) poses over offset, height and tilt."""
    offsets, heights = (
        np.arange(-round(one / _SEARCH_STEP_M), round(one / _SEARCH_STEP_M) + 1) * _SEARCH_STEP_M
        for one in reach
    )
    grid = np.array(np.meshgrid(offsets, heights, tilts, indexing="ij")).reshape(3, -1)
    poses = np.tile(middle, (grid.shape[1], 1))
    poses[:, OFFSET] += grid[0]
    poses[:, HEIGHT] += grid[1]
    poses[:, TILT] += grid[2]
    return poses


def _far_apart(poses: _Floats, scores: _Floats) -> list[int]:
    """The best few poses that aren't neighbours."""
    chosen: list[int] = []
    for number in np.argsort(-scores)[:_LOOKED_THROUGH].tolist():
        steps = [np.abs(poses[number] - poses[one])[[OFFSET, HEIGHT]].max() for one in chosen]
        if not steps or min(steps) > _APART_STEPS * _SEARCH_STEP_M:
            chosen.append(number)
        if len(chosen) == _BEST_KEPT:
            break
    return chosen
