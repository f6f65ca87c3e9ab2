"""Loops that fit carriageway, face and top to the points about one station of a curb.

Takahashi 2022, section 6.3 d–f: planes of points within 5 mm, intersected. In the curved frame of
the curb (along, across, above) each plane has three numbers; they are found by robust least squares
with weak knowledge of what curbs are, which takes over where points are few.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.road.curbs.edges import edge_measures as of

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_LOW, _HIGH, _FACE = 0, 1, 2
_HEIGHT, _SLOPE, _SLOPE_ALONG, _TOP_HEIGHT, _TOP_SLOPE, _TOP_SLOPE_ALONG = range(6)
"""Of the two planes of ground: height at the line, m, slopes across and along; of low and high."""

_LOWER, _UPPER, _BESIDE, _BEFORE, _BELOW, _DEEPER = range(6)
"""Of edges as known by now, m: both across; how far beside them a point of the face may lie,
before the upper one and below its plane one of the top, below its plane one of the carriageway."""

_REACH_M, _DEEP_M = 0.35, 0.08
"""How far before the edge and how deep below the rough line carriageway is looked at: within the
0.4 m of Table 6-1; what is deeper is an open gutter. By trial."""

_TOP_M, _TOP_MORE_M = 0.12, 0.03
"""A stone is at least about as wide; a little more is looked at, as the edge isn't exact yet."""

_CHAMFER_M = 0.03
"""Width of a chamfer or rounding at the top's edge."""

_ROUND = 0.32
"""Share of the step, at the top, where an arris may be chamfered or rounded: no point there says
where the face is. By trial."""

_CLEAR_SHARE, _LEAST_CLEAR_M, _MOST_CLEAR_M = 0.25, 0.006, 0.02
"""Points of the face lie so far above the carriageway: a share of the step, between the two. By
trial."""

_EDGE_M = 0.01
"""Points so near to an edge are of neither surface of ground. By trial."""

_HALF_STEP, _LEAST_HALF_M = 0.5, 0.02
"""Ground lies within half the step of its plane, on low steps within the latter. By trial."""

_ON_ARRIS_M = 0.006
"""Beside the upper edge, where the arris may be rounded, the top lies within so much."""

_ON_GROUND_M, _END_M = 0.015, 0.25
"""Points so near to a plane tell where it ends, at most so far from the rough line. By trial."""

_CLOSE_BELOW_M = 0.02
"""Behind the narrow top of an edging stone its other face lies close below: a hidden top has no
lower points at first. By trial."""

_FIRST_BESIDE_M, _LATER_BESIDE_M = 0.12, 0.03
"""How far beside the edges points of the face are looked for: at first, and once a face was found.
By trial."""

_ROUNDS = 5
"""Of surfaces and edges in turn, and of each robust fit: they have settled by then. By trial."""

_WIDE_ROUNDS = (4.0, 2.0, 1.0)
"""What the tolerance is multiplied with in the first rounds of a fit, and in the rest."""

_LIMIT = 3.0
"""Points farther off than so many tolerances weigh nothing (biweight)."""

_ABOVE_WEIGHT = 0.5
"""Of ground above its plane by more than the tolerance: grass and litter lie above, nothing
below."""

_NOISE_M = 0.005
"""Noise by which priors are weighed against points: the inlier tolerance of Table 6-1."""

_LEAST_PIVOT, _LEAST_WEIGHT = 1e-12, 1e-6
"""Guards: of elimination, and of a plane without points, which keeps its first height."""

_FREE_SLOPE, _FREE_ALONG = 0.05, 0.1
"""Standard deviations of the slopes of ground across about level, and along about the rough line, m
per m. By trial."""

_FREE_LEAN, _FREE_LEAN_ALONG = 0.15, 0.05
"""The same of a face's lean about the typical one, and along. By trial."""

_FACE_MIDDLE = 0.4
"""Share of the step about which a face's height is counted, so that place and lean are independent:
the middle of what is neither carriageway nor arris."""

