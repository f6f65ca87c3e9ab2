"""How high a crown hangs over the carriageway and over the walk.

Both have to be kept free: 4.5 m over a carriageway, 2.5 m over a walk (道路構造令 第12条).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.methods.road.objects.ground_heights import GROUND_M, height_of
from processing.methods.road.objects.sparse_plan import SparsePlan

_FARTHEST_M = 20.0
"""From the vehicle's path to a tree whose crown can hang over the road: two lanes, a walk, and the
radius of a large crown."""

_CURB_M = 0.08
"""Rise from one cell of the ground (0.8 m) to the next that is a curb: a carriageway rises by 10 %
at most (道路構造令 第16条), curbs by 15 to 25 cm."""

_HALF_LANE_M = 3.0
"""Without a curb what lies so near to the vehicle's path is carriageway: half a lane and the next
one's edge (道路構造令 第5条: lanes of 2.75 to 3.5 m)."""

_WALK_M = 3.5
"""Width of a walk that many use (道路構造令 第11条), where no step ends it before."""

_BESIDE_M = 0.25
"""A tree stands so far behind the edge of the carriageway at least (道路構造令 第12条)."""

_STEP_M = 0.4


class Clearances(NamedTuple):
    """Lowest height of a crown over the ground below it, m; NaN where it doesn't hang over."""

    road_m: float
    walk_m: float


class SectionAtTree(NamedTuple):
    """A section through a street at a tree, m from the vehicle's path towards the tree.

    Attributes
    ----------
    start, towards : (2,) float64
        Where the path passes the tree, m about the plan's origin; a metre on from there.
    edge_m : float
        Where the carriageway ends, to half a metre.
    walk_end_m : float
        Where the walk ends; NaN without a curb.
    """

    start: Floats
    towards: Floats
    edge_m: float
    walk_end_m: float


class GroundBelowCrowns:
    """The ground of a street, and where vehicles drove on it.

    Parameters
    ----------
    ground : (tiles, 16, 16) float32
        As `processing.methods.road.objects.ground_heights` found it.
    driven : (n, 2) float64
        Places along the vehicle's paths, m about the plan's origin.
    """

    def __init__(self, plan: SparsePlan, ground: NDArray[np.float32], driven: Floats) -> None:
        self._plan, self._ground, self._driven = plan, ground, driven
        self._tree = cKDTree(driven) if len(driven) else None

    def clearances(self, foot: Floats, underside: Floats) -> Clearances:
        """Of a crown.

        Parameters
        ----------
        foot : (3,) float64
            Of the tree, m about the plan's origin.
        underside : (n, 3) float64
            The crown from below, m about the same.
        """
        section = self._section_at(foot[:2])
        if section is None or not len(underside):
            return Clearances(np.nan, np.nan)
        along = (underside[:, :2] - section.start) @ section.towards
        over = underside[:, 2] - self._heights(underside[:, :2])
        is_road = (along > -_HALF_LANE_M) & (along < section.edge_m)
        is_walk = (along > section.edge_m) & (along < section.walk_end_m)
        return Clearances(_least(over[is_road]), _least(over[is_walk]))

    def _section_at(self, foot: Floats) -> SectionAtTree | None:
        """None too far from the path, or without one."""
        if self._tree is None:
            return None
        start = self._driven[int(self._tree.query(foot)[1])]
        away = float(np.hypot(*(foot - start)))
        if not _BESIDE_M < away <= _FARTHEST_M:
            return None
        towards = (foot - start) / away
        places = np.arange(0.0, away + _WALK_M + GROUND_M, _STEP_M)
        heights = self._heights(start + places[:, None] * towards)
        ahead = round(GROUND_M / _STEP_M)
        rises = heights[ahead:] - heights[:-ahead]
        # A cell with a curb in it shows the lower side, so the step comes out behind it.
        steps = places[:-ahead] + _STEP_M / 2
        curbs = steps[(rises >= _CURB_M) & (steps <= away)]
        if not curbs.size:
            return SectionAtTree(start, towards, min(_HALF_LANE_M, away - _BESIDE_M), np.nan)
        edge = float(curbs[0])
        ends = steps[(np.abs(rises) >= _CURB_M) & (steps > edge + 2 * GROUND_M)]
        return SectionAtTree(start, towards, edge, min([edge + _WALK_M, *ends.tolist()]))

    def _heights(self, places: Floats) -> Floats:
        return np.array([height_of(self._ground, self._plan, *one) for one in places.tolist()])


def _least(heights: Floats) -> float:
    known = heights[np.isfinite(heights)]
    return float(known.min()) if known.size else float("nan")
