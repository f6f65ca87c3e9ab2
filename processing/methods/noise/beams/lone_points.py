"""Points without company: nothing else was measured where something should have been.

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
from processing.methods.noise.beams.closed_surfaces import (
    BELOW_SURFACE,
    OFF_SURFACE,
    off_surfaces_kernel,
)
from processing.methods.noise.neighbours.sharing import share_out

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_APART_FROM_SURFACE = 2.0
"""Spacings to the nearest other point beyond which a point is alone where the surface around it
goes on without it: what is thin enough for one beam of a row is met by the next row, too, which is
one spacing away if it stands square to the rows and 1.4 if it runs at 45°."""

_ROWS = 5
"""Rows to either side that are searched for it: two spacings, and four where nothing is strict."""

_REACH = 12
"""Spacings and rows to either side within which other points are counted: a few hundred in a crown,
so that their number is sure to a tenth. By trial; with 7 less noise was found for the same loss."""

_NEAREST = 1.5
"""Spacings within which another point is company enough: from row to row along a slanting wire."""

_LONELINESS = 7.0
"""See :func:`lone_points`. Where next to nothing is noise a fifth of a percent of the points may be
lost: streets of which 6 and 8 % are crowns lose .19 % with this value, .21 % with 6.5."""

_SCATTER_POWER = 0.8
"""Of the number of points in reach: leaves stand in clumps, and their number grows with less than
the third power of the distance (2.4). By trial, of 1, 0.8 and 0.6."""

_GAP_POWER = 3 * (1 - _SCATTER_POWER)
"""Of the reach, with which loneliness is in spacings: with that power it is no pure number."""

_MOST_ROWS = 48
"""Rows to either side that are searched at most: of a scanner that nearly stands."""

_MOST_COLUMNS = 256
"""Columns to either side that are searched at most; the point's range is a few steps' then."""

_LEAST_STEP_M = 1e-9
"""From pulse to pulse at a point: keeps one at its scanner from dividing by nothing."""

_POINTS_AT_ONCE = 16_384
"""Points of a share of a core's work."""