_LEAST_POINTS, _LEAST_FACE_POINTS = 4, 3
"""With fewer points nothing is fitted: one more than a plane's unknowns; a face's are held."""

_LONGEST_M = 2.0
"""Where few points fall a window is made longer, twice the one before, up to so much before and
behind: three kerb stones, and less than a quarter of a corner's arc."""

_MOST_POINTS, _LEAST_TOP = 400, 3.0
"""More points make an edge slower, not better; weight of those that a top must have, as a plane has
three unknowns."""

_UNSEEN, _ROUGH_M = 0.05, 0.005
"""A rough line's height, where the carriageway is hidden, is worth so many points of so much
noise."""

_NOISY, _NOISIEST_M = 1.5, 0.02
"""Where ground is rough the tolerance is so many times the RMS of the quieter surface, up to the
latter. By trial."""

_TOP_SPACING_M, _ASIDE_M = 0.03, 0.08
"""Before the first point of a hidden top its edge lies at most so far; so far before the rough edge
a hidden top may begin. By trial."""

_RAISED = 0.7
"""Of the rough step: what lies higher is no soil and little of a face. By trial."""

_LEAST_FACE, _TYPICAL_LEAN = 2.5, 0.08
"""Weight of points from which a face is placed by them; lean of upright kerb stones, m across per m
of height. By trial."""

_MOST_ASIDE_M = 0.15
"""Where no points lie on the face the edge is within so much of the rough line."""

_LEAST_ERROR_M, _UNPLACED_M, _OF_GAP, _ENDS_M = 0.002, 0.01, 0.29, 0.02
"""No edge is known better; one without points on its face lies somewhere in a gap, whose standard
deviation is the latter share of its width (1 / √12), at least 1 cm, and whose ends aren't known
exactly: where it is narrow such edges lie 2 to 3 cm off, on own streets as on samples."""

_LOW_STEP, _LEAST_STEP_M = 5.0, 0.002
"""From steps as low as so many tolerances on, the error across grows by the fourth power. By
trial."""

_BEFORE_M, _BEFORE_MORE_M = (-0.25, -0.05), (-0.4, -0.02)
_BEHIND_M, _BEHIND_MORE_M, _BEHIND_HIDDEN_M = (0.04, 0.16), (0.02, 0.3), (-0.06, 0.16)
"""Where rough heights are taken, across: before the lower edge, and wider where that holds too few;
behind the upper edge, wider, and about one that is hidden. By trial."""

_LOW_SHARE, _GUTTER_SHARE, _HIGH_SHARE, _HIDDEN_SHARE = 0.4, 0.8, 0.5, 0.6
"""Quantiles of rough heights: the carriageway a little below the median, as things lie on it; that
beside an open gutter high, that of tops in the middle, that of hidden ones higher since soil lies
among them. By trial."""


class _Prior(NamedTuple):
    """What is known of a plane before its points.

    Attributes
    ----------
    tolerance_m : float
    value_m : float
        Height of ground, or place of a face across.
    slope : float
    free, free_along : float
        Standard deviations of the slopes.
    """

    tolerance_m: float
    value_m: float
    slope: float
    free: float
    free_along: float


class _Plane(NamedTuple):
    """A plane: value at the line, m; slope, slope along; weight of its points, their RMS, m."""

    value_m: float
    slope: float
    slope_along: float
    weight: float
    off_m: float


class _Face(NamedTuple):
    """A face: place across at height 0, m; its lean; weight of its points, their RMS, m."""

    across_m: float
    lean: float
    weight: float
    off_m: float


@kernel
def _solve(m: _Floats, out: _Floats) -> bool:
    """Solve three equations (3, 4) by elimination; all pivots are positive by the priors."""
    for i in range(3):
        if m[i, i] <= _LEAST_PIVOT:
            return False
        for j in range(i + 1, 3):
            factor = m[j, i] / m[i, i]
            for k in range(i, 4):
                m[j, k] -= factor * m[i, k]
    for i in range(2, -1, -1):
        value = m[i, 3]
        for k in range(i + 1, 3):
            value -= m[i, k] * out[k]
        out[i] = value / m[i, i]
    return True


