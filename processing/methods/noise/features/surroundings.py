"""What lies around the points of a cloud: nested cells, what hangs together, the ground's height.

Sizes are taken relative to the spacing that the points should have at each position.

Sizes and limits here shape what the trees are told (see :mod:`processing.methods.noise.combined`):
they learned with these values, so that a change asks for new training. They were set by trial, on
simulated scenes; no measurement varied one alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.methods.noise.features.cell_kernels import (
    AROUND,
    COLUMN,
    CellLevel,
    around_kernel,
    column_kernel,
    held_kernel,
    mean_around_kernel,
    point_features_kernel,
)
from processing.methods.noise.features.cell_levels import cell_levels, count_sure
from processing.methods.noise.features.connected import Parts, parts_of, sure_counts
from processing.methods.noise.features.ground_heights import GroundGrid, ground_below
from processing.methods.noise.neighbours.morton import NestedCells, nested_cells
from processing.methods.noise.neighbours.sharing import share_out

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]
_Rows = NDArray[np.float32]

SCALES = 5
"""Sizes of cells that are looked at around a point: 1, 2, 4, 8 and 16 spacings."""

PER_SCALE = 8
"""Features of each; see :func:`~.cell_kernels.point_features_kernel`."""

PLACE_FEATURES = 4
"""Spacing, connection at two sizes, height."""

COLUMN_SCALES = (1, 3)
"""Sizes of cells, 2 ** scale spacings, of which those straight above and below are looked at."""

PART_SIZES = (2.0, 4.0, 8.0, 32.0)
"""Sizes of cells, in median spacings, whose connected parts are looked at where no beams are
known."""

_LEVELS = 12
"""Sizes of cells that are kept, each twice the one before: from 2 cm up to 41 m."""

_FINEST_M, _FINEST_PERCENT = 0.02, 2
"""Smallest cells: this percentile of the spacings, but not below what scanners resolve."""

_CELLS_AT_ONCE = 4_096
_POINTS_AT_ONCE = 65_536
"""Cells and points of a share of a core's work."""

_MAIN_SHARE = 0.1
"""Of all sure points, from which a connected part is one that noise does not make."""

_LINK_M, _LINK_SPACINGS = 0.4, 3.0
"""Size of cells that hang together when they touch, at least, and in median spacings."""

_WIDER_LEVELS = 2
"""By which the second size of what hangs together is wider: four times."""

_GROUND_CELL_M, _GROUND_CELL_SPACINGS = 1.0, 4
"""Cells of the ground, at least, and in median spacings."""

_HEIGHT_UNIT_M = 0.05
"""Height above the ground up to which the feature grows evenly, and above it as its logarithm."""

_LEAST_SIZE_M = 1e-6
"""Keeps the logarithm of a cloud's spacing finite where all points lie at one position."""


class _PointsInCells(NamedTuple):
    """Which cell each point is in, where it is along the curve, and its beam if that is known."""

    cells: _Integers
    positions: _Integers
    directions: _Floats


