"""Trees of several classes from examples, by scikit-learn: boosted, or averaged.

References
----------
Geurts, Ernst and Wehenkel 2006, Extremely randomized trees, Machine Learning 63.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.noise_training.fitting import joined_trees
from processing.methods.noise.tree_files import AveragedTrees, Forest
from processing.methods.noise.trees import rounded_down

_BINS = 48
_LEAST_IN_A_LEAF = 40
_LEAST_IN_AN_AVERAGED_LEAF = 5
_RIDGE = 10.0
_LEAST_SHARE = 0.005
"""Of a leaf: classes that are less likely there aren't written."""
_BALANCE = 0.5
"""Power of a class's share by which it counts: between as frequent as it is and all alike."""


@dataclass(frozen=True)
class ForestSize:
    """How many rounds of trees of how many leaves, and how much each may say."""

    rounds: int
    leaves: int
    rate: float


@dataclass(frozen=True)
class AveragedSize:
    """How many averaged trees of how many leaves, and the share of the features each node asks."""

    trees: int
    leaves: int
    asked: float


def fit_forest(
    rows: NDArray[np.float32],
    codes: NDArray[np.uint8],
    stands_for: NDArray[np.float64],
    size: ForestSize,
) -> Forest:
    """Trees that say how likely each class is.

    Parameters
    ----------
    rows : (n, f) float32
    codes : (n,) uint8
    stands_for : (n,) float64
        For how many cells each example stands.
    """
    from sklearn.ensemble import HistGradientBoostingClassifier

    model = HistGradientBoostingClassifier(
        max_iter=size.rounds,
        max_leaf_nodes=size.leaves,
        learning_rate=size.rate,
        max_bins=_BINS,
        l2_regularization=_RIDGE,
        min_samples_leaf=_LEAST_IN_A_LEAF,
        early_stopping=False,
        random_state=0,
    )
    model.fit(rows, codes, sample_weight=_balanced(codes, stands_for))
    return _forest_of(model)


def fit_averaged_trees(
    rows: NDArray[np.float32],
    codes: NDArray[np.uint8],
    stands_for: NDArray[np.float64],
    size: AveragedSize,
) -> AveragedTrees:
    """Trees that divide by chance, whose mean says how likely each class is.

    What one of them takes from the simulated world another doesn't: on streets of another simulator
    they err otherwise than boosted ones (docs/accuracy.md).

    Parameters
    ----------
    rows, codes, stands_for
        As of :func:`fit_forest`.
    """
    from sklearn.ensemble import ExtraTreesClassifier

    model = ExtraTreesClassifier(
        size.trees,
        max_leaf_nodes=size.leaves,
        min_samples_leaf=_LEAST_IN_AN_AVERAGED_LEAF,
        max_features=size.asked,
        random_state=0,
    )
    model.fit(rows, codes, sample_weight=_balanced(codes, stands_for))
    return _averaged_of(model)


def _balanced(codes: NDArray[np.uint8], stands_for: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) weights, 1 in the mean, by which rare classes count more than they are frequent."""
    weights = stands_for.copy()
    for code in np.unique(codes):
        own = codes == code
        weights[own] *= weights[own].sum() ** -_BALANCE
    return np.asarray(weights * (weights.size / weights.sum()))


def in_order_of(shares: NDArray[np.float32], judge: Forest, wanted: Forest) -> NDArray[np.float32]:
    """Shares in the order of another forest's classes; none of a class that it didn't meet."""
    ordered = np.zeros((shares.shape[0], wanted.codes.size), np.float32)
    known = {code: column for column, code in enumerate(judge.codes.tolist())}
    for column, code in enumerate(wanted.codes.tolist()):
        if code in known:
            ordered[:, column] = shares[:, known[code]]
    return ordered


# scikit-learn has no types here.
def _forest_of(model: Any) -> Forest:
    rounds = model._predictors  # noqa: SLF001 - the only way to the nodes
    predictors = [one for each in rounds for one in each]
    class_of = np.array([which for each in rounds for which in range(len(each))], np.int32)
    trees = joined_trees(predictors, 0.0)
    bases = np.ravel(model._baseline_prediction).astype(np.float32)  # noqa: SLF001 - as above
    return Forest(trees, class_of, bases.astype(np.float64), model.classes_.astype(np.uint8))


# scikit-learn has no types here.
def _averaged_of(model: Any) -> AveragedTrees:
    parts = [_in_order(one.tree_) for one in model.estimators_]
    sizes = [part.features.size for part in parts]
    leaves = [len(part.shares) for part in parts]
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int32)
    firsts = np.concatenate([[0], np.cumsum(leaves)[:-1]]).astype(np.int32)
    return AveragedTrees(
        np.concatenate([part.features for part in parts]),
        np.concatenate([part.thresholds for part in parts]),
        np.concatenate([part.rights + at for part, at in zip(parts, starts, strict=True)]),
        np.concatenate([part.leaf_of + at for part, at in zip(parts, firsts, strict=True)]),
        np.concatenate([part.shares for part in parts]),
        starts,
        model.classes_.astype(np.uint8),
    )


# scikit-learn has no types here.
def _in_order(tree: Any) -> AveragedTrees:
    """One tree with every node before those below it, the left ones first; a leaf's next is itself.

    scikit-learn's thresholds are doubles: single numbers are rounded down, which divides alike.
    """
    order, waiting = [], [0]
    while waiting:
        node = waiting.pop()
        order.append(node)
        if tree.children_left[node] >= 0:
            waiting += [tree.children_right[node], tree.children_left[node]]
    at = np.empty(len(order), np.int32)
    at[order] = np.arange(len(order))
    is_leaf = tree.children_left[order] < 0
    rights = np.where(is_leaf, np.arange(len(order)), at[tree.children_right[order]])
    shares = tree.value[np.array(order)[is_leaf], 0, :]
    shares = np.where(shares < _LEAST_SHARE, 0.0, shares)
    return AveragedTrees(
        np.where(is_leaf, -1, tree.feature[order]).astype(np.int32),
        rounded_down(tree.threshold[order]),
        rights.astype(np.int32),
        (np.cumsum(is_leaf) - 1).astype(np.int32),
        (shares / shares.sum(axis=1, keepdims=True)).astype(np.float32),
        np.zeros(1, np.int32),
        np.zeros(0, np.uint8),
    )
