"""Columns: narrow upright things that stand free at some heights, as trunks, poles and posts do.

A trunk shows on every scan line that crosses it as a few points with nothing beside them. So cells
of the plan are marked at which heights above the ground they hold points, and a column is where
cells are filled over a height without filled ones on two opposite sides. Walls, hedges and fences
have those; a trunk that stands before a wall, in a hedge or behind a rail has them at some heights
only. The search takes two passes over the points and no neighbours of single points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.drive_chunks import chunks_of
from processing.methods.road.objects.ground_heights import GROUND_CELLS, height_of
from processing.methods.road.objects.sparse_plan import TILE, SparsePlan, cell_of
from processing.recording.drive import Drive

SLAB_M = 0.2
"""Height of a slab: two are never missed by scan lines that lie 0.3 m apart on an upright thing."""

SLABS = 32
"""Bits of a cell: from 0.2 to 6.6 m above the ground."""

LOWEST_M = 0.2
"""Below lie grass, curbs and the error of the ground."""

_RING = 3
"""Cells from the middle to the ring that must not be filled on two opposite sides: 0.6 m."""

_HALO = _RING + 2

_HALO_OF_GROUND = 2
"""Cells of the coarse map about a tile: eight of the plan, as wide as its own halo and more."""

_FEWEST_SLABS = 3
"""In a row, of a column: 0.6 m, the height of a bollard above `LOWEST_M`."""

_APART_CELLS = 2
"""Columns are farther apart in either direction: 0.4 m; nearer ones are stakes beside a trunk, or
the stems of one tree."""

ONE_M = 0.3
"""Columns nearer to each other are of one pole, as thick as two cells; each would get a half."""

_BEGINS = np.uint32((1 << 11) - 1)
"""The slabs up to 2.4 m, in which a column stands free: a pedestrian passes under what hangs
higher."""

_FOOT, _RAISED_SLABS = np.uint32((1 << 7) - 1), 12
"""The slabs up to 1.6 m, and how many stand free in a row of a column whose lower part a wall
or a hedge before it hides: 2.4 m, longer than what hangs on fronts of houses."""


_Middles: TypeAlias = list[tuple[Floats, int]]
"""Of columns, in cells of the plan, with the slabs at which each stands free."""


@dataclass(frozen=True)
class FoundColumns:
    """Columns of a survey.

    Attributes
    ----------
    middles : (k, 2) float64
        In plan, m about the origin of the plan.
    ground : (k,) float64
        Height of the ground there, m about the origin of the plan, to a decimetre or two.
    slabs : (k,) uint32
        At which heights each stands free: bit b is ``0.2 + 0.2 b`` m above the ground and on.
    """

    middles: Floats
    ground: Floats
    slabs: NDArray[np.uint32]

    def __len__(self) -> int:
        return len(self.middles)

    def chosen(self, which: NDArray[np.bool_]) -> FoundColumns:
        """Some of them."""
        return FoundColumns(self.middles[which], self.ground[which], self.slabs[which])


class UprightColumns(NamedTuple):
    """Columns of each kind.

    Attributes
    ----------
    standing : FoundColumns
        Heights of each cell count from the ground of its own.
    posts : FoundColumns
        Heights count from the ground of the cell that is asked about: beside gutters and steps
        more low posts stand free so. Middles of trunks come out otherwise, by which their search
        measured worse on streets.
    raised : FoundColumns
        As posts; those of which nothing below 1.6 m above the ground was seen.
    """

    standing: FoundColumns
    posts: FoundColumns
    raised: FoundColumns


def find_columns(
    drives: Sequence[Drive],
    plan: SparsePlan,
    ground: NDArray[np.float32],
    monitor: Monitor,
) -> UprightColumns:
    """Columns of all drives together.

    Parameters
    ----------
    ground : (tiles, 16, 16) float32
        As :func:`ground_heights` found it.
    """
    slabs, several, many = np.zeros((3, len(plan), TILE, TILE), np.uint32)
    for chunk in chunks_of(drives, plan.origin, monitor):
        filled = slabs.reshape(-1), several.reshape(-1), many.reshape(-1)
        slabs_kernel(chunk.local, chunk.is_noise, plan.table, ground.reshape(-1), filled)
    found: tuple[_Middles, ...] = ([], [], [])

    def of_tile(tile: int) -> tuple[_Middles, ...]:
        monitor.check()
        margin = _HALO + _APART_CELLS
        few, some, most = (plan.window(one, tile, margin, 0) for one in (slabs, several, many))
        below = _of_cells(plan.window(ground, tile, _HALO_OF_GROUND, np.nan), len(few))
        # Single points of noise don't stand beside what shows by many, as sparse walls do.
        each, one = (
            free_slabs(few, few, told) | free_slabs(most, some, told)
            for told in (np.zeros_like(below), below)
        )
        return _columns_of(each)[0], *_columns_of(one)

    for tile, parts in enumerate(in_order(of_tile, range(len(plan)))):
        for kind, here in zip(found, parts, strict=True):
            kind += [
                (plan.middles(tile, np.asarray(middle - 0.5)), bits)
                for middle, bits in here
                if ((middle >= 0) & (middle < TILE)).all()
            ]
    return UprightColumns(*(_on_ground(kind, plan, ground) for kind in found))


def distinct_columns(columns: FoundColumns) -> FoundColumns:
    """Of columns that are one the one that stands free at the most heights."""
    from scipy.spatial import cKDTree

    if len(columns) < 2:
        return columns
    kept = np.ones(len(columns), np.bool_)
    heights = np.bitwise_count(columns.slabs)
    pairs = cKDTree(columns.middles).query_pairs(ONE_M, output_type="ndarray")
    for a, b in pairs[np.lexsort(pairs.T)].tolist():
        if kept[a] and kept[b]:
            kept[b if heights[a] >= heights[b] else a] = False
    return FoundColumns(columns.middles[kept], columns.ground[kept], columns.slabs[kept])


def _on_ground(
    found: Sequence[tuple[Floats, int]], plan: SparsePlan, ground: NDArray[np.float32]
) -> FoundColumns:
    places = np.array([middle for middle, _ in found], np.float64).reshape(-1, 2)
    heights = [height_of(ground, plan, *place) for place in places.tolist()]
    free = np.array([bits for _, bits in found], np.uint32)
    return FoundColumns(places, np.array(heights, np.float64), free)


@kernel
def slabs_kernel(
    local: Floats,
    is_noise: NDArray[np.bool_],
    table: NDArray[np.int32],
    ground: NDArray[np.float32],
    filled: tuple[NDArray[np.uint32], NDArray[np.uint32], NDArray[np.uint32]],
) -> None:
    """Mark at which heights cells hold points, at which two and more, at which three and more."""
    slabs, several, many = filled
    for point in range(len(local)):
        if is_noise[point]:
            continue
        below = cell_of(local[point, 0], local[point, 1], table, GROUND_CELLS)
        low = ground[below] if below >= 0 else np.float32(np.nan)
        if np.isnan(low):
            continue
        slab = int((local[point, 2] - low - LOWEST_M) / SLAB_M)
        if local[point, 2] - low >= LOWEST_M and slab < SLABS:
            cell = cell_of(local[point, 0], local[point, 1], table, TILE)
            bit = np.uint32(1) << np.uint32(slab)
            many[cell] |= several[cell] & bit
            several[cell] |= slabs[cell] & bit
            slabs[cell] |= bit


def _of_cells(ground: NDArray[np.float32], side: int) -> NDArray[np.float32]:
    """(side, side) the ground of the coarse map of the cells in its middle."""
    per_cell = TILE // GROUND_CELLS
    wide = np.repeat(np.repeat(ground, per_cell, axis=0), per_cell, axis=1)
    margin = (len(wide) - side) // 2
    return np.ascontiguousarray(wide[margin : margin + side, margin : margin + side])


def free_slabs(
    slabs: NDArray[np.uint32], beside: NDArray[np.uint32], ground: NDArray[np.float32]
) -> NDArray[np.uint32]:
    """At which heights cells are filled without filled ones 0.6 m away on two opposite sides.

    Parameters
    ----------
    slabs, beside : (n, m) uint32
        At which heights cells are filled, and at which they count as filled beside others.
    ground : (n, m) float32
        From which the heights of each cell count, m: beside a gutter or a step they differ.

    Returns
    -------
    (n, m) uint32
        0 along the margin of `_HALO` cells.
    """
    free = np.zeros_like(slabs)
    free_kernel(slabs, beside, ground, _RING_STEPS, free)
    return free


@kernel
def free_kernel(
    slabs: NDArray[np.uint32],
    beside: NDArray[np.uint32],
    ground: NDArray[np.float32],
    ring: Integers,
    free: NDArray[np.uint32],
) -> None:
    """Write at which heights cells stand free.

    Parameters
    ----------
    ring : (r, 2) int64
        Steps to the cells of the ring, in order round it.
    """
    half = len(ring) // 2
    around = np.zeros(len(ring), np.uint32)
    for i in range(_HALO, slabs.shape[0] - _HALO):
        for j in range(_HALO, slabs.shape[1] - _HALO):
            if slabs[i, j] == 0:
                continue
            for step in range(len(ring)):
                a, b = i + ring[step, 0], j + ring[step, 1]
                around[step] = _raised(_tall(beside[a, b]), ground[a, b] - ground[i, j])
            hidden = np.uint32(0)
            for step in range(half):
                # A line of points need not pass exactly through the middle.
                other = around[step + half] | around[step + half - 1]
                hidden |= around[step] & (other | around[(step + half + 1) % len(ring)])
            free[i, j] = _tall(slabs[i, j]) & ~hidden


@kernel
def _tall(bits: np.uint32) -> np.uint32:
    """The slabs and those above and below each."""
    return np.uint32(bits | (bits << np.uint32(1)) | (bits >> np.uint32(1)))


@kernel
def _raised(bits: np.uint32, rise_m: np.float32) -> np.uint32:
    """Slabs above a ground that lies so much higher than the one from which they shall count."""
    if not abs(rise_m) < SLABS * SLAB_M:
        return np.uint32(0)
    slabs = round(rise_m / SLAB_M)
    if slabs >= 0:
        return np.uint32(bits << np.uint32(slabs))
    return np.uint32(bits >> np.uint32(-slabs))


def _ring_steps() -> list[tuple[int, int]]:
    """The cells of the ring about a cell, in order round it."""
    side = range(-_RING, _RING + 1)
    steps = [(i, j) for i in side for j in side if max(abs(i), abs(j)) == _RING]
    return sorted(steps, key=lambda step: float(np.arctan2(step[1], step[0])))


_RING_STEPS = np.array(_ring_steps(), np.int64)


def _columns_of(free: NDArray[np.uint32]) -> tuple[_Middles, _Middles]:
    """Middles of columns in cells of the tile inside the window, and where they stand free.

    Those that stand free low, and those of which no foot was seen.

    Parameters
    ----------
    free : (n, m) uint32
        At which heights cells stand free.
    """
    low, run = _longest_run(free & _BEGINS), _longest_run(free)
    is_low = low >= _FEWEST_SLABS
    standing = _peaks(is_low, np.where(is_low, low + run, 0), free)
    has_foot = is_low & ((free & _FOOT) > 0)
    is_raised = ~ndimage.maximum_filter(has_foot, 3) & (run >= _RAISED_SLABS)
    if not is_raised.any():
        return standing, []
    return standing, _peaks(is_raised, np.where(is_raised, run, 0), free)


def _peaks(is_column: NDArray[np.bool_], counts: Integers, free: NDArray[np.uint32]) -> _Middles:
    """Of cells that lie near each other the middle of those that have most about them."""
    weights = counts.astype(np.float64)
    about = ndimage.uniform_filter(weights, 3, mode="constant")
    # Of cells that are alike, the weights themselves tell.
    about += 1e-3 * weights
    # Within a ring of filled cells, as a thick trunk is one, nothing was measured.
    # A cell between two columns has most about it without being one.
    about[~is_column] = 0.0
    best = ndimage.maximum_filter(about, 2 * _APART_CELLS + 1, mode="constant")
    found: _Middles = []
    border = _HALO + _APART_CELLS
    for row, column in np.argwhere(is_column & (about == best)).tolist():
        part = (slice(row - 1, row + 2), slice(column - 1, column + 2))
        cells = np.argwhere(weights[part] > 0) + np.array([row - 1, column - 1])
        where = tuple(cells.T)
        weight = weights[where]
        middle = weight @ (cells + 0.5) / weight.sum() - border
        found.append((np.asarray(middle), int(np.bitwise_or.reduce(free[where]))))
    return found


def _longest_run(bits: NDArray[np.uint32]) -> Integers:
    """How many bits of each follow each other at most."""
    run = np.zeros(bits.shape, np.int64)
    left = bits.copy()
    while left.any():
        run += left != 0
        left &= left << np.uint32(1)
    return run
