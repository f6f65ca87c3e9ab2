"""The ground that a plate stands on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.methods.road.objects.ground_heights import height_of
from processing.methods.road.objects.sparse_plan import SparsePlan

_DROP_M = 1.8
"""So far below the road beside it the ground under a plate may be none that it stands on: lower
edges of signs hang higher over the road (道路標識設置基準 2-2)."""

_EDGE_M = 1.0
"""How far from the middle of a plate the edge is looked for that it stands on: signs hang over it
by half a width."""


def ground_below(
    place: Floats, road: tuple[float, float], below: tuple[SparsePlan, NDArray[np.float32]]
) -> float:
    """Height of the ground below a plate, m about the origin of the plan; NaN where none is known.

    A plate over the edge of a viaduct, or of a wall that holds the road, stands on that edge; what
    lies below it is as deep as it may be.

    Parameters
    ----------
    place : (3,) float64
        The middle of the plate, m about the origin of the plan.
    road : (float, float)
        Where the vehicle was beside it, m; NaN where nobody knows.
    below : (SparsePlan, NDArray)
        The plan with its ground.
    """
    plan, ground = below
    x, y = place[:2].tolist()
    level = height_of(ground, plan, x, y)
    above = height_of(ground, plan, *road)
    if not level < above - _DROP_M:
        return level
    about = [
        height_of(ground, plan, x + right * _EDGE_M, y + up * _EDGE_M)
        for right in (-1, 0, 1)
        for up in (-1, 0, 1)
    ]
    edges = [one for one in about if one > level + _DROP_M and abs(one - above) < _DROP_M]
    return max(edges, default=level)
