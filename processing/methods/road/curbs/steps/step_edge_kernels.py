"""Loops that measure the edges of steps from the vertices of scanlines themselves."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.road.curbs.steps.step_columns import (
    FACE_COUNT,
    FOOT_COVER_M,
    FOOT_ROUGH_M,
    FOOT_SLOPE,
    LOWER_ACROSS,
    LOWER_HEIGHT,
    SECTION,
    SIGN,
    SIGNIFICANCE,
    STEP_COLUMNS,
    TOP_SLOPE,
    UPPER_ACROSS,
    UPPER_HEIGHT,
    VERTEX,
)

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_FOOT_SHARE, _TOP_SHARE = 0.2, 0.8  # of the rise: what is below and above isn't on the face
_BEYOND_M = 0.06
_HELD = 0.01  # of squared shares: a few vertices tell no lean, a face is upright then
_SAME_M = 0.12
_FOOT_REACH_M, _FACE_OFF_M = 0.30, 0.03  # what is nearer to the edge may be the face's
_WALL_M = 0.02  # of a gutter: it leans by less
_OVER_M, _OVERHEAD_M = 0.15, 1.2  # what lies higher hangs over, is no growth of the ground
_SEEN_FACE_M, _HIDDEN_M = 0.04, 0.15
_BESIDE_M, _MOST_ROUGH_M = 0.16, 0.30


@kernel
def edges_kernel(
    across: _Floats, height: _Floats, starts: _Integers, limits: _Floats, table: _Floats
) -> int:
    """Put the edges of steps where the vertices have them; leave out what doesn't rise steeply.

    Parameters
    ----------
    across, height : (n,)
        Vertices, left to right, m.
    starts : (s + 1,)
        Where the scanlines begin.
    limits : (4,)
        Least and greatest step, m; least rise per metre of the face; height of a high scanner, m,
        0 where lines don't run from the vehicle's path.
    table : (k, STEP_COLUMNS)
        Steps as found; those that are kept are moved to the front.

    Returns
    -------
    int
        How many are kept.
    """
    kept = 0
    for number in range(table.shape[0]):
        row = table[number]
        section = int(row[SECTION])
        begin, end = starts[section], starts[section + 1]
        x, h = across[begin:end], height[begin:end]
        row[VERTEX] = -1.0
        if not _cross(x, h, limits[3], row):
            continue
        wide = abs(row[UPPER_ACROSS] - row[LOWER_ACROSS])
        high = row[UPPER_HEIGHT] - row[LOWER_HEIGHT]
        if not limits[0] <= high <= limits[1] or high < limits[2] * wide:
            continue
        _roughness(x, h, row)
        row[VERTEX] += begin
        if kept > 0 and _is_same(table[kept - 1], row):
            if row[SIGNIFICANCE] > table[kept - 1, SIGNIFICANCE]:
                table[kept - 1] = row
            continue
        table[kept] = row
        kept += 1
    return kept


@kernel
def _is_same(one: _Floats, other: _Floats) -> bool:
    """Whether two steps that were found apart turn out to be one."""
    apart = abs(one[LOWER_ACROSS] + one[UPPER_ACROSS] - other[LOWER_ACROSS] - other[UPPER_ACROSS])
    return bool(one[SECTION] == other[SECTION] and one[SIGN] == other[SIGN] and apart < 2 * _SAME_M)


@kernel
def _cross(x: _Floats, h: _Floats, highest: float, row: _Floats) -> bool:
    """Where the face is crossed; False where foot or top have no vertices."""
    sign = row[SIGN]
    middle = (row[LOWER_ACROSS] + row[UPPER_ACROSS]) / 2
    reach = abs(row[UPPER_ACROSS] - row[LOWER_ACROSS]) / 2 + _BEYOND_M
    foot, top = row[LOWER_HEIGHT], row[UPPER_HEIGHT]
    last_low, first_high, off = -math.inf, math.inf, math.inf
    count, total, shares, products, squares = 0, 0.0, 0.0, 0.0, 0.0
    for i in range(x.size):
        u = (x[i] - middle) * sign
        if abs(u) > reach + _BESIDE_M or h[i] > top + _OVER_M:
            continue
        if abs(u) < off:
            off = abs(u)
            row[VERTEX] = i
        base = foot + row[FOOT_SLOPE] * u
        share = (h[i] - base) / max(top + row[TOP_SLOPE] * u - base, 1e-3)
        if share < _FOOT_SHARE and last_low < u < first_high:
            last_low = u
        if share > _TOP_SHARE and -reach < u < first_high:
            first_high = u
        if _FOOT_SHARE <= share <= _TOP_SHARE and abs(u) <= reach:
            count += 1
            total += u
            shares += share
            products += share * u
            squares += share * share
    if not math.isfinite(last_low - first_high):
        return False
    wide = _width(max(first_high - last_low, 0.0), count, (total, shares, products, squares))
    centre = total / count if count > 0 else (first_high + last_low) / 2
    if count == 0 and wide > _SEEN_FACE_M and highest > 0:
        # No point on the face: upright, where the side that is turned to the way ends.
        centre = last_low
        if middle * sign < 0:
            # In shadow: between the last point of the top and where the ray that touches the
            # edge of a high scanner would pass.
            touched = last_low + (top - foot) * abs(middle + sign * last_low) / highest
            centre = min(max((touched + first_high) / 2, first_high - _HIDDEN_M), first_high)
        wide = 0.0
    row[FACE_COUNT] = count
    row[LOWER_ACROSS] = middle + sign * (centre - wide / 2)
    row[UPPER_ACROSS] = middle + sign * (centre + wide / 2)
    row[LOWER_HEIGHT] = foot + row[FOOT_SLOPE] * (centre - wide / 2)
    row[UPPER_HEIGHT] = top + row[TOP_SLOPE] * (centre + wide / 2)
    return True


@kernel
def _width(gap: float, count: int, sums: tuple[float, float, float, float]) -> float:
    """How wide a face is, from the gap between foot and top and sums over the vertices on it.

    Foot and top end somewhere between two vertices; the face's own say how it leans.
    """
    if count == 0:
        return gap
    total, shares, products, squares = sums
    lean = (products - shares * total / count) / (squares - shares**2 / count + _HELD)
    return min(max(lean, 0.0), gap / (_TOP_SHARE - _FOOT_SHARE))


@kernel
def _roughness(x: _Floats, h: _Floats, row: _Floats) -> None:
    """How far vertices before the lower edge lie off the foot, m.

    What is about as high above the foot as the upper edge is no ground but grows on the top, blades
    of a verge, or is a vehicle over its tyre; where it falls as deep an open gutter begins.
    """
    off_ground = _TOP_SHARE * (row[UPPER_HEIGHT] - row[LOWER_HEIGHT])
    sums = np.zeros(4)
    ground_m = _FOOT_REACH_M
    for i in range(x.size):
        before = (row[LOWER_ACROSS] - x[i]) * row[SIGN]
        if 0.0 < before < ground_m and row[LOWER_HEIGHT] - h[i] > off_ground:
            ground_m = before - _WALL_M
    for i in range(x.size):
        before = (row[LOWER_ACROSS] - x[i]) * row[SIGN]
        if 0.0 < before <= _FOOT_REACH_M:
            off = h[i] - row[LOWER_HEIGHT] + row[FOOT_SLOPE] * before
            if off < _OVERHEAD_M:
                sums[0] += min(off * off, _MOST_ROUGH_M**2)
                sums[1] += 1.0
            if _FACE_OFF_M < before < ground_m and abs(off) < off_ground:
                sums[2] += off * off
                sums[3] += 1.0
    row[FOOT_COVER_M] = math.sqrt(sums[0] / max(sums[1], 1.0))
    row[FOOT_ROUGH_M] = math.sqrt(sums[2] / max(sums[3], 1.0))


def warm_up() -> None:
    """Compile the kernel."""
    across, height = np.linspace(-1.0, 1.0, 9), np.zeros(9)
    table = np.zeros((1, STEP_COLUMNS))
    edges_kernel(across, height, np.array([0, 9]), np.array([0.01, 0.45, 0.25, 3.0]), table)
