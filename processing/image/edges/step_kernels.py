"""Loops that look for a low step: two surfaces, straight across, whose ends a short face joins.

Points around a place are looked at along a heading: *along* it a, *across* it u (to the left),
height v. A step is v = base + grade·a + left·(u − place) before its place, rises by jump + twist·a
over its width, and goes on with another slope beyond it. The twist is that of the short ramps at
the ends of a dropped curb, where the upper edge falls by 13 cm within 0.7 m.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats
from processing.core.kernels import kernel

OTHER, FLAT, STEP = 0, 1, 2
"""What a patch of points is: neither of the two; a surface without a step; a step."""

BASE, GRADE, LEFT, RIGHT, JUMP, TWIST, POSITION, WIDTH, HEADING = range(9)
"""The unknowns of a step: height at the lower end, m; grade along; slopes before and beyond;
height of the face, m, and its rise along; where the face begins across, and how wide it is, m;
heading, rad."""

UNKNOWNS = 9
_LINEAR = 6
"""Unknowns, and those in which a sharp step is linear: all but place, width and heading."""

_OFF, _SURE, _WEIGHT = range(3)
"""Of a fit: see `fit_step`."""

_N, _U, _V, _A, _UU, _UV, _UA, _VA, _AA = range(9)
_SUMS = 9
"""Sums over points of 1, u, v, a, u², uv, ua, va, a²."""

_POINTS, _WEIGHTS, _SQUARES, _FACE_POINTS, _FACE_WEIGHTS = range(5)
"""Sums over the points of a fit: number, weights, squares, number and weights at the face."""

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

LEAST_STEP_M = 0.012
"""Lower steps aren't told from joints of slabs."""

MOST_STEP_M = 0.25
"""Higher ones have faces of many points, and are found as profiles."""

ACROSS_M = 0.30
"""Half the width of what is looked at: gutters and narrow tops of 12 cm lie within."""

_FEWEST, _FEWEST_BESIDE = 18, 7
"""Points of a patch, twice its unknowns, and on either side of a step. By trial."""

_HEADINGS, _FINER = 36, math.radians(2.5)
"""Tried over half a circle, 5° apart, then half as far: over half a metre 2.5° moves an end by 2
cm, a face's width."""

_BIN_M, _BINS = 0.01, 60
"""Places tried across, m: 60 cm in all."""

_MOST_CUTS = 18
"""Bins between face and place: a surface of 12 cm is left on either side."""

_NOISE_M, _LEAST_NOISE_M, _MOST_NOISE_M = 0.004, 0.003, 0.008
"""How far points of a line scanner lie off a surface, usually, at least and at most: as in
`edge_sections`, where smooth surfaces and single scanners scatter less."""

_OFF_PLANE_M, _MOST_OFF_PLANE = 0.20, 0.25
"""Points farther from the plane of most are of other things; where so many are, it is none. By
trial."""

_PLANE_ROUNDS, _FIRST_SCALE_M, _SCALE_M = 6, 0.1, 0.02
"""Of the robust plane, and the distance at which a point weighs half (Cauchy), at first and
then."""

_LEAST_WEIGHTS, _LEAST_INFORMATION, _LEAST_SQUARE = 1e-6, 1e-3, 1e-9
"""Guards of equations and divisions: of the plane, of the fit, of weights and squares, m²."""

_LEAST_PIVOT = 1e-12
"""Guard of elimination, as a share of the diagonal."""

_TRIED = 0.5
"""Steps so much lower and less sure in the scan are fitted: a face isn't sharp."""

_VARIANCE = 16.0
"""Of a jump in the middle of two sloping surfaces of n points: 16 σ²/n."""

_LEAST_WEIGHT = 0.7
"""Mean weight of the points in the fit; with normal noise it is 0.8."""

_FLAT_NOISES, _PLAIN = 1.6, 0.97
"""A patch is flat within so many noises, if this share of its points is on it. By trial."""

_LEAST_KINK = 0.2
"""Difference of slopes: what bends more is left to the profile. By trial."""

_LEAST_JUMP, _LEAST_SURE = 2.5, 5.5
"""Of a jump in noises, and in its standard deviations: over 2,000 places and headings are tried, so
that three would be passed by chance. With these at most 0.3 % of the clicks on the carriageway away
from edges find one."""

_FACE_M, _FACE_SURE_M = 0.025, 0.015
"""Width of low faces in plan and its standard deviation, before their points are asked. By
trial."""

