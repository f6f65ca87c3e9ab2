"""Where a gutter's covers are barred: gratings between lids, by the points themselves.

On a lid heights follow each other smoothly from pulse to pulse. Between the bars of a grating
beams fall by centimetres and come back, however flat they come in, so that a good part of all
points lies off the middle of its two neighbours; how many do on the gutter's own lids is measured.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter, uniform_filter1d

from processing.methods.road.curbs.edges.curb_points import PointsAbout
from processing.methods.road.gutters.gutter_axis import STEP_M
from processing.methods.road.gutters.gutter_depths import are_deep
from processing.methods.road.gutters.gutter_joints import (
    LID,
    POSITION_M,
    JointRow,
    RowKnown,
    joint_row,
)
from processing.methods.road.gutters.gutter_runs import GutterRun, length_of
from processing.recording.drive import Drive

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_RIM_M = 0.03
"""Left out at the sides of covers, as in `gutter_lids`."""

_MOST_PULSES = 2
"""From a point to its neighbour: one lost pulse between them."""

_ROUGH = 3.0
"""Standard deviations from which a point is off its neighbours: one in 370 of normal noise."""

_OF_MEDIAN = 1.4826
"""Standard deviation in median absolute deviations of normal noise."""

_LEAST_SPREAD_M = 0.0003
"""Of heights: what coordinates are rounded to."""

_WINDOW_M = 0.15
"""Over which points are counted: five bars and gaps of 3 cm."""

_OF_LIDS, _LEAST_OF_LIDS, _MOST_OF_LIDS = 1.5, 0.05, 0.3
"""Share of rough points on a dirty or worn lid, in times the usual lid's; at least and at most. Of
3,026 lids with more than 90 % of them free one in ten has more than .15, and one in ten of 216
gratings less than .16; half of the gratings have more than .46."""

_OF_GRATINGS = 0.45
"""Share on a grating: half of its surface is open."""

_LEVEL_M, _LEVEL_STEP_M, _RAISED_M = 6.0, 1.0, 0.03
"""The tops of covers lie about level over so much; what rises so far above them, more than lids of
one gutter differ, is plants and soil, which are rough too. Bars lie no higher than lids."""

_AGREEING = 3.0
"""Points of a row that tell the same: those about the edge of one bar."""


def barred_run(
    run: GutterRun,
    drives: Sequence[Drive],
    about: Sequence[tuple[PointsAbout, slice]],
    most_missed: int,
) -> GutterRun:
    """The gutter with its covers told apart by the points on them.

    Parameters
    ----------
    run : GutterRun
    drives : sequence of Drive
    about : sequence of (PointsAbout, slice)
        Of each drive: the points about gutters, and which of them are about this one.
    most_missed : int
        As for `gutter_runs`.
    """
    parts = [_rough_points(run, *one) for one in zip(drives, about, strict=True)]
    along, is_rough = (np.concatenate([part[k] for part in parts]) for k in range(2))
    barred = _chances(run, along, is_rough.astype(np.bool_))
    known = RowKnown(most_missed, run.row.share_seen, barred)
    row = joint_row(run.notches, run.mixes, run.axis.length_m, known)
    if row is None:
        return run
    row = row.chosen(are_deep(row, run.depths, run.holes))
    if row.starts_m.size == 0:
        return run
    return replace(run, row=row, length_m=length_of(row), barred=_means(row, barred))


def _means(row: JointRow, values: _Floats) -> _Floats:
    """(k,) means over the covers of a row of values every `POSITION_M`."""
    summed = np.concatenate([[0.0], np.cumsum(values)])
    first, stop = (
        np.clip(np.round(ends / POSITION_M).astype(np.int64), 0, values.size)
        for ends in (row.starts_m, row.ends_m)
    )
    return np.asarray((summed[stop] - summed[first]) / np.maximum(stop - first, 1), np.float64)


def _rough_points(
    run: GutterRun, drive: Drive, about: tuple[PointsAbout, slice]
) -> tuple[_Floats, _Floats]:
    """Where points of a drive lie along the covers, m, and which are off their neighbours (1)."""
    points, part = about
    order = np.argsort(points.point[part], kind="stable")
    point, across = points.point[part][order], points.across[part][order]
    along, above = points.along[part][order] * STEP_M, points.above[part][order]
    low, high = run.edges
    inner = np.flatnonzero((across > low + _RIM_M) & (across < high - _RIM_M))
    inner = inner[(point[inner] > 0) & (point[inner] < drive.count - 1)]
    if inner.size == 0:
        return np.empty(0), np.empty(0)
    pulse = drive.columns["pulse"]
    own = np.asarray(pulse[point[inner]], np.int64)
    is_known, is_off = np.ones(inner.size, np.bool_), np.zeros(inner.size, np.bool_)
    middle, highest = np.zeros(inner.size), above[inner]
    for step in (-1, 1):
        beside = np.clip(inner + step, 0, point.size - 1)
        is_met = point[beside] == point[inner] + step
        apart = np.abs(np.asarray(pulse[point[inner] + step], np.int64) - own)
        is_known &= apart <= _MOST_PULSES
        # So near to the middle only what fell deep is beyond the points about the gutter.
        is_off |= ~is_met
        middle += above[beside] / 2
        highest = np.maximum(highest, np.where(is_met, above[beside], -np.inf))
    off = np.abs(above[inner] - middle)
    is_smooth = is_known & ~is_off
    if not is_smooth.any():
        return np.empty(0), np.empty(0)
    spread = max(_OF_MEDIAN * float(np.median(off[is_smooth])), _LEAST_SPREAD_M)
    is_rough = is_off | (off > _ROUGH * spread)
    is_rough &= highest <= _level_at(along[inner], above[inner]) + _RAISED_M
    return along[inner][is_known], is_rough[is_known].astype(np.float64)


def _level_at(along: _Floats, above: _Floats) -> _Floats:
    """(n,) how high the tops of covers lie about each point: medians of metres, then of some."""
    station = np.floor(along / _LEVEL_STEP_M).astype(np.int64)
    station -= station.min()
    order = np.lexsort((above, station))
    starts = np.searchsorted(station[order], np.arange(int(station.max()) + 2))
    known = np.flatnonzero(np.diff(starts) > 0)
    heights = above[order][(starts[known] + starts[known + 1]) // 2]
    window = round(_LEVEL_M / _LEVEL_STEP_M) + 1
    levels = median_filter(np.interp(np.arange(starts.size - 1), known, heights), window)
    return np.asarray(levels[station], np.float64)


def _chances(run: GutterRun, along: _Floats, is_rough: NDArray[np.bool_]) -> _Floats:
    """Of each place along the gutter, the chance that it is barred, 0 to 1; ½: nothing known."""
    row, count = run.row, int(run.axis.length_m / POSITION_M) + 1
    at = np.floor(along / POSITION_M).astype(np.int64)
    is_in = (at >= 0) & (at < count)
    at, is_rough, along = at[is_in], is_rough[is_in], along[is_in]
    of_lids = _usual_share(along, is_rough, row.starts_m[row.what == LID], row.ends_m)
    of_lids = float(np.clip(_OF_LIDS * of_lids, _LEAST_OF_LIDS, _MOST_OF_LIDS))
    odds = np.where(
        is_rough,
        np.log(_OF_GRATINGS / of_lids),
        np.log((1.0 - _OF_GRATINGS) / (1.0 - of_lids)),
    )
    summed = np.bincount(at, odds, minlength=count).astype(np.float64)
    window = round(_WINDOW_M / POSITION_M)
    told = uniform_filter1d(summed, window, mode="constant") * window / _AGREEING
    return np.asarray(1.0 / (1.0 + np.exp(-told)), np.float64)


def _usual_share(
    along: _Floats, is_rough: NDArray[np.bool_], starts: _Floats, ends: _Floats
) -> float:
    """Median over the lids of the share of their points that are rough."""
    if starts.size == 0:
        return 0.0
    of = np.searchsorted(starts, along, side="right") - 1
    is_on = (of >= 0) & (along < np.sort(ends)[-1])
    points = np.bincount(of[is_on], minlength=starts.size)
    rough = np.bincount(of[is_on], is_rough[is_on], minlength=starts.size)
    known = points > 0
    return float(np.median(rough[known] / points[known])) if known.any() else 0.0
