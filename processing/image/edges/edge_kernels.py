"""Loops over the cross-section of a piece of surface: where it bends, and which way it runs.

Points around a place are looked at along an edge: *along* it a (horizontal), *across* it u (to the
left), and their height v less the grade of the edge, so the points of several rows fall on one
profile. A profile is cut into straight pieces; where two meet, their crossing is the edge.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel

ACROSS, HEIGHT, BEND, STRENGTH, BEFORE, AFTER, ORDER = range(7)
"""Columns of a corner: its place in the section, m; the bend, rad, positive where the surface is
hollow; the strength, m; directions of the pieces before and after it, rad; 1 where the profile
rises to the left of the direction of the edge, −1 where it falls."""

CORNER_COLUMNS = 7
MOST_CORNERS = 16
"""Of a profile: far more than a curb with its gutter has."""

_MEAN_U, _MEAN_V, _ANGLE, _LENGTH, _SPREAD, _NUMBER, _FIRST, _LAST, _MEAN_A, _MEAN_AA = range(10)
"""Columns of a piece: middle, m; direction, rad; length, RMS off it, m; points; first and last of
them along it, m; mean place along the edge and its mean square, m, m²."""

_PIECE_COLUMNS = 10

_HEADING, _GRADE, _CURVATURE = range(3)
"""Of a frame: rad, rise per metre, 1/m."""

_N, _U, _V, _UU, _UV, _VV = range(6)
_SUMS = 6
"""Sums over points of 1, u, v, u², uv, v²."""

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_MOST_PIECES, _FEWEST_POINTS, _MOST_BINS = 24, 8, 200
"""Of a profile: more pieces than one can have corners; fewer points are no two pieces; bins that
bound the time, which grows with their square."""

_PIECE_PRICE = 10.0
"""What a piece costs, in squares of the noise: about ln(points) for each of its three unknowns (two
of a line and where it ends), as in Schwarz' criterion (1978)."""

_LEAST_BEND = math.radians(15.0)
"""Less is unevenness of a surface: slopes of ramps are below it. By trial."""

_LEAST_JUMP, _STEEPEST_JUMP = 3.0, 3.0
"""Height of a jump between two surfaces in noises; and how many times as wide as high it may be: a
gap that wide may as well be missing points. By trial."""

_SIGNIFICANT, _OF_SPAN = 4.0, 12.0
"""A crossing must be off the straight by so many standard deviations of where a piece ends that so
few points show; evenly spread over a length they scatter by that length / √12."""

_SHORTEST_M = 0.008
"""Two spacings of near points: a shorter piece has no direction."""

_ROUNDING_M = 0.035
"""A piece this short between two bends of one sign is a rounded edge: arrises of kerb stones have
radii of 2 to 3 cm."""

LONGEST_ARM_M = 0.10
"""No edge counts as stronger: what is farther away doesn't matter to it."""

_STEEP_SINE, _STEEP_COSINE = math.sin(math.radians(65.0)), math.cos(math.radians(65.0))
_STEEPEST_COSINE = math.cos(math.radians(130.0))
"""No piece runs steeper than 65° against the order of the profile; upright and level are at 45°, so
that faces leaning 20° backwards are still found. Directions count double in a scatter matrix."""

_LEAST_ALONG = 0.2
"""Standard deviation of a piece's points along the edge, in half lengths; evenly spread they have
0.58, one row hardly any: a surface is seen by several rows."""

_LEAST_OF_PIECE, _ROUGHEST = 3, 2.5
"""Points of a surface: three, that it has a spread; rougher pieces, in noises, are plants. By
trial."""

_COARSENESS = (6.0, 3.0, 1.5, 1.0, 1.0)
"""Noise is taken so many times as large at first, so that a slightly wrong frame doesn't break the
profile to splinters."""

_FEWEST_TO_TURN = 6
"""Points of a piece that may turn the frame."""

_SURE = (0.1, 0.1, 0.1)
"""How well heading, grade and curvature are known before, rad, 1, 1/m: 6°, 10 %, a radius of 10 m.
Nor does one step change them by more. By trial."""

_ON_PIECE, _FAR = 4.0, 2.0
"""Points within so many noises are of a piece; at the second a point weighs half (Cauchy)."""

_LEAST_SINE = 0.1
"""Of the angle of two pieces: flatter ones cross anywhere."""

