"""Loops that find narrow ridges on scanlines: edging stones between a planting strip and a walk.

From the road one sees a face that rises from the soil, a top of 6 to 20 cm and, behind it, shadow
up to where the ray over the far edge meets the walk. The edge of the map is the far one: what is
lower behind it is told by where the shadow ends, for that ray comes from a scanner's height.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.road.curbs.steps import step_columns as of

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_NEAREST_M = 1.0
"""What is nearer to the vehicle's path is the vehicle itself."""

_OVER_M, _MOST_OVER = 0.15, 50
"""What lies higher hangs over; so many vertices of it are passed, half a metre of a crown at points
1 cm apart. By trial."""

_LEAST_GAP_M = 0.03
"""A shorter gap between two vertices is no shadow but their spacing. By trial."""

_WIDEST_M, _LEVEL_M, _FACE_M, _FEWEST_TOP = 0.25, 0.02, 0.08, 2
"""A top is at most so wide, that of the widest kerb stone; its vertices lie level within so much,
its front face takes at most so much in plan; and it has at least two vertices, which give its
spacing."""

_GROUND_M, _FEWEST_GROUND, _TRIES = 0.35, 4, 6
"""Length of ground behind a shadow that is looked at, vertices that it has at least, and how many
of the first are passed over because they may lie on the mesh across the shadow. By trial."""

_ROUGH_M, _LEAST_ROUGH_M, _MODEL_M = 0.02, 0.003, 0.003
"""Rougher ground tells no height of a step of 3 cm; no ground is smoother than pavement's texture;
how far pavement departs from a straight piece. As in `step_kernels`."""

_SLOPE_SD = 0.15
"""Standard deviation of the slope of pavements, m per m; as in `step_kernels`."""

_MOST_BEYOND_M = 0.02
"""The edge lies half a spacing beyond the last vertex of the top, at most so much. By trial."""


class RidgeLimits(NamedTuple):
    """What ridges may be.

    Attributes
    ----------
    least_m, most_m : float
        Height of the step behind one.
    steepest : float
        Slope of the ground, m per m.
    least_scanner_m, most_scanner_m : float
        Height of a scanner over an edge.
    """

    least_m: float
    most_m: float
    steepest: float
    least_scanner_m: float
    most_scanner_m: float


class _Top(NamedTuple):
    """The top of a ridge: vertices, mean height, width, m; mean square off it, m²."""

    vertices: int
    height: float
    width: float
    square: float


class _Ground(NamedTuple):
    """Ground behind a shadow: vertices, height at the edge, RMS, m; squared error, m²."""

    vertices: int
    height: float
    rough: float
    error: float


@kernel
def ridges_kernel(
    across: _Floats,
    height: _Floats,
    starts: _Integers,
    limits: RidgeLimits,
    found: tuple[_Floats, _Floats],
) -> int:
    """The far edges of ridges; gives how many there are: beyond the room they are counted only.

    ``across`` and ``height`` (n,) are vertices, left to right, m; ``starts`` (s + 1,) where the
    scanlines begin. ``found`` are filled in the order of the scanlines: (k, of.STEP_COLUMNS), and
    (k,) the near end of the top, m across.
    """
    rows, fronts = found
    count = 0
    for section in range(starts.size - 1):
        begin, end = starts[section], starts[section + 1]
        for side in (-1, 1):
            x, h = across[begin:end][::side], height[begin:end][::side]
            for i in range(_first_of(across[begin:end], side), x.size - 1):
                behind = _behind(x, h, (i, side), limits)
                if behind < 0:
                    continue
                top = _top_of(x, h, (i, side), limits.least_m)
                if top.vertices < _FEWEST_TOP:
                    continue
                ground = _ground_of(x, h, (i, side, behind), limits)
                high = top.height - ground.height
                if ground.vertices == 0 or not limits.least_m <= high <= limits.most_m:
                    continue
                position = min(count, rows.shape[0] - 1)
                row = rows[position]
                fronts[position] = x[i] - side * top.width
                _describe((section, side), side * x[i], top, ground, row)
                row[of.VERTEX] = begin + i if side > 0 else end - 1 - i
                count += 1
    return count


@kernel
def _first_of(across: _Floats, side: int) -> int:
    """The first vertex beside the vehicle, counted towards a side."""
    if side > 0:
        return int(np.searchsorted(across, _NEAREST_M))
    return int(across.size - np.searchsorted(across, -_NEAREST_M, "right"))


