"""Roofs that several shafts carry: of shelters, carports, bicycle stands.

Their posts are as straight and smooth as those of signs, but end together at one height, and
something level leads from one to the next.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.core.arrays import Floats
from processing.methods.road.poles.shafts import Shaft

_LOWEST_M, _HIGHEST_M = 1.8, 4.0
"""Tops of shafts that may carry a roof over people or cars; gantries over roads are higher."""

_NEAR_M, _FAR_M = 0.8, 7.0
"""Between posts of one roof: those of carports stand up to 5.5 m apart."""

_LEVEL_M = 0.3
"""How far tops of posts of one roof differ: its slope for the rain."""

_BELOW_M, _ABOVE_M, _ASIDE_M = 0.3, 0.6, 0.35
"""About the line between two tops: beams hang below, bent sheets rise above it."""

_PIECE_M, _THIN_M = 0.25, 0.25
"""Pieces of that line, and how thick a roof with its beam is in one: a crown is thicker."""


def fellows_of(shafts: Sequence[Shaft]) -> list[Floats]:
    """Of each shaft the others that end as high near it: (k, 2) m from its top in plan."""
    from scipy.spatial import cKDTree

    tops = np.array([(*(one.foot[:2] + one.lean * one.top_m), one.foot[2] + one.top_m)
                     for one in shafts]).reshape(-1, 3)  # fmt: skip
    high = np.array([_LOWEST_M < one.top_m < _HIGHEST_M for one in shafts], np.bool_)
    found: list[Floats] = []
    tree = cKDTree(tops[:, :2]) if len(tops) else None
    for number, top in enumerate(tops):
        if tree is None or not high[number]:
            found.append(np.empty((0, 2)))
            continue
        near = np.array(tree.query_ball_point(top[:2], _FAR_M, return_sorted=True), np.int64)
        beside = tops[near] - top
        away = np.hypot(beside[:, 0], beside[:, 1])
        is_fellow = high[near] & (away > _NEAR_M) & (np.abs(beside[:, 2]) < _LEVEL_M)
        found.append(beside[is_fellow, :2])
    return found


def roof_share(points: Floats, shaft: Shaft, fellows: Floats) -> float:
    """How much of the way to another shaft's top something level fills, as far as it is nearer.

    Parameters
    ----------
    points : (n, 3) float64
        m about its foot; those that are nearer to no other shaft.
    fellows : (k, 2) float64
        As :func:`fellows_of` told it.

    Returns
    -------
    float
        Of the one that it leads to the most, 0 to 1.
    """
    if len(fellows) == 0:
        return 0.0
    above = points[:, 2] - shaft.top_m
    near = points[(above > -_BELOW_M) & (above < _ABOVE_M)]
    level, heights = near[:, :2] - shaft.lean * shaft.top_m, near[:, 2]
    best = 0.0
    for fellow in fellows:
        half = float(np.hypot(*fellow)) / 2
        way = fellow / (2 * half)
        along, across = level @ way, level @ np.array([-way[1], way[0]])
        is_between = (along > 0) & (along < half) & (np.abs(across) < _ASIDE_M)
        pieces = (along[is_between] / _PIECE_M).astype(np.int64)
        count = int(np.ceil(half / _PIECE_M))
        low, high = np.full(count, np.inf), np.full(count, -np.inf)
        np.minimum.at(low, pieces, heights[is_between])
        np.maximum.at(high, pieces, heights[is_between])
        best = max(best, float(((high >= low) & (high - low < _THIN_M)).mean()))
    return best
