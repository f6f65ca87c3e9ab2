"""Lids and gratings as rectangles in space: on their measured tops, at their true size."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.methods.road.curbs.edges.curb_points import PointsAbout
from processing.methods.road.gutters.gutter_axis import STEP_M
from processing.methods.road.gutters.gutter_joints import GRATING
from processing.methods.road.gutters.gutter_runs import GutterRun

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

POINTS_WITHIN_M = 0.6
"""How far from a gutter's middle points say something about its lids: half of the widest, 33 cm
(Takahashi 2022, Table 7-2), and as much beside it."""

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_RIM_M = 0.03
"""Left out of the plane: rims, joints. By trial."""

_ON_M, _FIRST_ON_M = 0.012, 0.04
"""A point so near to the plane is of the top: four times what scanners scatter; at first, when only
a median is known, so near to it. What lies twice as far below is below. By trial."""

_ROUNDS = 3
"""Of plane and points in turn; the limit is halved each time."""

_LEAST_POINTS = 6
"""With fewer points a top has no height of its own: twice a plane's unknowns."""

_STEEPEST = 0.05
"""Slope of a lid against its neighbours, m per m: what lies steeper would rock under traffic. By
trial."""

_CORNER_M = 0.10
"""A point so near to a corner shows it; as in `gratings`."""

_HEIGHT_WEIGHT, _SLOPE_WEIGHT_M2 = 1e-3, 0.02
"""Of the belief that a lid lies as the gutter does, in points: hardly any for the height; for the
slopes one point 14 cm off the middle. By trial."""

_LEAST_M = 1e-9
"""Guard of a division."""


@dataclass(frozen=True)
class GutterCover:
    """One lid or grating.

    Attributes
    ----------
    corners : (4, 3) float64
        On its top, m, project CRS, counterclockwise from above; the first side runs along the
        gutter.
    is_grating, is_bridged : bool
    width_m, length_m : float
    on_top, below : int
        Points on its top and farther below.
    along_m : float
        Its middle on the gutter's axis.
    seen : (int, int)
        Notches at its joints.
    rough_m : float
        Scatter of the points on it about its plane, root mean square.
    points, drives : tuple of int
        The measured point nearest to each corner, −1 where none is near, and the drive that it is
        of.
    """

    corners: _Floats
    is_grating: bool
    is_bridged: bool
    width_m: float
    length_m: float
    on_top: int
    below: int
    along_m: float
    seen: tuple[int, int]
    rough_m: float
    points: tuple[int, ...] = (-1,) * 4
    drives: tuple[int, ...] = (0,) * 4


def covers_of(run: GutterRun, number: int, about: Sequence[PointsAbout]) -> tuple[GutterCover, ...]:
    """The covers of one gutter.

    Parameters
    ----------
    run : GutterRun
    number : int
        Of the run among the lines of ``about``.
    about : sequence of PointsAbout
        Of each drive.
    """
    row, edges = run.row, run.edges
    if row.starts_m.size == 0:
        return ()
    parts = [slice(one.starts[number], one.starts[number + 1]) for one in about]
    along = np.concatenate([one.along[part] for one, part in zip(about, parts, strict=True)])
    across, above = (
        np.concatenate([getattr(one, name)[part] for one, part in zip(about, parts, strict=True)])
        for name in ("across", "above")
    )
    along = along * STEP_M
    which = np.searchsorted(row.starts_m, along) - 1
    is_in = (which >= 0) & (across > edges[0] + _RIM_M) & (across < edges[1] - _RIM_M)
    is_in &= along < row.ends_m[np.maximum(which, 0)]
    which, positions = which[is_in], np.column_stack([along, across, above])
    middles, wide = (row.starts_m + row.ends_m) / 2, (edges[0] + edges[1]) / 2
    local = positions[is_in] - np.column_stack(
        [middles[which], *np.tile([[wide], [0.0]], which.size)]
    )
    planes = _Planes.fitted(which, local, row.starts_m.size)
    is_grating = row.what == GRATING
    nearest = _nearest_to(_corners_about(run, planes), positions)
    point = np.concatenate([one.point[part] for one, part in zip(about, parts, strict=True)])
    drive = np.repeat(np.arange(len(about)), [part.stop - part.start for part in parts])
    measured = np.append(point, -1)[nearest], np.append(drive, 0)[nearest]
    return tuple(
        replace(
            _cover(run, k, planes, is_grating=bool(is_grating[k])),
            points=tuple(measured[0][k].tolist()),
            drives=tuple(measured[1][k].tolist()),
        )
        for k in range(row.starts_m.size)
    )


def _corners_about(run: GutterRun, planes: _Planes) -> _Floats:
    """(k, 4, 3) corners of the covers along, across and above the axis."""
    row, (left, right) = run.row, run.edges
    half = (row.ends_m - row.starts_m)[:, None] / 2
    x, y = half * np.array([-1, 1, 1, -1]), (right - left) / 2 * np.array([1, 1, -1, -1])
    above = planes.planes[:, :1] + planes.planes[:, 1:2] * x + planes.planes[:, 2:] * y
    along = (row.starts_m + row.ends_m)[:, None] / 2 + x
    return np.stack([along, np.broadcast_to((left + right) / 2 + y, x.shape), above], axis=2)


