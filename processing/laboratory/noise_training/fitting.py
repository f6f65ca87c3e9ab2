"""Trees from examples, by scikit-learn's gradient boosting."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.laboratory.noise_training.examples import Examples, FeatureVectors
from processing.methods.noise.trees import Trees, log_odds

_BINS = 64
_RIDGE = 5.0


@dataclass(frozen=True)
class TreesSize:
    """How many trees of how many leaves, and how much each may say.

    Attributes
    ----------
    least_in_a_leaf : int
        Examples.
    signs : tuple of int
        Of each feature whether more of it can only raise (1) or lower (−1) the odds, or either (0);
        empty: either.
    """

    trees: int
    leaves: int
    rate: float
    least_in_a_leaf: int = 60
    signs: tuple[int, ...] = ()


def fit_trees(examples: Examples, shape: TreesSize) -> Trees:
    """Trees that give the log-odds of being noise.

    References
    ----------
    Friedman, "Greedy function approximation: a gradient boosting machine", 2001, section 4.4;
    in the form of scikit-learn's ``HistGradientBoostingClassifier``.
    """
    from sklearn.ensemble import HistGradientBoostingClassifier

    model = HistGradientBoostingClassifier(
        max_iter=shape.trees,
        max_leaf_nodes=shape.leaves,
        learning_rate=shape.rate,
        max_bins=_BINS,
        l2_regularization=_RIDGE,
        min_samples_leaf=shape.least_in_a_leaf,
        monotonic_cst=list(shape.signs) or None,
        early_stopping=False,
        random_state=0,
    )
    model.fit(np.nan_to_num(examples.rows), examples.is_noise, sample_weight=examples.weights)
    return _trees_of(model)


def shift_to_keep(
    trees: Trees, rows: FeatureVectors, is_noise: NDArray[np.bool_], lost_share: float
) -> Trees:
    """Trees whose sum is above zero for all noise but a small share."""
    odds = log_odds(trees, rows, SilentMonitor())[is_noise]
    return trees._replace(base=trees.base - float(np.quantile(odds, lost_share)))


def mean_of_trees(sums: Sequence[Trees]) -> Trees:
    """Trees that give the mean of what several sums of them say.

    They take turns, so that those at the front say about what all do.
    """
    each = [
        (number / one.roots.size, one, slice(*ends))
        for one in sums
        for number, ends in enumerate(pairwise([*one.roots.tolist(), one.features.size]))
    ]
    each.sort(key=lambda turn: turn[0])
    starts = np.cumsum([0, *(nodes.stop - nodes.start for _, _, nodes in each)])[:-1]
    moves = [start - nodes.start for start, (_, _, nodes) in zip(starts, each, strict=True)]
    features = np.concatenate([one.features[nodes] for _, one, nodes in each])
    values = np.concatenate([one.thresholds[nodes] for _, one, nodes in each])
    values[features < 0] = (values[features < 0] / len(sums)).astype(np.float32)
    lefts, rights = (
        np.concatenate(
            [
                getattr(one, side)[nodes] + move
                for move, (_, one, nodes) in zip(moves, each, strict=True)
            ]
        )
        for side in ("lefts", "rights")
    )
    return Trees(
        features,
        values,
        lefts.astype(np.int32),
        rights.astype(np.int32),
        starts.astype(np.int32),
        float(np.mean([one.base for one in sums])),
    )


# scikit-learn has no types here.
def _trees_of(model: Any) -> Trees:
    base = model._baseline_prediction  # noqa: SLF001 - the only way to it
    predictors = [one[0] for one in model._predictors]  # noqa: SLF001 - the only way to the nodes
    return joined_trees(predictors, float(np.ravel(base)[0]))


def joined_trees(predictors: Sequence[Any], base: float) -> Trees:
    """The trees of scikit-learn's boosting, one behind the other.

    Parameters
    ----------
    predictors : sequence
        As a fitted ``HistGradientBoostingClassifier`` holds them.
    base : float
        Log-odds before any tree.
    """
    nodes = [one.nodes for one in predictors]
    starts = np.cumsum([0, *(one.size for one in nodes)])[:-1].astype(np.int32)
    joined = np.concatenate(nodes)
    firsts = np.repeat(starts, [one.size for one in nodes])
    is_leaf = joined["is_leaf"].astype(bool)
    values = np.where(is_leaf, joined["value"], joined["num_threshold"])
    return Trees(
        np.where(is_leaf, -1, joined["feature_idx"]).astype(np.int32),
        values.astype(np.float32).astype(np.float64),
        (firsts + joined["left"]).astype(np.int32),
        (firsts + joined["right"]).astype(np.int32),
        starts,
        base,
    )
