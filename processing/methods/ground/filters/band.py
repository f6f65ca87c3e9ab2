"""The ground's own band: its mean height, its roughness, and what stands in it.

Where a constant says “by trial”, no measurement varied it alone: docs/accuracy.md judges all values
together, on simulated earthwork sites and on airborne samples of the ISPRS filter test.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.ground.filters.cell_positions import Blocks
from processing.methods.ground.filters.cells import CellGrid
from processing.methods.ground.filters.face_inclination import FaceRange, upright_faces
from processing.methods.ground.filters.feet import SIDE_PARTS, attached_feet
from processing.methods.ground.filters.morphology import steepness_of
from processing.methods.ground.filters.walls import BIN_M, BINS, column_tops, faces

_UNIT_M = 1e-4
"""Offsets are summed in whole units of this size: whole numbers add up to the same in any order.
A tenth of a millimetre is finer than any scanner measures."""

_WINDOW_CELLS = 5
"""Side of the window whose points give a cell its roughness, by trial: a single cell of a sparse
cloud holds too few points for a standard deviation."""

_LEAST_PER_CELL = 0.2
"""Points a cell, on average over the window, for a roughness of its own: five in its 25 cells."""

_MEAN_ROUNDS = 2
"""Rounds in which the surface moves to the mean of its points, each a pass over the cloud. Once it
was three; with one fewer, and with fewer windows (``regions``), no score got worse."""

_OWN_POINTS = 3
"""A cell with so many points moves to its own mean, by trial; one with fewer takes the mean of
its neighbours, since one or two points may be strays."""

_MEAN_CELLS = 3
"""Side of the window of those neighbours: the cells that touch it."""

_NO_WEIGHT = 0.05
"""Share of that window with points: less than one cell of nine (0.11) is rounding, not a cell."""

_ROUGHNESS_SHARES = 0.5, 1.5
"""Roughness of a cell as a share of the typical one, at least and at most, by trial: a cell of
grass must not widen the band by its own grass, nor a smooth one lose all tolerance."""

_NO_DIVISOR = 1e-9
"""Keeps divisions by an empty window finite; what they give is not used."""

_WITHIN_CELL = 0.5
"""Of a cell's rise: a point lies up to half a side from the cell's centre."""

_FOOT_REACH_M = 0.4
"""How far above the band a thing is looked for whose foot holds no ground, by trial: what begins
higher, as a branch or a wire, does not stand on that part of the cell."""

_FILLED_CELLS, _FILLED_COARSE_CELLS = 1, 2
"""Cells from measured ground within which a point in the band is ground; beyond, what reaches
through the filled surface is rather the thing that hides the ground. With cells that hold about one
point the next may be empty by chance: two. On streets labelled by hand 3.8 and 1.7 % of buildings
and vehicles were ground, with this, ``_FACE_CELLS`` and the islands 2.4 and 0.6 %."""

_FACE_CELLS = 2
"""The same for the face of a step, which leans over one cell more."""

_FINE_CELL_M = 0.5
"""Cells larger than this have no faces and no feet: between two of them lies the jump from a roof
to the ground as well as a step, and a sixteenth of one is wider than what stands on it. Measured
together with the feet: ISPRS sample 12, total error 3.10 % before and 2.94 % after."""


class _OffsetSums(NamedTuple):
    """Points near the surface in each cell, their offsets and squared offsets, in ``_UNIT_M``."""

    counts: NDArray[np.int64]
    totals: NDArray[np.int64]
    squares: NDArray[np.int64]


class _StandingPoints(NamedTuple):
    """Bits for tenths of a metre above the surface, and for the parts of a cell stood upon."""

    bins: NDArray[np.uint64]
    feet: NDArray[np.uint16]


class _BandGrids(NamedTuple):
    """The grids of a :class:`GroundBand` that a kernel compares points with."""

    heights: NDArray[np.float32]
    below: NDArray[np.float32]
    above: NDArray[np.float32]
    face_low: NDArray[np.float32]
    face_high: NDArray[np.float32]


@dataclass(frozen=True)
class GroundBand:
    """Where ground lies, cell by cell.

    Attributes
    ----------
    heights : (rows, columns) float32
        Ground at the cells' centres, m above the grid's origin.
    below, above : (rows, columns) float32
        A point no farther under or over that surface is ground, m; ``above`` is smaller where
        something stands. Both are −inf far from any measured ground: nothing is ground there.
    face_low, face_high : (rows, columns) float32
        Between these heights points on the face of a step are ground; empty elsewhere.
    feet : (rows, columns) uint16
        Bit ``4 r + c`` is set where a thing stands on that sixteenth of a cell, over whose foot
        no point is ground.
    roughness_m : float
        Standard deviation of ground points about the surface, in the median of the cells.
    """

    heights: NDArray[np.float32]
    below: NDArray[np.float32]
    above: NDArray[np.float32]
    face_low: NDArray[np.float32]
    face_high: NDArray[np.float32]
    feet: NDArray[np.uint16]
    roughness_m: float


@dataclass(frozen=True)
class Tolerances:
    """How far from its surface ground reaches.

    Attributes
    ----------
    near_m, near_share : float
        What is averaged at first lies within ``near_m`` and this share of a cell's side: the
        roughness of graded ground, and what it may rise within a cell. By trial.
    deviations : float
        Thickness in standard deviations of the ground's own roughness; three hold 99.7 % of what
        is scattered normally.
    side_share, slope_share : float
        What is added for the surface between cells: this share of a side, and of its rise. By
        trial.
    foot_deviations : float
        Thickness where something stands: half of the usual one, so that the lowest parts of the
        thing stay outside, while 87 % of normally scattered ground stays inside. By trial.
    face_slope : float
        Rise over run from which a cell holds the face of a step: 45°, steeper than loose earth
        lies.
    """

    near_m: float = 0.04
    near_share: float = 0.10
    deviations: float = 3.0
    side_share: float = 0.10
    slope_share: float = 0.30
    foot_deviations: float = 1.5
    face_slope: float = 1.0


def ground_band(
    blocks: Blocks,
    grid: CellGrid,
    surface: NDArray[np.float32],
    ground: NDArray[np.bool_],
    tolerances: Tolerances,
) -> GroundBand:
    """Fit the surface to the ground's points and measure how far they scatter.

    Parameters
    ----------
    surface : (rows, columns) float32
        Lowest ground without holes, m above the grid's origin.
    ground : (rows, columns) bool
        Cells in which it was measured.
    """
    size_m = grid.size_m
    steepness = steepness_of(surface, size_m)
    reach = tolerances.near_m + size_m * (tolerances.near_share + _WITHIN_CELL * steepness)
    reach = np.where(ground, reach, 0.0).astype(np.float32)
    # Larger cells hold no face of a step, but the jump from a roof to the ground.
    is_level = (steepness <= tolerances.face_slope) | (size_m > _FINE_CELL_M)
    for _ in range(_MEAN_ROUNDS):
        sums = _sums(blocks, grid, surface, reach)
        # Beside a step the mean swings more from round to round; the lowest heights serve there.
        surface = surface + np.where(is_level, _mean_offset(sums), np.float32(0.0))
    roughness, typical = _roughness(_sums(blocks, grid, surface, reach))
    rise = size_m * steepness
    spread = tolerances.deviations * roughness
    thick: NDArray[np.float32] = (
        spread + tolerances.side_share * size_m + tolerances.slope_share * rise
    ).astype(np.float32)
    bins, feet = _find_standing_points(blocks, grid, surface, thick)
    foot = tolerances.foot_deviations * roughness + tolerances.slope_share * rise
    above = np.where(_stands(bins, thick) | ~ground, np.minimum(thick, foot), thick)
    face_low, face_high = _face_heights(
        (blocks, grid), (surface, ground), (thick, above), is_level, column_tops(bins)
    )
    fine = size_m <= _FINE_CELL_M
    is_near = _near_ground(ground, _FILLED_CELLS if fine else _FILLED_COARSE_CELLS)
    nowhere = np.float32(-np.inf)
    return GroundBand(
        surface,
        np.where(is_near, thick, nowhere),
        np.where(is_near, above, nowhere).astype(np.float32),
        face_low,
        np.where(_near_ground(ground, _FACE_CELLS), face_high, nowhere),
        feet,
        typical,
    )


def _near_ground(ground: NDArray[np.bool_], cells: int) -> NDArray[np.bool_]:
    """Cells with measured ground so near that the surface, filled in there, still tells it."""
    import cv2

    away = cv2.distanceTransform((~ground).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    near: NDArray[np.bool_] = away <= cells
    return near


def _face_heights(
    cloud: tuple[Blocks, CellGrid],
    known: tuple[NDArray[np.float32], NDArray[np.bool_]],
    band: tuple[NDArray[np.float32], NDArray[np.float32]],
    is_level: NDArray[np.bool_],
    tops: NDArray[np.float32],
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Between which heights points of steep cells lie on a face; low > high: on none.

    ``known``: surface and where it was measured; ``band``: how far ground reaches below and above
    it; ``tops``: of what stands in each cell.
    """
    import cv2

    (blocks, grid), (surface, ground), (thick, above) = cloud, known, band
    lowest = cv2.erode(surface, np.ones((3, 3), np.uint8))
    highest = cv2.dilate(surface, np.ones((3, 3), np.uint8))
    upper = faces(surface, ground, tops, grid.size_m)
    face = np.isfinite(upper)
    face_low = np.where(face, lowest - thick, np.where(is_level, np.inf, lowest))
    face_high = np.where(is_level, -np.inf, highest)
    face_high = np.where(face, np.maximum(upper + thick, face_high), face_high)
    looked_at = FaceRange(
        np.where(face_high > face_low, lowest + thick, np.inf).astype(np.float32),
        np.where(face, upper, highest - thick).astype(np.float32),
    )
    upright = upright_faces(blocks, grid, looked_at)
    # Beside a wall the ground between cells does not lie between their heights.
    face_low = np.where(upright, np.where(ground, surface - thick, np.inf), face_low)
    face_high = np.where(upright, np.where(ground, surface + above, -np.inf), face_high)
    return face_low.astype(np.float32), face_high.astype(np.float32)


