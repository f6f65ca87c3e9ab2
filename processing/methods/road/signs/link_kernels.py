"""Loops that link pieces of neighbouring scan lines which lie in one upright plane."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.signs.piece_kernels import (
    BEFORE,
    BEHIND,
    COUNT,
    FIRST,
    FROM,
    GOES_ON,
    PIECE,
    TO,
    VIEW,
)

FLAT_M = 0.02
"""Both ends of a piece lie so near to a plate's plane: noise of centimetres at most, and plates
that were bent; posts stand farther behind it."""

STEEPEST = math.sin(math.radians(20.0))
"""Of a plate's normal: large ones look down by some degrees, worn ones lean by ten and more."""

_SAME_LINE_M = 0.03
"""Two pieces whose lines lie nearer to each other say nothing about a plane."""

_SAME_WAY = math.sin(math.radians(10.0))

_MISSED_TURNS = 3
"""That a plate may lack: leaves and things that pass before it."""

_SPARE_TURNS = 0.6
"""By how many turns more than there are between two lines they may lie apart: plates and directions
are known to some degrees."""

_LEAST_REACH_M, _MOST_REACH_M = 0.1, 0.8
"""Between scan lines on a plate: dense ones, and those of a fast vehicle with a slow mirror."""

_USUAL_REACH_M = 0.35
"""Where a drive doesn't say how fast it went: 100 km/h at 100 turns a second."""

RIM_M = 0.1
"""About the box of a group, in which further pieces of its plate may lie."""

_TRIED = 12
"""Longest pieces of a group, of which each two are tried for its plane."""


@kernel
def link_kernel(
    values: Floats, rows: Integers, is_bright: NDArray[np.bool_], ways: Floats, group: Integers
) -> None:
    """Number groups of linked pieces of one drive.

    Parameters
    ----------
    values : (n, PIECE)
    rows : (n,)
        The turn of each, rising.
    ways : (n, 3)
        What the vehicle went during one turn where each was measured, m; NaN where nobody knows.
    group : (n,)
        Filled: a piece of its group, the same for all of them.
    """
    count = len(rows)
    for piece in range(count):
        group[piece] = piece
    first = 0
    for b in range(count):
        while rows[first] < rows[b] - _MISSED_TURNS:
            first += 1
        for a in range(first, b):
            turns = max(rows[b] - rows[a], 1) + _SPARE_TURNS
            if _are_linked(values, a, b, is_bright, turns * ways[a]):
                one, other = _root(group, a), _root(group, b)
                group[max(one, other)] = min(one, other)
    for piece in range(count):
        group[piece] = _root(group, piece)


@kernel
def _root(group: Integers, piece: int) -> int:
    while group[piece] != piece:
        group[piece] = group[group[piece]]
        piece = group[piece]
    return piece


@kernel
def _are_linked(values: Floats, a: int, b: int, is_bright: NDArray[np.bool_], way: Floats) -> bool:
    """Whether two pieces are near each other and span an upright plane.

    Parameters
    ----------
    way : (3,)
        What the vehicle went between them at most, m.
    """
    most = 0.0
    for axis in range(3):
        middles = abs(
            values[a, FROM + axis] + values[a, TO + axis]
            - values[b, FROM + axis] - values[b, TO + axis]
        ) / 2  # fmt: skip
        most = max(most, middles)
    half = 0.5 * max(_length(values, a), _length(values, b))
    if most > _MOST_REACH_M + half:
        return False
    normal = np.empty(3)
    off, is_same = _plane_of(values, a, b, normal)
    if is_same:
        near = off <= _LEAST_REACH_M and most <= _LEAST_REACH_M + half
        return bool(near and is_bright[a] == is_bright[b])
    if (
        off > _MOST_REACH_M
        or abs(normal[2]) > STEEPEST
        or not _is_flat(values, b, values[a], normal)
    ):
        return False
    view_a, view_b = 0.0, 0.0
    for axis in range(3):
        view_a += values[a, VIEW + axis] * normal[axis]
        view_b += values[b, VIEW + axis] * normal[axis]
    if is_bright[a] != is_bright[b] and view_a * view_b > 0:
        return False
    reach_m = _reach_of(values, a, normal, way)
    return off <= reach_m and most <= reach_m + half


