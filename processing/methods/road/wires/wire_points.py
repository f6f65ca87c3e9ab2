"""Points of thin things high above the street, and the groups in which they lie on one line.

A scan line crosses a wire in one or a few points with the sky before and behind; walls and roofs
give long runs of points. What is left of crowns and railings lies in no thin free line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.drive_chunks import DriveChunk, chunks_of
from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import SparsePlan, cell_of
from processing.methods.road.wires.solid_cells import SolidCells, solid_keys
from processing.methods.road.wires.wire_kernels import (
    LineLimits,
    WireGrid,
    both_kernel,
    crowded_kernel,
    firsts_kernel,
    groups_kernel,
    lines_kernel,
    short_runs_kernel,
)
from processing.recording.columns.ordering import chunk_ranges
from processing.recording.drive import Drive

_NEAR_M = 0.3
"""Points of neighbouring pulses on one wall are nearer, but for walls seen askew."""

_PULSES = 1.6
"""Time between points of neighbouring pulses over the pulse interval: no pulse is missing."""

_INTERVAL_SHARE = 0.2
"""Of the times between points: fewer pulses come early, and on most follows another point."""

_LONGEST_M = 0.35
"""Of a run on a wire: a cable of 4 cm that is crossed askew."""

_CELL_M = 0.8
"""How far about a point its line is looked for: scan lines of a fast vehicle, 0.28 m apart at 100
turns a second and 100 km/h, meet it six times."""

_CELLS_AT_ONCE = 1_000
"""Whose points are measured between two moments at which the work can be stopped: a hundredth of a
second where crowns fill them."""

_MOST_FILLED = 24
"""Of 64 parts of such a cell: a wire fills four or five, a line of five side by side 20 to 25."""

_LIMITS = LineLimits(
    reach_m=_CELL_M,
    core_m=0.03,
    ring_m=0.045,
    free_m=0.085,
    fewest=4,
    steepest=0.8,
    beside=0.5,
)
"""A wire and its noise, and the free room about it: wires of one line hang 10 cm apart and more;
service drops fall by half their run."""


@dataclass(frozen=True)
class WirePoints:
    """Points on thin lines.

    Attributes
    ----------
    local : (n, 3) float64
        m about the plan's origin.
    direction : (n, 3) float64
        Unit vectors along the line through each.
    group : (n,) int64
        The same for points that lie on each other's lines.
    drives, points : (n,) int64
        Which of the drives each is of, and its number there.
    solid : SolidCells
        What is no thin thing, as high as they are.
    thin : (m, 3) float64
        All points in short runs, m about the plan's origin, those on lines among them.
    """

    local: Floats
    direction: Floats
    group: Integers
    drives: Integers
    points: Integers
    solid: SolidCells
    thin: Floats


def wire_points(
    drives: Sequence[Drive],
    plan: SparsePlan,
    ground: NDArray[np.float32],
    lowest_m: float,
    monitor: Monitor,
) -> WirePoints:
    """All points that lie on thin free lines.

    Parameters
    ----------
    ground : (tiles, 16, 16) float32
        As :func:`ground_heights` found it.
    lowest_m : float
        Above the ground; lower lines are no wires.
    """
    intervals = [pulse_interval(drive) for drive in drives]

    def high_and_thin(chunk: DriveChunk) -> tuple[Floats, Integers, Integers, Integers]:
        short = thin_points(drives[chunk.drive], intervals[chunk.drive], chunk.start, chunk.local)
        high = ~chunk.is_noise
        high_kernel(chunk.local, plan.table, ground.reshape(-1), lowest_m, high)
        kept = np.flatnonzero(short & high)
        drive = np.full(kept.size, chunk.drive, np.int64)
        solid = solid_keys(chunk.local, high & ~short)
        return chunk.local[kept], drive, chunk.start + kept, solid

    parts = list(in_order(high_and_thin, chunks_of(drives, plan.origin, monitor)))
    local = np.concatenate([np.empty((0, 3)), *(one[0] for one in parts)])
    which = np.concatenate([np.empty(0, np.int64), *(one[1] for one in parts)])
    numbers = np.concatenate([np.empty(0, np.int64), *(one[2] for one in parts)])
    solid = SolidCells([one[3] for one in parts])
    return points_on_lines(local, which, numbers, solid, monitor)


def thin_points(drive: Drive, interval_s: float, start: int, local: Floats) -> NDArray[np.bool_]:
    """Which of a stretch of points lie in short runs along their scan line: (n,) bool.

    Parameters
    ----------
    interval_s : float
        As :func:`pulse_interval` told it.
    start : int
        Number of the first point.
    local : (n, 3) float64
        m about any origin.
    """
    times = np.asarray(drive.columns["time"][start : start + len(local)], np.float64)
    if interval_s == 0.0:
        times, interval_s = np.arange(len(local), dtype=np.float64), 1.0
    short = np.empty(len(local), np.bool_)
    short_runs_kernel(local, times, _NEAR_M, _PULSES * interval_s, _LONGEST_M, short)
    return short


def pulse_interval(drive: Drive) -> float:
    """Time between pulses, s; 0 for a recording without times."""
    if not drive.info.has_measured_times or drive.count < 3:
        return 0.0
    times = np.asarray(drive.columns["time"][: min(drive.count, 200_000)], np.float64)
    steps = np.diff(times)
    steps = steps[steps > 0]
    return float(np.quantile(steps, _INTERVAL_SHARE)) if steps.size else 0.0


def points_on_lines(
    local: Floats, which: Integers, numbers: Integers, solid: SolidCells, monitor: Monitor
) -> WirePoints:
    """Those of points in short runs that lie on thin free lines, and on which together.

    Parameters
    ----------
    local : (n, 3) float64
        m about any origin.
    which, numbers : (n,) int64
        Of which drive each is, and its number there.
    solid : SolidCells
        What else is there.
    """
    monitor.check()
    order, _, starts, grid = _sorted(local)
    monitor.check()
    local, which, numbers = local[order], which[order], numbers[order]
    thin = local
    crowded = np.zeros(len(local), np.bool_)
    for some in chunk_ranges(starts.size - 1, _CELLS_AT_ONCE):
        monitor.check()
        crowded_kernel(local, starts, grid, _MOST_FILLED, some, crowded)
    local, which, numbers = local[~crowded], which[~crowded], numbers[~crowded]
    for _ in range(2):
        # Points on lines tell the lines again, without what lay beside them.
        monitor.check()
        order, cells, starts, grid = _sorted(local)
        monitor.check()
        local, which, numbers = local[order], which[order], numbers[order]
        direction = _directions(local, cells, starts, grid, monitor)
        is_on = direction.any(axis=1)
        local, which, numbers = local[is_on], which[is_on], numbers[is_on]
    direction = direction[is_on]
    monitor.check()
    order, cells, starts, grid = _sorted(local)
    local, direction = local[order], direction[order]
    group = _groups(local, direction, (cells, starts, grid), monitor)
    return WirePoints(local, direction, group, which[order], numbers[order], solid, thin)


def _groups(
    local: Floats,
    direction: Floats,
    sorted_by: tuple[Integers, Integers, WireGrid],
    monitor: Monitor,
) -> Integers:
    """The first of the points that lie on each other's lines with each one."""
    cells, starts, grid = sorted_by
    half = len(cells) // 2

    def joined(part: tuple[int, int]) -> Integers:
        group = np.arange(len(local), dtype=np.int64)
        for first, last in chunk_ranges(part[1] - part[0], _CELLS_AT_ONCE):
            monitor.check()
            some = part[0] + first, part[0] + last
            groups_kernel(local, direction, cells, starts, grid, _LIMITS.core_m, some, group)
        return group

    group, other = in_order(joined, ((0, half), (half, len(cells))))
    both_kernel(group, other)
    firsts_kernel(group)
    return group


