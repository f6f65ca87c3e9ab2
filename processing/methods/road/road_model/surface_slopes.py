"""Falls across and slope along a road, by straight lines through its measured surface."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats
from processing.methods.road.surface.carriageway import RoadProfiles

_ALONG_M, _ROWS_M = 10.0, 2.0
"""To either side of a station: surface along which the slope is taken, and across which the fall
is. A gradient is that of the road, not of a patch in it."""

_MIDDLE_M = 0.5
_EDGE_M, _CENTRE_M = 0.3, 0.2
"""Left out of a half: the foot of the curb, and the crown or the centre line's paint."""

_STEEPEST, _UNEVEN_M = 0.12, 0.1
"""Share that a carriageway falls at most (道路構造令 第16条: 10 %, and its unevenness), and how far
its middle may be off, m."""

_FEWEST, _ROUNDS = 6, 8
_TUKEY = 4.685
"""Of the biweight, in standard deviations: 95 % as exact as least squares where nothing is off
(Huber and Ronchetti 2009, section 4.8)."""

_SCALE = 1.4826
_LEAST_OFF_M = 0.0005
"""Surfaces are not known better, however well a few cells agree."""


class StraightFit(NamedTuple):
    """A straight line: slope, how far it may be off (one standard deviation), height at zero."""

    slope: float
    within: float
    height: float


UNKNOWN = StraightFit(math.nan, math.nan, math.nan)


def straight_fit(places: Floats, heights: Floats) -> StraightFit:
    """The line through most of some places; `UNKNOWN` of too few.

    Parameters
    ----------
    places, heights : (n,) float64
        NaN heights don't count.

    Notes
    -----
    1. The middle of the slopes between all pairs of places begins (Theil 1950, Sen 1968).
    2. Least squares with Tukey's biweight: what lies off by 4.7 standard deviations says nothing.
    3. The standard deviation is that of least squares with the places that count. Neighbours may
       be off together by unevenness, which it doesn't know.
    """
    known = np.isfinite(heights)
    x, z = places[known], heights[known]
    if x.size < _FEWEST or np.ptp(x) <= 0:
        return UNKNOWN
    one, other = np.triu_indices(x.size, 1)
    apart = x[other] - x[one]
    is_apart = apart != 0
    slope = float(np.median((z[other] - z[one])[is_apart] / apart[is_apart]))
    height = float(np.median(z - slope * x))
    weight = np.ones_like(x)
    spread = _LEAST_OFF_M
    for _ in range(_ROUNDS):
        off = z - height - slope * x
        spread = max(_SCALE * float(np.median(np.abs(off))), _LEAST_OFF_M)
        weight = np.maximum(1 - (off / (_TUKEY * spread)) ** 2, 0.0) ** 2
        total = float(weight.sum())
        middle = float(weight @ x) / total
        about = x - middle
        moment = float(weight @ about**2)
        if moment <= 0:
            return UNKNOWN
        level = float(weight @ z) / total
        slope = float(weight @ (about * (z - level))) / moment
        height = level - slope * middle
    return StraightFit(slope, spread / math.sqrt(moment), height)


def slope_along(profiles: RoadProfiles, station_m: float) -> StraightFit:
    """Rise along the line at a station, and the height there, about the raster's origin."""
    rows = np.abs(profiles.stations - station_m) <= _ALONG_M
    middle = np.abs(profiles.offsets) <= _MIDDLE_M
    heights = row_medians(profiles.heights[rows][:, middle])
    return straight_fit(profiles.stations[rows] - station_m, heights)


def fall_across(
    profiles: RoadProfiles, station_m: float, edge_m: float, along: StraightFit, *, is_left: bool
) -> StraightFit:
    """Fall of a half outwards at a station, positive downwards; `UNKNOWN` without an edge.

    Parameters
    ----------
    edge_m : float
        How far from the centre line the carriageway reaches.
    along : StraightFit
        Slope and height of the line, which rows before and behind are levelled by. What lies
        farther from it than the steepest carriageway falls is none, as below what a scanner that
        measures by phase draws under the road.
    """
    if math.isnan(edge_m) or math.isnan(along.height):
        return UNKNOWN
    rows = np.abs(profiles.stations - station_m) <= _ROWS_M
    away = profiles.offsets if is_left else -profiles.offsets
    columns = (away >= _CENTRE_M) & (away <= edge_m - _EDGE_M)
    ahead = (profiles.stations[rows] - station_m) * along.slope
    heights = profiles.heights[rows][:, columns] - ahead[:, None]
    room = _STEEPEST * away[columns] + _UNEVEN_M
    with np.errstate(invalid="ignore"):
        heights[np.abs(heights - along.height) > room[None]] = np.nan
    fit = straight_fit(away[columns], row_medians(heights.T))
    return fit._replace(slope=-fit.slope)


def row_medians(values: Floats) -> Floats:
    """(n,) the middle of each row's known values of (n, m); NaN of none."""
    ordered = np.sort(values, axis=1)
    count = np.isfinite(ordered).sum(axis=1)
    if not ordered.size:
        return np.full(len(values), np.nan)
    rows = np.arange(len(values))
    low, high = np.maximum(count - 1, 0) // 2, np.minimum(count // 2, ordered.shape[1] - 1)
    medians: Floats = np.where(count > 0, (ordered[rows, low] + ordered[rows, high]) / 2, np.nan)
    return medians
