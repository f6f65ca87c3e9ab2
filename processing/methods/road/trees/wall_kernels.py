"""Straight rows of points in a level slab: walls, fences and the rails of stakes, left out of it.

Of what lies about a trunk before a wall most is the wall. Circles that touch it hold more points
than the trunk does, and take the trunk's for their inside.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

_DRAWS = 60
"""Of two points each: with a quarter of the points on the row one of these is good in all but one
case in fifty."""

_MOST_ROWS = 3
"""In a slab: two walls that meet and a rail before them."""

_LONG_M = 0.5
"""What is straight for so long is no trunk: within 12 mm of a line lie 0.34 m of a trunk of
1.2 m."""

_GAP_M = 0.1
"""Between neighbours along a row."""

_FEWEST = 8
"""Points of a row."""

_FACTOR, _MODULUS = 1_664_525, 1 << 32
"""Of the generator of draws (Press et al., Numerical Recipes, 7.1): the same ones each time."""


@kernel
def rows_kernel(plan: Floats, noise_m: float, step: int, is_row: NDArray[np.bool_]) -> None:
    """Mark the points of a slab that lie in straight rows.

    Parameters
    ----------
    plan : (n, 2) float64
        Points of one slab in plan, m.
    noise_m : float
        How far off the row a point may lie.
    step : int
        Rows are looked for among every so many-th point.
    is_row : (n,) bool
        Written.
    """
    along = np.empty(len(plan))
    for _ in range(_MOST_ROWS):
        left = np.flatnonzero(~is_row)[::step]
        if left.size < _FEWEST:
            return
        first, second = _likeliest_row(plan, left, noise_m)
        if first < 0:
            return
        if not _mark(plan, (first, second), noise_m, along, is_row):
            return


@kernel
def without_rows_kernel(
    plan: Floats,
    spans: Integers,
    noise_m: float,
    most: int,
    members: Integers,
    starts: Integers,
) -> None:
    """Points of slabs that lie in no straight row; of thousands in a slab a few hundred.

    Parameters
    ----------
    plan : (n, 2) float64
        Points in plan, m, the lowest first.
    spans : (s, 2) int64
        The first of each slab and the one after the last.
    most : int
        Of a slab, about which it is thinned.
    members : (m,) int64
        Gets their places, slab after slab; there is room for the points of all slabs.
    starts : (s + 1,) int64
        Gets where each slab's begin.
    """
    used = 0
    for slab in range(len(spans)):
        starts[slab] = used
        first, end = spans[slab]
        part = plan[first:end]
        is_row = np.zeros(len(part), np.bool_)
        rows_kernel(part, noise_m, max(1, -(-len(part) // most)), is_row)
        left = np.flatnonzero(~is_row)
        for one in left[:: max(1, -(-left.size // most))]:
            members[used] = first + one
            used += 1
    starts[len(spans)] = used


@kernel
def _likeliest_row(plan: Floats, left: NDArray[np.int64], noise_m: float) -> tuple[int, int]:
    """Two points whose line most others are near to; −1 where few are."""
    best, first, second = _FEWEST - 1, -1, -1
    # Beside each other, so that several are counted at a time.
    easts, norths = plan[left, 0].copy(), plan[left, 1].copy()
    state = 1
    for _ in range(_DRAWS):
        state = (state * _FACTOR + 1) % _MODULUS
        a = state * left.size // _MODULUS
        state = (state * _FACTOR + 1) % _MODULUS
        b = state * left.size // _MODULUS
        east, north = easts[b] - easts[a], norths[b] - norths[a]
        length = math.hypot(east, north)
        # Points nearer to each other tell no direction.
        if length < _LONG_M / 2:
            continue
        count, middle, most = 0, east * norths[a] - north * easts[a], noise_m * length
        for one in range(left.size):
            count += abs(east * norths[one] - north * easts[one] - middle) <= most
        if count > best:
            best, first, second = count, left[a], left[b]
    return first, second


@kernel
def _mark(
    plan: Floats,
    ends: tuple[int, int],
    noise_m: float,
    along: Floats,
    is_row: NDArray[np.bool_],
) -> bool:
    """Mark what lies on a line without gaps for long enough; whether anything does."""
    a, b = ends
    east, north = plan[b, 0] - plan[a, 0], plan[b, 1] - plan[a, 1]
    length = math.hypot(east, north)
    east, north = east / length, north / length
    count = 0
    on = np.empty(len(plan), np.int64)
    for one in range(len(plan)):
        beside_east, beside_north = plan[one, 0] - plan[a, 0], plan[one, 1] - plan[a, 1]
        if not is_row[one] and abs(east * beside_north - north * beside_east) <= noise_m:
            along[count] = east * beside_east + north * beside_north
            on[count] = one
            count += 1
    order = np.argsort(along[:count])
    begin, is_marked = 0, False
    for rank in range(1, count + 1):
        if rank < count and along[order[rank]] - along[order[rank - 1]] <= _GAP_M:
            continue
        is_long = along[order[rank - 1]] - along[order[begin]] >= _LONG_M
        if is_long and rank - begin >= _FEWEST:
            for one in order[begin:rank]:
                is_row[on[one]] = True
            is_marked = True
        begin = rank
    return is_marked