def _nearest_to(corners: _Floats, positions: _Floats) -> _Integers:
    """(k, 4) the nearest of some places to each corner; −1 where none is near."""
    ends = np.unique(corners[:, :, 0])
    after = np.clip(np.searchsorted(ends, positions[:, 0]), 1, ends.size - 1)
    off = np.minimum(positions[:, 0] - ends[after - 1], ends[after] - positions[:, 0])
    sides = corners[0, [0, 2], 1]
    aside = np.abs(positions[:, 1, None] - sides).min(axis=1)
    near = np.flatnonzero((np.abs(off) < _CORNER_M) & (aside < _CORNER_M))
    found = np.full(corners.shape[:2], -1, np.int64)
    if near.size:
        away, which = cKDTree(positions[near]).query(corners, distance_upper_bound=_CORNER_M)
        is_met = np.isfinite(away)
        found[is_met] = near[np.asarray(which, np.int64)[is_met]]
    return found


@dataclass(frozen=True)
class _Planes:
    """Tops of covers about the axis: height in the middle, rise along and across; facts."""

    planes: _Floats
    on_top: _Integers
    below: _Integers
    rough_m: _Floats

    @staticmethod
    def fitted(which: _Integers, points: _Floats, count: int) -> _Planes:
        height = _middle_heights(which, points[:, 2], count)
        planes: _Floats = np.column_stack([height, np.zeros((count, 2))])
        design = np.column_stack([np.ones(len(points)), points[:, :2]])
        off: _Floats = points[:, 2] - height[which]
        limit = _FIRST_ON_M
        for _ in range(_ROUNDS):
            is_on = np.abs(off) < limit
            planes = _least_squares(which[is_on], design[is_on], points[is_on, 2], height)
            off = points[:, 2] - (planes[which] * design).sum(axis=1)
            limit = max(_ON_M, limit / 2)
        is_on = np.abs(off) < _ON_M
        on_top = np.bincount(which[is_on], minlength=count)
        squares = np.bincount(which[is_on], off[is_on] ** 2, minlength=count)
        below = np.bincount(which[off < -2 * _ON_M], minlength=count)
        return _Planes(planes, on_top, below, np.sqrt(squares / np.maximum(on_top, 1)))


def _middle_heights(which: _Integers, above: _Floats, count: int) -> _Floats:
    """(count,) median of the points that are not far below; of the neighbours where none are."""
    order = np.lexsort((above, which))
    starts = np.searchsorted(which[order], np.arange(count + 1))
    heights = np.full(count, np.nan)
    some = np.flatnonzero(np.diff(starts) >= _LEAST_POINTS)
    heights[some] = above[order][(starts[some] + starts[some + 1]) // 2]
    known = np.isfinite(heights)
    if not known.any():
        return np.zeros(count)
    filled: _Floats = np.interp(np.arange(count), np.flatnonzero(known), heights[known])
    return filled


def _least_squares(which: _Integers, design: _Floats, heights: _Floats, usual: _Floats) -> _Floats:
    """(count, 3) planes; those with few points lie as the gutter does."""
    count = usual.size
    normal = np.zeros((count, 3, 3))
    right = np.zeros((count, 3))
    for i in range(3):
        right[:, i] = np.bincount(which, design[:, i] * heights, minlength=count)
        for j in range(3):
            normal[:, i, j] = np.bincount(which, design[:, i] * design[:, j], minlength=count)
    normal += np.diag([_HEIGHT_WEIGHT, _SLOPE_WEIGHT_M2, _SLOPE_WEIGHT_M2])
    right[:, 0] += _HEIGHT_WEIGHT * usual
    planes = np.asarray(np.linalg.solve(normal, right[:, :, None])[:, :, 0], np.float64)
    planes[:, 1:] = np.clip(planes[:, 1:], -_STEEPEST, _STEEPEST)
    return planes


def _cover(run: GutterRun, k: int, planes: _Planes, *, is_grating: bool) -> GutterCover:
    row, edges = run.row, run.edges
    start, end = float(row.starts_m[k]), float(row.ends_m[k])
    middle = (edges[0] + edges[1]) / 2
    ends = run.axis.positions(np.array([start, end]), np.array([middle, middle]))
    ahead = ends[1, :2] - ends[0, :2]
    ahead /= max(float(np.hypot(*ahead)), _LEAST_M)
    left = np.array([-ahead[1], ahead[0]])
    centre = (ends[0] + ends[1]) / 2
    long, wide = end - start, edges[1] - edges[0]
    height, rise, tilt = planes.planes[k]
    rise += (ends[1, 2] - ends[0, 2]) / max(long, _LEAST_M)
    corners = np.empty((4, 3))
    for number, (x, y) in enumerate(((-1, -1), (1, -1), (1, 1), (-1, 1))):
        along, aside = x * long / 2, y * wide / 2
        corners[number, :2] = centre[:2] + along * ahead + aside * left
        corners[number, 2] = centre[2] + height + along * rise - aside * tilt
    seen = (int(row.seen[k, 0]), int(row.seen[k, 1]))
    return GutterCover(
        corners,
        is_grating,
        bool(row.is_bridged[k]),
        wide,
        long,
        int(planes.on_top[k]),
        int(planes.below[k]),
        (start + end) / 2,
        seen,
        float(planes.rough_m[k]),
    )