def _find_standing_points(
    blocks: Blocks, grid: CellGrid, surface: NDArray[np.float32], thick: NDArray[np.float32]
) -> _StandingPoints:
    """Columns of points by tenths of a metre, and the parts of cells over which things stand."""
    bins = np.zeros(surface.shape, np.uint64)
    feet = np.zeros(surface.shape, np.uint16)
    found = _StandingPoints(bins, feet)
    for xyz in blocks():
        _columns_kernel(np.ascontiguousarray(xyz), grid.origin, grid.size_m, surface, thick, found)
    if grid.size_m > _FINE_CELL_M:
        feet[:] = 0
    elif feet.any():
        feet = _attached_feet(blocks, grid, surface, thick, feet)
    return _StandingPoints(bins, feet)


def _attached_feet(
    blocks: Blocks,
    grid: CellGrid,
    surface: NDArray[np.float32],
    thick: NDArray[np.float32],
    feet: NDArray[np.uint16],
) -> NDArray[np.uint16]:
    def offsets() -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        for xyz in blocks():
            yield xyz, xyz[:, 2] - grid.origin[2] - heights_at(xyz[:, :2], level, surface)

    level = replace(grid, origin=np.append(grid.origin[:2], 0.0))
    return attached_feet(offsets(), grid, thick, thick + np.float32(_FOOT_REACH_M), feet)


