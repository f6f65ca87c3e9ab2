"""Ground without a parameter to set: the surface of a whole cloud, found in passes over blocks.

Where a constant says “by trial”, no measurement varied it alone: docs/accuracy.md judges all values
together, on simulated earthwork sites and on airborne samples of the ISPRS filter test.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.ground.filters.band import (
    GroundBand,
    Tolerances,
    classify,
    ground_band,
    heights_at,
)
from processing.methods.ground.filters.cell_positions import Blocks
from processing.methods.ground.filters.cells import (
    CellGrid,
    LevelsAboveFloor,
    choose_cells,
    levels_above,
)
from processing.methods.ground.filters.chords import carried_on, single_bumps
from processing.methods.ground.filters.islands import crowded_islands
from processing.methods.ground.filters.layers import begin_of_ground
from processing.methods.ground.filters.morphology import fill_heights, steepness_of
from processing.methods.ground.filters.neighbours import off_neighbours
from processing.methods.ground.filters.points_below_ground import ghosts, sunk_points
from processing.methods.ground.filters.regions import (
    ObjectShape,
    standing_cells,
    standing_segments,
)

_ROUNDS = 2
"""Most rounds in which points under the ground are taken away, each two passes over the cloud: the
second sees what the first uncovered. By trial; once it was three."""

_CROWDED_M = 1.5
"""Something less than this above the lowest point crowds a cell: it stands on the ground, as
machines and plants do, while a branch, a roof or a wire is higher. By trial."""

_NEAR_PER_ABOVE = 20
"""Points near the lowest for each one above, from which the one above is a stray: 5 %. By trial,
on sites with thousands of points in a cell, where every cell had one."""

_FEW_SHARE = 1e-3
"""Share of the measured cells below which ghosts are not worth another round; by trial."""

_GAP_CELLS = 4
"""Gaps up to so many cells wide between measured ground count as measured: heights change little
over them, and the lowest points of a sparse cloud leave such gaps everywhere. By trial."""

_COARSE_CELL_M = 0.5
"""Larger cells are chosen where a cloud has about one point in each, as from the air; then three
cell sizes are asked."""

_OTHER_SIZES = (0.92, 1.09)
"""The other two, as shares of the first and about each other's reciprocal: near enough to show the
same things, and their borders fall elsewhere. Mean total error on five ISPRS samples 3.26 % with
one size, 2.89 % with three."""

_AGREEING_SIZES = 2
"""Of the three: the majority."""

_WITHIN_CELL = 0.5
"""Of a cell's rise: a point lies up to half a side from the cell's centre."""

_MARGIN_SHARE, _MARGIN_M = 0.12, 0.025
"""How far below the ground around them cells of ghosts begin again: this share of a side, 7° of
slope, and the roughness of graded ground. By trial."""

_JUST_ABOVE_M = 1e-3
"""They begin at least so far above the ghost itself, which is thus left out: more than single
precision rounds off, less than a scanner measures."""

_GAP_M, _GAP_SHARE = 0.10, 0.6
"""What lies this far above a cell's lowest point is clearly above it; in larger cells this share of
a side, since on a slope of 31° the ground itself rises so much. By trial."""

_LEFT_PER_PASS = 0.85
"""What of the progress bar is left after a pass: how many there will be is not known before. After
the usual twenty it stands at 96 %."""


@dataclass(frozen=True)
class GroundAssumptions:
    """What ground and the things on it are like; the same for every kind of survey.

    Attributes
    ----------
    widest_m : float
        Width of the largest thing that may stand on the ground and is seen from beside, a hall.
    widest_roof_m : float
        The same seen from above, in a cloud with about one point in a cell: halls of works and
        stations.
    grid_m : float
        Side of a cell; 0 lets the data choose it.
    rise_m, rise_share : float
        A bump up to this, and this share of a cell's side, is the ground's own: ruts and clods,
        and a slope of 9° within a cell. By trial.
    flank : float
        Rise over the half width of a window, 6°, from which a bump is looked at. By trial.
    steep, steep_small : float
        Rise over run of the sides of a thing: 39°, about as steep as loose earth lies; of one a
        few cells wide 17° at least, since the cells blur its sides. By trial.
    lowest_thing_m : float
        Rise from one cell to the next that the side of a thing has, m, about a kerb's height:
        small cells blur it less, and ask more than 17°. Kappa of four dates of two sites .963,
        .953, .912 and .940 without; the same within .004 from .12 to .25 m.
    rim_share : float
        Share of its rim along which a thing has such sides: less than half, since a thing against
        a bank or another thing shows only some of them. By trial.
    tolerances : Tolerances
    """

    widest_m: float = 50.0
    widest_roof_m: float = 80.0
    grid_m: float = 0.0
    rise_m: float = 0.05
    rise_share: float = 0.15
    flank: float = 0.10
    steep: float = 0.8
    steep_small: float = 0.3
    lowest_thing_m: float = 0.15
    rim_share: float = 0.45
    tolerances: Tolerances = field(default_factory=Tolerances)

    def widest_in(self, size_m: float) -> float:
        """Width of the largest thing in a cloud with cells of ``size_m``, m."""
        return self.widest_roof_m if size_m > _COARSE_CELL_M else self.widest_m


@dataclass(frozen=True)
class GroundSurface:
    """Ground of a cloud, everywhere within its extent.

    Attributes
    ----------
    grid : CellGrid
    band : GroundBand
    measured : (rows, columns) bool
        Cells in which ground was measured, and gaps up to four cells wide between such; elsewhere
        the surface is only filled in.
    """

    grid: CellGrid
    band: GroundBand
    measured: NDArray[np.bool_]

    def is_ground(self, xyz: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Which points are ground: (n,) bool; (n, 3) float64, m, in any order and any blocks."""
        return classify(xyz, self.grid, self.band)

    def heights_at(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        """Ground height at positions, m: (n,) float64; NaN outside the cloud's extent."""
        return heights_at(xy, self.grid, self.band.heights)

    def is_filled_at(self, xy: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether the height at a position is filled in and not measured: (n,) bool."""
        cells = np.floor((xy - self.grid.origin[:2]) / self.grid.size_m)
        limits = np.array([self.grid.columns - 1, self.grid.rows - 1])
        column, row = np.clip(np.nan_to_num(cells), 0, limits).astype(np.int64).T
        outside = ~np.all((cells >= 0) & (cells <= limits), axis=1)
        filled_in: NDArray[np.bool_] = outside | ~self.measured[row, column]
        return filled_in


def find_ground(
    blocks: Blocks, habits: GroundAssumptions, monitor: Monitor, grid: CellGrid | None = None
) -> GroundSurface:
    """The ground of a whole cloud, in some twenty passes over its blocks.

    Parameters
    ----------
    blocks : callable
        Gives the cloud's blocks, each (n, 3) float64, m, afresh at every call. How it is cut, and
        the order of the points, change nothing in the result.
    grid : CellGrid, optional
        The cells to use; points outside them are passed over. Without it the data choose it.

    Raises
    ------
    OutOfRange
        Without a grid: points at fewer than three positions.

    Notes
    -----
    Of a sparse cloud, with about one point in a cell, three cell sizes are asked.

    Memory: some 80 bytes a cell, and for a while 100 more for each with fifty points or with
    something standing in it, whatever the number of points; cells are larger where a cloud's
    extent would need more than ``cells.MOST_CELLS``.
    """
    passes = _Passes(blocks, monitor)
    grid = choose_cells(passes, habits.grid_m) if grid is None else grid
    levels, ground = _ground_cells(passes, grid, habits)
    if grid.size_m > _COARSE_CELL_M:
        ground = _agreed(passes, grid, habits, levels.lowest, ground)
    surface = fill_heights(levels.lowest, ground)
    band = ground_band(passes, grid, surface, ground, habits.tolerances)
    return GroundSurface(grid, band, _without_small_gaps(ground))


def _ground_cells(
    blocks: Blocks, grid: CellGrid, habits: GroundAssumptions
) -> tuple[LevelsAboveFloor, NDArray[np.bool_]]:
    is_sparse = grid.size_m > _COARSE_CELL_M
    shape = ObjectShape(
        widest_m=habits.widest_in(grid.size_m),
        rise_m=habits.rise_m + habits.rise_share * grid.size_m,
        flank=habits.flank,
        steep=habits.steep,
        rim_share=habits.rim_share,
        small_steep=min(max(habits.lowest_thing_m / grid.size_m, habits.steep_small), habits.steep),
    )
    levels, standing = _lowest_ground(blocks, grid, shape)
    ground = np.isfinite(levels.lowest) & ~standing
    if not ground.any():
        ground = np.isfinite(levels.lowest)
    crowded = _crowded(levels)
    ground &= ~off_neighbours(levels.lowest, ground, crowded, grid.size_m)
    if is_sparse:
        ground = _followed_on_slopes(levels.lowest, ground, grid.size_m, shape)
    else:
        ground &= ~crowded_islands(levels.lowest, ground, crowded, grid.size_m)
    return levels, ground


def _followed_on_slopes(
    lowest: NDArray[np.float32], ground: NDArray[np.bool_], size_m: float, shape: ObjectShape
) -> NDArray[np.bool_]:
    """Ground cells of a sparse cloud, with crests and faces, without wide roofs and shrubs."""
    segments = standing_segments(lowest, ground, size_m, shape)
    if (ground & ~segments).any():
        ground = ground & ~segments
    ground = ground & ~single_bumps(lowest, ground, size_m)
    return carried_on(lowest, ground, shape.rise_m)


def _agreed(
    blocks: Blocks,
    grid: CellGrid,
    habits: GroundAssumptions,
    lowest: NDArray[np.float32],
    ground: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """Cells that are ground for two of three cell sizes.

    With about one point in a cell, where its borders fall decides whether a courtyard is joined
    to the street or a roof to a bank beside it.
    """
    votes = ground.astype(np.uint8)
    row, column = np.nonzero(np.isfinite(lowest))
    positions = grid.origin[:2] + grid.size_m * (np.column_stack([column, row]) + 0.5)
    for share in _OTHER_SIZES:
        size_m = grid.size_m * share
        rows = int(np.ceil(grid.rows / share)) + 1
        columns = int(np.ceil(grid.columns / share)) + 1
        other = CellGrid(grid.origin, size_m, rows, columns)
        levels, is_ground = _ground_cells(blocks, other, habits)
        surface = fill_heights(levels.lowest, is_ground)
        slope = heights_at(positions, other, steepness_of(surface, size_m)) - grid.origin[2]
        off = heights_at(positions, other, surface) - grid.origin[2] - lowest[row, column]
        reach = habits.rise_m + grid.size_m * (habits.rise_share + _WITHIN_CELL * slope)
        votes[row, column] += np.abs(off) <= reach
    agreed: NDArray[np.bool_] = votes >= _AGREEING_SIZES
    return agreed if agreed.any() else ground


def _without_small_gaps(ground: NDArray[np.bool_]) -> NDArray[np.bool_]:
    import cv2

    element = np.ones((_GAP_CELLS + 1, _GAP_CELLS + 1), np.uint8)
    closed = cv2.morphologyEx(ground.astype(np.uint8), cv2.MORPH_CLOSE, element)
    return closed > 0


class _Passes:
    """Blocks that tell a monitor how many passes were made."""

    def __init__(self, blocks: Blocks, monitor: Monitor) -> None:
        self._blocks = blocks
        self._monitor = monitor
        self._done = 0

    def __call__(self) -> Iterator[NDArray[np.float64]]:
        self._done += 1
        self._monitor.report(
            1.0 - _LEFT_PER_PASS**self._done,
            Text("Looking for the ground", "地面を探しています"),
        )
        for xyz in self._blocks():
            self._monitor.check()
            yield xyz


def _lowest_ground(
    blocks: Blocks, grid: CellGrid, shape: ObjectShape
) -> tuple[LevelsAboveFloor, NDArray[np.bool_]]:
    """Lowest heights that are not under the ground, and the cells where they lie on things."""
    size_m = grid.size_m
    gap_m = max(_GAP_M, _GAP_SHARE * size_m)
    floor = np.full((grid.rows, grid.columns), -np.inf, np.float32)
    levels = levels_above(blocks, grid, floor, gap_m)
    floor = begin_of_ground(blocks, grid, levels)
    if np.isfinite(floor).any():
        levels = levels_above(blocks, grid, floor, gap_m)
    for _ in range(_ROUNDS):
        hidden = sunk_points(levels, size_m)
        if not hidden.any():
            break
        _raise_floor(floor, levels, hidden, size_m)
        levels = levels_above(blocks, grid, floor, gap_m)
    for _ in range(_ROUNDS):
        known = np.isfinite(levels.lowest)
        crowded = _crowded(levels)
        surface = fill_heights(levels.lowest, known)
        standing = standing_cells(levels.lowest, surface, crowded, size_m, shape)
        hidden = ghosts(levels.lowest, levels.second, known & ~standing, size_m)
        if not hidden.any():
            break
        _raise_floor(floor, levels, hidden, size_m)
        levels = levels_above(blocks, grid, floor, gap_m)
        if hidden.sum() < _FEW_SHARE * known.sum():
            standing &= ~hidden
            break
    return levels, standing | ~np.isfinite(levels.lowest)


def _crowded(levels: LevelsAboveFloor) -> NDArray[np.bool_]:
    """Cells with something close above the lowest point; a stray among many is none."""
    is_low = levels.second < levels.lowest + _CROWDED_M
    held = levels.above.astype(np.int64) * _NEAR_PER_ABOVE >= levels.near
    crowded: NDArray[np.bool_] = is_low & held
    return crowded


def _raise_floor(
    floor: NDArray[np.float32], levels: LevelsAboveFloor, hidden: NDArray[np.bool_], size_m: float
) -> None:
    """Let cells of points under the ground begin a little below the ground around them."""
    import cv2

    near_hidden = cv2.dilate(hidden.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    trusted = np.isfinite(levels.lowest) & ~near_hidden
    if not trusted.any():
        return
    expected = fill_heights(levels.lowest, trusted) - (_MARGIN_SHARE * size_m + _MARGIN_M)
    floor[hidden] = np.maximum(expected, levels.lowest + _JUST_ABOVE_M)[hidden]
