"""What the beams beside a beam met: loops over windows of pixels around a point.

Sizes and limits here shape what the trees are told (see :mod:`processing.methods.noise.combined`):
they learned with these values, so that a change asks for new training. They were set by trial, on
simulated scenes; no measurement varied one alone.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.noise.beams.beam_kernels import PointBeams

_Integers = NDArray[np.int64]
_Rows = NDArray[np.float32]

_PER_WINDOW = 7
"""Features of a window; its counts are one more, in this order."""

_USED, _CLOSE, _FAIR, _FAR, _FRONT, _BEHIND, _SURE_FRONT, _ROWS_USED = range(_PER_WINDOW + 1)
"""A point meets itself in the counts from ``_USED`` to ``_FAR``."""

NEAR_FEATURES = 2 * _PER_WINDOW
WIDE_FEATURES = _PER_WINDOW + 1
SUSPICION_FEATURES = 4
_ROWS = np.array([-4, -2, -1, 0, 1, 2, 4])
"""Rows of the near window (up to two to either side) and of the middle one (every second)."""

_NEAR_ROWS, _MIDDLE_ROWS, _MIDDLE_STEP = 2, 4, 2

_NEAR, _MIDDLE = 3, 12
"""Pulses to either side in these windows."""

_WIDE, _WIDE_ROWS, _ROW_STEP, _STRIDE = 64, 10, 5, 2
"""The wide window: pulses and rows to either side, and every which row and pulse is asked."""

_CLOSE_M, _FAIR_M, _FAR_M = 0.025, 0.1, 0.4
"""Differences of range that count as on the same surface, on the same thing, and near it: each four
times the one before, the first some times a scanner's noise."""

_LEAST_RANGE_M = 0.1
"""Keeps a logarithm finite; no scanner measures nearer."""

_A_FEW = 16
"""Columns that are gone through one by one before the search by halves begins, which costs more."""


class _Window(NamedTuple):
    """Pulses and rows to either side of a point, and every which row is asked."""

    aside: int
    reach: int
    step: int


class _Suspicions(NamedTuple):
    """Sums and counts over a window: of all pixels, and of those at about the same range."""

    total: float
    pixels: float
    like: float
    likes: float


@kernel
def near_beams_kernel(
    beams: PointBeams, is_sure: NDArray[np.bool_], points: _Integers, rows: _Integers, found: _Rows
) -> None:
    """What the beams around points met; ``points`` (k,) rise, ``found`` (k, NEAR_FEATURES).

    For a near (2 rows, 3 pulses) and a middle window (4 rows in steps of 2, 12 pulses): share of
    pulses that came back, and of these the shares within three distances, in front and behind, and
    of sure ones in front.
    """
    counts = np.zeros((2, _PER_WINDOW + 1), np.int64)
    positions = np.zeros((_ROWS.size, 4), np.int64)
    for i in range(points.size):
        point, row = points[i], rows[i]
        column = beams.columns[point]
        is_new = i == 0 or rows[i - 1] != row
        counts[:] = 0
        for number in range(_ROWS.size):
            other = row + _ROWS[number]
            if not _is_beside(beams.segments, row, other):
                continue
            if is_new:
                positions[number] = beams.row_starts[other]
            end = beams.row_starts[other + 1]
            at = positions[number]
            if abs(_ROWS[number]) <= _NEAR_ROWS:
                at[0] = _first_from(beams.columns, at[0], end, column - _NEAR)
                at[1] = _first_from(beams.columns, at[1], end, column + _NEAR + 1)
                _count(beams, is_sure, beams.ranges[point], at[0], at[1], 1, counts[0])
            if abs(_ROWS[number]) != 1:
                at[2] = _first_from(beams.columns, at[2], end, column - _MIDDLE)
                at[3] = _first_from(beams.columns, at[3], end, column + _MIDDLE + 1)
                _count(beams, is_sure, beams.ranges[point], at[2], at[3], 1, counts[1])
        counts[:, _USED : _FAR + 1] -= 1  # the point itself
        _shares(counts[0], _NEAR, 1, found[i, 0:_PER_WINDOW])
        _shares(counts[1], _MIDDLE, 1, found[i, _PER_WINDOW:NEAR_FEATURES])


@kernel
def wide_beams_kernel(
    beams: PointBeams, is_sure: NDArray[np.bool_], points: _Integers, rows: _Integers, found: _Rows
) -> None:
    """The same for a wide window (10 rows in steps of 5, every second of 64 pulses), and the range.

    ``found`` (k, WIDE_FEATURES); the range as its log2.
    """
    counts = np.zeros(_PER_WINDOW + 1, np.int64)
    for i in range(points.size):
        point, row = points[i], rows[i]
        column = beams.columns[point]
        counts[:] = 0
        for other in range(row - _WIDE_ROWS, row + _WIDE_ROWS + 1, _ROW_STEP):
            if not _is_beside(beams.segments, row, other):
                continue
            end = beams.row_starts[other + 1]
            first = _first_from(beams.columns, beams.row_starts[other], end, column - _WIDE)
            stop = _first_from(beams.columns, first, end, column + _WIDE + 1)
            _count(beams, is_sure, beams.ranges[point], first, stop, _STRIDE, counts)
            if other == row and (point - first) % _STRIDE == 0:
                counts[_USED : _FAR + 1] -= 1
        _shares(counts, _WIDE, _STRIDE, found[i, 0:_PER_WINDOW])
        found[i, _PER_WINDOW] = math.log2(max(beams.ranges[point], _LEAST_RANGE_M))