@kernel
def _reach_of(values: Floats, piece: int, normal: Floats, way: Floats) -> float:
    """How far a scan line moves on a plane while the vehicle goes some way, m.

    The plane in which the scanner turned moves by what of the way goes across it, and its trace on
    a plane that it meets askew by so much more.
    """
    if math.isnan(way[0]):
        return _USUAL_REACH_M
    long_m = max(_length(values, piece), 1e-9)
    size, across, both = 0.0, 0.0, 0.0
    for axis in range(3):
        p, q = (axis + 1) % 3, (axis + 2) % 3
        turned = (
            values[piece, VIEW + p] * (values[piece, TO + q] - values[piece, FROM + q])
            - values[piece, VIEW + q] * (values[piece, TO + p] - values[piece, FROM + p])
        ) / long_m
        size += turned * turned
        across += turned * way[axis]
        both += turned * normal[axis]
    size = max(size, 1e-12)
    askew = math.sqrt(max(1.0 - both * both / size, 1e-6))
    return min(max(abs(across) / math.sqrt(size) / askew, _LEAST_REACH_M), _MOST_REACH_M)


@kernel
def _length(values: Floats, piece: int) -> float:
    long = 0.0
    for axis in range(3):
        long += (values[piece, TO + axis] - values[piece, FROM + axis]) ** 2
    return math.sqrt(long)


@kernel
def _is_flat(values: Floats, piece: int, base: Floats, normal: Floats) -> bool:
    """Whether both ends of a piece lie in the plane through the middle of another one."""
    start, end = 0.0, 0.0
    for axis in range(3):
        middle = (base[FROM + axis] + base[TO + axis]) / 2
        start += (values[piece, FROM + axis] - middle) * normal[axis]
        end += (values[piece, TO + axis] - middle) * normal[axis]
    return abs(start) <= FLAT_M and abs(end) <= FLAT_M


@kernel
def _plane_of(values: Floats, a: int, b: int, normal: Floats) -> tuple[float, bool]:
    """The normal of the plane of two pieces, how far their lines are apart, whether they are one.

    Where their lines meet their directions span it, else one direction and what lies between.
    """
    long_a, long_b = max(_length(values, a), 1e-9), max(_length(values, b), 1e-9)
    one, other, between = np.empty(3), np.empty(3), np.empty(3)
    dot = 0.0
    for axis in range(3):
        one[axis] = (values[a, TO + axis] - values[a, FROM + axis]) / long_a
        other[axis] = (values[b, TO + axis] - values[b, FROM + axis]) / long_b
        between[axis] = (
            values[b, FROM + axis] + values[b, TO + axis]
            - values[a, FROM + axis] - values[a, TO + axis]
        ) / 2  # fmt: skip
        dot += between[axis] * one[axis]
    off = 0.0
    for axis in range(3):
        between[axis] -= dot * one[axis]
        off += between[axis] ** 2
    off = math.sqrt(off)
    if off < _SAME_LINE_M:
        between[:] = other
    size = 0.0
    for axis in range(3):
        p, q = (axis + 1) % 3, (axis + 2) % 3
        normal[axis] = one[p] * between[q] - one[q] * between[p]
        size += normal[axis] ** 2
    size = math.sqrt(size)
    is_same = off < _SAME_LINE_M and size < _SAME_WAY
    for axis in range(3):
        normal[axis] /= max(size, 1e-9)
    return off, is_same


@kernel
def plane_kernel(values: Floats, members: Integers, chosen: NDArray[np.bool_]) -> float:
    """Choose the pieces in the upright plane of two of them that holds the most points.

    Parameters
    ----------
    members : (k,)
        Pieces of a group, those with the most points first.
    chosen : (k,)
        Filled.

    Returns
    -------
    float
        The points of those that were chosen; 0: no two pieces span an upright plane.
    """
    most = 0.0
    normal, best = np.empty(3), np.zeros(3)
    base = -1
    tried = min(len(members), _TRIED)
    for first in range(tried):
        for second in range(first + 1, tried):
            a, b = members[first], members[second]
            _, is_same = _plane_of(values, a, b, normal)
            if is_same or abs(normal[2]) > STEEPEST:
                continue
            points, pieces = 0.0, 0
            for k in range(len(members)):
                if _is_flat(values, members[k], values[a], normal):
                    points += values[members[k], COUNT]
                    pieces += 1
            if points > most and pieces > 1:
                most, base = points, a
                best[:] = normal
    for k in range(len(members)):
        chosen[k] = base >= 0 and _is_flat(values, members[k], values[base], best)
    return most


