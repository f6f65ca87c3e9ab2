"""How the local and the global block become one answer.

References
----------
Shinohara 2022, section 3.3.4 and figure 3.11; section 6.2 (learned fusion as future work).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from processing.core.arrays import Flags, Floats, Integers
from processing.scoring.points.six_classes import SIX

F32 = NDArray[np.float32]

LOCAL = tuple(SIX.index(code) for code in (5, 14, 15))
"""Vegetation, wire and tower: classes that one waveform may tell."""

THRESHOLD = 0.5
_LEAST_SHARE = 1e-6
_PENALTY = 1e-3


def merged_published(
    local: F32, of_all: F32, local_classes: tuple[int, ...] = LOCAL
) -> tuple[Integers, Flags]:
    """The published rule.

    A local class that the local block gives at least `THRESHOLD` has its word, all others the
    global block's; the greatest counts.

    Parameters
    ----------
    local, of_all : (n, k) float32
        How likely each class is, by the local and the global block.
    local_classes : tuple of int
        Their places.

    Returns
    -------
    found : (n,) int64
        Places of classes.
    is_local : (n,) bool
        Whether the local block's word decided.
    """
    columns = list(local_classes)
    both = np.array(of_all, np.float32)
    is_sure = local[:, columns] >= THRESHOLD
    both[:, columns] = np.where(is_sure, local[:, columns], both[:, columns])
    found = both.argmax(axis=1)
    replaced = np.zeros(both.shape, np.bool_)
    replaced[:, columns] = is_sure
    return found, replaced[np.arange(found.size), found]


def merged_any_class(local: F32, of_all: F32) -> tuple[Integers, Flags]:
    """The local block's class wherever it is that sure of any; as `merged_published`."""
    is_local: Flags = local.max(axis=1) >= THRESHOLD
    return np.where(is_local, local.argmax(axis=1), of_all.argmax(axis=1)), is_local


@dataclass(frozen=True, eq=False)
class LearnedMerge:
    """A logistic layer on the logarithms of what both blocks say.

    Attributes
    ----------
    weights : (2 k + 1, k) float64
        The last row is the bias.
    """

    weights: Floats

    @staticmethod
    def of(local: F32, of_all: F32, classes: Integers) -> LearnedMerge:
        """By points that neither block learnt from; every class counts as much."""
        rows, count = _told(local, of_all), local.shape[1]
        counts = np.bincount(classes, minlength=count)
        weight = (1.0 / np.maximum(counts, 1))[classes] / np.count_nonzero(counts)
        start = np.concatenate([np.eye(count) / 2, np.eye(count) / 2, np.zeros((1, count))])

        def loss(flat: Floats) -> tuple[float, Floats]:
            weights = flat.reshape(start.shape)
            shares = _softmax(rows @ weights)
            own = np.maximum(shares[np.arange(classes.size), classes], _LEAST_SHARE)
            shares[np.arange(classes.size), classes] -= 1
            gradient = rows.T @ (shares * weight[:, None]) + _PENALTY * (weights - start)
            penalty = _PENALTY / 2 * float(((weights - start) ** 2).sum())
            return -float((weight * np.log(own)).sum()) + penalty, gradient.ravel()

        found = minimize(loss, start.ravel(), jac=True, method="L-BFGS-B")
        return LearnedMerge(np.asarray(found.x, np.float64).reshape(start.shape))

    def merged(self, local: F32, of_all: F32) -> Integers:
        """(n,) int64 places of classes."""
        return np.asarray((_told(local, of_all) @ self.weights).argmax(axis=1), np.int64)


def _told(local: F32, of_all: F32) -> Floats:
    logs = np.log(np.maximum(np.hstack([local, of_all]), _LEAST_SHARE)).astype(np.float64)
    return np.hstack([logs, np.ones((len(logs), 1))])


def _softmax(values: Floats) -> Floats:
    raised = np.exp(values - values.max(axis=1, keepdims=True))
    return np.asarray(raised / raised.sum(axis=1, keepdims=True))
