"""Whether a shaft stands in a crown: what hangs together about its axis and fills space.

An arm is a line on one side, a plate a plane on two opposite ones, the house behind a post a plane
on one; twigs fill space on all sides (Takahashi 2022, 5.2, asks for the spread of the wires'
directions, which tells the same). Whose a crown is, trees ask
(:mod:`processing.methods.road.trees.crowns`); here it speaks against a pole whoever's it is.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from processing.core.arrays import Floats, Integers
from processing.methods.road.poles.shafts import Shaft

_CELL_M = 0.4
"""Cells in which a crown hangs together: the gaps between its twigs are smaller, and houses and
wires keep farther away."""

_LOW_M = 1.4
"""Crowns are looked for above: what is lower is hedge, stake or guard."""

_AXIS_M = 0.6
"""What is so near to the axis above the shaft belongs to what stands on it."""

_ABOVE_M = 2.5
"""So far above the highest point that was seen of the shaft: the crown hides what goes on."""

_ON_TOP_M = 0.5
"""How far above its highest point a shaft is left out."""

_FEWEST = 6
"""Points of a cell from which its shape is told."""

_FLAT = 0.15
"""Extent square to a cell's plane over its longest one. Over a plane it is the noise, 1 cm over
12 cm; twigs and leaves fill a cell to a third."""

_PAIRS = ((0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2))
"""Of axes whose products make a matrix of second moments."""

_MOST_SPARE = 16
"""Cells of the box about points, over their number, up to which a table of all is quicker than to
sort."""

_SECTORS = 12
"""Of 30 degrees."""

_BESIDE_M = 0.12
"""m beside a shaft's surface; nearer points are its own and noise."""


@dataclass(frozen=True)
class LeavesAbout:
    """What could be a crown about a shaft.

    Attributes
    ----------
    sectors : int
        Of twelve about the axis, those that twigs fill.
    cells : int
        That twigs fill: 0.064 m³ each.
    flat_share : float
        Of the cells near the axis whose shape is told, those that are planes or lines.
    aside : float
        How far its middle lies from the axis, over half its width.
    """

    sectors: int
    cells: int
    flat_share: float
    aside: float


def leaves_about(points: Floats, shaft: Shaft) -> LeavesAbout:
    """What hangs together with the axis above a shaft.

    Parameters
    ----------
    points : (n, 3) float64
        m about its foot; those that are nearer to no other shaft.

    Notes
    -----
    1. Points above 1.4 m that don't lie on the shaft are put into cells of 0.4 m.
    2. Cells whose points lie in a plane or on a line are walls, signs, arms and wires.
    3. The crown is what hangs together of the others with the axis above the shaft.
    """
    top = shaft.top_m
    free = points[(points[:, 2] > _LOW_M) & ~_is_on(points, shaft)]
    if len(free) == 0:
        return LeavesAbout(0, 0, 1.0, 1.0)
    cells, member = filled_cells(_cells_of(free))
    is_told, is_flat = _shapes(free, member, cells)
    middles = (cells + 0.5) * _CELL_M
    axis = shaft.lean * top
    beside = middles[:, :2] - axis
    away = np.hypot(beside[:, 0], beside[:, 1])
    is_axis = (away < _AXIS_M) & (middles[:, 2] > _LOW_M) & (middles[:, 2] < top + _ABOVE_M)
    about = is_told & (away < 2 * _AXIS_M)
    flat_share = float(is_flat[about].mean()) if about.any() else 1.0
    is_crown = _hangs_together(cells, ~is_flat, is_axis & ~is_flat)
    is_leafy = is_crown & is_told
    crown = free[is_crown[member]]
    if len(crown) < _FEWEST or not is_leafy.any():
        return LeavesAbout(0, 0, flat_share, 1.0)
    width, middle = _widest(crown[:, :2])
    return LeavesAbout(
        sectors=_filled_sectors(beside[is_leafy & (away > _CELL_M)]),
        cells=int(np.count_nonzero(is_leafy)),
        flat_share=flat_share,
        aside=float(np.hypot(*(middle - axis))) / max(width / 2, _CELL_M),
    )


def _is_on(points: Floats, shaft: Shaft) -> NDArray[np.bool_]:
    beside = points[:, :2] - shaft.lean * points[:, 2:]
    reach = points[:, 2] < shaft.top_m + _ON_TOP_M
    is_near = np.hypot(beside[:, 0], beside[:, 1]) < shaft.radius_m + _BESIDE_M
    return np.asarray(reach & is_near)


def _cells_of(points: Floats) -> Integers:
    return np.floor(points / _CELL_M).astype(np.int64)


