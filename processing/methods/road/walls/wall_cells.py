"""Cells of the plan over which something stands, and a few points of each.

A face is thin in plan and high, so cells of 0.2 m tell where one may be: which slabs of height over
the ground hold points. Of each such cell as many points are kept as tell a plane, each with the
point measured just before it: on a wall that is of the wall too, in a hedge or behind a fence it is
not.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.road.objects.drive_chunks import DriveChunk
from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import TILE, SparsePlan, cell_of
from processing.methods.road.objects.survey import SurveyGround
from processing.methods.road.wires.wire_points import pulse_interval
from processing.recording.drive import Drive

SLAB_M, SLABS, LOWEST_M = 0.2, 31, 0.15
"""Slabs over the ground: 0.15 to 6.35 m. Below lie grass, curbs and the error of the ground."""

FACE_SLABS = 15
"""Of these the ones in which a face must show: up to 3.15 m, the ground floor."""

GROUND_BIT = np.uint32(1 << 31)

_FACE_BITS = np.uint32((1 << FACE_SLABS) - 1)

_FEWEST_SLABS = 3
"""Over a cell and those about it: 0.6 m, the height of a low wall (コンクリートブロック塀 begins
with three layers of 0.2 m)."""

_KEPT = 64
"""Points that are kept of a cell: a plane through a cell and its neighbours has some hundreds."""

_NEAR_GROUND_M = 0.15

_PULSES = 1.6
"""Intervals between two pulses that follow each other, with what their times are rounded by."""


class CellColumns(NamedTuple):
    """What stands over each cell of the plan: arrays over the cells of all tiles.

    Attributes
    ----------
    slabs : (cells,) uint32
        Filled slabs; the highest bit: ground was seen.
    counts : (cells,) uint32
        Points in slabs a face shows in.
    ground : (cells, 2) float32
        Sum of heights over the coarse ground of points near it, m, and how many.
    """

    slabs: NDArray[np.uint32]
    counts: NDArray[np.uint32]
    ground: NDArray[np.float32]


class WallCellPoints(NamedTuple):
    """Some points over cells, those of a cell one after the other.

    Attributes
    ----------
    cells : (k,) int64
        Their cells, rising.
    number : (cells,) int32
        Which of them a cell of the plan is; −1: none.
    starts : (k + 1,) int64
    local : (n, 3) float64
        m about the plan's origin.
    above : (n,) float32
        Height over the coarse ground, m.
    before : (n, 3) float32
        From each to the point that the pulse before it met, m; NaN where that met nothing.
    drives, points : (n,) int64
        Which drive each is of, and its number there.
    """

    cells: Integers
    number: NDArray[np.int32]
    starts: Integers
    local: Floats
    above: NDArray[np.float32]
    before: NDArray[np.float32]
    drives: Integers
    points: Integers


class PulseTimes:
    """When the pulses of drives were sent.

    Parameters
    ----------
    drives : sequence of Drive
        In the order that chunks number them.
    """

    def __init__(self, drives: Sequence[Drive]) -> None:
        self._drives = drives
        self._intervals = [pulse_interval(drive) for drive in drives]

    def follows(self, chunk: DriveChunk) -> NDArray[np.bool_]:
        """(n,) whether the pulse before each point's met something; always without times."""
        count, interval = len(chunk.local), self._intervals[chunk.drive]
        if interval == 0.0:
            return np.ones(count, np.bool_)
        first = max(chunk.start - 1, 0)
        times = np.asarray(
            self._drives[chunk.drive].columns["time"][first : chunk.start + count], np.float64
        )
        steps = np.diff(times, prepend=times[:1]) if chunk.start == 0 else np.diff(times)
        return np.asarray(steps <= _PULSES * interval)


def cell_columns(
    chunks: Iterable[DriveChunk], plan: SparsePlan, ground: NDArray[np.float32]
) -> CellColumns:
    """What stands over each cell."""
    cells = len(plan) * TILE * TILE
    found = CellColumns(
        np.zeros(cells, np.uint32), np.zeros(cells, np.uint32), np.zeros((cells, 2), np.float32)
    )
    for chunk in chunks:
        columns_kernel(chunk.local, chunk.is_noise, plan.table, ground.reshape(-1), *found)
    return found


def cell_points(
    chunks: Iterable[DriveChunk],
    below: SurveyGround,
    columns: CellColumns,
    pulses: PulseTimes,
    monitor: Monitor,
) -> WallCellPoints:
    """Some points over each cell that a face may stand in."""
    plan, ground = below
    number = _chosen_cells(plan, columns.slabs, monitor)
    cells = np.flatnonzero(number >= 0)
    starts = np.concatenate([[0], np.cumsum(np.minimum(columns.counts[cells], _KEPT))])
    size = int(starts[-1])
    kept = WallCellPoints(
        cells,
        number,
        starts.astype(np.int64),
        np.empty((size, 3)),
        np.empty(size, np.float32),
        np.empty((size, 3), np.float32),
        np.empty(size, np.int64),
        np.empty(size, np.int64),
    )
    met = np.zeros(len(cells), np.int64)
    last, drive = np.full(3, np.nan), -1
    for chunk in chunks:
        if chunk.drive != drive:
            last[:], drive = np.nan, chunk.drive
        which = np.array([chunk.drive, chunk.start], np.int64)
        keep_kernel(
            chunk.local,
            chunk.is_noise,
            (plan.table, ground.reshape(-1), columns.counts),
            (which, pulses.follows(chunk)),
            kept,
            met,
            last,
        )
    return kept


