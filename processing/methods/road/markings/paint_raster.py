"""How painted a road is, in fine cells of its plan: what strokes of paint are followed on.

Nothing absolute is asked of intensities. Each head's are held against the road's own around them,
place by place, which takes out what range, incidence, wetness and the head's law do to them; how
much brighter paint is follows from what is brighter on the way that the vehicle drove.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor, PartMonitor
from processing.core.worked_ahead import in_order
from processing.methods.road.markings.tone_kernels import (
    BINS,
    ceilings_kernel,
    count_tones_kernel,
    levels_kernel,
    paint_kernel,
    road_points_kernel,
    shares_kernel,
)
from processing.methods.road.objects.drive_chunks import chunks_of
from processing.methods.road.objects.ground_heights import GROUND_CELLS, GROUND_M
from processing.methods.road.objects.sparse_plan import CELL_M, TILE, SparsePlan
from processing.recording.drive import Drive

TILE_M = CELL_M * TILE

_REACH_M = 16.0
"""How far beside the vehicle's path markings are looked for: two lanes each way and a turning lane
beyond the middle (道路構造令 第5条: 3 to 3.5 m a lane)."""

_ABOVE_M = 0.05
"""Over the lowest points of a cell and its slope: unevenness and noise; curbs are higher."""

_WAY_M = 4.0
"""What is brighter so near to the path is paint: gutters, walks and verges lie farther off."""

_FINEST, _COARSEST = 360, 128
"""Cells along a tile of 12.8 m: 3.5 to 10 cm; a line is 10 to 20 cm wide."""

_PER_CELL = 1.0
"""Points in a cell where the road is seen well."""

_SAMPLED = 200_000
_TILES_AT_ONCE = 64

_FULL_SHARE = 0.3
"""Of a head's points at its highest value: paint can't be told from road any more."""


@dataclass(frozen=True)
class PaintRaster:
    """A road's paint.

    Attributes
    ----------
    plan : SparsePlan
        Of the survey.
    table : (nx, ny) int32
        Tiles that were looked at, numbered anew; −1 elsewhere.
    per_tile : int
        Cells along the side of a tile.
    shares : (tiles × per_tile²,) float32
        0 road, 1 paint; NaN where nothing was measured.
    coarse : (tiles × (per_tile / 2)²,) float32
        The same of cells twice as wide, for what lies far from the scanner.
    heights : (tiles × 64²,) float64
        Of the road's surface, m about the plan's origin; NaN where it wasn't seen.
    path : (n, 2) float64
        Where the vehicle drove.
    """

    plan: SparsePlan
    table: NDArray[np.int32]
    per_tile: int
    shares: NDArray[np.float32]
    coarse: NDArray[np.float32]
    heights: Floats
    path: Floats

    @property
    def cell_m(self) -> float:
        """Width of a cell."""
        return TILE_M / self.per_tile


class HeadTones(NamedTuple):
    """What a head saw of the road.

    Attributes
    ----------
    is_flat : bool
        All its intensities are the same.
    full_share : float
        Of its points that have its highest value.
    levels : (cells, 3) float32
        As :func:`levels_kernel` tells them.
    contrast : float
        What paint is brighter by, over the road's own tone; NaN where none was seen.
    seen : (cells,) int64
        Points of each cell.
    """

    is_flat: bool
    full_share: float
    levels: NDArray[np.float32]
    contrast: float
    seen: Integers

    @property
    def is_saturated(self) -> bool:
        """Whether too many of its points are as bright as can be."""
        return self.full_share > _FULL_SHARE


class RoadExtent(NamedTuple):
    """Where markings are looked for.

    Attributes
    ----------
    plan : SparsePlan
        Of the survey.
    table : (nx, ny) int32
        Tiles near the path, numbered anew; −1 elsewhere.
    ceiling : (cells,) float64
        How high the road's surface may reach in each cell, m about the plan's origin.
    path : (n, 2) float64
        Where the vehicle drove.
    """

    plan: SparsePlan
    table: NDArray[np.int32]
    ceiling: Floats
    path: Floats


def road_extent(plan: SparsePlan, ground: NDArray[np.float32], path: Floats) -> RoadExtent:
    """The road about a path; everything that was measured without one."""
    table = looked_at(plan, path)
    return RoadExtent(plan, table, ceilings(ground_of_tiles(plan, table, ground), table), path)


def looked_at(plan: SparsePlan, path: Floats) -> NDArray[np.int32]:
    """The tiles that lie near to the path, numbered anew; all tiles without a path."""
    table = np.full_like(plan.table, -1)
    tiles = np.argwhere(plan.table >= 0)
    if len(path) and len(tiles):
        from scipy.spatial import cKDTree

        away, _ = cKDTree(path).query((tiles + 0.5) * TILE_M)
        tiles = tiles[away < _REACH_M + TILE_M / math.sqrt(2)]
    table[tuple(tiles.T)] = np.arange(len(tiles), dtype=np.int32)
    return table


def ground_of_tiles(
    plan: SparsePlan, table: NDArray[np.int32], ground: NDArray[np.float32]
) -> NDArray[np.float32]:
    """The ground of the tiles that are looked at, in their order: (cells,) float32."""
    tiles = np.argwhere(table >= 0)
    chosen = np.empty((len(tiles), GROUND_CELLS, GROUND_CELLS), np.float32)
    chosen[table[tuple(tiles.T)]] = ground[plan.table[tuple(tiles.T)]]
    return chosen.reshape(-1)


def ceilings(ground: NDArray[np.float32], table: NDArray[np.int32]) -> Floats:
    """How high the road's surface may reach in each cell, m about the plan's origin."""
    ceiling = np.full(len(ground), np.nan)
    ceilings_kernel(ground, table, np.argwhere(table >= 0), _ABOVE_M, ceiling)
    return ceiling


def head_tones(drive: Drive, road: RoadExtent, monitor: Monitor) -> HeadTones:
    """How bright the road is to one head, place by place."""
    plan, table, ceiling, path = road
    values = np.asarray(drive.columns["intensity"][:: max(1, drive.count // _SAMPLED)], np.float64)
    levels: NDArray[np.float32] = np.full((len(ceiling), 3), np.nan, np.float32)
    if values.size == 0 or values.min() == values.max():
        return HeadTones(
            is_flat=True,
            full_share=0.0,
            levels=levels,
            contrast=math.nan,
            seen=np.zeros(len(ceiling), np.int64),
        )
    ends = _bins_of(values)
    bin_of = np.clip(np.searchsorted(ends, np.arange(65_536), "right") - 1, 0, BINS - 1)
    bin_of = bin_of.astype(np.uint8)
    tones: NDArray[np.uint16] = np.zeros((len(ceiling), BINS), np.uint16)
    for chunk in chunks_of([drive], plan.origin, PartMonitor(monitor, 0.0, 0.8)):
        count = len(chunk.local)
        intensity = np.asarray(drive.columns["intensity"][chunk.start : chunk.start + count])
        is_road = np.empty(count, np.bool_)
        road_points_kernel(chunk.local, chunk.is_noise, table, ceiling, is_road)
        count_tones_kernel(chunk.local, is_road, bin_of[intensity], table, tones)
    tiles = np.argwhere(table >= 0)
    for start in range(0, len(tiles), _TILES_AT_ONCE):
        monitor.check()
        levels_kernel(tones, table, tiles[start : start + _TILES_AT_ONCE], ends, levels)
    full = float(tones[:, -1].sum()) / max(1.0, float(tones.sum(dtype=np.int64)))
    seen = tones.sum(axis=1, dtype=np.int64)
    contrast = _contrast(levels, table, path)
    return HeadTones(is_flat=False, full_share=full, levels=levels, contrast=contrast, seen=seen)


def _bins_of(values: Floats) -> Floats:
    """Ends of bins: fine where values are many, and as fine over all of their range."""
    low, high = float(values.min()), float(values.max())
    even = np.linspace(low, float(np.quantile(values, 0.995)), 25)
    ends = np.unique(np.r_[even, np.quantile(values, np.linspace(0.0, 1.0, 40))])
    ends = np.unique(np.round(ends * 2) / 2)
    missing = BINS + 1 - len(ends)
    while missing > 0:
        widest = np.argsort(-np.diff(ends))[: min(missing, len(ends) - 1)]
        ends = np.sort(np.r_[ends, (ends[widest] + ends[widest + 1]) / 2])
        missing = BINS + 1 - len(ends)
    ends[-1] = high + 1.0
    return np.asarray(ends, np.float64)


def _contrast(levels: NDArray[np.float32], table: NDArray[np.int32], path: Floats) -> float:
    """Of what is brighter near the path, over the road's own tone: the middle one of all cells."""
    ratio = (levels[:, 2] - levels[:, 0]) / np.maximum(levels[:, 0], 1e-6)
    known = np.isfinite(ratio)
    if len(path) and known.any():
        from scipy.spatial import cKDTree

        away, _ = cKDTree(path).query(_cell_middles(table))
        near = known & (away < _WAY_M)
        known = near if near.any() else known
    return float(np.median(ratio[known])) if known.any() else math.nan


