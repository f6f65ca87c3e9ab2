"""Boosted trees with several classes: how likely each class is for rows of features."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.noise.neighbours.sharing import share_out
from processing.methods.noise.tree_files import Forest
from processing.methods.noise.trees import sums_kernel, word_trees

_ROWS_AT_ONCE = 8_192
"""Rows of a share of a core's work."""


def class_shares(model: Forest, rows: NDArray[np.float32], monitor: Monitor) -> NDArray[np.float32]:
    """(n, k) how likely each class is for rows of features, (n, f)."""
    shares = np.empty((rows.shape[0], model.codes.size), np.float32)
    rows = np.ascontiguousarray(rows)
    trees = word_trees(model.trees, rows.shape[1])

    def weigh(start: int, stop: int) -> None:
        sums = np.tile(model.bases, (stop - start, 1))
        sums_kernel(trees, model.class_of, model.class_of.size, rows[start:stop], sums)
        shares_kernel(sums, shares[start:stop])

    share_out(weigh, rows.shape[0], _ROWS_AT_ONCE, monitor)
    return shares


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
    """Compile the kernel."""
    shares_kernel(np.zeros((1, 1)), np.empty((1, 1), np.float32))