def _chosen_cells(
    plan: SparsePlan, slabs: NDArray[np.uint32], monitor: Monitor
) -> NDArray[np.int32]:
    """Numbers of the cells that hold points of a face; −1 for others.

    Together with those about it enough slabs of one are filled.
    """
    shaped = slabs.reshape(-1, TILE, TILE)
    number = np.full(shaped.shape, -1, np.int32)
    for tile in range(len(plan)):
        monitor.check()
        wide = plan.window(shaped, tile, 1, 0)
        chosen_kernel(wide, number[tile])
    flat = number.reshape(-1)
    cells = np.flatnonzero(flat >= 0)
    flat[cells] = np.arange(cells.size, dtype=np.int32)
    return flat


@kernel
def _bits(mask: np.uint32) -> int:
    count = 0
    while mask:
        mask &= mask - np.uint32(1)
        count += 1
    return count


@kernel
def chosen_kernel(wide: NDArray[np.uint32], number: NDArray[np.int32]) -> None:
    """Write 0 for cells that a face may stand in: ``wide`` has one more cell on each side."""
    for i in range(number.shape[0]):
        for j in range(number.shape[1]):
            if not wide[i + 1, j + 1] & _FACE_BITS:
                continue
            both = np.uint32(0)
            for a in range(3):
                for b in range(3):
                    both |= wide[i + a, j + b]
            if _bits(both & _FACE_BITS) >= _FEWEST_SLABS:
                number[i, j] = 0


@kernel
def columns_kernel(
    local: Floats,
    is_noise: NDArray[np.bool_],
    table: NDArray[np.int32],
    ground: NDArray[np.float32],
    slabs: NDArray[np.uint32],
    counts: NDArray[np.uint32],
    lows: NDArray[np.float32],
) -> None:
    """Mark the slabs of points, count those of faces, and add up heights of the ground."""
    for point in range(len(local)):
        if is_noise[point]:
            continue
        cell = cell_of(local[point, 0], local[point, 1], table, TILE)
        if cell < 0:
            continue
        floor = ground[cell_of(local[point, 0], local[point, 1], table, GROUND_CELLS)]
        above = local[point, 2] - floor
        if abs(above) <= _NEAR_GROUND_M:
            slabs[cell] |= GROUND_BIT
            lows[cell, 0] += np.float32(above)
            lows[cell, 1] += np.float32(1.0)
        elif above > LOWEST_M:
            slab = int((above - LOWEST_M) / SLAB_M)
            if slab < SLABS:
                slabs[cell] |= np.uint32(1) << np.uint32(slab)
            if slab < FACE_SLABS:
                counts[cell] += np.uint32(1)


@kernel
def keep_kernel(
    local: Floats,
    is_noise: NDArray[np.bool_],
    over: tuple[NDArray[np.int32], NDArray[np.float32], NDArray[np.uint32]],
    drive: tuple[Integers, NDArray[np.bool_]],
    kept: WallCellPoints,
    met: Integers,
    last: Floats,
) -> None:
    """Keep points of a stretch, evenly among those of their cell.

    Parameters
    ----------
    over : (table, ground, counts)
        Of the plan.
    drive : (which, follows)
        (2,) int64, the drive and the number of the first point in it; (n,) bool, whether the pulse
        before each met something.
    met : (k,) int64
        How many points of each cell have been met; moved on.
    last : (3,) float64
        The point before the first; gets the last one.
    """
    table, ground, counts = over
    which, follows = drive
    for point in range(len(local)):
        cell = -1
        if not is_noise[point]:
            cell = cell_of(local[point, 0], local[point, 1], table, TILE)
        number = kept.number[cell] if cell >= 0 else -1
        if number >= 0:
            floor = ground[cell_of(local[point, 0], local[point, 1], table, GROUND_CELLS)]
            above = local[point, 2] - floor
            if above > LOWEST_M and int((above - LOWEST_M) / SLAB_M) < FACE_SLABS:
                room = kept.starts[number + 1] - kept.starts[number]
                # The k-th of n points goes to place ⌊k·room/n⌋, if it is the first there.
                rank = met[number]
                met[number] += 1
                total = int(counts[cell])
                place = rank * room // total
                if rank == 0 or (rank - 1) * room // total < place:
                    at = kept.starts[number] + place
                    kept.above[at] = above
                    kept.drives[at] = which[0]
                    kept.points[at] = which[1] + point
                    for axis in range(3):
                        kept.local[at, axis] = local[point, axis]
                        step = last[axis] - local[point, axis]
                        kept.before[at, axis] = step if follows[point] else np.nan
        for axis in range(3):
            last[axis] = local[point, axis]
