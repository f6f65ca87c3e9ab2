"""Loops that lay carriageway, face and top through the points about one station of a curb.

Thesis 6.3 d–f: planes of points within 5 mm, intersected. In the curved frame of the curb (along,
across, above) each plane has three numbers; they are found by robust least squares with weak
knowledge of what curbs are (``_PRIOR``), which takes over where points are few.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

LOWER_ACROSS, LOWER_ABOVE, UPPER_ACROSS, UPPER_ABOVE = range(4)
LEAN, ERROR_ACROSS, ERROR_LOW, ERROR_HIGH = range(4, 8)
FACE_POINTS, LOW_POINTS, HIGH_POINTS, GAP, OFF, LOW_OFF, HIGH_OFF = range(8, 15)
MEASURES = 15
"""Measures of a station: edges in its frame, m; lean of the face (across per m of height); errors
of place and of the two heights, m; how many points each surface has; how wide nothing is seen
between them, m; how far points of face, carriageway and top lie off them, m RMS. NaN where not
measured."""

STEP_M = 0.25
"""Between stations."""

_LOW, _HIGH, _FACE = 0, 1, 2
_REACH_M, _DEEP_M = 0.35, 0.08  # how far and deep carriageway is looked at
_TOP_M = 0.12  # a stone is at least about as wide
_CHAMFER_M = 0.03
_ROUND = 0.32  # of the step, at the top, where an arris may be chamfered or rounded
_TURNS = 5
_LEAST_POINTS = 4
_MOST_POINTS = 400  # more make an edge slower, not better
_LEAST_TOP = 3.0
_UNSEEN, _ROUGH_M = 0.05, 0.005  # a rough line's height is worth so many points
_NOISY, _NOISIEST_M = 1.5, 0.02
_TOP_SPACING_M, _ASIDE_M = 0.03, 0.08
_RAISED = 0.7  # of the rough step: what lies higher is no soil and little of a face
_LEAST_FACE, _TYPICAL_LEAN = 2.5, 0.08


@kernel
def _solve(m: _Floats, out: _Floats) -> bool:
    """Solve three equations (3, 4) by elimination; all pivots are positive by the priors."""
    for i in range(3):
        if m[i, i] <= 1e-12:
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
    which: int, span: tuple[int, int], values: _Floats, kinds: _Integers, scales: _Floats
) -> tuple[float, float, float, float, float]:
    """A plane through the points of one kind: value, its slope, its slope along; weight, RMS.

    Of ground the height by the distance across; of a face the distance across by the height.
    ``scales``: tolerance, first value, typical slope, and the freedom of the slopes.
    """
    tolerance, start, slope, free, free_along = scales
    m, out = np.empty((3, 4)), np.array([start, slope, 0.0])
    noise = 0.005
    total, square = 0.0, 0.0
    for turn in range(_TURNS):
        m[:] = 0.0
        limit = tolerance * (4.0 if turn == 0 else (2.0 if turn == 1 else 1.0)) * 3.0
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
                weight *= 0.5  # grass and litter lie above, nothing below
            total += weight
            square += weight * off * off
            row = (1.0, x, t)
            for a in range(3):
                for b in range(3):
                    m[a, b] += weight * row[a] * row[b]
                m[a, 3] += weight * row[a] * y
        m[0, 0] += 1e-6
        m[0, 3] += 1e-6 * start
        m[1, 1] += (noise / free) ** 2
        m[1, 3] += (noise / free) ** 2 * slope
        m[2, 2] += (noise / free_along) ** 2
        if total <= 0.0 or not _solve(m, out):
            return start, slope, 0.0, 0.0, math.nan
    return out[0], out[1], out[2], total, math.sqrt(square / total)


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
    lower, upper = edge[0], edge[1]
    for i in range(span[0], span[1]):
        t, d, h = values[i, 0], values[i, 1], values[i, 2]
        low = planes[0] + planes[1] * d + planes[2] * t
        high = planes[3] + planes[4] * d + planes[5] * t
        step = max(high - low, 0.0)
        kind = -1
        clear, clear_m = min(max(0.25 * step, 0.006), 0.02), upper + _CHAMFER_M
        if d < lower - 0.01 and h < low + max(0.5 * step, 0.02):
            kind = _LOW
        elif d > upper + 0.01 - edge[3]:
            below = max(0.5 * step, 0.02) if d > clear_m else 0.006
            kind = _HIGH if h > high - min(below, edge[4]) else -1
        if lower - edge[2] <= d <= upper + edge[2] and low + clear < h < high - _ROUND * step:
            kind = _FACE
        kinds[i - span[0]] = kind if d > lower - _REACH_M and d < upper + _TOP_M + 0.03 else -1


@kernel
def _ends(
    span: tuple[int, int], values: _Floats, kinds: _Integers, planes: _Floats
) -> tuple[float, float]:
    """Where carriageway ends and top begins, by the points on them."""
    last, first = -math.inf, math.inf
    for i in range(span[0], span[1]):
        t, d, h = values[i, 0], values[i, 1], values[i, 2]
        low = planes[0] + planes[1] * d + planes[2] * t
        high = planes[3] + planes[4] * d + planes[5] * t
        middle = 0.5 * (low + high)
        if kinds[i - span[0]] == _FACE:
            continue
        if abs(h - low) < 0.015 and h < middle and d > last and d < 0.25:
            last = d
        if abs(h - high) < 0.015 and h >= middle and d < first and d > -0.25:
            first = d
    return last, first


@kernel
def _levels(values: _Floats, span: tuple[int, int], start: _Floats) -> tuple[float, float]:
    """Rough heights of carriageway and top; NaN where there are too few points."""
    width, is_hidden, step = start[0], start[1] > 0.5, start[2]
    low = _middle(values, span, (-0.25, -0.05), -math.inf, 0.4)
    if math.isnan(low):
        low = _middle(values, span, (-0.4, -0.02), -math.inf, 0.4)
    if low < -_DEEP_M:  # between an open gutter and the curb there is some ground
        low = _middle(values, span, (-0.4, -0.02), -_DEEP_M, 0.8)
    high = math.nan
    if is_hidden:
        # Behind a narrow stone the ground may lie as low as before it; the top is no carriageway.
        low = low if low <= 0.5 * step else math.nan
        floor = (0.0 if math.isnan(low) else low) + _RAISED * step
        high = _middle(values, span, (width - 0.06, width + 0.16), floor, 0.6)
    if math.isnan(high):
        high = _middle(values, span, (width + 0.04, width + 0.16), -math.inf, 0.5)
    if math.isnan(high):
        high = _middle(values, span, (width + 0.02, width + 0.3), -math.inf, 0.5)
    return low, high


@kernel
def _station(span: tuple[int, int], values: _Floats, start: _Floats, out: _Floats) -> None:
    """Edges at a station; ``start``: a row as in :func:`edges_kernel`, and the tolerance."""
    width, is_hidden, tolerance = start[0], start[1] > 0.5, start[4]
    low, high = _levels(values, span, start)
    if math.isnan(high) or (math.isnan(low) and not is_hidden):
        return
    is_shaded = math.isnan(low)  # the carriageway lies in the curb's own shadow
    kinds = np.empty(span[1] - span[0], np.int64)
    planes = np.array([0.0 if is_shaded else low, 0.0, 0.0, high, 0.0, 0.0])
    # At first a hidden top may begin elsewhere; close below a narrow one its other face may be.
    aside_m = _ASIDE_M if is_hidden else 0.0
    below_m = 0.02 if is_hidden and start[3] > 0.5 else math.inf
    edge = np.array([0.0, width, 0.12, aside_m, below_m])
    weights, spread = np.zeros(3), math.nan
    for turn in range(_TURNS):
        _sort_into(span, values, edge, planes, kinds)
        edge[3] = 0.0
        a = _plane(_LOW, span, values, kinds, np.array([tolerance, planes[0], 0.0, 0.05, 0.1]))
        b = _plane(_HIGH, span, values, kinds, np.array([tolerance, planes[3], 0.0, 0.05, 0.1]))
        if b[3] < _LEAST_TOP or (a[3] < _LEAST_POINTS and not is_hidden):
            return
        if a[3] < _LEAST_POINTS:
            a = (planes[0], 0.0, 0.0, _UNSEEN, _ROUGH_M)
        planes[:3], planes[3:] = a[:3], b[:3]
        tolerance = max(start[4], min(_NOISY * min(a[4], b[4]), _NOISIEST_M))
        weights[0], weights[1] = a[3], b[3]
        out[LOW_OFF], out[HIGH_OFF] = a[4], b[4]
        _sort_into(span, values, edge, planes, kinds)
        at = 0.5 * (edge[0] + edge[1])
        step = b[0] - a[0] + (b[1] - a[1]) * at
        face = _face(span, values, kinds, np.array([tolerance, a[0] + a[1] * at + 0.4 * step]))
        weights[2], spread = 0.0 if is_hidden else face[2], face[3]
        if weights[2] >= _LEAST_FACE:
            edge[0] = (face[0] + face[1] * a[0]) / (1.0 - face[1] * a[1])
            edge[1] = (face[0] + face[1] * b[0]) / (1.0 - face[1] * b[1])
            edge[2] = 0.12 if turn == 0 else 0.03
            out[LEAN] = face[1]
        else:
            out[LEAN] = math.nan
            if not _without_face(span, values, (kinds, planes, is_hidden), (edge, out)):
                return
    _measure(planes, edge, weights, (tolerance, spread), out)
    out[HIGH_POINTS], out[LOW_POINTS] = weights[1], weights[0]


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
    lean = _TYPICAL_LEAN * max(planes[3] - planes[0], 0.0)
    if is_hidden:
        # The edge lies before the first of the top's points by as much as they lie apart.
        count = 0
        for i in range(span[0], span[1]):
            if kinds[i - span[0]] == _HIGH and values[i, 1] < first + _TOP_M:
                count += 1
        out[GAP] = min(_TOP_M / max(count, 1), _TOP_SPACING_M)
        edge[1] = first - out[GAP]
        edge[0] = edge[1] - lean
    else:
        edge[0] = min(max(0.5 * (last + first - lean), -0.15), 0.15)
        edge[1] = edge[0] + lean
        out[GAP] = max(first - last, 0.0)
    return True


@kernel
def _face(
    span: tuple[int, int], values: _Floats, kinds: _Integers, about: _Floats
) -> tuple[float, float, float, float]:
    """The face: across at height 0, its lean, weight and spread of its points."""
    tolerance, middle = about
    count = 0
    across = np.empty(span[1] - span[0])
    for i in range(span[0], span[1]):
        if kinds[i - span[0]] == _FACE:
            across[count] = values[i, 1]
            values[i, 2] -= middle
            count += 1
    if count < 3:
        position = (0.0, 0.0, 0.0, 0.0, math.nan)
    else:
        start = float(np.median(across[:count]))
        free = 0.15
        position = _plane(
            _FACE, span, values, kinds, np.array([tolerance, start, _TYPICAL_LEAN, free, 0.05])
        )
    for i in range(span[0], span[1]):
        if kinds[i - span[0]] == _FACE:
            values[i, 2] += middle
    return position[0] - position[1] * middle, position[1], position[3], position[4]


@kernel
def _measure(
    planes: _Floats, edge: _Floats, weights: _Floats, about: tuple[float, float], out: _Floats
) -> None:
    tolerance, spread = about
    lower, upper = edge[0], edge[1]
    out[LOWER_ACROSS], out[UPPER_ACROSS] = lower, upper
    out[LOWER_ABOVE] = planes[0] + planes[1] * lower
    out[UPPER_ABOVE] = planes[3] + planes[4] * upper
    step = max(out[UPPER_ABOVE] - out[LOWER_ABOVE], 0.0)
    out[FACE_POINTS] = weights[2]
    out[OFF] = spread
    floor = 0.002
    out[ERROR_LOW] = math.sqrt(floor**2 + tolerance**2 / weights[0])
    out[ERROR_HIGH] = math.sqrt(floor**2 + tolerance**2 / weights[1])
    if weights[2] >= _LEAST_FACE:
        noise = max(tolerance, spread)
        out[ERROR_ACROSS] = math.sqrt(floor**2 + noise**2 / weights[2])
    else:
        out[ERROR_ACROSS] = max(0.29 * out[GAP], 0.01)
    # What is about as low as the surfaces are rough has no edge that could be placed.
    out[ERROR_ACROSS] *= 1.0 + (5.0 * tolerance / max(step, 0.002)) ** 4


@kernel
def edges_kernel(
    along: _Floats, across_above: _Floats, stations: _Floats, settings: _Floats, measures: _Floats
) -> None:
    """Edges at every station of one approximate line.

    Parameters
    ----------
    along : (n,) float64
        Rising, in stations.
    across_above : (n, 2) float64
        m.
    stations : (m, 4) float64
        Rough width of the face, whether it is hidden, rough step, whether it is of an edging.
    settings : (4,) float64
        Half the window, the longest half window, points that are enough in one, tolerance.
    measures : (m, MEASURES) float64
        Filled with NaN before.
    """
    half, most, enough, tolerance = settings
    first, last = 0, 0
    for k in range(stations.shape[0]):
        while first < along.shape[0] and along[first] < k - most / STEP_M:
            first += 1
        last = max(last, first)
        while last < along.shape[0] and along[last] <= k + most / STEP_M:
            last += 1
        near, far = first, last
        if last - first > enough * most / half:
            near = first + np.searchsorted(along[first:last], k - half / STEP_M)
            far = first + np.searchsorted(along[first:last], k + half / STEP_M)
        if far - near < 2 * _LEAST_POINTS:
            continue
        stride = max(1, (far - near) // _MOST_POINTS)
        values = np.empty(((far - near + stride - 1) // stride, 3))
        values[:, 0] = (along[near:far:stride] - k) * STEP_M
        values[:, 1:] = across_above[near:far:stride]
        start = np.append(stations[k], tolerance)
        _station((0, values.shape[0]), values, start, measures[k])


@kernel
def nearest_kernel(
    along: _Floats, across_above: _Floats, wanted: _Floats, within_m: float, nearest: _Integers
) -> None:
    """The point nearest to each of some places, (k, 3) in the same frame; −1 beyond a distance.

    The first column of ``wanted`` rises.
    """
    first = 0
    for k in range(wanted.shape[0]):
        nearest[k] = -1
        least = within_m * within_m
        reach = within_m / STEP_M
        while first < along.shape[0] and along[first] < wanted[k, 0] - reach:
            first += 1
        i = first
        while i < along.shape[0] and along[i] <= wanted[k, 0] + reach:
            away = ((along[i] - wanted[k, 0]) * STEP_M) ** 2
            away += (across_above[i, 0] - wanted[k, 1]) ** 2
            away += (across_above[i, 1] - wanted[k, 2]) ** 2
            if away < least:
                nearest[k], least = i, away
            i += 1


def warm_up() -> None:
    """Compile the kernel."""
    random = np.random.default_rng(0)
    across = random.uniform(-0.3, 0.3, 200)
    position = np.column_stack([across, np.where(across > 0, 0.15, 0.0)])
    measures = np.full((3, MEASURES), np.nan)
    edges_kernel(
        np.linspace(0, 2, 200),
        position,
        np.zeros((3, 4)),
        np.array([0.25, 0.5, 50.0, 0.005]),
        measures,
    )
    nearest_kernel(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 3)), 0.1, np.zeros(1, np.int64))