@kernel
def _plane(
    which: int, span: tuple[int, int], values: _Floats, kinds: _Integers, prior: _Prior
) -> _Plane:
    """A plane through the points of one kind.

    Of ground the height by the distance across; of a face the distance across by the height.
    """
    tolerance, start, slope, free, free_along = prior
    m, out = np.empty((3, 4)), np.array([start, slope, 0.0])
    total, square = 0.0, 0.0
    for number in range(_ROUNDS):
        m[:] = 0.0
        limit = tolerance * _WIDE_ROUNDS[min(number, 2)] * _LIMIT
        total, square = 0.0, 0.0
        for i in range(span[0], span[1]):
            if kinds[i - span[0]] != which:
                continue
            t = values[i, 0]
            x = values[i, 2] if which == _FACE else values[i, 1]
            y = values[i, 1] if which == _FACE else values[i, 2]
            off = y - out[0] - out[1] * x - out[2] * t
            if abs(off) >= limit:
                continue
            weight = (1.0 - (off / limit) ** 2) ** 2
            if off > tolerance and which != _FACE:
                weight *= _ABOVE_WEIGHT
            total += weight
            square += weight * off * off
            row = (1.0, x, t)
            for a in range(3):
                for b in range(3):
                    m[a, b] += weight * row[a] * row[b]
                m[a, 3] += weight * row[a] * y
        m[0, 0] += _LEAST_WEIGHT
        m[0, 3] += _LEAST_WEIGHT * start
        m[1, 1] += (_NOISE_M / free) ** 2
        m[1, 3] += (_NOISE_M / free) ** 2 * slope
        m[2, 2] += (_NOISE_M / free_along) ** 2
        if total <= 0.0 or not _solve(m, out):
            return _Plane(start, slope, 0.0, 0.0, math.nan)
    return _Plane(out[0], out[1], out[2], total, math.sqrt(square / total))


@kernel
def _middle(
    values: _Floats, span: tuple[int, int], across: tuple[float, float], above: float, share: float
) -> float:
    """A quantile of heights above a floor, between distances across; NaN of too few."""
    low, high = across
    heights = np.empty(span[1] - span[0])
    count = 0
    for i in range(span[0], span[1]):
        if low <= values[i, 1] < high and values[i, 2] > above:
            heights[count] = values[i, 2]
            count += 1
    if count < _LEAST_POINTS:
        return math.nan
    return float(np.sort(heights[:count])[int(share * (count - 1))])


@kernel
def _sort_into(
    span: tuple[int, int], values: _Floats, edge: _Floats, planes: _Floats, kinds: _Integers
) -> None:
    """Which surface each point can be of, by the edges and planes as known by now."""
    lower, upper = edge[_LOWER], edge[_UPPER]
    for i in range(span[0], span[1]):
        t, d, h = values[i, 0], values[i, 1], values[i, 2]
        low = planes[_HEIGHT] + planes[_SLOPE] * d + planes[_SLOPE_ALONG] * t
        high = planes[_TOP_HEIGHT] + planes[_TOP_SLOPE] * d + planes[_TOP_SLOPE_ALONG] * t
        step = max(high - low, 0.0)
        kind = -1
        half = max(_HALF_STEP * step, _LEAST_HALF_M)
        clear = min(max(_CLEAR_SHARE * step, _LEAST_CLEAR_M), _MOST_CLEAR_M)
        if d < lower - _EDGE_M and low - edge[_DEEPER] < h < low + half:
            kind = _LOW
        elif d > upper + _EDGE_M - edge[_BEFORE]:
            below = half if d > upper + _CHAMFER_M else _ON_ARRIS_M
            kind = _HIGH if h > high - min(below, edge[_BELOW]) else -1
        is_beside = lower - edge[_BESIDE] <= d <= upper + edge[_BESIDE]
        if is_beside and low + clear < h < high - _ROUND * step:
            kind = _FACE
        is_near = d > lower - _REACH_M and d < upper + _TOP_M + _TOP_MORE_M
        kinds[i - span[0]] = kind if is_near else -1