_NARROWEST_M, _WIDEST_M, _BESIDE_FACE_M = 0.003, 0.15, 0.05
"""Bounds of the width in a fit; points so near to the face are asked for their weight too. By
trial."""

_POSITION_SURE_M, _HEADING_SURE, _TWIST_SURE = 0.03, 0.10, 0.3
"""Standard deviations of what the scan gives: place, heading, rad, and of the twist about none: of
ramps it is 13 cm within 0.7 m, 0.19. By trial."""

_COARSENESS = (3.0, 2.0, 1.5, 1.0, 1.0, 1.0, 1.0, 1.0)
"""Noise is taken so many times as large in each round, so that the fit is led in."""

_FAR = 2.0
"""A point off by so many noises weighs half (Cauchy)."""

_STEEPEST = 0.30
"""Slope of the surfaces beside a step: steeper ones are no ground. By trial."""

_LEAST_FACE = 0.35
"""Rise per metre of a face beyond that of its surfaces. By trial."""


class _FitLimits(NamedTuple):
    """Half the length looked at, noise, m; by how much it is taken larger."""

    along: float
    noise: float
    coarseness: float


@kernel
def step_kernel(local: Floats, along: float, step: Floats) -> int:
    """Whether points about a place are a low step, and where.

    Parameters
    ----------
    local : (n, 3)
        m, about the place.
    along : float
        Half the length of edge that is looked at, m.
    step : (UNKNOWNS,)
        Is filled where a step is found; the heading has the upper surface on its left.

    Returns
    -------
    int
        `OTHER`, `FLAT` or `STEP`.
    """
    surface = np.empty((local.shape[0], 3))
    number = _near_plane(local, surface)
    if number < _FEWEST:
        return OTHER
    surface = surface[:number]
    noise = _scan(surface, along, step)
    if noise < 0:
        return OTHER
    is_plain = noise <= _FLAT_NOISES * _NOISE_M and number >= _PLAIN * local.shape[0]
    is_flat = is_plain and abs(step[LEFT] - step[RIGHT]) <= _LEAST_KINK
    if step[JUMP] < _TRIED * LEAST_STEP_M or step[WIDTH] < _TRIED * _LEAST_SURE:
        return FLAT if is_flat else OTHER
    step[WIDTH] = _FACE_M
    step[POSITION] -= _FACE_M / 2
    fit = np.empty(3)
    fit_step(surface, along, step, fit)
    if is_step(step, fit):
        return STEP
    return FLAT if is_flat else OTHER


@kernel
def is_step(step: Floats, fit: Floats) -> bool:
    """Whether a fitted step is one: high, steep and sure enough, between gentle surfaces."""
    beside = max(abs(step[LEFT]), abs(step[RIGHT]))
    return bool(
        max(LEAST_STEP_M, _LEAST_JUMP * fit[_OFF]) <= step[JUMP] <= MOST_STEP_M
        and fit[_OFF] <= _MOST_NOISE_M
        and fit[_SURE] >= _LEAST_SURE
        and fit[_WEIGHT] >= _LEAST_WEIGHT
        and beside <= _STEEPEST
        and step[JUMP] >= (_LEAST_FACE + beside) * step[WIDTH]
    )


@kernel
def _near_plane(local: Floats, surface: Floats) -> int:
    """The points near the plane that most of them lie on; 0 where many don't."""
    plane = np.zeros(3)
    matrix, right = np.zeros((3, 3)), np.zeros(3)
    row = np.empty(3)
    count = 0
    for number in range(_PLANE_ROUNDS):
        matrix[:] = 0.0
        right[:] = 0.0
        scale = _SCALE_M if number else _FIRST_SCALE_M
        for i in range(local.shape[0]):
            row[0], row[1], row[2] = 1.0, local[i, 0], local[i, 1]
            off = local[i, 2] - plane[0] - plane[1] * row[1] - plane[2] * row[2]
            weight = 1 / (1 + (off / scale) ** 2)
            _add(matrix, right, row, weight, local[i, 2])
        for j in range(3):
            matrix[j, j] += _LEAST_WEIGHTS
        if not _solve(matrix, right, plane, 3):
            return 0
    for i in range(local.shape[0]):
        off = local[i, 2] - plane[0] - plane[1] * local[i, 0] - plane[2] * local[i, 1]
        if abs(off) <= _OFF_PLANE_M:
            surface[count] = local[i]
            count += 1
    return count if count >= (1 - _MOST_OFF_PLANE) * local.shape[0] else 0


