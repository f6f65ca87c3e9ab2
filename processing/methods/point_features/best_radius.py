"""The number of neighbours at which line, plane and scatter are told apart best."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.noise.features.cell_kernels import SUMS, covariance_of, eigenvalues
from processing.methods.point_features.ball_kernels import SPHERE, shape_entropy, sphere_row
from processing.methods.point_features.point_tree import (
    PointTree,
    add_point,
    point_tree,
    square_to,
    squares_to_box,
)

FARTHEST_M = 5.0
"""Where a thousand neighbours reach farther, as many as the largest sphere of the thesis holds."""

BEST_FEATURES = SPHERE + 1
"""Columns of what is found: those of a sphere, and the number of neighbours."""

_LEAST, _MOST = 10, 1000
"""Neighbours (Takahashi 2022, section 4.4.1)."""

_COUNTS = np.unique(np.rint(np.geomspace(_LEAST, _MOST, 26)).astype(np.int64))
"""Numbers of neighbours that are tried, each a fifth more than the one before: the thesis names
no step, and what is seen of a surface changes with its size's logarithm."""

_ROOM = 8 * _MOST
"""Points held at a time."""

_AND_A_BIT = 1 + 1e-9
"""For roundings, which must not leave a neighbour out."""

_DEEPEST = 128
"""Branches that wait: two a level, of 2^48 points at most."""

_HALVINGS = 40
"""Of a reach of 5 m down to nothing: what still holds too many are points at one place."""

_NO_VARIANCE = 1e-12
"""m², below which points are at one place."""


def best_neighbours(
    tree: PointTree, ends: tuple[int, int], own: int, found: NDArray[np.float32]
) -> None:
    """Features of the points' best neighbourhoods.

    Parameters
    ----------
    tree : PointTree
        Of three axes.
    ends : (int, int)
        The first point of the tree that is asked for, and the one after the last.
    own : int
        Points with this number or a higher one are left out.
    found : (own, 16) float32
        By number: what a sphere has, and the number of neighbours.
    """
    best_kernel(tree, ends, own, _COUNTS, found)


@kernel
def best_kernel(
    tree: PointTree,
    ends: tuple[int, int],
    own: int,
    counts: Integers,
    found: NDArray[np.float32],
) -> None:
    """As :func:`best_neighbours`; ``counts`` rise.

    The thousandth neighbour of a point is no farther than that of the point before and the way to
    that one.
    """
    near, squares = np.empty(_ROOM, np.int64), np.empty(_ROOM)
    total, best = np.empty(SUMS), np.empty(SUMS)
    seen, best_seen, covariance = np.empty(3), np.empty(3), np.empty((3, 3))
    before, reach = -1, 0.0
    for at in range(ends[0], ends[1]):
        if tree.order[at] >= own:
            continue
        position, guess = tree.xyz[at], FARTHEST_M
        if before >= 0:
            way = math.sqrt(square_to(tree, before, position, 1.0))
            guess = min(FARTHEST_M, (reach + way) * _AND_A_BIT)
        count = _near(tree, at, guess, near, squares)
        by_distance = np.argsort(squares[:count])
        used = min(count, _MOST + 1)
        before, reach = at, math.sqrt(squares[by_distance[used - 1]])
        if count <= _MOST:
            reach = FARTHEST_M
        total[:] = 0.0
        seen[1], seen[2] = np.inf, -np.inf
        least, step, neighbours = np.inf, 0, 0
        for k in range(used):
            point = near[by_distance[k]]
            add_point(tree.xyz, point, total)
            seen[0] = math.sqrt(squares[by_distance[k]])
            seen[1], seen[2] = min(seen[1], tree.xyz[point, 2]), max(seen[2], tree.xyz[point, 2])
            if step < counts.size and k == counts[step]:
                step += 1
            elif k < used - 1 or neighbours > 0:
                continue
            covariance_of(total, covariance)
            large, middle, small = eigenvalues(covariance)
            middle, small = max(middle, 0.0), max(small, 0.0)
            entropy = shape_entropy(large, middle, small) if large > _NO_VARIANCE else 0.0
            if entropy < least:
                least, neighbours = entropy, k
                best[:], best_seen[:] = total, seen
        row = found[tree.order[at]]
        sphere_row(best, best_seen, covariance, row[:SPHERE])
        row[SPHERE] = neighbours


@kernel
def _near(tree: PointTree, at: int, reach: float, near: Integers, squares: Floats) -> int:
    """Collect the points within a reach, or within less that still holds a thousand and one."""
    count = _collect(tree, at, reach, near, squares)
    if count <= near.size:
        return count
    low, high = 0.0, reach
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        count = _collect(tree, at, middle, near, squares)
        if count > near.size:
            high = middle
        elif count <= _MOST:
            low = middle
        else:
            return count
    return min(_collect(tree, at, high, near, squares), near.size)


@kernel
def _collect(tree: PointTree, at: int, reach: float, near: Integers, squares: Floats) -> int:
    """How many points are within a reach; as many as there is room for are collected."""
    waiting = np.empty(_DEEPEST, np.int64)
    position, limit = tree.xyz[at], reach * reach
    waiting[0], left, count = 0, 1, 0
    while left > 0 and count <= near.size:
        left -= 1
        branch = waiting[left]
        least, _ = squares_to_box(tree.boxes[branch], position, 1.0)
        if least > limit:
            continue
        if branch < tree.first_leaf:
            waiting[left], waiting[left + 1] = 2 * branch + 1, 2 * branch + 2
            left += 2
            continue
        for point in range(tree.starts[branch], tree.ends[branch]):
            square = square_to(tree, point, position, 1.0)
            if square <= limit:
                if count < near.size:
                    near[count], squares[count] = point, square
                count += 1
    return count


def warm_up() -> None:
    """Compile the kernels."""
    best_neighbours(point_tree(np.zeros((2, 3)), 3), (0, 2), 2, np.empty((2, BEST_FEATURES), "f4"))