class _Limits(NamedTuple):
    """Spacings off a surface, and loneliness, from which a point is alone."""

    apart: float
    loneliness: float


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
    A point is alone where the beams on all sides met one plane and it is off that plane: at once
    if it lies behind a level one, since nothing is below a road that others didn't see, and else
    if no point lies within two spacings (:mod:`.closed_surfaces`).

    Elsewhere, as in a crown or at an edge, chance decides. Of ``n`` points that scatter within
    twelve spacings ``n (d / 12)³`` are expected within a distance ``d``: the more, the less likely
    is it to find none. The loneliness of a point is that number for ``d₁² d₂`` in place of ``d³``,
    its nearest and its second neighbour, with a lesser power of ``n``, times one more for each of
    the four pairs of beams on opposite sides of which one met something nearer and the other
    something farther: so lie ranges between an edge and what is behind it. Nothing at all within
    twelve spacings is alone, too.

    Of a scanner that stood only the plane says anything: far wires and blades of grass are met by
    single beams there.
    """
    found = np.empty(points.size, np.bool_)
    scale = 4.0 ** (0.5 - strictness)
    # Axis by axis: NumPy takes ten times as long over rows of three.
    has_moved = any(np.ptp(axis) > 0 for axis in beams.origins.T)
    limits = _Limits(scale * _APART_FROM_SURFACE, scale**3 * _LONELINESS if has_moved else math.inf)

    def look(start: int, stop: int) -> None:
        part = slice(start, stop)
        off = np.empty(stop - start, np.uint8)
        off_surfaces_kernel(beams, points[part], rows[part], off)
        _lone_kernel(beams, spacings, points[part], rows[part], off, limits, found[part])

    share_out(look, points.size, _POINTS_AT_ONCE, monitor)
    return found


@kernel
def _lone_kernel(
    beams: PointBeams,
    spacings: _Floats,
    points: _Integers,
    rows: _Integers,
    off: NDArray[np.uint8],
    limits: _Limits,
    found: NDArray[np.bool_],
) -> None:
    for i in range(points.size):
        point, row = points[i], rows[i]
        spacing = spacings[point]
        found[i] = off[i] == BELOW_SURFACE
        # Most points have company next to them: that is asked first, since it costs least.
        if found[i] or _is_accompanied(beams, point, row, 1, _NEAREST * spacing):
            continue
        if off[i] == OFF_SURFACE and not _is_accompanied(
            beams, point, row, _ROWS, limits.apart * spacing
        ):
            found[i] = True
        elif math.isfinite(limits.loneliness):
            alone = _loneliness(beams, point, row, spacing)
            found[i] = alone > limits.loneliness


@kernel
def _loneliness(beams: PointBeams, point: int, row: int, spacing: float) -> float:
    """How unlikely the gap around a point is, see :func:`lone_points`; infinite in the open."""
    reach = _REACH * spacing
    nearest, second, count = reach * reach, reach * reach, 0
    column, aside = beams.columns[point], _columns_within(beams, point, reach)
    for step in range(2 * _rows_within(beams, row, reach) + 1):
        # From the point's own row outwards: most have company there, and the rest isn't asked.
        other = row + (step + 1) // 2 * (1 if step % 2 else -1)
        if (
            other < 0
            or other >= beams.segments.size
            or beams.segments[other] != beams.segments[row]
        ):
            continue
        end = beams.row_starts[other + 1]
        at = first_at(beams.columns, beams.row_starts[other], end, column - aside)
        while at < end and beams.columns[at] <= column + aside:
            if at != point and abs(beams.ranges[at] - beams.ranges[point]) <= reach:
                square = _square_away(beams, at, point)
                if square <= reach * reach:
                    count += 1
                    if square < nearest:
                        nearest, second = square, nearest
                    elif square < second:
                        second = square
            at += 1
        if nearest < (_NEAREST * spacing) ** 2:
            return 0.0
    if count == 0:
        return math.inf
    gap = nearest * math.sqrt(second) / reach**3
    return float(
        gap * _REACH**_GAP_POWER * (count + 1) ** _SCATTER_POWER * _pairs(beams, point, row)
    )


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
def _rows_within(beams: PointBeams, row: int, reach: float) -> int:
    """Rows to either side until the scanner has gone so far; those of a standing one are even."""
    beside = row + 1 if row + 1 < beams.segments.size else row - 1
    if beside < 0 or beams.row_starts[row] == beams.row_starts[row + 1]:
        return _REACH
    here, there = beams.row_starts[row], beams.row_starts[beside]
    square = 0.0
    for axis in range(3):
        square += (beams.origins[there, axis] - beams.origins[here, axis]) ** 2
    if square * _MOST_ROWS * _MOST_ROWS <= reach * reach:
        return _REACH if square == 0.0 else _MOST_ROWS
    return max(math.ceil(reach / math.sqrt(square)), _REACH)


@kernel
def _square_away(beams: PointBeams, one: int, other: int) -> float:
    square = 0.0
    for axis in range(3):
        square += (beams.xyz[one, axis] - beams.xyz[other, axis]) ** 2
    return square


@kernel
def _pairs(beams: PointBeams, point: int, row: int) -> int:
    """One more than the pairs of beams on opposite sides, one nearer and one farther: 1 to 5."""
    count = 1
    for pair in range(4):
        rows, columns = min(pair, 1), pair - 2 if pair > 0 else 1
        before = _gap_to(beams, point, row, -rows, -columns)
        behind = _gap_to(beams, point, row, rows, columns)
        count += before * behind < 0
    return count


@kernel
def _gap_to(beams: PointBeams, point: int, row: int, rows: int, columns: int) -> float:
    """How much farther the beam beside went, m; of its returns the one nearest in range."""
    other = row + rows
    if other < 0 or other >= beams.segments.size or beams.segments[other] != beams.segments[row]:
        return 0.0
    end, column = beams.row_starts[other + 1], beams.columns[point] + columns
    at = first_at(beams.columns, beams.row_starts[other], end, column)
    best = 0.0
    while at < end and beams.columns[at] == column:
        gap = beams.ranges[at] - beams.ranges[point]
        if best == 0.0 or abs(gap) < abs(best):
            best = gap
        at += 1
    return best


def warm_up() -> None:
    """Compile the kernels."""
    zeros = np.zeros((4, 3))
    starts, segments = np.arange(5), np.zeros(4, np.int32)
    beams = PointBeams(zeros, zeros, np.ones(4), segments, starts, segments, 0.01)
    some, found = np.arange(2), np.zeros(2, np.bool_)
    off = np.zeros(2, np.uint8)
    _lone_kernel(beams, np.ones(4), some, some, off, _Limits(1.0, 2.0), found)
