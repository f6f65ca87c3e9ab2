"""Where the ground lies about the foot of a column, to a centimetre or two."""

from __future__ import annotations

import itertools

import numpy as np

from processing.core.arrays import Floats, Integers

_RINGS_M = (0.03, 0.15, 0.3, 0.5, 0.9)
"""Edges of rings about the column's surface: soil is heaped up about trunks, so the nearest ring
tells most, but it may hold only grass and shoots."""

_HEAP = 0.15
"""Rise over run at which the ground may rise towards a column: soil in a tree pit."""

_ABOUT_M = 0.5
"""How far the ground there may be off the coarse map: a curb, a tree pit, the map's own error."""

_SECTORS = 8
"""Of 45 degrees: each tells its own height, so that grass or a curb on one side don't count."""

_LEAST_SECTORS, _FEWEST = 3, 3
"""Of a ring that tells a height, and points of a sector: a column hides what lies behind it."""

_LOW_SHARE = 0.1
"""Of a sector's points: what lies higher is grass, leaves and things."""


def foot_height(points: Floats, axis: Floats, coarse_m: float, radius_m: float = 0.0) -> float:
    """Height of the ground about an axis.

    Parameters
    ----------
    points : (n, 3) float64
        m about any origin.
    axis : (2,) float64
        Of the column near its foot, about the same.
    coarse_m : float
        The ground of the coarse map.
    radius_m : float
        Of the column.

    Returns
    -------
    float
        The lowest of what rings about the column tell, each the median over sectors of their low
        points, raised by what soil may be heaped up; ``coarse_m`` where none was measured.
    """
    beside = points[:, :2] - axis
    away = np.hypot(beside[:, 0], beside[:, 1]) - radius_m
    asked = np.abs(points[:, 2] - coarse_m) < _ABOUT_M
    asked &= (away > _RINGS_M[0]) & (away < _RINGS_M[-1])
    turn = np.arctan2(beside[asked, 1], beside[asked, 0]) / (2 * np.pi) + 0.5
    sectors = (turn * _SECTORS).astype(np.int64) % _SECTORS
    heights, away = points[asked, 2], away[asked]
    told: list[float] = []
    for inner, outer in itertools.pairwise(_RINGS_M):
        is_in = (away >= inner) & (away < outer)
        lows = _lows(heights[is_in], sectors[is_in])
        if len(lows) >= _LEAST_SECTORS:
            told.append(float(np.median(lows)) + _HEAP * (inner + outer) / 2)
    return min(told) if told else coarse_m


def _lows(heights: Floats, sectors: Integers) -> list[float]:
    """Low points of the sectors that have enough."""
    counts = np.bincount(sectors, minlength=_SECTORS)
    return [
        float(np.quantile(heights[sectors == number], _LOW_SHARE))
        for number in np.flatnonzero(counts >= _FEWEST).tolist()
    ]
