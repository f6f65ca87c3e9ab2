"""Faces: cells whose planes go on from one to the next."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.sparse_plan import CELL_M, TILE, SparsePlan
from processing.methods.road.walls.plane_kernels import PLANE_FIELDS, planes_kernel
from processing.methods.road.walls.wall_cells import WallCellPoints

FIRST_NOISE_M = 0.02
"""How far off a plane points may lie before the recording's own noise is known."""

_CELLS_AT_ONCE = 2_000
_GOOD_SLABS, _GOOD_SHARE = 3, 0.4
_STEP = 2
"""Cells from one to the next of a face: 0.4 m, between scan lines of a fast vehicle."""

_TURN = 0.99
"""Cosine of the most that a plane turns from one cell to the next: 8 degrees."""

_LEAN = 0.08
"""The most that its lean changes."""


def local_planes(
    points: WallCellPoints, plan: SparsePlan, monitor: Monitor
) -> tuple[Floats, Floats, float]:
    """The plane over each cell, the middles of cells, and the noise of the points.

    Returns
    -------
    planes : (k, 8) float64
        As :mod:`processing.methods.road.walls.plane_kernels` tells them.
    middles : (k, 2) float64
        m about the plan's origin.
    noise_m : float
        How far off a plane a point may lie: three times the scatter about the flattest ones.
    """
    middles = cell_middles(points, plan)
    around = neighbours(points, plan, middles, 1)
    planes = np.zeros((len(middles), PLANE_FIELDS))
    starts = range(0, len(middles), _CELLS_AT_ONCE)
    noise_m = FIRST_NOISE_M
    for _ in range(2):

        def fit(start: int, limit_m: float = noise_m) -> None:
            monitor.check()
            span = start, min(start + _CELLS_AT_ONCE, len(middles))
            planes_kernel(points, around, middles, span, limit_m, planes)

        for _ in in_order(fit, starts):
            monitor.check()
        measured = 3.0 * _noise_of(planes)
        if not measured > 1.3 * noise_m:
            break
        noise_m = min(measured, 3 * FIRST_NOISE_M)
    return planes, middles, noise_m


def _noise_of(planes: Floats) -> float:
    good = planes[(planes[:, 4] >= 2 * _GOOD_SLABS) & (planes[:, 5] > _GOOD_SHARE), 6]
    return float(np.quantile(good, 0.5)) if good.size else 0.0


def cell_middles(points: WallCellPoints, plan: SparsePlan) -> Floats:
    """(k, 2) float64 of the cells that hold points, m about the plan's origin."""
    tiles = np.empty((len(plan), 2))
    there = np.argwhere(plan.table >= 0)
    tiles[plan.table[tuple(there.T)]] = there
    tile, rest = np.divmod(points.cells, TILE * TILE)
    within = np.column_stack(np.divmod(rest, TILE))
    return np.asarray((tiles[tile] * TILE + within + 0.5) * CELL_M)


def neighbours(
    points: WallCellPoints, plan: SparsePlan, middles: Floats, reach: int
) -> NDArray[np.int32]:
    """(k, (2·reach + 1)²) int32 numbers of the cells about each; −1: none."""
    side = 2 * reach + 1
    around = np.full((len(middles), side * side), -1, np.int32)
    neighbours_kernel(middles, reach, plan.table, points.number, around)
    return around


@kernel
def neighbours_kernel(
    middles: Floats,
    reach: int,
    table: NDArray[np.int32],
    number: NDArray[np.int32],
    around: NDArray[np.int32],
) -> None:
    """Write the numbers of the cells about each."""
    for cell in range(len(middles)):
        east = int(np.floor(middles[cell, 0] / CELL_M))
        north = int(np.floor(middles[cell, 1] / CELL_M))
        place = 0
        for i in range(-reach, reach + 1):
            for j in range(-reach, reach + 1):
                a, b = east + i, north + j
                p, q = a // TILE, b // TILE
                if 0 <= p < table.shape[0] and 0 <= q < table.shape[1] and table[p, q] >= 0:
                    at = (table[p, q] * TILE + a - p * TILE) * TILE + b - q * TILE
                    around[cell, place] = number[at]
                place += 1


def linked_cells(
    planes: Floats, middles: Floats, around: NDArray[np.int32], off_m: float
) -> Integers:
    """(k,) int64 the face of each cell, numbered from 0; −1: of none.

    Parameters
    ----------
    off_m : float
        The most that one cell's plane misses the next one's.
    """
    is_good = (planes[:, 4] >= _GOOD_SLABS) & (planes[:, 5] >= _GOOD_SHARE)
    owner = np.arange(len(planes))
    link_kernel(planes, middles, around, is_good, off_m, owner)
    owner[~is_good] = -1
    faces = np.full(len(planes), -1, np.int64)
    if is_good.any():
        faces[is_good] = np.unique(owner[is_good], return_inverse=True)[1]
    return faces


@kernel
def _root(owner: Integers, cell: int) -> int:
    while owner[cell] != cell:
        owner[cell] = owner[owner[cell]]
        cell = owner[cell]
    return cell


@kernel
def link_kernel(
    planes: Floats,
    middles: Floats,
    around: NDArray[np.int32],
    is_good: NDArray[np.bool_],
    off_m: float,
    owner: Integers,
) -> None:
    """Join cells whose planes go on."""
    for cell in range(len(planes)):
        if not is_good[cell]:
            continue
        for other in around[cell]:
            if other <= cell or not is_good[other]:
                continue
            if _goes_on(planes[cell], planes[other], middles[other] - middles[cell], off_m):
                a, b = _root(owner, cell), _root(owner, other)
                owner[max(a, b)] = min(a, b)
    for cell in range(len(planes)):
        owner[cell] = _root(owner, cell)


@kernel
def _goes_on(one: Floats, other: Floats, way: Floats, off_m: float) -> bool:
    """Whether two planes are one: alike in turn and lean, and each through the other's middle."""
    turn = one[0] * other[0] + one[1] * other[1]
    sign = 1.0 if turn >= 0.0 else -1.0
    if abs(turn) < _TURN or abs(one[3] - sign * other[3]) > _LEAN:
        return False
    high = 0.5 * (one[7] + other[7])
    here, there = one[2] + one[3] * high, other[2] + other[3] * high
    # Where the other's plane is nearest to its cell's middle, about this one's middle.
    east, north = way[0] + other[0] * there, way[1] + other[1] * there
    first = one[0] * east + one[1] * north - here
    east, north = one[0] * here - way[0], one[1] * here - way[1]
    second = other[0] * east + other[1] * north - there
    return bool(abs(first) <= off_m and abs(second) <= off_m)
