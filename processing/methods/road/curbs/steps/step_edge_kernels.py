"""Loops that measure the edges of steps from the vertices of scanlines themselves."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.road.curbs.steps.step_columns import (
    FACE_COUNT,
    FOOT_COVER_M,
    FOOT_M,
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

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_FOOT_SHARE, _TOP_SHARE = 0.2, 0.8
"""Of the rise: what is below and above isn't on the face. Symmetric, and far enough from both ends
that noise of some millimetres on a step of 3 cm is not taken for the face."""

_BEYOND_M = 0.06
"""How far beyond the face as found a vertex may be of it: three cells of the search. By trial."""

_HELD = 0.01
"""Of squared shares: a few vertices tell no lean, a face is upright then. By trial."""

_SAME_M = 0.12
"""Steps of one direction whose middles lie nearer are one: narrower than an edging stone's two
faces, which differ in direction. By trial."""

_FOOT_REACH_M, _FACE_OFF_M = 0.30, 0.03
"""Over how much ground before the edge roughness is measured, the width of an apron; what is nearer
to the edge may be the face's. By trial."""

_WALL_M = 0.02
"""Of a gutter beside the foot: it leans by less. By trial."""

_OVER_M, _OVERHEAD_M = 0.15, 1.2
"""What lies higher over the upper edge hangs over it; what lies higher over the foot is no growth
of the ground but a crown or a mirror. By trial."""

_SEEN_FACE_M, _HIDDEN_M = 0.04, 0.15
"""A wider gap between foot and top without a vertex is in shadow, as a face of that width would
show two cells; so far before the first vertex of the top its edge lies at most. By trial."""

_BESIDE_M, _MOST_ROUGH_M = 0.16, 0.30
"""How far beyond the face vertices of foot and top are looked for, a kerb stone's width; no vertex
counts as farther off the foot, so that a single one cannot decide. By trial."""

_LEDGE_M, _LEDGE_OFF_M, _LEDGE_VERTICES, _LEDGE_APART_M = 0.04, 0.01, 3, 0.04
"""Even ground within a face is the top of the wall of an open gutter, 4.5 to 9 cm wide (JIS A
5372): so much of it, m, off by no more, m, told by no fewer vertices, and above the foot and below
the top by four times what it may be off, m, at least, so that it is of neither."""

_LEAST_RISE_M = 1e-3
"""Guard of a division where foot and top meet."""


class EdgeLimits(NamedTuple):
    """What the edges of steps may be.

    Attributes
    ----------
    least_m, most_m : float
        Height of a step.
    least_face : float
        Rise per metre of the face.
    scanner_m : float
        Height of a high scanner; 0 where lines don't run from the vehicle's path.
    """

    least_m: float
    most_m: float
    least_face: float
    scanner_m: float


class _FaceSums(NamedTuple):
    """Sums over the vertices of a face: of their place, share of the rise, product, share²."""

    total: float
    shares: float
    products: float
    squares: float


@kernel
def edges_kernel(
    across: _Floats, height: _Floats, starts: _Integers, limits: EdgeLimits, table: _Floats
) -> int:
    """Put the edges of steps where the vertices have them; leave out what doesn't rise steeply.

    Parameters
    ----------
    across, height : (n,)
        Vertices, left to right, m.
    starts : (s + 1,)
        Where the scanlines begin.
    limits : EdgeLimits
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
        _stand_on_ledge(x, h, row)
        if not _cross(x, h, limits.scanner_m, row):
            continue
        wide = abs(row[UPPER_ACROSS] - row[LOWER_ACROSS])
        high = row[UPPER_HEIGHT] - row[LOWER_HEIGHT]
        is_step = limits.least_m <= high <= limits.most_m
        if not is_step or high < limits.least_face * wide:
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
def _stand_on_ledge(x: _Floats, h: _Floats, row: _Floats) -> None:
    """Take a step whose face holds even ground for what it is: a curb that stands on a wall."""
    sign, low = row[SIGN], row[LOWER_HEIGHT]
    middle = (row[LOWER_ACROSS] + row[UPPER_ACROSS]) / 2
    rise = row[UPPER_HEIGHT] - low
    reach = abs(row[UPPER_ACROSS] - row[LOWER_ACROSS]) / 2 + _BEYOND_M
    if rise <= 2 * _LEDGE_APART_M:
        return
    begin, count, total = 0.0, 0, 0.0
    for k in range(x.size):
        i = k if sign > 0 else x.size - 1 - k
        u = (x[i] - middle) * sign
        if abs(u) > reach:
            continue
        # Vertices of the wall itself lie lower and may come after the first ones on its top.
        if count > 0 and h[i] < total / count - _LEDGE_OFF_M and u - begin < _WALL_M:
            continue
        if count > 0 and abs(h[i] - total / count) <= _LEDGE_OFF_M:
            count += 1
            total += h[i]
        else:
            is_between = _LEDGE_APART_M < h[i] - low < rise - _LEDGE_APART_M
            begin, count, total = u, int(is_between), h[i]
        if count >= _LEDGE_VERTICES and u - begin >= _LEDGE_M:
            row[SIGNIFICANCE] *= 1.0 - (total / count - low) / rise
            row[LOWER_HEIGHT], row[FOOT_SLOPE], row[FOOT_M] = total / count, 0.0, u - begin
            row[LOWER_ACROSS] = middle + sign * u
            return


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
        share = (h[i] - base) / max(top + row[TOP_SLOPE] * u - base, _LEAST_RISE_M)
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
    sums = _FaceSums(total, shares, products, squares)
    wide = _width(max(first_high - last_low, 0.0), count, sums)
    centre = total / count if count > 0 else (first_high + last_low) / 2
    if count == 0 and wide > _SEEN_FACE_M and highest > 0:
        # No point on the face: upright, where the side that faces the vehicle's path
        # ends.
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
def _width(gap: float, count: int, sums: _FaceSums) -> float:
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
    cover, cover_count, rough, rough_count = 0.0, 0.0, 0.0, 0.0
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
                cover += min(off * off, _MOST_ROUGH_M**2)
                cover_count += 1.0
            if _FACE_OFF_M < before < ground_m and abs(off) < off_ground:
                rough += off * off
                rough_count += 1.0
    row[FOOT_COVER_M] = math.sqrt(cover / max(cover_count, 1.0))
    row[FOOT_ROUGH_M] = math.sqrt(rough / max(rough_count, 1.0))


def warm_up() -> None:
    """Compile the kernel."""
    across, height = np.linspace(-1.0, 1.0, 9), np.zeros(9)
    table = np.zeros((1, STEP_COLUMNS))
    edges_kernel(across, height, np.array([0, 9]), EdgeLimits(0.01, 0.45, 0.25, 3.0), table)