_BEYOND_M, _BEYOND_SHARE = 0.03, 0.3
"""Two pieces may cross so far beyond their ends, m and a share of their lengths: the spacing of
points, not a missing surface. By trial."""


class SectionLimits(NamedTuple):
    """What is looked at about a place.

    Attributes
    ----------
    along_m, across_m, height_m : float
        Half length along the edge and across it, half height.
    noise_m : float
    order : int
        Of the profile: 1 rising, −1 falling, 0 whichever fits better.
    """

    along_m: float
    across_m: float
    height_m: float
    noise_m: float
    order: int


@kernel
def corners_kernel(
    local: Floats, limits: SectionLimits, frame: Floats, corners: Floats
) -> tuple[int, float, float]:
    """Corners of the profile of points about a place.

    Parameters
    ----------
    local : (n, 3)
        m, about the place.
    limits : SectionLimits
    frame : (3,)
        Heading of the edge, rad, counter-clockwise from the first axis; its grade; its curvature,
        1/m, left positive; made better.
    corners : (MOST_CORNERS, CORNER_COLUMNS)

    Returns
    -------
    tuple of int, float, float
        Number of corners; price of the profile per point, in squares of the noise; how far the
        points of its largest piece lie off it, m.
    """
    profile = np.empty((local.shape[0], 3))
    pieces = np.empty((_MOST_PIECES, _PIECE_COLUMNS))
    best_pieces = np.empty((_MOST_PIECES, _PIECE_COLUMNS))
    found, least, order, number = 0, math.inf, 0, 0
    for turn in range(len(_COARSENESS)):
        # Coarse first, so that a slightly wrong frame doesn't break the profile to splinters.
        noise = limits.noise_m * _COARSENESS[turn]
        number = _project(local, limits, frame, profile)
        if number < _FEWEST_POINTS:
            return 0, math.inf, math.inf
        least = math.inf
        for candidate in (1, -1):
            if limits.order not in (0, candidate):
                continue
            count, cost = _cut(profile[:number], candidate, noise, pieces)
            if cost < least:
                least, found, wanted_order = cost, count, candidate
                best_pieces[:] = pieces
        order = wanted_order
        if turn < len(_COARSENESS) - 1:
            _turn_frame(profile[:number], noise, best_pieces[:found], frame)
    count = _corners_of(best_pieces[:found], order, noise, limits.along_m, corners)
    largest = int(best_pieces[:found, _NUMBER].argmax())
    return count, least / number, best_pieces[largest, _SPREAD]


@kernel
def _project(local: Floats, limits: SectionLimits, frame: Floats, profile: Floats) -> int:
    cos, sin, grade = math.cos(frame[_HEADING]), math.sin(frame[_HEADING]), frame[_GRADE]
    number = 0
    for i in range(local.shape[0]):
        a = local[i, 0] * cos + local[i, 1] * sin
        u = local[i, 1] * cos - local[i, 0] * sin
        u -= frame[_CURVATURE] * a * a / 2
        v = local[i, 2] - grade * a
        is_level = abs(v) <= limits.height_m
        if abs(a) <= limits.along_m and abs(u) <= limits.across_m and is_level:
            profile[number, 0] = u
            profile[number, 1] = v
            profile[number, 2] = a
            number += 1
    return number


@kernel
def _add(sums: Floats, u: float, v: float) -> None:
    sums[_N] += 1
    sums[_U] += u
    sums[_V] += v
    sums[_UU] += u * u
    sums[_UV] += u * v
    sums[_VV] += v * v


@kernel
def _least_squares(sums: Floats, order: int) -> float:
    """Sum of squared distances from the best line that doesn't run across the profile's order."""
    n = sums[_N]
    uu = sums[_UU] - sums[_U] * sums[_U] / n
    uv = sums[_UV] - sums[_U] * sums[_V] / n
    vv = sums[_VV] - sums[_V] * sums[_V] / n
    # Turned by 45°: along the order of the profile, and square to it.
    total, difference, sw = uu + vv, 2 * order * uv, order * (vv - uu) / 2
    root = math.sqrt(difference * difference + 4 * sw * sw)
    if difference >= _STEEPEST_COSINE * root:
        return float(max(0.0, (total - root) / 2))
    along, square = (total + difference) / 2, (total - difference) / 2
    least = along * _STEEP_SINE**2 + square * _STEEP_COSINE**2
    return float(max(0.0, least - 2 * abs(sw) * _STEEP_SINE * _STEEP_COSINE))


