"""One decision tree from rows whose values are sorted into bins: grown best leaf first.

Written here because scikit-learn, which makes the models that are shipped, starts from nothing:
it can't go on from what other trees say already, and it is no part of what is installed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel

FEATURE, CUT, LEFT, RIGHT = range(4)
"""Columns of a tree's nodes: the feature asked (−1 at a leaf), the last bin that goes left, and
where it goes on."""

_GAIN, _SPLIT_FEATURE, _SPLIT_CUT, _SPLIT = 0, 1, 2, 3
_MOST_BINS = 256


class GrowthLimits(NamedTuple):
    """How far a tree may go.

    ``leaves``: at most; ``ridge``: added to a leaf's curvature, so that few rows say little;
    ``least``: rows in a leaf; ``rate``: share of its own step that a leaf may go.
    """

    leaves: int
    ridge: float
    least: int
    rate: float


class GrownTree(NamedTuple):
    """A tree on bins: ``nodes`` (m, 4) int32 by the columns above; ``values`` (m,) of leaves."""

    nodes: NDArray[np.int32]
    values: Floats


def grow_tree(
    bins: NDArray[np.uint8], gradients: Floats, curvatures: Floats, limits: GrowthLimits
) -> tuple[GrownTree, Floats]:
    """A regression tree, and what it says of each row.

    Parameters
    ----------
    bins : (f, n) uint8
        By feature, contiguous.
    gradients, curvatures : (n,) float64
        First and second derivatives of the loss by what was said so far.

    References
    ----------
    Friedman 2001, Annals of Statistics 29(5), algorithm 6; Chen and Guestrin 2016, KDD, equations
    5 (a leaf's value) and 7 (the gain of a split).
    """
    most = 2 * limits.leaves - 1
    nodes, values = np.full((most, 4), -1, np.int32), np.zeros(most)
    ranges = np.zeros((most, 2), np.int64)
    rows = np.arange(gradients.size, dtype=np.int32)
    said = np.zeros(gradients.size)
    count = grow_kernel(bins, gradients, curvatures, limits, rows, nodes, values, ranges, said)
    return GrownTree(nodes[:count], values[:count]), said


@kernel
def grow_kernel(
    bins: NDArray[np.uint8],
    gradients: Floats,
    curvatures: Floats,
    limits: GrowthLimits,
    rows: NDArray[np.int32],
    nodes: NDArray[np.int32],
    values: Floats,
    ranges: NDArray[np.int64],
    said: Floats,
) -> int:
    """Grow a tree; gives its number of nodes.

    ``rows`` is put in the order of the leaves; ``ranges`` (m, 2): which of it a node holds.
    """
    splits = np.zeros((nodes.shape[0], _SPLIT))
    ranges[0, 0], ranges[0, 1] = 0, rows.size
    values[0] = best_split_kernel(bins, gradients, curvatures, limits, rows, splits[0])
    count = 1
    for _ in range(limits.leaves - 1):
        best, gain = -1, 0.0
        for node in range(count):
            if nodes[node, FEATURE] < 0 and splits[node, _GAIN] > gain:
                best, gain = node, splits[node, _GAIN]
        if best < 0:
            break
        feature, cut = int(splits[best, _SPLIT_FEATURE]), int(splits[best, _SPLIT_CUT])
        start, stop = ranges[best, 0], ranges[best, 1]
        middle = start + divide_kernel(bins[feature], cut, rows[start:stop])
        nodes[best, FEATURE], nodes[best, CUT] = feature, cut
        nodes[best, LEFT], nodes[best, RIGHT] = count, count + 1
        ranges[count, 0], ranges[count, 1] = start, middle
        ranges[count + 1, 0], ranges[count + 1, 1] = middle, stop
        for node in (count, count + 1):
            own = rows[ranges[node, 0] : ranges[node, 1]]
            values[node] = best_split_kernel(bins, gradients, curvatures, limits, own, splits[node])
        count += 2
    for node in range(count):
        if nodes[node, FEATURE] < 0:
            for i in range(ranges[node, 0], ranges[node, 1]):
                said[rows[i]] = values[node]
    return count


@kernel
def divide_kernel(column: NDArray[np.uint8], cut: int, rows: NDArray[np.int32]) -> int:
    """Put rows whose bin is at most ``cut`` first, in their order; gives how many."""
    right = np.empty(rows.size, np.int32)
    lefts, rights = 0, 0
    for i in range(rows.size):
        if column[rows[i]] <= cut:
            rows[lefts] = rows[i]
            lefts += 1
        else:
            right[rights] = rows[i]
            rights += 1
    for i in range(rights):
        rows[lefts + i] = right[i]
    return lefts


@kernel
def best_split_kernel(
    bins: NDArray[np.uint8],
    gradients: Floats,
    curvatures: Floats,
    limits: GrowthLimits,
    rows: NDArray[np.int32],
    split: Floats,
) -> float:
    """The value of a leaf of some rows; ``split``: gain, feature and cut of its best division."""
    count = rows.size
    own = np.empty((count, 2))
    slope, bend = 0.0, 0.0
    for i in range(count):
        own[i, 0], own[i, 1] = gradients[rows[i]], curvatures[rows[i]]
        slope += own[i, 0]
        bend += own[i, 1]
    split[_GAIN] = 0.0
    whole = slope * slope / (bend + limits.ridge)
    sums = np.empty((_MOST_BINS, 3))
    for feature in range(bins.shape[0] if count >= 2 * limits.least else 0):
        sums[:] = 0.0
        column = bins[feature]
        for i in range(count):
            b = column[rows[i]]
            sums[b, 0] += own[i, 0]
            sums[b, 1] += own[i, 1]
            sums[b, 2] += 1.0
        left_slope, left_bend, left = 0.0, 0.0, 0.0
        for b in range(_MOST_BINS - 1):
            if sums[b, 2] == 0.0:
                continue
            left_slope += sums[b, 0]
            left_bend += sums[b, 1]
            left += sums[b, 2]
            if left < limits.least or count - left < limits.least:
                continue
            gain = left_slope * left_slope / (left_bend + limits.ridge) - whole
            gain += (slope - left_slope) ** 2 / (bend - left_bend + limits.ridge)
            if gain > split[_GAIN]:
                split[_GAIN], split[_SPLIT_FEATURE], split[_SPLIT_CUT] = gain, feature, b
    return -limits.rate * slope / (bend + limits.ridge)


def warm_up() -> None:
    """Compile the kernels."""
    bins = np.zeros((1, 4), np.uint8)
    grow_tree(bins, np.ones(4), np.ones(4), GrowthLimits(2, 1.0, 1, 0.1))
