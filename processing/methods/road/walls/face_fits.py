"""Each face measured: its line at the ground station by station, its lean, its top and bottom."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import TILE, SparsePlan, cell_of
from processing.methods.road.walls.fit_kernels import station_medians_kernel
from processing.methods.road.walls.wall_cells import (
    FACE_SLABS,
    GROUND_BIT,
    LOWEST_M,
    SLAB_M,
    SLABS,
    CellColumns,
    WallCellPoints,
)

BIN_M = 0.4
"""Between stations of a face: a few scan lines of a fast vehicle."""

_FEWEST_CELLS = 3
"""Of a face: 0.6 m, about the shortest piece of a wall between a gate and a corner."""

_FEWEST_POINTS = 3
"""Of a station: their median is off by less than the noise of one."""

_FRONT_M = (0.25, 0.45)
"""Before a face the ground is asked for so far away: one and two cells, clear of the face."""

_FEW_GROUND = 3.0
_AROUND_M = 0.15
"""Of what lies so near to a face and is not on it, how much there is tells a hedge from a wall."""

_BASE_SLABS, _LESS_SOLID, _FENCE_SHARE = 2, 0.15, 0.1
"""Of a wall with a fence on it: the lowest slabs, 0.4 m, how much less solid the fence is, and its
share of the points on both."""

_SOLID, _SMOOTHED = 0.62, 2
"""Share of points measured just after another one on it, between fences and walls, and stations to
either side that tell it: two metres together."""

_FITS = 4
"""Of the line and the lean of a face, each to the points on the one before."""

_TOLD_BY, _LOW_PART_M, _TOLD_LOW = 0.4, 1.5, 0.25
"""Share of points measured just after another one on the face from which these alone tell where it
is; and of its lower part, which tells the foot best."""

_FRAMES_M = 0.05
_NORMAL = 1.4826
"""From the median of distances to the standard deviation of a normal distribution."""

_THROUGH_M = (0.45, 0.65)
"""Behind a face, clear of a wall's own thickness: what it hides from a vehicle that looks over a
low wall, too."""

_TOP_SHARE, _LOW_SHARE = 0.99, 0.02

_TELLS_LEAN_M, _LEAST_LEAN = 0.5, 0.005
"""Height over which a face must show to tell its lean, and the least that counts: 5 mm in a metre
is what masons may be off (公共建築工事標準仕様書 8章)."""

_BEHIND_M = (0.3, 0.5, 0.7, 0.9)
"""Behind the top of a retaining wall, where the ground goes on."""


@dataclass(frozen=True)
class FaceStations:
    """A face, station by station.

    Attributes
    ----------
    line : (n, 3) float64
        Where the face meets the ground before it, m about the plan's origin.
    normal : (2,) float64
        Towards the vehicle's way.
    lean : float
        How far it leans away from there for each metre it rises.
    low_m, top_m : float
        Lowest and highest of its points over the foot.
    noise_m : float
        How far points lie off it.
    points : Integers
        Which of the kept points are on it, along the line.
    solid, flat, near, filled : float
        Shares: of its points that were measured just after another one on it; of the points about
        it that are on it, and that are as near as frames of windows; of squares between bottom and
        top that hold points.
    is_ground_behind, is_open : float
        Shares of stations behind which ground lies at the top, and behind which the ground at the
        foot is seen: one looks through.
    """

    line: Floats
    normal: Floats
    lean: float
    low_m: float
    top_m: float
    noise_m: float
    points: Integers
    solid: float
    flat: float
    near: float
    filled: float
    is_ground_behind: float
    is_open: float

    @cached_property
    def long_m(self) -> float:
        """Length in plan."""
        return float(np.hypot(*np.diff(self.line[:, :2], axis=0).T).sum())

    @property
    def way(self) -> Floats:
        """From the first to the last station, a unit vector in plan."""
        step = self.line[-1, :2] - self.line[0, :2]
        return np.asarray(step / max(float(np.hypot(*step)), 1e-9))


@dataclass(frozen=True)
class FaceSurroundings:
    """What faces are measured in.

    Attributes
    ----------
    plan : SparsePlan
    ground : (cells of 0.8 m,) float32
    columns : CellColumns
    points : WallCellPoints
    path : (n, 2) float64
        Where the vehicle drove, m about the plan's origin; none without a trajectory.
    noise_m : float
        How far off a face a point may lie.
    """

    plan: SparsePlan
    ground: NDArray[np.float32]
    columns: CellColumns
    points: WallCellPoints
    path: Floats
    noise_m: float

    def ground_at(self, places: Floats) -> Floats:
        """(n,) the ground at (n, 2) places, m; NaN where none is known."""
        heights = np.empty(len(places))
        ground_kernel(places, self.plan.table, self.ground, self.columns.ground, heights)
        return heights

    def is_ground_seen(self, places: Floats) -> Flags:
        """(n,) whether some points lie near the ground at (n, 2) places."""
        counts = np.empty(len(places))
        low_points_kernel(places, self.plan.table, self.columns.ground, counts)
        return np.asarray(counts >= _FEW_GROUND)

    def slabs_at(self, places: Floats) -> NDArray[np.uint32]:
        """(n,) the filled slabs over (n, 2) places."""
        slabs = np.empty(len(places), np.uint32)
        slabs_kernel(places, self.plan.table, self.columns.slabs, slabs)
        return slabs


def measured_faces(
    about: FaceSurroundings,
    planes: Floats,
    middles: Floats,
    cells: tuple[Integers, NDArray[np.int32]],
    monitor: Monitor,
) -> Iterator[FaceStations]:
    """All faces that are large enough.

    Parameters
    ----------
    cells : (faces, around)
        The face of each cell, and the numbers of the cells about each.
    """
    faces, around = cells
    owner = _with_rims(faces, around)
    points_of = np.repeat(owner, np.diff(about.points.starts))
    order = np.argsort(points_of, kind="stable")
    ends = np.searchsorted(points_of[order], np.arange(faces.max(initial=-1) + 2))
    cell_order = np.argsort(faces, kind="stable")
    cell_ends = np.searchsorted(faces[cell_order], np.arange(faces.max(initial=-1) + 2))
    for face in range(faces.max(initial=-1) + 1):
        own = cell_order[cell_ends[face] : cell_ends[face + 1]]
        if own.size < _FEWEST_CELLS:
            continue
        monitor.check()
        kept = order[ends[face] : ends[face + 1]]
        yield from _measured(about, planes[own], middles[own], kept)


def _with_rims(faces: Integers, around: NDArray[np.int32]) -> Integers:
    """The face of each cell, and of those beside one of a face: the most that any has."""
    owner = faces.copy()
    alone = np.flatnonzero(faces < 0)
    beside = np.where(around[alone] >= 0, faces[around[alone]], -1)
    owner[alone] = beside.max(axis=1, initial=-1)
    return owner


def _measured(
    about: FaceSurroundings, planes: Floats, middles: Floats, kept: Integers
) -> Iterator[FaceStations]:
    """A face, or its parts where a wall goes on as a fence."""
    local = about.points.local[kept]
    way, normal = _frame(about, planes, middles)
    sign = np.where(planes[:, :2] @ normal >= 0, 1.0, -1.0)
    slope = float(np.median(sign * planes[:, 3]))
    centres = middles + planes[:, :2] * planes[:, 2:3]
    guide = _Guide.of(centres @ way, centres @ normal, np.ones(len(centres), np.bool_), 1)
    along, off = local[:, :2] @ way, local[:, :2] @ normal
    feet = _feet(about, guide, way, normal)
    if feet is None:
        return
    above = local[:, 2] - np.interp(along, guide.at, feet)
    is_on, cut = np.zeros(len(kept), np.bool_), float("inf")
    for step in range(_FITS):
        left = off - guide.off_at(along) - slope * above
        is_on = (np.abs(left) <= about.noise_m) & (above <= cut)
        # Of a low wall with bars on it the bars are less to go by.
        is_solid = is_on & _solid(
            _Measures(about, way, normal, guide, slope),
            about.points.before[kept],
            (along, off, above),
        )
        told = is_solid if is_solid.sum() >= _TOLD_BY * is_on.sum() else is_on
        is_low = told & (above <= _LOW_PART_M)
        told = is_low if is_low.sum() >= _TOLD_LOW * told.sum() else told
        slope = _slope(along, off, above, told)
        guide = _Guide.of(along, off - slope * above, told, _FEWEST_POINTS)
        if not len(guide.at):
            return
        cut = _solid_top(above[is_on], is_solid[is_on]) if step == 0 else cut
    feet = _feet(about, guide, way, normal)
    if feet is None:
        return
    measures = _Measures(about, way, normal, guide, slope)
    is_solid = _solid(measures, about.points.before[kept], (along, off, above))
    stations = np.floor(along / BIN_M).astype(np.int64)
    for first, end in _parts(stations, is_solid, is_on):
        part = np.flatnonzero((stations >= first) & (stations < end))
        inside = (guide.at >= first * BIN_M) & (guide.at < end * BIN_M)
        if not inside.any():
            continue
        own = measures._replace(guide=_Guide(guide.at[inside], guide.off[inside]))
        points = _FacePoints(
            kept[part], along[part], off[part], above[part], is_on[part], is_solid[part]
        )
        found = _described(own, feet[inside], points)
        if found is not None:
            yield found


class _FacePoints(NamedTuple):
    """Points about a face: which of the kept ones they are, and where they lie in its frame."""

    kept: Integers
    along: Floats
    off: Floats
    above: Floats
    is_on: Flags
    is_solid: Flags


def _solid(
    measures: _Measures, before: NDArray[np.float32], places: tuple[Floats, Floats, Floats]
) -> Flags:
    """Points of which the one before, by the pulse before, lies on the face, too."""
    along, off, above = places
    left = off - measures.guide.off_at(along) - measures.slope * above
    last = left + before[:, :2] @ measures.normal - measures.slope * before[:, 2]
    with np.errstate(invalid="ignore"):
        is_near = np.abs(last) <= 1.5 * measures.about.noise_m
        return np.asarray(is_near & (above + before[:, 2] >= 0.0))


def _parts(stations: Integers, is_solid: Flags, is_on: Flags) -> list[tuple[int, int]]:
    """First station and the one after the last of stretches that are solid, or are not."""
    low = int(stations[is_on].min())
    count = int(stations[is_on].max()) - low + 1
    at = stations[is_on] - low
    window = np.ones(2 * _SMOOTHED + 1)
    total = np.convolve(np.bincount(at, minlength=count), window, "full")[_SMOOTHED:-_SMOOTHED]
    solid = np.convolve(np.bincount(at, is_solid[is_on], count), window, "full")
    share = solid[_SMOOTHED:-_SMOOTHED] / np.maximum(total, 1.0)
    state = share >= _SOLID
    edges = np.r_[0, np.flatnonzero(np.diff(state)) + 1, count]
    # What is shorter than a smoothed stretch belongs to the part before it.
    kept = [0]
    for edge in edges[1:-1].tolist():
        if edge - kept[-1] > 2 * _SMOOTHED and count - edge > 2 * _SMOOTHED:
            kept.append(edge)
    ends = [*kept, count]
    return [(low + a, low + b) for a, b in itertools.pairwise(ends)]


@dataclass(frozen=True)
class _Guide:
    """Where a face is: its distance from the origin along the normal, station by station."""

    at: Floats
    off: Floats

    @staticmethod
    def of(along: Floats, off: Floats, is_on: Flags, fewest: int) -> _Guide:
        """The medians of what is on it, where that is enough."""
        chosen = np.flatnonzero(is_on)
        if not chosen.size:
            return _Guide(np.empty(0), np.empty(0))
        station = np.floor(along[chosen] / BIN_M).astype(np.int64)
        station -= station.min()
        told = np.empty((int(station.max()) + 1, 2))
        told = told[: station_medians_kernel(station, along[chosen], off[chosen], fewest, told)]
        return _Guide(told[:, 0].copy(), told[:, 1].copy())

    def off_at(self, along: Floats) -> Floats:
        """Between the stations, and as at the last ones beyond them."""
        return np.asarray(np.interp(along, self.at, self.off))


class _Measures(NamedTuple):
    """A face in its frame."""

    about: FaceSurroundings
    way: Floats
    normal: Floats
    guide: _Guide
    slope: float

    def places(self, at: Floats, before_m: float, above_m: float = 0.0) -> Floats:
        """(n, 2) places so far before the face at a height."""
        off = self.guide.off_at(at) + self.slope * above_m + before_m
        return np.asarray(np.outer(at, self.way) + np.outer(off, self.normal))


def _frame(about: FaceSurroundings, planes: Floats, middles: Floats) -> tuple[Floats, Floats]:
    """Along a face, and square to it towards the vehicle's way.

    Without a trajectory, to where more of the ground was seen.
    """
    double = np.arctan2(planes[:, 1], planes[:, 0]) * 2
    turn = np.arctan2(np.sin(double).sum(), np.cos(double).sum()) / 2
    normal = np.array([np.cos(turn), np.sin(turn)])
    middle = middles.mean(axis=0)
    if len(about.path):
        nearest = about.path[((about.path - middle) ** 2).sum(axis=1).argmin()]
        side = float((nearest - middle) @ normal)
    else:
        seen = [
            np.count_nonzero(about.slabs_at(middles + sign * _FRONT_M[1] * normal) & GROUND_BIT)
            for sign in (1.0, -1.0)
        ]
        side = float(seen[0] - seen[1])
    normal = normal if side >= 0 else -normal
    return np.array([-normal[1], normal[0]]), normal


def _feet(about: FaceSurroundings, guide: _Guide, way: Floats, normal: Floats) -> Floats | None:
    """The ground before each station; between those that know it; None where none does."""
    told = [
        about.ground_at(np.outer(guide.at, way) + np.outer(guide.off + before, normal))
        for before in _FRONT_M
    ]
    feet = np.where(np.isfinite(told[0]), told[0], told[1])
    known = np.flatnonzero(np.isfinite(feet))
    if not known.size:
        return None
    return np.asarray(np.interp(guide.at, guide.at[known], feet[known]))


def _slope(along: Floats, off: Floats, above: Floats, is_on: Flags) -> float:
    """How far a face moves along its normal for each metre up: least squares within stations."""
    chosen = np.flatnonzero(is_on)
    if chosen.size < 2 * _FEWEST_POINTS or np.ptp(above[chosen]) < _TELLS_LEAN_M:
        return 0.0
    station = np.floor(along[chosen] / BIN_M).astype(np.int64)
    station -= station.min()
    count = np.maximum(np.bincount(station), 1)
    high = above[chosen] - (np.bincount(station, above[chosen]) / count)[station]
    away = off[chosen] - (np.bincount(station, off[chosen]) / count)[station]
    square = float(high @ high)
    slope = float(high @ away) / square if square > 0 else 0.0
    # What the noise may feign of it is none.
    error = float(np.std(away - slope * high)) / np.sqrt(max(square, 1e-9))
    return slope if abs(slope) > 3 * error + _LEAST_LEAN else 0.0


def _described(
    measures: _Measures,
    feet: Floats,
    seen: _FacePoints,
) -> FaceStations | None:
    """A face with what tells walls from other things."""
    guide = measures.guide
    kept, along, off, above, is_on, is_solid = seen
    left = off - guide.off_at(along) - measures.slope * above
    is_on = is_on & (above <= _solid_top(above[is_on], is_solid[is_on]))
    on = np.flatnonzero(is_on)
    if on.size < 2 * _FEWEST_POINTS:
        return None
    low, top = np.quantile(above[on], [_LOW_SHARE, _TOP_SHARE])
    top = _true_top(measures, float(top))
    inside = (above >= low) & (above <= top) & (np.abs(left) <= _AROUND_M)
    about_it = max(1, int(inside.sum()))
    ends = np.array([_end(along[on], 1.0), _end(along[on], -1.0)])
    stations = np.column_stack([measures.places(guide.at, 0.0), feet])
    return FaceStations(
        line=_with_ends(stations, measures, ends),
        normal=measures.normal,
        lean=-measures.slope,
        low_m=float(low),
        top_m=top,
        noise_m=_NORMAL * float(np.median(np.abs(left[on]))),
        points=kept[on[np.argsort(along[on], kind="stable")]],
        solid=float(np.mean(is_solid[on])),
        flat=int((inside & is_on).sum()) / about_it,
        near=int((inside & (np.abs(left) <= _FRAMES_M)).sum()) / about_it,
        filled=_filled(along[on], above[on], float(low), top),
        is_ground_behind=_ground_behind(measures, top),
        is_open=_open_share(measures),
    )


def _solid_top(above: Floats, is_solid: Flags) -> float:
    """Up to which height a face is solid, where a fence stands on it; infinite where none does.

    Parameters
    ----------
    above : (n,) float64
        Of the points on it over its foot.
    is_solid : (n,) bool
        Which of them were measured just after another one.
    """
    slab = np.maximum(((above - LOWEST_M) / SLAB_M).astype(np.int64), 0)
    count = np.bincount(slab)
    share = np.bincount(slab, is_solid) / np.maximum(count, 1)
    known = np.flatnonzero(count >= _FEWEST_POINTS)
    if known.size <= _BASE_SLABS:
        return float("inf")
    base = float(np.median(share[known[: _BASE_SLABS + 1]]))
    limit = base - _LESS_SOLID if base >= _SOLID + _LESS_SOLID else _SOLID
    for place in range(_BASE_SLABS, known.size):
        over = slab >= known[place]
        # A rail on top of bars is as solid as the wall: what counts is all from there on.
        if share[known[place]] < limit and is_solid[over].mean() < limit:
            is_fence = over.sum() >= _FENCE_SHARE * slab.size and base >= _SOLID
            return float(LOWEST_M + known[place] * SLAB_M) if is_fence else float("inf")
    return float("inf")


def _true_top(measures: _Measures, seen_m: float) -> float:
    """The top of a face: beyond the slabs whose points were kept, as far as slabs are filled."""
    if seen_m < LOWEST_M + (FACE_SLABS - 1) * SLAB_M:
        return seen_m
    slabs = measures.about.slabs_at(measures.places(measures.guide.at, 0.0, seen_m))
    high = 0
    for slab in range(FACE_SLABS, SLABS):
        if np.count_nonzero(slabs & np.uint32(1 << slab)) < 0.3 * slabs.size:
            break
        high = slab + 1
    return LOWEST_M + high * SLAB_M if high else seen_m


def _ground_behind(measures: _Measures, top_m: float) -> float:
    """The share of stations behind which something lies at the top and nothing below it."""
    level = int((top_m - LOWEST_M) / SLAB_M)
    if level < 1 or level >= SLABS - 1:
        return 0.0
    at_top = np.uint32(0b111 << max(level - 1, 0))
    below = np.uint32((1 << max(level - 1, 0)) - 1) | GROUND_BIT
    is_behind = np.zeros(len(measures.guide.at), np.bool_)
    is_open = np.zeros(len(measures.guide.at), np.bool_)
    for back in _BEHIND_M:
        slabs = measures.about.slabs_at(measures.places(measures.guide.at, -back, top_m))
        is_behind |= (slabs & at_top) > 0
        is_open |= (slabs & below) > 0
    return float(np.mean(is_behind & ~is_open))


def _open_share(measures: _Measures) -> float:
    """The share of stations behind which the ground is seen."""
    is_seen = np.zeros(len(measures.guide.at), np.bool_)
    for back in _THROUGH_M:
        is_seen |= measures.about.is_ground_seen(measures.places(measures.guide.at, -back))
    return float(np.mean(is_seen))


def _end(along: Floats, sign: float) -> float:
    """Where a face ends: its third last point, so that two strays don't lengthen it."""
    rank = min(2, along.size - 1)
    return float(sign * np.partition(sign * along, rank)[rank])


