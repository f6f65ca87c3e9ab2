"""Where the carriageway ends on both sides of a line, told by the measured surface alone.

From the line outwards the surface goes on evenly until it steps up at a curb, or down into a
gutter. Single rows are hidden by vehicles or lowered at entrances: what most of the rows before and
behind show counts. A place behind the step that is even again is a walk.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats
from processing.methods.road.objects.sparse_plan import CELL_M
from processing.methods.road.surface.road_frame import RoadFrame
from processing.methods.road.surface.road_raster import REACH_M, RoadRaster

ROW_M = 0.5
"""From one row across to the next."""

HALF_LANE_M = 3.0
"""Without an edge what lies so near to the line is carriageway: half a lane and the next one's
edge (道路構造令 第5条: lanes of 2.75 to 3.5 m)."""

WALK_M = 3.5
"""Width of a walk that many use (道路構造令 第11条), where no step ends it before."""

_STEP_M = 0.04
"""Rise of a curb over the slope before it: curbs are 15 to 25 cm high, lowered ones 5 cm
(移動等円滑化 standards: 2 cm at crossings, which the rows beside tell)."""

_DROP_M = 0.06
_WALL_M, _WALL_CELLS = 0.35, 4
"""What rises more within 0.8 m is no curb but a wall, a hedge or a parked vehicle."""

_OTHER_LANE_M = 5.0
"""So much is carriageway where nothing but a wall far beyond ends it: the rest of the lane and the
one that comes towards it, as on roads of two lanes (道路構造令 第5条)."""

_AHEAD, _BEFORE = 2, 5
"""Cells over which a rise is measured, and those before it over which the slope is."""

_NEAREST_M = 1.0
"""The vehicle's own half width: nearer to its path is no edge."""

_SMOOTHED_ROWS, _MEDIAN_ROWS, _NEAR_ROWS = 5, 20, 5
_LEAST_SHARE, _SAME_M = 0.25, 1.0
"""Of the rows within 10 m to either side those that must show an edge, and how far apart edges
within 2.5 m are one."""

_WALK_STEP_M, _LEAST_WALK_M, _GAP_CELLS = 0.08, 0.6, 3


class RoadProfiles(NamedTuple):
    """The surface across a frame.

    Attributes
    ----------
    stations : (n,) float64
    offsets : (m,) float64
        To the left, rising.
    heights : (n, m) float64
        m about the raster's origin; NaN where nothing was measured.
    """

    stations: Floats
    offsets: Floats
    heights: Floats


class RoadEdges(NamedTuple):
    """Where carriageway and walks end at each row of profiles: (n,) float64 each, m from the line.

    Attributes
    ----------
    edge : (2, n) float64
        Left, right.
    is_seen : (2, n) bool
        False where no curb or gutter was found for a long way, so that half a lane counts, or a
        lane more where there is room.
    walk : (2, n) float64
        Where the walk ends; NaN where there is none.
    """

    edge: Floats
    is_seen: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    walk: Floats


def profiles_of(raster: RoadRaster, frame: RoadFrame) -> RoadProfiles:
    """Heights each half metre along a frame, each 0.2 m across it."""
    stations = np.arange(frame.start_m, frame.end_m + ROW_M / 2, ROW_M)
    half = round(REACH_M / CELL_M)
    offsets = np.arange(-half, half + 1).astype(np.float64) * CELL_M
    return RoadProfiles(stations, offsets, raster.at(frame.places(stations, offsets)))


def edges_of(profiles: RoadProfiles) -> RoadEdges:
    """Edges on both sides of the line.

    Notes
    -----
    1. Rows are smoothed along the line, so that single cells tell nothing.
    2. The first cell outwards whose surface rises by 4 cm within 0.4 m over the slope of the metre
       before it, or falls by 6 cm, is an edge.
    3. Of the rows within 10 m the middle edge counts, or that of the nearest rows which agree.
    """
    smooth = _smoothed(profiles.heights)
    middle = len(profiles.offsets) // 2
    edges, seen, walks = [], [], []
    for sign in (1, -1):
        outwards = smooth[:, middle::sign]
        own = np.array([_first_edge(row) for row in outwards]).reshape(-1, 2)
        settled, ends_m = _settled(own[:, 0]), _settled(own[:, 1])
        is_seen = np.isfinite(settled)
        ends = np.array([_walk_end(row, at) for row, at in zip(outwards, settled, strict=True)])
        edges.append(np.where(is_seen, settled, _without_edge(ends_m)))
        seen.append(is_seen)
        walks.append(_settled(ends))
    return RoadEdges(np.array(edges), np.array(seen), np.array(walks))


