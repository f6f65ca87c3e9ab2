"""Boosted decision trees as plain arrays, asked about many rows at once.

A kernel of its own, for onnxruntime 1.31 is no faster: on the rows that the sample street asks
about (60,223 of 19, 22,007 of 73 and 7,709 of 90 features; two cores) it took 0.083, 0.125 and
0.062 s, these 0.097, 0.167 and 0.031 s, as they skip the trees that no longer matter. It would add
68 MB to what is installed, and answers in float32.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.noise.neighbours.sharing import share_out

_HOPELESS = -4.0
"""Log-odds (2 % likely) after a third of the trees from which the others aren't asked: they change
little that matters then. By trial."""

_ROWS_AT_ONCE = 16_384
"""Rows of a share of a core's work."""


_ROWS_AT_A_TREE = 128
"""Rows that one tree is shown after the other: its nodes and their features stay at hand."""


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


def log_odds(trees: Trees, rows: NDArray[np.float32], monitor: Monitor) -> NDArray[np.float64]:
    """(n,) log-odds of the claim for rows of features, (n, f)."""
    found = np.empty(rows.shape[0])
    rows = np.ascontiguousarray(rows)

    def weigh(start: int, stop: int) -> None:
        log_odds_kernel(trees, rows, start, stop, found)

    share_out(weigh, found.size, _ROWS_AT_ONCE, monitor)
    return found


@kernel
def log_odds_kernel(
    trees: Trees, rows: NDArray[np.float32], first: int, stop: int, found: NDArray[np.float64]
) -> None:
    """Log-odds for the rows ``first … stop − 1``; NaN goes right.

    A row that the first third of the trees finds hopeless isn't shown to the others.
    """
    third, count = trees.roots.size // 3, trees.roots.size
    left = np.empty(_ROWS_AT_A_TREE, np.int64)
    for start in range(first, stop, _ROWS_AT_A_TREE):
        end = min(start + _ROWS_AT_A_TREE, stop)
        found[start:end] = trees.base
        for row in range(start, end):
            left[row - start] = row
        _add_trees(trees, rows, (0, third), left[: end - start], found)
        asked = 0
        for row in range(start, end):
            if not found[row] < _HOPELESS:
                left[asked] = row
                asked += 1
        _add_trees(trees, rows, (third, count), left[:asked], found)


@kernel
def _add_trees(
    trees: Trees,
    rows: NDArray[np.float32],
    some: tuple[int, int],
    asked: NDArray[np.int64],
    found: NDArray[np.float64],
) -> None:
    """Add what some trees, one after the other, say of rows."""
    for tree in range(some[0], some[1]):
        root = trees.roots[tree]
        for row in asked:
            node = root
            feature = trees.features[node]
            while feature >= 0:
                is_left = rows[row, feature] <= trees.thresholds[node]
                node = trees.lefts[node] if is_left else trees.rights[node]
                feature = trees.features[node]
            found[row] += trees.thresholds[node]


def warm_up() -> None:
    """Compile the kernel."""
    none = np.zeros(1, np.int32)
    leaf = Trees(none - 1, np.zeros(1), none, none, none, 0.0)
    log_odds_kernel(leaf, np.zeros((1, 1), np.float32), 0, 1, np.empty(1))
