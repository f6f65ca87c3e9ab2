"""What spheres and discs about points hold: sums, extremes and the farthest point, exact."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.methods.noise.features.cell_kernels import (
    COUNT,
    SUM_Z,
    SUMS,
    covariance_of,
    eigenvalues,
    eigenvector,
)
from processing.methods.point_features.point_tree import (
    PointTree,
    add_point,
    point_tree,
    square_to,
    squares_to_box,
)
from processing.recording.columns.point_features import DISC_FEATURES, SPHERE_FEATURES

SPHERE, DISC = len(SPHERE_FEATURES), len(DISC_FEATURES)
"""Columns of what is found, in the order of these lists."""

_LEAST_NEIGHBOURS = 3
"""With fewer points than a plane needs, eigenvalues say nothing."""

_NO_VARIANCE = 1e-12
"""m², below which points are at one place: a thousandth of a millimetre."""

_DEEPEST = 128
"""Branches that wait: two a level, of 2^48 points at most."""

_MOST_PENDING = 2_048
"""Branches that may hold the farthest point; what is more is looked at immediately."""


@kernel
def spheres_kernel(
    tree: PointTree, radius_m: float, ends: tuple[int, int], own: int, found: NDArray[np.float32]
) -> None:
    """Features of the spheres about the points of the tree from one to before another.

    ``own``: points with this number or a higher one are left out; ``found`` (own, 15), by number.
    """
    total, seen = np.empty(SUMS), np.empty(3)
    waiting, pending = np.empty(_DEEPEST, np.int64), np.empty(_MOST_PENDING, np.int64)
    covariance = np.empty((3, 3))
    for at in range(ends[0], ends[1]):
        if tree.order[at] < own:
            _gather(tree, (at, radius_m, 1.0), waiting, pending, total, seen)
            sphere_row(total, seen, covariance, found[tree.order[at]])


@kernel
def discs_kernel(
    tree: PointTree, radius_m: float, ends: tuple[int, int], own: int, found: NDArray[np.float32]
) -> None:
    """The same of discs seen from above: ``found`` (own, 4)."""
    total, seen = np.empty(SUMS), np.empty(3)
    waiting, pending = np.empty(_DEEPEST, np.int64), np.empty(_MOST_PENDING, np.int64)
    covariance = np.empty((3, 3))
    for at in range(ends[0], ends[1]):
        if tree.order[at] < own:
            _gather(tree, (at, radius_m, 0.0), waiting, pending, total, seen)
            covariance_of(total, covariance)
            disc_row(total, seen, covariance, found[tree.order[at]])


@kernel
def _gather(
    tree: PointTree,
    query: tuple[int, float, float],
    waiting: NDArray[np.int64],
    pending: NDArray[np.int64],
    total: Floats,
    seen: Floats,
) -> None:
    """Sums of the points within a radius; ``seen``: the farthest, the lowest and the highest, m.

    1. A branch within the radius is added as a whole; of the others points are looked at.
    2. Where the farthest point may be in a branch that was added, its points are looked at, too.
    """
    at, radius, upright = query
    position, limit = tree.xyz[at], radius * radius
    total[:] = 0.0
    seen[0], seen[1], seen[2] = 0.0, np.inf, -np.inf
    count, left = 0, 1
    waiting[0] = 0
    while left > 0:
        left -= 1
        branch = waiting[left]
        near, far = squares_to_box(tree.boxes[branch], position, upright)
        if far <= limit:
            _add_branch(tree, branch, total, seen)
            if far > seen[0] and count < _MOST_PENDING:
                pending[count] = branch
                count += 1
            elif far > seen[0]:
                seen[0] = _farthest_in(tree, branch, position, upright, seen[0])
        elif near <= limit and branch >= tree.first_leaf:
            _add_within(tree, branch, (at, limit, upright), total, seen)
        elif near <= limit:
            waiting[left], waiting[left + 1] = 2 * branch + 1, 2 * branch + 2
            left += 2
    for k in range(count):
        seen[0] = _farthest_in(tree, pending[k], position, upright, seen[0])
    seen[0] = math.sqrt(seen[0])


@kernel
def _add_branch(tree: PointTree, branch: int, total: Floats, seen: Floats) -> None:
    for m in range(SUMS):
        total[m] += tree.sums[branch, m]
    seen[1] = min(seen[1], tree.boxes[branch, 2])
    seen[2] = max(seen[2], tree.boxes[branch, 5])


@kernel
def _add_within(
    tree: PointTree, leaf: int, query: tuple[int, float, float], total: Floats, seen: Floats
) -> None:
    """Add the points of a leaf whose distance's square is within a limit."""
    at, limit, upright = query
    for point in range(tree.starts[leaf], tree.ends[leaf]):
        square = square_to(tree, point, tree.xyz[at], upright)
        if square <= limit:
            add_point(tree.xyz, point, total)
            seen[0] = max(seen[0], square)
            seen[1] = min(seen[1], tree.xyz[point, 2])
            seen[2] = max(seen[2], tree.xyz[point, 2])