def _cell_middles(table: NDArray[np.int32]) -> Floats:
    """(cells, 2) float64, in the order of cells."""
    tiles = np.argwhere(table >= 0)
    corners = np.empty((len(tiles), 2))
    corners[table[tuple(tiles.T)]] = tiles * TILE_M
    side = (np.arange(GROUND_CELLS) + 0.5) * GROUND_M
    within = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    return np.asarray((corners[:, None] + within[None]).reshape(-1, 2))


def cells_per_tile(tones: Sequence[HeadTones]) -> int:
    """How fine the raster may be: a point a cell where the road was seen well."""
    total = np.sum([one.seen for one in tones], axis=0)
    seen = total[total > 0]
    if seen.size == 0:
        return _COARSEST
    spacing = GROUND_M / math.sqrt(float(np.quantile(seen, 0.75)) / _PER_CELL)
    wanted = TILE_M / spacing
    return int(np.clip(wanted // 2 * 2, _COARSEST, _FINEST))


def paint_raster(
    drives: Sequence[Drive],
    tones: Sequence[HeadTones],
    road: RoadExtent,
    per_tile: int,
    monitor: Monitor,
) -> PaintRaster:
    """The paint that all heads saw, each by its own tones."""
    plan, table, ceiling, path = road
    tiles = int(table.max()) + 1
    paint: NDArray[np.uint16] = np.zeros(tiles * per_tile**2, np.uint16)
    counts: NDArray[np.uint8] = np.zeros(tiles * per_tile**2, np.uint8)
    heights = np.zeros((tiles * TILE**2, 2))
    for chunk in chunks_of(drives, plan.origin, PartMonitor(monitor, 0.0, 0.8)):
        head, count = tones[chunk.drive], len(chunk.local)
        if not head.contrast > 0:
            continue
        column = drives[chunk.drive].columns["intensity"]
        is_road = np.empty(count, np.bool_)
        road_points_kernel(chunk.local, chunk.is_noise, table, ceiling, is_road)
        paint_kernel(
            chunk.local,
            is_road,
            np.asarray(column[chunk.start : chunk.start + count]),
            table,
            head.levels,
            head.contrast,
            per_tile,
            paint,
            counts,
            heights,
        )
    shares = _shares(paint, counts, table, per_tile, monitor)
    wide = _wide(paint, per_tile), _wide(counts, per_tile)
    coarse = _shares(*wide, table, per_tile // 2, monitor)
    with np.errstate(invalid="ignore", divide="ignore"):
        surface = heights[:, 0] / heights[:, 1]
    return PaintRaster(plan, table, per_tile, shares, coarse, surface, path)


def _wide(values: NDArray[Any], per_tile: int) -> NDArray[np.uint32]:
    """Sums of two by two cells."""
    half = per_tile // 2
    sums = values.reshape(-1, half, 2, half, 2).sum(axis=(2, 4), dtype=np.uint32)
    return np.asarray(sums.reshape(-1))


def _shares(
    paint: NDArray[Any],
    counts: NDArray[Any],
    table: NDArray[np.int32],
    per_tile: int,
    monitor: Monitor,
) -> NDArray[np.float32]:
    shares: NDArray[np.float32] = np.empty(len(paint), np.float32)

    def of_tile(tile: list[int]) -> None:
        monitor.check()
        shares_kernel(paint, counts, table, (tile[0], tile[1]), per_tile, shares)

    for _ in in_order(of_tile, np.argwhere(table >= 0).tolist()):
        monitor.check()
    return shares
