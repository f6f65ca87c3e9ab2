"""What stands about columns, summed up in decimetres in a few passes over the points.

No point is kept: of each column its axis is followed upwards, and what lies on it, beside it and
around it is counted by height. So little is asked of each place that a handful of points tells it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.objects.columns import FoundColumns
from processing.methods.road.objects.drive_chunks import chunks_of
from processing.methods.road.objects.sparse_plan import CELL_M, TILE, SparsePlan, cell_of
from processing.recording.drive import Drive

SLAB_M, LOWEST_M, SLABS = 0.4, 0.2, 32
"""Height of a slab: rows of sparse recordings lie so far apart on an upright thing; where the first
one begins, above grass and the error of the ground; and their number, up to 13 m."""

REACH_M = 2.5
"""Points so near to an axis are counted."""

ON_M = 0.3
"""Of an axis: half of the thickest trunks, and posts as shaken as sparse recordings are."""

_BESIDE_M, _RING_M, _HEDGE_M, _AROUND_M = 0.4, 1.0, 1.5, 2.2
"""From where to where something stands beside an axis, how wide a hedge about it is, and how far a
crown reaches at least."""

SECTORS = 12

LOW_SLABS, HIGH_SLAB = 6, 5
"""Slabs up to 2.6 m, in which a trunk or a post stands free, and the first one of a crown."""

_FOLLOWED = ((0.5, 6), (0.35, 12), (0.3, SLABS))
"""How near points of an axis lie and up to which slab, pass by pass: a lean that is known over two
metres tells where it goes on, and not where it ends."""

_STEEPEST, _DOUBT = 0.25, (0.1 / 0.05) ** 2
"""Run over rise of the most leaning axis; and how much a lean is doubted, m²: points lie 0.1 m off
an axis, usual axes lean by 0.05, and few points don't say otherwise."""

_MOST_COUNT = 4.0
"""More points of a slab place its middle no better: they are shaken together."""

MOST_GAP = 4
"""Slabs without a point beyond which what follows is another thing."""

# What is summed up of a slab: points on the axis, in the ring beside it and around it, and the
# plan's first and second moments of those on it; then points up to the ring's rim, and theirs.
ON, RING, AROUND, EAST, NORTH, EAST_EAST, NORTH_NORTH, EAST_NORTH = range(8)
NEAR, NEAR_EAST = 8, 9
_SUMS = 14


class Axes(NamedTuple):
    """Lines that columns go up along.

    Attributes
    ----------
    base : (k, 2) float64
        Where each meets its column's ground, m about the plan's origin.
    lean : (k, 2) float64
        What it moves to the east and north in a metre of height.
    """

    base: Floats
    lean: Floats


@dataclass(frozen=True)
class ColumnSums:
    """What was counted about columns.

    Attributes
    ----------
    axes : Axes
    slabs : (k, SLABS, 14) float64
        By the names above.
    low, high : (k,) int64
        In which twelfths round the axis something stands, a bit each: beside it up to 2.6 m, and
        around it above.
    highest_m : (k,) float64
        Of all points within `REACH_M`, above the ground.
    """

    axes: Axes
    slabs: Floats
    low: Integers
    high: Integers
    highest_m: Floats


def sum_columns(
    drives: Sequence[Drive], plan: SparsePlan, columns: FoundColumns, monitor: Monitor
) -> ColumnSums:
    """Follow the axes of columns and count what is about them.

    Parameters
    ----------
    plan : SparsePlan
        With the tiles of all points.
    """
    count, parts = len(columns), len(_FOLLOWED) + 1
    axes = Axes(columns.middles.copy(), np.zeros((count, 2)))
    near = _ColumnsOfTiles.of(plan, columns)
    for number, (within_m, slabs) in enumerate(_FOLLOWED):
        sums = np.zeros((count, SLABS, _SUMS))
        part = PartMonitor(monitor, number / parts, (number + 1) / parts)
        for chunk in chunks_of(drives, plan.origin, part):
            middles_kernel(
                chunk.local,
                chunk.is_noise,
                plan.table,
                near,
                (*axes, columns.ground),
                within_m,
                sums,
            )
        follow_kernel(sums, slabs, axes)
    counted = ColumnSums(
        axes,
        np.zeros((count, SLABS, _SUMS)),
        np.zeros(count, np.int64),
        np.zeros(count, np.int64),
        np.zeros(count),
    )
    for chunk in chunks_of(drives, plan.origin, PartMonitor(monitor, 1 - 1 / parts, 1.0)):
        counts_kernel(
            chunk.local,
            chunk.is_noise,
            plan.table,
            near,
            (*axes, columns.ground),
            (counted.slabs, counted.low, counted.high, counted.highest_m),
        )
    return counted


class _ColumnsOfTiles(NamedTuple):
    """The columns that points of a tile may be near to.

    ``starts`` : (tiles + 1,) int64; ``columns`` : (n,) int64, those of tile t from ``starts[t]``.
    """

    starts: Integers
    columns: Integers

    @staticmethod
    def of(plan: SparsePlan, columns: FoundColumns) -> _ColumnsOfTiles:
        size_m = CELL_M * TILE
        reach = REACH_M + _FOLLOWED[0][0] + _STEEPEST * SLAB_M * SLABS / 2
        tiles: list[Integers] = []
        owners: list[Integers] = []
        for east in (-reach, reach):
            for north in (-reach, reach):
                at = np.floor((columns.middles + np.array([east, north])) / size_m).astype(np.int64)
                is_in = ((at >= 0) & (at < plan.table.shape)).all(axis=1)
                number = plan.table[tuple(at[is_in].T)].astype(np.int64)
                tiles.append(number[number >= 0])
                owners.append(np.flatnonzero(is_in)[number >= 0])
        pairs = np.unique(np.column_stack([np.concatenate(tiles), np.concatenate(owners)]), axis=0)
        counts = np.bincount(pairs[:, 0], minlength=len(plan))
        return _ColumnsOfTiles(np.concatenate([[0], np.cumsum(counts)]), pairs[:, 1].copy())


