"""Trees of several classes, boosted or averaged: how likely each class is for rows of features."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.noise.neighbours.sharing import share_out
from processing.methods.noise.tree_files import AveragedTrees, Forest
from processing.methods.noise.trees import sums_kernel, word_trees

_ROWS_AT_ONCE = 8_192
"""Rows of a share of a core's work."""

_ROWS_PER_TREE = 512


def class_shares(
    model: Forest | AveragedTrees, rows: NDArray[np.float32], monitor: Monitor
) -> NDArray[np.float32]:
    """(n, k) how likely each class is for rows of features, (n, f)."""
    shares = np.empty((rows.shape[0], model.codes.size), np.float32)
    rows = np.ascontiguousarray(rows)
    if isinstance(model, AveragedTrees):
        share_out(
            lambda start, stop: mean_kernel(model, rows[start:stop], shares[start:stop]),
            rows.shape[0],
            _ROWS_AT_ONCE,
            monitor,
        )
        return shares
    trees = word_trees(model.trees, rows.shape[1])

    def weigh(start: int, stop: int) -> None:
        sums = np.tile(model.bases, (stop - start, 1))
        sums_kernel(trees, model.class_of, model.class_of.size, rows[start:stop], sums)
        shares_kernel(sums, shares[start:stop])

    share_out(weigh, rows.shape[0], _ROWS_AT_ONCE, monitor)
    return shares


@kernel
def mean_kernel(
    trees: AveragedTrees, rows: NDArray[np.float32], shares: NDArray[np.float32]
) -> None:
    """The mean of what trees say of rows: ``shares`` (n, k); NaN goes right.

    One tree is shown some hundred rows before the next one, as many as stay near a core with it.
    """
    shares[:] = 0.0
    count = np.float32(trees.roots.size)
    for first in range(0, rows.shape[0], _ROWS_PER_TREE):
        last = min(first + _ROWS_PER_TREE, rows.shape[0])
        for tree in range(trees.roots.size):
            for row in range(first, last):
                node = trees.roots[tree]
                feature = trees.features[node]
                while feature >= 0:
                    stays = rows[row, feature] <= trees.thresholds[node]
                    node = node + 1 if stays else trees.rights[node]
                    feature = trees.features[node]
                leaf = trees.shares[trees.leaf_of[node]]
                for which in range(shares.shape[1]):
                    shares[row, which] += leaf[which]
        for row in range(first, last):
            for which in range(shares.shape[1]):
                shares[row, which] /= count


@kernel
def shares_kernel(sums: Floats, shares: NDArray[np.float32]) -> None:
    """Shares of classes, (n, k), from sums of log-odds; the sums become room of the work."""
    for row in range(sums.shape[0]):
        most = sums[row].max()
        total = 0.0
        for which in range(sums.shape[1]):
            sums[row, which] = np.exp(sums[row, which] - most)
            total += sums[row, which]
        for which in range(sums.shape[1]):
            shares[row, which] = sums[row, which] / total


def warm_up() -> None:
    """Compile the kernels."""
    one, none = np.zeros(1, np.float32), np.zeros(1, np.int32)
    leaf = AveragedTrees(none - 1, one, none, none, one[:, None], none, np.zeros(1, np.uint8))
    mean_kernel(leaf, one[:, None], np.empty((1, 1), np.float32))
    shares_kernel(np.zeros((1, 1)), np.empty((1, 1), np.float32))
