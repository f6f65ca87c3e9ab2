"""Things found and things that are, paired one to one so that pairs are as near as can be."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from processing.core.arrays import Floats, Integers


def pairs_within(result: Floats, truth: Floats, within_m: float) -> tuple[Integers, Integers]:
    """The pairs of two sets of places, each place in at most one.

    What counts is how much nearer than ``within_m`` pairs are in all: a pair far apart never
    costs two others their near partners. The order of the places doesn't matter but for ties.

    Parameters
    ----------
    result, truth : (n, k), (m, k) float64
        Places, m.

    Returns
    -------
    of_result, of_truth : (p,) int64
        Indices of the partners, by rising ``of_truth``.
    """
    if not len(result) or not len(truth):
        return np.empty(0, np.int64), np.empty(0, np.int64)
    near = cKDTree(result).sparse_distance_matrix(
        cKDTree(truth), within_m, output_type="coo_matrix"
    )
    # A pair just at the limit gains a little too, so that it counts.
    return best_pairs(near.row, near.col, within_m * (1 + 1e-6) - near.data)


def best_pairs(
    of_result: NDArray[np.integer], of_truth: NDArray[np.integer], gains: Floats
) -> tuple[Integers, Integers]:
    """Those of possible pairs that gain most in all, each member in at most one.

    Parameters
    ----------
    of_result, of_truth : (n,) int
        Indices of possible partners.
    gains : (n,) float64
        More than 0.

    Returns
    -------
    of_result, of_truth : (p,) int64
        By rising ``of_truth``.
    """
    from scipy.optimize import linear_sum_assignment  # a fifth of a second to load

    if not len(gains):
        return np.empty(0, np.int64), np.empty(0, np.int64)
    left, right = np.asarray(of_result, np.int64), np.asarray(of_truth, np.int64)
    first = int(left.max()) + 1
    size = first + int(right.max()) + 1
    graph = coo_array((np.ones(len(gains)), (left, first + right)), shape=(size, size))
    group = connected_components(graph, directed=False)[1][left]
    order = np.argsort(group, kind="stable")
    found: list[tuple[int, int]] = []
    for part in np.split(order, np.flatnonzero(np.diff(group[order])) + 1):
        rows, row = np.unique(left[part], return_inverse=True)
        columns, column = np.unique(right[part], return_inverse=True)
        table = np.zeros((rows.size, columns.size))
        table[row, column] = gains[part]
        for i, j in zip(*linear_sum_assignment(table, maximize=True), strict=True):
            if table[i, j] > 0:
                found.append((int(columns[j]), int(rows[i])))
    found.sort()
    pairs = np.array(found, dtype=np.int64).reshape(-1, 2)
    return pairs[:, 1], pairs[:, 0]
