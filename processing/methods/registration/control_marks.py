"""What shows the place of a control point in plan: the corner of a marking, the foot of a pole."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats

_AROUND_M = 0.5
_SOFTNESS_M = (0.04, 0.012)
"""Half the width over which a beam goes from asphalt to paint: wide first, so that edges a few
centimetres away are felt, then half a beam's width."""

_SIDES_M = ((0.15, 0.6), (0.6, 0.15), (0.6, 0.6))
"""What paint may go on for on either side of a corner: along and across a line, or a field."""

_CLOSE_M = 0.15
"""A corner farther from where it is looked for is another one: a line is some 15 cm wide."""

_NEAREST_M = 0.07
"""Of two corners that are told alike the nearer one is meant: one this far must be told twice as
well as one at the place itself."""

_FEWEST, _MOST = 60, 6000
_EXPLAINED = 0.55
"""Of the variance of the intensities: less is no corner."""

_CONTRAST = 1.25
_ALIKE = 4.0
"""Points of one scan line share what they are off by: so many count as one."""

_FOOT_M = 0.6
_HEIGHTS_M = (0.15, 1.8)
_THICKEST_M = 0.4
_ROUND_M = 0.012
"""Scatter of points about a pole's shaft that is still a shaft."""

_SLIMMEST_M = 0.015
_LEAN = 0.06

_DESCENTS, _STUCK, _ASIDE = 30, 1e6, 1e-5


@dataclass(frozen=True, eq=False)
class FoundMark:
    """A mark in the points.

    Attributes
    ----------
    kind : str
        ``corner`` or ``foot``.
    offset : (2,) float64
        Where it lies, m from where it was looked for.
    sigma_m : float
        Of either coordinate.
    """

    kind: str
    offset: Floats
    sigma_m: float


