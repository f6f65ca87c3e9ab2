"""Beams in rows, and where surfaces go on from pulse to pulse and from row to row.

Every point has a row, a column and a range from where its beam began. Noise seldom goes on.

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

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

SURE, SQUARE = 1, 2
"""What a surface that goes on is called: see :func:`surface_kernel`."""

_COLUMNS_BESIDE = 8
"""Columns within which the next row's point tells the distance between rows."""

_NEAREST_M = 1e-6
"""Keeps a range of nothing from dividing."""

_SPACINGS_BETWEEN_ROWS, _STEPS_BETWEEN_ROWS, _SCATTER_M = 2.5, 4, 0.01
"""How far the point of the row beside may lie on a surface that goes on: so many spacings of rows
and steps from pulse to pulse, for surfaces that stand aslant, and a scanner's noise."""

_COLUMNS_BESIDE_IN_ROW = 3
"""Columns within which the row beside must have a point."""

_COLUMNS_OF_FIVE = 6
"""Columns that a point and two on either side may span: five, and lost pulses for two."""

_OFF_LINE_M, _OFF_LINE_SHARE = 0.02, 0.15
"""How far a pulse beside may lie off the line, along its beam: a scanner's noise, and a share of
the range's change from pulse to pulse."""

_STEEPEST_STEPS = 8
"""Change of range from pulse to pulse, in steps across the beam, from which nothing is sure: 83°
from square."""

_SQUARE_STEPS = 0.1
"""Change of range below which a surface stands square to the beam: 6°."""


class PointBeams(NamedTuple):
    """Points with their beams, in rows.

    ``xyz`` and ``origins`` (n, 3) local m, ``ranges`` (n,) m, ``columns`` (n,), ``row_starts``
    (rows + 1,), ``segments`` (rows,), ``step_rad``: from pulse to pulse.
    """

    xyz: _Floats
    origins: _Floats
    ranges: _Floats
    columns: NDArray[np.int32]
    row_starts: _Integers
    segments: NDArray[np.int32]
    step_rad: float


@kernel
def spacing_kernel(beams: PointBeams, first: int, stop: int, spacings: _Floats) -> None:
    """Distance from each point's beam to the nearest of the next row, at the point's range."""
    for row in range(first, stop):
        other = _row_beside(beams.segments, row, 1)
        if other < 0 or beams.row_starts[other] == beams.row_starts[other + 1]:
            other = _row_beside(beams.segments, row, -1)
        position = beams.row_starts[other] if other >= 0 else 0
        for point in range(beams.row_starts[row], beams.row_starts[row + 1]):
            reach = beams.ranges[point]
            best = reach * beams.step_rad
            if other >= 0:
                end = beams.row_starts[other + 1]
                column = beams.columns[point]
                while position + 1 < end and beams.columns[position + 1] <= column:
                    position += 1
                if position < end and abs(beams.columns[position] - column) <= _COLUMNS_BESIDE:
                    share = reach / max(beams.ranges[position], _NEAREST_M)
                    shift = (column - beams.columns[position]) * reach * beams.step_rad
                    square = 0.0
                    for axis in range(3):
                        there = beams.origins[position, axis]
                        there += share * (beams.xyz[position, axis] - there)
                        square += (there - beams.xyz[point, axis]) ** 2
                    best = max(best, math.sqrt(max(square - shift * shift, 0.0)))
                else:
                    best = 0.0
            spacings[point] = best


@kernel
def surface_kernel(
    beams: PointBeams, spacings: _Floats, first: int, stop: int, found: NDArray[np.uint8]
) -> None:
    """Mark the points from which a surface goes on to both sides and to the rows beside.

    ``found`` (n,) uint8: `SURE`, `SQUARE` where the surface stands square to the beam, as arcs of
    constant range do too, or 0.
    """
    for row in range(first, stop):
        start, end = beams.row_starts[row], beams.row_starts[row + 1]
        above, below = _row_beside(beams.segments, row, -1), _row_beside(beams.segments, row, 1)
        i = beams.row_starts[above] if above >= 0 else 0
        j = beams.row_starts[below] if below >= 0 else 0
        for point in range(start, end):
            found[point] = 0
            if above < 0 or below < 0 or point - 2 < start or point + 2 >= end:
                continue
            kind = _goes_on_along(beams, point)
            if kind == 0:
                continue
            i = _advance(beams, i, above, beams.columns[point])
            j = _advance(beams, j, below, beams.columns[point])
            limit = (
                _SPACINGS_BETWEEN_ROWS * spacings[point]
                + _STEPS_BETWEEN_ROWS * beams.ranges[point] * beams.step_rad
                + _SCATTER_M
            )
            if _is_near(beams, point, i, limit) and _is_near(beams, point, j, limit):
                found[point] = kind


@kernel
def _goes_on_along(beams: PointBeams, point: int) -> int:
    """Whether the two pulses on either side met the same line: 0, `SURE` or `SQUARE`."""
    step = beams.ranges[point] * beams.step_rad
    left, right = point - 1, point + 1
    if beams.columns[point + 2] - beams.columns[point - 2] > _COLUMNS_OF_FIVE:
        return 0
    here = 1 / beams.ranges[point]
    slope = (1 / beams.ranges[right] - 1 / beams.ranges[left]) / max(
        1, beams.columns[right] - beams.columns[left]
    )
    tolerance = (
        (_OFF_LINE_M + _OFF_LINE_SHARE * abs(slope) / here * beams.ranges[point]) * here * here
    )
    for other in range(point - 2, point + 3):
        steps = beams.columns[other] - beams.columns[point]
        if abs(1 / beams.ranges[other] - here - slope * steps) > tolerance * max(1, abs(steps)):
            return 0
    far = beams.ranges[point] * abs(slope) / here
    if far >= _STEEPEST_STEPS * step:
        return 0
    return SURE if far > _SQUARE_STEPS * step else SQUARE


@kernel
def _advance(beams: PointBeams, position: int, row: int, column: int) -> int:
    """The point of a row whose column is nearest, from one at or before it on."""
    end = beams.row_starts[row + 1]
    while position + 1 < end and abs(beams.columns[position + 1] - column) <= abs(
        beams.columns[position] - column
    ):
        position += 1
    return position


@kernel
def _is_near(beams: PointBeams, point: int, other: int, limit: float) -> bool:
    if other >= beams.xyz.shape[0] or abs(beams.columns[other] - beams.columns[point]) > (
        _COLUMNS_BESIDE_IN_ROW
    ):
        return False
    square = 0.0
    for axis in range(3):
        square += (beams.xyz[other, axis] - beams.xyz[point, axis]) ** 2
    return square <= limit * limit


@kernel
def _row_beside(segments: NDArray[np.int32], row: int, side: int) -> int:
    other = row + side
    if other < 0 or other >= segments.size or segments[other] != segments[row]:
        return -1
    return other


def warm_up() -> None:
    """Compile the kernels."""
    zeros = np.zeros((4, 3))
    starts, segments = np.arange(5), np.zeros(4, np.int32)
    beams = PointBeams(zeros, zeros, np.ones(4), segments, starts, segments, 0.01)
    spacing_kernel(beams, 0, 4, np.empty(4))
    surface_kernel(beams, np.ones(4), 0, 4, np.empty(4, np.uint8))
