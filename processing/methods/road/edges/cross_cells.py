"""What lies beside the ways, station by station in narrow cells: height, roughness, brightness.

Roughness and brightness are told for each head by itself, since heads lie millimetres to
centimetres apart and write intensities of their own, and then put together.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats
from processing.core.monitor import Monitor, parts_of
from processing.methods.road.edges.cross_kernels import ceilings_kernel, cross_sums_kernel
from processing.methods.road.edges.fact_kernels import CELL_M
from processing.methods.road.edges.way import RoadWays, nearest_stations
from processing.methods.road.markings.paint_raster import ground_of_tiles, looked_at
from processing.methods.road.objects.drive_chunks import DriveChunk
from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import cell_of
from processing.methods.road.objects.survey import SurveyGround
from processing.recording.drive import Drive

REACH_M = 16.0
"""To each side, as far as markings are looked for."""

CELLS = round(2 * REACH_M / CELL_M)

_ABOVE_M = 0.3
"""Over the lowest points of a coarse cell: curbs (25 cm at most) and blades of grass are seen."""

_LOWER_M = 0.7
"""A cell that lies lower than one beside it by no more is a gutter (50 cm deep at most) beside the
road, whose surface in the same cell counts, too."""

_LANE_M = 3.0
"""So far to both sides there is road wherever one drives: its own lane and a part of the next."""

_GROWN, _EVEN, _LEAST_FITTED = 10, 0.15, 10
"""Cells by which the fitted part of the road grows, how far its brightness may be off what the
nearer part tells (asphalt by a fifth is lighter or darker from place to place), and the fewest that
are fitted."""

_POWER, _TILT, _INDEPENDENT = (-1.5, 1.0), 0.03, 12.0
"""Power of the slant: −1 by Lambert's law where a maker corrects ranges, −3 where none does, and
what damping makes of it; per metre how much more the left shows than the right, of heads that look
aside; and how many cells tell as much as the whole lane does."""

_HEIGHTS = (0.7, 1.0, 1.4)
"""Of the scanner as its mirror's plane sees it, over that of the path."""

_LEAST_NOISE_M = 0.0005
"""No roughness is told below: a tenth of what scanners for surveying range by."""

_FEWEST = 3
"""Points of one head in a cell that tell its roughness."""


@dataclass(frozen=True)
class CrossCells:
    """Cells across the ways, the first one farthest to the right.

    Attributes
    ----------
    ways : RoadWays
    counts : (stations, CELLS) float32
        Points.
    heights : (stations, CELLS) float64
        Mean, m about the heights of the path less `under_m`; NaN without points.
    rough : (stations, CELLS) float64
        Logarithm of the standard deviation of heights within each head, m; NaN: too few points.
    tones : (stations, CELLS) float64
        Logarithm of the mean brightness over that of the lane, without what range and incidence
        do; NaN where no head tells any.
    under_m : float
        How far the road lies below the path.
    has_tones : bool
        Whether any head tells brightness.
    full_share : float
        Of the points at the highest intensity of their head, the most of all heads.
    """

    ways: RoadWays
    counts: NDArray[np.float32]
    heights: Floats
    rough: Floats
    tones: Floats
    under_m: float
    has_tones: bool
    full_share: float


ChunksOf = Callable[[int, Monitor], Iterable[DriveChunk]]
"""Makes the points of a drive, by its number."""


