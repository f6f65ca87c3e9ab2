"""What makes a trunk's diameter less sure than its points tell.

Standard deviations of fitted bodies hold while the body is the trunk: where one stem of several was
missed, or leaves and wraps lie about it, the error is of another size. How much wider 95 of 100
errors lie is learnt from known trunks.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from processing.methods.road.trees.cone_kernels import FREE_SLAB_M
from processing.methods.road.trees.stems import FittedStem

_USUAL_M, _LONG_M, _USUAL_DENSITY = 0.2, 2.0, 2_000.0
"""Diameter and density on bark about which facts are told, and the length that is no surer."""

# Learnt by `python -m processing.laboratory.road_training.tree_training`: the 95th per cent of
# errors over what the fit alone tells (Koenker and Bassett 1978, Regression quantiles).
WEIGHTS = (0.07, -0.11, 0.53, 2.39, -0.24)
"""A constant, and in the order of the causes."""


class ErrorCauses(NamedTuple):
    """What speaks for errors beyond those of the fit.

    Attributes
    ----------
    thick : float
        Natural logarithm of the diameter over 0.2 m.
    crowded : float
        Share of a stem's length along which something stands beside it.
    short_m : float
        What its seen piece lacks of 2 m.
    dense : float
        Decimal logarithm of the points on its surface over 2,000 a square metre.
    """

    thick: float
    crowded: float
    short_m: float
    dense: float


def causes_of(stems: Sequence[FittedStem], diameter_m: float) -> ErrorCauses:
    """What makes a trunk's diameter unsure, in the mean of its stems."""
    seen = np.array([one.high_m - one.low_m for one in stems])
    slabs = np.array([one.free_slabs for one in stems])
    density = np.array([one.density for one in stems])
    free = slabs * FREE_SLAB_M / np.maximum(seen, FREE_SLAB_M / 2)
    return ErrorCauses(
        thick=math.log(max(diameter_m, _USUAL_M / 10) / _USUAL_M),
        crowded=float(1.0 - np.minimum(free, 1.0).mean()),
        short_m=float(np.maximum(0.0, _LONG_M - seen).mean()),
        dense=float(np.log10(np.maximum(density, 10.0) / _USUAL_DENSITY).mean()),
    )


def wider(causes: ErrorCauses) -> float:
    """How many times as wide as by the fit alone 95 of 100 errors lie, 1 and more."""
    told = sum(weight * one for weight, one in zip(WEIGHTS, (1.0, *causes), strict=True))
    return math.exp(max(0.0, told))
