"""Trees of several classes from examples, by scikit-learn's gradient boosting."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.noise_training.fitting import joined_trees
from processing.methods.noise.tree_files import Forest

_BINS = 48
_LEAST_IN_A_LEAF = 40
_RIDGE = 10.0
_BALANCE = 0.5
"""Power of a class's share by which it counts: between as frequent as it is and all alike."""


@dataclass(frozen=True)
class ForestSize:
    """How many rounds of trees of how many leaves, and how much each may say."""

    rounds: int
    leaves: int
    rate: float


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

    weights = stands_for.copy()
    for code in np.unique(codes):
        own = codes == code
        weights[own] *= weights[own].sum() ** -_BALANCE
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
    model.fit(rows, codes, sample_weight=weights * (weights.size / weights.sum()))
    return _forest_of(model)


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