@kernel
def _cut(profile: Floats, order: int, noise: float, pieces: Floats) -> tuple[int, float]:
    """The cheapest cut of a profile into straight pieces; gives their number and the price.

    Points are sorted by u + v where the profile rises (u − v where it falls): along any profile
    that doesn't turn back by more than 45° this is their order, upright faces included.
    """
    starts = np.empty(_MOST_BINS + 1, np.int64)
    by_order = np.argsort(profile[:, 0] + order * profile[:, 1])
    bins = _bins_of(profile, by_order, order, noise, starts)
    sums = np.zeros((bins + 1, _SUMS))
    for k in range(bins):
        sums[k + 1] = sums[k]
        for i in range(starts[k], starts[k + 1]):
            point = by_order[i]
            _add(sums[k + 1], profile[point, 0], profile[point, 1])
    cut = np.empty(bins + 1, np.int64)
    price = _cheapest(sums, order, noise, cut)
    count, end = 0, bins
    while end > 0:
        count, end = count + 1, cut[end]
    kept, end = min(count, _MOST_PIECES), bins
    for k in range(count - 1, -1, -1):
        if k < kept:
            chosen = by_order[starts[cut[end]] : starts[end]]
            _describe(profile, chosen, order, pieces[k])
        end = cut[end]
    return kept, price


@kernel
def _cheapest(sums: Floats, order: int, noise: float, cut: NDArray[np.int64]) -> float:
    """Where the last piece of the cheapest cut of the first bins begins; the price of them all."""
    price = np.full(cut.size, math.inf)
    price[0] = 0.0
    between = np.empty(_SUMS)
    for end in range(1, cut.size):
        for start in range(end - 1, -1, -1):
            if price[start] + _PIECE_PRICE >= price[end]:
                continue
            for j in range(_SUMS):
                between[j] = sums[end, j] - sums[start, j]
            squares = _least_squares(between, order) / (noise * noise)
            if price[start] + _PIECE_PRICE + squares < price[end]:
                price[end], cut[end] = price[start] + _PIECE_PRICE + squares, start
    return float(price[-1])


@kernel
def _bins_of(
    profile: Floats,
    by_order: NDArray[np.int64],
    order: int,
    noise: float,
    starts: NDArray[np.int64],
) -> int:
    """First points of the filled bins along a sorted profile."""
    first, last = by_order[0], by_order[-1]
    low = profile[first, 0] + order * profile[first, 1]
    high = profile[last, 0] + order * profile[last, 1]
    size = max(noise, (high - low) / (_MOST_BINS - 1))
    bins, before = 0, -1
    for i in range(by_order.size):
        s = profile[by_order[i], 0] + order * profile[by_order[i], 1]
        position = int((s - low) / size)
        if position != before:
            starts[bins] = i
            bins, before = bins + 1, position
    starts[bins] = by_order.size
    return bins


@kernel
def _describe(profile: Floats, chosen: NDArray[np.int64], order: int, piece: Floats) -> None:
    sums = np.zeros(_SUMS)
    mean_a, mean_aa = 0.0, 0.0
    for i in chosen:
        _add(sums, profile[i, 0], profile[i, 1])
        mean_a += profile[i, 2]
        mean_aa += profile[i, 2] ** 2
    n = sums[_N]
    mean_u, mean_v = sums[_U] / n, sums[_V] / n
    uu, vv = sums[_UU] / n - mean_u**2, sums[_VV] / n - mean_v**2
    uv = sums[_UV] / n - mean_u * mean_v
    angle = 0.5 * math.atan2(2 * uv, uu - vv)
    if math.cos(angle) + order * math.sin(angle) < 0:
        angle += math.pi if angle < 0 else -math.pi
    first, last = math.inf, -math.inf
    cos, sin = math.cos(angle), math.sin(angle)
    for i in chosen:
        along = (profile[i, 0] - mean_u) * cos + (profile[i, 1] - mean_v) * sin
        first, last = min(first, along), max(last, along)
    piece[_MEAN_U], piece[_MEAN_V], piece[_ANGLE] = mean_u, mean_v, angle
    piece[_LENGTH], piece[_NUMBER] = last - first, n
    piece[_FIRST], piece[_LAST], piece[_MEAN_A] = first, last, mean_a / n
    piece[_MEAN_AA] = mean_aa / n
    piece[_SPREAD] = math.sqrt(_least_squares(sums, order) / n)


