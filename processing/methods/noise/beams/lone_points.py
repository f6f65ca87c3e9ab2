"""Points without company: nothing else was measured within some spacings of them.

Whatever a scanner sees is met by more than one of its beams: beams beside each other are a spacing
apart, and a wire or a rod goes on from row to row. A drop, an insect, an echo of an echo and a
range between an edge and what is behind it stand alone, and so they do where next to nothing of a
recording is noise. Nothing here was learned.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.image.rows.point_image_kernels import first_at
from processing.methods.noise.beams.beam_kernels import PointBeams
from processing.methods.noise.neighbours.sharing import share_out

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_APART_FROM_SURFACE = 2.0
"""Spacings to the nearest other point beyond which a point is alone where the surface around it
goes on without it: what is thin enough for one beam of a row is met by the next row, too, which is
one spacing away if it stands square to the rows and 1.4 if it runs at 45°."""

_APART = 3.5
"""The same where the beams around met several things: in a crown, at an edge. A surface that falls
off steeply, and twigs, leave gaps of two and three spacings."""

_APART_IN_THE_OPEN = 5.0
"""The same where most of the beams around met nothing: a wire thinner than the spacing is met by
some of the beams only, and far from the scanner its points are that far apart."""

_NEVER = 1e6
"""From a tripod far wires and blades of grass are met by single beams: only what stands before or
behind a surface that goes on is alone. On the sample of a standing scanner the other two would take
9 % of the wires and 17 % of the grass."""

_ROWS = 5
"""Rows to either side that are searched: as far as ``_APART_IN_THE_OPEN``."""

_SCATTER_M = 0.02
"""What ranges of one surface differ by themselves: a scanner's noise and the surface's roughness,
as in :mod:`.beam_kernels`."""

_COLUMNS_ACROSS_GAPS = 3
"""Columns within which the next pulse that came back counts as the one beside."""

_FEWEST_BESIDE = 3
"""Of four beams beside, that show whether a surface goes on: all, but for a lost pulse."""

_MOST_COLUMNS = 256
"""Columns to either side that are searched at most; the point's range is a few steps' then."""

_LEAST_STEP_M = 1e-9
"""From pulse to pulse at a point: keeps one at its scanner from dividing by nothing."""

_POINTS_AT_ONCE = 16_384
"""Points of a share of a core's work."""


class _Limits(NamedTuple):
    """In spacings: before a surface that goes on, among several things, in the open."""

    near: float
    far: float
    farthest: float


def lone_points(
    beams: PointBeams,
    spacings: _Floats,
    points: _Integers,
    rows: _Integers,
    strictness: float,
    *,
    monitor: Monitor,
) -> NDArray[np.bool_]:
    """Which of some points stand alone: (k,) bool.

    Parameters
    ----------
    spacings : (n,) float64
        m, from each beam to those of the next row and pulse at the point's range.
    points, rows : (k,) int64
        Indices of the points that are asked, and their rows.
    strictness : float
        0 to 1: at 1 half of the distance is enough, at 0 twice as much is asked.

    Notes
    -----
    A point stands alone if no other lies within three and a half spacings of it, in five rows to
    either side, returns of its own pulse among them. Two spacings are enough where the beams on all
    sides of it met one surface: where their ranges differ less among themselves than from the
    point's own. Where most beams around met nothing, five are asked. Of a scanner that stood,
    only the second of these says anything.
    """
    found = np.empty(points.size, np.bool_)
    scale = 4.0 ** (0.5 - strictness)
    elsewhere = (_APART, _APART_IN_THE_OPEN)
    if not np.ptp(beams.origins, axis=0).any():
        elsewhere = (_NEVER, _NEVER)
    limits = _Limits(*(scale * one for one in (_APART_FROM_SURFACE, *elsewhere)))

    def look(start: int, stop: int) -> None:
        part = slice(start, stop)
        _lone_kernel(beams, spacings, points[part], rows[part], limits, found[part])

    share_out(look, points.size, _POINTS_AT_ONCE, monitor)
    return found


@kernel
def _lone_kernel(
    beams: PointBeams,
    spacings: _Floats,
    points: _Integers,
    rows: _Integers,
    limits: _Limits,
    found: NDArray[np.bool_],
) -> None:
    for i in range(points.size):
        point, row = points[i], rows[i]
        spacing = spacings[point]
        found[i] = False
        # Most points have company next to them: that is asked first, since it costs least.
        if _is_accompanied(beams, point, row, 1, limits.near * spacing):
            continue
        if _is_accompanied(beams, point, row, _ROWS, limits.near * spacing):
            continue
        apart = _off_surface(beams, point, row)
        limit = limits.farthest if math.isnan(apart) else limits.far
        found[i] = apart > 1.0 or not _is_accompanied(beams, point, row, _ROWS, limit * spacing)


