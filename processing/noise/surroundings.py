"""What lies around the points of a cloud: nested cells, what hangs together, the ground's height.

Sizes are taken relative to the spacing that the points should have at each place.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.monitor import Monitor
from processing.noise.cell_kernels import AROUND, COLUMN, CellLevel, around_kernel, column_kernel
from processing.noise.cell_levels import cell_levels
from processing.noise.connected import parts_of, sure_counts
from processing.noise.ground_heights import heights_above_ground
from processing.noise.morton import NestedCells, nested_cells
from processing.noise.sharing import shared_out

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

SCALES = 5
PER_SCALE = 8
PLACE_FEATURES = 4  # spacing, connection at two sizes, height
COLUMN_SCALES = (1, 3)
PART_SIZES = (2.0, 4.0, 8.0, 32.0)  # in median spacings
_LEVELS = 12
_FINEST_M = 0.02
_CELLS_AT_ONCE = 4_096
_MAIN_SHARE = 0.1
_LINK_M = 0.4
_LINK_SPACINGS = 3.0
_WIDER = 2  # levels, for the second size of what hangs together


@dataclass(frozen=True)
class Surroundings:
    """The cells of a cloud and what was found from them.

    Attributes
    ----------
    cells : NestedCells
    place : (n,) int64
        Where each point is along the cells' curve.
    spacings : (n,) float64
        m, of the points as given.
    levels : list of CellLevel
    is_main : (n,) bool
        Hangs together with a good part of the cloud's sure points; empty if not looked for.
    heights : (n,) float64
        m above the local ground, NaN where none is known; empty if not looked for.
    connected : tuple of (c,) float64
        Sure points in the part of each cell of the levels ``link`` and ``link`` + 2.
    link : int
        The level whose cells hang together when they touch.
    """

    cells: NestedCells
    place: _Integers
    spacings: _Floats
    levels: list[CellLevel]
    is_main: NDArray[np.bool_]
    heights: _Floats
    connected: tuple[_Floats, ...] = ()
    link: int = 0

    @classmethod
    def bare(cls, xyz: _Floats, spacings: _Floats, is_sure: NDArray[np.bool_]) -> Surroundings:
        """Without what hangs together and without heights."""
        finest = max(_FINEST_M, float(np.percentile(spacings, 2)))
        cells = nested_cells(xyz, finest)
        place = np.empty(cells.order.size, np.int64)
        place[cells.order] = np.arange(cells.order.size)
        levels = cell_levels(cells, is_sure[cells.order], _LEVELS)
        none = np.zeros(0)
        return cls(cells, place, spacings, levels, none.astype(np.bool_), none)

    @classmethod
    def of(cls, xyz: _Floats, spacings: _Floats, is_sure: NDArray[np.bool_]) -> Surroundings:
        """With everything."""
        bare = cls.bare(xyz, spacings, is_sure)
        middle = float(np.median(spacings))
        link = bare.level_of(max(_LINK_M, _LINK_SPACINGS * middle))
        wide = min(link + _WIDER, _LEVELS - 1)
        connected = (sure_counts(bare.levels[link]), sure_counts(bare.levels[wide]))
        is_main_cell = connected[0] >= _MAIN_SHARE * max(1, int(is_sure.sum()))
        codes = bare.cells.codes >> (3 * link)
        is_main = np.empty(xyz.shape[0], np.bool_)
        is_main[bare.cells.order] = is_main_cell[np.cumsum(np.r_[0, codes[1:] != codes[:-1]])]
        heights = heights_above_ground(xyz, is_sure, max(1.0, 4 * middle))
        return replace(bare, is_main=is_main, heights=heights, connected=connected, link=link)

    def level_of(self, size_m: float) -> int:
        """The level whose cells have about this size."""
        level = round(float(np.log2(max(size_m, 1e-6) / self.cells.cell_m)))
        return min(max(level, 0), _LEVELS - 1)

    def place_features(self, points: _Integers) -> _Floats:
        """(k, PLACE_FEATURES): log2 of the spacing, two of the connection, the height."""
        found = np.empty((points.size, PLACE_FEATURES))
        found[:, 0] = np.log2(self.spacings[points])
        wide = min(self.link + _WIDER, _LEVELS - 1)
        for column, level in enumerate((self.link, wide)):
            cells = self._cells_of(level, points)
            found[:, 1 + column] = np.log2(1 + self.connected[column][cells])
        height = np.nan_to_num(self.heights[points])  # 0 where no ground is known
        found[:, 3] = np.sign(height) * np.log2(1 + np.abs(height) / 0.05)
        return found

    def part_features(self, points: _Integers, level: int) -> _Floats:
        """(k, PART_FEATURES): what the part of the cloud looks like to which points belong."""
        parts = parts_of(self.levels[level])
        return parts.features[parts.numbers[self._cells_of(level, points)]]

    def scale_features(self, points: _Integers, ways: _Floats | None, monitor: Monitor) -> _Floats:
        """(k, SCALES × PER_SCALE): how points lie around; ``ways`` (k, 3) are their beams."""
        return np.column_stack(
            [self.scale_of(scale, points, monitor, ways) for scale in range(SCALES)]
        )

    def scale_of(
        self, scale: int, points: _Integers, monitor: Monitor, ways: _Floats | None = None
    ) -> _Floats:
        """(k, PER_SCALE): how points lie in 27 cells of 2 ** scale spacings around each."""
        found = np.empty((points.size, PER_SCALE))
        for level, chosen in self._by_level(points, scale):
            beams = None if ways is None else ways[chosen]
            found[chosen] = self._around(level, points[chosen], beams, monitor)
        return found

    def column_features(self, points: _Integers) -> _Floats:
        """(k, 2 × COLUMN): what lies straight above and below, at two sizes."""
        found = np.empty((points.size, len(COLUMN_SCALES) * COLUMN))
        for number, scale in enumerate(COLUMN_SCALES):
            block = slice(number * COLUMN, (number + 1) * COLUMN)
            for level, chosen in self._by_level(points, scale):
                codes = self.cells.codes[self.place[points[chosen]]] >> (3 * level)
                columns = np.empty((chosen.size, COLUMN))
                column_kernel(self.levels[level], codes, columns)
                found[chosen, block] = columns
        return found

    def _around(
        self, level: int, points: _Integers, ways: _Floats | None, monitor: Monitor
    ) -> _Floats:
        """(k, PER_SCALE): points, sure points, line, plane, scatter, offset, level, incidence."""
        cells, place = self.levels[level], self.place[points]
        mine_codes = self.cells.codes[place] >> (3 * level)
        codes, back = np.unique(mine_codes, return_inverse=True)
        around = np.empty((codes.size, AROUND))

        def add_up(start: int, stop: int) -> None:
            around_kernel(cells, codes[start:stop], around[start:stop])

        shared_out(add_up, codes.size, _CELLS_AT_ONCE, monitor)
        mine = around[back]
        normals = mine[:, 5:8]
        found = np.empty((place.size, PER_SCALE))
        found[:, 0:2] = np.log2(1 + mine[:, 0:2])
        found[:, 2:5] = mine[:, 2:5]
        offsets = (normals * self.cells.local_xyz[place]).sum(axis=1) - mine[:, 8]
        found[:, 5] = np.abs(offsets) / cells.side
        found[:, 6] = np.abs(normals[:, 2])
        found[:, 7] = 0.0 if ways is None else np.abs((normals * ways).sum(axis=1))
        return found

    def _by_level(self, points: _Integers, scale: int) -> list[tuple[int, _Integers]]:
        """Levels whose cells are 2 ** scale spacings wide, and which of the points have them."""
        wanted = np.log2(self.spacings[points] / self.cells.cell_m)
        levels = np.clip(np.rint(wanted).astype(np.int64) + scale, 0, _LEVELS - 1)
        return [(int(level), np.flatnonzero(levels == level)) for level in np.unique(levels)]

    def _cells_of(self, level: int, points: _Integers) -> _Integers:
        codes = self.cells.codes[self.place[points]] >> (3 * level)
        return np.searchsorted(self.levels[level].codes, codes)