def _with_ends(line: Floats, measures: _Measures, ends: Floats) -> Floats:
    """The stations with the ends of the face before and behind them."""
    places = measures.places(ends, 0.0)
    rises = np.interp(ends, measures.guide.at, line[:, 2])
    both = np.column_stack([places, rises])
    inner = line[(measures.guide.at > ends[0] + 0.05) & (measures.guide.at < ends[1] - 0.05)]
    return np.concatenate([both[:1], inner, both[1:]])


def _filled(along: Floats, above: Floats, low_m: float, top_m: float) -> float:
    """The share of squares of a face, a slab high and two wide, that hold points."""
    top = min(top_m, LOWEST_M + FACE_SLABS * SLAB_M)
    rows = max(1, round((top - low_m) / SLAB_M))
    row = np.clip(((above - low_m) / max(top - low_m, 1e-6) * rows).astype(np.int64), 0, rows - 1)
    column = np.floor((along - along.min()) / BIN_M).astype(np.int64)
    return float(np.unique(column * rows + row).size / (rows * (int(column.max()) + 1)))


@kernel
def ground_kernel(
    places: Floats,
    table: NDArray[np.int32],
    ground: NDArray[np.float32],
    lows: NDArray[np.float32],
    heights: Floats,
) -> None:
    """The mean of what was measured near the ground in each place's cell, or the coarse ground."""
    for place in range(len(places)):
        heights[place] = np.nan
        cell = cell_of(places[place, 0], places[place, 1], table, TILE)
        if cell < 0:
            continue
        floor = ground[cell_of(places[place, 0], places[place, 1], table, GROUND_CELLS)]
        heights[place] = floor
        if lows[cell, 1] >= _FEW_GROUND:
            heights[place] = floor + lows[cell, 0] / lows[cell, 1]


@kernel
def low_points_kernel(
    places: Floats, table: NDArray[np.int32], lows: NDArray[np.float32], counts: Floats
) -> None:
    """How many points near the ground were counted in each place's cell."""
    for place in range(len(places)):
        cell = cell_of(places[place, 0], places[place, 1], table, TILE)
        counts[place] = lows[cell, 1] if cell >= 0 else 0.0


@kernel
def slabs_kernel(
    places: Floats, table: NDArray[np.int32], slabs: NDArray[np.uint32], found: NDArray[np.uint32]
) -> None:
    """The slabs over each place; 0 where nothing was measured."""
    for place in range(len(places)):
        cell = cell_of(places[place, 0], places[place, 1], table, TILE)
        found[place] = slabs[cell] if cell >= 0 else np.uint32(0)