@kernel
def _is_accompanied(beams: PointBeams, point: int, row: int, reach: int, limit: float) -> bool:
    """Whether another point lies within a distance, in so many rows to either side."""
    column, square = beams.columns[point], limit * limit
    aside = _columns_within(beams, point, limit)
    for other in range(max(row - reach, 0), min(row + reach + 1, beams.segments.size)):
        if beams.segments[other] != beams.segments[row]:
            continue
        end = beams.row_starts[other + 1]
        at = first_at(beams.columns, beams.row_starts[other], end, column - aside)
        while at < end and beams.columns[at] <= column + aside:
            is_near = at != point and abs(beams.ranges[at] - beams.ranges[point]) <= limit
            if is_near and _square_away(beams, at, point) <= square:
                return True
            at += 1
    return False


@kernel
def _columns_within(beams: PointBeams, point: int, limit: float) -> int:
    step = max(beams.ranges[point] * beams.step_rad, _LEAST_STEP_M)
    aside: int = min(math.ceil(limit / step), _MOST_COLUMNS)
    return aside


@kernel
def _square_away(beams: PointBeams, one: int, other: int) -> float:
    square = 0.0
    for axis in range(3):
        square += (beams.xyz[one, axis] - beams.xyz[other, axis]) ** 2
    return square


@kernel
def _off_surface(beams: PointBeams, point: int, row: int) -> float:
    """How much farther a point is from the beams on all sides than they are from each other.

    Above 1 they met one surface, and the point is not of it; NaN where too few came back.
    """
    lowest, highest, nearest, count = np.inf, -np.inf, np.inf, 0
    for side in range(4):
        if side < 2:
            reach = _beside_in_row(beams, point, row, 2 * side - 1)
        else:
            reach = _beside_in_next(beams, point, row, 2 * side - 5)
        if math.isnan(reach):
            continue
        count += 1
        lowest, highest = min(lowest, reach), max(highest, reach)
        nearest = min(nearest, abs(reach - beams.ranges[point]))
    if count < _FEWEST_BESIDE:
        return math.nan
    return nearest / (highest - lowest + _SCATTER_M)


@kernel
def _beside_in_row(beams: PointBeams, point: int, row: int, way: int) -> float:
    """The range of the next pulse that came back; of its returns the one nearest in range."""
    first, end = beams.row_starts[row], beams.row_starts[row + 1]
    at = point + way
    while first <= at < end and beams.columns[at] == beams.columns[point]:
        at += way
    if at < first or at >= end:
        return math.nan
    column = beams.columns[at]
    if abs(column - beams.columns[point]) > _COLUMNS_ACROSS_GAPS:
        return math.nan
    best: float = beams.ranges[at]
    while first <= at < end and beams.columns[at] == column:
        if abs(beams.ranges[at] - beams.ranges[point]) < abs(best - beams.ranges[point]):
            best = beams.ranges[at]
        at += way
    return best


@kernel
def _beside_in_next(beams: PointBeams, point: int, row: int, way: int) -> float:
    """The range of the row beside in the same direction, a column to either side allowed."""
    other = row + way
    if other < 0 or other >= beams.segments.size or beams.segments[other] != beams.segments[row]:
        return math.nan
    end, column = beams.row_starts[other + 1], beams.columns[point]
    at = first_at(beams.columns, beams.row_starts[other], end, column - 1)
    best = math.nan
    while at < end and beams.columns[at] <= column + 1:
        reach: float = beams.ranges[at]
        if math.isnan(best) or abs(reach - beams.ranges[point]) < abs(best - beams.ranges[point]):
            best = reach
        at += 1
    return best


def warm_up() -> None:
    """Compile the kernels."""
    zeros = np.zeros((4, 3))
    starts, segments = np.arange(5), np.zeros(4, np.int32)
    beams = PointBeams(zeros, zeros, np.ones(4), segments, starts, segments, 0.01)
    some, found = np.arange(2), np.zeros(2, np.bool_)
    _lone_kernel(beams, np.ones(4), some, some, _Limits(1.0, 2.0, 3.0), found)
