"""Standing things: parts of the lowest surface that rise steeply along most of their rim.

Where a constant says “by trial”, no measurement varied it alone: docs/accuracy.md judges all values
together, on simulated earthwork sites and on airborne samples of the ISPRS filter test.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.ground.filters.morphology import nearest_known
from processing.methods.ground.filters.openings import open_heights, open_heights_within

_WINDOWS = 8
"""Sizes of window from one cell up to half the widest thing: each about twice the one before where
cells are 0.2 m and things up to 50 m. With these and ``_LEVEL_FACTOR``, over nine cell sizes each,
the total error on five ISPRS samples was 3.21 %, with 14 windows and 1.5 it was 3.43 %."""

_SMALL_CELLS = 2
"""Windows up to this radius look at bumps a few cells wide, whose sides the cells blur; they need
only ``ObjectShape.small_steep``."""

_LEVEL_FACTOR = 1.0
"""A thing has at least so much steep rim for each level one; chosen with ``_WINDOWS``."""

_SEEN_SHARE = 0.3
"""Share of a rim that must border on cells to compare with, or nothing is said of it; by trial."""

_GAP_CELLS = 2.0
"""Measured cells farther apart than this have a gap between them, in which a side may be hidden:
diagonal neighbours are 1.4 cells apart, and beyond one empty cell it is two."""

_FINE_CELL_M = 0.25
"""Cells up to this size show every side of a thing; larger ones come from clouds, as those from
the air, in which sides are missing. By trial."""

_WIDE_M, _ALL_ROUND_SHARE = 5.0, 0.75
"""From this width a thing needs so much steep rim: a fill of earth is steep along two or three
sides of four, and with less, fills were removed, on one simulated site 120 m³ of them."""

_HALL_M = 10.0
"""Width of window from which the border of a cloud may cut what is in it, by trial. With a second
look at the mirrored surface ISPRS sample 22 went from 5.9 to 4.9 % total error."""

_STOREY_M = 3.0
"""Least height of what the border cuts: a usual storey."""

_BORDER_RIM = 1.0
"""Level rim for each side of a cell on the border of the grid: the cut counts as what it hides
at the worst, so that terraces along the border stay."""

_LEVEL_SLOPE = 0.1
"""Rise over run below which a rim is level, 6°; by trial, as ``GroundAssumptions.flank``."""


class FreeCells(NamedTuple):
    """Cells that a rim is compared with.

    Attributes
    ----------
    free : (rows, columns) bool
        Cells that were measured and hold no thing found before.
    nearest : (rows, columns) int32
        The nearest measured cell of every cell, counted along the rows.
    """

    free: NDArray[np.bool_]
    nearest: NDArray[np.int32]


@dataclass(frozen=True)
class ObjectShape:
    """What a thing that stands on the ground looks like, in numbers a surveyor can judge.

    Attributes
    ----------
    widest_m : float
        Width of the largest thing to be removed.
    rise_m : float
        A bump lower than this is ground.
    flank : float
        Rise over width from which a bump is looked at.
    steep : float
        Rise over run of a rim that counts as the side of a thing (not of a heap).
    rim_share : float
        Share of the rim that must be so steep.
    small_steep : float
        The same as ``steep`` for a bump a few cells wide.
    crowded : float
        Share of all these numbers that is enough where points lie above the lowest: half, by
        trial, since something does stand there.
    barrier : float
        Rise over run at which a region is cut in two, as a tree is from the roof beside it: 45°,
        steeper than earth lies or roofs are pitched.
    """

    widest_m: float
    rise_m: float
    flank: float
    steep: float
    rim_share: float
    small_steep: float = 0.3
    crowded: float = 0.5
    barrier: float = 1.0


def standing_cells(
    heights: NDArray[np.float32],
    surface: NDArray[np.float32],
    crowded: NDArray[np.bool_],
    size_m: float,
    shape: ObjectShape,
) -> NDArray[np.bool_]:
    """Cells whose lowest point lies on a thing and not on the ground.

    Parameters
    ----------
    heights : (rows, columns) float32
        m; not finite where nothing was measured.
    surface : (rows, columns) float32
        The same without holes.
    crowded : (rows, columns) bool
        Where points lie above the lowest one, no higher than a person reaches.

    Notes
    -----
    From small to large windows: what an opening takes away is a thing where its rim is steep, and
    leaves the surface before the next window; crests, heaps and terraces, which somewhere go down
    gently, stay. Where cells are fine enough to show every side, a thing wider than five metres has
    to be steep along three quarters of its rim: fills of earth are steep along two sides or three,
    and go down gently along another. Wide windows look a second time as if the cloud went on with
    its mirror image, for a hall that its border cuts: it is a storey high, and its steep rim is
    longer than the cut, as a terrace's isn't.
    """
    standing = np.zeros(heights.shape, np.bool_)
    measured = np.isfinite(heights)
    surface = surface.copy()
    nearest = nearest_known(measured)
    share_of = np.where(crowded, np.float32(shape.crowded), np.float32(1.0))
    radii = _radii(shape.widest_m / 2 / size_m, max(heights.shape))
    found = np.zeros(heights.shape, np.bool_)
    for number, radius in enumerate([*radii, radii[-1], radii[-1]]):
        if number >= len(radii) and not found.any():
            break
        rise = share_of * np.float32(shape.flank * radius * size_m + shape.rise_m)
        is_small = radius <= _SMALL_CELLS
        steep = share_of * np.float32(shape.small_steep if is_small else shape.steep)
        lower = open_heights(surface, radius)
        cells = FreeCells(measured & ~standing, nearest)
        is_wide = size_m <= _FINE_CELL_M and 2 * radius * size_m >= _WIDE_M
        needed = replace(shape, rim_share=_ALL_ROUND_SHARE) if is_wide else shape
        found = _things(surface - lower > rise, heights, cells, size_m, steep=steep, shape=needed)
        standing |= found
        surface[found] = lower[found]
        if 2 * radius * size_m >= _HALL_M:
            lower = open_heights_within(surface, radius)
            raised = surface - lower > np.maximum(rise, np.float32(_STOREY_M))
            cells = FreeCells(measured & ~standing, nearest)
            shares = rim_shares(
                raised, heights, cells, size_m, steep, barrier=shape.barrier, border=_BORDER_RIM
            )
            things = shares.at_least(shape.rim_share)
            standing |= things
            surface[things] = lower[things]
            found |= things
    return standing


def standing_segments(
    heights: NDArray[np.float32], ground: NDArray[np.bool_], size_m: float, shape: ObjectShape
) -> NDArray[np.bool_]:
    """Ground cells of smooth surfaces that stand above all around them: (rows, columns) bool.

    Parameters
    ----------
    heights : (rows, columns) float32
        Lowest heights, m.
    ground : (rows, columns) bool
        Cells held to be ground so far.

    Notes
    -----
    Windows miss what is wider than they are, as a hall of 120 m, or what fits none of them. Here
    the whole plan is parted where it rises by more than 45°; a part that is steep along three
    quarters of its rim is a thing. What the border of the cloud cuts counts as level, so that the
    ground itself, which a border surrounds, stays.

    References
    ----------
    Sithole and Vosselman 2005, ISPRS Archives 36 (3/W19), p. 66-71: filtering by segments.
    """
    steep = np.full(ground.shape, shape.steep, np.float32)
    segments = rim_shares(
        np.ones(ground.shape, np.bool_),
        heights,
        FreeCells(ground, nearest_known(ground)),
        size_m,
        steep,
        barrier=shape.barrier,
        border=_BORDER_RIM,
    )
    found: NDArray[np.bool_] = ground & segments.at_least(_ALL_ROUND_SHARE)
    return found


def _things(
    raised: NDArray[np.bool_],
    heights: NDArray[np.float32],
    cells: FreeCells,
    size_m: float,
    *,
    steep: NDArray[np.float32],
    shape: ObjectShape,
) -> NDArray[np.bool_]:
    """Raised regions with steep rims: whole ones, parts of others, parts beside other things."""
    things = rim_shares(raised, heights, cells, size_m, steep).at_least(shape.rim_share)
    rest = raised & ~things
    others = FreeCells(cells.free & ~things, cells.nearest)
    split = rim_shares(rest, heights, others, size_m, steep, barrier=shape.barrier)
    things |= split.at_least(shape.rim_share)
    unclear = rest & ~things & split.unclear()
    if unclear.any():
        free = cells.free & ~things
        beside = FreeCells(free, nearest_known(free))
        around = rim_shares(unclear, heights, beside, size_m, steep, barrier=shape.barrier)
        things |= around.at_least(shape.rim_share)
    return things


@dataclass(frozen=True)
class RimShares:
    """How much of the rim of each raised region rises steeply.

    Attributes
    ----------
    labels : (rows, columns) int32
        Number of the region that a cell belongs to, 0 outside all.
    shares : (regions,) float64
        0 outside all; NaN where most of a rim borders on cells that are not to compare with.
    """

    labels: NDArray[np.int32]
    shares: NDArray[np.float64]

    def at_least(self, share: float) -> NDArray[np.bool_]:
        """Cells of regions with such a share, which is more than 0: (rows, columns) bool."""
        return self._cells_of(self.shares >= share)

    def unclear(self) -> NDArray[np.bool_]:
        """Cells of regions whose rim can't be judged: (rows, columns) bool."""
        return self._cells_of(np.isnan(self.shares))

    def _cells_of(self, regions: NDArray[np.bool_]) -> NDArray[np.bool_]:
        if not regions.any():
            return np.zeros(self.labels.shape, np.bool_)
        cells: NDArray[np.bool_] = regions[self.labels]
        return cells