def cross_cells(
    drives: Sequence[Drive],
    chunks_of_drive: ChunksOf,
    ground: SurveyGround,
    ways: RoadWays,
    monitor: Monitor,
) -> CrossCells:
    """The cells across the ways of all drives together."""
    plan, heights = ground
    table = looked_at(plan, ways.places[:, :2])
    chosen = ground_of_tiles(plan, table, heights)
    ceiling = np.full(len(chosen), np.nan)
    ceilings_kernel(chosen, table, np.argwhere(table >= 0), (_ABOVE_M, _LOWER_M), ceiling)
    nearest = nearest_stations(table, ways)
    under_m = _under_m(ways, table, chosen)
    sums = _Sums(len(ways))
    parts = parts_of(monitor, [drive.count for drive in drives])
    for number, (drive, part) in enumerate(zip(drives, parts, strict=True)):
        own: NDArray[np.float32] = np.zeros((len(ways), CELLS, 4), np.float32)
        scale = _scale_of(drive)
        for chunk in chunks_of_drive(number, part):
            count = len(chunk.local)
            intensity = np.asarray(drive.columns["intensity"][chunk.start : chunk.start + count])
            cross_sums_kernel(
                chunk.local,
                chunk.is_noise,
                intensity,
                (table, ceiling, nearest),
                (ways.places, ways.directions, ways.way),
                (under_m, ways.step_m, REACH_M, CELL_M, scale.unit),
                own,
            )
        sums.add(own, scale, under_m)
        monitor.check()
    return sums.cells(ways, under_m)


@dataclass(frozen=True)
class _Scale:
    """Of a head's intensities: a usual value, whether they differ, the share of the highest."""

    unit: float
    is_flat: bool
    full_share: float