def classify(xyz: NDArray[np.float64], grid: CellGrid, band: GroundBand) -> NDArray[np.bool_]:
    """Which points lie in the band: (n,) bool; those that aren't finite do not."""
    is_ground = np.zeros(len(xyz), np.bool_)
    _classify_kernel(
        np.ascontiguousarray(xyz),
        grid.origin,
        grid.size_m,
        _BandGrids(band.heights, band.below, band.above, band.face_low, band.face_high),
        band.feet,
        is_ground,
    )
    return is_ground


def heights_at(
    xy: NDArray[np.float64], grid: CellGrid, surface: NDArray[np.float32]
) -> NDArray[np.float64]:
    """Height of a grid's surface at positions: (n,) m; NaN outside the grid."""
    heights = np.full(len(xy), np.nan)
    _heights_kernel(np.ascontiguousarray(xy), grid.origin, grid.size_m, surface, heights)
    return heights


def _sums(
    blocks: Blocks,
    grid: CellGrid,
    surface: NDArray[np.float32],
    reach: NDArray[np.float32],
) -> _OffsetSums:
    """What the points near the surface say in each cell, whatever their order."""
    sums = _OffsetSums(
        np.zeros(surface.shape, np.int64),
        np.zeros(surface.shape, np.int64),
        np.zeros(surface.shape, np.int64),
    )
    for xyz in blocks():
        _sums_kernel(np.ascontiguousarray(xyz), grid.origin, grid.size_m, surface, reach, sums)
    return sums