def _radii(largest: float, extent: int) -> list[int]:
    largest = max(1.0, min(largest, extent / 2))
    return sorted({round(r) for r in np.geomspace(1.0, largest, _WINDOWS)})


def rim_shares(
    raised: NDArray[np.bool_],
    heights: NDArray[np.float32],
    cells: FreeCells,
    size_m: float,
    steep: NDArray[np.float32],
    *,
    barrier: float = np.inf,
    border: float = 0.0,
) -> RimShares:
    """For each raised region, the share of its rim that rises by ``steep``.

    Parameters
    ----------
    cells : FreeCells
        Cells to compare with.
    barrier : float
        Rise over run that divides regions; infinite joins all raised neighbours.
    border : float
        What each cell's side on the border of the grid counts as level rim.

    Notes
    -----
    The rise is taken between measured cells over their true distance. Across a gap a fall that is
    not steep says nothing: the side may be as steep, in the thing's own shadow.
    """
    free, nearest = cells
    if not raised.any() or not free.any():
        return RimShares(np.zeros(raised.shape, np.int32), np.zeros(1))
    labels: NDArray[np.int32] = np.zeros(raised.shape, np.int32)
    if np.isfinite(barrier):
        numbers = np.flatnonzero(raised)
        stack = np.empty(numbers.size, np.int64)
        count = _label_kernel(numbers, heights, nearest, size_m, barrier, stack, labels) + 1
    else:
        import cv2

        count, found = cv2.connectedComponents(raised.astype(np.uint8), connectivity=8)
        labels = np.asarray(found, np.int32)
    rim = np.zeros(count)
    rising = np.zeros(count)
    level = np.zeros(count)
    hidden = np.zeros(count)
    _rim_kernel(labels, heights, free, nearest, size_m, border, steep, rim, rising, level, hidden)
    share: NDArray[np.float64] = rising / np.maximum(rim, 1)
    share[rising < _LEVEL_FACTOR * level] = 0.0
    share[rim < _SEEN_SHARE * (rim + hidden)] = np.nan
    share[0] = 0.0
    return RimShares(labels, share)