@kernel
def _turn_frame(profile: Floats, noise: float, pieces: Floats, frame: Floats) -> None:
    """One Gauss-Newton step: what is left of the distances along the edge turns the frame."""
    matrix = np.zeros((3, 3))
    right = np.zeros(3)
    lever = np.empty(3)
    for j in range(3):
        matrix[j, j] = (noise / _SURE[j]) ** 2
    right[_CURVATURE] = -matrix[_CURVATURE, _CURVATURE] * frame[_CURVATURE]
    for i in range(profile.shape[0]):
        nearest, distance, lever_u, lever_v = -1, _ON_PIECE * noise, 0.0, 0.0
        for k in range(pieces.shape[0]):
            if pieces[k, _NUMBER] < _FEWEST_TO_TURN:
                continue
            cos, sin = math.cos(pieces[k, _ANGLE]), math.sin(pieces[k, _ANGLE])
            u, v = profile[i, 0] - pieces[k, _MEAN_U], profile[i, 1] - pieces[k, _MEAN_V]
            along, off = u * cos + v * sin, v * cos - u * sin
            inside = pieces[k, _FIRST] - noise <= along <= pieces[k, _LAST] + noise
            if inside and abs(off) < abs(distance):
                nearest, distance, lever_u, lever_v = k, off, -sin, cos
        if nearest < 0:
            continue
        a, mean_a = profile[i, 2], pieces[nearest, _MEAN_A]
        lever[_HEADING] = lever_u * (a - mean_a)
        lever[_GRADE] = lever_v * (a - mean_a)
        lever[_CURVATURE] = lever_u * (a * a - pieces[nearest, _MEAN_AA]) / 2
        weight = 1 / (1 + (distance / (_FAR * noise)) ** 2)
        for j in range(3):
            right[j] += weight * lever[j] * distance
            for k in range(3):
                matrix[j, k] += weight * lever[j] * lever[k]
    step = np.linalg.solve(matrix, right)
    for j in range(3):
        frame[j] += max(-_SURE[j], min(_SURE[j], step[j]))


@kernel
def _corners_of(pieces: Floats, order: int, noise: float, along: float, corners: Floats) -> int:
    count, k = 0, -1
    last = _next_piece(pieces, -1, noise, along)
    while last >= 0 and count < MOST_CORNERS - 1:
        k = _next_piece(pieces, last, noise, along)
        if k < 0:
            break
        bend = _between(pieces[last, _ANGLE], pieces[k, _ANGLE])
        after = _next_piece(pieces, k, noise, along)
        if after >= 0 and pieces[k, _LENGTH] < _ROUNDING_M:
            second = _between(pieces[k, _ANGLE], pieces[after, _ANGLE])
            both = _between(pieces[last, _ANGLE], pieces[after, _ANGLE])
            if bend * second > 0 and abs(both) >= _LEAST_BEND:
                k, bend = after, both
        if abs(bend) >= _LEAST_BEND:
            count += _crossing(pieces[last], pieces[k], order, corners[count])
        else:
            count += _jump(pieces[last], pieces[k], order, noise, corners[count : count + 2])
        last = k
    return count


@kernel
def _next_piece(pieces: Floats, k: int, noise: float, along: float) -> int:
    """The next piece that is a surface, seen by several rows; −1 after the last."""
    for other in range(k + 1, pieces.shape[0]):
        piece = pieces[other]
        if (
            piece[_NUMBER] >= _LEAST_OF_PIECE
            and piece[_LENGTH] >= _SHORTEST_M
            and piece[_SPREAD] <= _ROUGHEST * noise
            and piece[_MEAN_AA] - piece[_MEAN_A] ** 2 >= (_LEAST_ALONG * along) ** 2
        ):
            return other
    return -1


@kernel
def _between(before: float, after: float) -> float:
    turned = after - before
    return turned - 2 * math.pi * math.floor((turned + math.pi) / (2 * math.pi))