@kernel
def _ends(
    span: tuple[int, int], values: _Floats, kinds: _Integers, planes: _Floats
) -> tuple[float, float]:
    """Where carriageway ends and top begins, by the points on them."""
    last, first = -math.inf, math.inf
    for i in range(span[0], span[1]):
        t, d, h = values[i, 0], values[i, 1], values[i, 2]
        low = planes[_HEIGHT] + planes[_SLOPE] * d + planes[_SLOPE_ALONG] * t
        high = planes[_TOP_HEIGHT] + planes[_TOP_SLOPE] * d + planes[_TOP_SLOPE_ALONG] * t
        middle = 0.5 * (low + high)
        if kinds[i - span[0]] == _FACE:
            continue
        if abs(h - low) < _ON_GROUND_M and h < middle and d > last and d < _END_M:
            last = d
        if abs(h - high) < _ON_GROUND_M and h >= middle and d < first and d > -_END_M:
            first = d
    return last, first


@kernel
def _levels(values: _Floats, span: tuple[int, int], start: _Floats) -> tuple[float, float, bool]:
    """Rough heights of carriageway and top, NaN of too few points; whether a gutter lies before."""
    width, is_hidden, step = start[of.WIDTH], start[of.IS_HIDDEN] == of.HIDDEN, start[of.STEP]
    low = _middle(values, span, _BEFORE_M, -math.inf, _LOW_SHARE)
    if math.isnan(low):
        low = _middle(values, span, _BEFORE_MORE_M, -math.inf, _LOW_SHARE)
    is_gutter = low < -_DEEP_M
    if is_gutter:  # between an open gutter and the curb there is some ground
        low = _middle(values, span, _BEFORE_MORE_M, -_DEEP_M, _GUTTER_SHARE)
    high = math.nan
    if is_hidden:
        # Behind a narrow stone the ground may lie as low as before it; the top is no carriageway.
        low = low if low <= _HALF_STEP * step else math.nan
        floor = (0.0 if math.isnan(low) else low) + _RAISED * step
        near, far = width + _BEHIND_HIDDEN_M[0], width + _BEHIND_HIDDEN_M[1]
        high = _middle(values, span, (near, far), floor, _HIDDEN_SHARE)
    if math.isnan(high):
        near, far = width + _BEHIND_M[0], width + _BEHIND_M[1]
        high = _middle(values, span, (near, far), -math.inf, _HIGH_SHARE)
    if math.isnan(high):
        near, far = width + _BEHIND_MORE_M[0], width + _BEHIND_MORE_M[1]
        high = _middle(values, span, (near, far), -math.inf, _HIGH_SHARE)
    return low, high, is_gutter