@kernel
def _position_of(nearest: NDArray[np.int32], row: int, column: int) -> tuple[int, int]:
    """Row and column of the measured cell that is nearest to a cell; mostly the cell itself."""
    columns = nearest.shape[1]
    cell = nearest[row, column]
    if cell == row * columns + column:
        return row, column
    return cell // columns, cell % columns


@kernel
def _fall_beyond(
    labels: NDArray[np.int32],
    heights: NDArray[np.float32],
    nearest: NDArray[np.int32],
    r: int,
    c: int,
    down: int,
    right: int,
) -> float:
    """Fall over run of the ground outside a rim: the side of a heap goes on falling there."""
    far_row, far_column = r + 2 * down, c + 2 * right
    rows, columns = labels.shape
    if far_row < 0 or far_column < 0 or far_row >= rows or far_column >= columns:
        return 0.0
    if labels[far_row, far_column] != 0:
        return 0.0
    a, b = _position_of(nearest, r, c)
    d, e = _position_of(nearest, far_row, far_column)
    run = np.sqrt((a - d) ** 2.0 + (b - e) ** 2.0)
    if run == 0.0:
        return 0.0
    return float(heights[a, b] - heights[d, e]) / float(run)


@kernel
def _rim_kernel(
    labels: NDArray[np.int32],
    heights: NDArray[np.float32],
    free: NDArray[np.bool_],
    nearest: NDArray[np.int32],
    size_m: float,
    border: float,
    steep: NDArray[np.float32],
    rim: NDArray[np.float64],
    rising: NDArray[np.float64],
    level: NDArray[np.float64],
    hidden: NDArray[np.float64],
) -> None:
    rows, columns = labels.shape
    for row in range(rows):
        for column in range(columns):
            label = labels[row, column]
            if label == 0:
                continue
            for side in range(4):
                down = (side == 0) - (side == 1)
                right = (side == 2) - (side == 3)
                r, c = row + down, column + right
                if r < 0 or c < 0 or r >= rows or c >= columns:
                    level[label] += border
                    continue
                if labels[r, c] == label:
                    continue
                from_row, from_column = _position_of(nearest, row, column)
                to_row, to_column = _position_of(nearest, r, c)
                run = size_m * np.sqrt(
                    (from_row - to_row) ** 2.0 + (from_column - to_column) ** 2.0
                )
                if run == 0.0:
                    continue
                rise = heights[from_row, from_column] - heights[to_row, to_column]
                is_level = rise < _LEVEL_SLOPE * run
                is_shaded = (
                    run > _GAP_CELLS * size_m and not is_level and rise <= steep[row, column] * run
                )
                if is_shaded or not (free[to_row, to_column] and free[from_row, from_column]):
                    hidden[label] += 1.0
                    continue
                rim[label] += 1.0
                level[label] += is_level
                fall = _fall_beyond(labels, heights, nearest, r, c, down, right)
                rise -= max(0.0, fall) * run / size_m
                if rise > steep[row, column] * run:
                    rising[label] += 1.0