@kernel
def _behind(x: _Floats, h: _Floats, which: tuple[int, int], limits: RidgeLimits) -> int:
    """The vertex that follows an edge if a ray from a scanner could just pass both; else −1."""
    i, side = which
    edge = side * x[i]
    if edge < _NEAREST_M:
        return -1
    k = i + 1
    while k < x.size - 1 and h[k] > h[i] + _OVER_M and k - i < _MOST_OVER:
        k += 1
    gap, drop = side * x[k] - edge, h[i] - h[k]
    is_shadow = limits.least_scanner_m * gap <= drop * edge <= limits.most_scanner_m * gap
    if gap < _LEAST_GAP_M or not is_shadow:
        return -1
    return k


@kernel
def _top_of(x: _Floats, h: _Floats, which: tuple[int, int], least: float) -> _Top:
    """Level ground before an edge that a face ends; no vertices if it is none or too wide."""
    i, side = which
    none = _Top(0, 0.0, 0.0, 0.0)
    count, total, squares, wide = 0, 0.0, 0.0, 0.0
    for j in range(i, -1, -1):
        away, off = side * (x[i] - x[j]), h[j] - h[i]
        if off > _OVER_M:
            continue
        if away > _WIDEST_M + _FACE_M or off > _LEVEL_M:
            return none
        if off <= -least:
            if away > wide + _FACE_M or count == 0:
                return none
            mean = total / count
            return _Top(count, h[i] + mean, wide, max(squares / count - mean * mean, 0.0))
        if off >= -_LEVEL_M:
            count += 1
            total += off
            squares += off * off
            wide = max(wide, away)
            if wide > _WIDEST_M:
                return none
    return none


@kernel
def _ground_of(x: _Floats, h: _Floats, which: tuple[int, int, int], limits: RidgeLimits) -> _Ground:
    """Level ground behind the shadow of an edge; no vertices where there is none.

    Vertices that lie on the mesh across the shadow are passed: ground is the evenest piece.
    """
    i, side, first = which
    best = _Ground(0, 0.0, _ROUGH_M, 0.0)
    for begin in range(first, min(first + _TRIES, x.size)):
        gap = side * (x[begin] - x[i])
        drop = (h[i] - h[begin]) * side * x[i]
        if gap <= 0:
            continue
        if not limits.least_scanner_m * gap <= drop <= limits.most_scanner_m * gap:
            continue
        n, u, v, uu, uv, vv = 0, 0.0, 0.0, 0.0, 0.0, 0.0
        for j in range(begin, x.size):
            away = side * (x[j] - x[begin])
            if away > _GROUND_M:
                break
            if away < 0 or h[j] > h[i] + _OVER_M:
                continue
            off = h[j] - h[begin]
            n += 1
            u += away
            v += off
            uu += away * away
            uv += away * off
            vv += off * off
        if n < _FEWEST_GROUND:
            break
        u, v = u / n, v / n
        uu, uv, vv = uu - n * u * u, uv - n * u * v, vv - n * v * v
        held = _LEAST_ROUGH_M**2 / _SLOPE_SD**2
        slope = uv / (uu + held)
        square = max(vv - 2 * slope * uv + slope * slope * uu, 0.0) / n
        rough = math.sqrt(max(square, _LEAST_ROUGH_M**2))
        if rough >= best.rough or abs(slope) > limits.steepest:
            continue
        error = rough**2 / n + rough**2 * (gap + u) ** 2 / (uu + held) + _MODEL_M**2
        best = _Ground(n, h[begin] + v - slope * (u + gap), rough, error)
    return best


@kernel
def _describe(
    which: tuple[int, int], edge: float, top: _Top, ground: _Ground, row: _Floats
) -> None:
    section, side = which
    spacing = top.width / (top.vertices - 1)
    at = side * (edge + min(spacing / 2, _MOST_BEYOND_M))
    noise = max(math.sqrt(top.square), _LEAST_ROUGH_M)
    row[:] = 0.0
    row[of.SECTION] = section
    row[of.LOWER_ACROSS], row[of.UPPER_ACROSS] = at, at
    row[of.LOWER_HEIGHT], row[of.UPPER_HEIGHT] = ground.height, top.height
    row[of.SIGN] = -side
    error = noise * noise / top.vertices + _MODEL_M**2 + ground.error
    row[of.SIGNIFICANCE] = (top.height - ground.height) / math.sqrt(error)
    # The top is level up to its end: nothing says that it is none.
    row[of.TOP_M], row[of.FOOT_M] = _GROUND_M, _GROUND_M
    row[of.FOOT_ROUGH_M], row[of.FOOT_COVER_M] = ground.rough, ground.rough


def warm_up() -> None:
    """Compile the kernel."""
    across, height = np.linspace(-2.0, 2.0, 9), np.zeros(9)
    limits = RidgeLimits(0.03, 0.45, 0.36, 1.0, 3.5)
    ridges_kernel(
        across, height, np.array([0, 9]), limits, (np.empty((2, of.STEP_COLUMNS)), np.empty(2))
    )
