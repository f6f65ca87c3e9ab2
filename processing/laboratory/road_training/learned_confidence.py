"""Chances learnt from things of known streets: logistic regression, and how reliable it is."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from processing.core.arrays import Floats
from processing.laboratory.accuracy.filters.filter_tables import markdown_table

_BOUNDS = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0)


@dataclass(frozen=True)
class LabelledThings:
    """Things of which it is known whether they are right.

    Attributes
    ----------
    terms : (n, f) float64
        Facts as the weights take them.
    is_right : (n,) bool
    worth : (n,) float64
        How much each has to say.
    street : (n,) int64
        Which street each is from.
    """

    terms: Floats
    is_right: NDArray[np.bool_]
    worth: Floats
    street: NDArray[np.int64]

    @staticmethod
    def of(rows: Sequence[tuple[Sequence[float], bool, float, int]], facts: int) -> LabelledThings:
        """From the terms, rightness, worth and street of each."""
        return LabelledThings(
            np.array([row[0] for row in rows], np.float64).reshape(-1, facts),
            np.array([row[1] for row in rows], np.bool_),
            np.array([row[2] for row in rows], np.float64),
            np.array([row[3] for row in rows], np.int64),
        )

    def chosen(self, which: NDArray[np.bool_]) -> LabelledThings:
        """Some of them."""
        return LabelledThings(
            self.terms[which], self.is_right[which], self.worth[which], self.street[which]
        )


@dataclass(frozen=True)
class WeightPrior:
    """What reasoning expects of weights before anything is learnt.

    Attributes
    ----------
    weights, off : (f + 1,)
        The constant and the weights, and how far each may be off. No weight changes its sign.
    """

    weights: Sequence[float]
    off: Sequence[float]


def fit_weights(known: LabelledThings, expected: WeightPrior) -> Floats:
    """(f + 1,) constant and weights: the likeliest after what was expected and what was seen.

    References
    ----------
    Hosmer, Lemeshow: Applied Logistic Regression; Gelman et al. 2008 (weakly informative priors).
    """
    middle, off = np.array(expected.weights), np.array(expected.off)
    terms = np.column_stack([np.ones(known.is_right.size), known.terms])

    def doubt(weights: Floats) -> tuple[float, Floats]:
        logits, away = terms @ weights, (weights - middle) / off
        loss = known.worth * (np.logaddexp(0.0, logits) - known.is_right * logits)
        slope = terms.T @ (known.worth * (_chance(logits) - known.is_right))
        return float(loss.sum() + 0.5 * (away**2).sum()), slope + away / off

    bounds = [(None, None), *((0.0, None) if one > 0 else (None, 0.0) for one in middle[1:])]
    found = minimize(doubt, middle, jac=True, method="L-BFGS-B", bounds=bounds)
    return np.asarray(found.x, np.float64)


def chances(known: LabelledThings, weights: Floats) -> Floats:
    """(n,) by some weights."""
    return _chance(weights[0] + known.terms @ weights[1:])


def cross_validate(known: LabelledThings, expected: WeightPrior) -> Floats:
    """(n,) each street's by weights that were fitted without it."""
    result = np.zeros(known.is_right.size)
    for street in np.unique(known.street):
        is_here = known.street == street
        result[is_here] = chances(
            known.chosen(is_here), fit_weights(known.chosen(~is_here), expected)
        )
    return result


def reliability(known: LabelledThings, chance: Floats) -> str:
    """A table: things and right ones by confidence."""
    rows = []
    for low, high in itertools.pairwise(_BOUNDS):
        chosen = (chance >= low) & ((chance < high) | (high == _BOUNDS[-1]))
        count, right = int(chosen.sum()), int(known.is_right[chosen].sum())
        share = f"{100 * right / count:.0f} %" if count else "–"
        rows.append([f"{low:.1f}–{high:.1f}", str(count), str(right), share])
    return markdown_table([["confidence", "of", "right", "share"], *rows])


def learn_weights(
    names: Sequence[str], expected: WeightPrior, known: LabelledThings, check: LabelledThings
) -> str:
    """The weights, a line each; how reliable they are, each street left out; and on others."""
    weights = fit_weights(known, expected)
    named = zip(("constant", *names), weights, strict=True)
    told = "".join(f"{name} {weight:.2f}\n" for name, weight in named)
    own, others = cross_validate(known, expected), chances(check, weights)
    return f"{told}\n{reliability(known, own)}\n\n{reliability(check, others)}\n"


def _chance(logits: Floats) -> Floats:
    result: Floats = 1.0 / (1.0 + np.exp(-np.clip(logits, -50.0, 50.0)))
    return result