def _smoothed(heights: Floats) -> Floats:
    """Medians of five rows."""
    half = _SMOOTHED_ROWS // 2
    padded = np.pad(heights, ((half, half), (0, 0)), mode="edge")
    rows = np.stack([padded[k : k + len(heights)] for k in range(_SMOOTHED_ROWS)])
    return _nan_median(rows)


def _nan_median(values: Floats) -> Floats:
    """Medians along the first axis without what isn't known; NaN of nothing."""
    ordered = np.sort(values, axis=0)  # NaN last
    count = np.isfinite(ordered).sum(axis=0)
    low, high = np.maximum(count - 1, 0) // 2, count // 2
    both = [
        np.take_along_axis(ordered, at[None], axis=0)[0]
        for at in (low, np.minimum(high, len(values) - 1))
    ]
    medians: Floats = np.where(count > 0, (both[0] + both[1]) / 2, np.nan)
    return medians


def _without_edge(end_m: Floats) -> Floats:
    """How far the carriageway is taken to reach where a wall or nothing ends what is even."""
    far = np.where(end_m < _OTHER_LANE_M, np.minimum(end_m, HALF_LANE_M), _OTHER_LANE_M)
    reach: Floats = np.where(np.isfinite(end_m), far, HALF_LANE_M)
    return reach


def _first_edge(row: Floats) -> tuple[float, float]:
    """How far from the line a row's first curb or gutter lies, and its first wall, m; else NaN."""
    first = math.ceil(_NEAREST_M / CELL_M)
    for at in range(max(first, _BEFORE), len(row) - _AHEAD):
        slope = (row[at] - row[at - _BEFORE]) / _BEFORE
        rise = row[at + _AHEAD] - row[at] - _AHEAD * slope
        if rise >= _STEP_M or row[at + _AHEAD] - row[at] <= -_DROP_M:
            steps = np.abs(np.diff(row[at : at + _AHEAD + 1]) - slope)
            within = int(np.nanargmax(steps)) if np.isfinite(steps).any() else 0
            edge_m = (at + 0.5 + within) * CELL_M
            beyond = row[at : at + _WALL_CELLS + 1] - row[at]
            if np.nanmax(beyond) > _WALL_M:
                return math.nan, edge_m
            return edge_m, math.nan
    return math.nan, math.nan


def _settled(own: Floats) -> Floats:
    """What most of the rows about each show; NaN where too few show anything."""
    found = np.full(own.shape, np.nan)
    for row in range(len(own)):
        wide = own[max(0, row - _MEDIAN_ROWS) : row + _MEDIAN_ROWS + 1]
        known = wide[np.isfinite(wide)]
        if known.size < _LEAST_SHARE * wide.size:
            continue
        middle = float(np.median(known))
        near = own[max(0, row - _NEAR_ROWS) : row + _NEAR_ROWS + 1]
        near = near[np.abs(near - middle) <= _SAME_M]
        found[row] = float(np.median(near)) if near.size else middle
    return found


def _walk_end(row: Floats, edge_m: float) -> float:
    """Where an even place behind a curb ends; NaN where there is none."""
    if not math.isfinite(edge_m):
        return math.nan
    first = math.ceil(edge_m / CELL_M) + 1
    last = min(len(row) - 1, first + round(WALK_M / CELL_M))
    before = row[max(0, first - 4)] if first - 4 < len(row) else math.nan
    if first >= last or not row[first] - before >= _STEP_M:
        return math.nan
    missing, height = 0, row[first]
    end = first
    for at in range(first + 1, last + 1):
        if not math.isfinite(row[at]):
            missing += 1
            if missing > _GAP_CELLS:
                break
            continue
        if abs(row[at] - height) >= _WALK_STEP_M * (1 + missing):
            break
        missing, height, end = 0, row[at], at
    wide = (end - first) * CELL_M
    return (end + 0.5) * CELL_M if wide >= _LEAST_WALK_M else math.nan