@kernel
def _crossing(before: Floats, after: Floats, order: int, corner: Floats) -> int:
    """The corner where two pieces cross, if they come near it."""
    c1, s1 = math.cos(before[_ANGLE]), math.sin(before[_ANGLE])
    c2, s2 = math.cos(after[_ANGLE]), math.sin(after[_ANGLE])
    du, dv = after[_MEAN_U] - before[_MEAN_U], after[_MEAN_V] - before[_MEAN_V]
    sine = c1 * s2 - s1 * c2
    if abs(sine) < _LEAST_SINE:
        return 0
    along = (du * s2 - dv * c2) / sine
    back = (du * s1 - dv * c1) / sine
    # Beyond a piece's end there may be the spacing of the points, not a missing surface.
    reach_before = before[_LAST] + _BEYOND_M + _BEYOND_SHARE * before[_LENGTH]
    reach_after = after[_FIRST] - _BEYOND_M - _BEYOND_SHARE * after[_LENGTH]
    if along > reach_before or back < reach_after:
        return 0
    short, long = (before, after) if before[_LENGTH] < after[_LENGTH] else (after, before)
    unsure = long[_SPREAD] * math.sqrt(_OF_SPAN / short[_NUMBER])
    if abs(sine) * short[_LENGTH] < _SIGNIFICANT * unsure:
        return 0
    arm = min(min(before[_LENGTH], after[_LENGTH]), LONGEST_ARM_M)
    if arm < _ROUNDING_M:
        # The direction of so short a piece is unsure; where it ends isn't.
        if before[_LENGTH] > after[_LENGTH]:
            near = du * c1 + dv * s1 + after[_FIRST] * (c1 * c2 + s1 * s2)
            along = (before[_LAST] + near) / 2
        else:
            near = before[_LAST] * (c1 * c2 + s1 * s2) - du * c2 - dv * s2
            back = (after[_FIRST] + near) / 2
            _store(corner, after[_MEAN_U] + back * c2, after[_MEAN_V] + back * s2, order)
    if arm >= _ROUNDING_M or before[_LENGTH] > after[_LENGTH]:
        _store(corner, before[_MEAN_U] + along * c1, before[_MEAN_V] + along * s1, order)
    corner[BEND] = _between(before[_ANGLE], after[_ANGLE])
    corner[STRENGTH] = abs(sine) * arm if abs(corner[BEND]) < math.pi / 2 else arm
    corner[BEFORE], corner[AFTER] = before[_ANGLE], after[_ANGLE]
    return 1


@kernel
def _jump(before: Floats, after: Floats, order: int, noise: float, corners: Floats) -> int:
    """Two corners where one surface ends and goes on higher or lower, no point on the face."""
    cos, sin = math.cos(before[_ANGLE]), math.sin(before[_ANGLE])
    end_u, end_v = before[_MEAN_U] + before[_LAST] * cos, before[_MEAN_V] + before[_LAST] * sin
    cos, sin = math.cos(after[_ANGLE]), math.sin(after[_ANGLE])
    start_u, start_v = after[_MEAN_U] + after[_FIRST] * cos, after[_MEAN_V] + after[_FIRST] * sin
    height = (end_u - start_u) * sin - (end_v - start_v) * cos
    if abs(height) < _LEAST_JUMP * noise or abs(end_u - start_u) > _STEEPEST_JUMP * abs(height):
        return 0
    if end_u > start_u:
        # The surfaces overlap a little: an upright face between them.
        middle = (end_u + start_u) / 2
        end_v += (middle - end_u) * math.tan(before[_ANGLE])
        start_v += (middle - start_u) * math.tan(after[_ANGLE])
        end_u = start_u = middle
    face = math.atan2(start_v - end_v, start_u - end_u)
    arm = min(abs(height), LONGEST_ARM_M)
    _store(corners[0], end_u, end_v, order)
    _store(corners[1], start_u, start_v, order)
    for k in range(2):
        corners[k, STRENGTH] = arm
    corners[0, BEFORE], corners[0, AFTER] = before[_ANGLE], face
    corners[1, BEFORE], corners[1, AFTER] = face, after[_ANGLE]
    corners[0, BEND] = _between(before[_ANGLE], face)
    corners[1, BEND] = _between(face, after[_ANGLE])
    return 2


@kernel
def _store(corner: Floats, u: float, v: float, order: int) -> None:
    corner[ACROSS], corner[HEIGHT], corner[ORDER] = u, v, order
