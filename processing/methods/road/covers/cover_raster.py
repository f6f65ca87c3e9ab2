"""The surface of road and walks in fine cells of its plan: how bright, how high, how open it is.

Brightness is told over the road's own tone about each place, head by head, as markings do
(:mod:`processing.methods.road.markings.paint_raster`); what is darker counts as well as what is
brighter, since iron may be either.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.covers.cell_kernels import (
    BINS,
    count_heights_kernel,
    surface_kernel,
    surface_levels_kernel,
)
from processing.methods.road.markings.paint_raster import (
    TILE_M,
    HeadTones,
    RoadExtent,
    ground_of_tiles,
)
from processing.methods.road.objects.drive_chunks import chunks_of
from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import TILE, SparsePlan
from processing.recording.drive import Drive

_FINEST = 256
"""Cells along a tile: 5 cm, half of the smallest valve; middles are told to a part of a cell."""

_PITS = ((7, 0.35), (3, 0.12))
"""Widths, in cells of the coarse ground, and depths, m, of what lies below the ground on all sides:
single points mirrored far below the road, which draw the cells around them down, and shafts under
gratings. A carriageway between curbs is wider than the second and less deep than the first."""


@dataclass(frozen=True)
class CoverRaster:
    """A road's surface.

    Attributes
    ----------
    road : RoadExtent
    per_tile : int
        Cells along the side of a tile.
    counts : (2, cells) uint8
        Points of the surface, and points below it, tile after tile.
    sums : (2, cells) float32
        Of how much brighter the points of the surface are than the road, over its tone; and of
        their heights about the plan's origin, m.
    """

    road: RoadExtent
    per_tile: int
    counts: NDArray[np.uint8]
    sums: NDArray[np.float32]

    @property
    def cell_m(self) -> float:
        """Width of a cell."""
        return TILE_M / self.per_tile

    def surface(self) -> Floats:
        """Heights in cells of 20 cm about the plan's origin, m: (tiles × 64²,); NaN: not seen."""
        fine = self.per_tile // TILE
        shape = (-1, TILE, fine, TILE, fine)
        counts, sums = (
            values.reshape(shape).sum(axis=(2, 4), dtype=np.float64)
            for values in (self.counts[0], self.sums[1])
        )
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray((sums / counts).reshape(-1))


def cover_raster(
    drives: Sequence[Drive],
    tones: Sequence[HeadTones],
    road: RoadExtent,
    ground: NDArray[np.float32],
    monitor: Monitor,
) -> CoverRaster:
    """What all heads saw of the surface of road and walks.

    Parameters
    ----------
    ground : (tiles, 16, 16) float32
        Of the whole plan.
    """
    plan, table = road.plan, road.table
    tiles, per = int(table.max()) + 1, _FINEST
    coarse = ground_of_tiles(plan, table, _without_pits(plan, ground, monitor))
    heights: NDArray[np.uint8] = np.zeros((tiles * TILE**2, BINS), np.uint8)
    for chunk in chunks_of(drives, plan.origin, PartMonitor(monitor, 0.0, 0.4)):
        count_heights_kernel(chunk.local, chunk.is_noise, table, coarse, heights)
    levels: NDArray[np.float32] = np.empty(tiles * TILE**2, np.float32)
    surface_levels_kernel(heights, coarse, TILE // GROUND_CELLS, levels)
    counts: NDArray[np.uint8] = np.zeros((2, tiles * per**2), np.uint8)
    sums: NDArray[np.float32] = np.zeros((2, tiles * per**2), np.float32)
    for chunk in chunks_of(drives, plan.origin, PartMonitor(monitor, 0.4, 1.0)):
        count = len(chunk.local)
        column = drives[chunk.drive].columns["intensity"]
        surface_kernel(
            chunk.local,
            chunk.is_noise,
            np.asarray(column[chunk.start : chunk.start + count]),
            (table, tones[chunk.drive].levels, levels),
            per,
            counts,
            sums,
        )
    return CoverRaster(road, per, counts, sums)


def _without_pits(
    plan: SparsePlan, ground: NDArray[np.float32], monitor: Monitor
) -> NDArray[np.float32]:
    """The ground over shafts, and over wide deep pits that mirrored points make."""
    from scipy.ndimage import grey_closing

    closed, halo = ground.copy(), max(wide for wide, _ in _PITS)
    for tile in range(len(plan)):
        monitor.check()
        around = plan.window(ground, tile, halo, np.nan)
        known = np.isfinite(around)
        if not known.any():
            continue
        filled = np.where(known, around, np.median(around[known]))
        for wide, deep_m in _PITS:
            level = grey_closing(filled, (wide, wide))
            filled = np.where(level > filled + deep_m, level, filled)
        closed[tile] = np.where(np.isfinite(ground[tile]), filled[halo:-halo, halo:-halo], np.nan)
    return closed