def _scale_of(drive: Drive) -> _Scale:
    values = np.asarray(drive.columns["intensity"][:: max(1, drive.count // 100_000)], np.float64)
    if values.size == 0 or values.min() == values.max():
        return _Scale(1.0, is_flat=True, full_share=0.0)
    unit = max(float(np.median(values)), 1.0)
    return _Scale(unit, is_flat=False, full_share=float(np.mean(values == values.max())))


def _under_m(ways: RoadWays, table: NDArray[np.int32], ground: NDArray[np.float32]) -> float:
    """How far below the path the road lies, m: the middle one of all stations."""
    below = []
    for place in ways.places[:: max(1, len(ways) // 500)]:
        cell = int(cell_of(place[0], place[1], table, GROUND_CELLS))
        if cell >= 0 and np.isfinite(ground[cell]):
            below.append(float(place[2] - ground[cell]))
    return float(np.median(below)) if below else 0.0


class _Sums:
    """Cells of several heads, put together one after the other."""

    def __init__(self, stations: int) -> None:
        shape = (stations, CELLS)
        self.counts: NDArray[np.float32] = np.zeros(shape, np.float32)
        self.heights = np.zeros(shape)
        self.spread, self.free = np.zeros(shape), np.zeros(shape)
        self.tones, self.told = np.zeros(shape), np.zeros(shape)
        self.full_share = 0.0

    def add(self, own: NDArray[np.float32], scale: _Scale, under_m: float) -> None:
        count, height = own[..., 0].astype(np.float64), own[..., 1].astype(np.float64)
        some = np.maximum(count, 1.0)
        self.counts += own[..., 0]
        self.heights += height
        is_told = count >= _FEWEST
        within = own[..., 2] - own[..., 1].astype(np.float64) ** 2 / some
        self.spread += np.where(is_told, np.maximum(within, 0.0), 0.0)
        self.free += np.where(is_told, count - 1.0, 0.0)
        self.full_share = max(self.full_share, scale.full_share)
        if scale.is_flat:
            return
        with np.errstate(divide="ignore", invalid="ignore"):
            tone = np.log(np.where(count > 0, own[..., 3] / some, np.nan))
        tone = tone - lane_tones(tone, under_m)
        known = np.isfinite(tone)
        self.tones += np.where(known, count * np.where(known, tone, 0.0), 0.0)
        self.told += np.where(known, count, 0.0)

    def cells(self, ways: RoadWays, under_m: float) -> CrossCells:
        with np.errstate(divide="ignore", invalid="ignore"):
            heights = np.where(self.counts > 0, self.heights / self.counts, np.nan)
            noise = np.sqrt(self.spread / self.free)
            rough = np.log(np.maximum(noise, _LEAST_NOISE_M))
            tones = np.where(self.told > 0, self.tones / self.told, np.nan)
        return CrossCells(
            ways,
            self.counts,
            heights,
            rough,
            tones,
            under_m,
            bool((self.told > 0).any()),
            self.full_share,
        )


def lane_tones(tone: Floats, under_m: float) -> Floats:
    """(stations, CELLS) what the brightness of road would be everywhere, for one head.

    Notes
    -----
    1. Brightness falls with range and incidence. Both follow from the distance aside over the
       height of the scanner, so that one power of the slant tells both; a scanner whose turning
       axis is not along the way sees the road as if it were higher or lower, and otherwise on the
       left than on the right.
    2. They are fitted to the lanes about the path, over the middle ones of all stations, and to
       what lies farther out as long as that goes on evenly.
    3. Each station has a level of its own, that of its lanes.
    """
    left = np.asarray((np.arange(CELLS) + 0.5) * CELL_M - REACH_M, np.float64)
    lane = np.abs(left) < _LANE_M
    level = _medians(tone[:, lane], axis=1)[:, None]
    column = _medians(tone - level, axis=0)
    law = _grown_law(left, column, under_m)
    known = np.isfinite(level)
    usual = float(np.median(level[known])) if known.any() else 0.0
    return np.asarray(np.where(known, level, usual) + law[None, :])


def _grown_law(left: Floats, column: Floats, under_m: float) -> Floats:
    """(CELLS,) the brightness of road over that of the lane."""
    fitted = (np.abs(left) < _LANE_M) & np.isfinite(column)
    if fitted.sum() < _LEAST_FITTED:
        return np.zeros(len(left))
    law = _fitted_law(left, column, fitted, under_m)
    is_open = {-1: True, 1: True}
    while any(is_open.values()):
        for side in (-1, 1):
            last = np.flatnonzero(fitted)[0 if side < 0 else -1]
            beyond = last + side * np.arange(1, _GROWN + 1)
            beyond = beyond[(beyond >= 0) & (beyond < len(left))]
            off = column[beyond] - law[beyond]
            known = np.isfinite(off)
            is_open[side] &= bool(
                known.sum() * 2 >= _GROWN and abs(float(np.median(off[known]))) <= _EVEN
            )
            if is_open[side]:
                fitted[beyond[known]] = True
                law = _fitted_law(left, column, fitted, under_m)
    return law


def _fitted_law(left: Floats, column: Floats, fitted: Flags, under_m: float) -> Floats:
    """Level, power of the slant and tilt that fit some cells best, near to what physics expect."""
    values = column[fitted]
    # Neighbouring cells are no independent witnesses: so many weigh as one.
    weight = math.sqrt(_INDEPENDENT / len(values)) / _EVEN
    best, law = math.inf, np.zeros(len(left))
    for share in _HEIGHTS:
        slant = 0.5 * np.log1p((left / max(share * under_m, 0.3)) ** 2)
        terms = np.column_stack([np.ones(len(left)), slant, left])
        prior = np.array([[0.0, 1.0 / _POWER[1], 0.0], [0.0, 0.0, 1.0 / _TILT]])
        found = np.linalg.lstsq(
            np.concatenate([weight * terms[fitted], prior]),
            np.concatenate([weight * values, [_POWER[0] / _POWER[1], 0.0]]),
            rcond=None,
        )[0]
        off = weight * (values - terms[fitted] @ found)
        left_over = float((off**2).sum())
        left_over += ((found[1] - _POWER[0]) / _POWER[1]) ** 2 + (found[2] / _TILT) ** 2
        if left_over < best:
            best, law = left_over, terms @ found
    return law


def _medians(values: Floats, axis: int) -> Floats:
    """Medians of what is known; NaN where nothing is."""
    known = np.isfinite(values)
    filled = np.where(known, values, np.inf)
    filled.sort(axis=axis)
    at = np.maximum((known.sum(axis=axis) - 1) // 2, 0)
    found = np.take_along_axis(filled, np.expand_dims(at, axis), axis).squeeze(axis)
    return np.asarray(np.where(np.isfinite(found), found, np.nan))