PLANE_MIDDLE, PLANE_RIGHT, PLANE_UP, PLANE_NORMAL, PLANE_NOISE, PLANE_LOW, PLANE_HIGH = (
    0, 3, 6, 9, 12, 13, 15,
)  # fmt: skip
"""Where each begins among what is told of a plane: its middle, its axes as the scanner saw it, how
far its pieces lie off it, and their box, right and up of the middle."""

PLANE_WIDTH = 17


@kernel
def turns_kernel(
    values: Floats, met_by: tuple[Integers, Integers], members: Integers, plane: Floats
) -> tuple[int, float, float]:
    """How many turns met a plane's pieces, on what share of them nothing goes on at either end.

    And the mean length that they draw on the plane, over that of its box along their way.

    Parameters
    ----------
    met_by : tuple of (n,) int64
        Drive and row of each piece.
    """
    key = np.empty(members.size, np.int64)
    rows = met_by[1][members].max() + 1
    for member in range(members.size):
        key[member] = met_by[0][members[member]] * rows + met_by[1][members[member]]
    order = np.argsort(values[members, FIRST], kind="mergesort")
    order = order[np.argsort(key[order], kind="mergesort")]
    along, drawn = np.zeros(2), np.zeros(2)
    turns, clear, drawn_m, begin = 0, 0, 0.0, 0
    for end in range(1, members.size + 1):
        if end < members.size and key[order[end]] == key[order[begin]]:
            continue
        first, last = members[order[begin]], members[order[end - 1]]
        clear += values[first, BEFORE] != GOES_ON and values[last, BEHIND] != GOES_ON
        for axis in range(2):
            way = plane[PLANE_RIGHT + 3 * axis : PLANE_RIGHT + 3 * axis + 3]
            ends = np.zeros(2)
            for i in range(3):
                ends[0] += (values[first, FROM + i] - plane[PLANE_MIDDLE + i]) * way[i]
                ends[1] += (values[last, TO + i] - plane[PLANE_MIDDLE + i]) * way[i]
            drawn[axis] = ends[1] - ends[0]
        turns, begin = turns + 1, end
        drawn_m += math.sqrt(drawn[0] ** 2 + drawn[1] ** 2)
        along += drawn * (-1.0 if drawn[1] < 0 else 1.0)
    size = plane[PLANE_HIGH : PLANE_HIGH + 2] - plane[PLANE_LOW : PLANE_LOW + 2]
    whole = abs(along[0]) * size[0] + abs(along[1]) * size[1]
    whole /= max(math.sqrt(along[0] ** 2 + along[1] ** 2), 1e-9)
    return turns, clear / turns, drawn_m / turns / max(whole, 1e-9)


@kernel
def flat_kernel(values: Floats, members: Integers, told: Floats) -> bool:
    """The plane of pieces by least squares; whether it is upright.

    Parameters
    ----------
    values : (n, PIECE) float64
        Of pieces.
    members : (k,) int64
        Those that are asked.
    told : (PLANE_WIDTH,) float64
        Written.
    """
    middle, total = np.zeros(3), 0.0
    for member in members:
        total += 2 * values[member, COUNT]
        for axis in range(3):
            both = values[member, FROM + axis] + values[member, TO + axis]
            middle[axis] += values[member, COUNT] * both
    middle /= total
    spread, seen = np.zeros((3, 3)), np.zeros(3)
    for member in members:
        seen += values[member, VIEW : VIEW + 3] * values[member, COUNT]
        for side in (FROM, TO):
            off = values[member, side : side + 3] - middle
            for i in range(3):
                for j in range(3):
                    spread[i, j] += values[member, COUNT] / total * off[i] * off[j]
    normal = np.ascontiguousarray(np.linalg.eigh(spread)[1][:, 0])
    if abs(normal[2]) > STEEPEST:
        return False
    if (seen * normal).sum() > 0:
        normal = -normal
    right = np.array([-normal[1], normal[0], 0.0]) / math.hypot(normal[0], normal[1])
    up = np.array([-normal[2] * right[1], normal[2] * right[0], 0.0])
    up[2] = normal[0] * right[1] - normal[1] * right[0]
    told[PLANE_MIDDLE:PLANE_RIGHT], told[PLANE_RIGHT:PLANE_UP] = middle, right
    told[PLANE_UP:PLANE_NORMAL], told[PLANE_NORMAL:PLANE_NOISE] = up, normal
    _box(values, members, told)
    return True