@kernel
def _scan(surface: Floats, along: float, step: Floats) -> float:
    """The best sharp step over all headings and places; gives what is left of the heights, m.

    The unknown of the width holds how sure the jump is, in its standard deviations. −1 where too
    few points lie beside any place.
    """
    sums, system = np.empty((_BINS + 1, _SUMS)), np.empty((_LINEAR + 1, _LINEAR))
    unknowns = np.empty(_LINEAR)
    least, best_cut, best_heading, count = math.inf, _BINS // 2, 0.0, 0.0
    for turn in range(2):
        # Every other place in all headings, then each place near the best.
        first, last, stride = best_cut - 1, best_cut + 1, 1
        headings = 3
        if turn == 0:
            first, last, stride = _BINS // 2 - _MOST_CUTS, _BINS // 2 + _MOST_CUTS, 2
            headings = _HEADINGS
        middle = best_heading
        for k in range(headings):
            heading = k * math.pi / _HEADINGS if turn == 0 else middle + (k - 1) * _FINER
            total = _sum_up(surface, along, heading, sums)
            n = sums[_BINS, _N]
            for cut in range(first, last + 1, stride):
                if min(sums[cut, _N], n - sums[cut, _N]) < _FEWEST_BESIDE:
                    continue
                squares = _try_cut(sums, total, cut, system, unknowns)
                if squares < least:
                    least, best_cut, best_heading, count = squares, cut, heading, n
                    step[:_LINEAR] = unknowns
    if count == 0:
        return -1.0
    step[POSITION], step[HEADING] = best_cut * _BIN_M - ACROSS_M, best_heading
    step[WIDTH] = abs(step[JUMP]) * math.sqrt(count / (_VARIANCE * least))
    if step[JUMP] < 0:
        _turn_round(step)
    return math.sqrt(least)


@kernel
def _try_cut(sums: Floats, total: float, cut: int, system: Floats, unknowns: Floats) -> float:
    """What is left of the squares of heights per point with a sharp step at a place, m²."""
    matrix, right = system[:_LINEAR], system[_LINEAR]
    _normal_equations(sums, cut, matrix, right)
    if not _solve(matrix, right, unknowns, _LINEAR):
        return math.inf
    for j in range(_LINEAR):
        total -= unknowns[j] * right[j]
    # Per point: other headings take in other points.
    return float(max(total, _LEAST_SQUARE) / max(1.0, sums[_BINS, _N] - _LINEAR - 1))


@kernel
def _turn_round(step: Floats) -> None:
    """The same sharp step, its upper surface on the left."""
    step[BASE] += step[JUMP]
    step[GRADE] = -step[GRADE] - step[TWIST]
    step[JUMP] = -step[JUMP]
    step[LEFT], step[RIGHT] = -step[RIGHT], -step[LEFT]
    step[POSITION] = -step[POSITION]
    step[HEADING] += math.pi


@kernel
def _sum_up(surface: Floats, along: float, heading: float, sums: Floats) -> float:
    """Sums of 1, u, v, a, u², uv, ua, va, a² over points before each place; gives that of v²."""
    cos, sin = math.cos(heading), math.sin(heading)
    sums[:] = 0.0
    total = 0.0
    for i in range(surface.shape[0]):
        a = surface[i, 0] * cos + surface[i, 1] * sin
        u = surface[i, 1] * cos - surface[i, 0] * sin
        if abs(a) > along or abs(u) >= ACROSS_M:
            continue
        v = surface[i, 2]
        bin_sums = sums[int((u + ACROSS_M) / _BIN_M) + 1]
        bin_sums[_N] += 1
        bin_sums[_U] += u
        bin_sums[_V] += v
        bin_sums[_A] += a
        bin_sums[_UU] += u * u
        bin_sums[_UV] += u * v
        bin_sums[_UA] += u * a
        bin_sums[_VA] += v * a
        bin_sums[_AA] += a * a
        total += v * v
    for k in range(_BINS):
        for j in range(_SUMS):
            sums[k + 1, j] += sums[k, j]
    return total