def _mean_offset(sums: _OffsetSums) -> NDArray[np.float32]:
    has_points = sums.counts > 0
    own = np.where(has_points, sums.totals / np.maximum(sums.counts, 1) * _UNIT_M, 0.0)
    weight = _smooth(has_points.astype(np.float64), _MEAN_CELLS)
    mean = _smooth(own, _MEAN_CELLS) / np.maximum(weight, _NO_DIVISOR)
    around = np.where(weight > _NO_WEIGHT, mean, 0.0)
    return np.where(sums.counts >= _OWN_POINTS, own, around).astype(np.float32)


def _roughness(sums: _OffsetSums) -> tuple[NDArray[np.float64], float]:
    """Standard deviation about the surface, m: of each cell, and in the median of the cells."""
    per_cell = _smooth(sums.counts.astype(np.float64), _WINDOW_CELLS)
    total_square = _smooth(sums.squares.astype(np.float64) * _UNIT_M**2, _WINDOW_CELLS)
    mean_square = total_square / np.maximum(per_cell, _NO_DIVISOR)
    deviation = np.sqrt(np.maximum(mean_square, 0.0))
    enough = per_cell > _LEAST_PER_CELL
    with_points = deviation[enough & (sums.counts > 0)]
    typical = float(np.median(with_points)) if len(with_points) else 0.0
    least, most = _ROUGHNESS_SHARES
    own = np.where(enough, deviation, typical)
    return np.clip(own, least * typical, most * typical), typical


def _smooth(values: NDArray[np.float64], window: int) -> NDArray[np.float64]:
    import cv2

    smoothed = cv2.blur(values, (window, window), borderType=cv2.BORDER_REFLECT_101)
    return smoothed.astype(np.float64, copy=False)