@kernel
def _station(
    span: tuple[int, int], values: _Floats, start: _Floats, least_tolerance: float, out: _Floats
) -> None:
    """Edges at a station; ``start`` is a row of what is known roughly."""
    is_hidden, tolerance = start[of.IS_HIDDEN] == of.HIDDEN, least_tolerance
    low, high, is_gutter = _levels(values, span, start)
    if math.isnan(high) or (math.isnan(low) and not is_hidden):
        return
    is_shaded = math.isnan(low)  # the carriageway lies in the curb's own shadow
    kinds = np.empty(span[1] - span[0], np.int64)
    planes = np.array([0.0 if is_shaded else low, 0.0, 0.0, high, 0.0, 0.0])
    # At first a hidden top may begin elsewhere; close below a narrow one its other face may be.
    before_m = _ASIDE_M if is_hidden else 0.0
    below_m = _CLOSE_BELOW_M if is_hidden and start[of.IS_EDGING] > 0 else math.inf
    deeper_m = _ON_GROUND_M if is_gutter else math.inf  # its wall is no carriageway
    edge = np.array([0.0, start[of.WIDTH], _FIRST_BESIDE_M, before_m, below_m, deeper_m])
    weights, spread = np.zeros(3), math.nan
    for number in range(_ROUNDS):
        _sort_into(span, values, edge, planes, kinds)
        edge[_BEFORE] = 0.0
        a = _ground(_LOW, span, values, kinds, (tolerance, planes[_HEIGHT]))
        b = _ground(_HIGH, span, values, kinds, (tolerance, planes[_TOP_HEIGHT]))
        if b.weight < _LEAST_TOP or (a.weight < _LEAST_POINTS and not is_hidden):
            return
        if a.weight < _LEAST_POINTS:
            a = _Plane(planes[_HEIGHT], 0.0, 0.0, _UNSEEN, _ROUGH_M)
        planes[:3] = a.value_m, a.slope, a.slope_along
        planes[3:] = b.value_m, b.slope, b.slope_along
        tolerance = max(least_tolerance, min(_NOISY * min(a.off_m, b.off_m), _NOISIEST_M))
        weights[_LOW], weights[_HIGH] = a.weight, b.weight
        out[of.LOW_OFF], out[of.HIGH_OFF] = a.off_m, b.off_m
        _sort_into(span, values, edge, planes, kinds)
        at = 0.5 * (edge[_LOWER] + edge[_UPPER])
        step = b.value_m - a.value_m + (b.slope - a.slope) * at
        middle = a.value_m + a.slope * at + _FACE_MIDDLE * step
        face = _face(span, values, kinds, tolerance, middle)
        weights[_FACE], spread = 0.0 if is_hidden else face.weight, face.off_m
        out[of.AWAY] = _middle_along(span, values, kinds)
        if weights[_FACE] >= _LEAST_FACE:
            foot, top = face.lean * a.value_m, face.lean * b.value_m
            edge[_LOWER] = (face.across_m + foot) / (1.0 - face.lean * a.slope)
            edge[_UPPER] = (face.across_m + top) / (1.0 - face.lean * b.slope)
            edge[_BESIDE] = _FIRST_BESIDE_M if number == 0 else _LATER_BESIDE_M
            out[of.LEAN] = face.lean
        else:
            out[of.LEAN] = math.nan
            if not _without_face(span, values, (kinds, planes, is_hidden), (edge, out)):
                return
    _measure(planes, edge, weights, (tolerance, spread), out)
    out[of.HIGH_POINTS], out[of.LOW_POINTS] = weights[_HIGH], weights[_LOW]


@kernel
def _ground(
    which: int,
    span: tuple[int, int],
    values: _Floats,
    kinds: _Integers,
    known: tuple[float, float],
) -> _Plane:
    """The carriageway or the top; known are the tolerance and a first height, m."""
    tolerance, height = known
    prior = _Prior(tolerance, height, 0.0, _FREE_SLOPE, _FREE_ALONG)
    return _plane(which, span, values, kinds, prior)


@kernel
def _without_face(
    span: tuple[int, int],
    values: _Floats,
    known: tuple[_Integers, _Floats, bool],
    found: tuple[_Floats, _Floats],
) -> bool:
    """Edges where no points lie on the face: at the top's end, or midway between the surfaces."""
    kinds, planes, is_hidden = known
    edge, out = found
    last, first = _ends(span, values, kinds, planes)
    if math.isinf(first) or (math.isinf(last) and not is_hidden):
        return False
    lean = _TYPICAL_LEAN * max(planes[_TOP_HEIGHT] - planes[_HEIGHT], 0.0)
    if is_hidden:
        # The edge lies before the first of the top's points by as much as they lie apart.
        count = 0
        for i in range(span[0], span[1]):
            if kinds[i - span[0]] == _HIGH and values[i, 1] < first + _TOP_M:
                count += 1
        out[of.GAP] = _TOP_M / max(count, 1)
        edge[_UPPER] = first - min(out[of.GAP], _TOP_SPACING_M)
        edge[_LOWER] = edge[_UPPER] - lean
    else:
        middle = 0.5 * (last + first - lean)
        edge[_LOWER] = min(max(middle, -_MOST_ASIDE_M), _MOST_ASIDE_M)
        edge[_UPPER] = edge[_LOWER] + lean
        # Surfaces that overlap tell of an edge that runs askew: its place is known no better.
        out[of.GAP] = abs(first - last)
    return True


