"""A balanced tree of points with the sums of every branch: whole branches are added at once.

What a sphere of 5 m holds is some hundred thousand points of a street. Branches that lie wholly
within it are added by their sums, so that only the points near its surface are looked at, and
the result is that of all points.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.noise.features.cell_kernels import (
    COUNT,
    SUM_X,
    SUM_XX,
    SUM_XY,
    SUM_XZ,
    SUM_Y,
    SUM_YY,
    SUM_YZ,
    SUM_Z,
    SUM_ZZ,
    SUMS,
)

_LEAF_POINTS = 16
"""Points of the smallest branches; sets the time only, least from 8 to 32 on a street."""


class PointTree(NamedTuple):
    """Points in the order of the tree's leaves, and its branches.

    Branch i parts into 2 i + 1 and 2 i + 2; the branches from ``first_leaf`` on have no parts.

    ``xyz`` (n, 3) m; ``order`` (n,) the given number of each; ``starts``, ``ends`` (b,) the points
    of each branch; ``boxes`` (b, 6) their lowest and highest coordinates; ``sums`` (b, 11) as of
    :mod:`processing.methods.noise.features.cell_kernels`.
    """

    xyz: Floats
    order: Integers
    starts: Integers
    ends: Integers
    boxes: Floats
    sums: Floats
    first_leaf: int


def point_tree(xyz: Floats, axes: int) -> PointTree:
    """Build the tree.

    Parameters
    ----------
    xyz : (n, 3) float64
        m about an origin near by; finite.
    axes : {2, 3}
        2: for discs seen from above, which reach through all heights.
    """
    count = xyz.shape[0]
    levels = 0
    while count > _LEAF_POINTS << levels:
        levels += 1
    branches = (2 << levels) - 1
    order = np.arange(count)
    starts, ends = np.zeros(branches, np.int64), np.zeros(branches, np.int64)
    boxes, sums = np.empty((branches, 6)), np.zeros((branches, SUMS))
    first_leaf = (1 << levels) - 1
    ends[0] = count
    part_kernel(np.ascontiguousarray(xyz), axes, first_leaf, order, starts, ends)
    tree = PointTree(xyz[order], order, starts, ends, boxes, sums, first_leaf)
    sums_kernel(tree)
    return tree


@kernel
def part_kernel(
    xyz: Floats, axes: int, first_leaf: int, order: Integers, starts: Integers, ends: Integers
) -> None:
    """Part every branch across its longest side, in the middle of its points."""
    for branch in range(first_leaf):
        start, end = starts[branch], ends[branch]
        widest, extent = 0, -1.0
        for axis in range(axes):
            low, high = np.inf, -np.inf
            for at in range(start, end):
                value = xyz[order[at], axis]
                low, high = min(low, value), max(high, value)
            if high - low > extent:
                widest, extent = axis, high - low
        middle = (start + end) // 2
        _part(xyz, widest, order, (start, middle, end))
        starts[2 * branch + 1], ends[2 * branch + 1] = start, middle
        starts[2 * branch + 2], ends[2 * branch + 2] = middle, end


@kernel
def _part(xyz: Floats, axis: int, order: Integers, ends: tuple[int, int, int]) -> None:
    """Bring the points with lower coordinates before the middle (Hoare's selection)."""
    start, middle, end = ends
    low, high = start, end - 1
    while low < high:
        pivot = xyz[order[(low + high) // 2], axis]
        i, j = low, high
        while i <= j:
            while xyz[order[i], axis] < pivot:
                i += 1
            while xyz[order[j], axis] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                i += 1
                j -= 1
        if middle <= j:
            high = j
        elif middle >= i:
            low = i
        else:
            return


@kernel
def sums_kernel(tree: PointTree) -> None:
    """Sums and boxes, from the leaves upwards."""
    for branch in range(tree.starts.size - 1, -1, -1):
        box, total = tree.boxes[branch], tree.sums[branch]
        box[:3], box[3:] = np.inf, -np.inf
        if branch >= tree.first_leaf:
            for point in range(tree.starts[branch], tree.ends[branch]):
                add_point(tree.xyz, point, total)
                for axis in range(3):
                    box[axis] = min(box[axis], tree.xyz[point, axis])
                    box[3 + axis] = max(box[3 + axis], tree.xyz[point, axis])
            continue
        for part in (2 * branch + 1, 2 * branch + 2):
            for m in range(SUMS):
                total[m] += tree.sums[part, m]
            for axis in range(3):
                box[axis] = min(box[axis], tree.boxes[part, axis])
                box[3 + axis] = max(box[3 + axis], tree.boxes[part, 3 + axis])


@kernel
def add_point(xyz: Floats, point: int, total: Floats) -> None:
    """Add one point to sums."""
    x, y, z = xyz[point, 0], xyz[point, 1], xyz[point, 2]
    total[COUNT] += 1.0
    total[SUM_X] += x
    total[SUM_Y] += y
    total[SUM_Z] += z
    total[SUM_XX] += x * x
    total[SUM_XY] += x * y
    total[SUM_XZ] += x * z
    total[SUM_YY] += y * y
    total[SUM_YZ] += y * z
    total[SUM_ZZ] += z * z


@kernel
def square_to(tree: PointTree, point: int, position: Floats, upright: float) -> float:
    """Square of the distance of a point of the tree, m²; ``upright`` 0 leaves heights out."""
    dx = tree.xyz[point, 0] - position[0]
    dy = tree.xyz[point, 1] - position[1]
    dz = (tree.xyz[point, 2] - position[2]) * upright
    return float(dx * dx + dy * dy + dz * dz)


@kernel
def squares_to_box(box: Floats, position: Floats, upright: float) -> tuple[float, float]:
    """Squares of the least and of the largest distance that a point of a box may have, m²."""
    near, far = 0.0, 0.0
    for axis in range(3):
        below, above = box[axis] - position[axis], position[axis] - box[3 + axis]
        least, most = max(below, above, 0.0), max(-below, -above)
        if axis == 2:
            least, most = least * upright, most * upright
        near += least * least
        far += most * most
    return near, far


def warm_up() -> None:
    """Compile the kernels."""
    for axes in (2, 3):
        point_tree(np.zeros((_LEAF_POINTS + 1, 3)), axes)
