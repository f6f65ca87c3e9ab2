"""Stems of a tree that show too little for circles: thin, far, half hidden by a hedge.

Where one stem of a tree is known, others like it are looked for: a few points in each slab, no
wider than a stem and standing free, that follow a line which leaves the ground with the known one
and parts from it upwards. Branches that begin above the tape don't point to its foot.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

_WIDEST, _APART = 3.0, 1.0
"""Width of the points of a slab over the radius of the known stem, and the gap about them: its
diameter, noise, and what a lean of 20 degrees moves it within a slab."""

_CELLS = 2
"""Cells of a gap, in which points are counted as one: dense scanners show thousands of a shrub."""

_FEWEST = 2
"""Points of a piece: a scan line of a far scanner shows so many of a thin stem."""

_MOST = 40
"""Pieces of a slab; where more are, leaves or shrubs are."""

_FEWEST_PIECES, _FILLED = 7, 0.7
"""Pieces on a line, every 0.1 m, and their share of the slabs between the first and the last."""

_STEEPEST = 0.4
"""Run over rise: 22 degrees."""

_NEAR_M, _FAR_M = 0.35, 1.05
"""How far above each other two pieces lie that tell a line."""

_STEP_M, _HIGH_M = 0.1, 2.6
"""From slab to slab, and the highest one."""

CLUMP_M = 0.7
"""Axes of stems of one tree are so near to each other at the foot: they rise from one root, and the
tree takes no more of a planting strip of 1.5 m (道路構造令 第11条の4: 植樹帯)."""

PARTS = 0.1
"""Run over rise by which they move apart: 6 degrees, which two posts beside each other don't."""


def pieces_of(points: Floats, heights: Floats, thick_m: float, radius_m: float) -> Floats:
    """Small groups of points of level slabs: (n, 3) float64, height and middle in plan, rising.

    Parameters
    ----------
    points : (n, 3) float64
        m about the foot.
    heights : (k,) float64
        Of the slabs' middles.
    radius_m : float
        Of the known stem.
    """
    found: list[Floats] = [np.empty((0, 3))]
    order = np.argsort(points[:, 2], kind="stable")
    rising = points[order]
    first = np.searchsorted(rising[:, 2], heights - thick_m / 2)
    end = np.searchsorted(rising[:, 2], heights + thick_m / 2)
    for height, low, high in zip(heights, first, end, strict=True):
        plan = rising[low:high, :2]
        if len(plan) < _FEWEST:
            continue
        groups = _groups(plan, _APART * radius_m)
        counts = np.bincount(groups)
        sums = np.column_stack([np.bincount(groups, plan[:, one]) for one in (0, 1)])
        middles = sums / counts[:, None]
        away = np.hypot(*(plan - middles[groups]).T)
        widest = np.zeros(counts.size)
        np.maximum.at(widest, groups, away)
        small = np.flatnonzero((counts >= _FEWEST) & (2 * widest < _WIDEST * radius_m))
        if small.size <= _MOST:
            found.append(np.column_stack([np.full(small.size, height), middles[small]]))
    return np.concatenate(found)


def _groups(plan: Floats, apart_m: float) -> Integers:
    """The group of each place: those nearer to each other than so much, about, are of one."""
    cells = np.floor(plan / (apart_m / _CELLS)).astype(np.int64)
    filled, cell_of = np.unique(cells, axis=0, return_inverse=True)
    pairs = cKDTree(filled).query_pairs(_CELLS, output_type="ndarray")
    ties = coo_matrix((np.ones(len(pairs)), pairs.T), (len(filled),) * 2)
    groups: Integers = connected_components(ties, directed=False)[1][cell_of].astype(np.int64)
    return groups


def lines_of(pieces: Floats, axis: Floats, off_m: float) -> list[Floats]:
    """The pieces of each line that leaves the ground with a known stem and parts from it.

    Parameters
    ----------
    pieces : (n, 3) float64
        Rising.
    axis : (4,) float64
        The known stem's: east and north at the foot, and what they change in a metre of height.
    off_m : float
        How far off a line a piece may lie.
    """
    left = np.ones(len(pieces), np.bool_)
    lines: list[Floats] = []
    while np.count_nonzero(left) >= _FEWEST_PIECES:
        mine = np.zeros(len(pieces), np.bool_)
        if not line_kernel(pieces, left, axis, off_m, mine):
            break
        lines.append(pieces[mine])
        left &= ~mine
    return lines


@kernel
def line_kernel(
    pieces: Floats, left: NDArray[np.bool_], axis: Floats, off_m: float, mine: NDArray[np.bool_]
) -> int:
    """Mark the pieces of the line that the most lie on; how many, 0 where none is one.

    Parameters
    ----------
    left : (n,) bool
        Which pieces are of no line yet.
    mine : (n,) bool
        Written.
    """
    best = 0
    on = np.zeros(len(pieces), np.bool_)
    for one in range(len(pieces)):
        for other in range(one + 1, len(pieces)):
            rise = pieces[other, 0] - pieces[one, 0]
            if not (left[one] and left[other] and _NEAR_M < rise < _FAR_M):
                continue
            east = (pieces[other, 1] - pieces[one, 1]) / rise
            north = (pieces[other, 2] - pieces[one, 2]) / rise
            if np.hypot(east, north) > _STEEPEST:
                continue
            foot_east = pieces[one, 1] - east * pieces[one, 0] - axis[0]
            foot_north = pieces[one, 2] - north * pieces[one, 0] - axis[1]
            away = np.hypot(foot_east, foot_north)
            apart = np.hypot(
                foot_east + _HIGH_M * (east - axis[2]), foot_north + _HIGH_M * (north - axis[3])
            )
            if away > CLUMP_M or apart - away < _HIGH_M * PARTS:
                continue
            count = _on_kernel(pieces, left, (one, other), off_m, on)
            if count > best:
                best = count
                mine[:] = on
    return best


@kernel
def _on_kernel(
    pieces: Floats,
    left: NDArray[np.bool_],
    pair: tuple[int, int],
    off_m: float,
    on: NDArray[np.bool_],
) -> int:
    """Mark the nearest piece of each slab on a line; how many, 0 where too few are on it."""
    one, other = pieces[pair[0]], pieces[pair[1]]
    rise = other[0] - one[0]
    on[:] = False
    count, nearest, height = 0, -1, -1.0
    low, high, off = 0.0, 0.0, off_m
    for at in range(len(pieces)):
        if not left[at]:
            continue
        if pieces[at, 0] != height:
            height, nearest, off = pieces[at, 0], -1, off_m
        share = (height - one[0]) / rise
        east = pieces[at, 1] - one[1] - share * (other[1] - one[1])
        north = pieces[at, 2] - one[2] - share * (other[2] - one[2])
        away = np.hypot(east, north)
        if away > off:
            continue
        if nearest >= 0:
            on[nearest] = False
        else:
            count += 1
            low = height if count == 1 else low
            high = height
        on[at], nearest, off = True, at, away
    slabs = round((high - low) / _STEP_M) + 1
    return count if count >= _FEWEST_PIECES and count >= _FILLED * slabs else 0


def warm_up() -> None:
    """Compile the kernels."""
    lines_of(np.zeros((_FEWEST_PIECES, 3)), np.zeros(4), _STEP_M)