@kernel
def _normal_equations(sums: Floats, cut: int, matrix: Floats, right: Floats) -> None:
    """Of height over 1, a, u before the cut, u beyond it, 1 beyond it, a beyond it."""
    c = cut * _BIN_M - ACROSS_M
    whole, before = sums[_BINS], sums[cut]
    n, u, a, uu, ua = before[_N], before[_U], before[_A], before[_UU], before[_UA]
    m, w, b = whole[_N] - n, whole[_U] - u, whole[_A] - a
    ww, wb, bb = whole[_UU] - uu, whole[_UA] - ua, whole[_AA] - before[_AA]
    matrix[:] = 0.0
    matrix[0, 0], matrix[0, 1], matrix[0, 2] = whole[_N], whole[_A], u - c * n
    matrix[0, 3], matrix[0, 4], matrix[0, 5] = w - c * m, m, b
    matrix[1, 1], matrix[1, 2] = whole[_AA], ua - c * a
    matrix[1, 3], matrix[1, 4], matrix[1, 5] = wb - c * b, b, bb
    matrix[2, 2] = uu - 2 * c * u + c * c * n
    matrix[3, 3] = ww - 2 * c * w + c * c * m
    matrix[3, 4], matrix[3, 5] = w - c * m, wb - c * b
    matrix[4, 4], matrix[4, 5], matrix[5, 5] = m, b, bb
    for j in range(_LINEAR):
        for k in range(j):
            matrix[j, k] = matrix[k, j]
    right[0], right[1] = whole[_V], whole[_VA]
    right[2] = before[_UV] - c * before[_V]
    right[4], right[5] = whole[_V] - before[_V], whole[_VA] - before[_VA]
    right[3] = whole[_UV] - before[_UV] - c * right[4]


@kernel
def fit_step(surface: Floats, along: float, step: Floats, fit: Floats) -> None:
    """Make a nearly known step better by Gauss-Newton steps over all unknowns.

    Face, place and heading are held by what is known of them: few points lie on a face of 2 cm.

    Parameters
    ----------
    step : (UNKNOWNS,)
        Is made better.
    fit : (3,)
        How far points lie off the step, m; how sure the jump is, in its standard
        deviations; the mean weight of the points, or of those near the face if it is less.
    """
    begin, heading, noise = step[POSITION], step[HEADING], _NOISE_M
    system, change, sums = np.zeros((UNKNOWNS + 1, UNKNOWNS)), np.zeros(UNKNOWNS), np.zeros(5)
    matrix, right = system[:UNKNOWNS], system[UNKNOWNS]
    for coarseness in _COARSENESS:
        _sum_rows(surface, _FitLimits(along, noise, coarseness), step, system, sums)
        _hold(matrix, right, POSITION, begin - step[POSITION], _POSITION_SURE_M)
        _hold(matrix, right, WIDTH, _FACE_M - step[WIDTH], max(_FACE_SURE_M, step[JUMP] / 2))
        _hold(matrix, right, HEADING, heading - step[HEADING], _HEADING_SURE)
        _hold(matrix, right, TWIST, -step[TWIST], _TWIST_SURE)
        for j in range(UNKNOWNS):
            matrix[j, j] += _LEAST_INFORMATION
        if not _solve(matrix, right, change, UNKNOWNS):
            fit[_OFF], fit[_SURE], fit[_WEIGHT] = math.inf, 0.0, 0.0
            return
        for j in range(UNKNOWNS):
            step[j] += change[j]
        step[WIDTH] = min(_WIDEST_M, max(_NARROWEST_M, step[WIDTH]))
        fit[_OFF] = math.sqrt(sums[_SQUARES] / (sums[_WEIGHTS] + _LEAST_SQUARE))
        noise = max(_LEAST_NOISE_M, min(_MOST_NOISE_M, fit[_OFF]))
    right[:] = 0.0
    right[JUMP] = 1.0
    _solve(matrix, right, change, UNKNOWNS)
    fit[_SURE] = step[JUMP] / math.sqrt(change[JUMP])
    fit[_WEIGHT] = sums[_WEIGHTS] / max(sums[_POINTS], 1.0)
    if sums[_FACE_POINTS] >= _FEWEST_BESIDE:
        fit[_WEIGHT] = min(fit[_WEIGHT], sums[_FACE_WEIGHTS] / sums[_FACE_POINTS])