def _stands(bins: NDArray[np.uint64], thick: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Where points go on above the band without a gap of two tenths of a metre."""
    # Two bits are looked at: the last two at the most.
    first = np.minimum(np.ceil(thick / BIN_M), BINS - 2).astype(np.uint64)
    stands: NDArray[np.bool_] = ((bins >> first) & np.uint64(3)) > 0
    return stands


@kernel
def _at(surface: NDArray[np.float32], y: float, x: float) -> float:
    rows, columns = surface.shape
    r = min(max(int(np.floor(y - 0.5)), 0), max(rows - 2, 0))
    c = min(max(int(np.floor(x - 0.5)), 0), max(columns - 2, 0))
    r1, c1 = min(r + 1, rows - 1), min(c + 1, columns - 1)
    v, u = y - 0.5 - r, x - 0.5 - c
    low = (1 - u) * surface[r, c] + u * surface[r, c1]
    high = (1 - u) * surface[r1, c] + u * surface[r1, c1]
    return float((1 - v) * low + v * high)


@kernel
def _sums_kernel(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    size_m: float,
    surface: NDArray[np.float32],
    reach: NDArray[np.float32],
    sums: _OffsetSums,
) -> None:
    for point in range(xyz.shape[0]):
        x = (xyz[point, 0] - origin[0]) / size_m
        y = (xyz[point, 1] - origin[1]) / size_m
        z = xyz[point, 2] - origin[2]
        if np.isfinite(z) and 0.0 <= x < surface.shape[1] and 0.0 <= y < surface.shape[0]:
            row, column = int(y), int(x)
            offset = z - _at(surface, y, x)
            if abs(offset) < reach[row, column]:
                units = int(np.rint(offset / _UNIT_M))
                sums.counts[row, column] += 1
                sums.totals[row, column] += units
                sums.squares[row, column] += units * units


@kernel
def _columns_kernel(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    size_m: float,
    surface: NDArray[np.float32],
    thick: NDArray[np.float32],
    found: _StandingPoints,
) -> None:
    for point in range(xyz.shape[0]):
        x = (xyz[point, 0] - origin[0]) / size_m
        y = (xyz[point, 1] - origin[1]) / size_m
        z = xyz[point, 2] - origin[2]
        if np.isfinite(z) and 0.0 <= x < surface.shape[1] and 0.0 <= y < surface.shape[0]:
            offset = z - _at(surface, y, x)
            if 0.0 <= offset < BINS * BIN_M:
                row, column = int(y), int(x)
                found.bins[row, column] |= np.uint64(1) << np.uint64(int(offset / BIN_M))
                if thick[row, column] < offset < thick[row, column] + _FOOT_REACH_M:
                    north, east = int(SIDE_PARTS * (y - row)), int(SIDE_PARTS * (x - column))
                    part = north * SIDE_PARTS + east
                    found.feet[row, column] |= np.uint16(1) << np.uint16(part)


@kernel
def _classify_kernel(
    xyz: NDArray[np.float64],
    origin: NDArray[np.float64],
    size_m: float,
    band: _BandGrids,
    feet: NDArray[np.uint16],
    is_ground: NDArray[np.bool_],
) -> None:
    surface = band.heights
    for point in range(xyz.shape[0]):
        x = (xyz[point, 0] - origin[0]) / size_m
        y = (xyz[point, 1] - origin[1]) / size_m
        z = xyz[point, 2] - origin[2]
        if np.isfinite(z) and 0.0 <= x < surface.shape[1] and 0.0 <= y < surface.shape[0]:
            row, column = int(y), int(x)
            offset = z - _at(surface, y, x)
            in_band = -band.below[row, column] <= offset <= band.above[row, column]
            on_face = band.face_low[row, column] <= z <= band.face_high[row, column]
            part = int(SIDE_PARTS * (y - row)) * SIDE_PARTS + int(SIDE_PARTS * (x - column))
            if (feet[row, column] >> np.uint16(part)) & np.uint16(1):
                in_band = False
            is_ground[point] = in_band or on_face


@kernel
def _heights_kernel(
    xy: NDArray[np.float64],
    origin: NDArray[np.float64],
    size_m: float,
    surface: NDArray[np.float32],
    heights: NDArray[np.float64],
) -> None:
    for position in range(xy.shape[0]):
        x = (xy[position, 0] - origin[0]) / size_m
        y = (xy[position, 1] - origin[1]) / size_m
        if 0.0 <= x < surface.shape[1] and 0.0 <= y < surface.shape[0]:
            heights[position] = origin[2] + _at(surface, y, x)


def warm_up() -> None:
    """Compile the kernels of this file."""
    grid = CellGrid(np.zeros(3), 1.0, 2, 2)
    flat = np.zeros((2, 2), np.float32)
    xyz = np.array([[0.5, 0.5, 0.0]])
    band = ground_band(lambda: [xyz], grid, flat, np.ones((2, 2), np.bool_), Tolerances())
    classify(xyz, grid, band)
    heights_at(xyz[:, :2], grid, flat)
