"""Measured points about rough curb lines, in the curved frame of each line.

Every block of a recording is looked through once; cells of the plan say which points are near a
line at all, so the time is linear in points however many lines there are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.curbs.edges.curb_point_kernels import (
    CellFrame,
    CellTable,
    LineReach,
    PlanLines,
    about_lines_kernel,
    fill_slots_kernel,
    in_cells_kernel,
    order_kernel,
)
from processing.recording.drive import Drive

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

BELOW_M, ABOVE_M = 0.3, 0.7
"""How far below and above a rough lower edge a point may lie to say something about a curb: the
ground before it and a rough line's error; the highest curb of 45 cm (Takahashi 2022, Table 6-1) and
the same error."""

POINTS_AT_ONCE = 500_000
"""Points read at a time: 6 MB of coordinates, and short enough for a cancel to be felt at once."""

_CELL_M, _COARSE_M = 0.25, 2.0
"""Cells of the plan: that of lines is some half of how far from them points are wanted (0.4 m),
that of whole ends is coarse, since 30 m about each are looked at. They change only the time."""

_X_KEY = 0x100000000
"""As in `curb_point_kernels`."""

_ROUNDED_M = 0.001
"""Two origins make one place two numbers: far more than they differ by."""


@dataclass(frozen=True)
class PointsAbout:
    """The points of one drive about approximate lines, line by line and along each.

    Attributes
    ----------
    starts : (g + 1,) int64
        Where each line's points begin.
    along : (n,) float64
        Station of the approximate line, counted in its vertices.
    across : (n,) float64
        m from its line towards the higher ground, in plan.
    above : (n,) float64
        m above it.
    point : (n,) int64
        Index in the drive.
    """

    starts: _Integers
    along: _Floats
    across: _Floats
    above: _Floats
    point: _Integers


class PlanLine(Protocol):
    """A line in plan: places (m, 3) and level unit vectors to one side of it (m, 2)."""

    @property
    def xyz(self) -> _Floats:
        """Places, m, project CRS."""

    @property
    def outwards(self) -> _Floats:
        """Unit vectors."""


@dataclass(frozen=True)
class ChosenPoints:
    """Some points of a drive, and which of them lie in which cell of the plan.

    Attributes
    ----------
    points : (n,) int64
        Their indices, rising.
    integers : (n, 3) int32
        Coordinates as delivered.
    origin : (3,) float64
        Of the cells, m, project CRS.
    keys : (c,) int64
        Of the cells, rising.
    order, starts : (n,), (4 c + 1,) int64
        Places in ``points``, quarter of a cell by quarter, and where each quarter begins.
    """

    points: _Integers
    integers: NDArray[np.int32]
    origin: _Floats
    keys: _Integers
    order: _Integers
    starts: _Integers

    def about(self, approximate_lines: Sequence[PlanLine], across_m: float) -> _Integers:
        """(k,) places in ``points``, rising: those in all quarters that lines come near to."""
        parts = []
        for approximate_line in approximate_lines:
            ends = approximate_line.xyz[:, :2] - self.origin[:2]
            _, x, y = _boxes((ends[:-1], ends[1:]), across_m + _ROUNDED_M, _COARSE_M / 2)
            parts.append(((x >> 1) * _X_KEY + (y >> 1)) * 4 + (x & 1) * 2 + (y & 1))
        quarters = np.unique(np.concatenate(parts))
        cell = np.minimum(np.searchsorted(self.keys, quarters >> 2), self.keys.size - 1)
        quarters = (4 * cell + (quarters & 3))[self.keys[cell] == quarters >> 2]
        spans = [self.order[self.starts[one] : self.starts[one + 1]] for one in quarters]
        return np.sort(_join(spans))


def points_near(
    drive: Drive, positions: _Floats, reach: tuple[float, float], monitor: Monitor
) -> ChosenPoints:
    """Points of a drive about places, by cells of the plan.

    Parameters
    ----------
    positions : (n, 3) float64
        At least one.
    reach : tuple of float
        How far aside, and how far above or below, m.
    """
    origin: _Floats = np.floor(positions[0])
    keys, heights = _cells_about(positions - origin, reach)
    slots = _slots_of(keys)
    frame = _frame_of(drive, origin, _COARSE_M)
    points, integers, quarters = [], [np.empty((0, 3), np.int32)], []

    def near(start: int) -> tuple[_Integers, NDArray[np.int32], _Integers]:
        monitor.check()
        stop = min(start + POINTS_AT_ONCE, drive.count)
        block = drive.coordinates.chunk(start, stop)
        chosen, quarter = np.empty(stop - start, np.int64), np.empty(stop - start, np.int64)
        count = in_cells_kernel(block, frame, (slots, keys), heights, (chosen, quarter))
        return chosen[:count] + start, block[chosen[:count]], quarter[:count].copy()

    starts = range(0, drive.count, POINTS_AT_ONCE)
    for done, found in enumerate(in_order(near, starts), 1):
        points.append(found[0])
        integers.append(found[1])
        quarters.append(found[2])
        monitor.report(done / len(starts))
    quarter = _join(quarters)
    begins = np.concatenate([[0], np.cumsum(np.bincount(quarter, minlength=4 * keys.size))])
    order = np.empty(quarter.size, np.int64)
    order_kernel(quarter, begins[:-1].copy(), order)
    return ChosenPoints(_join(points), np.vstack(integers), origin, keys, order, begins)


def _cells_about(positions: _Floats, reach: tuple[float, float]) -> tuple[_Integers, _Floats]:
    """Keys of the coarse cells about places, and (n, 2) the heights that are near in each."""
    aside = int(np.ceil(reach[0] / _COARSE_M))
    steps = np.arange(-aside, aside + 1)
    cells = np.floor(positions[:, :2] / _COARSE_M).astype(np.int64)
    x = (cells[:, 0, None, None] + steps[None, :, None]) * _X_KEY
    keys = (x + cells[:, 1, None, None] + steps[None, None, :]).reshape(len(positions), -1)
    z = np.repeat(positions[:, 2], keys.shape[1])
    unique, where = np.unique(keys.ravel(), return_inverse=True)
    heights = np.tile([np.inf, -np.inf], (unique.size, 1))
    np.minimum.at(heights[:, 0], where, z - reach[1])
    np.maximum.at(heights[:, 1], where, z + reach[1])
    return unique, heights


def _slots_of(keys: _Integers) -> _Integers:
    slots = np.full(1 << max(2, int(2 * keys.size).bit_length()), -1, np.int64)
    fill_slots_kernel(keys, slots)
    return slots


def _frame_of(drive: Drive, origin: _Floats, cell_m: float) -> CellFrame:
    """What makes metres about an origin of integers, and the size of a cell."""
    scale, shift = drive.coordinates.quantisation.about(origin)
    (scale_x, scale_y, scale_z), (x, y, z) = scale.tolist(), shift.tolist()
    return CellFrame(scale_x, scale_y, scale_z, x, y, z, cell_m)


class LineCells:
    """Which approximate lines pass through which cells of the plan.

    Parameters
    ----------
    approximate_lines : sequence of PlanLine
        At least one.
    across_m : float
        How far from an approximate line points are wanted.
    """

    def __init__(self, approximate_lines: Sequence[PlanLine], across_m: float) -> None:
        self._approximate_lines = approximate_lines
        sizes = np.array([approximate_line.xyz.shape[0] for approximate_line in approximate_lines])
        self.firsts: _Integers = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
        self.origin: _Floats = np.floor(approximate_lines[0].xyz[0])
        self._xyz = (
            np.vstack([approximate_line.xyz for approximate_line in approximate_lines])
            - self.origin
        )
        self._outwards = np.ascontiguousarray(
            np.vstack([approximate_line.outwards for approximate_line in approximate_lines])
        )
        self._line_of = np.repeat(np.arange(sizes.size), sizes).astype(np.int64)
        self._reach = LineReach(across_m, BELOW_M, ABOVE_M)
        self._table = self._table_of(across_m)

    def about(
        self, drive: Drive, monitor: Monitor, points_at_once: int = POINTS_AT_ONCE
    ) -> PointsAbout:
        """Points of a drive about the approximate lines."""
        frame = _frame_of(drive, self.origin, _CELL_M)
        points, owners, values = [], [], []

        def near(start: int) -> tuple[_Integers, _Integers, _Floats]:
            monitor.check()
            stop = min(start + points_at_once, drive.count)
            found = self._find(drive.coordinates.chunk(start, stop), frame)
            return found[0] + start, found[1], found[2]

        starts = range(0, drive.count, points_at_once)
        for done, found in enumerate(in_order(near, starts), 1):
            points.append(found[0])
            owners.append(found[1])
            values.append(found[2])
            monitor.report(done / len(starts))
        return self._by_approximate_line(
            _join(points), _join(owners), np.vstack([*values, _NO_VALUES])
        )

    def among(self, drive: Drive, chosen: ChosenPoints) -> PointsAbout:
        """Points about the approximate lines among some of a drive."""
        near = chosen.about(self._approximate_lines, self._reach.across_m)
        frame = _frame_of(drive, self.origin, _CELL_M)
        which, owners, values = self._find(chosen.integers[near], frame)
        return self._by_approximate_line(chosen.points[near[which]], owners, values)

    def _find(
        self, integers: NDArray[np.int32], frame: CellFrame
    ) -> tuple[_Integers, _Integers, _Floats]:
        lines = PlanLines(self._xyz, self._outwards, self._line_of)
        most = max(integers.shape[0], 1)
        while True:
            room = (np.empty(most, np.int64), np.empty(most, np.int64), np.empty((most, 3)))
            count = about_lines_kernel(integers, frame, self._table, lines, self._reach, room)
            if count >= 0:
                return room[0][:count].copy(), room[1][:count].copy(), room[2][:count].copy()
            most *= 2

    def _by_approximate_line(
        self, points: _Integers, owners: _Integers, values: _Floats
    ) -> PointsAbout:
        order = np.argsort(values[:, 0], kind="stable")
        starts = np.concatenate([[0], np.cumsum(np.bincount(owners, minlength=self._count))])
        along = values[order, 0] - self.firsts[owners[order]]
        return PointsAbout(
            starts.astype(np.int64),
            along,
            np.ascontiguousarray(values[order, 1]),
            np.ascontiguousarray(values[order, 2]),
            points[order],
        )

    @property
    def _count(self) -> int:
        return self.firsts.size - 1

    def _table_of(self, across_m: float) -> CellTable:
        segments = np.flatnonzero(self._line_of[:-1] == self._line_of[1:])
        ends = self._xyz[:, :2]
        which, x, y = _boxes((ends[segments], ends[segments + 1]), across_m, _CELL_M)
        keys = x * _X_KEY + y
        order = np.lexsort((which, keys))
        unique, starts = np.unique(keys[order], return_index=True)
        starts = np.append(starts, which.size)
        return CellTable(_slots_of(unique), unique, starts, segments[which[order]])


_NO_VALUES = np.empty((0, 3))


def _boxes(
    ends: tuple[_Floats, _Floats], across_m: float, cell_m: float
) -> tuple[_Integers, _Integers, _Integers]:
    """Which segments come near to which cells (x, y) of the plan."""
    first = np.floor((np.minimum(*ends) - across_m) / cell_m).astype(np.int64)
    count = np.floor((np.maximum(*ends) + across_m) / cell_m).astype(np.int64) - first + 1
    per = count[:, 0] * count[:, 1]
    which = np.repeat(np.arange(per.size), per)
    within = np.arange(which.size) - np.repeat(np.cumsum(per) - per, per)
    x = first[which, 0] + within // count[which, 1]
    return which, x, first[which, 1] + within % count[which, 1]


def _join(parts: Sequence[_Integers]) -> _Integers:
    return np.concatenate([*parts, np.empty(0, np.int64)])