@kernel
def middles_kernel(
    local: Floats,
    is_noise: NDArray[np.bool_],
    table: NDArray[np.int32],
    near: _ColumnsOfTiles,
    axes: tuple[Floats, Floats, Floats],
    within_m: float,
    sums: Floats,
) -> None:
    """Sum up the points on each axis by slabs, m about the axis.

    Parameters
    ----------
    axes : tuple
        Base, lean and ground of each.
    """
    for point in range(len(local)):
        tile = cell_of(local[point, 0], local[point, 1], table, 1)
        if is_noise[point] or tile < 0:
            continue
        for place in range(near.starts[tile], near.starts[tile + 1]):
            column = near.columns[place]
            east, north, up = _about_axis(local[point], axes, column)
            slab = int((up - LOWEST_M) / SLAB_M)
            if up < LOWEST_M or slab >= SLABS:
                continue
            if east * east + north * north < within_m * within_m:
                sums[column, slab, ON] += 1
                sums[column, slab, EAST] += east
                sums[column, slab, NORTH] += north


@kernel
def _about_axis(
    place: Floats, axes: tuple[Floats, Floats, Floats], column: int
) -> tuple[float, float, float]:
    """East and north of an axis, and up from its ground."""
    base, lean, ground = axes
    up = place[2] - ground[column]
    east = place[0] - base[column, 0] - lean[column, 0] * up
    north = place[1] - base[column, 1] - lean[column, 1] * up
    return east, north, up


@kernel
def follow_kernel(sums: Floats, slabs: int, axes: Axes) -> None:
    """Lay axes through the middles of their slabs, up to one of them or to a gap.

    Each slab counts as its points do, up to `_MOST_COUNT`.
    """
    for column in range(len(sums)):
        weight = rise = rises = 0.0
        off = np.zeros(2)
        offs = np.zeros(2)
        gap = 0
        for slab in range(slabs):
            points = sums[column, slab, ON]
            if points == 0:
                gap += 1
                if gap > MOST_GAP and weight > 0:
                    break
                continue
            gap = 0
            counts = min(points, _MOST_COUNT)
            up = LOWEST_M + (slab + 0.5) * SLAB_M
            weight += counts
            rise += counts * up
            rises += counts * up * up
            for axis in range(2):
                middle = sums[column, slab, EAST + axis] / points
                off[axis] += counts * middle
                offs[axis] += counts * middle * up
        if weight == 0:
            continue
        spread = rises - rise * rise / weight
        for axis in range(2):
            told = offs[axis] - rise * off[axis] / weight
            slope = (told - _DOUBT * axes.lean[column, axis]) / (spread + _DOUBT)
            lean = min(max(axes.lean[column, axis] + slope, -_STEEPEST), _STEEPEST)
            slope = lean - axes.lean[column, axis]
            axes.base[column, axis] += (off[axis] - slope * rise) / weight
            axes.lean[column, axis] = lean


@kernel
def counts_kernel(
    local: Floats,
    is_noise: NDArray[np.bool_],
    table: NDArray[np.int32],
    near: _ColumnsOfTiles,
    axes: tuple[Floats, Floats, Floats],
    counted: tuple[Floats, Integers, Integers, Floats],
) -> None:
    """Count what is on axes, beside and around them.

    Parameters
    ----------
    counted : tuple
        Slabs, low, high and highest of `ColumnSums`.
    """
    slabs, low, high, highest = counted
    for point in range(len(local)):
        tile = cell_of(local[point, 0], local[point, 1], table, 1)
        if is_noise[point] or tile < 0:
            continue
        for place in range(near.starts[tile], near.starts[tile + 1]):
            column = near.columns[place]
            east, north, up = _about_axis(local[point], axes, column)
            if up < LOWEST_M:
                continue
            away = np.sqrt(east * east + north * north)
            if away > REACH_M:
                continue
            highest[column] = max(highest[column], up)
            slab = int((up - LOWEST_M) / SLAB_M)
            if slab >= SLABS:
                continue
            _count(slabs[column, slab], east, north, away)
            is_high = slab >= HIGH_SLAB
            if _BESIDE_M < away < (_AROUND_M if is_high else _HEDGE_M):
                bits = high if is_high else low
                bits[column] |= _sector_of(east, north)


@kernel
def _count(slab: Floats, east: float, north: float, away: float) -> None:
    """Add a place to the sums of a slab."""
    if away < _RING_M:
        slab[NEAR] += 1
        _add_moments(slab, NEAR_EAST, east, north)
    if away < ON_M:
        slab[ON] += 1
        _add_moments(slab, EAST, east, north)
    elif away > _BESIDE_M:
        slab[RING] += away < _RING_M
        slab[AROUND] += away < _AROUND_M


@kernel
def _add_moments(slab: Floats, first: int, east: float, north: float) -> None:
    """Add a place to the sums that begin at a number."""
    slab[first] += east
    slab[first + 1] += north
    slab[first + 2] += east * east
    slab[first + 3] += north * north
    slab[first + 4] += east * north


@kernel
def _sector_of(east: float, north: float) -> int:
    """The bit of the twelfth round the axis."""
    turn = np.arctan2(north, east) / (2 * np.pi) + 0.5
    return 1 << min(int(turn * SECTORS), SECTORS - 1)
