"""Points that stand off a closed surface: the beams on all sides met one plane, this one did not.

Nothing is below a road; what is before a surface and met by one beam only is thinner than what two
beams would meet. Behind an upright surface there may be a room, seen through a window.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.image.rows.point_image_kernels import first_at
from processing.methods.noise.beams.beam_kernels import PointBeams

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

ON_SURFACE, OFF_SURFACE, BELOW_SURFACE = 0, 1, 2
"""What is said of a point: off a surface is before it, below it is behind a level one."""

_ROWS, _COLUMNS = 1, 3
"""Rows and columns to either side whose points span the plane: 20 where all came back."""

_MOST, _FEWEST = 40, 14
"""Points of these that are taken (several returns of a pulse are several points), and that show a
closed surface: two thirds."""

_DEVIATIONS = 6.0
"""How much farther from the plane a point lies than the others scatter about it, along the beam: by
chance one in a thousand lies beyond 4 (Student's t of 17), beyond 6 one in a hundred thousand."""

_FARTHEST_SHARE = 2.0
"""By how many times as much as the farthest of the others: a step or a bend is no plane."""

_LEAST_M = 0.05
"""How far off a surface a point lies at least, along its beam: joints of slabs and paving stones
are so deep, and their points are wanted."""

_LEVEL = 0.7
"""Of a plane's normal upwards from which it is level: 45°."""

_LEAST = 1e-12
"""Keeps a plane from lying along a beam, and one row from being a plane."""


@kernel
def off_surface(beams: PointBeams, point: int, row: int, fitted: _Floats) -> int:
    """Where a point is to the plane that the beams around it met.

    ``fitted`` (_MOST, 6) is overwritten: steps of columns and of rows, inverse ranges, in which a
    plane is linear, and positions.
    """
    if row < _ROWS or row + _ROWS >= beams.segments.size or not _stands_out(beams, point, row):
        return ON_SURFACE
    column, count = beams.columns[point], 0
    positions = fitted[:, 3:]
    for other in range(row - _ROWS, row + _ROWS + 1):
        if beams.segments[other] != beams.segments[row]:
            return ON_SURFACE
        end = beams.row_starts[other + 1]
        at = first_at(beams.columns, beams.row_starts[other], end, column - _COLUMNS)
        while at < end and beams.columns[at] <= column + _COLUMNS and count < _MOST:
            step, side = beams.columns[at] - column, other - row
            if step != 0 or side != 0:
                fitted[count, 0], fitted[count, 1] = step, side
                fitted[count, 2] = 1.0 / beams.ranges[at]
                for axis in range(3):
                    positions[count, axis] = beams.xyz[at, axis]
                count += 1
            at += 1
    if count < _FEWEST:
        return ON_SURFACE
    off = _off_plane(beams.ranges[point], fitted[:count])
    if off == 0.0:
        return ON_SURFACE
    if off < 0:
        return OFF_SURFACE
    return BELOW_SURFACE if _is_level(fitted[:count]) else ON_SURFACE


@kernel
def _stands_out(beams: PointBeams, point: int, row: int) -> bool:
    """Whether a point is off both points beside it in its row by more than the least."""
    left, right = point - 1, point + 1
    if left < beams.row_starts[row] or right >= beams.row_starts[row + 1]:
        return False
    between = 2.0 / (1.0 / beams.ranges[left] + 1.0 / beams.ranges[right])
    return bool(abs(beams.ranges[point] - between) > 0.5 * _LEAST_M)


@kernel
def _off_plane(reach: float, fitted: _Floats) -> float:
    """How far behind the plane a point lies along its beam, m; 0 where that may be chance."""
    plane = _plane(fitted)
    if not plane[0] > _LEAST:
        return 0.0
    off, squares, farthest = reach - 1.0 / plane[0], 0.0, 0.0
    for other in range(fitted.shape[0]):
        there = plane[0] + plane[1] * fitted[other, 0] + plane[2] * fitted[other, 1]
        miss = abs(1.0 / max(there, _LEAST) - 1.0 / fitted[other, 2])
        squares += miss * miss
        farthest = max(farthest, miss)
    scatter = math.sqrt(squares / (fitted.shape[0] - 3))
    usual = max(_DEVIATIONS * scatter, _FARTHEST_SHARE * farthest, _LEAST_M)
    return off if abs(off) > usual else 0.0


@kernel
def _is_level(fitted: _Floats) -> bool:
    """Whether the positions lie in a plane that is rather level than upright."""
    count = fitted.shape[0]
    middle, along, across = np.zeros(5), np.zeros(3), np.zeros(3)
    for other in range(count):
        for axis in range(3):
            middle[axis] += fitted[other, 3 + axis] / count
        middle[3] += fitted[other, 0] / count
        middle[4] += fitted[other, 1] / count
    for other in range(count):
        for axis in range(3):
            away = fitted[other, 3 + axis] - middle[axis]
            along[axis] += (fitted[other, 0] - middle[3]) * away
            across[axis] += (fitted[other, 1] - middle[4]) * away
    x = along[1] * across[2] - along[2] * across[1]
    y = along[2] * across[0] - along[0] * across[2]
    z = along[0] * across[1] - along[1] * across[0]
    return bool(abs(z) > _LEVEL * math.sqrt(x * x + y * y + z * z))


@kernel
def _plane(fitted: _Floats) -> tuple[float, float, float]:
    """Inverse range at the point, and its change by column and by row, by least squares."""
    n, x, y, v = float(fitted.shape[0]), 0.0, 0.0, 0.0
    xx, xy, yy, xv, yv = 0.0, 0.0, 0.0, 0.0, 0.0
    for other in range(fitted.shape[0]):
        a, b, c = fitted[other, 0], fitted[other, 1], fitted[other, 2]
        x, y, v = x + a, y + b, v + c
        xx, xy, yy = xx + a * a, xy + a * b, yy + b * b
        xv, yv = xv + a * c, yv + b * c
    xx, xy, yy = xx - x * x / n, xy - x * y / n, yy - y * y / n
    xv, yv = xv - x * v / n, yv - y * v / n
    divisor = xx * yy - xy * xy
    if divisor < _LEAST:
        return 0.0, 0.0, 0.0
    by_column, by_row = (xv * yy - yv * xy) / divisor, (yv * xx - xv * xy) / divisor
    return (v - by_column * x - by_row * y) / n, by_column, by_row


@kernel
def off_surfaces_kernel(
    beams: PointBeams, points: _Integers, rows: _Integers, found: NDArray[np.uint8]
) -> None:
    """What :func:`off_surface` says of points: ``found`` (k,)."""
    fitted = np.empty((_MOST, 6))
    for i in range(points.size):
        found[i] = off_surface(beams, points[i], rows[i], fitted)


def warm_up() -> None:
    """Compile the kernels."""
    zeros = np.zeros((4, 3))
    starts, segments = np.arange(5), np.zeros(4, np.int32)
    beams = PointBeams(zeros, zeros, np.ones(4), segments, starts, segments, 0.01)
    off_surfaces_kernel(beams, np.arange(2), np.arange(2), np.zeros(2, np.uint8))