def filled_cells(cells: Integers) -> tuple[Integers, Integers]:
    """The different ones of cells, rising, and which of them each is: one number a cell."""
    low = cells.min(axis=0)
    shape = tuple((cells.max(axis=0) - low + 1).tolist())
    numbers = np.ravel_multi_index(tuple((cells - low).T), shape)
    if math.prod(shape) > _MOST_SPARE * len(cells):
        different, member = np.unique(numbers, return_inverse=True)
        member = member.reshape(-1)
    else:
        is_filled = np.zeros(math.prod(shape), np.bool_)
        is_filled[numbers] = True
        different = np.flatnonzero(is_filled)
        rank = np.empty(is_filled.size, np.int64)
        rank[different] = np.arange(different.size)
        member = rank[numbers]
    places = np.column_stack(np.unravel_index(different, shape))
    return places + low, member


def _shapes(
    points: Floats, member: Integers, cells: Integers
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Of cells: whether their shape is told, and whether it is a plane or a line.

    One scan line through a crown is a plane too, so the points of the cells about it count with
    those of a cell that is flat by itself.
    """
    sums = _moments(points, member, len(cells))
    number, flatness = _flatness(sums)
    wide_number, wide_flatness = _flatness(_with_neighbours(sums, cells))
    is_flat = wide_flatness < _FLAT
    is_flat &= (number < _FEWEST) | (flatness < _FLAT)
    is_told = wide_number >= _FEWEST
    return is_told, is_told & is_flat


def _moments(points: Floats, member: Integers, count: int) -> Floats:
    """(count, 10) number, sums and sums of products of the points of cells."""
    sums = np.empty((count, 10))
    sums[:, 0] = np.bincount(member, minlength=count)
    for axis in range(3):
        sums[:, 1 + axis] = np.bincount(member, points[:, axis], count)
    for number, (i, j) in enumerate(_PAIRS):
        sums[:, 4 + number] = np.bincount(member, points[:, i] * points[:, j], count)
    return sums


def _with_neighbours(sums: Floats, cells: Integers) -> Floats:
    """The same of cells and the 26 about each."""
    low = cells.min(axis=0) - 1
    grid = np.full(cells.max(axis=0) - low + 2, len(cells), np.int64)
    where = cells - low
    grid[tuple(where.T)] = np.arange(len(cells))
    padded = np.vstack([sums, np.zeros(10)])
    wide = np.zeros_like(sums)
    for step in itertools.product((-1, 0, 1), repeat=3):
        wide += padded[grid[tuple((where + step).T)]]
    return wide


def _flatness(sums: Floats) -> tuple[Floats, Floats]:
    """Number of points, and their extent square to their plane over the longest one."""
    number = sums[:, 0]
    means = sums[:, 1:4] / number[:, None]
    spread = np.empty((len(sums), 3, 3))
    for column, (i, j) in enumerate(_PAIRS):
        product = sums[:, 4 + column] / number - means[:, i] * means[:, j]
        spread[:, i, j] = spread[:, j, i] = product
    extents = np.sqrt(np.maximum(np.linalg.eigvalsh(spread), 1e-12))
    return number, extents[:, 0] / extents[:, 2]


def _hangs_together(
    cells: Integers, is_open: NDArray[np.bool_], is_seed: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Which of the open cells hang together with seeds."""
    low = cells.min(axis=0)
    grid = np.zeros(cells.max(axis=0) - low + 1, np.bool_)
    where = tuple((cells - low).T)
    grid[where] = is_open
    parts, _ = ndimage.label(grid, np.ones((3, 3, 3)))
    part = parts[where]
    # A stray beside the axis is a part of its own; the largest of those that touch it counts.
    touching = np.unique(part[is_seed])
    touching = touching[touching > 0]
    if touching.size == 0:
        return np.zeros(len(cells), np.bool_)
    sizes = np.bincount(part, minlength=int(part.max()) + 1)
    return np.asarray(part == touching[sizes[touching].argmax()])


def _filled_sectors(beside: Floats) -> int:
    turn = np.arctan2(beside[:, 1], beside[:, 0]) / (2 * np.pi) + 0.5
    return int(np.unique((turn * _SECTORS).astype(np.int64) % _SECTORS).size)


def _widest(plan: Floats) -> tuple[float, Floats]:
    """Extent along the direction in which it is widest, and its middle."""
    turns = np.radians(np.arange(0, 180, 10))
    axes = np.array([np.cos(turns), np.sin(turns)])
    along = plan @ axes
    low, high = along.min(axis=0), along.max(axis=0)
    widest = int((high - low).argmax())
    across = (widest + len(turns) // 2) % len(turns)
    middle = sum((low[k] + high[k]) / 2 * axes[:, k] for k in (widest, across))
    return float(high[widest] - low[widest]), np.asarray(middle)