@kernel
def _face(
    span: tuple[int, int], values: _Floats, kinds: _Integers, tolerance: float, middle: float
) -> _Face:
    """The face, fitted about the height of its middle."""
    count = 0
    across = np.empty(span[1] - span[0])
    for i in range(span[0], span[1]):
        if kinds[i - span[0]] == _FACE:
            across[count] = values[i, 1]
            values[i, 2] -= middle
            count += 1
    if count < _LEAST_FACE_POINTS:
        plane = _Plane(0.0, 0.0, 0.0, 0.0, math.nan)
    else:
        start = float(np.median(across[:count]))
        prior = _Prior(tolerance, start, _TYPICAL_LEAN, _FREE_LEAN, _FREE_LEAN_ALONG)
        plane = _plane(_FACE, span, values, kinds, prior)
    for i in range(span[0], span[1]):
        if kinds[i - span[0]] == _FACE:
            values[i, 2] += middle
    return _Face(plane.value_m - plane.slope * middle, plane.slope, plane.weight, plane.off_m)


@kernel
def _middle_along(span: tuple[int, int], values: _Floats, kinds: _Integers) -> float:
    """How far ahead of the station the points on the face are on the average, m; 0 of none."""
    total, count = 0.0, 0
    for i in range(span[0], span[1]):
        if kinds[i - span[0]] == _FACE:
            total += values[i, 0]
            count += 1
    return total / max(count, 1)


@kernel
def _measure(
    planes: _Floats, edge: _Floats, weights: _Floats, about: tuple[float, float], out: _Floats
) -> None:
    tolerance, spread = about
    lower, upper = edge[_LOWER], edge[_UPPER]
    out[of.LOWER_ACROSS], out[of.UPPER_ACROSS] = lower, upper
    out[of.LOWER_ABOVE] = planes[_HEIGHT] + planes[_SLOPE] * lower
    out[of.UPPER_ABOVE] = planes[_TOP_HEIGHT] + planes[_TOP_SLOPE] * upper
    step = max(out[of.UPPER_ABOVE] - out[of.LOWER_ABOVE], 0.0)
    out[of.FACE_POINTS] = weights[_FACE]
    out[of.OFF] = spread
    out[of.ERROR_LOW] = math.sqrt(_LEAST_ERROR_M**2 + tolerance**2 / weights[_LOW])
    out[of.ERROR_HIGH] = math.sqrt(_LEAST_ERROR_M**2 + tolerance**2 / weights[_HIGH])
    if weights[_FACE] >= _LEAST_FACE:
        noise = max(tolerance, spread)
        out[of.ERROR_ACROSS] = math.sqrt(_LEAST_ERROR_M**2 + noise**2 / weights[_FACE])
    else:
        out[of.ERROR_ACROSS] = max(_OF_GAP * out[of.GAP], _UNPLACED_M)
    # What is about as low as the surfaces are rough has no edge that could be placed.
    out[of.ERROR_ACROSS] *= 1.0 + (_LOW_STEP * tolerance / max(step, _LEAST_STEP_M)) ** 4
    if weights[_FACE] < _LEAST_FACE:
        out[of.ERROR_ACROSS] = math.hypot(out[of.ERROR_ACROSS], _ENDS_M)


