"""The thesis' forests: importance, Boruta's choice, and F as if all points had been asked.

References
----------
Takahashi 2022, sections 4.5 to 4.7; Kursa and Rudnicki 2010, Journal of Statistical Software
36(11), for Boruta.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.scoring.points.class_scores import class_score
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.scoring.points.point_scores import PointScore

_TREES, _LEAST_LEAF = 100, 5
"""The thesis names neither: scikit-learn's number of trees, and leaves that no single point makes.
"""

LEAST_IMPORTANCE = 0.015
"""Table 4-1."""

_BORUTA_ROUNDS, _BORUTA_ROWS, _BORUTA_TREES = 20, 3_000, 30
_SURE = 0.05
"""Rounds in which a feature beats the best shadow follow a binomial distribution; kept is what does
so more often than half at this level, with Bonferroni's correction for all features."""


# scikit-learn's classes have no types.
def fitted_forest(rows: NDArray[np.float32], codes: NDArray[np.uint8]) -> Any:
    """A random forest in which every class counts as much."""
    from sklearn.ensemble import RandomForestClassifier

    forest = RandomForestClassifier(
        _TREES,
        min_samples_leaf=_LEAST_LEAF,
        max_features="sqrt",
        class_weight="balanced",
        random_state=0,
    )
    return forest.fit(rows, codes)


def importance_of(forest: Any) -> Floats:
    """(f,) share of each feature in what a forest tells, 1 in all."""
    shares: Floats = forest.feature_importances_
    return shares


def boruta(rows: NDArray[np.float32], codes: NDArray[np.uint8], rng: Generator) -> Integers:
    """Features that beat the best of all shadows more often than by chance.

    1. Every feature gets a shadow: its values in another order, so that they say nothing.
    2. A forest is grown of both; a feature scores when it is worth more than the best shadow.
    3. Kept is what scored in more of the rounds than chance would let it.

    Parameters
    ----------
    rows : (n, f) float32
    codes : (n,) uint8

    Returns
    -------
    (k,) int64
        Numbers of the columns, rising.
    """
    from scipy.stats import binom
    from sklearn.ensemble import RandomForestClassifier

    some = rng.choice(len(codes), min(len(codes), _BORUTA_ROWS), replace=False)
    rows, codes = rows[some], codes[some]
    scored = np.zeros(rows.shape[1], np.int64)
    for number in range(_BORUTA_ROUNDS):
        both = np.hstack([rows, rng.permuted(rows, axis=0)])
        forest = RandomForestClassifier(_BORUTA_TREES, class_weight="balanced", random_state=number)
        worth = importance_of(forest.fit(both, codes))
        scored += worth[: rows.shape[1]] > worth[rows.shape[1] :].max()
    by_chance = binom.sf(scored - 1, _BORUTA_ROUNDS, 0.5)
    return np.flatnonzero(by_chance < _SURE / rows.shape[1])


def whole_score(
    true: NDArray[np.uint8], found: NDArray[np.uint8], counts: Mapping[int, int]
) -> PointScore:
    """What a sample says of a street: every point counts for the others of its class.

    Parameters
    ----------
    true, found : (n,) uint8
    counts : mapping of int to int
        Points of each class in the street.
    """
    matrix = ConfusionMatrix.of(true, found)
    whole = np.array([counts.get(code, 0) for code in matrix.codes])
    asked = np.maximum(matrix.true_counts, 1)
    scaled = np.rint(matrix.counts * (whole / asked)[:, None]).astype(np.int64)
    return class_score(ConfusionMatrix(matrix.codes, scaled))


def mean_f(score: PointScore) -> float:
    """Mean F of the classes, ground and road as one."""
    (joined,) = [one.value for one in score.figures if one.id == "mean_f_ground_joined"]
    return joined
