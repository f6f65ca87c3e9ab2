"""Cells of the plan that are carriageway or walk, each with the height of its surface.

The surface under parked vehicles and in shadows is that of the rows around: across the road a
parabola, which holds the crown and the rise to the outside of a bend.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats
from processing.methods.road.objects.column_points import nearest_columns
from processing.methods.road.objects.sparse_plan import TILE
from processing.methods.road.surface.carriageway import RoadEdges, RoadProfiles
from processing.methods.road.surface.road_frame import RoadFrame
from processing.methods.road.surface.road_raster import REACH_M, RoadRaster, middles_of

NONE, CARRIAGEWAY, WALK = 0, 1, 2

_BLOCK_ROWS, _MARGIN_ROWS = 4, 6
"""Rows of a parabola's own and those on either side that it is fitted to: 8 m of road."""

_FEWEST, _ROUNDS = 30, 4
_OFF_M = 0.06
"""What lies farther off the parabola is no surface: unevenness and ruts are less."""

_TERMS = 4


@dataclass(frozen=True)
class RoadCells:
    """Cells of 0.2 m of a raster's plan.

    Attributes
    ----------
    surface : (cells,) float32
        m about the plan's origin; NaN outside the road.
    part : (cells,) uint8
        `NONE`, `CARRIAGEWAY` or `WALK`.
    depth : (cells,) float32
        How far inside its part's edge, m.
    frame : (cells,) int16
        Which of the frames told it.
    station : (cells,) float32
        Along that frame, m.
    is_seen : (cells,) bool
        Whether the edge on its side was seen.
    """

    surface: NDArray[np.float32]
    part: NDArray[np.uint8]
    depth: NDArray[np.float32]
    frame: NDArray[np.int16]
    station: NDArray[np.float32]
    is_seen: Flags


def road_cells(
    raster: RoadRaster,
    roads: Sequence[tuple[RoadFrame, RoadProfiles, RoadEdges]],
) -> RoadCells:
    """The cells between the edges of some frames; where several tell one, the one deepest inside.

    A place is carriageway if any frame says so.
    """
    count = len(raster.plan) * TILE * TILE
    cells = RoadCells(
        np.full(count, np.nan, np.float32),
        np.zeros(count, np.uint8),
        np.full(count, -np.inf, np.float32),
        np.full(count, -1, np.int16),
        np.full(count, np.nan, np.float32),
        np.zeros(count, np.bool_),
    )
    for number, (frame, profiles, edges) in enumerate(roads):
        _add(cells, raster, number, (frame, profiles, edges))
    return cells


def _add(
    cells: RoadCells,
    raster: RoadRaster,
    number: int,
    road: tuple[RoadFrame, RoadProfiles, RoadEdges],
) -> None:
    frame, profiles, edges = road
    nearest = nearest_columns(raster.plan, frame.nodes, REACH_M).reshape(-1)
    near = np.flatnonzero(nearest >= 0)
    station, offset = frame.located(middles_of(raster.plan, near), nearest[near].astype(np.int64))
    inside = (station >= frame.start_m) & (station <= frame.end_m)
    near, station, offset = near[inside], station[inside], offset[inside]
    row = np.clip(np.rint((station - profiles.stations[0]) / 0.5), 0, len(profiles.stations) - 1)
    row = row.astype(np.int64)
    side, away = (offset < 0).astype(np.int64), np.abs(offset)
    edge, walk = edges.edge[side, row], edges.walk[side, row]
    on_road = away <= edge
    on_walk = ~on_road & (away <= walk)
    depth = np.where(on_road, edge - away, np.minimum(away - edge, walk - away))
    before = cells.part[near]
    better = (depth > cells.depth[near]) | (before != CARRIAGEWAY) & on_road
    worse = (before == CARRIAGEWAY) & on_walk
    chosen = (on_road | on_walk) & better & ~worse
    cells.is_seen[near[chosen]] = edges.is_seen[side[chosen], row[chosen]]
    near, row = near[chosen], row[chosen]
    fitted = fitted_surface(profiles, edges)
    own = raster.heights.reshape(-1)[near].astype(np.float64)
    told = _of_rows(fitted, row, offset[chosen])
    is_road = on_road[chosen]
    known = np.isfinite(own) & (~is_road | (np.abs(own - told) <= _OFF_M))
    # On a walk the surface is what was measured there.
    surface = np.where(known, own, np.where(is_road, told, np.nan))
    cells.surface[near] = surface
    cells.part[near] = np.where(is_road, CARRIAGEWAY, WALK)
    cells.depth[near] = depth[chosen]
    cells.frame[near] = number
    cells.station[near] = station[chosen]


def fitted_surface(profiles: RoadProfiles, edges: RoadEdges) -> Floats:
    """(n, 4) float64 for each row: height on the line, slope and bend across, slope along.

    NaN where no carriageway was measured within some metres.
    """
    offsets = profiles.offsets
    rows = len(profiles.stations)
    inside = (offsets[None] <= edges.edge[0][:, None]) & (offsets[None] >= -edges.edge[1][:, None])
    terms = np.full((rows, _TERMS), np.nan)
    for first in range(0, rows, _BLOCK_ROWS):
        low, high = max(0, first - _MARGIN_ROWS), min(rows, first + _BLOCK_ROWS + _MARGIN_ROWS)
        at = (first + min(rows, first + _BLOCK_ROWS) - 1) / 2
        row, column = np.nonzero(inside[low:high] & np.isfinite(profiles.heights[low:high]))
        heights = profiles.heights[low:high][row, column]
        along = (row + low - at).astype(np.float64) * 0.5
        fit = _parabola(offsets[column], along, heights)
        for one in range(first, min(rows, first + _BLOCK_ROWS)):
            terms[one] = fit
            terms[one, 0] += fit[3] * (one - at) * 0.5
    return _nearest_known(terms)


def _parabola(across: Floats, along: Floats, heights: Floats) -> Floats:
    """Least squares whose far points are left out round by round; NaN of too few."""
    if heights.size < _FEWEST:
        return np.full(_TERMS, np.nan)
    design = np.column_stack([np.ones_like(across), across, across**2, along])
    # Vehicles lie above the road: the first round keeps the lower half.
    kept: Flags = heights <= np.median(heights) + 0.3
    fit = np.full(_TERMS, np.nan)
    for _ in range(_ROUNDS):
        if kept.sum() < _FEWEST:
            return np.full(_TERMS, np.nan)
        fit = np.linalg.lstsq(design[kept], heights[kept], rcond=None)[0]
        off = heights - design @ fit
        spread = 1.4826 * float(np.median(np.abs(off[kept])))
        kept = np.abs(off) <= max(3 * spread, _OFF_M / 2)
    return np.asarray(fit)


def _nearest_known(terms: Floats) -> Floats:
    known = np.flatnonzero(np.isfinite(terms[:, 0]))
    if not known.size:
        return terms
    rows = np.arange(len(terms))
    after = np.clip(np.searchsorted(known, rows), 0, known.size - 1)
    before = np.maximum(after - 1, 0)
    is_before = np.abs(known[before] - rows) < np.abs(known[after] - rows)
    nearest = known[np.where(is_before, before, after)]
    filled = terms[nearest].copy()
    filled[:, 0] += filled[:, 3] * (rows - nearest) * 0.5
    return filled


def _of_rows(terms: Floats, row: NDArray[np.int64], offset: Floats) -> Floats:
    chosen = terms[row]
    told: Floats = chosen[:, 0] + chosen[:, 1] * offset + chosen[:, 2] * offset**2
    return told