@kernel
def edges_kernel(
    along: _Floats, across_above: _Floats, stations: _Floats, window: of.Window, measures: _Floats
) -> None:
    """Edges at every station of one approximate line.

    Parameters
    ----------
    along : (n,) float64
        Rising, in stations.
    across_above : (n, 2) float64
        m.
    stations : (m, 4) float64
        What is known roughly of each.
    window : of.Window
    measures : (m, of.MEASURES) float64
        Filled with NaN before.
    """
    half, most, enough, _ = window
    first, last = 0, 0
    longer = np.empty(of.MEASURES)
    for k in range(stations.shape[0]):
        while first < along.shape[0] and along[first] < k - most / of.STEP_M:
            first += 1
        last = max(last, first)
        while last < along.shape[0] and along[last] <= k + most / of.STEP_M:
            last += 1
        near, far = first, last
        if last - first > enough * most / half:
            near, far = of.span_about(along, k, half)
        points = (along, across_above)
        _measure_span(points, (near, far), (k, stations[k]), window, measures[k])
        reach = most
        while reach < _LONGEST_M and last - first < enough and not _is_placed(measures[k]):
            reach *= 2.0
            longer[:] = math.nan
            _measure_span(points, of.span_about(along, k, reach), (k, stations[k]), window, longer)
            if not _is_placed(longer):
                # Ends of surfaces tell no direction, as points on a face do.
                askew = _FREE_LEAN_ALONG * (reach - most)
                longer[of.ERROR_ACROSS] = math.hypot(longer[of.ERROR_ACROSS], askew)
            # Beyond a curb's end a long window still sees its face, all of it on one side.
            if _is_placed(longer) and abs(longer[of.AWAY]) > 0.5 * reach:
                continue
            if _is_placed(longer) or (
                stations[k, of.IS_HIDDEN] == of.ASKEW and of.is_surer(longer, measures[k])
            ):
                measures[k] = longer


@kernel
def _is_placed(measures: _Floats) -> bool:
    """Whether enough points lie on a face."""
    return bool(measures[of.FACE_POINTS] >= _LEAST_FACE)


@kernel
def _measure_span(
    points: tuple[_Floats, _Floats],
    span: tuple[int, int],
    station: tuple[int, _Floats],
    window: of.Window,
    out: _Floats,
) -> None:
    """Edges at a station by some of the points about its line."""
    (along, across_above), (near, far), (k, start) = points, span, station
    if far - near < 2 * _LEAST_POINTS:
        return
    stride = max(1, (far - near) // _MOST_POINTS)
    values = np.empty(((far - near + stride - 1) // stride, 3))
    values[:, 0] = (along[near:far:stride] - k) * of.STEP_M
    values[:, 1:] = across_above[near:far:stride]
    if start[of.IS_HIDDEN] != of.ASKEW:
        _station((0, values.shape[0]), values, start, window.tolerance_m, out)
        return
    as_seen, seen = start.copy(), np.full(of.MEASURES, math.nan)
    for view in (of.VISIBLE, of.HIDDEN):
        as_seen[of.IS_HIDDEN] = view
        seen[:] = math.nan
        _station((0, values.shape[0]), values, as_seen, window.tolerance_m, seen)
        # What shows its foot is no hidden face: something else cut its top off.
        is_shadowed = not out[of.LOW_POINTS] >= _LEAST_POINTS
        if view == of.VISIBLE or (is_shadowed and of.is_surer(seen, out)):
            out[:] = seen
        if _is_placed(out):
            return


def warm_up() -> None:
    """Compile the kernel."""
    across = np.random.default_rng(0).uniform(-0.3, 0.3, 200)
    position = np.column_stack([across, np.where(across > 0, 0.15, 0.0)])
    edges_kernel(
        np.linspace(0, 2, 200),
        position,
        np.zeros((3, 4)),
        of.Window(0.25, 0.5, 50.0, 0.005),
        np.full((3, of.MEASURES), np.nan),
    )