@kernel
def _label_kernel(
    cells: NDArray[np.int64],
    heights: NDArray[np.float32],
    nearest: NDArray[np.int32],
    size_m: float,
    barrier: float,
    stack: NDArray[np.int64],
    labels: NDArray[np.int32],
) -> int:
    """Number the regions of raised cells; between two cells of one is no barrier."""
    rows, columns = labels.shape
    for first in cells:
        labels[first // columns, first % columns] = -1
    count = 0
    for first in cells:
        if labels[first // columns, first % columns] >= 0:
            continue
        count += 1
        labels[first // columns, first % columns] = count
        stack[0] = first
        held = 1
        while held:
            held -= 1
            row, column = stack[held] // columns, stack[held] % columns
            from_row, from_column = _position_of(nearest, row, column)
            for side in range(4):
                r = row + (side == 0) - (side == 1)
                c = column + (side == 2) - (side == 3)
                if r < 0 or c < 0 or r >= rows or c >= columns:
                    continue
                if labels[r, c] >= 0:
                    continue
                to_row, to_column = _position_of(nearest, r, c)
                run = size_m * np.sqrt(
                    (from_row - to_row) ** 2.0 + (from_column - to_column) ** 2.0
                )
                rise = abs(heights[from_row, from_column] - heights[to_row, to_column])
                if rise <= barrier * run:
                    labels[r, c] = count
                    stack[held] = r * columns + c
                    held += 1
    return count


def warm_up() -> None:
    """Compile the kernels of this file."""
    heights = np.zeros((8, 8), np.float32)
    heights[3:5, 3:5] = 2.0
    crowded = np.zeros((8, 8), np.bool_)
    standing_cells(heights, heights, crowded, 1.0, ObjectShape(4.0, 0.1, 0.1, 0.8, 0.45))