@kernel
def _box(values: Floats, members: Integers, told: Floats) -> None:
    """Tell how far pieces lie off a plane, and their box in it."""
    middle = told[PLANE_MIDDLE:PLANE_RIGHT]
    right, up = told[PLANE_RIGHT:PLANE_UP], told[PLANE_UP:PLANE_NORMAL]
    normal = told[PLANE_NORMAL:PLANE_NOISE]
    told[PLANE_LOW:PLANE_HIGH], told[PLANE_HIGH:PLANE_WIDTH] = np.inf, -np.inf
    squares, total = 0.0, 0.0
    for member in members:
        for side in (FROM, TO):
            off = values[member, side : side + 3] - middle
            squares += values[member, COUNT] * (off * normal).sum() ** 2
            total += values[member, COUNT]
            flat = (off * right).sum(), (off * up).sum()
            for axis in range(2):
                told[PLANE_LOW + axis] = min(told[PLANE_LOW + axis], flat[axis])
                told[PLANE_HIGH + axis] = max(told[PLANE_HIGH + axis], flat[axis])
    told[PLANE_NOISE] = math.sqrt(squares / total)


@kernel
def complete_kernel(
    values: Floats,
    near: Integers,
    members: Integers,
    plane: Floats,
    is_bright: NDArray[np.bool_],
    is_own: NDArray[np.bool_],
    chosen: Integers,
) -> int:
    """Choose the pieces that lie in the box and the plane of a group and are as bright as it.

    Parameters
    ----------
    near : (n,) int64
        Pieces near the group.
    members : (k,) int64
        Those of the group.
    plane : (PLANE_WIDTH,) float64
    is_own : (m,) bool
        Of all pieces; false before and after.
    chosen : (n,) int64
        Filled with their numbers.

    Returns
    -------
    int
        How many were chosen.
    """
    points, brights = np.zeros(2), np.zeros(2)
    for member in members:
        is_own[member] = True
        side = _side_of(values, member, plane)
        if side >= 0:
            points[side] += values[member, COUNT]
            brights[side] += values[member, COUNT] * is_bright[member]
    count = 0
    for piece in near:
        if is_own[piece] or not _is_in_box(values, piece, plane):
            continue
        side = _side_of(values, piece, plane)
        is_seen = side >= 0 and points[side] > 0.0
        if is_seen and is_bright[piece] != (brights[side] / points[side] > 0.5):
            continue
        chosen[count] = piece
        count += 1
    for member in members:
        is_own[member] = False
    return count


@kernel
def _side_of(values: Floats, piece: int, plane: Floats) -> int:
    """From which side of a plane a piece was seen: 0, 1; -1 along it."""
    towards = 0.0
    for axis in range(3):
        towards += values[piece, VIEW + axis] * plane[PLANE_NORMAL + axis]
    return -1 if towards == 0.0 else int(towards > 0.0)


@kernel
def _is_in_box(values: Floats, piece: int, plane: Floats) -> bool:
    """Whether both ends of a piece lie in a plane, and in its box and a rim about it."""
    for side in (FROM, TO):
        off, right, up = 0.0, 0.0, 0.0
        for axis in range(3):
            away = values[piece, side + axis] - plane[PLANE_MIDDLE + axis]
            off += away * plane[PLANE_NORMAL + axis]
            right += away * plane[PLANE_RIGHT + axis]
            up += away * plane[PLANE_UP + axis]
        if abs(off) > FLAT_M:
            return False
        if right < plane[PLANE_LOW] - RIM_M or right > plane[PLANE_HIGH] + RIM_M:
            return False
        if up < plane[PLANE_LOW + 1] - RIM_M or up > plane[PLANE_HIGH + 1] + RIM_M:
            return False
    return True


def warm_up() -> None:
    """Compile the kernels."""
    values, rows = np.zeros((2, PIECE)), np.zeros(2, np.int64)
    link_kernel(values, rows, np.zeros(2, np.bool_), np.zeros((2, 3)), np.zeros(2, np.int64))
    plane_kernel(values, np.arange(2), np.zeros(2, np.bool_))
    values[:, COUNT], values[1, TO], values[1, TO + 2] = 1.0, 1.0, 1.0
    plane, one = np.zeros(PLANE_WIDTH), np.zeros(2, np.int64)
    flat_kernel(values, rows, plane)
    complete_kernel(values, rows, rows, plane, np.zeros(2, np.bool_), np.zeros(2, np.bool_), one)