@kernel
def _sum_rows(
    surface: Floats,
    limits: _FitLimits,
    step: Floats,
    system: Floats,
    sums: Floats,
) -> None:
    """Normal equations; number, weights, squares of all points, number and weights at the face."""
    along, noise, coarseness = limits
    row = np.empty(UNKNOWNS)
    system[:] = 0.0
    sums[:] = 0.0
    cos, sin = math.cos(step[HEADING]), math.sin(step[HEADING])
    for i in range(surface.shape[0]):
        a = surface[i, 0] * cos + surface[i, 1] * sin
        u = surface[i, 1] * cos - surface[i, 0] * sin
        if abs(a) > along or abs(u) > ACROSS_M:
            continue
        slope = _row_of(step, a, u, surface[i, 2], row)
        off, steepness = surface[i, 2] - row[POSITION], 1 + slope * slope
        row[POSITION] = -slope
        weight = 1 / (1 + off * off / (steepness * (_FAR * noise * coarseness) ** 2))
        sums[_POINTS] += 1
        sums[_WEIGHTS] += weight
        sums[_SQUARES] += weight * off * off / steepness
        if -_BESIDE_FACE_M < u - step[POSITION] < step[WIDTH] + _BESIDE_FACE_M:
            sums[_FACE_POINTS] += 1
            sums[_FACE_WEIGHTS] += weight
        factor = weight / (noise * noise * steepness)
        _add(system[:UNKNOWNS], system[UNKNOWNS], row, factor, off)


@kernel
def _add(matrix: Floats, right: Floats, row: Floats, weight: float, off: float) -> None:
    for j in range(row.size):
        right[j] += weight * row[j] * off
        for k in range(row.size):
            matrix[j, k] += weight * row[j] * row[k]


@kernel
def _hold(matrix: Floats, right: Floats, unknown: int, away: float, sure: float) -> None:
    matrix[unknown, unknown] += 1 / sure**2
    right[unknown] += away / sure**2


@kernel
def _row_of(step: Floats, a: float, u: float, v: float, row: Floats) -> float:
    """Derivatives of the height of the nearest surface at a place; gives its slope across.

    That of the place holds the height. Noise moves points of an upright face across, where they
    lie far above or below the surfaces beside it, so those go to the face.
    """
    beyond, width = u - step[POSITION], step[WIDTH]
    row[:] = 0.0
    row[BASE], row[GRADE] = 1.0, a
    base, jump = step[BASE] + step[GRADE] * a, step[JUMP] + step[TWIST] * a
    slope, height = step[LEFT], base + step[LEFT] * beyond
    if beyond >= width / 2:
        slope = step[RIGHT]
        height = base + jump + slope * (beyond - width)
    face = jump / width
    foot = (beyond * width + (v - base) * jump) / (width * width + jump * jump)
    off_face = (v - base - face * beyond) ** 2 / (1 + face * face)
    if 0 < foot < 1 and (0 < beyond < width or off_face < (v - height) ** 2 / (1 + slope * slope)):
        # By the foot, not by the place across: noise across would make steep faces less steep.
        slope, height = face, base + face * beyond
        row[JUMP], row[TWIST], row[WIDTH] = foot, foot * a, -face * foot
    elif beyond < width / 2:
        row[LEFT] = beyond
    else:
        row[JUMP], row[TWIST], row[RIGHT] = 1.0, a, beyond - width
        row[WIDTH] = -slope
    row[HEADING] = -slope * a
    row[POSITION] = height
    return float(slope)


@kernel
def _solve(matrix: Floats, right: Floats, unknowns: Floats, size: int) -> bool:
    """Cholesky; the matrix and the right side stay as they are."""
    lower = np.empty((size, size))
    for j in range(size):
        left = matrix[j, j]
        for k in range(j):
            left -= lower[j, k] * lower[j, k]
        if left <= _LEAST_PIVOT * matrix[j, j] or left <= 0:
            return False
        lower[j, j] = math.sqrt(left)
        for i in range(j + 1, size):
            value = matrix[i, j]
            for k in range(j):
                value -= lower[i, k] * lower[j, k]
            lower[i, j] = value / lower[j, j]
    for j in range(size):
        value = right[j]
        for k in range(j):
            value -= lower[j, k] * unknowns[k]
        unknowns[j] = value / lower[j, j]
    for j in range(size - 1, -1, -1):
        value = unknowns[j]
        for k in range(j + 1, size):
            value -= lower[k, j] * unknowns[k]
        unknowns[j] = value / lower[j, j]
    return True
