"""Strokes of paint: long or short, straight or bent, with road on both sides."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.methods.road.markings.paint_raster import TILE_M, PaintRaster
from processing.methods.road.markings.stroke_kernels import (
    STATION,
    StrokeLimits,
    StrokeRaster,
    smooth_kernel,
    strokes_kernel,
)

STEP_M = 0.25

_LIMITS = StrokeLimits(seed=0.3, widest_m=0.75, beside_m=0.2, dark=0.35, step_m=STEP_M, long_m=0.4)
"""Paint of a third of the usual contrast may be worn or dirty. The widest strokes are those of
stop lines and crossings (0.30 to 0.45 m, police's standard for markings) and of lanes' ends; road
of two hands' width lies between any two."""

_STATIONS, _SEEDS_AT_ONCE = 40_000, 4_000
_SMOOTHED_M = 2.0
"""Along which stations are put on one smooth line: paint is laid by a machine."""


@dataclass(frozen=True, eq=False)
class BrightStroke:
    """One stroke of paint.

    Attributes
    ----------
    line : (n, 2) float64
        Along its middle from end to end, m about the plan's origin.
    width_m : float
    width_spread_m : float
        Standard deviation of its widths.
    paint : float
        Of a full coat of the drive's paint.
    beside : float
        The more painted one of its two sides.
    seen_share : float
        Of its length at which both edges were measured.
    """

    line: Floats
    width_m: float
    width_spread_m: float
    paint: float
    beside: float
    seen_share: float

    @property
    def long_m(self) -> float:
        """Its length."""
        return float(np.hypot(*np.diff(self.line, axis=0).T).sum())


def strokes_of(raster: PaintRaster, monitor: Monitor) -> list[BrightStroke]:
    """All strokes of a raster: in fine cells, then what is left in coarse ones."""
    found: list[BrightStroke] = []
    is_done = np.zeros(len(raster.shares), np.bool_)
    half = raster.per_tile // 2
    for shares, per_tile in ((raster.shares, raster.per_tile), (raster.coarse, half)):
        shown = StrokeRaster(shares, raster.table, per_tile, TILE_M / per_tile)
        if per_tile == half:
            is_done = is_done.reshape(-1, half, 2, half, 2).any(axis=(2, 4)).reshape(-1)
        found += _followed(shown, is_done, monitor)
    return found


def _followed(
    shown: StrokeRaster, is_done: NDArray[np.bool_], monitor: Monitor
) -> Iterator[BrightStroke]:
    stations = np.empty((_STATIONS, STATION))
    counts = np.empty(_SEEDS_AT_ONCE, np.int64)
    per_tile = shown.per_tile**2
    for i, j in np.argwhere(shown.table >= 0).tolist():
        first = int(shown.table[i, j]) * per_tile
        seeds = np.flatnonzero(shown.shares[first : first + per_tile] >= _LIMITS.seed)
        for start in range(0, len(seeds), _SEEDS_AT_ONCE):
            monitor.check()
            some = seeds[start : start + _SEEDS_AT_ONCE]
            corner = (i * TILE_M, j * TILE_M)
            many = strokes_kernel(some, corner, shown, _LIMITS, is_done, stations, counts)
            ends = np.cumsum(counts[:many])
            for last, count in zip(ends.tolist(), counts[:many].tolist(), strict=True):
                yield _stroke(stations[last - count : last].copy())


def _stroke(stations: Floats) -> BrightStroke:
    inner = stations[1:-1]
    line = _smoothed(inner[:, :2])
    # Ends lie on the way that the smooth line leads.
    line = np.concatenate([stations[:1, :2], line, stations[-1:, :2]])
    line[0], line[-1] = _on_the_way(line[::-1]), _on_the_way(line)
    long = float(np.hypot(*np.diff(line, axis=0).T).sum())
    return BrightStroke(
        line,
        float(np.median(inner[:, 2])),
        float(inner[:, 2].std()),
        float(np.median(inner[:, 3])),
        float(np.median(np.maximum(inner[:, 4], inner[:, 5]))),
        min(1.0, len(inner) * STEP_M / max(long, STEP_M)),
    )


def _on_the_way(line: Floats) -> Floats:
    """The last place of a line, moved onto the way on which those before lead to it."""
    before = line[:-1][-9:]
    if len(before) < 2:
        return np.asarray(line[-1])
    way = before[-1] - before[0]
    way /= max(float(np.hypot(*way)), 1e-9)
    return np.asarray(before[-1] + way * max(0.0, float((line[-1] - before[-1]) @ way)))


def _smoothed(places: Floats) -> Floats:
    """Places moved across onto straight lines through those within reach."""
    if len(places) < 3:
        return places
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(places, axis=0).T))]
    smooth = places.copy()
    smooth_kernel(places, along, _SMOOTHED_M, STEP_M, smooth)
    return smooth
