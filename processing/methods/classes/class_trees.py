"""Boosted trees with several classes: how likely each class is for rows of features."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.noise.neighbours.sharing import share_out
from processing.methods.noise.tree_files import Forest
from processing.methods.noise.trees import Trees

_ROWS_AT_ONCE = 8_192
"""Rows of a share of a core's work."""


def class_shares(model: Forest, rows: NDArray[np.float32], monitor: Monitor) -> NDArray[np.float32]:
    """(n, k) how likely each class is for rows of features, (n, f)."""
    shares = np.empty((rows.shape[0], model.codes.size), np.float32)
    rows = np.ascontiguousarray(rows)

    def weigh(start: int, stop: int) -> None:
        shares_kernel(
            model.trees, model.class_of, model.bases, rows[start:stop], shares[start:stop]
        )

    share_out(weigh, rows.shape[0], _ROWS_AT_ONCE, monitor)
    return shares


@kernel
def shares_kernel(
    trees: Trees,
    class_of: NDArray[np.int32],
    bases: Floats,
    rows: NDArray[np.float32],
    shares: NDArray[np.float32],
) -> None:
    """Shares of the classes for some rows; NaN goes right.

    Tree by tree over all rows: the nodes of one stay near the core meanwhile.
    """
    totals = np.empty((rows.shape[0], bases.size))
    totals[:] = bases
    for tree in range(trees.roots.size):
        root, which = trees.roots[tree], class_of[tree]
        for row in range(rows.shape[0]):
            node = root
            while trees.features[node] >= 0:
                is_left = rows[row, trees.features[node]] <= trees.thresholds[node]
                node = trees.lefts[node] if is_left else trees.rights[node]
            totals[row, which] += trees.thresholds[node]
    for row in range(rows.shape[0]):
        most = totals[row].max()
        total = 0.0
        for which in range(bases.size):
            totals[row, which] = np.exp(totals[row, which] - most)
            total += totals[row, which]
        for which in range(bases.size):
            shares[row, which] = totals[row, which] / total


def warm_up() -> None:
    """Compile the kernel."""
    none = np.zeros(1, np.int32)
    leaf = Trees(none - 1, np.zeros(1), none, none, none, 0.0)
    shares = np.empty((1, 1), np.float32)
    shares_kernel(leaf, none, np.zeros(1), np.zeros((1, 1), np.float32), shares)