def find_corner(xy: Floats, tone: Floats) -> FoundMark | None:
    """The corner of a rectangle of paint nearest to the origin.

    Parameters
    ----------
    xy : (n, 2) float64
        Points of the road, m.
    tone : (n,) float64
        Intensities, those of asphalt about 1.
    """
    near = np.abs(xy).max(axis=1) < _AROUND_M
    xy, tone = xy[near], np.asarray(tone[near], np.float64)
    step = max(1, tone.size // _MOST)
    xy, tone = xy[::step], tone[::step]
    if tone.size < _FEWEST:
        return None
    dark, bright = np.percentile(tone, [20, 95])
    if bright < _CONTRAST * dark:
        return None
    level = np.clip((tone - dark) / (bright - dark), -0.2, 1.2)
    best, best_cost = None, np.inf
    for turn in np.radians(_directions(xy, level)):
        for sides in _SIDES_M:
            start = np.array([0.0, 0.0, turn, *sides, 0.0, 1.0])
            for soft in _SOFTNESS_M:
                fit = _fit(_paint_misfit_of(xy, level, soft), start, 0.3)
                start = fit.unknown
            away = float(np.hypot(fit.unknown[0], fit.unknown[1]))
            cost = fit.cost * (1 + (away / _NEAREST_M) ** 2)
            if away < _CLOSE_M and min(fit.unknown[3:5]) > 0.05 and cost < best_cost:
                best, best_cost = fit, cost
    if best is None:
        return None
    misfit = _paint_misfit(best.unknown, xy, level, _SOFTNESS_M[-1])
    explained = 1.0 - float(np.var(misfit) / np.var(level))
    if explained < _EXPLAINED or best.unknown[6] < 0.4:
        return None
    spread = best.cofactors * float(np.var(misfit)) * _ALIKE
    sigma = float(np.sqrt(max(spread[0, 0] + spread[1, 1], 0.0) / 2))
    return FoundMark("corner", best.unknown[:2].copy(), max(sigma, 0.002))


def _paint_misfit_of(xy: Floats, level: Floats, soft: float) -> Callable[[Floats], Floats]:
    return lambda unknown: _paint_misfit(unknown, xy, level, soft)


def _paint_misfit(unknown: Floats, xy: Floats, level: Floats, soft: float) -> Floats:
    east, north, turn, long, wide, asphalt, paint = unknown
    cosine, sine = np.cos(turn), np.sin(turn)
    along = (xy[:, 0] - east) * cosine + (xy[:, 1] - north) * sine
    across = -(xy[:, 0] - east) * sine + (xy[:, 1] - north) * cosine
    inside = _between(along, long, soft) * _between(across, wide, soft)
    return np.asarray(asphalt + (paint - asphalt) * inside - level)


def _between(at: Floats, end: float, soft: float) -> Floats:
    """1 from 0 to ``end``, 0 elsewhere, and soft in between."""
    return np.asarray(0.5 * (np.tanh(at / soft / 2) - np.tanh((at - end) / soft / 2)))


def _directions(xy: Floats, level: Floats) -> Floats:
    """Degrees in which the sides of paint may go from the corner."""
    paint = xy[level > 0.5]
    if paint.shape[0] < 8:
        return np.empty(0)
    turns = np.arange(0.0, 90.0, 3.0)
    # Sides of paint are sharp: turned by their direction, paint begins and ends in one bin.
    sharpness = []
    for turn in np.radians(turns):
        along = paint @ np.array([np.cos(turn), np.sin(turn)])
        across = paint @ np.array([-np.sin(turn), np.cos(turn)])
        counts = [np.histogram(one, np.arange(-0.6, 0.62, 0.02))[0] for one in (along, across)]
        sharpness.append(sum(float(np.abs(np.diff(one)).max()) for one in counts))
    best = turns[int(np.argmax(sharpness))]
    return np.asarray(best + np.arange(4) * 90.0)


def find_foot(xyz: Floats) -> FoundMark | None:
    """Where the axis of a pole meets the height of the origin, nearest to it.

    Parameters
    ----------
    xyz : (n, 3) float64
        m about the place.
    """
    high = (xyz[:, 2] > _HEIGHTS_M[0]) & (xyz[:, 2] < _HEIGHTS_M[1])
    near = high & (np.hypot(xyz[:, 0], xyz[:, 1]) < _FOOT_M)
    points = xyz[near]
    if points.shape[0] < _FEWEST // 2:
        return None
    start = np.array([0.0, 0.0, 0.0, 0.0, 0.08])
    for scale in (0.05, 0.01, 0.004):
        fit = _fit(lambda unknown: _shaft_misfit(unknown, points), start, scale)
        start = fit.unknown
    off = _shaft_misfit(start, points)
    is_on = np.abs(off) < 3 * _ROUND_M
    scatter = 1.4826 * float(np.median(np.abs(off[is_on]))) if is_on.any() else np.inf
    radius = float(start[4])
    is_shaft = (
        scatter < _ROUND_M
        and is_on.sum() > max(_FEWEST // 3, 0.4 * off.size)
        and _SLIMMEST_M < radius < _THICKEST_M
        and np.hypot(start[0], start[1]) < 2 * _CLOSE_M
        and np.abs(start[2:4]).max() < _LEAN
        and np.ptp(points[is_on, 2]) > 0.5
    )
    if not is_shaft:
        return None
    spread = fit.cofactors * scatter**2 * _ALIKE
    sigma = float(np.sqrt(max(spread[0, 0] + spread[1, 1], 0.0) / 2))
    return FoundMark("foot", start[:2].copy(), max(sigma, 0.003))


@dataclass(frozen=True, eq=False)
class _Fit:
    """Unknowns that fit best, the cost that is left, and the inverse of the normal matrix."""

    unknown: Floats
    cost: float
    cofactors: Floats


def _fit(misfit: Callable[[Floats], Floats], start: Floats, scale: float) -> _Fit:
    """Levenberg and Marquardt's descent with Cauchy's weights.

    Few unknowns and many points: normal equations of a handful of rows need no library's threads.
    """
    unknown, damping = start.astype(np.float64), 1e-3
    off = misfit(unknown)
    cost = _cost(off, scale)
    normal = np.eye(unknown.size)
    for _ in range(_DESCENTS):
        slopes = np.stack([_slope(misfit, unknown, off, one) for one in range(unknown.size)])
        weight = 1.0 / (1.0 + (off / scale) ** 2)
        normal = np.einsum("in,jn->ij", slopes * weight, slopes)
        towards = np.einsum("in,n->i", slopes, weight * off)
        damped = normal + damping * np.diag(np.diag(normal) + 1e-12)
        step = np.linalg.lstsq(damped, -towards, rcond=None)[0]
        moved = misfit(unknown + step)
        moved_cost = _cost(moved, scale)
        if moved_cost > cost:
            damping *= 10.0
            if damping > _STUCK:
                break
            continue
        is_there = cost - moved_cost < 1e-6 * cost
        unknown, off, cost, damping = unknown + step, moved, moved_cost, damping / 5.0
        if is_there:
            break
    return _Fit(unknown, cost, np.asarray(np.linalg.pinv(normal), np.float64))


def _slope(misfit: Callable[[Floats], Floats], unknown: Floats, off: Floats, one: int) -> Floats:
    beside = unknown.copy()
    beside[one] += _ASIDE
    return np.asarray((misfit(beside) - off) / _ASIDE)


def _cost(off: Floats, scale: float) -> float:
    return float(np.log1p((off / scale) ** 2).sum() * scale**2 / 2)


def _shaft_misfit(unknown: Floats, points: Floats) -> Floats:
    east = points[:, 0] - unknown[0] - unknown[2] * points[:, 2]
    north = points[:, 1] - unknown[1] - unknown[3] * points[:, 2]
    return np.asarray(np.hypot(east, north) - unknown[4])