@dataclass(frozen=True)
class CloudNeighbourhood:
    """The cells of a cloud and what was found from them.

    Attributes
    ----------
    cells : NestedCells
    position : (n,) int64
        Where each point is along the cells' curve.
    spacings : (n,) float64
        m, of the points as given.
    middle_m : float
        Their median.
    levels : list of CellLevel
    numbers : list of (…,) int32
        Which cell holds what, as :func:`processing.methods.noise.features.cell_levels.cell_levels`.
    is_main : (n,) bool
        Hangs together with a good part of the cloud's sure points; empty if not looked for.
    ground : GroundGrid
        Empty if not looked for.
    connected : tuple of (c,) float64
        Sure points in the part of each cell of the levels ``link`` and ``link`` + 2.
    link : int
        The level whose cells hang together when they touch.
    parts : dict
        What :meth:`parts_at` found.
    """

    cells: NestedCells
    position: _Integers
    spacings: _Floats
    middle_m: float
    levels: list[CellLevel]
    numbers: list[NDArray[np.int32]]
    is_main: NDArray[np.bool_]
    ground: GroundGrid
    connected: tuple[_Floats, ...] = ()
    link: int = 0
    parts: dict[int, Parts] = field(default_factory=dict)

    @classmethod
    def bare(cls, xyz: _Floats, spacings: _Floats) -> CloudNeighbourhood:
        """Without what hangs together and without heights; no point is sure as yet."""
        finest = max(_FINEST_M, float(np.percentile(spacings, _FINEST_PERCENT)))
        cells = nested_cells(xyz, finest)
        position = np.empty(cells.order.size, np.int64)
        position[cells.order] = np.arange(cells.order.size)
        levels, numbers = cell_levels(cells, _LEVELS)
        none = np.zeros(0, np.bool_)
        middle = float(np.median(spacings))
        return cls(cells, position, spacings, middle, levels, numbers, none, GroundGrid.none())

    @classmethod
    def of(cls, xyz: _Floats, spacings: _Floats, is_sure: NDArray[np.bool_]) -> CloudNeighbourhood:
        """With everything."""
        return cls.bare(xyz, spacings).completed(xyz, is_sure)

    def completed(self, xyz: _Floats, is_sure: NDArray[np.bool_]) -> CloudNeighbourhood:
        """A bare one with everything; it shares the levels, in which sure points are counted."""
        count_sure(self.levels, self.numbers, is_sure[self.cells.order])
        middle = self.middle_m
        link = self.level_of(max(_LINK_M, _LINK_SPACINGS * middle))
        wide = min(link + _WIDER_LEVELS, _LEVELS - 1)
        connected = (sure_counts(self.levels[link]), sure_counts(self.levels[wide]))
        is_main_cell = connected[0] >= _MAIN_SHARE * max(1, int(is_sure.sum()))
        is_main = np.empty(xyz.shape[0], np.bool_)
        is_main[self.cells.order] = is_main_cell[self.held_by(link, slice(None))]
        cell_m = max(_GROUND_CELL_M, _GROUND_CELL_SPACINGS * middle)
        ground = ground_below(xyz, is_sure, cell_m)
        return replace(self, is_main=is_main, ground=ground, connected=connected, link=link)

    @property
    def heights(self) -> _Floats:
        """(n,) m above the local ground, NaN where none is known; empty if not looked for."""
        return self.ground.heights

    def level_of(self, size_m: float) -> int:
        """The level whose cells have about this size."""
        level = round(float(np.log2(max(size_m, _LEAST_SIZE_M) / self.cells.cell_m)))
        return min(max(level, 0), _LEVELS - 1)

    def place_features(self, points: _Integers) -> _Rows:
        """(k, PLACE_FEATURES): log2 of the spacing, two of the connection, the height."""
        found = np.empty((points.size, PLACE_FEATURES), np.float32)
        found[:, 0] = np.log2(self.spacings[points])
        wide = min(self.link + _WIDER_LEVELS, _LEVELS - 1)
        for column, level in enumerate((self.link, wide)):
            found[:, 1 + column] = np.log2(1 + self.connected[column])[self.cells_of(level, points)]
        height = np.nan_to_num(self.heights[points])  # 0 where no ground is known
        found[:, 3] = np.sign(height) * np.log2(1 + np.abs(height) / _HEIGHT_UNIT_M)
        return found

    def part_features(self, points: _Integers, level: int) -> _Rows:
        """(k, PART_FEATURES): what the part of the cloud looks like to which points belong."""
        parts = self.parts_at(level)
        return parts.features[parts.numbers[self.cells_of(level, points)]]

    def parts_at(self, level: int) -> Parts:
        """What hangs together at a level; looked for once."""
        if level not in self.parts:
            self.parts[level] = parts_of(self.levels[level])
        return self.parts[level]

    def scale_features(
        self,
        points: _Integers,
        directions: _Floats | None,
        monitor: Monitor,
        scales: Sequence[int] = range(SCALES),
    ) -> _Rows:
        """(k, scales × PER_SCALE): how points lie around, in 27 cells of 2 ** scale spacings.

        Per scale: points, sure points, line, plane, scatter, offset, level, incidence;
        ``directions`` (k, 3) are the points' beams.
        """
        found = np.empty((points.size, len(scales) * PER_SCALE), np.float32)
        own, positions = self.own_levels(points), self.position[points]
        at = [self.level_at(own, scale) for scale in scales]
        held = [self.cells_at(levels, points) for levels in at]
        for level in range(_LEVELS):
            of_scale = [np.flatnonzero(levels == level) for levels in at]
            if not any(chosen.size for chosen in of_scale):
                continue
            groups = [cells[chosen] for cells, chosen in zip(held, of_scale, strict=True)]
            around, slots = self.around(level, groups, monitor)
            for number, (chosen, cells) in enumerate(zip(of_scale, slots, strict=True)):
                block = np.empty((chosen.size, PER_SCALE), np.float32)
                beams = np.empty((0, 3)) if directions is None else directions[chosen]
                of_points = _PointsInCells(cells, positions[chosen], beams)
                self._fill_features(level, around, of_points, block, monitor)
                found[chosen, number * PER_SCALE : (number + 1) * PER_SCALE] = block
        return found

    def means_around(self, level: int, points: _Integers, totals: _Floats) -> _Rows:
        """(k,): the mean of a value in the 27 cells around each point; ``totals`` per cell."""
        cells = self.levels[level]
        used, (back,) = self._used_cells(level, [self.cells_of(level, points)])
        found = np.empty(used.size, np.float32)
        mean_around_kernel(cells, cells.codes[used], totals, found)
        return found[back]

    def column_features(self, points: _Integers) -> _Rows:
        """(k, 2 × COLUMN): what lies straight above and below, at two sizes."""
        found = np.empty((points.size, len(COLUMN_SCALES) * COLUMN), np.float32)
        own = self.own_levels(points)
        for number, scale in enumerate(COLUMN_SCALES):
            block = slice(number * COLUMN, (number + 1) * COLUMN)
            levels = self.level_at(own, scale)
            for level in np.unique(levels):
                chosen = np.flatnonzero(levels == level)
                used, (back,) = self._used_cells(level, [self.cells_of(level, points[chosen])])
                columns = np.empty((used.size, COLUMN), np.float32)
                column_kernel(self.levels[level], self.levels[level].codes[used], columns)
                found[chosen, block] = columns[back]
        return found

    def held_by(self, level: int, positions: _Integers | slice) -> NDArray[np.int32]:
        """The cell of a level that holds each of some positions along the curve."""
        cells = self.numbers[0][positions]
        for above in range(1, level + 1):
            cells = self.numbers[above][cells]
        return cells

    def cells_of(self, level: int, points: _Integers) -> NDArray[np.int32]:
        """The cell of a level that holds each of some points."""
        return self.held_by(level, self.position[points])

    def cells_at(self, levels: NDArray[np.int8], points: _Integers) -> NDArray[np.int32]:
        """The cell that holds each of some points, each at a level of its own."""
        found = np.empty(points.size, np.int32)
        held_kernel(tuple(self.numbers), levels, self.position[points], found)
        return found

    def own_levels(self, points: _Integers) -> _Integers:
        """(k,) level whose cells are about a spacing wide, below zero where none is so fine."""
        wanted = np.log2(self.spacings[points] / self.cells.cell_m)
        own: _Integers = np.rint(wanted).astype(np.int64)
        return own

    def level_at(self, own: _Integers, scale: int) -> NDArray[np.int8]:
        """The levels whose cells are 2 ** scale times as wide, as far as there are any."""
        levels: NDArray[np.int8] = np.clip(own + scale, 0, _LEVELS - 1).astype(np.int8)
        return levels

    def around(
        self, level: int, groups: list[NDArray[np.int32]], monitor: Monitor
    ) -> tuple[_Floats, list[_Integers]]:
        """What lies around the cells of some groups, and where each group's are in it.

        (k, AROUND), as :func:`~.cell_kernels.around_kernel` tells.
        """
        cells = self.levels[level]
        used, positions = self._used_cells(level, groups)
        codes, around = cells.codes[used], np.empty((used.size, AROUND))

        def add_up(start: int, stop: int) -> None:
            around_kernel(cells, codes[start:stop], around[start:stop])

        share_out(add_up, used.size, _CELLS_AT_ONCE, monitor)
        return around, positions

    def _used_cells(
        self, level: int, groups: list[NDArray[np.int32]]
    ) -> tuple[_Integers, list[_Integers]]:
        """The cells of some groups, rising, and where each group's are in them."""
        is_used = np.zeros(self.levels[level].codes.size, np.bool_)
        for one in groups:
            is_used[one] = True
        positions = np.cumsum(is_used) - 1
        return np.flatnonzero(is_used), [positions[one] for one in groups]

    def _fill_features(
        self,
        level: int,
        around: _Floats,
        of_points: _PointsInCells,
        found: _Rows,
        monitor: Monitor,
    ) -> None:
        cells, positions, directions = of_points

        def fill(start: int, stop: int) -> None:
            part = slice(start, stop)
            point_features_kernel(
                self.levels[level],
                around,
                cells[part],
                self.cells.local_xyz,
                positions[part],
                directions[part],
                found[part],
            )

        share_out(fill, cells.size, _POINTS_AT_ONCE, monitor)
