"""Steep planes through the points over a cell and its neighbours, by drawing.

A plane is told by its normal in plan (cosine and sine), by how far it lies along that from the
middle of the cell at the ground, and by how far it leans away for each metre it rises.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.walls.wall_cells import FACE_SLABS, LOWEST_M, SLAB_M, WallCellPoints

MOST_LEAN = 0.35
"""Run over rise of the least steep wall: 1 : 0.3 of stone walls and what its unevenness adds; what
rises less steeply is a bank."""

PLANE_FIELDS = 8
"""Of a plane: cosine, sine, offset m, lean, filled slabs, share on it, RMS off it m, middle of its
heights m."""

_UPRIGHT_DRAWS, _LEANING_DRAWS = 24, 40
"""With half of the points on the face, one of 24 draws of two misses it in a thousand cases; with
40 of three, in two hundred."""

_ENOUGH = 0.7
"""Share of points on an upright plane from which no leaning one is looked for."""

_MOST_POINTS = 96
_OF_SLAB = 4.0
"""Points that a slab may say for a plane: dense low slabs must not outvote high ones."""

_FOOT_SLABS, _FOOT_WORTH = 3, 1.6
"""The lowest slabs, 0.15 to 0.75 m, and what they say more: the foot is looked for, and bars on a
low wall stand some centimetres beside its face."""

_ALONE = 0.35
"""What a point says whose last pulse met something else: bars on a low wall must not outvote it."""

_APART_M = 0.15
"""Between two points that tell a direction: nearer ones tell the noise."""

_FEWEST = 8

_FACTOR, _INCREMENT, _MODULUS = 1_664_525, 1_013_904_223, 1 << 32
"""Of the generator of draws (Press et al., Numerical Recipes, 7.1): the same ones each time."""


@kernel
def planes_kernel(
    points: WallCellPoints,
    around: NDArray[np.int32],
    middles: Floats,
    span: tuple[int, int],
    noise_m: float,
    planes: Floats,
) -> None:
    """The likeliest plane over each cell of a span; 0 slabs where there is none.

    Parameters
    ----------
    around : (k, 9) int32
        Numbers of the cells about each, its own among them; −1: none.
    middles : (k, 2) float64
        m about the plan's origin.
    noise_m : float
        How far off a plane a point may lie.
    planes : (k, 8) float64
        Written, see `PLANE_FIELDS`.
    """
    near = np.empty((_MOST_POINTS, 6))
    slab = np.empty(_MOST_POINTS, np.int64)
    sums = np.empty(FACE_SLABS)
    guess, best = np.empty(4), np.empty(4)
    for cell in range(span[0], span[1]):
        count = _gather(points, around[cell], middles[cell], near, slab)
        planes[cell, 4] = 0.0
        if count < _FEWEST:
            continue
        part, own = near[:count], slab[:count]
        score = _upright(part, own, noise_m, sums, guess, best)
        told = _told(part, own, noise_m, best, sums)
        if told[1] < _ENOUGH:
            score = _leaning(part, own, noise_m, sums, guess, best, score)
        if score <= 0.0:
            continue
        for step in range(3):
            # The first time from points a little farther off, as the draw leaves it.
            _straighten(part, own, noise_m * (1.5 if step == 0 else 1.0), best)
        told = _told(part, own, noise_m, best, sums)
        if abs(best[3]) > MOST_LEAN:
            continue
        planes[cell, :4] = best
        planes[cell, 4] = told[0]
        planes[cell, 5] = told[1]
        planes[cell, 6] = told[2]
        planes[cell, 7] = told[3]


@kernel
def _gather(
    points: WallCellPoints,
    around: NDArray[np.int32],
    middle: Floats,
    near: Floats,
    slab: Integers,
) -> int:
    """Points over cells about a middle, evenly thinned.

    In plan, over the ground, and from each to the point before it.
    """
    total = 0
    for number in around:
        if number >= 0:
            total += points.starts[number + 1] - points.starts[number]
    step = max(1, -(-total // _MOST_POINTS))
    count, rank = 0, 0
    for number in around:
        if number < 0:
            continue
        for at in range(points.starts[number], points.starts[number + 1]):
            if rank % step == 0 and count < _MOST_POINTS:
                near[count, 0] = points.local[at, 0] - middle[0]
                near[count, 1] = points.local[at, 1] - middle[1]
                near[count, 2] = points.above[at]
                for axis in range(3):
                    near[count, 3 + axis] = points.before[at, axis]
                slab[count] = min(int((points.above[at] - LOWEST_M) / SLAB_M), FACE_SLABS - 1)
                count += 1
            rank += 1
    return count


@kernel
def _score(near: Floats, slab: Integers, noise_m: float, plane: Floats, sums: Floats) -> float:
    """How much speaks for a plane: of each slab as its points are near, `_OF_SLAB` at most."""
    sums[:] = 0.0
    square = noise_m * noise_m
    for point in range(len(near)):
        off = plane[0] * near[point, 0] + plane[1] * near[point, 1]
        off -= plane[2] + plane[3] * near[point, 2]
        off *= off
        if off < square:
            last = plane[0] * near[point, 3] + plane[1] * near[point, 4]
            last -= plane[3] * near[point, 5]
            # False where the pulse before met nothing: NaN.
            worth = 1.0 if abs(last) <= noise_m else _ALONE
            sums[slab[point]] += worth * (1.0 - off / square)
    score = 0.0
    for number in range(len(sums)):
        score += min(sums[number], _OF_SLAB) * (_FOOT_WORTH if number < _FOOT_SLABS else 1.0)
    return score


@kernel
def _upright(
    near: Floats, slab: Integers, noise_m: float, sums: Floats, guess: Floats, best: Floats
) -> float:
    """The upright plane through two points that most speaks for; what speaks for it."""
    score, state = 0.0, 1
    best[:] = 0.0
    for _ in range(_UPRIGHT_DRAWS):
        state = (state * _FACTOR + _INCREMENT) % _MODULUS
        a = state * len(near) // _MODULUS
        state = (state * _FACTOR + _INCREMENT) % _MODULUS
        b = state * len(near) // _MODULUS
        east, north = near[b, 0] - near[a, 0], near[b, 1] - near[a, 1]
        long = math.hypot(east, north)
        if long < _APART_M:
            continue
        guess[0], guess[1] = -north / long, east / long
        guess[2] = guess[0] * near[a, 0] + guess[1] * near[a, 1]
        guess[3] = 0.0
        here = _score(near, slab, noise_m, guess, sums)
        if here > score:
            score = here
            best[:] = guess
    return score


@kernel
def _leaning(
    near: Floats,
    slab: Integers,
    noise_m: float,
    sums: Floats,
    guess: Floats,
    best: Floats,
    score: float,
) -> float:
    """The plane through three points that more speaks for; what speaks for the best one."""
    state = 7
    for _ in range(_LEANING_DRAWS):
        state = (state * _FACTOR + _INCREMENT) % _MODULUS
        a = state * len(near) // _MODULUS
        state = (state * _FACTOR + _INCREMENT) % _MODULUS
        b = state * len(near) // _MODULUS
        state = (state * _FACTOR + _INCREMENT) % _MODULUS
        c = state * len(near) // _MODULUS
        x1, y1, z1 = near[b, 0] - near[a, 0], near[b, 1] - near[a, 1], near[b, 2] - near[a, 2]
        x2, y2, z2 = near[c, 0] - near[a, 0], near[c, 1] - near[a, 1], near[c, 2] - near[a, 2]
        x, y, z = y1 * z2 - z1 * y2, z1 * x2 - x1 * z2, x1 * y2 - y1 * x2
        flat = math.hypot(x, y)
        # The triangle must be large enough to tell a plane, and the plane steep.
        if flat < _APART_M * _APART_M or abs(z) > MOST_LEAN * flat:
            continue
        guess[0], guess[1] = x / flat, y / flat
        guess[3] = -z / flat
        guess[2] = guess[0] * near[a, 0] + guess[1] * near[a, 1] - guess[3] * near[a, 2]
        here = _score(near, slab, noise_m, guess, sums)
        if here > score:
            score = here
            best[:] = guess
    return score


@kernel
def _straighten(near: Floats, slab: Integers, noise_m: float, plane: Floats) -> None:
    """Least squares through the points on a plane: its offset, turn and lean."""
    normal = np.zeros((3, 3))
    right = np.zeros(3)
    row = np.empty(3)
    lowest, highest = FACE_SLABS, -1
    for point in range(len(near)):
        off = plane[0] * near[point, 0] + plane[1] * near[point, 1]
        if abs(off - plane[2] - plane[3] * near[point, 2]) > noise_m:
            continue
        row[0] = 1.0
        row[1] = plane[0] * near[point, 1] - plane[1] * near[point, 0]
        row[2] = near[point, 2]
        lowest, highest = min(lowest, slab[point]), max(highest, slab[point])
        for i in range(3):
            right[i] += row[i] * off
            for j in range(3):
                normal[i, j] += row[i] * row[j]
    if normal[0, 0] < 3.0:
        return
    # What is seen over less than four slabs tells no lean: it is taken for upright, all but.
    normal[2, 2] += 1e-3 * normal[0, 0] if highest - lowest >= 3 else normal[0, 0]
    normal[1, 1] += 1e-4 * normal[0, 0]
    told = np.linalg.solve(normal, right)
    long = math.hypot(1.0, told[1])
    # off = a + b·t + c·h, with t along the plane: the normal turns by −b.
    cosine = (plane[0] + told[1] * plane[1]) / long
    sine = (plane[1] - told[1] * plane[0]) / long
    plane[0], plane[1] = cosine, sine
    plane[2], plane[3] = told[0] / long, told[2] / long


@kernel
def _told(
    near: Floats, slab: Integers, noise_m: float, plane: Floats, sums: Floats
) -> tuple[float, float, float, float]:
    """Filled slabs, share of the points, RMS off the plane, and middle of the heights."""
    sums[:] = 0.0
    square, high, count, within = 0.0, 0.0, 0, 0
    lowest, highest = FACE_SLABS, -1
    for point in range(len(near)):
        off = plane[0] * near[point, 0] + plane[1] * near[point, 1]
        off -= plane[2] + plane[3] * near[point, 2]
        if abs(off) <= noise_m:
            sums[slab[point]] += 1.0
            lowest, highest = min(lowest, slab[point]), max(highest, slab[point])
            square += off * off
            high += near[point, 2]
            count += 1
    if count < _FEWEST // 2:
        return 0.0, 0.0, 0.0, 0.0
    for point in range(len(near)):
        within += lowest <= slab[point] <= highest
    slabs = 0.0
    for one in sums:
        slabs += 1.0 if one > 0.0 else 0.0
    return slabs, count / within, math.sqrt(square / count), high / count
