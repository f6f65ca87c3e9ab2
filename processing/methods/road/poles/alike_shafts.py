"""How many shafts about a low one are like it: bollards stand in rows, and so do posts of fences.

What stands in a row was put there; a stake, a person or the edge of a wall has few of its like.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.methods.road.poles.shafts import Shaft, feet_of

_NEAR_M, _APART_M = 25.0, 0.4
"""Rows are looked for so far along: delineators stand up to 40 m apart, most at 10 m (視線誘導標設
置基準). What is nearer than the second is the same thing."""

_HIGHER, _HIGHER_M = 0.1, 0.08
"""By how much heights of like ones differ, of the height and at least: posts set in uneven ground,
of which one scan line more or less is seen."""

_THICKER, _THICKER_M, _SURE = 0.12, 0.004, 2.0
"""The same of radii, and how many of their standard deviations."""

_MOST = 15
"""As many as a row of bollards about a corner; more say no more."""


def alike_of(shafts: Sequence[Shaft]) -> Floats:
    """(n,) float64: the logarithm to the base 2 of one and the like ones about each, 0 to 4."""
    from scipy.spatial import cKDTree

    if not shafts:
        return np.zeros(0)
    feet = feet_of(shafts)
    pairs = np.asarray(cKDTree(feet).query_pairs(_NEAR_M, output_type="ndarray"), np.int64)
    both = np.concatenate([pairs, pairs[:, ::-1]])
    count = np.bincount(both[_are_alike(shafts, feet, both), 0], minlength=len(shafts))
    alike: Floats = np.log2(1 + np.minimum(count, _MOST))
    return alike


def _are_alike(shafts: Sequence[Shaft], feet: Floats, pairs: Integers) -> Integers:
    """Which pairs are alike, by the measures of the first of each."""
    tops = np.array([one.top_m for one in shafts])
    radii = np.array([one.radius_at(one.top_m / 2) for one in shafts])
    deviations = np.array([one.deviation_m for one in shafts])
    a, b = pairs.T
    thicker = np.maximum(_THICKER * radii[a], _SURE * np.hypot(deviations[a], deviations[b]))
    is_alike = np.abs(tops[a] - tops[b]) < np.maximum(_HIGHER * tops[a], _HIGHER_M)
    is_alike &= np.abs(radii[a] - radii[b]) < np.maximum(thicker, _THICKER_M)
    is_alike &= np.hypot(*(feet[a] - feet[b]).T) > _APART_M
    return np.flatnonzero(is_alike)