@kernel
def _farthest_in(
    tree: PointTree, branch: int, position: Floats, upright: float, farthest: float
) -> float:
    """Square of the distance to the farthest point of a branch, where it is more than so far."""
    waiting = np.empty(_DEEPEST, np.int64)
    waiting[0], left = branch, 1
    while left > 0:
        left -= 1
        here = waiting[left]
        _, far = squares_to_box(tree.boxes[here], position, upright)
        if far <= farthest:
            continue
        if here >= tree.first_leaf:
            for point in range(tree.starts[here], tree.ends[here]):
                farthest = max(farthest, square_to(tree, point, position, upright))
        else:
            waiting[left], waiting[left + 1] = 2 * here + 1, 2 * here + 2
            left += 2
    return farthest


@kernel
def sphere_row(total: Floats, seen: Floats, covariance: Floats, found: NDArray[np.float32]) -> None:
    """Features of a sphere from the sums of its points (Takahashi 2022, section 4.4.1)."""
    count, radius = total[COUNT], seen[0]
    found[:] = 0.0
    found[8] = radius
    if radius > 0.0:
        found[9] = count / (4.0 / 3.0 * math.pi * radius**3)
    found[11] = total[SUM_Z] / count
    found[12] = seen[2] - seen[1]
    covariance_of(total, covariance)
    found[13] = math.sqrt(max(covariance[2, 2], 0.0))
    large, middle, small = eigenvalues(covariance)
    middle, small = max(middle, 0.0), max(small, 0.0)
    if count <= _LEAST_NEIGHBOURS or large <= _NO_VARIANCE:
        return
    found[0], found[1], found[2] = (large - middle) / large, (middle - small) / large, small / large
    found[3] = (large * middle * small) ** (1.0 / 3.0)
    found[4] = (large - small) / large
    found[5] = _entropy(large) + _entropy(middle) + _entropy(small)
    found[6] = large + middle + small
    found[7] = small / (large + middle + small)
    _, _, upwards = eigenvector(covariance, small)
    found[10] = 1.0 - abs(upwards)
    found[14] = shape_entropy(large, middle, small)


@kernel
def disc_row(total: Floats, seen: Floats, covariance: Floats, found: NDArray[np.float32]) -> None:
    """Features of a disc from the spread of its points (Takahashi 2022, section 4.4.2)."""
    a, b, c = covariance[0, 0], covariance[0, 1], covariance[1, 1]
    half = math.sqrt((a - c) ** 2 / 4.0 + b * b)
    large, small = (a + c) / 2.0 + half, max((a + c) / 2.0 - half, 0.0)
    found[0] = large + small
    found[1] = small / large if large > _NO_VARIANCE else 0.0
    found[2] = seen[0]
    found[3] = total[COUNT] / (2.0 * math.pi * seen[0] ** 2) if seen[0] > 0.0 else 0.0


@kernel
def shape_entropy(large: float, middle: float, small: float) -> float:
    """Of the shares of line, plane and scatter (equation 4-12)."""
    line, plane, scatter = (large - middle) / large, (middle - small) / large, small / large
    return _entropy(line) + _entropy(plane) + _entropy(scatter)


@kernel
def _entropy(value: float) -> float:
    return -value * math.log(value) if value > 0.0 else 0.0


def warm_up() -> None:
    """Compile the kernels."""
    tree = point_tree(np.zeros((2, 3)), 3)
    spheres_kernel(tree, 1.0, (0, 2), 2, np.empty((2, SPHERE), np.float32))
    discs_kernel(tree, 1.0, (0, 2), 2, np.empty((2, DISC), np.float32))