@kernel
def suspicion_kernel(
    beams: PointBeams,
    suspicions: NDArray[np.float32],
    points: _Integers,
    rows: _Integers,
    found: _Rows,
) -> None:
    """How suspicious the pixels around points are; ``found`` (k, SUSPICION_FEATURES).

    The mean of ``suspicions`` (n,) in the middle and in the wide window: of all pixels, and of
    those at about the same range.
    """
    for i in range(points.size):
        for window in range(2):
            if window == 0:
                around = _Window(_MIDDLE, _MIDDLE_ROWS, _MIDDLE_STEP)
            else:
                around = _Window(_WIDE, _WIDE_ROWS, _ROW_STEP)
            sums = _suspicion(beams, suspicions, points[i], rows[i], around)
            found[i, 2 * window] = sums.total / max(sums.pixels, 1.0)
            found[i, 2 * window + 1] = sums.like / max(sums.likes, 1.0)


@kernel
def _suspicion(
    beams: PointBeams,
    suspicions: NDArray[np.float32],
    point: int,
    row: int,
    window: _Window,
) -> _Suspicions:
    aside, reach = window.aside, window.reach
    stride = _STRIDE if aside == _WIDE else 1
    column, total, count, like, likes = beams.columns[point], 0.0, 0.0, 0.0, 0.0
    for other in range(row - reach, row + reach + 1, window.step):
        if not _is_beside(beams.segments, row, other):
            continue
        end = beams.row_starts[other + 1]
        first = _first_from(beams.columns, beams.row_starts[other], end, column - aside)
        for position in range(first, end, stride):
            if beams.columns[position] > column + aside:
                break
            if position == point:
                continue
            total += suspicions[position]
            count += 1
            if abs(beams.ranges[position] - beams.ranges[point]) < _FAIR_M:
                like += suspicions[position]
                likes += 1
    return _Suspicions(total, count, like, likes)


@kernel
def _count(
    beams: PointBeams,
    is_sure: NDArray[np.bool_],
    reach: float,
    first: int,
    stop: int,
    stride: int,
    counts: _Integers,
) -> None:
    """Add the pixels ``first … stop − 1`` of a row to the counts of a window."""
    near, fair, wide, front, behind, sure = 0, 0, 0, 0, 0, 0
    for position in range(first, stop, stride):
        gap = beams.ranges[position] - reach
        near += abs(gap) < _CLOSE_M
        fair += abs(gap) < _FAIR_M
        wide += abs(gap) < _FAR_M
        front += gap < -_FAIR_M
        behind += gap > _FAIR_M
        sure += is_sure[position] and gap < -_FAIR_M
    counts[_USED] += (stop - first + stride - 1) // stride
    counts[_CLOSE] += near
    counts[_FAIR] += fair
    counts[_FAR] += wide
    counts[_FRONT] += front
    counts[_BEHIND] += behind
    counts[_SURE_FRONT] += sure
    counts[_ROWS_USED] += 1


@kernel
def _shares(counts: _Integers, aside: int, stride: int, found: _Rows) -> None:
    used, rows = counts[_USED], counts[_ROWS_USED]
    found[0] = stride * used / (rows * (2 * aside + 1) - 1) if rows else 0.0
    for number in range(1, _PER_WINDOW):
        found[number] = counts[number] / max(used, 1)


@kernel
def _is_beside(segments: NDArray[np.int32], row: int, other: int) -> bool:
    """Whether there is such a row in the same stretch of rows."""
    return 0 <= other < segments.size and segments[other] == segments[row]


@kernel
def _first_from(columns: NDArray[np.int32], position: int, end: int, wanted: int) -> int:
    """The first point of a row, from one on, whose column isn't below the wanted."""
    if position + _A_FEW < end and columns[position + _A_FEW] < wanted:
        return position + int(np.searchsorted(columns[position:end], wanted))
    while position < end and columns[position] < wanted:
        position += 1
    return position


def warm_up() -> None:
    """Compile the kernels."""
    zeros = np.zeros((4, 3))
    starts, segments = np.arange(5), np.zeros(4, np.int32)
    beams = PointBeams(zeros, zeros, np.ones(4), segments, starts, segments, 0.01)
    four = np.arange(4)
    near_beams_kernel(beams, segments > 0, four, four, np.empty((4, NEAR_FEATURES), np.float32))
    wide_beams_kernel(beams, segments > 0, four, four, np.empty((4, WIDE_FEATURES), np.float32))
    found = np.empty((4, SUSPICION_FEATURES), np.float32)
    suspicion_kernel(beams, found[:, 0].copy(), four, four, found)
