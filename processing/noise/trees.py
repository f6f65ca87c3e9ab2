"""Boosted decision trees as plain arrays: read, and asked about many rows at once."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.kernels import kernel

_HOPELESS = -4.0


class Trees(NamedTuple):
    """A sum of trees that gives the log-odds of a claim.

    ``features`` (m,) int32: the column asked at each node, −1 at a leaf; ``thresholds`` (m,):
    at most this goes left, at a leaf the value; ``lefts``, ``rights`` (m,) int32: next nodes;
    ``roots`` (t,) int32; ``base``: log-odds before any tree.
    """

    features: NDArray[np.int32]
    thresholds: NDArray[np.float64]
    lefts: NDArray[np.int32]
    rights: NDArray[np.int32]
    roots: NDArray[np.int32]
    base: float


def read_trees(path: Path) -> Trees:
    """Trees from a file written by :func:`write_trees`."""
    with np.load(path, allow_pickle=False) as kept:
        return Trees(
            kept["features"].astype(np.int32),
            kept["thresholds"].astype(np.float64),
            kept["lefts"].astype(np.int32),
            kept["rights"].astype(np.int32),
            kept["roots"].astype(np.int32),
            float(kept["base"]),
        )


def write_trees(trees: Trees, path: Path) -> None:
    """Keep trees in a compressed file."""
    np.savez_compressed(
        path,
        features=trees.features,
        thresholds=trees.thresholds.astype(np.float32),
        lefts=trees.lefts,
        rights=trees.rights,
        roots=trees.roots,
        base=np.float32(trees.base),
    )


@kernel
def log_odds_kernel(
    trees: Trees, rows: NDArray[np.float32], first: int, stop: int, found: NDArray[np.float64]
) -> None:
    """Log-odds for the rows ``first … stop − 1``; NaN goes right.

    A row that the first third of the trees finds hopeless isn't shown to the others.
    """
    third = trees.roots.size // 3
    for row in range(first, stop):
        total = trees.base
        for tree in range(trees.roots.size):
            if tree == third and total < _HOPELESS:
                break
            node = trees.roots[tree]
            while trees.features[node] >= 0:
                is_left = rows[row, trees.features[node]] <= trees.thresholds[node]
                node = trees.lefts[node] if is_left else trees.rights[node]
            total += trees.thresholds[node]
        found[row] = total


def warm_up() -> None:
    """Compile the kernel."""
    none = np.zeros(1, np.int32)
    leaf = Trees(none - 1, np.zeros(1), none, none, none, 0.0)
    log_odds_kernel(leaf, np.zeros((1, 1), np.float32), 0, 1, np.empty(1))