def _directions(
    local: Floats, cells: Integers, starts: Integers, grid: WireGrid, monitor: Monitor
) -> Floats:
    """The direction of the thin line through each of points that are sorted by cells."""
    direction = np.zeros_like(local)

    def measure(some: tuple[int, int]) -> None:
        monitor.check()
        lines_kernel(local, cells, starts, grid, _LIMITS, some, direction)

    for _ in in_order(measure, chunk_ranges(len(cells), _CELLS_AT_ONCE)):
        monitor.check()
    return direction


def _sorted(local: Floats) -> tuple[Integers, Integers, Integers, WireGrid]:
    """The order of points by cells, the filled cells, where each begins, and the grid."""
    if not len(local):
        none = np.empty(0, np.int64)
        return none, none, np.zeros(1, np.int64), WireGrid(np.zeros(3), np.ones(3, np.int64), 1.0)
    # A cell more on each side, so that the neighbours of each are others.
    low = local.min(axis=0) - 1.5 * _CELL_M
    shape = ((local.max(axis=0) - low) / _CELL_M).astype(np.int64) + 3
    where = ((local - low) / _CELL_M).astype(np.int64)
    keys = (where[:, 0] * shape[1] + where[:, 1]) * shape[2] + where[:, 2]
    order = np.argsort(keys, kind="stable")
    cells, first = np.unique(keys[order], return_index=True)
    starts = np.concatenate([first, [len(local)]]).astype(np.int64)
    return order, cells, starts, WireGrid(low, shape, _CELL_M)


@kernel
def high_kernel(
    local: Floats,
    table: NDArray[np.int32],
    ground: NDArray[np.float32],
    lowest_m: float,
    kept: Flags,
) -> None:
    """Drop what is low, or over no known ground."""
    for point in range(len(local)):
        if not kept[point]:
            continue
        cell = cell_of(local[point, 0], local[point, 1], table, GROUND_CELLS)
        kept[point] = cell >= 0 and local[point, 2] - ground[cell] >= lowest_m
