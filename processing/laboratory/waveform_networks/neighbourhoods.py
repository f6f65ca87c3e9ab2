"""Neighbourhoods of a patch: representatives, their balls, and the way back to all points.

1. Representatives: from a first point always the one that is farthest from those chosen.
2. Ball query: the first members of a representative's ball in the order of the level before. There
   representatives stand in the order in which they were chosen, so the first of a ball are spread
   over all of it.
3. Interpolation: the three nearest representatives, weighted by one over the squared distance.

References
----------
Shinohara 2022, section 3.3.2; Qi et al. 2017, “PointNet++”, sections 3.2 and 3.4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Integers
from processing.core.kernels import kernel
from processing.laboratory.waveform_networks.sizes import NetworkSizes

F32 = NDArray[np.float32]

_INTERPOLATED = 3
_LEAST_SQUARE_M = 1e-8


@dataclass(frozen=True, eq=False)
class PatchLevel:
    """Representatives of the points of the level before.

    Attributes
    ----------
    chosen : (r,) int64
        Which of the points before.
    members : (r, n) int64
        Points before in each ball; the first stands again where there are fewer.
    offsets : (r, n, 3) float32
        Members from their representative, m.
    nearest : (p, k) int64
        Of each point before the nearest representatives, three where there are as many.
    weights : (p, k) float32
        Theirs; they sum to 1.
    """

    chosen: Integers
    members: Integers
    offsets: F32
    nearest: Integers
    weights: F32


def levels_of(xyz: F32, sizes: NetworkSizes, first: int = 0) -> list[PatchLevel]:
    """The levels of the encoder over a patch.

    Parameters
    ----------
    xyz : (p, 3) float32
        m from the patch's middle.
    first : int
        The point that representatives begin with.
    """
    found, points = [], np.ascontiguousarray(xyz, np.float32)
    asked = zip(sizes.representatives, sizes.radii_m, sizes.members, strict=True)
    for representatives, radius_m, most in asked:
        chosen = farthest_points(points, min(representatives, len(points)), first)
        centres = points[chosen]
        members = ball_members(points, chosen, radius_m, most)
        offsets = points[members] - centres[:, None]
        found.append(PatchLevel(chosen, members, offsets, *interpolation(points, centres)))
        points, first = centres, 0
    return found


def farthest_points(xyz: F32, count: int, first: int = 0) -> Integers:
    """(count,) int64: points of (p, 3), each the farthest from those before it."""
    chosen = np.zeros(count, np.int64)
    _choose_farthest(np.ascontiguousarray(xyz, np.float32), first, chosen)
    return chosen


def ball_members(xyz: F32, chosen: Integers, radius_m: float, most: int) -> Integers:
    """(r, most) int64: the first points within a radius of chosen ones, themselves among them.

    Where there are fewer the first stands again.
    """
    members = np.zeros((chosen.size, most), np.int64)
    _fill_balls(np.ascontiguousarray(xyz, np.float32), chosen, np.float32(radius_m), members)
    return members


def interpolation(xyz: F32, centres: F32) -> tuple[Integers, F32]:
    """(p, k) int64 nearest of the centres (r, 3), and (p, k) float32 their weights."""
    count = min(_INTERPOLATED, len(centres))
    distances, nearest = cKDTree(centres).query(xyz, k=list(range(1, count + 1)))
    weights = 1.0 / np.maximum(np.asarray(distances, np.float64) ** 2, _LEAST_SQUARE_M)
    weights /= weights.sum(axis=1, keepdims=True)
    return np.asarray(nearest, np.int64), weights.astype(np.float32)


@kernel
def _choose_farthest(xyz: F32, first: int, chosen: Integers) -> None:
    squares = np.full(len(xyz), np.inf, np.float32)
    at = first
    for number in range(len(chosen)):
        chosen[number] = at
        farthest, greatest = at, np.float32(-1.0)
        for point in range(len(xyz)):
            east = xyz[point, 0] - xyz[at, 0]
            north = xyz[point, 1] - xyz[at, 1]
            up = xyz[point, 2] - xyz[at, 2]
            squares[point] = min(squares[point], east * east + north * north + up * up)
            if squares[point] > greatest:
                farthest, greatest = point, squares[point]
        at = farthest


@kernel
def _fill_balls(xyz: F32, chosen: Integers, radius_m: np.float32, members: Integers) -> None:
    most = members.shape[1]
    for number in range(len(chosen)):
        at, found = chosen[number], 0
        for point in range(len(xyz)):
            east = xyz[point, 0] - xyz[at, 0]
            north = xyz[point, 1] - xyz[at, 1]
            up = xyz[point, 2] - xyz[at, 2]
            if east * east + north * north + up * up <= radius_m * radius_m:
                members[number, found] = point
                found += 1
                if found == most:
                    break
        if found == 0:  # a chosen point that isn't a number
            members[number, 0] = at
            found = 1
        for place in range(found, most):
            members[number, place] = members[number, 0]
